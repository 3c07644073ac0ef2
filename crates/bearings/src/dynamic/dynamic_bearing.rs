//! A ball bearing between two bodies of a system, every ball a body of its own.

use std::f64::consts::TAU;
use std::sync::Arc;

use gearmesh_dynamics::elements::{Channel, ForceElement, Loads, View};
use gearmesh_dynamics::{BodyId, BodyMotion, ElementFailure, Marker, MarkerPair, Power, Unknown};
use nalgebra::{Vector3, Vector6};

use super::ball_on_body::{Ball, BallPlaces, Carrier};
use super::ball_start::start_of_row;
use super::contact_damping::StatedContact;
use super::effort::{BearingEffort, count};
use super::groove_touch::{groove_touch, hertz_load};
use super::pockets::Pockets;
use super::rebound::Rebound;
use super::surface_contact::{SurfaceForce, surface_force};
use super::traction::Traction;
use crate::ball_row::{BallRow, Groove};
use crate::error::BearingError;
use crate::operation::Operation;
use crate::quasi_static::{QuasiStaticBearing, Row};
use crate::ring_channels::{RING_CHANNELS, race_loads, ring_channels, sample_ring};
use crate::ring_pose::RingPose;

/// What a bearing's balls feel besides the elastic races. The default is nothing.
#[derive(Debug, Clone, Default)]
pub struct DynamicEffects {
    /// Load and damping of the contacts at the races by a stated law; none: Hertz with `rebound`. Balls start at Hertz' places all the same.
    pub contact: Option<StatedContact>,
    /// Damping of Hertz' contacts at the races.
    pub rebound: Rebound,
    /// Friction at the races; without it balls do not turn.
    pub traction: Option<Traction>,
    /// Weight of the balls \[m/s²\], world axes.
    pub gravity_m_per_s2: Option<[f64; 3]>,
    /// A cage for each row, in the order of rows; none: balls are free. A cage is a body of the system whose reference point is its middle and whose z axis
    /// is that of the bearing; its pockets stand where the balls are at the start, turned with the body.
    pub cages: Vec<(BodyId, Pockets)>,
}

/// A ball bearing: the outer ring on marker A, the inner ring on marker B, z along the axis of each.
///
/// Channels: force and moment on the inner ring (axes of marker A, moment about marker B's place), mean orbital speed of the balls against the outer ring; with
/// [`Self::with_ball_loads`] the load of every ball at both races; with cages the force on each by its pockets.
pub struct DynamicBearing {
    name: String,
    pair: MarkerPair,
    bodies: Vec<BodyId>,
    rows: Vec<BallRow>,
    effects: DynamicEffects,
    ball_loads: bool,
    effort: Option<Arc<BearingEffort>>,
}

/// The rings at a motion: body, middle and axis.
struct Ring<'a> {
    carrier: Carrier<'a>,
    middle: Vector3<f64>,
    axis: Vector3<f64>,
}

impl<'a> Ring<'a> {
    fn new(marker: &Marker, motion: &'a BodyMotion, first: usize) -> Self {
        Self {
            carrier: Carrier::new(motion, first),
            middle: motion.position_m + motion.rotation * marker.position_m,
            axis: motion.rotation * (marker.orientation() * Vector3::z()),
        }
    }
}

impl DynamicBearing {
    /// Puts a bearing between its outer ring (marker A) and its inner ring (marker B).
    ///
    /// # Errors
    /// [`BearingError::NotCarried`] for bearings with rollers, or where there are cages but not one for each row.
    pub fn new(
        name: &str,
        pair: MarkerPair,
        bearing: &QuasiStaticBearing,
        effects: DynamicEffects,
    ) -> Result<Self, BearingError> {
        let mut rows = Vec::with_capacity(bearing.rows.len());
        for row in &bearing.rows {
            match row {
                Row::Ball(row) => rows.push(row.clone()),
                Row::Roller(_) => {
                    return Err(BearingError::NotCarried(
                        "only ball bearings have the model `dynamic`; take `quasi-static` for rollers",
                    ));
                }
            }
        }
        if !effects.cages.is_empty() && effects.cages.len() != rows.len() {
            return Err(BearingError::NotCarried(
                "each row of balls has a cage of its own: give as many cages as rows, or none",
            ));
        }
        let mut bodies = vec![pair.a.body, pair.b.body];
        bodies.extend(effects.cages.iter().map(|(body, _)| *body));
        Ok(Self {
            name: name.to_owned(),
            pair,
            bodies,
            rows,
            effects,
            ball_loads: false,
            effort: None,
        })
    }

