//! Meshed planets and Ravigneaux sets of reduced gears, all meshes of which are solved together.
//!
//! Torques on a set add up to nothing in each position. Their ratios are those of rigid bodies in the mean over a mesh
//! period, as no energy is lost: in between, what gears store while their teeth move on takes torque and gives it back,
//! by some 1e-3 of it, and where tip edges carry, whose normals are others, by up to 2 %.

use std::f64::consts::TAU;

use gearmesh_geometry::GearDefinition;
use gearmesh_model::{ReducedGear, StoredGear, write_reduced_gear};
use nalgebra::Vector2;

use super::meshed::{ahead_rad, arms_m, meshed, unit_forces, write_meshed};
use super::positions::ALPHA_DEG;
use super::ravigneaux::{
    DRIVEN, MEMBERS, TEETH as OF_RAVIGNEAUX, gears, ravigneaux, torques, write_ravigneaux,
};
use super::*;
use crate::made_up_gears::mesh_common::{modal_gear::modal_gear, on_soft_rim};

/// z_s and z_r of the meshed planets.
const TEETH: [usize; 2] = [24, 72];
/// Sums of torques, and turns that are driven.
const WITHIN: f64 = 1e-6;
/// Ratios in the mean over a mesh period, by the rule of the trapezoid in so many positions: with half as many it is
/// off by up to 4e-5.
const IN_THE_MEAN: f64 = 3e-5;
const POSITIONS: usize = 256;
/// Forces and ratios in a position.
const IN_A_POSITION: f64 = 2e-2;

/// Makes a reduced gear on a soft rim of each gear file of a folder, with a face of 20 mm.
fn reduce(folder: &Path) {
    let files = std::fs::read_dir(folder).unwrap();
    for path in files.map(|entry| entry.unwrap().path()) {
        let text = std::fs::read_to_string(&path).unwrap();
        let (before, width) = text.split_once("face_width_mm = ").unwrap();
        let (_, after) = width.split_once('\n').unwrap();
        let text = format!("{before}face_width_mm = 20.0\n{after}");
        std::fs::write(&path, &text).unwrap();
        let definition = GearDefinition::read(&path).unwrap();
        let model = ReducedGear {
            input: StoredGear::of_older_file(text),
            near_field: None,
            ..modal_gear(&definition.name, &definition.profile)
        };
        write_reduced_gear(&path.with_extension("h5"), &on_soft_rim(model)).unwrap();
    }
}

/// A scene with reduced gears in place of gear files, and hybrid meshes; `damping`: keys of their model.
fn of_reduced(text: &str, damping: &str) -> String {
    let spring = "kind = \"iso6336\", stiffness_N_per_mm_um = 20.0 }";
    assert!(text.contains(spring));
    let hybrid = format!("kind = \"hybrid\", local = \"weber-banaschek\"{damping} }}");
    text.replace(".toml\"", ".h5\"").replace(spring, &hybrid)
}

const DAMPED: &str =
    ", damping = { kind = \"stiffness-proportional\", time_s = 1e-6, full_depth_um = 1.0 }";

/// A set of three pairs with 400 N m on the carrier, sun driven and ring held; keys of planets and of partners.
fn pairs(run: &str, planets: &str, partners: &str) -> String {
    let carrier = "torque_Nm = 400.0";
    let planets = format!("count = 3\n{planets}");
    let parts = [
        "speed_rpm = 0.0",
        "support = \"held\"",
        carrier,
        &planets,
        partners,
    ];
    meshed(run, TEETH, parts)
}

/// Positions over a mesh period of so many degrees of what is driven.
fn over_a_period(driven: &str, period_deg: f64) -> String {
    let angle = |k: usize| period_deg * k as f64 / POSITIONS as f64;
    let angles: Vec<f64> = (0..POSITIONS).map(angle).collect();
    format!("kind = \"static\"\nmotion = \"{driven} speed\"\nangles_deg = {angles:?}")
}

