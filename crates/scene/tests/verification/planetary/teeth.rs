//! Teeth that are thinner, a ring that is not round, tilted pins: their effect on forces, on the line load and on
//! the transmission error, against springs with gaps (`positions.rs`).

use std::f64::consts::TAU;

use nalgebra::Complex;

use super::positions::*;
use super::*;

/// Stiffness of a pair of teeth, force over approach \[N/m\].
const PAIR: f64 = 4e8;

/// Meshes of straight springs for each pair of teeth, on the path of contact only.
fn on_pairs(text: &str) -> String {
    text.replace(
        "{ kind = \"iso6336\", stiffness_N_per_mm_um = 20.0 }",
        "{ kind = \"impact\", stiffness_N_per_mm_e = 4e5, exponent = 1.0 }, teeth = { path = \"line-of-action\" }",
    )
}

/// Stiffness of both meshes of a planet in series in each row, by the pairs that carry \[N/m\].
fn in_series(rows: &Rows, planet: usize) -> Vec<f64> {
    let pairs = |name: &str| rows.read(&format!("elements/set {name}/loaded_pairs"));
    let (sun, ring) = (
        pairs(&format!("sun-planet {}", planet + 1)),
        pairs(&format!("planet {}-ring", planet + 1)),
    );
    let both = sun.iter().zip(&ring);
    both.map(|(sun, ring)| PAIR * sun * ring / (sun + ring))
        .collect()
}

/// 10 µm less on both flanks of planet 2: 20 µm along its two lines of action. Meshes are in phase: all planets have as
/// many pairs in contact. Forces and transmission error follow to the slopes of the solver, 1e-8, and the forces'
/// rounding in a sum: 1e-6.
#[test]
fn a_planet_with_thin_teeth_carries_less() {
    let folder = tempfile::tempdir().unwrap();
    write_gears(folder.path(), [24, 36], ALPHA_DEG);
    let (force, gap_m) = (1.5e4, 20e-6);
    let thin = "count = 3\ndeviation = [{ planet = 2, removed_um = 10.0 }]";
    for drive in drives(force) {
        let rows_of = |planets: &str| {
            let text = on_pairs(&of_drive(&drive, (planets, ""), (5, 3.7)));
            Rows::of(&text, drive.sense, folder.path())
        };
        let [plain, with] = ["count = 3", thin].map(rows_of);
        let [before, after] = [&plain, &with].map(Rows::approach);
        for row in 0..before.len() {
            let stiffness = in_series(&with, 0)[row];
            assert!(stiffness > 0.0);
            for planet in 0..3 {
                let gap = if planet == 1 { gap_m } else { 0.0 };
                let expected = force + stiffness * (gap_m / 3.0 - gap);
                for which in ["sun", "ring"] {
                    let found = with.forces(planet, which)[row];
                    assert!(
                        (found / expected - 1.0).abs() < 1e-6,
                        "{:?} planet {planet} {which} row {row}: {found} {expected}",
                        drive.keys
                    );
                }
            }
            // Both series start where teeth touch: without thin teeth for the first planet, which has none.
            let more = (after[row] - after[0]) - (before[row] - before[0]);
            assert!(
                more.abs() < 1e-6 * gap_m,
                "{:?} row {row}: {more:e}",
                drive.keys
            );
        }
    }
}

