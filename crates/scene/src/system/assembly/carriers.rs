//! Which body carries which: a planet gear turns on its carrier, and goes round with it.
//!
//! Joints, bearings and shafts make a graph; seen from the ground, the body through which another one is reached
//! carries it. At the start what is carried moves with its carrier,
//!
//! ```text
//! ẋ = ẋ_c + ω_c × (x − x_c) + (ω − ω_c) × (x − p)        p: on the axis on which it turns
//! ```
//!
//! unless the scene states its velocity.

use gearmesh_specification::gear_tables::MM;
use gearmesh_specification::system::bearing::BearingTable;
use std::collections::VecDeque;

use nalgebra::Vector3;

use super::bodies::Bodies;
use super::joints::PlacedJoint;
use super::shafts::PlacedShaft;

/// What holds bodies.
#[derive(Clone, Copy)]
pub(super) struct Holds<'a> {
    pub joints: &'a [PlacedJoint<'a>],
    pub bearings: &'a [BearingTable],
    pub shafts: &'a [PlacedShaft],
}

/// Two bodies that are held to each other, none for the ground, and a point of the axis they may turn about.
struct Hold {
    ends: [Option<usize>; 2],
    at_m: Vector3<f64>,
}

/// A body that is carried by another one.
pub(super) struct Carried {
    pub body: usize,
    /// None: the ground, or nothing.
    pub carrier: Option<usize>,
    at_m: Vector3<f64>,
}

/// All bodies, each after its carrier.
pub(super) fn find(
    bodies: &Bodies,
    Holds {
        joints,
        bearings,
        shafts,
    }: Holds<'_>,
) -> Vec<Carried> {
    let mut holds: Vec<Hold> = Vec::new();
    for PlacedJoint { seat, .. } in joints {
        let (ends, at_m) = (seat.ends, seat.frame.origin_m);
        holds.push(Hold { ends, at_m });
    }
    // What a bearing names wrongly is refused where it is made.
    let number = |name: &str| bodies.number(name);
    for bearing in bearings {
        let first = bearing.body_1.as_deref().and_then(number);
        let ends = [first, number(&bearing.body_2)];
        let seat = ends[1].map_or(Vector3::zeros(), |body| bodies.list[body].body.position_m);
        let at_m = bearing.at_mm.map_or(seat, |at| MM * Vector3::from(at));
        holds.push(Hold { ends, at_m });
    }
    for shaft in shafts {
        let own: Vec<usize> = shaft.bodies().collect();
        for pair in own.windows(2) {
            let at_m = bodies.list[pair[0]].body.position_m;
            let ends = [Some(pair[0]), Some(pair[1])];
            holds.push(Hold { ends, at_m });
        }
    }
    let mut found: Vec<Carried> = Vec::new();
    let mut reached = vec![false; bodies.list.len()];
    let mut next: VecDeque<Option<usize>> = VecDeque::from([None]);
    while let Some(carrier) = next.pop_front() {
        for hold in &holds {
            for (from, to) in [(0, 1), (1, 0)] {
                let (Some(body), true) = (hold.ends[to], hold.ends[from] == carrier) else {
                    continue;
                };
                if !std::mem::replace(&mut reached[body], true) {
                    found.push(Carried {
                        body,
                        carrier,
                        at_m: hold.at_m,
                    });
                    next.push_back(Some(body));
                }
            }
        }
    }
    // What hangs on nothing is nobody's.
    for (body, reached) in reached.into_iter().enumerate() {
        if !reached {
            found.push(Carried {
                body,
                carrier: None,
                at_m: bodies.list[body].body.position_m,
            });
        }
    }
    found
}

impl Carried {
    /// Lets the body move with its carrier, whose motion is known. Axes that are not parallel are left alone.
    pub(super) fn go_along(&self, bodies: &mut Bodies) {
        let Some(carrier) = self.carrier else {
            return;
        };
        let (leading, led) = (&bodies.list[carrier], &bodies.list[self.body]);
        let crossed = leading.axis().cross(&led.axis()).norm() > 1e-9;
        if !led.velocity_is_free || crossed {
            return;
        }
        let (omega, own) = (leading.turning(), led.turning());
        let from_carrier = led.body.position_m - leading.body.position_m;
        let mut velocity = leading.body.velocity_m_per_s + omega.cross(&from_carrier);
        if !led.speed_is_free {
            velocity += (own - omega).cross(&(led.body.position_m - self.at_m));
        }
        bodies.list[self.body].body.velocity_m_per_s = velocity;
    }
}