    /// Adds the load of every ball to the channels: `ball_<number>_inner_N`, `ball_<number>_outer_N`, counted from one, row after row.
    #[must_use]
    pub fn with_ball_loads(mut self) -> Self {
        self.ball_loads = true;
        self
    }

    /// Counts what is evaluated.
    #[must_use]
    pub fn counted(mut self, effort: Arc<BearingEffort>) -> Self {
        self.effort = Some(effort);
        self
    }

    /// Coordinates of a ball.
    fn per_ball(&self) -> usize {
        if self.turns() { 6 } else { 3 }
    }

    /// Whether anything turns the balls.
    fn turns(&self) -> bool {
        let rubs = |(_, pockets): &(BodyId, Pockets)| pockets.traction.is_some();
        self.effects.traction.is_some() || self.effects.cages.iter().any(rubs)
    }

    fn balls(&self) -> usize {
        self.rows.iter().map(|row| row.balls).sum()
    }

    /// Rows, and numbers of their balls among all.
    fn numbered(&self) -> impl Iterator<Item = (usize, &BallRow, usize, usize)> {
        let rows = self.rows.iter().enumerate();
        rows.flat_map(|(place, row)| {
            let before: usize = self.rows[..place].iter().map(|row| row.balls).sum();
            (0..row.balls).map(move |ball| (place, row, ball, before + ball))
        })
    }

    fn ball(&self, view: &View<'_>, row: &BallRow, number: usize) -> Ball {
        let first = number * self.per_ball();
        let three = |values: &[f64], first: usize| {
            Vector3::new(values[first], values[first + 1], values[first + 2])
        };
        Ball {
            place_m: three(view.unknowns(), first),
            velocity_m_per_s: three(view.unknown_rates(), first),
            spin_rad_per_s: if self.turns() {
                three(view.unknown_rates(), first + 3)
            } else {
                Vector3::zeros()
            },
            radius_m: 0.5 * row.ball_diameter_m,
        }
    }

    fn rings<'a>(&self, view: &'a View<'_>, first: [usize; 2]) -> [Ring<'a>; 2] {
        let motions = [self.pair.a.body, self.pair.b.body].map(|body| view.body(body));
        [
            Ring::new(&self.pair.a, motions[0], first[0]),
            Ring::new(&self.pair.b, motions[1], first[1]),
        ]
    }

    /// Force of a race on a ball; none where they do not touch.
    fn at_race(
        &self,
        groove: &Groove,
        ring: &Ring<'_>,
        ball: &Ball,
        tangents: bool,
    ) -> Option<SurfaceForce> {
        if let Some(effort) = &self.effort {
            count(&effort.races);
        }
        let touch = groove_touch(groove, &(ball.place_m - ring.middle), &ring.axis)?;
        if touch.approach_m <= 0.0 {
            return None;
        }
        let law = self.effects.traction.as_ref().map(|traction| {
            let effort = self.effort.as_deref();
            move |load: f64, slip: f64| {
                if let Some(effort) = effort {
                    count(&effort.tractions);
                }
                traction.slip(&groove.contact, load, slip)
            }
        });
        if let Some(effort) = &self.effort {
            count(&effort.contacts);
        }
        Some(surface_force(
            &touch,
            |rate| match &self.effects.contact {
                None => {
                    let elastic = hertz_load(groove, touch.approach_m);
                    self.effects.rebound.damped(&elastic, rate)
                }
                Some(stated) => stated.damped(touch.approach_m, rate),
            },
            &ring.carrier.against(ball),
            law,
            tangents,
        ))
    }

    /// Force of a cage on the ball in its pocket.
    fn in_pocket(
        &self,
        (row, place, ball_of_row): (&BallRow, usize, usize),
        cage: &Carrier<'_>,
        ball: &Ball,
        tangents: bool,
    ) -> Option<SurfaceForce> {
        let (_, pockets) = &self.effects.cages[place];
        if let Some(effort) = &self.effort {
            count(&effort.pockets);
        }
        let angle = row.first_angle_rad + TAU * ball_of_row as f64 / row.balls as f64;
        let touch = pockets.touch(
            &ball.place_m,
            cage.motion,
            row.pitch_radius_m,
            angle.sin_cos(),
        );
        let elastic = pockets.load(touch.approach_m);
        if elastic.load_n == 0.0 && elastic.slope_n_per_m == 0.0 {
            return None;
        }
        let law = pockets.traction.as_ref().map(|traction| {
            move |load: f64, slip: f64| traction.slip(&row.inner.contact, load, slip)
        });
        Some(surface_force(
            &touch,
            |rate| pockets.rebound.damped(&elastic, rate),
            &cage.against(ball),
            law,
            tangents,
        ))
    }
}

