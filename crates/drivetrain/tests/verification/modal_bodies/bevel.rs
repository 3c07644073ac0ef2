//! Vibrating bevel gears: what holds of cylindrical ones, with slices that walk along the teeth of gear 2 and friction
//! in the tangent plane.

use std::f64::consts::TAU;
use std::ops::ControlFlow;

use gearmesh_contact::LocalContact;
use gearmesh_drivetrain::pose::Vector6;
use gearmesh_drivetrain::*;
use gearmesh_dynamics::{Params, Simulation};
use gearmesh_geometry::Flank;
use gearmesh_model::ReducedGear;
use nalgebra::Vector3;

use crate::mesh_common::made_up_bevel::modal_bevel;
use crate::mesh_common::modal_gear::MODES;
use crate::mesh_common::*;
use crate::modal_bodies::friction::check_power_of_friction;
use crate::modal_bodies::loads::{check_energy, check_tangents};
use crate::modal_bodies::vibrating_pair::*;
use crate::running_bevel::{flanks, running_at};

/// Slices along the teeth.
const ALONG: usize = 12;
const BOTH: [usize; 2] = [COUNT, COUNT];

fn models(flanks: &BevelSlices) -> [ReducedGear; 2] {
    [0, 1].map(|member| modal_bevel(flanks, member))
}

/// `hybrid` on these sides of the teeth with so many modes of both gears.
fn mesh_with(
    flanks: &BevelSlices,
    models: &[ReducedGear; 2],
    (modes, sides): ([usize; 2], &[Flank]),
    teeth: impl Fn(ReducedTeeth) -> Box<dyn TeethModel>,
) -> GearMesh {
    let of = |side| {
        let made = flanks.reduced_teeth(
            side,
            [&models[0], &models[1]],
            (LocalContact::Calibrated, 2000.0),
        );
        teeth(made.unwrap())
    };
    let mesh = GearMesh::of_flanks(Box::new(flanks.clone()), sides[0], of(sides[0]));
    let mut mesh = mesh.unwrap();
    for side in &sides[1..] {
        mesh = mesh.with_side(*side, of(*side)).unwrap();
    }
    for (gear, count) in modes.into_iter().enumerate() {
        if count > 0 {
            mesh = mesh.with_modes(gear + 1, &models[gear], count).unwrap();
        }
    }
    mesh
}

fn undamped(flanks: &BevelSlices, models: &[ReducedGear; 2], modes: [usize; 2]) -> GearMesh {
    mesh_with(flanks, models, (modes, &Flank::ALL), |teeth| {
        Box::new(teeth)
    })
}

/// Gear 2 where flanks of a side stand open by so much, gear 1 turned, axes off their design.
fn pose_at(
    flanks: &BevelSlices,
    side: Flank,
    (turn_1, gap_m): (f64, f64),
    (shift, tilt): (Vector3<f64>, Vector3<f64>),
) -> Pose {
    let pair = flanks.pair();
    let lever = pair.levers_m()[1] * side.mirror();
    let teeth = pair.teeth();
    let mut turn_2 = -turn_1 * teeth[0] as f64 / teeth[1] as f64;
    let mut found = FlankContacts::default();
    let placed = |turn_2: f64| {
        let nominal = pair.nominal_pose([turn_1, turn_2]);
        let step = Vector6::new(shift.x, shift.y, shift.z, tilt.x, tilt.y, tilt.z);
        moved(&nominal, &step)
    };
    for _ in 0..60 {
        pair.contacts_at(&placed(turn_2), side, &mut found).unwrap();
        turn_2 -= (found.lines[0].ideal_gap_m - gap_m) / lever;
    }
    placed(turn_2)
}

/// Both sides loaded, one and more pairs of teeth, as designed and off it: contacts that walk along the teeth of gear
/// 2, and at its ends.
fn bevel_poses(flanks: &BevelSlices) -> Vec<(Flank, Pose)> {
    let none = (Vector3::zeros(), Vector3::zeros());
    let off = (
        Vector3::new(20e-6, -30e-6, 40e-6),
        Vector3::new(2e-4, -3e-4, 0.0),
    );
    let pitch = TAU / flanks.pair().teeth()[0] as f64;
    [
        (Flank::Right, 0.1, -14e-6, none),
        (Flank::Left, 0.55, -18e-6, none),
        (Flank::Right, 0.7, -16e-6, off),
        (Flank::Left, 0.3, -12e-6, off),
    ]
    .map(|(side, pitches, gap_m, off)| {
        let at = pose_at(flanks, side, (pitches * pitch, gap_m), off);
        (side, at)
    })
    .to_vec()
}

