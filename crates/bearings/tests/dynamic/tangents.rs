//! Every derivative that the element states, against differences of its force.

use gearmesh_bearings::dynamic::{
    DynamicBearing, DynamicEffects, FluidTraction, LandContact, LandFilm, LandGuide, LandSide,
    PocketShape, Pockets, Rebound, StatedContact, Traction,
};
use gearmesh_bearings::quasi_static::{QuasiStaticBearing, Row};
use gearmesh_dynamics::{Body, Marker, MarkerPair, Params, Simulation, State, System};
use nalgebra::{UnitQuaternion, Vector3};

use crate::common::{B218, B6205, PAIR, bearing};

/// Numbers between −1 and 1, the same in every run.
struct Numbers(fastrand::Rng);

impl Numbers {
    fn with_seed(seed: u64) -> Self {
        Self(fastrand::Rng::with_seed(seed))
    }

    fn next(&mut self) -> f64 {
        2.0 * self.0.f64() - 1.0
    }

    fn vector(&mut self, size: f64) -> Vector3<f64> {
        Vector3::from_fn(|_, _| size * self.next())
    }
}

/// Housing, shaft and cages, all of them free, somewhere in space.
fn free_bodies(
    bearing: &QuasiStaticBearing,
    effects: &DynamicEffects,
    pockets: Option<&Pockets>,
    numbers: &mut Numbers,
) -> System {
    let mut builder = System::builder();
    let orientation = UnitQuaternion::from_scaled_axis(numbers.vector(1.0));
    let place = numbers.vector(0.1);
    let mut body = |name: &str, point: Vector3<f64>| {
        let mut body = Body::rigid(name, 1.0, [1e-3; 3]);
        body.orientation = orientation;
        body.position_m = place - orientation * point;
        builder.body(body).unwrap()
    };
    let points = [numbers.vector(0.05), numbers.vector(0.05)];
    let (housing, shaft) = (body("housing", points[0]), body("shaft", points[1]));
    let mut effects = effects.clone();
    if let Some(pockets) = pockets {
        for row in 0..bearing.rows.len() {
            let cage = body(&format!("cage {row}"), Vector3::zeros());
            effects.cages.push((cage, pockets.clone()));
        }
    }
    let pair = MarkerPair {
        a: Marker::at(housing, points[0].into()),
        b: Marker::at(shaft, points[1].into()),
    };
    builder.element(DynamicBearing::new("bearing", pair, bearing, effects).unwrap());
    builder.build().unwrap()
}

/// What is added to a state.
struct Change {
    increment: Vec<f64>,
    velocity: Vec<f64>,
}

/// A random motion: rings some micrometres apart, balls some micrometres away from their equilibrium, everything in
/// motion.
fn change(system: &System, numbers: &mut Numbers) -> Change {
    let n = system.degrees_of_freedom();
    let first = system.layout().first_unknown();
    let turning = system.layout().unknowns().iter().any(|u| u.scale == 1.0);
    let per_ball = if turning { 6 } else { 3 };
    let is_turn = |dof: usize| {
        let place = if dof < first {
            dof % 6
        } else {
            (dof - first) % per_ball
        };
        place >= 3
    };
    let mut sizes = (0..n).map(|dof| {
        if is_turn(dof) {
            (2e-4, 20.0)
        } else {
            (1.2e-5, 0.2)
        }
    });
    let (mut increment, mut velocity) = (Vec::new(), Vec::new());
    for (place, speed) in sizes.by_ref() {
        increment.push(place * numbers.next());
        velocity.push(speed * numbers.next());
    }
    Change {
        increment,
        velocity,
    }
}

/// Fourth-order difference of the force by one degree of freedom.
fn difference(
    system: &mut System,
    start: &State,
    at: &Change,
    (dof, by_velocity): (usize, bool),
    step: f64,
) -> Vec<f64> {
    // Turning a body adds up from its own orientation, so that the state is moved first.
    let mut force = |factor: f64| {
        let (mut increment, mut velocity) = (at.increment.clone(), at.velocity.clone());
        let moved = if by_velocity {
            &mut velocity
        } else {
            &mut increment
        };
        moved[dof] += factor * step;
        system
            .probe("bearing", start, &increment, &velocity)
            .unwrap()
            .force
    };
    let [a, b, c, d] = [-2.0, 2.0, 1.0, -1.0].map(&mut force);
    (0..a.len())
        .map(|i| (a[i] - b[i] + 8.0 * (c[i] - d[i])) / (12.0 * step))
        .collect()
}