impl ForceElement for DynamicBearing {
    fn name(&self) -> &str {
        &self.name
    }

    fn bodies(&self) -> &[BodyId] {
        &self.bodies
    }

    fn unknowns(&self) -> Vec<Unknown> {
        let axes = ["x", "y", "z"];
        let mut unknowns = Vec::with_capacity(self.balls() * self.per_ball());
        for (_, row, _, number) in self.numbered() {
            let mass = row.ball_mass_kg;
            for axis in axes {
                let name = format!("ball_{}_{axis}_m", number + 1);
                unknowns.push(Unknown::inertial(&name, mass, row.pitch_radius_m));
            }
            if self.turns() {
                let inertia = 0.1 * mass * row.ball_diameter_m.powi(2);
                for axis in axes {
                    let name = format!("ball_{}_turn_{axis}_rad", number + 1);
                    unknowns.push(Unknown::inertial(&name, inertia, 1.0));
                }
            }
        }
        unknowns
    }

    fn start_unknowns(&self, view: &View<'_>, values: &mut [f64], rates: &mut [f64]) {
        let [a, b] = [self.pair.a.body, self.pair.b.body].map(|body| view.body(body));
        let motion = self.pair.motion(a, b);
        let axes = a.rotation * self.pair.a.orientation().matrix();
        let [outer, inner] = [(a, &self.pair.a), (b, &self.pair.b)].map(|(body, marker)| {
            let axis = marker.orientation() * Vector3::z();
            body.angular_velocity_rad_per_s.dot(&axis)
        });
        let pose = RingPose {
            centre_m: motion.displacement_m,
            axis: motion.rotation.column(2).into(),
        };
        let operation = Operation {
            inner_rad_per_s: inner,
            outer_rad_per_s: outer,
            ..Operation::default()
        };
        let origin = a.position_m + a.rotation * self.pair.a.position_m;
        let drift = a.velocity_m_per_s
            + a.rotation * a.angular_velocity_rad_per_s.cross(&self.pair.a.position_m);
        let per_ball = self.per_ball();
        let mut first = 0;
        for row in &self.rows {
            for start in start_of_row(row, &pose, &operation) {
                let place = origin + axes * start.place_m;
                let velocity = drift + axes * start.velocity_m_per_s;
                values[first..first + 3].copy_from_slice(place.as_slice());
                rates[first..first + 3].copy_from_slice(velocity.as_slice());
                if per_ball == 6 {
                    let spin = axes * start.spin_rad_per_s;
                    rates[first + 3..first + 6].copy_from_slice(spin.as_slice());
                }
                first += per_ball;
            }
        }
    }

    /// A ball meets the two rings and its cage.
    fn couplings(&self, starts: &[usize]) -> Vec<Vec<usize>> {
        let per_ball = self.per_ball();
        let unknowns = starts[starts.len() - 1];
        let body = |place: usize| starts[place]..starts[place] + 6;
        let groups = self.numbered().map(|(place, _, _, number)| {
            let own = unknowns + number * per_ball;
            let mut group: Vec<usize> = body(0).chain(body(1)).collect();
            if !self.effects.cages.is_empty() {
                group.extend(body(2 + place));
            }
            group.extend(own..own + per_ball);
            group
        });
        groups.collect()
    }

