//! A made-up gear that vibrates: the body of the contact tests and modes of a ring on top of it, whose static share is
//! in C_hub.

use gearmesh_drivetrain::{GearMesh, MeshLoad, ModalMotion, Pose};
use gearmesh_geometry::ToothGeometry;
use gearmesh_model::{Flank, GaugeRows, ModalBasis, ReducedGear, RigidBody};
use nalgebra::{DMatrix, DVector};
use std::f64::consts::TAU;

use super::{WIDTH, made_up_gear};

/// Frequency \[Hz\], nodal diameters, and whether it is the sine of a pair.
pub const MODES: [(f64, usize, bool); 6] = [
    (2500.0, 0, false),
    (3100.0, 1, false),
    (3100.0, 1, true),
    (4200.0, 2, false),
    (4200.0, 2, true),
    (6000.0, 0, false),
];
/// Gauges on as many teeth.
pub const GAUGES: usize = 8;

/// φ of a mode at a load: strongest at the tip, pairs of equal frequency turned against each other, so that the gear
/// looks the same from each tooth.
pub fn shape(mode: usize, tooth: usize, teeth: usize, side: f64, height: f64) -> f64 {
    let (_, diameters, sine) = MODES[mode];
    let angle = TAU * (diameters * tooth) as f64 / teeth as f64;
    let around = if sine { angle.sin() } else { angle.cos() };
    let amplitude = [0.35, 0.25, 0.25, 0.3, 0.3, 0.4][mode];
    side * amplitude * around * (0.8 + 0.4 * height)
}

/// φ_t of a mode towards the tip: the same on both sides of a tooth, strongest at the root.
pub fn tangential_shape(mode: usize, tooth: usize, teeth: usize, height: f64) -> f64 {
    0.6 * shape(mode, tooth + 1, teeth, 1.0, 0.5 - height)
}

