//! The stress of a result's gears for its page: of each gear at the moment at which its roots are stressed most, or at
//! one that is named.

use crate::cross_section::{CROSS_SECTION, FieldCase, largest_torque, nearest_angle, picture};
use crate::failure::{Failure, Result};
use crate::result_scene::scene_of;
use crate::stressed_gear::{Pressed, RootSearch, StressedBody, StressedGear, pressed_at};
use crate::system_moments::{SystemMoments, WantedMoments, stressed};
use crate::tooth_stress::{self, LoadedGear};
use crate::watch::Watch;
use gearmesh_geometry::{Element, Flank, GearDefinition};
use gearmesh_report::moving::pair_moment;
use gearmesh_report::page::{FieldPicture, Section, Text};
use gearmesh_scene::SceneResult;
use gearmesh_scene::system::MovingShape;
use gearmesh_scene::system_run::{ResultKind, SystemResult};
use serde_json::Value;
use std::path::{Path, PathBuf};

/// At which moment the stress of a result is drawn.
#[derive(Debug, Clone, Default)]
pub struct StressRequest {
    /// Time, of a run in time.
    pub at_s: Option<f64>,
    /// Angle of the driver, of a pair at rest.
    pub angle_deg: Option<f64>,
    /// Folder that file names of a multibody scene are relative to.
    pub scene_folder: Option<PathBuf>,
}

/// A section, and its figures for other programs.
pub type StressSection = (Section, Vec<Value>);

fn head(title: &str) -> Section {
    Section::new(format!("{title}: stress in the bodies"))
        .push(Text::paragraph(tooth_stress::WORDS))
}

/// Of these moments the one at which a gear's roots are stressed most; none where nothing presses on it.
fn worst_moment(
    gear: (&str, &StressedGear),
    moments: &[Pressed],
    watch: &Watch<'_>,
) -> Result<Option<usize>> {
    if moments.len() == 1 {
        return Ok((!moments[0].forces.is_empty()).then_some(0));
    }
    let carries = |side: &Flank| {
        moments
            .iter()
            .flat_map(|m| &m.forces)
            .any(|f| f.side == *side)
    };
    let sides: Vec<Flank> = Flank::ALL.into_iter().filter(carries).collect();
    let search = watch.offline(gear.0, |told| {
        told.stage("looking for the largest root strain");
        RootSearch::new(gear.1, &sides, told)
    });
    search?.largest_of(moments)
}

/// Why a gear has no pictures; none where it has.
fn no_pictures(gear: &GearDefinition) -> Option<&'static str> {
    if gear.blank.meshed().is_some() {
        Some("it was meshed elsewhere")
    } else if gear.crack.is_some() {
        Some("it has a crack")
    } else {
        None
    }
}

/// Adds a gear at the worst of its moments.
pub fn add_worst(
    (section, figures): StressSection,
    (name, gear): (&str, &StressedGear),
    moments: &[Pressed],
    when: impl Fn(usize) -> String,
    watch: &Watch<'_>,
) -> Result<(StressSection, Option<usize>)> {
    let Some(worst) = worst_moment((name, gear), moments, watch)? else {
        let words = format!("{name}: nothing presses on its teeth.");
        return Ok(((section.push(Text::note(words)), figures), None));
    };
    let loaded = LoadedGear {
        name,
        stressed: gear,
        pressed: &moments[worst],
        when: &when(worst),
    };
    let (section, of_gear) = tooth_stress::add(section, &loaded)?;
    let figures = figures.into_iter().chain([of_gear]).collect();
    Ok(((section, figures), Some(worst)))
}