    fn evaluate(&mut self, view: &View<'_>, loads: &mut Loads) -> Result<(), ElementFailure> {
        let tangents = loads.wants_tangents();
        let rings = self.rings(view, [loads.starts()[0], loads.starts()[1]]);
        let per_ball = self.per_ball();
        let mut power = Power::default();
        for (place, row, ball_of_row, number) in self.numbered() {
            let ball = self.ball(view, row, number);
            let first = loads.first_unknown() + number * per_ball;
            let places = BallPlaces {
                place: first,
                spin: (per_ball == 6).then_some(first + 3),
            };
            let mut add = |carrier: &Carrier<'_>, found: &SurfaceForce, loads: &mut Loads| {
                carrier.add(&ball, places, found, loads);
                power.stored_j += found.stored_j;
                power.dissipated_w += found.dissipated_w;
            };
            for (ring, groove) in rings.iter().zip([&row.outer, &row.inner]) {
                if let Some(found) = self.at_race(groove, ring, &ball, tangents) {
                    add(&ring.carrier, &found, loads);
                }
            }
            if let Some((body, _)) = self.effects.cages.get(place) {
                let cage = Carrier::new(view.body(*body), loads.starts()[2 + place]);
                let which = (row, place, ball_of_row);
                if let Some(found) = self.in_pocket(which, &cage, &ball, tangents) {
                    add(&cage, &found, loads);
                }
            }
            if let Some(gravity) = self.effects.gravity_m_per_s2 {
                let weight = Vector3::from(gravity) * (row.ball_mass_kg * view.load_factor);
                loads.add_force(first, weight.as_slice());
                power.stored_j -= weight.dot(&ball.place_m);
            }
        }
        loads.power = power;
        Ok(())
    }

    fn channels(&self) -> Vec<Channel> {
        let mut channels = ring_channels();
        let orbit = "mean angular speed of the balls about the axis, against the outer ring";
        channels.push(Channel::new("orbit_speed_rad_per_s", "rad/s", orbit));
        for cage in 1..=self.effects.cages.len() {
            let what = "force of the balls on the cage, world axes";
            channels.extend(
                ["x", "y", "z"]
                    .map(|axis| Channel::new(format!("cage_{cage}_force_{axis}_N"), "N", what)),
            );
        }
        if self.ball_loads {
            for ball in 1..=self.balls() {
                channels.extend(race_loads("ball", ball));
            }
        }
        channels
    }

    fn sample(&mut self, view: &View<'_>, out: &mut [f64]) {
        out.fill(0.0);
        let rings = self.rings(view, [0, 0]);
        let (mut force, mut moment) = (Vector3::zeros(), Vector3::zeros());
        let mut orbit = 0.0;
        let cages = self.effects.cages.len();
        let first_cage = RING_CHANNELS + 1;
        let first_load = first_cage + 3 * cages;
        for (place, row, ball_of_row, number) in self.numbered() {
            let ball = self.ball(view, row, number);
            let [outer, inner] = [(&rings[0], &row.outer), (&rings[1], &row.inner)]
                .map(|(ring, groove)| self.at_race(groove, ring, &ball, false));
            if let Some(inner) = &inner {
                force -= inner.force;
                let arm = ball.place_m - rings[1].middle;
                moment -= arm.cross(&inner.force) + inner.moment;
            }
            let against = rings[0].carrier.against(&ball);
            let arm = ball.place_m - rings[0].middle;
            let across = arm - rings[0].axis * arm.dot(&rings[0].axis);
            orbit += rings[0].axis.dot(&across.cross(&against.velocity)) / across.norm_squared();
            if let Some((body, _)) = self.effects.cages.get(place) {
                let cage = Carrier::new(view.body(*body), 0);
                let which = (row, place, ball_of_row);
                if let Some(found) = self.in_pocket(which, &cage, &ball, false) {
                    for axis in 0..3 {
                        out[first_cage + 3 * place + axis] -= found.force[axis];
                    }
                }
            }
            if self.ball_loads {
                let load = |found: &Option<SurfaceForce>| found.map_or(0.0, |f| f.load_n);
                out[first_load + 2 * number] = load(&inner);
                out[first_load + 2 * number + 1] = load(&outer);
            }
        }
        let a = view.body(self.pair.a.body);
        let axes = a.rotation * self.pair.a.orientation().matrix();
        let (seen, turning) = (axes.tr_mul(&force), axes.tr_mul(&moment));
        let load = Vector6::new(seen.x, seen.y, seen.z, turning.x, turning.y, turning.z);
        sample_ring(&load, &force, out);
        out[RING_CHANNELS] = orbit / self.balls() as f64;
    }
}