/// At rest the loads are those of `reduced` gears, with all modes or some, and so is the energy: the share of the modes
/// in the compliance is taken out with the very shares that slices have on both flanks.
#[test]
fn modal_bevel_gears_at_rest_are_reduced_gears() {
    let flanks = flanks(ALONG);
    let models = models(&flanks);
    // One side: modes carry what presses on one side of the teeth to the other, which `reduced` gears do not feel.
    let one_side = |modes, side| {
        let sides = [side];
        mesh_with(&flanks, &models, (modes, &sides), |teeth| Box::new(teeth))
    };
    for modes in [BOTH, [3, 0], [0, 2]] {
        for (side, at) in bevel_poses(&flanks) {
            let (mut reduced, mut modal) = (one_side([0, 0], side), one_side(modes, side));
            let expected = reduced.evaluate(&at, false).unwrap();
            let (eta, found) = at_rest(&mut modal, &at, modes);
            let scale = expected.load.fixed_rows::<3>(0).norm();
            assert!(scale > 100.0, "{scale}");
            let off = (found.load - expected.load).norm() / scale;
            assert!(off < 1e-9, "{modes:?}: {off:e}");
            let strain: f64 = (eta.iter().enumerate())
                .map(|(i, eta)| {
                    let mode = if i < modes[0] { i } else { i - modes[0] };
                    0.5 * (TAU * MODES[mode].0 * eta).powi(2)
                })
                .sum();
            assert!(strain > 1e-3 * expected.power.stored_j);
            let whole = found.power.stored_j + strain;
            let off = (whole / expected.power.stored_j - 1.0).abs();
            assert!(off < 1e-9, "{modes:?}: energy {off:e}");
        }
    }
}

#[test]
fn loads_on_modes_of_bevel_gears_follow_from_the_energy() {
    let flanks = flanks(ALONG);
    let models = models(&flanks);
    let mut mesh = undamped(&flanks, &models, BOTH);
    for (_, at) in bevel_poses(&flanks) {
        check_energy(&mut mesh, &at);
    }
}

#[test]
fn modal_tangents_of_bevel_gears_agree_with_differences() {
    let flanks = flanks(ALONG);
    let models = models(&flanks);
    let damping = Damping::StiffnessProportional {
        time_s: 5e-6,
        full_depth_m: 1e-6,
    };
    let damped = || {
        mesh_with(&flanks, &models, (BOTH, &Flank::ALL), |teeth| {
            Box::new(Damped::new(teeth, damping, ALONG).unwrap())
        })
    };
    let friction = Friction::new([0.12, 0.07], [2e-3, 2e-2]).unwrap();
    // Of the made-up bodies, soft as they are, what tangents leave out is 1 %, as without modes.
    for (what, mut mesh) in [
        ("smooth", damped()),
        ("rough", damped().with_friction(friction)),
    ] {
        for (_, at) in bevel_poses(&flanks) {
            check_tangents((what, 1e-2), &mut mesh, &at);
        }
    }
}

/// Friction acts against the sliding of the vibrating flanks in their tangent plane: it takes out of gears and modes
/// what it spends.
#[test]
fn power_of_friction_on_modal_bevel_gears_balances() {
    let flanks = flanks(ALONG);
    let models = models(&flanks);
    let soft = Friction::new([0.12, 0.07], [2e-3, 2e-2]).unwrap();
    let coulomb = Friction::new([0.1, 0.1], [1e-9, 2e-9]).unwrap();
    for (friction, is_constant) in [(coulomb, true), (soft, false)] {
        let mut smooth = undamped(&flanks, &models, BOTH);
        let mut rough = undamped(&flanks, &models, BOTH).with_friction(friction);
        for (_, at) in bevel_poses(&flanks) {
            check_power_of_friction((&mut smooth, &mut rough), &at, is_constant);
        }
    }
}

