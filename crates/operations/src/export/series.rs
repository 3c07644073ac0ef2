//! Gears that move: a .pvd file that names a .vtu file for each moment, in a folder beside it.

use super::ExportRequest;
use crate::answer::Answer;
use crate::cross_section::asked_torque;
use crate::failure::{Failure, Result};
use crate::result_scene::scene_of;
use crate::stressed_gear::{StressedGear, pressed_at};
use crate::system_moments::{SystemMoments, WantedMoments, stressed, surface};
use crate::watch::Watch;
use gearmesh_model::write_text;
use gearmesh_report::moving::{
    GearSurface, Moment, Series, pair_moment, pair_surfaces, series_text,
};
use gearmesh_scene::{ResultFile, SceneResult};
use serde_json::json;
use std::path::{Path, PathBuf};

/// Moments where nobody says how many.
const MOMENTS: usize = 100;

/// Writes the moments of a result.
pub(super) fn write(a: &ExportRequest, watch: &Watch<'_>) -> Result<Answer> {
    match ResultFile::open(&a.result).map_err(Failure::input)? {
        ResultFile::Pair(result) => pair(a, &result, watch),
        ResultFile::System(result) => {
            if a.torque_Nm.is_some() {
                return Err(Failure::input(
                    "--torque-Nm is for results of a [pair]; leave it out",
                ));
            }
            let wanted = WantedMoments {
                result: &a.result,
                from_s: a.from_s,
                to_s: a.to_s,
                scene_folder: a.scene_folder.as_deref(),
            };
            let mut moments = SystemMoments::new(&wanted, &result, watch)?;
            moments.demand_gears(wanted.result)?;
            let rows = chosen(moments.rows(), a, watch);
            let unit = moments.unit;
            let gears = moments.gears();
            let asked = gears.iter().filter(|_| a.stress);
            let stressed: Vec<_> =
                (asked.map(|gear| stressed(gear, watch))).collect::<Result<_, _>>()?;
            let surfaces: Vec<GearSurface> = match &stressed[..] {
                [] => gears.iter().map(surface).collect::<Result<_, _>>()?,
                stressed => {
                    (stressed.iter().map(StressedGear::surface)).collect::<Result<_, _>>()?
                }
            };
            write_moments((a, watch), &surfaces, unit, rows.len(), |k| {
                with_stress(moments.moment(rows[k])?, &stressed)
            })
        }
    }
}

fn pair(a: &ExportRequest, result: &SceneResult, watch: &Watch<'_>) -> Result<Answer> {
    for (name, given) in [
        ("--from-s", a.from_s.is_some()),
        ("--to-s", a.to_s.is_some()),
        ("--scene-folder", a.scene_folder.is_some()),
    ] {
        if given {
            let problem = format!("{name} is for results of multibody scenes; leave it out");
            return Err(Failure::input(problem));
        }
    }
    if result.bevel.is_some() {
        let problem = "gears that move are drawn of cylindrical pairs and of runs in time; run the bevel pair as a [[gear_mesh]]";
        return Err(Failure::input(problem));
    }
    let torque = asked_torque(result, "--torque-Nm", a.torque_Nm)?;
    let loaded = scene_of(result, &a.result)?;
    let gears = result.definitions()?;
    let asked = gears.iter().zip(&loaded.bores).filter(|_| a.stress);
    let stressed = asked.map(|(gear, bore)| {
        let stressed = StressedGear::of_gear(gear, watch)?;
        Ok(stressed.on_bore(bore.clone()))
    });
    let stressed: Vec<_> = stressed.collect::<Result<_>>()?;
    let surfaces = match &stressed[..] {
        [] => pair_surfaces(&loaded, gears).to_vec(),
        stressed => (stressed.iter().map(StressedGear::surface)).collect::<Result<_, _>>()?,
    };
    let angles = chosen((0..result.angles()).collect(), a, watch);
    watch.note(format!(
        "torque on gear 2: {} N m",
        result.torque_nm[torque]
    ));
    write_moments((a, watch), &surfaces, "deg", angles.len(), |k| {
        let moment = pair_moment(&loaded, result, gears, (torque, angles[k]));
        with_stress(moment, &stressed)
    })
}

