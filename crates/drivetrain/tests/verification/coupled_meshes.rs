//! An idler between two wheels, its meshes solved together: against each mesh solved by itself with the deflection
//! under the other's forces in its gaps; forces that have a potential; tangents by differences; what switches it off.

use crate::mesh_common;

use std::ops::ControlFlow;

use gearmesh_contact::ProfileHats;
use gearmesh_drivetrain::flank_contacts::FlankContacts;
use gearmesh_drivetrain::*;
use gearmesh_dynamics::{Marker, Params, Simulation, System};
use gearmesh_geometry::Flank;
use gearmesh_model::ReducedGear;
use mesh_common::idler::{Meshes, PLAIN, SIDES, idler, pairs, teeth};
use mesh_common::*;

/// Sum of a mesh's normal forces \[N\] at the start.
fn normal_force_n(system: &mut System, mesh: &str) -> f64 {
    let start = system.start().clone();
    let channels = system.channels();
    let mut values = vec![0.0; channels.len()];
    let count = |element: &str| {
        channels
            .iter()
            .filter(|(owner, _)| owner == element)
            .count()
    };
    let counts: Vec<usize> = system.elements().map(count).collect();
    system.sample(&start, &counts, &mut values);
    let mut named = channels.iter().zip(values);
    let is_force = |channel: &gearmesh_dynamics::Channel| channel.name.starts_with("normal_force");
    let found = named.find(|((element, channel), _)| element == mesh && is_force(channel));
    found.unwrap().1
}

/// Deflection of the idler at each contact of one mesh under the forces of the other, from the blocks of C_hub.
fn felt(gear: &ReducedGear, at: [(&FlankContacts, usize, Flank); 2], forces_n: &[f64]) -> Vec<f64> {
    let hats = ProfileHats::of_involute(&gear.grid.roll_angles_rad);
    let spread = layout(SLICES).spread(1, gear);
    let loads_of = |(found, number, _): (&FlankContacts, usize, Flank), contact: usize| {
        let slice = &found.contacts[contact];
        let place = hats.place(found.section(slice).touching_roll_rad[number]);
        let mut loads = vec![0.0; gear.grid.len()];
        for (station, share) in place.shares() {
            for &(axial, part) in spread.shares(slice.slice) {
                loads[gear.grid.load(station, axial)] += share * part;
            }
        }
        (found.lines[slice.line].teeth[number], loads)
    };
    let own = 0..at[0].0.contacts.len();
    let deflection = |contact: usize| {
        let (tooth, here) = loads_of(at[0], contact);
        let of_force = |(other, force): (usize, &f64)| {
            let (on, there) = loads_of(at[1], other);
            let block = gear.c_hub_block(tooth, at[0].2, on, at[1].2);
            let row = |l: usize| &block[l * there.len()..][..there.len()];
            let each = here.iter().enumerate().map(|(l, share)| {
                share * row(l).iter().zip(&there).map(|(c, f)| c * f).sum::<f64>()
            });
            force * each.sum::<f64>()
        };
        forces_n.iter().enumerate().map(of_force).sum()
    };
    own.map(deflection).collect()
}

