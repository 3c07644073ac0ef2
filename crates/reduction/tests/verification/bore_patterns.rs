//! Motions of the bore: the two ways to solve, the forces on a held bore under loads on any tooth, rigid motions, more
//! harmonics.

use crate::small_gears::{COARSE, SOLID, body, difference, gear, reduced, without_symmetry};
use gearmesh_fe::stiffness_product;
use gearmesh_geometry::{BoreMotions, GearDefinition};
use gearmesh_mesh::python::PythonEnvironment;
use gearmesh_model::{BoreMotion, read_reduced_gear, write_reduced_gear};
use gearmesh_reduction::flank_loads::{SparseVector, flank_grid, flank_loads};
use gearmesh_reduction::tooth_vectors::on_tooth;
use gearmesh_reduction::{ReductionError, ReductionOptions, Silent, reduce};

fn with_motions(helix_deg: f64) -> GearDefinition {
    let mut gear = gear(COARSE, SOLID, helix_deg);
    gear.reduction.bore = Some(BoreMotions {
        harmonics: 3,
        along: 2,
    });
    gear
}

/// One tooth and the harmonics of the ring against one factorisation of everything, to rounding.
#[test]
fn both_ways_to_solve_motions_of_the_bore_agree() {
    let gear = with_motions(12.0);
    let found = [gear.clone(), without_symmetry(&gear)].map(|gear| reduced(&gear, false).0);
    let [cyclic, whole] = found.each_ref().map(|model| model.bore.as_ref().unwrap());
    assert_eq!(cyclic.count(), 3 * 7 * 2);
    assert!(difference(&whole.stiffness, &cyclic.stiffness) < 1e-9);
    assert!(difference(&whole.flank, &cyclic.flank) < 1e-9);
    assert!(difference(&whole.gauges, &cyclic.gauges) < 1e-8);
    // The file keeps them.
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("gear.h5");
    write_reduced_gear(&path, &found[0]).unwrap();
    assert_eq!(read_reduced_gear(&path).unwrap(), found[0]);
    // Without them the rest is the same to the last bit.
    let mut plain = gear;
    plain.reduction.bore = None;
    let (plain, _) = reduced(&plain, false);
    assert!(plain.bore.is_none());
    assert_eq!(plain.c_hub, found[0].c_hub);
}

/// A load n on a flank of the held body presses its bore: Pᵀ K u = −s (Betti), here for some motions written out, on
/// teeth of several sectors; a rigid motion of the bore is one of the body.
#[test]
fn forces_on_a_held_bore_are_those_of_the_motions() {
    let gear = with_motions(0.0);
    let (model, _) = reduced(&gear, false);
    let bore = model.bore.as_ref().unwrap();
    // A rigid motion strains nothing, beside what a motion of its size strains.
    let largest_of = |values: &[f64]| values.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
    for motion in bore.rigid() {
        for strains in bore.gauges.chunks_exact(bore.count()) {
            let found: f64 = motion
                .iter()
                .zip(strains)
                .map(|(q, strain)| q * strain)
                .sum();
            let bound = 1e-7 * largest_of(&motion) * largest_of(strains);
            assert!(found.abs() < bound, "{found:e}, {bound:e}");
        }
    }
    let body = body(&gear);
    let side = gear.reduction.flanks[0];
    let loads = flank_loads(&gear, &body.mesh, &flank_grid(&gear), 0, side);
    let held = body.mesh.bore();
    for tooth in [0, 5, 17] {
        let load = 4;
        let normal: SparseVector = on_tooth(&body.mesh, &loads[load].normal, tooth);
        let mut u = Vec::new();
        body.solve_each(&[&normal], &Silent, |_, field| u = field.to_vec());
        let u = faer::Mat::from_fn(u.len(), 1, |i, _| u[i]);
        let forces = stiffness_product(&body.model, u.as_ref()).unwrap();
        // Radial cos 2φ times z, tangential sin 3φ, axial constant.
        let work = |motion: &dyn Fn(f64, f64) -> [f64; 3]| -> f64 {
            let of_node = |&node: &u32| {
                let [x, y, z] = body.mesh.nodes[node as usize];
                let polar = y.atan2(x);
                let [r, t, a] = motion(polar, 2.0 * z / gear.tooth.face_width_m);
                let (s, c) = polar.sin_cos();
                let at = 3 * node as usize;
                forces[(at, 0)] * (r * c - t * s)
                    + forces[(at + 1, 0)] * (r * s + t * c)
                    + forces[(at + 2, 0)] * a
            };
            held.iter().map(of_node).sum()
        };
        let rows = model.bore_rows(tooth, side).unwrap();
        let row = &rows[load * bore.count()..][..bore.count()];
        let motion = |component: BoreMotion, wave: usize, degree: usize| {
            row[bore.motions_of(component).start + wave * bore.along + degree]
        };
        let largest = largest_of(row);
        for (found, expected) in [
            (
                work(&|polar, zeta| [(2.0 * polar).cos() * zeta, 0.0, 0.0]),
                motion(BoreMotion::Radial, 3, 1),
            ),
            (
                work(&|polar, _| [0.0, (3.0 * polar).sin(), 0.0]),
                motion(BoreMotion::Tangential, 6, 0),
            ),
            (
                work(&|_, _| [0.0, 0.0, 1.0]),
                motion(BoreMotion::Axial, 0, 0),
            ),
        ] {
            assert!(
                (found + expected).abs() < 1e-9 * largest,
                "{tooth}: {found:e} {expected:e}"
            );
        }
        // Turned about the axis, the load's point moves along the normal by the lever: the base radius, on spur teeth.
        let turned: f64 = (bore.rigid()[2].iter().zip(row)).map(|(q, s)| q * s).sum();
        assert!((turned.abs() / gear.profile.base_radius_m - 1.0).abs() < 1e-3);
    }
}

/// More waves than the bore has nodes are refused before anything is solved.
#[test]
fn motions_that_the_nodes_do_not_tell_apart_are_refused() {
    let mut gear = with_motions(0.0);
    gear.reduction.bore = Some(BoreMotions {
        harmonics: 100,
        along: 2,
    });
    let options = ReductionOptions {
        estimate_error: false,
    };
    let python = PythonEnvironment::find().unwrap();
    let refused = reduce(&gear, &python, options, &Silent).err();
    assert!(matches!(
        refused,
        Some(ReductionError::BoreMotions { harmonics: 100, .. })
    ));
}
