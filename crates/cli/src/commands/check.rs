//! `gearmesh check`: reads a file of any kind and says what it is, or what is wrong with it.

use crate::arguments::CheckArguments;
use crate::commands::{bevel, reduce, system_table};
use crate::failure::Failure;
use crate::{console, offline};
use gearmesh_bearings::QuasiStaticBearing;
use gearmesh_bearings::bearing_file::BearingFromFile;
use gearmesh_bevel::PairFile;
use gearmesh_geometry::GearDefinition;
use gearmesh_geometry::input::InputDocument;
use gearmesh_model::{REDUCED_GEAR_FORMAT, format_of, read_reduced_gear};
use gearmesh_report::ReferenceRecord;
use gearmesh_scene::rating::sn_curve;
use gearmesh_scene::study::{PairCases, Study, StudyScenes};
use gearmesh_scene::system_run::RunJob;
use gearmesh_scene::{InputKind, ResultFile, SceneFile, load};
use std::path::Path;

/// Runs the command.
pub fn run(arguments: &CheckArguments) -> Result<(), Failure> {
    let path = &arguments.file;
    let ends_in = |ending: &str| {
        path.extension()
            .is_some_and(|e| e.eq_ignore_ascii_case(ending))
    };
    if ends_in("h5") || ends_in("hdf5") {
        return if format_of(path).map_err(Failure::input)? == REDUCED_GEAR_FORMAT.name {
            model(path)
        } else {
            result(path)
        };
    }
    if path.join("record.toml").is_file() {
        return record(path);
    }
    let document = InputDocument::read(path)?;
    let folder = path.parent().unwrap_or(Path::new(""));
    match InputKind::of(&document)? {
        InputKind::Scene => scene(path, SceneFile::from_document(document, folder)?),
        InputKind::Study => study(path, &Study::from_document(document, folder)?),
        InputKind::SnTable => sn_table(path, &document),
        InputKind::Record => record(folder),
        InputKind::Gear if PairFile::recognises(&document)? => bevel_pair(path, &document),
        InputKind::Gear if BearingFromFile::recognises(&document)? => bearing(path, &document),
        InputKind::Gear => gear(path, &document),
    }
}

fn bevel_pair(path: &Path, document: &InputDocument) -> Result<(), Failure> {
    let file = PairFile::from_document(document)?;
    bevel::design(&file)?;
    console::data(format!(
        "{}: bevel pair `{}`, sound",
        path.display(),
        file.title
    ));
    Ok(())
}

fn bearing(path: &Path, document: &InputDocument) -> Result<(), Failure> {
    let found = BearingFromFile::from_document(document)?;
    QuasiStaticBearing::new(&found.definition).map_err(Failure::work)?;
    console::data(format!(
        "{}: bearing `{}`, sound",
        path.display(),
        found.definition.name
    ));
    found.notes.iter().for_each(console::note);
    Ok(())
}

fn model(path: &Path) -> Result<(), Failure> {
    let model = read_reduced_gear(path).map_err(Failure::input)?;
    console::data(format!("{}: reduced gear, sound", path.display()));
    reduce::summary(&model).into_iter().for_each(console::data);
    Ok(())
}

fn result(path: &Path) -> Result<(), Failure> {
    let result = match ResultFile::open(path).map_err(Failure::input)? {
        ResultFile::Pair(result) => {
            console::data(format!(
                "{}: result of `{}`, {} torques x {} angles, sound",
                path.display(),
                result.title,
                result.torque_nm.len(),
                result.angles()
            ));
            return Ok(());
        }
        ResultFile::System(result) => result,
    };
    let (columns, rows) = (result.rows.columns().len(), result.rows.rows());
    let size = if rows > 0 {
        format!(", {columns} columns x {rows} rows")
    } else {
        String::new()
    };
    let problem = result.problem();
    let verdict = problem.as_ref().map_or("sound", |_| "not sound");
    console::data(format!(
        "{}: result of `{}`, {}{size}, {verdict}",
        path.display(),
        result.head.title,
        result.kind
    ));
    let lines = system_table::table(&result)?;
    lines.into_iter().skip(1).for_each(console::data);
    problem.map_or(Ok(()), |text| Err(Failure::work(text)))
}