/// Each mesh alone with the deflection under the other's forces added to its gaps, again and again until nothing
/// changes: sums of the normal forces. Block Gauss-Seidel of the joint problem, which converges as its matrix is
/// positive; another program than the joint solution but for the contact of one mesh.
fn one_by_one(system: &System) -> [f64; 2] {
    let pairs = pairs();
    let shared = on_soft_rim(made_up_gear(&pairs[0].gear_2));
    let motions: Vec<_> = (system.body_ids())
        .map(|id| system.body_motion(system.start(), id))
        .collect();
    let mut sides = [0, 1].map(|number: usize| {
        let markers = gearmesh_dynamics::MarkerPair {
            a: Marker::ground([0.0; 3]),
            b: Marker::ground([0.0; 3]),
        };
        let motion = markers.motion(&motions[number], &motions[number + 1]);
        let mut found = FlankContacts::default();
        let no_errors = [Vec::new(), Vec::new()];
        let kinematics = kinematics_with(&pairs[number], no_errors, PLAIN.ends);
        let pose = Pose::from(&motion);
        kinematics
            .contacts(&pose, SIDES[number], &mut found)
            .unwrap();
        let forces = vec![0.0; found.contacts.len()];
        (teeth(&pairs[number], SIDES[number]), found, forces)
    });
    let mut last = [0.0; 2];
    for _ in 0..200 {
        for number in 0..2 {
            let other = 1 - number;
            let at = |k: usize| (&sides[k].1, 1 - k, SIDES[k]);
            let deflections = felt(&shared, [at(number), at(other)], &sides[other].2);
            let (teeth, found, forces) = &mut sides[number];
            let mut loads = teeth_model::TeethLoads::default();
            loads.begin(found.contacts.len(), found.sections.len());
            let mut moved = found.clone();
            for (contact, deflection) in moved.contacts.iter_mut().zip(deflections) {
                contact.gap_m += deflection;
            }
            teeth.evaluate(&moved, false, &mut loads).unwrap();
            forces.clone_from(&loads.normal_n);
        }
        let sums = [0, 1].map(|k: usize| sides[k].2.iter().sum::<f64>());
        if sums == last {
            break;
        }
        last = sums;
    }
    last
}

/// The sum of each mesh's forces; 1e-8 as asked of a solution beside the joint problem.
#[test]
fn meshes_together_carry_what_each_carries_in_the_deflection_of_the_other() {
    for (theta, depths_m) in [
        (0.0, [12e-6, 9e-6]),
        (0.05, [12e-6, 3e-6]),
        (0.11, [4e-6, 12e-6]),
    ] {
        let mut system = idler(theta, depths_m, PLAIN, (0.0, 0.0));
        let expected = one_by_one(&system);
        for (mesh, sum) in ["first", "second"].into_iter().zip(expected) {
            let found = normal_force_n(&mut system, mesh);
            assert!(
                sum > 100.0 && (found / sum - 1.0).abs() < 1e-8,
                "{mesh}: {found} {sum}"
            );
        }
    }
}

/// Places of the bodies in the plane, and their turns.
const PLANE: [usize; 9] = [0, 1, 5, 6, 7, 11, 12, 13, 17];

/// Rows and columns of the planar motions: force and how it changes, by differences and as stated.
fn stiffnesses(damping: Option<Damping>, speed: f64) -> [nalgebra::DMatrix<f64>; 2] {
    let how = Meshes { damping, ..PLAIN };
    let mut system = idler(0.05, [12e-6, 7e-6], how, (0.0, 0.0));
    let start = system.start().clone();
    let n = system.degrees_of_freedom();
    let velocity: Vec<f64> = (0..n)
        .map(|i| {
            if i % 6 == 5 {
                speed * (1.0 + i as f64)
            } else {
                0.0
            }
        })
        .collect();
    let mut force = |dof: usize, by: f64| {
        let mut increment = vec![0.0; n];
        increment[dof] = by;
        system
            .probe("together", &start, &increment, &velocity)
            .unwrap()
    };
    let stated = force(0, 0.0).by_position;
    let mut found = nalgebra::DMatrix::zeros(9, 9);
    for (column, &dof) in PLANE.iter().enumerate() {
        // Turns in metres at the base circle, about.
        let step = if dof % 6 == 5 { 2e-8 } else { 1e-9 };
        let (ahead, behind) = (force(dof, step).force, force(dof, -step).force);
        for (row, &of) in PLANE.iter().enumerate() {
            found[(row, column)] = (ahead[of] - behind[of]) / (2.0 * step);
        }
    }
    let stated = nalgebra::DMatrix::from_fn(9, 9, |i, j| stated[(PLANE[i], PLANE[j])]);
    [found, stated]
}

/// Turns count in metres at 50 mm.
fn scaled(matrix: &nalgebra::DMatrix<f64>) -> nalgebra::DMatrix<f64> {
    let lever = |i: usize| if i % 3 == 2 { 1.0 / 50e-3 } else { 1.0 };
    nalgebra::DMatrix::from_fn(9, 9, |i, j| matrix[(i, j)] * lever(i) * lever(j))
}