/// Largest misfit of a column, forces and moments each over their largest entry in both.
fn misfit(exact: &[f64], other: &[f64], is_moment: impl Fn(usize) -> bool) -> f64 {
    let mut worst = 0.0_f64;
    for moments in [false, true] {
        let rows = || (0..exact.len()).filter(|&row| is_moment(row) == moments);
        let largest = rows().map(|row| exact[row].abs()).fold(0.0, f64::max);
        let miss = rows().map(|row| (exact[row] - other[row]).abs());
        let miss = miss.fold(0.0, f64::max);
        if miss > 0.0 {
            worst = worst.max(miss / largest);
        }
    }
    worst
}

/// Checks random columns of random states; returns states with a loaded and a lifted-off ball.
fn check(
    text: &str,
    balls: usize,
    effects: &DynamicEffects,
    pockets: Option<&Pockets>,
    states: usize,
) -> usize {
    let mut bearing = bearing(text);
    for row in &mut bearing.rows {
        if let Row::Ball(row) = row {
            row.balls = balls;
        }
    }
    let mut numbers = Numbers::with_seed(states as u64 + text.len() as u64);
    let (mut mixed, mut judged, mut unjudged) = (0, 0, 0);
    let system = free_bodies(&bearing, effects, pockets, &mut numbers);
    // Balls with spalls take their orientation where a run begins.
    let mut system = Simulation::new(system, Params::fixed(1e-6))
        .unwrap()
        .into_system();
    let start = system.start().clone();
    let n = system.degrees_of_freedom();
    let first = system.layout().first_unknown();
    let turning = system.layout().unknowns().iter().any(|u| u.scale == 1.0);
    let per_ball = if turning { 6 } else { 3 };
    for _ in 0..states {
        let at = change(&system, &mut numbers);
        // The state moved to, so that what is differenced turns from there.
        let exact = system
            .probe("bearing", &start, &at.increment, &at.velocity)
            .unwrap();
        let touching = (0..bearing.rows.len() * balls).filter(|ball| {
            let own = exact.force.len() - bearing.rows.len() * balls * per_ball + ball * per_ball;
            exact.force[own..own + 3].iter().any(|f| f.abs() > 1e-3)
        });
        let touching = touching.count();
        if touching > 0 && touching < bearing.rows.len() * balls {
            mixed += 1;
        }
        for _ in 0..6 {
            let dof = (0.5 * (numbers.next() + 1.0) * n as f64) as usize;
            // Of bodies' turns the columns are by increments from the state moved to: take those that start at zero.
            let mut here = Change {
                increment: at.increment.clone(),
                velocity: at.velocity.clone(),
            };
            if dof < first && dof % 6 >= 3 {
                let body = dof - dof % 6;
                here.increment[body + 3..body + 6].fill(0.0);
            }
            let exact = system
                .probe("bearing", &start, &here.increment, &here.velocity)
                .unwrap();
            let column = exact.dofs.iter().position(|d| *d == Some(dof)).unwrap();
            let is_moment = |row: usize| {
                let dof = exact.dofs[row].unwrap();
                let place = if dof < first {
                    dof % 6
                } else {
                    (dof - first) % per_ball
                };
                place >= 3
            };
            for by_velocity in [false, true] {
                let matrix = if by_velocity {
                    &exact.by_velocity
                } else {
                    &exact.by_position
                };
                let stated: Vec<f64> = matrix.column(column).iter().copied().collect();
                // Across a place where a ball is about to touch, or a pocket's film ends, no difference says anything:
                // there they disagree.
                let steps = if by_velocity {
                    [3e-4, 1e-4, 3e-5]
                } else {
                    [1e-8, 3e-9, 1e-9]
                };
                let found = steps.map(|h| {
                    let scale = if is_moment(column) && !by_velocity {
                        10.0
                    } else {
                        1.0
                    };
                    difference(&mut system, &start, &here, (dof, by_velocity), h * scale)
                });
                let agree = found
                    .windows(2)
                    .filter(|pair| misfit(&pair[0], &pair[1], is_moment) < 5e-7);
                let best = agree
                    .map(|pair| misfit(&stated, &pair[1], is_moment))
                    .fold(f64::INFINITY, f64::min);
                if best == f64::INFINITY {
                    unjudged += 1;
                    continue;
                }
                judged += 1;
                assert!(
                    best < 1e-6,
                    "{best:e}: dof {dof} of {n}, bodies end at {first}, by velocity: {by_velocity}\n{stated:?}\n{:?}",
                    found[1]
                );
            }
        }
    }
    assert!(
        unjudged < judged / 5,
        "{unjudged} columns beside {judged} could not be judged"
    );
    mixed
}

