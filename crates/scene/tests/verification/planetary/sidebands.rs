//! What a place of the ring sees of planets that pass: orders of the carrier's turn, against the known pattern of equal
//! planets (McFadden and Smith, Proceedings of the Institution of Mechanical Engineers 199, 1985): multiples of their
//! number.

use std::f64::consts::TAU;

use gearmesh_scene::system::planetary::layout::passing_share;
use nalgebra::Complex;

use super::*;

/// Share of ((1 + cos θ)/2)^4, which a gauge shall have of a planet at the angle θ from it, at order k: C(8, 4 + k)/2⁸.
fn seen(k: i64) -> f64 {
    match k.abs() {
        0 => 70.0 / 256.0,
        1 => 56.0 / 256.0,
        2 => 28.0 / 256.0,
        3 => 8.0 / 256.0,
        4 => 1.0 / 256.0,
        _ => 0.0,
    }
}

/// Ring meshes whose stiffness varies, in 256 equilibria over a turn of the carrier, one for 0.37 pitches or less. Of
/// equal planets lines stand at multiples of their number alone, with the mesh's own share of order z_r times N times
/// the share that the gauge has of order k; z_r itself is missing where N does not divide it, and sidebands are uneven.
/// A pin beside its place brings the orders between, by the shares of springs.
#[test]
fn a_place_of_the_ring_sees_multiples_of_the_number_of_planets() {
    let rows: usize = 256;
    for (teeth, planets, moved_um) in [
        ([25, 35], 3, 0.0),
        ([22, 36], 4, 0.0),
        ([37, 23], 5, 0.0),
        ([25, 35], 3, 10.0),
    ] {
        let folder = tempfile::tempdir().unwrap();
        write_gears(folder.path(), teeth, 20.0);
        let [sun, ring] = [teeth[0], teeth[0] + 2 * teeth[1]].map(|z| z as f64);
        let turn_deg = 360.0 * (1.0 + ring / sun);
        let angles: Vec<String> = (0..rows)
            .map(|i| format!("{:?}", turn_deg * (i as f64) / (rows as f64)))
            .collect();
        let kind = format!(
            "kind = \"static\"\nmotion = \"set sun speed\"\nangles_deg = [{}]",
            angles.join(", ")
        );
        let distance = 1.5 * (teeth[0] + teeth[1]) as f64;
        let carrier = "inertia_kg_m2 = [0.1, 0.1, 0.1]\ntorque_Nm = -4000.0";
        let planet = format!(
            "count = {planets}\ndeviation = [{{ planet = 1, tangential_um = {moved_um:?} }}]"
        );
        let parts = [
            "speed_rpm = 0.0",
            "support = \"held\"",
            carrier,
            &planet,
            "",
        ];
        let text = scene(&kind, distance, parts);
        let ring_mesh = "ring_mesh = { model = { kind = \"iso6336\", stiffness_N_per_mm_um = 20.0";
        let varied = format!("{ring_mesh}, stiffness_amplitude = 0.2");
        let result = run(&changed(&text, ring_mesh, &varied), folder.path());
        let read = |name: &str| result.rows.read(name).unwrap();
        let carrier = read("bodies/set carrier/turn_rad");
        let forces: Vec<Vec<f64>> = (1..=planets)
            .map(|n| {
                read(&format!(
                    "elements/set planet {n}-ring/normal_force_right_N"
                ))
            })
            .collect();
        let line = |values: &dyn Fn(usize) -> f64, order: i64| {
            let part = |row: usize| {
                let angle = TAU * order as f64 * row as f64 / (rows as f64);
                values(row) * Complex::from_polar(1.0, -angle)
            };
            (0..rows).map(part).sum::<Complex<f64>>() / (rows as f64)
        };
        let psi: Vec<f64> = (0..planets)
            .map(|n| TAU * n as f64 / planets as f64)
            .collect();
        let gauge = |row: usize| -> f64 {
            let at = |n: usize| (0.5 + 0.5 * (carrier[row] + psi[n]).cos()).powi(4);
            (0..planets).map(|n| forces[n][row] * at(n)).sum()
        };
        let mean = 4000.0 / (1e-3 * distance * 2.0 * planets as f64 * 20f64.to_radians().cos());
        let own = line(&|row| forces[1][row], ring as i64).norm();
        assert!(own > 0.01 * mean, "{own} {mean}");
        for k in -4..=4 {
            let order = ring as i64 + k;
            let found = line(&gauge, order).norm();
            let share = passing_share(order, &psi);
            let multiple = order % planets as i64 == 0;
            assert_eq!(share > 0.0, multiple);
            // The carrier's own unevenness, its transmission error, is 1e-4 of a pitch.
            let expected = planets as f64 * own * seen(k) * share;
            if moved_um == 0.0 {
                let allowed = 1e-3 * own;
                assert!(
                    (found - expected).abs() < allowed,
                    "{teeth:?} {order}: {found} {expected} {own}"
                );
            }
        }
        // One planet that carries less by δ N/(N − 1): the order of the carrier's turn.
        let less = 2.0 * 2.5e8 * 20f64.to_radians().cos() * 1e-6 * moved_um;
        let found = line(&gauge, 1).norm();
        assert!(
            (found - less * seen(1)).abs() < 0.02 * less.max(1e-3 * mean),
            "{found} {}",
            less * seen(1)
        );
    }
}
