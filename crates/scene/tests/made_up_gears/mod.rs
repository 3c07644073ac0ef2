//! Scenes of two made-up reduced gears with modes and gauges, 30/41 teeth of module 3 mm, as model files in a folder of
//! their own: what needs a model, but no finite elements.
#![allow(clippy::unwrap_used, dead_code, missing_docs)]

#[path = "../../../drivetrain/tests/mesh_common/mod.rs"]
pub mod mesh_common;

pub mod drilled_pair;

pub use mesh_common::pair_common;

use std::path::Path;

use gearmesh_geometry::GearPair;
use gearmesh_model::{ReducedGear, StoredGear, write_reduced_gear};
use mesh_common::modal_gear::modal_gear;

/// Young's modulus of the models [Pa].
pub const YOUNG_PA: f64 = 210e9;

/// The gear file whose teeth the made-up model has.
pub fn gear_file(teeth: usize, profile_shift: f64) -> String {
    format!(
        "name = \"made up {teeth}\"\n[tooth]\nteeth = {teeth}\nmodule_mm = 3.0\nprofile_shift = {profile_shift:?}\nrack_tip_radius = 0.25\n\
         thickness_allowance_mm = 0.1\nface_width_mm = 20.0\n[blank]\nkind = \"solid\"\nbore_diameter_mm = 30.0\n[material]\n\
         young_GPa = 210.0\npoisson = 0.3\ndensity_kg_per_m3 = 7850.0\n"
    )
}

/// The pair of the scenes.
pub fn pair() -> GearPair {
    mesh_common::spur_pair()
}

/// Writes `gear_30.h5` and `gear_41.h5`.
pub fn write_models(folder: &Path) {
    let pair = pair();
    for (teeth, shift, profile) in [(30, 0.2, &pair.gear_1), (41, -0.1, &pair.gear_2)] {
        let model = ReducedGear {
            input: StoredGear::of_older_file(gear_file(teeth, shift)),
            near_field: None,
            ..modal_gear(&format!("made up {teeth}"), profile)
        };
        write_reduced_gear(&folder.join(format!("gear_{teeth}.h5")), &model).unwrap();
    }
}

/// Writes `gear_24.h5` and `gear_75.h5`: a planet and its ring ([`pair_common::ring_pair`]) of one hand.
pub fn write_planet_and_ring(folder: &Path, helix_deg: f64) {
    let pair = pair_common::ring_pair(helix_deg, false);
    let helix = match helix_deg {
        0.0 => String::new(),
        right if right > 0.0 => format!("helix_angle_deg = {right:?}\nhand = \"right\"\n"),
        left => format!("helix_angle_deg = {:?}\nhand = \"left\"\n", -left),
    };
    let planet = gear_file(24, 0.2).replace("[blank]", &format!("{helix}[blank]"));
    let ring = format!(
        "name = \"made up ring\"\n[tooth]\nteeth = -75\nmodule_mm = 3.0\nprofile_shift = -0.2\naddendum = 0.75\nthickness_allowance_mm = 0.1\n\
         face_width_mm = 20.0\n{helix}[tooth.cutter]\nteeth = 27\nprofile_shift = 0.1\naddendum = 1.25\ntip_radius = 0.25\n[blank]\n\
         kind = \"ring\"\nouter_diameter_mm = 260.0\n[material]\nyoung_GPa = 210.0\npoisson = 0.3\ndensity_kg_per_m3 = 7850.0\n"
    );
    for (teeth, file, profile) in [(24, planet, &pair.gear_1), (75, ring, &pair.gear_2)] {
        let model = ReducedGear {
            input: StoredGear::of_older_file(file),
            near_field: None,
            ..modal_gear(&format!("made up {teeth}"), profile)
        };
        write_reduced_gear(&folder.join(format!("gear_{teeth}.h5")), &model).unwrap();
    }
}

/// Writes `sun.h5`, `planet.h5` and `ring.h5`: 27, 24 and 75 teeth at 76.5 mm, on soft rims.
pub fn write_set(folder: &Path) {
    write_planet_and_ring(folder, 0.0);
    let sun = mesh_common::pair_common::tooth(27, -0.2, 0.0);
    let sun = gearmesh_geometry::ToothGeometry::new(&sun).unwrap();
    let sun = ReducedGear {
        input: StoredGear::of_older_file(gear_file(27, -0.2)),
        near_field: None,
        ..modal_gear("made up 27", &sun)
    };
    let read = |teeth: usize| {
        let path = folder.join(format!("gear_{teeth}.h5"));
        gearmesh_model::read_reduced_gear(&path).unwrap()
    };
    for (name, gear) in [("sun", sun), ("planet", read(24)), ("ring", read(75))] {
        let gear = mesh_common::on_soft_rim(gear);
        write_reduced_gear(&folder.join(format!("{name}.h5")), &gear).unwrap();
    }
}

/// The gear with motions of its bore of this stiffness [N/m], each of which moves every load by as much.
pub fn with_bore(gear: ReducedGear, stiffness: f64, moved: f64) -> ReducedGear {
    let mut bore = gearmesh_model::BorePatterns {
        harmonics: 2,
        along: 2,
        components: 3,
        radius_m: 15e-3,
        ends_m: [-0.5 * gear.face_width_m, 0.5 * gear.face_width_m],
        ..Default::default()
    };
    let motions = bore.count();
    let loads = gear.teeth_per_sector() * gear.flanks.len() * gear.grid.len();
    let diagonal = |k: usize| {
        if k / motions == k % motions {
            stiffness
        } else {
            0.0
        }
    };
    bore.stiffness = (0..motions * motions).map(diagonal).collect();
    bore.flank = vec![moved; loads * motions];
    bore.gauges = vec![0.0; gear.gauges.len() * motions];
    ReducedGear {
        bore: Some(bore),
        ..gear
    }
}

/// Gear 1 drives at `speed_rpm` against 100 N m on gear 2; `of_gear_2` is put into its `[[body]]`, `further` at the
/// end.
pub fn scene(run: &str, speed_rpm: f64, of_gear_2: &str, further: &str) -> String {
    format!(
        r#"title = "made up"
{run}
[[body]]
name = "pinion"
gear = "gear_30.h5"
[[body]]
name = "wheel"
gear = "gear_41.h5"
position_mm = [106.8, 0.0, 0.0]
{of_gear_2}
[[joint]]
name = "axle 1"
kind = "revolute"
body_2 = "pinion"
[[joint]]
name = "axle 2"
kind = "revolute"
body_2 = "wheel"
[[motion]]
name = "drive"
joint = "axle 1"
speed_rpm = {speed_rpm:?}
[[load]]
body = "wheel"
torque_Nm = -100.0
[[gear_mesh]]
name = "mesh"
gear_1 = "pinion"
gear_2 = "wheel"
model.kind = "hybrid"
model.local = "weber-banaschek"
model.damping = {{ kind = "stiffness-proportional", time_s = 1e-6, full_depth_um = 1.0 }}
{further}"#
    )
}
