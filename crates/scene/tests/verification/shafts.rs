//! Beam shafts: trains over them, and their stiffness.

use std::f64::consts::{PI, TAU};

use gearmesh_dynamics::{StaticParams, equilibrium};

use crate::common::*;
use crate::{assert_labelled, body, spin};

const TRAIN: &str = r#"
title = "Train"
[run]
kind = "static"
[[body]]
name = "a"
gear = "gear1.toml"
mass_kg = 2.0
inertia_kg_m2 = [4e-3, 4e-3, 7e-3]
speed_rpm = -300.0
[[body]]
name = "b"
gear = "gear1.toml"
mass_kg = 2.0
inertia_kg_m2 = [4e-3, 4e-3, 7e-3]
[[body]]
name = "c"
gear = "gear1.toml"
mass_kg = 2.0
inertia_kg_m2 = [4e-3, 4e-3, 7e-3]
[[body]]
name = "d"
gear = "gear1.toml"
mass_kg = 2.0
inertia_kg_m2 = [4e-3, 4e-3, 7e-3]
position_mm = [300.0, 0.0, 100.0]
[[joint]]
name = "axle a"
kind = "revolute"
body_2 = "a"
[[joint]]
name = "axle d"
kind = "revolute"
body_2 = "d"
[[shaft]]
name = "lay"
model = { kind = "beam", young_GPa = 206.0, poisson = 0.3 }
origin_mm = [150.0, 0.0, 0.0]
stations_mm = [-50.0, 0.0, 100.0, 150.0]
outer_diameters_mm = [40.0, 50.0, 40.0]
inner_diameters_mm = [0.0, 20.0, 0.0]
density_kg_per_m3 = 7850.0
[[shaft.part]]
station = 3
mass_kg = 1.5
inertia_kg_m2 = [1e-3, 1e-3, 2e-3]
[[shaft.seat]]
station = 1
body = "b"
[[shaft.seat]]
station = 2
body = "c"
[[bearing]]
name = "left"
body_2 = "lay/0"
model = { kind = "linear", radial_stiffness_N_per_mm = 1e5, axial_stiffness_N_per_mm = 1e5 }
[[bearing]]
name = "right"
body_2 = "lay/3"
model = { kind = "linear", radial_stiffness_N_per_mm = 1e5 }
[[gear_mesh]]
name = "first"
gear_1 = "a"
gear_2 = "b"
teeth = { friction = { model = "coulomb", dynamic_coefficient = 0.05 } }
[gear_mesh.model]
kind = "analytic"
slices = 3
damping = { kind = "viscous", damping_N_s_per_mm = 1.0, full_depth_um = 1.0 }
[[gear_mesh]]
name = "second"
gear_1 = "c"
gear_2 = "d"
model = { kind = "iso6336", stiffness_amplitude = 0.1 }
teeth = { flanks = "left" }
microgeometry = false
"#;