/// Adds the stress of each gear under the forces on its flanks, where gears are given.
fn with_stress(mut moment: Moment, gears: &[StressedGear]) -> Result<Moment> {
    for (number, gear) in gears.iter().enumerate() {
        let pressed = pressed_at(&moment, number);
        moment.von_mises_pa.push(gear.stress(&pressed)?);
    }
    Ok(moment)
}

/// So many of them as are asked for, evenly.
fn chosen(all: Vec<usize>, a: &ExportRequest, watch: &Watch<'_>) -> Vec<usize> {
    let most = a.moments.map_or(MOMENTS, |count| count as usize);
    if all.len() <= most {
        return all;
    }
    watch.note(format!(
        "{most} of {} moments; --moments takes more",
        all.len()
    ));
    (0..most).map(|k| all[k * all.len() / most]).collect()
}

/// Writes all moments into a new folder, which then takes the place of an earlier one, and the file that names them.
fn write_moments(
    (a, watch): (&ExportRequest, &Watch<'_>),
    surfaces: &[GearSurface],
    unit: &str,
    count: usize,
    mut moment: impl FnMut(usize) -> Result<Moment>,
) -> Result<Answer> {
    let folder = frames_folder(&a.output)?;
    let name = folder
        .file_name()
        .unwrap_or_default()
        .to_string_lossy()
        .into_owned();
    let work = |error: std::io::Error| Failure::work(format!("{}: {error}", folder.display()));
    let parent = folder.parent().filter(|p| !p.as_os_str().is_empty());
    let scratch = tempfile::Builder::new()
        .prefix(".gearmesh-")
        .suffix(".tmp")
        .tempdir_in(parent.unwrap_or(Path::new(".")))
        .map_err(work)?;
    let series = Series::new(surfaces);
    let bar = watch.listener.begin("moments");
    let mut files = Vec::with_capacity(count);
    for k in 0..count {
        watch.go_on()?;
        let moment = moment(k)?;
        let file = format!("{k:05}.vtu");
        std::fs::write(scratch.path().join(&file), series.moment_text(&moment)).map_err(work)?;
        files.push((moment.at, format!("{name}/{file}")));
        bar.advance((k + 1) as f64, count as f64);
    }
    drop(bar);
    if folder.exists() {
        std::fs::remove_dir_all(&folder).map_err(work)?;
    }
    std::fs::rename(scratch.keep(), &folder).map_err(work)?;
    write_text(&a.output, &series_text(&files))?;
    watch.note(format!(
        "{count} moments in {}, over {unit}; {} gears",
        folder.display(),
        surfaces.len()
    ));
    let at: Vec<f64> = files.iter().map(|(at, _)| *at).collect();
    let paths: Vec<&String> = files.iter().map(|(_, file)| file).collect();
    let figures = json!({ "file": a.output, "moments": at, "unit": unit, "files": paths });
    Ok(figures.into())
}

/// The folder beside the file; one that is there must hold nothing but moments of an earlier export.
fn frames_folder(output: &Path) -> Result<PathBuf> {
    let stem = output.file_stem().unwrap_or_default().to_string_lossy();
    let folder = output.with_file_name(format!("{stem}_moments"));
    let Ok(found) = folder.symlink_metadata() else {
        return Ok(folder);
    };
    let foreign = || -> std::io::Result<Option<PathBuf>> {
        for entry in std::fs::read_dir(&folder)? {
            let path = entry?.path();
            if path.extension().is_none_or(|ending| ending != "vtu") {
                return Ok(Some(path));
            }
        }
        Ok(None)
    };
    let other = if found.is_dir() {
        foreign().map_err(Failure::work)?
    } else {
        Some(folder.clone())
    };
    match other {
        None => Ok(folder),
        Some(path) => Err(Failure::input(format!(
            "{}: the moments are written into {}, and this is none; move it, or choose another name",
            path.display(),
            folder.display()
        ))),
    }
}