fn scene(path: &Path, scene: SceneFile) -> Result<(), Failure> {
    match scene {
        SceneFile::Pair(scene) => {
            let loaded = load(*scene)?;
            loaded.scene.notes.iter().for_each(console::note);
            console::unit_slips(loaded.unit_slips());
            console::data(format!(
                "{}: scene `{}`, sound",
                path.display(),
                loaded.scene.title
            ));
        }
        SceneFile::System(scene) => {
            let loaded = scene.load()?;
            loaded.scene.notes.iter().for_each(console::note);
            console::unit_slips(loaded.unit_slips());
            let built = loaded.build()?;
            RunJob::from_scene(loaded.clone())?;
            console::data(format!(
                "{}: scene `{}`, sound: {} bodies, {} joints and motions, {} force elements",
                path.display(),
                loaded.scene.title,
                built.bodies.len(),
                built.joints.len(),
                built.elements.len()
            ));
            built.notes.iter().for_each(console::note);
        }
    }
    Ok(())
}

/// All scenes of a study are read, the scene as it is is built with its gears, whose columns are known then.
fn study(path: &Path, study: &Study) -> Result<(), Failure> {
    let made = StudyScenes::new(study, Path::new(""))?;
    made.check_columns(study, &PairCases::default())?;
    console::data(format!(
        "{}: study `{}`, sound: {} cases, {} columns of {}",
        path.display(),
        study.tables.title,
        made.cases.len(),
        study.tables.columns.len(),
        study.tables.scene.display()
    ));
    Ok(())
}

fn sn_table(path: &Path, document: &InputDocument) -> Result<(), Failure> {
    let curve = sn_curve(document)?;
    let points = curve.points();
    let [first, last] = [points.first(), points.last()].map(|point| {
        point.map_or(String::new(), |p| {
            format!("{} MPa at {:e} cycles", 1e-6 * p.amplitude_pa, p.cycles)
        })
    });
    console::data(format!(
        "{}: S-N table, sound: {} points, {first} to {last}",
        path.display(),
        points.len()
    ));
    Ok(())
}

/// A record is a folder.
fn record(folder: &Path) -> Result<(), Failure> {
    let record = ReferenceRecord::read(folder).map_err(Failure::input)?;
    let columns: Vec<&str> = record.columns.iter().map(|c| &c.name[..]).collect();
    console::data(format!(
        "{}: record `{}` ({}), sound: {} angles, {}",
        folder.display(),
        record.title,
        record.kind,
        record.angle_rad.len(),
        columns.join(", ")
    ));
    Ok(())
}

fn gear(path: &Path, document: &InputDocument) -> Result<(), Failure> {
    let gear = GearDefinition::from_document(document)?;
    offline::judge_gear(&gear, document)?;
    let p = &gear.profile;
    console::data(format!("{}: gear `{}`, sound", path.display(), gear.name));
    console::data(format!(
        "radii mm: tip {:.4}, reference {:.4}, base {:.4}, form {:.4}, root {:.4}{}",
        p.tip_radius_m * 1e3,
        p.reference_radius_m * 1e3,
        p.base_radius_m * 1e3,
        gearmesh_geometry::involute::radius_m(p.form_roll_rad, p.base_radius_m) * 1e3,
        p.root_radius_m * 1e3,
        if p.undercut { "; undercut" } else { "" }
    ));
    if p.helix_angle_rad != 0.0 {
        let width = gear.tooth.face_width_m;
        console::data(format!(
            "helix: {} hand, {:.4} deg at the reference circle, {:.4} deg at the base circle; transverse module {:.5} mm, transverse pressure angle {:.4} deg, overlap ratio over the face width {:.4}, virtual teeth {:.2}",
            p.hand(),
            p.helix_angle_rad.abs().to_degrees(),
            p.base_helix_angle_rad().abs().to_degrees(),
            2e3 * p.reference_radius_m / p.teeth as f64,
            (p.base_radius_m / p.reference_radius_m).acos().to_degrees(),
            p.overlap_ratio(width),
            p.virtual_teeth()
        ));
    }
    if gear.blank.openings().is_some() && gear.sectors() == 1 {
        console::warning(
            "the openings do not divide the teeth: the body does not repeat, and every tooth is solved",
        );
    }
    Ok(())
}
