//! A reduced bevel gear with a made-up compliance on the real flanks of its member.

use std::f64::consts::TAU;

use gearmesh_drivetrain::BevelSlices;
use gearmesh_geometry::Flank;
use gearmesh_model::{
    BevelBody, BevelMember, BevelNearField, FlankGrid, ModalBasis, ReducedGear, RigidBody,
};

use super::modal_gear::{MODES, shape};

/// Stations up the flank, and slices along it.
const UP: usize = 6;
pub const OWN_SLICES: usize = 8;

/// Member 0 or 1 of a pair; stiff at the root, neighbouring teeth coupled.
pub fn made_up_bevel(flanks: &BevelSlices, member: usize) -> ReducedGear {
    let pair = flanks.pair();
    let (teeth, face_width_m) = (pair.teeth()[member], pair.face_widths_m()[member]);
    let along = 2 * OWN_SLICES + 1;
    let grid = FlankGrid {
        roll_angles_rad: (0..UP).map(|k| k as f64 / (UP - 1) as f64).collect(),
        z_m: (0..along)
            .map(|k| face_width_m * (k as f64 / (along - 1) as f64 - 0.5))
            .collect(),
        slices: OWN_SLICES,
    };
    let loads = grid.len();
    let place = |load: usize| {
        let (u, z) = (grid.roll_angles_rad[load / along], grid.z_m[load % along]);
        [u, z / face_width_m + 0.5]
    };
    // Smooth, positive definite, softer towards the tip and the heel.
    let kernel = |l: usize, m: usize| {
        let ([u, s], [v, t]) = (place(l), place(m));
        let soft = |u: f64, s: f64| 0.3 + 0.7 * u * u + 0.1 * s;
        let apart = ((s - t) / 0.3).powi(2) + ((u - v) / 0.6).powi(2);
        let own = if l == m { 0.3 } else { 0.0 };
        1.5e-9 * soft(u, s) * soft(v, t) * ((-apart).exp() + own)
    };
    let mut c_hub = Vec::new();
    for load_flank in 0..2 {
        for response in 0..teeth {
            let around = response.min(teeth - response) as f64;
            for flank in 0..2 {
                for l in 0..loads {
                    for m in 0..loads {
                        let own = response == 0 && flank == load_flank;
                        let side = if flank == load_flank { 1.0 } else { -0.5 };
                        let far = 2e-10 * side * (-around).exp();
                        c_hub.push(far + if own { kernel(l, m) } else { 0.0 });
                    }
                }
            }
        }
    }
    let tooth = |flank: usize| (0..loads * loads).map(move |i| (flank, i / loads, i % loads));
    let point = |side: Flank, load: usize| {
        let [u, s] = place(load);
        pair.flank_point_m(side, member, [s, u])
    };
    let sides = [Flank::Right, Flank::Left];
    let all = || {
        sides
            .iter()
            .flat_map(|side| (0..loads).map(move |load| (*side, load)))
    };
    let sections_m: Vec<f64> = [-0.4, 0.0, 0.4].map(|s| s * face_width_m).to_vec();
    let profile: Vec<f64> = (0..5).map(|k| k as f64 / 4.0).collect();
    let per_section = |count: usize| 2 * sections_m.len() * count;
    ReducedGear {
        name: ["pinion", "gear"][member].to_owned(),
        teeth,
        sectors: teeth,
        base_radius_m: pair.levers_m()[member],
        face_width_m,
        opposite_distance_m: (0..2 * UP).map(|k| 5e-3 - 4e-4 * (k % UP) as f64).collect(),
        c_hub,
        c_tooth: sides
            .iter()
            .enumerate()
            .flat_map(|(flank, _)| tooth(flank))
            .map(|(_, l, m)| 0.4 * kernel(l, m))
            .collect(),
        flanks: sides.to_vec(),
        near_field: None,
        gauges: Vec::new(),
        reference_point: None,
        modes: None,
        crack: None,
        hub_patterns: None,
        shaft_faces: None,
        bore: None,
        bevel: Some(BevelBody {
            member: [BevelMember::Pinion, BevelMember::Gear][member],
            points_m: all()
                .flat_map(|(side, load)| <[f64; 3]>::from(point(side, load)))
                .collect(),
            normals: all().flat_map(|_| [1.0, 0.0, 0.0]).collect(),
            areas_m2: all()
                .map(|(_, load)| 1e-4 * (1.0 + 0.2 * place(load)[0]))
                .collect(),
            near_field: Some(BevelNearField {
                half_width_m: 1e-4,
                sections_m: sections_m.clone(),
                profile_length_m: vec![6e-3; per_section(1)],
                contact_m2_per_n: (0..per_section(profile.len()))
                    .map(|k| 2.2e-11 + 4e-13 * (k % 5) as f64 + 1e-13 * (k % 7) as f64)
                    .collect(),
                profile,
                mesh_m2_per_n: (0..per_section(UP * UP))
                    .map(|k| {
                        let (i, j) = (k / UP % UP, k % UP);
                        7e-12 * (-(i.abs_diff(j) as f64)).exp()
                    })
                    .collect(),
                opposite_distance_m: vec![4e-3; per_section(UP)],
                element_m: 1e-5,
                residual: 0.0,
            }),
            ..BevelBody::default()
        }),
        grid,
        ..super::pair_common::made_up_models::small_bevel_gear()
    }
}