fn coulomb() -> Traction {
    Traction::coulomb(0.07, 0.05).unwrap()
}

const BLOWS: Rebound = Rebound {
    factor_s_per_m: 0.3,
};

#[test]
fn tangents_of_free_balls_are_derivatives() {
    let clearance = format!("{B6205}radial_clearance_um = 12.0\n");
    let bare = DynamicEffects::default();
    let damped = DynamicEffects {
        rebound: BLOWS,
        ..DynamicEffects::default()
    };
    let stated = DynamicEffects {
        contact: Some(StatedContact {
            stiffness_n_per_m_e: 1e7 * 1e3_f64.powf(2.2),
            exponent: 2.2,
            damping_n_s_per_m: 1000.0,
            full_damping_depth_m: 1e-5,
        }),
        ..DynamicEffects::default()
    };
    let mixed = check(&clearance, 4, &bare, None, 150)
        + check(PAIR, 3, &damped, None, 150)
        + check(&clearance, 4, &stated, None, 150);
    assert!(mixed > 200, "{mixed} states with lifted-off balls");
}

#[test]
fn tangents_of_rolling_balls_are_derivatives() {
    let with = |traction| DynamicEffects {
        rebound: BLOWS,
        traction: Some(traction),
        ..DynamicEffects::default()
    };
    let fluid = FluidTraction {
        viscosity_pa_s: 0.033,
        pressure_viscosity_per_pa: 15e-9,
        eyring_stress_pa: 5e6,
        film_thickness_m: 0.3e-6,
    };
    let table = Traction::table(&[(0.05, 0.03), (0.2, 0.06), (1.0, 0.05)]).unwrap();
    let mixed = check(B218, 4, &with(coulomb()), None, 200)
        + check(B6205, 4, &with(Traction::Fluid(fluid)), None, 150)
        + check(PAIR, 3, &with(table), None, 100);
    assert!(mixed > 100, "{mixed} states with lifted-off balls");
}

/// Rims of spalls under two balls, waves and an off-size ball; the same with balls that have spalls, which turn.
#[test]
fn tangents_of_faults_are_derivatives() {
    let races = "[[fault]]\nkind = \"race-spall\"\nrace = \"outer\"\nangle_deg = 2.2\nlength_mm = 2.0\nwidth_mm = 1.0\ndepth_um = 5.0\n\
                 [[fault]]\nkind = \"race-spall\"\nrace = \"inner\"\nangle_deg = 93.2\nlength_mm = 2.0\ndepth_um = 5.0\n\
                 [[fault]]\nkind = \"waviness\"\nrace = \"inner\"\norder = 11\nradial_um = 1.0\naxial_um = 2.0\nphase_deg = 20.0\n\
                 [[fault]]\nkind = \"waviness\"\nrace = \"outer\"\norder = 6\naxial_um = 1.5\n\
                 [[fault]]\nkind = \"off-size-ball\"\nball = 1\noversize_um = 3.0\n\
                 [[fault]]\nkind = \"misaligned-ring\"\nring = \"inner\"\ntilt_mrad = [0.1, -0.05]\noffset_um = [1.0, 0.0, 2.0]\n";
    let balls = "[[fault]]\nkind = \"ball-spall\"\nball = 1\nangle_deg = 10.8\ndiameter_mm = 2.0\ndepth_um = 2.0\n\
                 [[fault]]\nkind = \"ball-spall\"\nball = 2\nangle_deg = 172.0\nbeside_deg = 3.0\ndiameter_mm = 2.0\ndepth_um = 2.0\n";
    let damped = DynamicEffects {
        rebound: BLOWS,
        ..DynamicEffects::default()
    };
    let rolling = DynamicEffects {
        rebound: BLOWS,
        traction: Some(coulomb()),
        ..DynamicEffects::default()
    };
    check(&format!("{B6205}{races}"), 4, &damped, None, 150);
    check(&format!("{B6205}{races}{balls}"), 4, &rolling, None, 150);
}