/// The gear with modes, mass and gauges.
pub fn modal_gear(name: &str, tooth: &ToothGeometry) -> ReducedGear {
    let mut gear = made_up_gear(tooth);
    let (teeth, loads, axial) = (gear.teeth, gear.grid.len(), gear.grid.z_m.len());
    let stations = gear.grid.roll_angles_rad.len();
    let omega_squared: Vec<f64> = MODES.iter().map(|(f, ..)| (TAU * f).powi(2)).collect();
    let at = |mode: usize, tooth: usize, flank: usize, load: usize| {
        let height = (load / axial) as f64 / (stations - 1) as f64;
        let side = if flank == 0 { 1.0 } else { -1.0 };
        shape(mode, tooth, teeth, side, height)
    };
    // `[mode][tooth][flank][load]`: cosines are too dear for every entry of the compliance.
    let shapes: Vec<f64> = (0..MODES.len() * teeth * 2 * loads)
        .map(|i| {
            let (load, flank) = (i % loads, i / loads % 2);
            let (tooth, mode) = (i / loads / 2 % teeth, i / loads / 2 / teeth);
            at(mode, tooth, flank, load)
        })
        .collect();
    let of_flank = |mode: usize, tooth: usize, flank: usize| {
        &shapes[((mode * teeth + tooth) * 2 + flank) * loads..][..loads]
    };
    // `[load flank][response tooth][response flank][load][response]`
    let blocks = gear.c_hub.chunks_exact_mut(loads * loads);
    for (block, entries) in blocks.enumerate() {
        let (response_flank, tooth, load_flank) = (block % 2, block / 2 % teeth, block / 2 / teeth);
        for (mode, omega_squared) in omega_squared.iter().enumerate() {
            let loaded = of_flank(mode, 0, load_flank);
            let moved = of_flank(mode, tooth, response_flank);
            for (row, l) in entries.chunks_exact_mut(loads).zip(loaded) {
                for (c, m) in row.iter_mut().zip(moved) {
                    *c += l * m / omega_squared;
                }
            }
        }
    }
    let mut flank = Vec::new();
    for mode in 0..MODES.len() {
        for tooth in 0..teeth {
            for side in 0..2 {
                for load in 0..loads {
                    let height = (load / axial) as f64 / (stations - 1) as f64;
                    let tangential = tangential_shape(mode, tooth, teeth, height);
                    flank.extend([at(mode, tooth, side, load), tangential, 0.02]);
                }
            }
        }
    }
    let readings: Vec<f64> = (0..MODES.len() * GAUGES)
        .map(|i| 3.0 * (1.7 * i as f64).sin())
        .collect();
    gear.gauges = (0..GAUGES)
        .map(|number| GaugeRows {
            name: format!("g{number}"),
            tooth: number,
            side: Flank::Right,
            description: "made up".to_owned(),
            error_estimate_relative: 0.01,
            adjoint: (0..teeth * 2 * loads * 3)
                .map(|i| {
                    let own = if i / (6 * loads) == number {
                        1e-8
                    } else {
                        1e-10
                    };
                    let modal: f64 = (0..MODES.len())
                        .map(|mode| {
                            let phi = flank[mode * teeth * 2 * loads * 3 + i];
                            readings[mode * GAUGES + number] * phi / omega_squared[mode]
                        })
                        .sum();
                    own * (1.0 + 0.3 * (0.1 * i as f64).sin()) + modal
                })
                .collect(),
            own_tooth: (0..2 * loads)
                .map(|i| 1e-9 * (0.2 * i as f64).cos())
                .collect(),
        })
        .collect();
    let blank = super::disc("", tooth, WIDTH, (0.0, 0.0, 0.0));
    let (mass, inertia) = (blank.mass_kg, blank.inertia_kg_m2);
    let mut coupling = vec![0.0; 6 * MODES.len()];
    coupling[5] = 0.4 * inertia[(2, 2)].sqrt();
    coupling[6] = 0.3 * mass.sqrt();
    coupling[13] = 0.3 * mass.sqrt();
    coupling[35] = -0.3 * inertia[(2, 2)].sqrt();
    ReducedGear {
        name: name.to_owned(),
        rigid_body: Some(RigidBody {
            reference_m: [0.0; 3],
            mass_kg: mass,
            centre_m: [0.0; 3],
            inertia_kg_m2: std::array::from_fn(|i| std::array::from_fn(|j| inertia[(i, j)])),
        }),
        modes: Some(ModalBasis {
            nodal_diameters: MODES.iter().map(|(_, n, _)| *n).collect(),
            omega_squared,
            complete_to_hz: 6000.0,
            flank,
            gauges: readings,
            coupling,
        }),
        ..gear
    }
}

/// Modal coordinates of both gears that deflect at rest: Ω²η = Q(η), by Newton with the mesh's own tangent.
pub fn at_rest(mesh: &mut GearMesh, pose: &Pose, modes: [usize; 2]) -> (Vec<f64>, MeshLoad) {
    let m = modes[0] + modes[1];
    let omega_squared = |i: usize| {
        let mode = if i < modes[0] { i } else { i - modes[0] };
        (TAU * MODES[mode].0).powi(2)
    };
    let mut eta = vec![0.0; m];
    for _ in 0..30 {
        let (first, second) = eta.split_at(modes[0]);
        let motion = ModalMotion {
            coordinates: [first, second],
            ..ModalMotion::default()
        };
        let load = mesh.evaluate_modal(pose, &motion, true).unwrap();
        let modal = mesh.modal_loads();
        let residual = DVector::from_fn(m, |i, _| modal.force[i] - omega_squared(i) * eta[i]);
        if residual.norm() <= 1e-13 * DVector::from_row_slice(&modal.force).norm() {
            return (eta, load);
        }
        let matrix = DMatrix::from_fn(m, m, |i, j| {
            let own = if i == j { omega_squared(i) } else { 0.0 };
            own - modal.by_coordinates[i * m + j]
        });
        let step = matrix.lu().solve(&residual).unwrap();
        eta.iter_mut()
            .zip(step.iter())
            .for_each(|(eta, step)| *eta += step);
    }
    panic!("no modal equilibrium");
}