/// Flanks that stand open as rigid ones and touch because they are bent are found: the loads are those of a search that
/// looks everywhere.
#[test]
fn bevel_flanks_that_touch_when_bent_are_found() {
    let flanks = flanks(ALONG);
    let models = models(&flanks);
    let mut near = undamped(&flanks, &models, BOTH);
    let mut everywhere = undamped(&flanks.clone().reaching(200e-6), &models, BOTH);
    let none = (Vector3::zeros(), Vector3::zeros());
    let mut closed = 0;
    for (side, gap_m) in [
        (Flank::Right, 3e-6),
        (Flank::Left, 12e-6),
        (Flank::Right, -4e-6),
    ] {
        let at = pose_at(&flanks, side, (0.1, gap_m), none);
        for seed in 0..8 {
            let value = |i: usize| ((13 * seed + 7 * i + 1) as f64).sin();
            let eta: Vec<f64> = (0..2 * COUNT).map(|i| 6e-5 * value(i)).collect();
            let motion = ModalMotion {
                coordinates: [&eta[..COUNT], &eta[COUNT..]],
                ..ModalMotion::default()
            };
            let [a, b] = [&mut near, &mut everywhere]
                .map(|mesh| mesh.evaluate_modal(&at, &motion, false).unwrap());
            let scale = b.load.norm().max(1.0);
            assert!((a.load - b.load).norm() < 1e-9 * scale, "{side:?} {seed}");
            assert!(
                (a.power.stored_j - b.power.stored_j).abs() < 1e-9 * b.power.stored_j.max(1e-9)
            );
            closed += usize::from(gap_m > 0.0 && b.load.norm() > 10.0);
        }
    }
    assert!(closed > 3, "{closed}");
}

/// Modal bevel gears without friction and damping keep their energy: the error of the balance falls with h² in the
/// mean.
#[test]
fn running_modal_bevel_gears_keep_their_energy() {
    let flanks = flanks(6);
    let models = models(&flanks);
    let run = |step_s: f64| {
        let undamped_bodies =
            [0, 1].map(|i: usize| modal_gear_body(&models[i], COUNT, 0.0).unwrap());
        let mesh = undamped(&flanks, &models, BOTH);
        let system = running_at(&flanks, mesh, undamped_bodies, 60.0);
        let params = Params {
            rho_infinity: 1.0,
            newton_tolerance: Some(1e-12),
            ..Params::fixed(step_s)
        };
        let mut run = Simulation::new(system.build().unwrap(), params).unwrap();
        run.run(2e-3, |_| ControlFlow::Continue(())).unwrap();
        *run.info()
    };
    let infos = [4e-6, 2e-6, 1e-6].map(run);
    let errors = infos.map(|info| info.energy.largest_error_j);
    let order = (errors[0] / errors[2]).log2() / 2.0;
    assert!((1.6..2.4).contains(&order), "{order} {errors:?}");
    let per_step = infos[1].iterations as f64 / infos[1].steps as f64;
    assert!(per_step < 6.0, "{per_step}");
}

/// Friction towards the tips, as gauges and modes take it, is that along differences of points up the flanks, of teeth
/// that need not be turned.
#[test]
fn friction_towards_the_tips_of_bevel_gears_follows_their_flanks() {
    let flanks = flanks(ALONG);
    let models = models(&flanks);
    let friction = Friction::new([0.1, 0.1], [1e-9, 2e-9]).unwrap();
    let mut mesh = undamped(&flanks, &models, [0, 0]).with_friction(friction);
    let (pair, mut compared) = (flanks.pair(), [[0; 2]; 2]);
    for (side, at) in bevel_poses(&flanks) {
        let turning = Vector6::new(0.0, 0.0, 0.0, 3.0, -5.0, 7.0);
        mesh.evaluate(&moving(&at, &turning), false).unwrap();
        let (found, forces) = mesh.side(side).unwrap();
        for (i, contact) in found
            .contacts
            .iter()
            .enumerate()
            .filter(|(i, _)| forces[*i] > 0.0)
        {
            let kinematics = mesh.kinematics();
            let tangents = kinematics.sliding(found, i, side, false);
            let [first, second]: [Vector3<f64>; 2] =
                tangents.map(|tangent| tangent.unwrap().direction.fixed_rows::<3>(0).into());
            let rubs = mesh.friction(side)[i];
            let on_2 = rubs.shares[0] * first + rubs.shares[1] * second;
            assert!((on_2.norm() - 0.1).abs() < 1e-12 && rubs.coefficient == 0.1);
            for (gear, compared) in compared.iter_mut().enumerate() {
                if found.lines[contact.line].teeth[gear] != 0 {
                    continue;
                }
                let s = contact.heights_m[gear] / pair.face_widths_m()[gear] + 0.5;
                let u = found.section(contact).roll_rad[gear];
                let [below, above] =
                    [u - 1e-5, u + 1e-5].map(|u| pair.flank_point_m(side, gear, [s, u]));
                let up = (above - below).normalize();
                let expected = match gear {
                    0 => -on_2.dot(&up),
                    _ => on_2.dot(&(at.rotation * up)),
                };
                assert!(
                    (rubs.towards_tips[gear] - expected).abs() < 1e-7,
                    "{side:?} {i} gear {gear}"
                );
                compared[usize::from(expected > 0.0)] += 1;
            }
        }
    }
    assert!(
        compared.iter().all(|of| of.iter().sum::<usize>() > 5),
        "{compared:?}"
    );
}