/// That torques are those of rigid bodies, in each position and in the mean.
fn assert_torque(found: &[f64], expected: f64, what: &str) {
    for found in found {
        let off = found / expected - 1.0;
        assert!(off.abs() < IN_A_POSITION, "{what}: {found} {expected}");
    }
    let off = found.iter().sum::<f64>() / found.len() as f64 / expected - 1.0;
    assert!(off.abs() < IN_THE_MEAN, "{what}: {off:e} off, {found:?}");
}

/// In phase at equal angles all pairs carry the same; what is left of the forces of two meshes is what the pin carries.
/// The carrier deflects in the sense of its torque, by another amount where planets and partners feel both their
/// meshes.
#[test]
fn meshed_planets_of_reduced_gears_are_in_equilibrium() {
    let folder = tempfile::tempdir().unwrap();
    write_meshed(folder.path(), TEETH);
    reduce(folder.path());
    // The sun turns 1.5 times as fast against the carrier.
    let kind = over_a_period("set sun", 360.0 / 24.0 / 1.5);
    let own = "coupling = \"own-mesh\"";
    let deflection_rad = |keys: &str| -> Vec<f64> {
        let result = run(&of_reduced(&pairs(&kind, keys, keys), ""), folder.path());
        let read = |name: &str| result.rows.read(name).unwrap();
        let [sun, ring] = ["sun speed", "ring axis"]
            .map(|member| read(&format!("joints/set {member}/moment_z_Nm")));
        for (sun, ring) in sun.iter().zip(&ring) {
            assert!((sun + ring + 400.0).abs() < WITHIN * 600.0, "{sun} {ring}");
        }
        assert_torque(&sun, 200.0, "sun");
        assert_torque(&ring, -600.0, "ring");
        let force = 200.0 / (3.0 * 36e-3 * ALPHA_DEG.to_radians().cos());
        let turned = read("bodies/set carrier/turn_rad");
        for n in 1..=3 {
            for mesh in [
                format!("sun-planet {n}/normal_force_left_N"),
                format!("planet {n}-partner/normal_force_right_N"),
                format!("partner {n}-ring/normal_force_left_N"),
            ] {
                for found in read(&format!("elements/set {mesh}")) {
                    let off = found / force - 1.0;
                    assert!(off.abs() < IN_A_POSITION, "{mesh}: {found} {force}");
                }
            }
            for (number, planet) in ["planet", "partner"].into_iter().enumerate() {
                let [x, y] = ["x", "y"]
                    .map(|axis| read(&format!("joints/set {planet} {n} pin/force_world_{axis}_N")));
                for ((x, y), carrier_rad) in x.into_iter().zip(y).zip(&turned) {
                    let angle = TAU * f64::from(n - 1) / 3.0 + carrier_rad;
                    let meshes = unit_forces(angle, ahead_rad(TEETH), arms_m(TEETH), 1.0)[number];
                    let rest = Vector2::new(x, y) + force * meshes;
                    assert!(
                        rest.norm() < 2.0 * IN_A_POSITION * force,
                        "{planet} {n}: {rest}"
                    );
                }
            }
        }
        // φ_c = −φ_s/2 where nothing deflects.
        let sun_rad = read("bodies/set sun/turn_rad");
        let both = sun_rad.iter().zip(&turned);
        both.map(|(sun, carrier)| carrier + 0.5 * sun).collect()
    };
    let (together, apart) = (deflection_rad(""), deflection_rad(own));
    let mean = |of: &[f64]| of.iter().sum::<f64>() / of.len() as f64;
    let most = together.iter().chain(&apart);
    assert!(most.into_iter().all(|turn| (1e-6..1e-3).contains(turn)));
    let changes = mean(&together) / mean(&apart) - 1.0;
    assert!(changes.abs() > 1e-3, "{changes:e}");
}