/// The same with modes of a ring whose static share is in its compliance: along the normal, up the profile and along
/// the tooth, stronger towards the heel.
pub fn modal_bevel(flanks: &BevelSlices, member: usize) -> ReducedGear {
    let mut gear = made_up_bevel(flanks, member);
    let (teeth, loads, along) = (gear.teeth, gear.grid.len(), gear.grid.z_m.len());
    let at = |mode: usize, tooth: usize, flank: usize, load: usize| {
        let up = (load / along) as f64 / (UP - 1) as f64;
        let heel = (load % along) as f64 / (along - 1) as f64;
        let side = if flank == 0 { 1.0 } else { -1.0 };
        [
            shape(mode, tooth, teeth, side, up) * (0.7 + 0.6 * heel),
            0.5 * shape(mode, tooth + 1, teeth, 1.0, 0.5 - up),
            0.4 * shape(mode, tooth + 2, teeth, 1.0, heel),
        ]
    };
    let omega_squared: Vec<f64> = MODES.iter().map(|(f, ..)| (TAU * f).powi(2)).collect();
    let mut flank = Vec::with_capacity(MODES.len() * teeth * 2 * loads * 3);
    for mode in 0..MODES.len() {
        for tooth in 0..teeth {
            for side in 0..2 {
                flank.extend((0..loads).flat_map(|load| at(mode, tooth, side, load)));
            }
        }
    }
    let normal = |mode: usize, tooth: usize, side: usize| {
        let first = 3 * ((mode * teeth + tooth) * 2 + side) * loads;
        flank[first..first + 3 * loads].iter().step_by(3)
    };
    // `[load flank][response tooth][response flank][load][response]`
    for (block, entries) in gear.c_hub.chunks_exact_mut(loads * loads).enumerate() {
        let (response_flank, tooth, load_flank) = (block % 2, block / 2 % teeth, block / 2 / teeth);
        for (mode, omega_squared) in omega_squared.iter().enumerate() {
            let rows = entries
                .chunks_exact_mut(loads)
                .zip(normal(mode, 0, load_flank));
            for (row, l) in rows {
                for (c, m) in row.iter_mut().zip(normal(mode, tooth, response_flank)) {
                    *c += l * m / omega_squared;
                }
            }
        }
    }
    let mut coupling = vec![0.0; 6 * MODES.len()];
    coupling[5] = 0.4e-2;
    coupling[6] = 0.15;
    coupling[13] = 0.15;
    coupling[35] = -0.3e-2;
    gear.rigid_body = Some(RigidBody {
        reference_m: [0.0; 3],
        mass_kg: 0.25,
        centre_m: [0.0, 0.0, 0.03],
        inertia_kg_m2: [[3.2e-4, 0.0, 0.0], [0.0, 3.2e-4, 0.0], [0.0, 0.0, 1.1e-4]],
    });
    gear.modes = Some(ModalBasis {
        nodal_diameters: MODES.iter().map(|(_, n, _)| *n).collect(),
        omega_squared,
        complete_to_hz: 6000.0,
        flank,
        gauges: Vec::new(),
        coupling,
    });
    gear
}
