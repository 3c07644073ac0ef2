//! 23 teeth drive 47: two made-up reduced gears, the wheel solid or with six holes, which do not divide its teeth. No
//! finite elements.
#![allow(clippy::unwrap_used, dead_code, missing_docs)]

use std::f64::consts::TAU;
use std::path::Path;

use gearmesh_geometry::GearDefinition;
use gearmesh_geometry::input::InputDocument;
use gearmesh_model::{Flank, GaugeRows, ReducedGear, write_reduced_gear};

use super::pair_common::made_up_gear;

pub const TEETH: [usize; 2] = [23, 47];
pub const HOLES: usize = 6;
const WIDTH_M: f64 = 20e-3;

/// How much softer or stiffer a tooth over a hole is.
const OVER_HOLES: f64 = 0.1;

/// The gear file of the made-up gears; `openings` is put behind the blank.
pub fn gear_file(teeth: usize, blank: &str) -> String {
    format!(
        "name = \"made up {teeth}\"\n[tooth]\nteeth = {teeth}\nmodule_mm = 3.0\nface_width_mm = 20.0\nthickness_allowance_mm = 0.1\n\
         [blank]\nbore_diameter_mm = 30.0\n{blank}[material]\nyoung_GPa = 210.0\npoisson = 0.3\ndensity_kg_per_m3 = 7850.0\n"
    )
}

pub const SOLID: &str = "kind = \"solid\"\n";
pub const DRILLED: &str = "kind = \"thin-rim\"\nhub_diameter_mm = 50.0\nrim_inner_diameter_mm = 124.0\nweb_thickness_mm = 6.0\n\
    [blank.holes]\ncount = 6\npitch_circle_diameter_mm = 88.0\ndiameter_mm = 20.0\nphase_deg = 0.0\n";

/// A gauge on a tooth that feels its own tooth most and its neighbours a little, more so near the tip.
fn gauge(model: &ReducedGear, tooth: usize) -> GaugeRows {
    let loads = model.grid.len();
    let axial = model.grid.z_m.len();
    let teeth = model.teeth;
    let adjoint = (0..teeth * loads * 3).map(|i| {
        let (component, load, of) = (i % 3, i / 3 % loads, i / 3 / loads);
        let apart = (of + teeth - tooth) % teeth;
        let apart = apart.min(teeth - apart);
        let height = 0.2 + (load / axial) as f64;
        match (component, apart) {
            (0, 0) => 1e-8 * height,
            (0, 1) => -2e-9 * height,
            _ => 0.0,
        }
    });
    GaugeRows {
        name: format!("g{tooth}"),
        tooth,
        side: Flank::Right,
        description: "made up".into(),
        error_estimate_relative: 0.01,
        adjoint: adjoint.collect(),
        own_tooth: vec![0.0; loads],
    }
}

/// A reduced gear with gauges on teeth 0 and 5; with `holes`, teeth over a hole are softer than those between two.
pub fn model(teeth: usize, holes: Option<usize>) -> ReducedGear {
    let text = gear_file(teeth, if holes.is_some() { DRILLED } else { SOLID });
    let gear = GearDefinition::from_document(&InputDocument::new("made up", text)).unwrap();
    let mut model = ReducedGear {
        name: format!("made up {teeth}"),
        input: gearmesh_model::StoredGear::new(gear.clone()),
        near_field: None,
        ..made_up_gear(&gear.profile, WIDTH_M, 1)
    };
    if let Some(holes) = holes {
        let weight =
            |tooth: usize| 1.0 + OVER_HOLES * (TAU * (holes * tooth) as f64 / teeth as f64).cos();
        let block = model.grid.len() * model.grid.len();
        let solid = std::mem::take(&mut model.c_hub);
        for load in 0..teeth {
            for response in 0..teeth {
                let factor = weight(load) * weight(response);
                let apart = (response + teeth - load) % teeth;
                model
                    .c_hub
                    .extend(solid[apart * block..][..block].iter().map(|c| factor * c));
            }
        }
        model.sectors = 1;
    }
    model.gauges = vec![gauge(&model, 0), gauge(&model, 5)];
    model
}

/// Writes `pinion.h5`, `wheel.h5` and `drilled.h5`.
pub fn write_models(folder: &Path) {
    for (name, teeth, holes) in [
        ("pinion", TEETH[0], None),
        ("wheel", TEETH[1], None),
        ("drilled", TEETH[1], Some(HOLES)),
    ] {
        write_reduced_gear(&folder.join(format!("{name}.h5")), &model(teeth, holes)).unwrap();
    }
}

/// A scene of the pinion with `wheel` or `drilled`; `run` are keys of its table \[run\], `further` stands behind.
pub fn scene(wheel: &str, run: &str, further: &str) -> String {
    format!(
        r#"title = "23 and 47"
[pair]
gear_1 = "pinion.h5"
gear_2 = "{wheel}.h5"
centre_distance_mm = 105.0
[mesh]
model.kind = "hybrid"
model.local = "weber-banaschek"
teeth.path = "line-of-action"
[run]
torques_Nm = [200.0]
{run}
{further}"#
    )
}

/// The pinion drives the drilled wheel in time, slowly enough to be near rest; right flanks.
pub fn scene_in_time(end_s: f64) -> String {
    let gear = |name: &str, model: &str, x_mm: f64| {
        format!(
            "[[body]]\nname = \"{name}\"\ngear = \"{model}.h5\"\nmass_kg = 1.0\ninertia_kg_m2 = [1e-3, 1e-3, 2e-3]\nposition_mm = [{x_mm:?}, 0, 0]\n\
             [[joint]]\nname = \"axle of {name}\"\nkind = \"revolute\"\nbody_2 = \"{name}\"\n"
        )
    };
    format!(
        "title = \"23 and 47 in time\"\n[run]\nkind = \"transient\"\nend_s = {end_s:?}\n[solver]\nstep_s = 4e-5\nstart = \"equilibrium\"\n\
         [output]\ninterval_s = 2e-4\n{}{}[[motion]]\njoint = \"axle of pinion\"\nspeed_rpm = -300.0\n[[load]]\nbody = \"wheel\"\ntorque_Nm = -200.0\n\
         [[gear_mesh]]\nname = \"mesh\"\ngear_1 = \"pinion\"\ngear_2 = \"wheel\"\nmodel.kind = \"hybrid\"\nmodel.local = \"weber-banaschek\"\nteeth.flanks = \"right\"\n\
         teeth.path = \"line-of-action\"\nmodel.damping = {{ kind = \"stiffness-proportional\", time_s = 5e-5, full_depth_um = 1.0 }}\n",
        gear("pinion", "pinion", 0.0),
        gear("wheel", "drilled", 105.0)
    )
}
