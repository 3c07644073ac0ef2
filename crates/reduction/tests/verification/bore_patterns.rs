//! Motions of the bore: the two ways to solve, the forces on a held bore under loads on any tooth, rigid motions, more
//! harmonics.

use crate::small_gears::{COARSE, SOLID, body, difference, gear, reduced, without_symmetry};
use gearmesh_fe::{DofMap, Factor, assemble_stiffness, stiffness_product};
use gearmesh_geometry::{BoreMotions, Flank, GearDefinition};
use gearmesh_mesh::python::PythonEnvironment;
use gearmesh_model::{BoreMotion, read_reduced_gear, write_reduced_gear};
use gearmesh_reduction::bore_patterns::moved_body;
use gearmesh_reduction::field::{FlankUnits, GridForce};
use gearmesh_reduction::flank_loads::{SparseVector, flank_grid, flank_loads};
use gearmesh_reduction::gauge_row::gauge_row;
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

/// A rim pressed from both sides, as that of a planet, whose bore radial pressures hold in balance. Once with rows and
/// motions of the bore, once as the whole model under the same forces on flanks and bore, held at six single degrees of
/// freedom that carry nothing. The gauge reads the same by its row and in the field that the motions make, to rounding;
/// what both miss of the whole model is what the harmonics left out would add. Each doubling leaves less than a third
/// of that; the eighth harmonic of exp(4 cos φ) is 1e-3 of the first one, the teeth's own forces on the bore fall as
/// slowly as the rim is thin. Along the axis there are as many motions as planes of nodes: with two, 5 % stay.
#[test]
fn a_bore_under_pressure_strains_gauges_as_the_whole_model_has_it() {
    let mut gear = gear(
        COARSE,
        "[blank]\nkind = \"solid\"\nbore_diameter_mm = 34.0\n",
        0.0,
    );
    gear.reduction.symmetry = gearmesh_geometry::Symmetry::Off;
    let body = body(&gear);
    let nodes = &body.mesh.nodes;
    let bore: Vec<usize> = body.mesh.bore().into_iter().map(|n| n as usize).collect();
    let polar = |node: usize| nodes[node][1].atan2(nodes[node][0]);
    // Right flank of tooth 0 and left one of tooth 9, both slices alike: no moment about the axis, none that tilts.
    let grid = flank_grid(&gear);
    let slices = grid.z_m.len();
    let mut forces = Vec::new();
    let mut on_mesh = vec![0.0; 3 * nodes.len()];
    for (tooth, side) in [(0, Flank::Right), (9, Flank::Left)] {
        let loads = flank_loads(&gear, &body.mesh, &grid, 0, side);
        for (load, unit) in loads.iter().enumerate().skip(slices).take(slices) {
            forces.push((tooth, side, load, 1000.0));
            for (dof, value) in on_tooth(&body.mesh, &unit.normal, tooth) {
                on_mesh[dof] += 1000.0 * value;
            }
        }
    }
    // Two bumps of pressure that balance them.
    let bump = |centre: f64, node: usize| {
        let middle = nodes[node][2].abs() < 1e-9;
        let share = if middle { 2.0 } else { 1.0 };
        share * (4.0 * ((polar(node) - centre).cos() - 1.0)).exp()
    };
    let sum = |axis: usize, of: &dyn Fn(usize) -> [f64; 2]| -> f64 {
        bore.iter().map(|&node| of(node)[axis]).sum()
    };
    let pushes = [2.0, 3.5].map(|centre| {
        let of = move |node: usize| {
            [polar(node).cos(), polar(node).sin()].map(|d| bump(centre, node) * d)
        };
        [sum(0, &of), sum(1, &of)]
    });
    let whole = [0, 1].map(|axis| on_mesh.iter().skip(axis).step_by(3).sum::<f64>());
    let [[a, c], [b, d]] = pushes;
    let det = a * d - b * c;
    let sizes = [
        (-whole[0] * d + whole[1] * b) / det,
        (-whole[1] * a + whole[0] * c) / det,
    ];
    let pressure = |node: usize| sizes[0] * bump(2.0, node) + sizes[1] * bump(3.5, node);
    for &node in &bore {
        on_mesh[3 * node] += pressure(node) * polar(node).cos();
        on_mesh[3 * node + 1] += pressure(node) * polar(node).sin();
    }
    // The whole model.
    let back = nodes.iter().map(|n| n[2]).fold(f64::INFINITY, f64::min);
    let nearest = |angle: f64| {
        let at_back = bore.iter().filter(|&&node| nodes[node][2] < back + 1e-9);
        let apart = |node: &&usize| {
            (polar(**node) - angle).sin().abs() + (1.0 - (polar(**node) - angle).cos())
        };
        *at_back
            .min_by(|p, q| apart(p).total_cmp(&apart(q)))
            .unwrap()
    };
    let [p, q, r] = [0.0, 3.1, 1.6].map(nearest);
    let fixed = [3 * p, 3 * p + 1, 3 * p + 2, 3 * q + 1, 3 * q + 2, 3 * r + 2];
    let dofs = DofMap::with_fixed_dofs(nodes.len(), &fixed).unwrap();
    let stiffness = assemble_stiffness(&body.model, &dofs).unwrap();
    let factor = Factor::of_model(&body.model, &dofs, &stiffness).unwrap();
    let mut free = dofs.restrict(&on_mesh);
    factor.solve_slice_in_place(&mut free);
    let exact = dofs.expand(&free);
    let row = gauge_row(
        &gear,
        &body.mesh,
        &body.model,
        &gear.gauges[0],
        gear.gauges[0].tooth,
    )
    .unwrap();
    let read = |u: &[f64]| {
        row.iter()
            .map(|&(dof, weight)| weight * u[dof])
            .sum::<f64>()
    };
    let expected = read(&exact);

    let off = [2, 4, 8, 16].map(|harmonics| {
        let mut gear = gear.clone();
        gear.reduction.bore = Some(BoreMotions {
            harmonics,
            along: 3,
        });
        let (model, body) = reduced(&gear, false);
        let patterns = model.bore.as_ref().unwrap();
        let released = model.with_sliding_bore().unwrap();
        let radial = &released.radial;
        let count = radial.count();
        // ŝᵀ f and the pressures along each motion.
        let mut push = vec![0.0; count];
        let index = |side: Flank| model.flank_index(side).unwrap();
        let place = |(tooth, side, load, _): &(usize, Flank, usize, f64)| {
            (tooth * model.flanks.len() + index(*side)) * model.grid.len() + load
        };
        for force in &forces {
            let row = &radial.flank[place(force) * count..][..count];
            for (sum, s) in push.iter_mut().zip(row) {
                *sum += force.3 * s;
            }
        }
        for &node in &bore {
            let values = patterns.at(polar(node), nodes[node][2]);
            for (sum, [wave, degree]) in push.iter_mut().zip(&radial.motions) {
                *sum += pressure(node) * values[wave * radial.along + degree];
            }
        }
        let matrix = faer::Mat::from_fn(count, count, |i, j| radial.stiffness[i * count + j]);
        let push = faer::Mat::from_fn(count, 1, |i, _| push[i]);
        let moved = faer::linalg::solvers::Solve::solve(&matrix.partial_piv_lu(), &push);
        let moved: Vec<f64> = (0..count).map(|i| moved[(i, 0)]).collect();
        let of_forces = forces
            .iter()
            .map(|force| force.3 * released.gear.gauges[0].adjoint[3 * place(force)]);
        let of_bore = radial.gauges[..count]
            .iter()
            .zip(&moved)
            .map(|(g, q)| g * q);
        let strain = of_forces.sum::<f64>() + of_bore.sum::<f64>();
        // The field that the motions make with the forces on a held bore.
        let motions = model.bore_motions_m(&forces, &moved).unwrap();
        let mut field = moved_body(&body, patterns, &motions).unwrap();
        let held = forces
            .iter()
            .map(|&(tooth, side, load, normal_n)| GridForce {
                tooth,
                side,
                load,
                normal_n,
                tangential_n: 0.0,
            });
        let units = FlankUnits::of_gear(&gear, &body, &Flank::ALL).unwrap();
        units.solve_each(&body, &[held.collect()], |_, u| {
            field.iter_mut().zip(u).for_each(|(sum, u)| *sum += u);
        });
        assert!(
            (read(&field) / strain - 1.0).abs() < 1e-7,
            "{} {strain}",
            read(&field)
        );
        (strain / expected - 1.0).abs()
    });
    let falls = off.windows(2).all(|pair| pair[1] < pair[0] / 3.0);
    assert!(falls && off[3] < 0.02, "{off:?}");
}