/// The three meshes of a pair carry the same, whatever its pin is displaced by, and all pairs together the torque; the
/// pair whose partner is farther on, where the carrier's torque pushes it against ring and planet, carries more. A
/// displaced partner has other pressure angles, by 1e-5 m in some 0.06 m.
#[test]
fn a_displaced_pair_of_reduced_gears_carries_the_same_in_its_three_meshes() {
    let folder = tempfile::tempdir().unwrap();
    write_meshed(folder.path(), TEETH);
    reduce(folder.path());
    let kind = "kind = \"static\"";
    let force = 200.0 / (3.0 * 36e-3 * ALPHA_DEG.to_radians().cos());
    for (tangential_um, side) in [(10.0, 1.0), (-10.0, -1.0)] {
        let deviation =
            format!("deviation = [{{ planet = 2, tangential_um = {tangential_um:?} }}]");
        let result = run(&of_reduced(&pairs(kind, "", &deviation), ""), folder.path());
        let read = |name: String| result.rows.read(&name).unwrap()[0];
        let mut sum = 0.0;
        for n in 1..=3 {
            let own = [
                format!("sun-planet {n}/normal_force_left_N"),
                format!("planet {n}-partner/normal_force_right_N"),
                format!("partner {n}-ring/normal_force_left_N"),
            ];
            let own = own.map(|mesh| read(format!("elements/set {mesh}")));
            for other in &own[1..] {
                let off = other / own[0] - 1.0;
                assert!(off.abs() < IN_A_POSITION, "{n}: {own:?}");
            }
            let more = side * (own[0] / force - 1.0);
            let is_displaced = n == 2;
            assert_eq!(more > 0.0, is_displaced, "{tangential_um} {n}: {own:?}");
            assert!(
                more.abs() > 5.0 * IN_A_POSITION,
                "{tangential_um} {n}: {own:?}"
            );
            sum += own[0];
        }
        let off = sum / (3.0 * force) - 1.0;
        assert!(off.abs() < IN_A_POSITION, "{sum}");
    }
}

/// A hundred steps from the equilibrium on: the ratio is kept but for what deflections change, meshes stay closed, and
/// energy balances.
#[test]
fn meshed_planets_of_reduced_gears_run_in_time() {
    let folder = tempfile::tempdir().unwrap();
    write_meshed(folder.path(), TEETH);
    reduce(folder.path());
    let keys = "kind = \"transient\"\nend_s = 5e-4\n[solver]\nstep_s = 5e-6\nstart = \"equilibrium\"\n[output]\ninterval_s = 1e-4";
    let text = changed(&pairs(keys, "", ""), "speed_rpm = 0.0", "speed_rpm = 500.0");
    let result = run(&of_reduced(&text, DAMPED), folder.path());
    let read = |name: &str| result.rows.read(name).unwrap();
    let [sun, carrier] =
        ["sun", "carrier"].map(|body| read(&format!("bodies/set {body}/turn_rad")));
    let last = sun.len() - 1;
    let turned = sun[last] - sun[0];
    assert!(
        (turned / (500.0 / 60.0 * TAU * 5e-4) - 1.0).abs() < WITHIN,
        "{turned}"
    );
    let off = carrier[last] - carrier[0] + 0.5 * turned;
    assert!(off.abs() < 5e-5, "{off:e}");
    for n in 1..=3 {
        let forces = read(&format!(
            "elements/set partner {n}-ring/normal_force_left_N"
        ));
        assert!(forces.iter().all(|force| *force > 100.0), "{n}: {forces:?}");
    }
    let error = result.relative_energy_error().unwrap();
    assert!(error < 1e-3, "{error:e}");
}

/// A Ravigneaux set of reduced gears with faces of 20 mm: those of the suns beside each other, each over half of the
/// long planets.
fn short_faced(run: &str, keys: [&str; 6]) -> String {
    ravigneaux(run, keys).replace("17.0", "11.0")
}

