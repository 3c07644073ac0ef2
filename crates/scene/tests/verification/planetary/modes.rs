//! Natural modes of a published set, by frequency and kind.

use std::f64::consts::TAU;

use gearmesh_scene::system_run::SetModeKind;
use nalgebra::{DMatrix, DVector, SymmetricEigen};

use super::*;

const PRESSURE_ANGLE_DEG: f64 = 24.6;
/// Masses and I/r² of carrier, ring, sun and planet \[kg\]; I over the square of base circle or pins' circle.
const MASSES: [[f64; 2]; 4] = [[5.43, 6.29], [2.35, 3.00], [0.40, 0.39], [0.66, 0.61]];

/// Lin and Parker's example set as their own equations have it (Journal of Vibration and Acoustics 121, 1999): plane
/// motion of carrier, ring, sun and planets, each with x, y and u = r θ; natural frequencies, rising \[Hz\].
fn equations_of_lin_and_parker(planets: usize) -> Vec<f64> {
    let (mesh, bearing, torsion) = (5e8, 1e8, 1e9);
    let size = 3 * (3 + planets);
    let mut stiffness = DMatrix::<f64>::zeros(size, size);
    let mut spring = |k: f64, entries: &[(usize, f64)]| {
        let mut w = DVector::zeros(size);
        entries.iter().for_each(|(place, value)| w[*place] += value);
        stiffness += k * &w * w.transpose();
    };
    let [carrier, ring, sun] = [0, 3, 6];
    for member in [carrier, ring, sun] {
        spring(bearing, &[(member, 1.0)]);
        spring(bearing, &[(member + 1, 1.0)]);
    }
    spring(torsion, &[(ring + 2, 1.0)]);
    let (sin_a, cos_a) = PRESSURE_ANGLE_DEG.to_radians().sin_cos();
    for n in 0..planets {
        let planet = 9 + 3 * n;
        let (sin, cos) = (TAU * n as f64 / planets as f64).sin_cos();
        // Pin: the carrier's turn moves it along e_t = (−sin, cos).
        spring(
            bearing,
            &[(planet, 1.0), (carrier, -1.0), (carrier + 2, sin)],
        );
        spring(
            bearing,
            &[(planet + 1, 1.0), (carrier + 1, -1.0), (carrier + 2, -cos)],
        );
        // The sun pushes the planet along cos α e_t + sin α e_r, the planet the ring along −cos α e_t + sin α e_r.
        let to_planet = [-cos_a * sin + sin_a * cos, cos_a * cos + sin_a * sin];
        let to_ring = [cos_a * sin + sin_a * cos, -cos_a * cos + sin_a * sin];
        spring(
            mesh,
            &[
                (sun, to_planet[0]),
                (sun + 1, to_planet[1]),
                (sun + 2, 1.0),
                (planet, -to_planet[0]),
                (planet + 1, -to_planet[1]),
                (planet + 2, 1.0),
            ],
        );
        spring(
            mesh,
            &[
                (planet, to_ring[0]),
                (planet + 1, to_ring[1]),
                (planet + 2, -1.0),
                (ring, -to_ring[0]),
                (ring + 1, -to_ring[1]),
                (ring + 2, 1.0),
            ],
        );
    }
    let mass = |place: usize| MASSES[(place / 3).min(3)][usize::from(place % 3 == 2)].sqrt();
    let scaled = DMatrix::from_fn(size, size, |i, k| stiffness[(i, k)] / mass(i) / mass(k));
    let mut found: Vec<f64> = SymmetricEigen::new(scaled)
        .eigenvalues
        .iter()
        .map(|s| s.max(0.0).sqrt() / TAU)
        .collect();
    found.sort_by(f64::total_cmp);
    found
}

/// The set of Lin and Parker with 3, 4 and 5 planets: every mode within 0.1 Hz of their equations, whose figures for
/// three planets are the published ones, and of the kind that they have. Radii are not those of the paper: they are in
/// its equations in I/r² only.
#[test]
fn natural_frequencies_are_those_of_lin_and_parker() {
    let folder = tempfile::tempdir().unwrap();
    write_gears(folder.path(), [34, 26], PRESSURE_ANGLE_DEG);
    let base_m = |z: usize| 1.5e-3 * z as f64 * PRESSURE_ANGLE_DEG.to_radians().cos();
    let radii = [0.09, base_m(86), base_m(34), base_m(26)];
    let inertia: Vec<f64> = (0..4).map(|i| MASSES[i][1] * radii[i] * radii[i]).collect();
    let bearing = "bearings = [{ model = { kind = \"linear\", radial_stiffness_N_per_mm = 1e5 } }]";
    let body = |i: usize, torque: &str| {
        format!(
            "mass_kg = {:?}\ninertia_kg_m2 = [1.0, 1.0, {:?}]\nsupport = \"floating\"\n{bearing}\n{torque}",
            MASSES[i][0], inertia[i]
        )
    };
    // A torque that closes the meshes: 1 N m on the sun, 1 + 86/34 times that on the carrier.
    let balance = format!("torque_Nm = {:?}", -120.0 / 34.0);
    let [carrier, ring, sun, planet] = [
        body(0, &balance),
        body(1, ""),
        body(2, "torque_Nm = 1.0"),
        body(3, ""),
    ];
    let carrier = carrier.replace("mass_kg = 5.43\n", "");
    for planets in [3, 4, 5] {
        let text = scene(
            "kind = \"eigen\"",
            90.0,
            [
                &sun,
                &ring,
                &carrier,
                &format!("{planet}\ncount = {planets}"),
                // The kinds are those of any axis.
                if planets == 4 {
                    "axis = [1.0, 0.5, -0.2]"
                } else {
                    ""
                },
            ],
        ) + &format!(
            "[[torsion_spring]]\nname = \"ring\"\nbody_2 = \"set ring\"\nstiffness_Nm_per_rad = {:?}\n",
            1e9 * radii[1] * radii[1]
        );
        let result = run(&text, folder.path());
        let point = &result.eigen[0];
        // The turn of the whole set, which nothing resists, is not among what vibrates: its eigenvalues are 0 but for
        // the load.
        let all = point.modes.iter().map(|mode| mode.frequency_hz());
        let found: Vec<f64> = all.filter(|hz| *hz > 1.0).collect();
        let expected = equations_of_lin_and_parker(planets).split_off(1);
        assert_eq!(found.len(), expected.len());
        for (found, expected) in found.iter().zip(&expected) {
            assert!(
                (found - expected).abs() < 0.1,
                "{planets}: {found} {expected}"
            );
        }
        if planets == 3 {
            let published = [
                743.2, 743.2, 1102.4, 1102.4, 1475.7, 1896.0, 1896.0, 1930.3, 2276.4, 2276.4,
                2658.3, 6986.3, 6986.3, 7462.8, 9647.9, 9647.9, 11775.3,
            ];
            for (found, published) in found.iter().zip(published) {
                assert!((found - published).abs() < 0.1, "{found} {published}");
            }
        }
        let kinds = &point.set_modes(&result.bodies, &result.head.sets)[0].kinds;
        let count = |kind| {
            let modes = kinds.iter().zip(&point.modes);
            let own = modes.filter(|(found, mode)| **found == kind && mode.frequency_hz() > 1.0);
            own.count()
        };
        assert_eq!(count(SetModeKind::Rotational), 5, "{kinds:?}");
        assert_eq!(count(SetModeKind::Translational), 12);
        assert_eq!(count(SetModeKind::Planet), 3 * (planets - 3));
    }
}