/// Waves of the ring turn with it against the planets. Three waves come to three planets at once: they are in the
/// transmission error, and shares stay equal. Two waves shift load between planets and are not in the transmission
/// error. Each tooth opens the mesh by A (sin α cos n(φ − φ_0) + σ cos α sin n(φ − φ_0)/n), φ its middle; teeth in
/// contact stand within a pitch of the planet's angle, half a pitch for the path of contact and half for the middle of
/// a tooth against its flank.
#[test]
fn waves_of_the_ring_are_in_transmission_error_or_shares() {
    let folder = tempfile::tempdir().unwrap();
    write_gears(folder.path(), [24, 36], ALPHA_DEG);
    let (force, amplitude_m, crest_deg) = (3e4, 30e-6, 25.0_f64);
    for drive in drives(force) {
        let rows_of = |lobes: Option<usize>| {
            let wave = |n| {
                format!(
                    "\nout_of_round = [{{ lobes = {n}, amplitude_um = 30.0, crest_deg = {crest_deg:?} }}]"
                )
            };
            let mut keys = drive.keys.clone();
            keys[1] += &lobes.map_or_else(String::new, wave);
            let changed = Drive { keys, ..drive };
            let text = on_pairs(&of_drive(&changed, ("count = 3", ""), (10, 0.7)));
            Rows::of(&text, drive.sense, folder.path())
        };
        let before = rows_of(None).approach();
        for lobes in [2, 3] {
            let with = rows_of(Some(lobes));
            let (carrier, ring, after) =
                (with.turns("carrier"), with.stands("ring"), with.approach());
            let (sin, cos) = ALPHA_DEG.to_radians().sin_cos();
            let n = lobes as f64;
            let wave = Complex::new(amplitude_m * sin, -drive.sense * amplitude_m * cos / n);
            let undecided = wave.norm() * n * TAU / 96.0;
            let opens = |planet: usize, row: usize| {
                let phi = TAU * planet as f64 / 3.0 + carrier[row] - ring[row];
                (wave * Complex::from_polar(1.0, n * (phi - crest_deg.to_radians()))).re
            };
            let stiffness: Vec<Vec<f64>> = (0..3).map(|planet| in_series(&with, planet)).collect();
            for row in 0..after.len() {
                let gaps: Vec<f64> = (0..3).map(|planet| opens(planet, row)).collect();
                let mean = gaps.iter().sum::<f64>() / 3.0;
                // Where the series begin is open: teeth touch there.
                let in_error = (after[row] - before[row]) - (after[0] - before[0]);
                let begin = (0..3).map(|planet| opens(planet, 0)).sum::<f64>() / 3.0;
                assert!(
                    (in_error - (mean - begin)).abs() < 2.0 * undecided,
                    "{:?} {lobes} row {row}: {in_error:e} {:e}",
                    drive.keys,
                    mean - begin
                );
                if lobes == 2 {
                    assert!(
                        in_error.abs() < 1e-6 * amplitude_m,
                        "row {row}: {in_error:e}"
                    );
                }
                for planet in 0..3 {
                    let found = (force - with.forces(planet, "ring")[row]) / stiffness[planet][row];
                    let expected = gaps[planet] - mean;
                    assert!(
                        (found - expected).abs() < undecided,
                        "{:?} {lobes}, planet {planet} row {row}: {found:e} {expected:e}",
                        drive.keys
                    );
                }
            }
        }
    }
}

/// A tilted pin opens both meshes of its planet by (f·t) z and −(g·t) z: the line load falls over the face, its sum and
/// the transmission error stay. What is left out is that a circle of radius r is an ellipse seen along another axis, t²
/// r/2 smaller, in both meshes.
#[test]
fn a_tilted_pin_tilts_the_line_load() {
    let folder = tempfile::tempdir().unwrap();
    write_gears(folder.path(), [24, 36], ALPHA_DEG);
    let (force, slices, width_m) = (2e4, 5, 25e-3);
    let per_m = 20e9;
    let allowed = per_m * (0.8e-3_f64.powi(2) + 1.1e-3_f64.powi(2)) * 54e-3;
    let tilted = "count = 3\ndeviation = [{ planet = 2, tilt_radial_mrad = 0.8, tilt_tangential_mrad = -1.1 }]";
    for drive in drives(force) {
        let text = of_drive(&drive, (tilted, ""), (3, 3.7)).replace(
            "stiffness_N_per_mm_um = 20.0",
            "stiffness_N_per_mm_um = 20.0, slices = 5",
        );
        let rows = Rows::of(&text, drive.sense, folder.path());
        let approach = rows.approach();
        for (row, carrier_rad) in rows.turns("carrier").into_iter().enumerate() {
            assert!((approach[row] - approach[0]).abs() < 1e-9);
            let out = unit(TAU / 3.0 + carrier_rad);
            let lean = 0.8e-3 * out - 1.1e-3 * nalgebra::Vector2::new(-out.y, out.x);
            let [f, g] = rows.directions(1, carrier_rad);
            for (name, slope) in [
                ("sun-planet 2", -f.dot(&lean)),
                ("planet 2-ring", g.dot(&lean)),
            ] {
                for slice in 0..slices {
                    let z_m = width_m * ((slice as f64 + 0.5) / slices as f64 - 0.5);
                    let expected = force / width_m + per_m * slope * z_m;
                    let column =
                        format!("elements/set {name}/line_load_slice_{}_N_per_m", slice + 1);
                    let found = rows.read(&column)[row];
                    assert!(
                        (found - expected).abs() < allowed,
                        "{:?} {name} slice {slice} row {row}: {found} {expected}",
                        drive.keys
                    );
                }
            }
        }
    }
}