/// Torques in all gears are those of the planets' balance, and so are the forces of all meshes.
#[test]
fn torques_of_a_ravigneaux_set_of_reduced_gears_are_in_equilibrium() {
    let folder = tempfile::tempdir().unwrap();
    write_ravigneaux(folder.path());
    reduce(folder.path());
    let [z_large, z_small, z_ring] = OF_RAVIGNEAUX;
    for gear in gears() {
        let driven = gear.keys.iter().position(|keys| *keys == DRIVEN).unwrap();
        let still = gear.keys.map(|keys| match keys == DRIVEN {
            true => "speed_rpm = 0.0",
            false => keys,
        });
        let [large, ring, carrier, small] = still;
        // All meshes have the period of the large sun against the carrier.
        let period_deg = 360.0 / z_large / (gear.speeds[0] - gear.speeds[2]).abs();
        let kind = over_a_period(MEMBERS[driven], period_deg);
        let text = short_faced(&kind, [large, ring, carrier, small, gear.first, ""]);
        let result = run(&of_reduced(&text, ""), folder.path());
        let read = |name: &str| result.rows.read(name).unwrap();
        let torques = torques(gear.torques, OF_RAVIGNEAUX);
        let mut all = vec![0.0; POSITIONS];
        for (member, torque) in torques.into_iter().enumerate() {
            let joint = match gear.keys[member] {
                DRIVEN => format!("{} speed", MEMBERS[member]),
                "support = \"held\"" => format!("{} axis", MEMBERS[member]),
                _ => {
                    all.iter_mut().for_each(|sum| *sum += torque);
                    continue;
                }
            };
            let found = read(&format!("joints/{joint}/moment_z_Nm"));
            assert_torque(&found, torque, &format!("{:?} {joint}", gear.keys));
            all.iter_mut().zip(found).for_each(|(sum, own)| *sum += own);
        }
        for sum in all {
            assert!(sum.abs() < WITHIN * 200.0, "{:?}: {sum}", gear.keys);
        }
        let base_m = |teeth: f64| 1.5e-3 * teeth * ALPHA_DEG.to_radians().cos();
        for (mesh, torque, teeth) in [
            ("set sun-planet {}", torques[0], z_large),
            ("set planet {}-ring", torques[1], z_ring),
            ("rear sun-planet {}", torques[3], z_small),
            ("rear planet {}-partner", torques[3], z_small),
        ] {
            let of = |n: usize, side: &str| {
                let mesh = mesh.replace("{}", &n.to_string());
                read(&format!("elements/{mesh}/normal_force_{side}_N"))
            };
            let all = (1..=3).flat_map(|n| ["left", "right"].map(|side| of(n, side)));
            let mut sums = vec![0.0; POSITIONS];
            for forces in all {
                sums.iter_mut()
                    .zip(forces)
                    .for_each(|(sum, force)| *sum += force);
            }
            let expected = torque.abs() / base_m(teeth);
            for sum in sums {
                let off = sum / expected - 1.0;
                assert!(
                    off.abs() < IN_A_POSITION,
                    "{:?} {mesh}: {sum} {expected}",
                    gear.keys
                );
            }
        }
    }
}

/// In first gear a hundred steps from the equilibrium on.
#[test]
fn a_ravigneaux_set_of_reduced_gears_runs_in_time() {
    let folder = tempfile::tempdir().unwrap();
    write_ravigneaux(folder.path());
    reduce(folder.path());
    let keys = "kind = \"transient\"\nend_s = 5e-4\n[solver]\nstep_s = 5e-6\nstart = \"equilibrium\"\n[output]\ninterval_s = 1e-4";
    let gear = &gears()[0];
    let [large, ring, carrier, small] = gear.keys;
    let text = short_faced(keys, [large, ring, carrier, small, gear.first, ""]);
    let result = run(&of_reduced(&text, DAMPED), folder.path());
    let read = |name: &str| result.rows.read(name).unwrap();
    let turned = |body: &str| {
        let turn = read(&format!("bodies/{body}/turn_rad"));
        turn[turn.len() - 1] - turn[0]
    };
    let driven = turned("rear sun");
    assert!(
        (driven / (300.0 / 60.0 * TAU * 5e-4) - 1.0).abs() < WITHIN,
        "{driven}"
    );
    let off = turned("set ring") - OF_RAVIGNEAUX[1] / OF_RAVIGNEAUX[2] * driven;
    assert!(off.abs() < 5e-5, "{off:e}");
    let error = result.relative_energy_error().unwrap();
    assert!(error < 1e-3, "{error:e}");
}
