//! Errors of pins, members and planets: sign, amplitude and order of their effect on mesh forces and transmission
//! error, against springs with gaps (`positions.rs`).

use std::f64::consts::TAU;

use nalgebra::Vector2;

use super::positions::*;
use super::*;

/// Which part an error displaces, all or one of the planets, and in which frame.
#[derive(Clone, Copy)]
enum Displaced {
    Sun,
    Ring,
    /// The gear of planet 2 on its body.
    Gear,
    /// The pin of planet 2, by radial and tangential parts.
    Pin,
    /// All pins, in the carrier's frame.
    Pins,
}

/// Runout of sun, ring and planet, a pin beside its place and an eccentric carrier, with the sun driven or held, the
/// carrier driven or loaded, the ring held, driven or loaded: the force of every planet and the transmission error in
/// five positions, 3.7 mesh periods apart. What springs leave out is the change of the lines of action by displaced
/// axes, e/(a sin α) of the forces: three times that is allowed, for lines of both meshes and of the force's arm.
#[test]
fn displaced_gears_and_pins_do_what_springs_with_gaps_do() {
    let folder = tempfile::tempdir().unwrap();
    write_gears(folder.path(), [24, 36], ALPHA_DEG);
    let table = "offset_um = 20.0, direction_deg = 30.0";
    let mesh = |which: &str, gear: usize| {
        let mesh = format!("{which}_mesh = {{ ");
        let with = format!("{mesh}teeth = {{ eccentricity_{gear} = {{ {table} }} }}, ");
        [mesh, with]
    };
    let own = |text: &str| [String::new(), text.to_owned()];
    let deviation = |keys: &str| format!("count = 3\ndeviation = [{{ planet = 2, {keys} }}]");
    let count = "count = 3".to_owned();
    let (at_30, force) = (20e-6 * unit(TAU / 12.0), 1.5e4);
    for (displaced, planets, more, by) in [
        (Displaced::Sun, &count, mesh("sun", 1), at_30),
        (Displaced::Ring, &count, mesh("ring", 2), at_30),
        (
            Displaced::Gear,
            &deviation(&format!("eccentricity = {{ {table} }}")),
            own(""),
            at_30,
        ),
        (
            Displaced::Pin,
            &deviation("radial_um = 12.0, tangential_um = -16.0"),
            own(""),
            Vector2::new(12e-6, -16e-6),
        ),
        (
            Displaced::Pins,
            &count,
            own(&format!("carrier_eccentricity = {{ {table} }}")),
            at_30,
        ),
    ] {
        for drive in drives(force) {
            let [of, with] = &more;
            let text = match of.is_empty() {
                true => of_drive(&drive, (planets, with), (5, 3.7)),
                false => of_drive(&drive, (planets, ""), (5, 3.7)).replacen(of, with, 1),
            };
            let rows = Rows::of(&text, drive.sense, folder.path());
            let carrier = rows.turns("carrier");
            let turned = |part: &str, row: usize| unit(rows.stands(part)[row]);
            let rotated =
                |e: Vector2<f64>| Vector2::new(e.x * by.x - e.y * by.y, e.y * by.x + e.x * by.y);
            let gap = |n: usize, row: usize| {
                let [f, g] = rows.directions(n, carrier[row]);
                match displaced {
                    Displaced::Sun => -f.dot(&rotated(turned("sun", row))),
                    Displaced::Ring => g.dot(&rotated(turned("ring", row))),
                    Displaced::Gear | Displaced::Pin if n != 1 => 0.0,
                    Displaced::Gear => (f - g).dot(&rotated(turned("planet 2", row))),
                    Displaced::Pin => (f - g).dot(&rotated(unit(TAU / 3.0 + carrier[row]))),
                    Displaced::Pins => (f - g).dot(&rotated(unit(carrier[row]))),
                }
            };
            let allowed = 3.0 * 20e-6 / (ARM_M * ALPHA_DEG.to_radians().sin());
            let [mut largest, mut ends] = [[0.0_f64; 2], [f64::INFINITY, f64::NEG_INFINITY]];
            let approach = rows.approach();
            for (row, near) in approach.iter().enumerate() {
                let gaps: Vec<f64> = (0..3).map(|n| gap(n, row)).collect();
                let mean = gaps.iter().sum::<f64>() / 3.0;
                for (n, own) in gaps.iter().enumerate() {
                    let expected = force + STIFFNESS * (mean - own);
                    largest[0] = largest[0].max((expected - force).abs());
                    for which in ["sun", "ring"] {
                        let found = rows.forces(n, which)[row];
                        assert!(
                            (found - expected).abs() < allowed * 2.0 * force,
                            "{text}\nplanet {}, {which}, row {row}: {found} {expected}",
                            n + 1
                        );
                    }
                }
                largest[1] = largest[1].max(mean.abs());
                let rest = near - mean;
                ends = [ends[0].min(rest), ends[1].max(rest)];
            }
            // The force of the load is F/K; its line changes, too.
            let spread = allowed * 2.0 * force / STIFFNESS;
            assert!(ends[1] - ends[0] < spread, "{text}\n{ends:?} {spread}");
            // The errors are seen: a tenth of what is allowed would be noise.
            assert!(largest[0] > 10.0 * allowed * force, "{largest:?}");
            let is_one_planet = matches!(displaced, Displaced::Gear | Displaced::Pin);
            assert_eq!(largest[1] > 1e-9, is_one_planet, "{largest:?}");
        }
    }
}
