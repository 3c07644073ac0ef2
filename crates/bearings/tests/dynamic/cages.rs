//! Cages: how fast they turn, what their pockets carry, what guides them.

use std::ops::ControlFlow;

use gearmesh_bearings::RingPose;
use gearmesh_bearings::dynamic::{
    DynamicEffects, LandContact, LandFilm, LandGuide, LandSide, PocketShape, Pockets, Rebound,
    Traction,
};
use gearmesh_dynamics::{GROUND, Marker, MarkerPair, Params, Simulation, System};
use nalgebra::{Vector3, Vector5};

use crate::common::{B6205, bearing, close};
use crate::rig::{Channels, Held, cage, element, hold, pockets, row, shaft};

const SPEED: f64 = 157.0;
const PRESSED_M: f64 = 5e-5;

/// A 6205 pressed in along its axis with a cage, which may be guided.
fn caged(pockets: Pockets, land: Option<LandGuide>, start_share: f64, axial_m: f64) -> System {
    let bearing = bearing(B6205);
    let mut builder = System::builder();
    let pose = RingPose::from_five(&Vector5::new(0.0, 0.0, axial_m, 0.0, 0.0));
    let shaft = shaft(&mut builder, &pose, SPEED);
    hold(&mut builder, shaft, &pose, SPEED, &Held::Fast);
    let row = row(&bearing);
    let cage = cage(
        &mut builder,
        row.pitch_radius_m,
        0.398 * SPEED * start_share,
    );
    if let Some(land) = land {
        let pair = MarkerPair {
            a: Marker::at(GROUND, [0.0; 3]),
            b: Marker::at(cage, [0.0; 3]),
        };
        builder.element(land.between("land", pair).unwrap());
    }
    let effects = DynamicEffects {
        rebound: Rebound {
            factor_s_per_m: 1.0,
        },
        traction: Some(Traction::coulomb(0.06, 2e-2).unwrap()),
        gravity_m_per_s2: None,
        cages: vec![(cage, pockets)],
        ..DynamicEffects::default()
    };
    builder.element(element(&bearing, effects, shaft));
    builder.build().unwrap()
}

/// Slow and thrust alone: balls roll at (1 − γ cos α)/2 of the shaft's speed at their contact angle, and the cage with
/// them.
#[test]
fn the_cage_tends_to_its_kinematic_speed() {
    let mut pockets = pockets();
    pockets.rebound.factor_s_per_m = 20.0;
    let system = caged(pockets, None, 0.8, PRESSED_M);
    let mut run = Simulation::new(system, Params::fixed(1e-5)).unwrap();
    let (mut sum, mut count) = (0.0, 0.0);
    run.run(0.1, |step| {
        if step.to.time_s > 0.06 {
            sum += step.to.velocity[11];
            count += 1.0;
        }
        ControlFlow::Continue(())
    })
    .unwrap();
    let bearing = bearing(B6205);
    let operation = gearmesh_bearings::Operation {
        inner_rad_per_s: SPEED,
        ..gearmesh_bearings::Operation::default()
    };
    let pose = RingPose::from_five(&Vector5::new(0.0, 0.0, PRESSED_M, 0.0, 0.0));
    let (_, loads) = bearing.loads(&pose, &operation).unwrap();
    let kinematic = loads.elements[0][0].orbit_rad_per_s;
    close(sum / count, kinematic, 2e-3);
    let found = Channels::at_end(run);
    close(found.get("bearing.orbit_speed_rad_per_s"), kinematic, 1e-3);
}

/// The acceleration of a ball is that of its equations of motion, which the integrator solves, blows of the pockets
/// and weight included; in the mean of a
/// turn under thrust alone it points to the axis with ω² r.
#[test]
fn the_acceleration_of_a_ball_is_that_of_its_motion() {
    // What Newton's method leaves of the equations is the difference.
    let params = Params {
        newton_tolerance: Some(1e-10),
        ..Params::fixed(1e-5)
    };
    let mut run = Simulation::new(caged(pockets(), None, 0.9, PRESSED_M), params).unwrap();
    for _ in 0..20 {
        run.run(run.state().time_s + 5e-4, |_| ControlFlow::Continue(()))
            .unwrap();
        let (state, solved) = (run.state().clone(), run.acceleration().to_vec());
        // A sample of a copy: the run goes on.
        let found = Channels::of(&mut caged(pockets(), None, 0.9, PRESSED_M), &state);
        let largest = solved[12..]
            .iter()
            .fold(0.0_f64, |most, a| most.max(a.abs()));
        for ball in 0..9 {
            for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
                let name = format!("bearing.ball_{}_acceleration_{name}_m_per_s2", ball + 1);
                let (found, solved) = (found.get(&name), solved[12 + 6 * ball + axis]);
                assert!(
                    (found - solved).abs() < 1e-5 * largest,
                    "{name}: {found}, {solved}"
                );
            }
        }
    }
}