#[test]
fn tangents_of_cages_are_derivatives() {
    let pockets = |shape, traction| Pockets {
        shape,
        clearance_m: 1e-5,
        film_stiffness_n_per_m: 2e5,
        contact_stiffness_n_per_m15: 1e9,
        rebound: BLOWS,
        traction,
    };
    let bare = DynamicEffects::default();
    let rolling = DynamicEffects {
        traction: Some(coulomb()),
        ..DynamicEffects::default()
    };
    let bore = pockets(PocketShape::Cylindrical, None);
    let ball = pockets(PocketShape::Spherical, Some(coulomb()));
    check(B6205, 4, &bare, Some(&bore), 150);
    check(PAIR, 3, &rolling, Some(&ball), 150);
}

#[test]
fn tangents_of_lands_are_derivatives() {
    let mut numbers = Numbers::with_seed(7);
    for (side, film) in [
        (LandSide::Outer, true),
        (LandSide::Inner, true),
        (LandSide::Inner, false),
    ] {
        let guide = LandGuide {
            side,
            radius_m: 0.022,
            clearance_m: 2e-4,
            film: film.then_some(LandFilm {
                viscosity_pa_s: 0.033,
                width_m: 4e-3,
            }),
            contact: LandContact {
                stiffness_n_per_m15: 1e9,
                roughness_m: 1e-5,
                rebound: BLOWS,
                friction: Some((0.1, 0.05)),
            },
        };
        let mut builder = System::builder();
        let mut body = |name: &str| builder.body(Body::rigid(name, 1.0, [1e-3; 3])).unwrap();
        let pair = MarkerPair {
            a: Marker::at(body("ring"), [0.01, 0.0, 0.02]),
            b: Marker::at(body("cage"), [0.01, 0.0, 0.02]),
        };
        builder.element(guide.between("bearing", pair).unwrap());
        let mut system = builder.build().unwrap();
        let start = system.start().clone();
        for state in 0..60 {
            let mut at = Change {
                increment: vec![0.0; 12],
                velocity: (0..12).map(|_| numbers.next()).collect(),
            };
            // Film, and beyond it solid contact.
            let reach = if state % 3 == 0 { 2.2e-4 } else { 1.2e-4 };
            at.increment[6] = reach * numbers.next();
            at.increment[7] = reach * numbers.next();
            at.velocity[11] = 60.0 + 20.0 * numbers.next();
            let exact = system
                .probe("bearing", &start, &at.increment, &at.velocity)
                .unwrap();
            for dof in 0..12 {
                for by_velocity in [false, true] {
                    let matrix = if by_velocity {
                        &exact.by_velocity
                    } else {
                        &exact.by_position
                    };
                    let stated: Vec<f64> = matrix.column(dof).iter().copied().collect();
                    let h = if by_velocity { 1e-4 } else { 1e-8 };
                    let which = (dof, by_velocity);
                    let found = difference(&mut system, &start, &at, which, h);
                    let size = exact.by_position.norm().max(exact.by_velocity.norm());
                    let largest = stated.iter().fold(1e-7 * size, |a, b| a.max(b.abs()));
                    for (a, b) in stated.iter().zip(&found) {
                        assert!(
                            (a - b).abs() <= 1e-6 * largest,
                            "{side:?} {which:?} {at:?}: {a} {b}",
                            at = at.increment
                        );
                    }
                }
            }
        }
    }
}