/// A lay shaft passes the speed on, its mass is all there, and the second mesh drives on left flanks because its gear 1
/// turns the other way.
#[test]
fn a_train_over_a_beam_shaft() {
    let built = build(TRAIN).unwrap();
    assert_labelled(&built);
    let names: Vec<&str> = built.bodies.iter().map(|body| &*body.name).collect();
    assert_eq!(names, ["a", "b", "c", "d", "lay/0", "lay/3"]);
    let omega = 300.0 * TAU / 60.0;
    for (name, sign) in [
        ("a", -1.0),
        ("b", 1.0),
        ("lay/0", 1.0),
        ("lay/3", 1.0),
        ("c", 1.0),
        ("d", -1.0),
    ] {
        assert!((spin(&built, name) - sign * omega).abs() < 1e-12, "{name}");
    }
    let tube = |outer: f64, inner: f64, length: f64| {
        7850.0 * 0.25 * PI * (outer * outer - inner * inner) * length
    };
    let steel = tube(0.04, 0.0, 0.1) + tube(0.05, 0.02, 0.1);
    let total: f64 = built.system.bodies().iter().map(|body| body.mass_kg).sum();
    assert!((total - (8.0 + 1.5 + steel)).abs() < 1e-12);
    let polar = |outer: f64, inner: f64, length: f64| {
        tube(outer, inner, length) * (outer * outer + inner * inner) / 8.0
    };
    let polar_all = polar(0.04, 0.0, 0.1) + polar(0.05, 0.02, 0.1);
    let total: f64 = built
        .system
        .bodies()
        .iter()
        .map(|body| body.inertia_kg_m2[(2, 2)])
        .sum();
    assert!((total - (4.0 * 7e-3 + 2e-3 + polar_all)).abs() < 1e-15);
    let seat = body(&built, "c");
    assert!((seat.position_m - nalgebra::Vector3::new(0.15, 0.0, 0.1)).norm() < 1e-15);
    let touching: Vec<&String> = built
        .notes
        .iter()
        .filter(|note| note.contains("touch"))
        .collect();
    assert!(
        touching[0].contains("`b`") && touching[0].contains("right flanks of mesh `first`"),
        "{touching:?}"
    );
    assert!(
        touching[1].contains("`d`") && touching[1].contains("left flanks of mesh `second`"),
        "{touching:?}"
    );
    let effect = |name: &str| {
        built
            .effects
            .iter()
            .find(|effect| effect.name == name)
            .unwrap()
            .computed
            .clone()
    };
    assert_eq!(
        effect("mesh `first`: friction").as_deref(),
        Some("`coulomb`, regularised")
    );
    assert_eq!(effect("mesh `second`: friction"), None);
    assert_eq!(effect("weight"), None);
}

/// Twist of a stepped shaft under a torque: Σ T L/(G I_t).
#[test]
fn a_beam_shaft_twists_as_the_closed_form_says() {
    let scene = r#"
        title = "Torsion bar"
        [run]
        kind = "static"
        [[body]]
        name = "disc"
        mass_kg = 1.0
        inertia_kg_m2 = [1e-3, 1e-3, 2e-3]
        [[shaft]]
        name = "bar"
        model = { kind = "beam", young_GPa = 210.0, poisson = 0.3 }
        origin_mm = [0.0, 0.0, 0.0]
        axis = [1.0, 0.0, 0.0]
        stations_mm = [0.0, 200.0, 500.0]
        outer_diameters_mm = [20.0, 16.0]
        density_kg_per_m3 = 7850.0
        [[shaft.seat]]
        station = 2
        body = "disc"
        [[joint]]
        name = "wall"
        kind = "fixed"
        body_2 = "bar/0"
        [[load]]
        body = "disc"
        torque_Nm = 40.0
    "#;
    let built = build(scene).unwrap();
    let mut system = built.system;
    let start = system.start().clone();
    let found = equilibrium(&mut system, &start, &StaticParams::default()).unwrap();
    let turned = (start.orientations[0].inverse() * found.state.orientations[0]).scaled_axis();
    let shear = 210e9 / 2.6;
    let twist: f64 = [(0.02f64, 0.2), (0.016, 0.3)]
        .iter()
        .map(|(d, l)| 40.0 * l / (shear * PI / 32.0 * d.powi(4)))
        .sum();
    assert!((turned[2] / twist - 1.0).abs() < 1e-9, "{turned:?} {twist}");
    let half = build(&scene.replace(
        "torque_Nm = 40.0",
        "torque_Nm = { sum = [20.0, { sine = { amplitude = 3.0, frequency_Hz = 5.0 } }] }",
    ))
    .unwrap();
    let found = equilibrium(&mut { half.system }, &start, &StaticParams::default()).unwrap();
    let turned = (start.orientations[0].inverse() * found.state.orientations[0]).scaled_axis();
    assert!((turned[2] / (0.5 * twist) - 1.0).abs() < 1e-9);
}