/// A cage whose middle goes round the axis is seen where it is, with the speed at which it goes round.
#[test]
fn the_middle_of_the_cage_is_seen() {
    let system = caged(pockets(), None, 1.0, PRESSED_M);
    let mut state = system.start().clone();
    let (place, whirl): (Vector3<f64>, f64) = (Vector3::new(3e-5, -4e-5, 1e-5), -70.0);
    state.positions_m[1] = place;
    state.velocity[6..9].copy_from_slice(&[-whirl * place.y, whirl * place.x, 0.3]);
    let mut system = system;
    let found = Channels::of(&mut system, &state);
    close(found.get("bearing.cage_1_x_m"), 3e-5, 1e-12);
    close(found.get("bearing.cage_1_y_m"), -4e-5, 1e-12);
    close(found.get("bearing.cage_1_whirl_rad_per_s"), whirl, 1e-12);
    close(found.get("bearing.cage_1_speed_ratio"), 0.398, 1e-12);
    close(
        found.get("bearing.ball_3_angle_rad"),
        2.0 * std::f64::consts::TAU / 9.0,
        1e-9,
    );
}

/// Newton's law for the cage: what its pockets and its land do is its mass times its acceleration; and balls touch
/// their pockets in this run.
#[test]
fn pocket_forces_sum_to_the_force_on_the_cage() {
    let system = caged(pockets(), None, 0.9, PRESSED_M);
    let mut run = Simulation::new(system, Params::fixed(5e-6)).unwrap();
    let mut largest = 0.0_f64;
    run.run(0.02, |step| {
        let found = Channels::of(step.system, step.to);
        for (axis, name) in ["x", "y", "z"].iter().enumerate() {
            let force = found.get(&format!("bearing.cage_1_force_{name}_N"));
            let expected = 0.02 * step.acceleration[6 + axis];
            let size = 1e-5 * largest.max(1.0);
            assert!(
                (force - expected).abs() < size,
                "{name}: {force} {expected}"
            );
            largest = largest.max(force.abs());
        }
        ControlFlow::Continue(())
    })
    .unwrap();
    assert!(largest > 0.1, "{largest} N");
}

/// The law of a pocket is continuous and rises in the ball's displacement, also where solid contact takes over from the
/// film.
#[test]
fn the_pocket_law_is_continuous() {
    let system = |place: f64| {
        let mut pockets = pockets();
        pockets.rebound = Rebound::default();
        let mut system = caged(pockets, None, 1.0, 0.0);
        let start = system.start().clone();
        let mut increment = vec![0.0; system.degrees_of_freedom()];
        // Ball 1 stands at angle 0: along y it moves across its pocket.
        increment[13] = place;
        let probe = system
            .probe("bearing", &start, &increment, &start.velocity)
            .unwrap();
        let cage = probe.dofs.iter().position(|d| *d == Some(6)).unwrap();
        probe.force[cage + 1]
    };
    let law: Vec<f64> = (0..=60).map(|i| system(i as f64 * 2.5e-6)).collect();
    let expected = |z: f64| 100.0 * z.min(1e-4) + 1e8 * (z - 1e-4).max(0.0).powf(1.5);
    for (i, force) in law.iter().enumerate() {
        let z = i as f64 * 2.5e-6;
        assert!(
            (force - law[0] - expected(z)).abs() < 1e-6 * (1.0 + expected(z)),
            "{z}: {force} {}",
            expected(z)
        );
    }
}