/// The section of a pair at rest, at its largest torque.
pub fn of_pair(
    a: &StressRequest,
    result: &SceneResult,
    path: &Path,
    watch: &Watch<'_>,
) -> Result<StressSection> {
    let loaded = scene_of(result, path)?;
    let torque = largest_torque(result);
    let gears = result.definitions()?;
    let angles: Vec<usize> = match a.angle_deg {
        None => (0..result.angles()).collect(),
        Some(wanted) => vec![nearest_angle(result, wanted)],
    };
    let mut forces = [Vec::new(), Vec::new()];
    for angle in &angles {
        let moment = pair_moment(&loaded, result, gears, (torque, *angle));
        for (gear, all) in forces.iter_mut().enumerate() {
            all.push(pressed_at(&moment, gear));
        }
    }
    let mut made = (head(&result.source.title), Vec::new());
    for (number, definition) in gears.into_iter().enumerate() {
        let name = &definition.name;
        if let Some(why) = no_pictures(definition) {
            watch.note(format!("{name}: no pictures of its stress, {why}"));
            continue;
        }
        let gear = StressedGear::of_gear(definition, watch)?;
        let gear = gear.on_bore(loaded.bores[number].clone());
        let case = |k: usize| FieldCase {
            gear: number + 1,
            torque,
            angle: angles[k],
        };
        let when = |k: usize| case(k).words(result);
        let worst;
        (made, worst) = add_worst(made, (name, &gear), &forces[number], when, watch)?;
        let StressedBody::Cylindrical(_, body) = &gear.body else {
            continue;
        };
        if definition.mesh.element == Element::Tet10 {
            watch.note(format!(
                "{name}: its mesh has no cross-section of quadrilaterals; `gearmesh recover --field-gear {}` writes the whole field",
                number + 1
            ));
        } else if let Some(worst) = worst {
            let whole = picture(&loaded, result, case(worst), (definition, body))?;
            made.0 = made.0.push(FieldPicture::from(&whole));
        }
    }
    made.0 = made.0.push(Text::paragraph(format!(
        "Of whole cross-sections: {CROSS_SECTION}"
    )));
    Ok(made)
}

/// The section of a multibody run; each gear at the row at which its roots are stressed most.
pub fn of_system(
    a: &StressRequest,
    result: &SystemResult,
    path: &Path,
    watch: &Watch<'_>,
) -> Result<StressSection> {
    if a.angle_deg.is_some() {
        return Err(Failure::input(format!(
            "--stress-angle-deg is for pairs at rest; {} is a multibody result, use --stress-at-s",
            path.display()
        )));
    }
    if a.at_s.is_some() && result.kind != ResultKind::Transient {
        return Err(Failure::input(format!(
            "--stress-at-s is for runs in time; {} is none, leave it out",
            path.display()
        )));
    }
    let wanted = WantedMoments {
        result: path,
        from_s: None,
        to_s: None,
        scene_folder: a.scene_folder.as_deref(),
    };
    let mut moments = SystemMoments::new(&wanted, result, watch)?;
    moments.demand_gears(wanted.result)?;
    let mut rows = moments.rows();
    if let Some(wanted) = a.at_s {
        let apart = |row: &usize| (moments.at(*row) - wanted).abs();
        let nearest = rows
            .iter()
            .copied()
            .min_by(|x, y| apart(x).total_cmp(&apart(y)));
        rows = nearest.into_iter().collect();
    }
    let gears = moments.gears().to_vec();
    let mut forces: Vec<Vec<Pressed>> = vec![Vec::new(); gears.len()];
    let bar = watch.listener.begin("forces on the teeth");
    for (done, row) in rows.iter().enumerate() {
        watch.go_on()?;
        let moment = moments.moment(*row)?;
        for (gear, all) in forces.iter_mut().enumerate() {
            all.push(pressed_at(&moment, gear));
        }
        bar.advance((done + 1) as f64, rows.len() as f64);
    }
    drop(bar);
    let mut made = (head(&result.head.title), Vec::new());
    for (gear, forces) in gears.iter().zip(&forces) {
        let left_out = match &gear.shape {
            MovingShape::Cylindrical(definition) => no_pictures(definition),
            MovingShape::Bevel(_) => None,
        };
        let idle = forces.iter().all(|pressed| pressed.forces.is_empty());
        let left_out = left_out.or(idle.then_some("nothing presses on its teeth"));
        if let Some(why) = left_out {
            watch.note(format!("{}: no pictures of its stress, {why}", gear.body));
            continue;
        }
        let body = stressed(gear, watch)?;
        let when = |k: usize| {
            let at = moments.at(rows[k]);
            match moments.unit {
                "s" => format!("at {at:.6} s"),
                _ => format!("equilibrium {at}"),
            }
        };
        (made, _) = add_worst(made, (&gear.body, &body), forces, when, watch)?;
    }
    Ok(made)
}