/// Forces of meshes together have a potential: how they change is symmetric. 1e-6 of the largest, what differences of
/// forces solved to 1e-12 leave. Without what the energy between the meshes changes by as contacts walk it is 1e-4.
#[test]
fn forces_of_meshes_together_have_a_potential() {
    let found = scaled(&stiffnesses(None, 0.0)[0]);
    let skew = (&found - found.transpose()).amax() / found.amax();
    assert!(skew < 1e-6, "{skew:e}");
}

/// What tangents leave out is how the compliance moves, 1e-3 of the stiffness; between the meshes, too, where the
/// coupling is 10 % of it.
#[test]
fn tangents_of_meshes_together_are_the_changes_of_their_forces() {
    let damping = Damping::StiffnessProportional {
        time_s: 2e-6,
        full_depth_m: 1e-6,
    };
    for (damping, speed) in [(None, 0.0), (Some(damping), 0.02)] {
        let [found, stated] = stiffnesses(damping, speed).map(|matrix| scaled(&matrix));
        let off = (&found - &stated).amax() / found.amax();
        let between = found.view((0, 6), (3, 3)).amax() / found.amax();
        assert!(between > 0.01, "{between}");
        assert!(off < 3e-3, "{off:e} of {between}");
    }
}

/// Where nothing touches any more there are no forces and nothing changes them, whatever touched before.
#[test]
fn meshes_that_have_come_apart_hold_nothing() {
    let mut system = idler(0.05, [12e-6, 7e-6], PLAIN, (0.0, 0.0));
    let start = system.start().clone();
    let n = system.degrees_of_freedom();
    let still = vec![0.0; n];
    let mut apart = 0;
    for (first, last) in [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)] {
        let touching = system.probe("together", &start, &still, &still).unwrap();
        assert!(touching.force.iter().any(|force| force.abs() > 1.0));
        // Both wheels turned by some 50 um, each away from the idler or into it.
        let mut increment = still.clone();
        (increment[5], increment[17]) = (1e-3 * first, 1e-3 * last);
        let Some(found) = system.probe("together", &start, &increment, &still) else {
            continue;
        };
        if found.force.iter().all(|force| *force == 0.0) {
            apart += 1;
            assert!(found.by_position.iter().all(|change| *change == 0.0));
        }
    }
    assert_eq!(apart, 1);
}

/// A run over some teeth: largest error of the energy balance \[J\], corrections and factorisations a step.
fn in_time(step_s: f64, coupled: bool) -> (f64, [f64; 2]) {
    let how = Meshes {
        ends: PathEnds::Extended,
        coupled,
        ..PLAIN
    };
    let system = idler(0.0, [5e-6, 5e-6], how, (45.0, 150.0));
    let params = Params {
        rho_infinity: 1.0,
        newton_tolerance: Some(1e-12),
        ..Params::fixed(step_s)
    };
    let mut run = Simulation::new(system, params).unwrap();
    run.run(6e-3, |_| ControlFlow::Continue(())).unwrap();
    let info = run.info();
    let steps = info.steps as f64;
    let effort = [info.iterations, info.factorisations].map(|count| count as f64 / steps);
    (info.energy.largest_error_j, effort)
}

/// Undamped teeth keep their energy but for the step: its error falls with h², as that of one pair does. A
/// coupling that forces felt and energy did not, or whose walking contacts did no work, would leave a part that no step
/// takes away. Second order gives a factor of 16; half of that is asked, because of tip edges. A step takes at most 1.1
/// times the corrections of a run without the coupling: the tangents hold how the forces of one mesh change with the
/// motion of the other.
#[test]
fn an_idler_in_time_keeps_its_energy_and_takes_no_more_corrections() {
    let (coarse, effort) = in_time(8e-6, true);
    let (fine, _) = in_time(2e-6, true);
    assert!(fine < coarse / 8.0, "{coarse:e} {fine:e}");
    let (_, apart) = in_time(8e-6, false);
    assert!(effort[0] < 1.1 * apart[0], "{effort:?} {apart:?}");
    assert!(effort[1] < 1.5 * apart[1] + 0.02, "{effort:?} {apart:?}");
}