fn land(side: LandSide) -> LandGuide {
    LandGuide {
        side,
        radius_m: 0.022,
        clearance_m: 2e-4,
        film: Some(LandFilm {
            viscosity_pa_s: 0.03,
            width_m: 4e-3,
        }),
        contact: LandContact {
            stiffness_n_per_m15: 1e9,
            roughness_m: 1e-5,
            rebound: Rebound {
                factor_s_per_m: 1.0,
            },
            friction: Some((0.1, 0.01)),
        },
    }
}

/// Without whirl and squeeze the film is Ocvirk's: ηUL³ε²/(C²(1 − ε²)²) against e, πηUL³ε/(4C²(1 − ε²)^1.5) across it,
/// 2πηUR²L/(C√(1 − ε²)).
#[test]
fn the_steady_film_is_ocvirks() {
    use gearmesh_dynamics::{Body, State};
    let guide = land(LandSide::Outer);
    let mut builder = System::builder();
    let cage = builder.body(Body::rigid("cage", 0.02, [1e-5; 3])).unwrap();
    let pair = MarkerPair {
        a: Marker::at(GROUND, [0.0; 3]),
        b: Marker::at(cage, [0.0; 3]),
    };
    builder.element(guide.between("land", pair).unwrap());
    let mut system = builder.build().unwrap();
    let start: State = system.start().clone();
    let (eta, r, l, c, omega) = (0.03, 0.022, 4e-3_f64, 2e-4_f64, 60.0);
    let u = r * omega;
    for epsilon in [0.05, 0.4, 0.8] {
        let increment = [epsilon * c, 0.0, 0.0, 0.0, 0.0, 0.0];
        let velocity = [0.0, 0.0, 0.0, 0.0, 0.0, omega];
        let probe = system.probe("land", &start, &increment, &velocity).unwrap();
        let at = probe.dofs.iter().position(|d| *d == Some(0)).unwrap();
        let gap: f64 = 1.0 - epsilon * epsilon;
        let size = eta * u * l.powi(3) / (c * c);
        close(
            probe.force[at],
            -size * epsilon * epsilon / gap.powi(2),
            1e-9,
        );
        let across = std::f64::consts::PI * size * epsilon / (4.0 * gap.powf(1.5));
        close(probe.force[at + 1], across, 1e-9);
        let drag = 2.0 * std::f64::consts::PI * eta * u * r * r * l / (c * gap.sqrt());
        close(
            probe.force[at + 5],
            -drag - 0.5 * epsilon * c * across,
            1e-9,
        );
    }
    // Carried round at half its speed the film does not carry along e: 1 − 2ϕ̇/ω = 0.
    let increment = [0.5 * c, 0.0, 0.0, 0.0, 0.0, 0.0];
    let velocity = [0.0, 0.5 * omega * 0.5 * c, 0.0, 0.0, 0.0, omega];
    let probe = system.probe("land", &start, &increment, &velocity).unwrap();
    let at = probe.dofs.iter().position(|d| *d == Some(0)).unwrap();
    assert!(probe.force[at].abs() < 1e-12 && probe.force[at + 1].abs() < 1e-12);
}

/// A cage thrown at its land stays inside it, whichever ring has the land, and a cage on its balls stays in the middle
/// without any.
#[test]
fn cages_stay_where_they_are_guided() {
    let throw = |guide: Option<LandGuide>, pockets: Pockets| {
        let system = caged(pockets, guide, 1.0, PRESSED_M);
        let mut state = system.start().clone();
        state.velocity[6] = 0.05;
        let mut run = Simulation::from_state(system, state, Params::fixed(1e-5)).unwrap();
        let mut furthest = 0.0_f64;
        run.run(0.03, |step| {
            let place: &Vector3<f64> = &step.to.positions_m[1];
            furthest = furthest.max(place.x.hypot(place.y));
            ControlFlow::Continue(())
        })
        .unwrap();
        furthest
    };
    let mut loose = pockets();
    loose.film_stiffness_n_per_m = 0.0;
    loose.clearance_m = 6e-4;
    for side in [LandSide::Outer, LandSide::Inner] {
        let furthest = throw(Some(land(side)), loose.clone());
        assert!((5e-5..2.1e-4).contains(&furthest), "{side:?}: {furthest}");
    }
    loose.shape = PocketShape::Spherical;
    loose.clearance_m = 1e-4;
    let furthest = throw(None, loose);
    assert!((5e-5..1.5e-4).contains(&furthest), "{furthest}");
}