const CUT: &str = "name = \"cut\"\n[tooth]\nteeth = 17\nmodule_mm = 3.0\nprofile_shift = 0.2\nface_width_mm = 30.0\n[blank]\nkind = \"solid\"\n\
    bore_diameter_mm = 0\nshaft_diameter_mm = [28, 32]\n[material]\nyoung_GPa = 210.0\npoisson = 0.3\ndensity_kg_per_m3 = 7850.0\n";

const CUT_SCENE: &str = r#"
title = "Pinion shaft"
[run]
kind = "static"
[[body]]
name = "pinion"
gear = "cut.toml"
[[shaft]]
name = "bar"
model = { kind = "beam", young_GPa = 210.0, poisson = 0.3 }
origin_mm = [0.0, 0.0, 0.0]
stations_mm = [-55.0, 0.0, 65.0]
outer_diameters_mm = [28.0, 32.0]
density_kg_per_m3 = 7850.0
[[shaft.seat]]
station = 1
body = "pinion"
[[joint]]
name = "wall"
kind = "fixed"
body_2 = "bar/2"
[[load]]
body = "pinion"
torque_Nm = 40.0
"#;

/// A pinion cut into its shaft: the core is in the gear, once. The shaft's mass is that beyond the faces, 40 and 50 mm
/// of it, and so is its twist; what the core twists is in the reduced gear. No station may lie within the face.
#[test]
fn the_core_of_a_pinion_cut_into_its_shaft_counts_once() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("cut.toml"), CUT).unwrap();
    let built = build_in(CUT_SCENE, folder.path()).unwrap();
    let gear = gearmesh_geometry::GearDefinition::from_document(
        &gearmesh_geometry::input::InputDocument::new("cut.toml", CUT.to_owned()),
    )
    .unwrap();
    let core = gearmesh_drivetrain::gear_inertia::GearInertia::new(
        &gear.profile,
        &gear.blank,
        0.03,
        7850.0,
    )
    .unwrap();
    let solid = gearmesh_geometry::Blank::solid(1e-9);
    let whole =
        gearmesh_drivetrain::gear_inertia::GearInertia::new(&gear.profile, &solid, 0.03, 7850.0)
            .unwrap();
    assert!((core.mass_kg / whole.mass_kg - 1.0).abs() < 1e-12);
    let bodies = built.system.bodies();
    let tube = |d: f64, length: f64| 7850.0 * 0.25 * PI * d * d * length;
    let mass: f64 = bodies.iter().map(|body| body.mass_kg).sum();
    assert!(
        (mass - core.mass_kg - tube(0.028, 0.04) - tube(0.032, 0.05)).abs() < 1e-9,
        "{mass}"
    );
    let polar: f64 = bodies.iter().map(|body| body.inertia_kg_m2[(2, 2)]).sum();
    let of = |d: f64, length: f64| tube(d, length) * d * d / 8.0;
    assert!((polar - core.polar_kg_m2 - of(0.028, 0.04) - of(0.032, 0.05)).abs() < 1e-12);
    let mut system = built.system;
    let start = system.start().clone();
    let found = equilibrium(&mut system, &start, &StaticParams::default()).unwrap();
    let turned = (start.orientations[0].inverse() * found.state.orientations[0]).scaled_axis();
    let twist = 40.0 * 0.05 / (210e9 / 2.6 * PI / 32.0 * 0.032f64.powi(4));
    assert!((turned[2] / twist - 1.0).abs() < 1e-9, "{turned:?} {twist}");
    let close = changed(CUT_SCENE, "[-55.0, 0.0, 65.0]", "[-55.0, 0.0, 15.0]");
    let error = build_in(&close, folder.path()).err().unwrap().to_string();
    assert!(error.contains("put no station within its face"), "{error}");
    let error = error.replace('\n', " ");
    assert!(
        error.contains("stations_mm") && error.contains("`pinion`"),
        "{error}"
    );
}
