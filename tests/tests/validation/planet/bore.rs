//! Validation: a planet pressed from opposite sides, its bore glued or sliding, thin and thick, against an independent
//! plane-strain solution (reference/plane_bore); how many harmonics of the bore's motion it takes.

use gearmesh_contact::flank_deflection::{FlankLoad, flank_deflection};
use gearmesh_contact::{LocalContact, ProfileHats};
use gearmesh_geometry::{Flank, involute};
use gearmesh_model::{BoreMotion, ReducedGear};
use nalgebra::{DMatrix, DVector};
use std::path::Path;

use super::gears::{FACE_M, HARMONICS, planet};

/// Both loads \[N/m\].
const LINE_LOAD: f64 = 1e3;
/// Right flank of tooth 0, left flank of tooth 12.
const PLACES: [(usize, Flank); 2] = [(0, Flank::Right), (12, Flank::Left)];

/// Bore \[mm\], radius of the loads \[mm\], sums of both deflections, glued and sliding \[nm\] at 1 N/mm.
fn reference() -> Vec<[f64; 4]> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../reference/plane_bore/data.csv");
    let text = std::fs::read_to_string(path).unwrap();
    let row = |line: &str| {
        let numbers: Vec<f64> = line.split(',').map(|v| v.parse().unwrap()).collect();
        numbers.try_into().unwrap()
    };
    text.lines().skip(1).map(row).collect()
}

fn glued_nm(gear: &ReducedGear, radius_m: f64) -> f64 {
    let deflection = |(tooth, flank): (usize, Flank)| {
        let load = FlankLoad {
            tooth,
            flank,
            radius_m,
            line_load_n_per_m: LINE_LOAD,
            half_width_m: 0.1e-3,
        };
        let (global, own) = flank_deflection(gear, &load, tooth, LocalContact::Calibrated)
            .unwrap()
            .means_m();
        1e9 * (global + own)
    };
    PLACES.into_iter().map(deflection).sum::<f64>() + 2e9 * between(gear, radius_m)
}

/// Shares of the loads of a flank's grid in a uniform line load at a radius \[N\].
fn forces(gear: &ReducedGear, radius_m: f64) -> Vec<f64> {
    let roll = involute::roll_angle_rad(radius_m, gear.base_radius_m);
    let place = ProfileHats::of_involute(&gear.grid.roll_angles_rad).place(roll);
    let mut forces = vec![0.0; gear.grid.len()];
    for (station, along) in place.shares() {
        for (axial, across) in [(0, 0.25), (1, 0.5), (2, 0.25)] {
            forces[gear.grid.load(station, axial)] += LINE_LOAD * FACE_M * along * across;
        }
    }
    forces
}

/// Deflection at one place under the load at the other, bore glued \[m\]: mean over the face.
fn between(gear: &ReducedGear, radius_m: f64) -> f64 {
    let [(a, of_a), (b, of_b)] = PLACES;
    let c = gear.c_hub_block(a, of_a, b, of_b);
    let forces = forces(gear, radius_m);
    let n = forces.len();
    let work = (0..n * n).map(|k| forces[k / n] * c[k] * forces[k % n]);
    work.sum::<f64>() / (LINE_LOAD * FACE_M)
}

/// What a sliding bore adds \[nm\], with tangential motions up to a harmonic: fᵀ s S⁻¹ sᵀ f over those that are free.
/// The moments cancel, so that the uniform motion has no part in it.
fn sliding_adds_nm(gear: &ReducedGear, radius_m: f64, harmonics: usize) -> f64 {
    let bore = gear.bore.as_ref().unwrap();
    let first = bore.motions_of(BoreMotion::Tangential).start;
    let free: Vec<usize> = (first + 1..=first + 2 * harmonics).collect();
    let (m, forces) = (bore.count(), forces(gear, radius_m));
    let mut push = DVector::<f64>::zeros(free.len());
    for (tooth, flank) in PLACES {
        let rows = gear.bore_rows(tooth, flank).unwrap();
        for (force, row) in forces.iter().zip(rows.chunks_exact(m)) {
            for (sum, &q) in push.iter_mut().zip(&free) {
                *sum += force * row[q];
            }
        }
    }
    let s = DMatrix::from_fn(free.len(), free.len(), |i, j| {
        bore.stiffness[free[i] * m + free[j]]
    });
    let motion = s.cholesky().unwrap().solve(&push);
    1e9 * push.dot(&motion) / (LINE_LOAD * FACE_M)
}

/// Glued: 0.5 %, as asked of deflections. What sliding adds: 3 % of itself, as asked; with 16 harmonics within 1 % of
/// that with 32, so that more of them do not count.
#[test]
fn a_planet_with_a_sliding_bore_deflects_as_an_independent_program_says() {
    let rows = reference();
    for bore_mm in [rows[0][0], rows[rows.len() - 1][0]] {
        let gear = planet(bore_mm > 30.0);
        for &[_, radius_mm, glued_nm_found, sliding_nm] in rows.iter().filter(|r| r[0] == bore_mm) {
            let radius_m = 1e-3 * radius_mm;
            let glued = glued_nm(gear, radius_m) / glued_nm_found - 1.0;
            let effect = sliding_nm - glued_nm_found;
            let at = |harmonics| sliding_adds_nm(gear, radius_m, harmonics);
            let adds = [4, 8, 16, HARMONICS].map(at);
            println!(
                "bore {bore_mm} mm, radius {radius_mm} mm: glued {:+.3} %, sliding adds {:.2} % by reference, {:?} of that with 4, 8, 16, 32 harmonics",
                100.0 * glued,
                100.0 * effect / glued_nm_found,
                adds.map(|nm| nm / effect)
            );
            assert!(glued.abs() < 0.005, "{bore_mm} {radius_mm}: {glued}");
            let off = adds[3] / effect - 1.0;
            assert!(off.abs() < 0.03, "{bore_mm} {radius_mm}: {off}");
            assert!((adds[2] / adds[3] - 1.0).abs() < 0.01, "{adds:?}");
            assert!(adds.windows(2).all(|w| w[0] <= w[1] * (1.0 + 1e-9)));
        }
    }
}
