//! A ball bearing between two bodies of a system, every ball a body of its own.

use std::sync::Arc;

use gearmesh_dynamics::elements::{Channel, ForceElement, Loads, View};
use gearmesh_dynamics::{BodyId, ElementFailure, MarkerPair, Power, Unknown};
use nalgebra::{Matrix3, Vector3, Vector6};

use super::ball_on_body::{BallPlaces, Carrier};
use super::ball_orientation::{BallOrientation, SAVED};
use super::ball_start::start_of_row;
use super::cage_motion::{CAGE_MOTION, cage_motion, cage_motion_channels};
use super::contact_damping::StatedContact;
use super::effort::BearingEffort;
use super::pockets::Pockets;
use super::rebound::Rebound;
use super::surface_contact::SurfaceForce;
use super::traction::Traction;
use super::triangles::{GrooveTriangles, TriangleSize};
use crate::ball_row::BallRow;
use crate::error::BearingError;
use crate::faults::Side;
use crate::operation::Operation;
use crate::quasi_static::{QuasiStaticBearing, Row};
use crate::ring_channels::{RING_CHANNELS, race_loads, ring_channels, sample_ring};
use crate::ring_pose::{RingPose, spin_rad_per_s};

/// What a bearing's balls feel besides the elastic races. The default is nothing.
#[derive(Debug, Clone, Default)]
pub struct DynamicEffects {
    /// Load and damping of the contacts at the races by a stated law; none: Hertz with `rebound`. Balls start at Hertz'
    /// places all the same.
    pub contact: Option<StatedContact>,
    /// Damping of Hertz' contacts at the races.
    pub rebound: Rebound,
    /// Races as meshes of triangles in place of tori.
    pub surface: Option<TriangleSize>,
    /// Friction at the races; without it balls do not turn.
    pub traction: Option<Traction>,
    /// Weight of the balls \[m/s²\], world axes.
    pub gravity_m_per_s2: Option<[f64; 3]>,
    /// A cage for each row, in the order of rows; none: balls are free. A cage is a body of the system whose reference
    /// point is its middle and whose z axis is that of the bearing; its pockets stand where the balls are at the start,
    /// turned with the body.
    pub cages: Vec<(BodyId, Pockets)>,
}

/// A ball bearing: the outer ring on marker A, the inner ring on marker B, z along the axis of each.
///
/// Channels: force and moment on the inner ring (axes of marker A, moment about marker B's place), mean orbital speed
/// of the balls against the outer ring; with [`Self::with_ball_loads`] the load of every ball at both races and its
/// place; with [`Self::with_ball_accelerations`] its acceleration; with cages the force on each by its pockets, where
/// its middle is, and how fast it turns and whirls.
pub struct DynamicBearing {
    name: String,
    pub(super) pair: MarkerPair,
    bodies: Vec<BodyId>,
    rows: Vec<BallRow>,
    /// Outer and inner groove of each row, where the races are meshes.
    pub(super) meshes: Vec<[GrooveTriangles; 2]>,
    pub(super) effects: DynamicEffects,
    /// Of balls with spalls, in the order of their numbers.
    pub(super) orientations: Vec<BallOrientation>,
    ball_loads: bool,
    ball_accelerations: bool,
    pub(super) effort: Option<Arc<BearingEffort>>,
}

impl DynamicBearing {
    /// Puts a bearing between its outer ring (marker A) and its inner ring (marker B).
    ///
    /// # Errors
    /// [`BearingError::NotCarried`] for bearings with rollers, where there are cages but not one for each row, for a
    /// spall on a ball that nothing turns, or for races as triangles in a bearing with faults;
    /// [`BearingError::Parameter`] for edges of triangles that do not fit.
    pub fn new(
        name: &str,
        pair: MarkerPair,
        bearing: &QuasiStaticBearing,
        effects: DynamicEffects,
    ) -> Result<Self, BearingError> {
        let mut rows = Vec::with_capacity(bearing.rows.len());
        for row in &bearing.rows {
            match row {
                Row::Ball(row) if row.inner.reaches(1.0, 0.0) => rows.push(row.clone()),
                Row::Ball(_) | Row::FourPoint(_) => {
                    return Err(BearingError::NotCarried(
                        "thrust and four-point bearings have no model `dynamic`; take `quasi-static`",
                    ));
                }
                Row::Roller(_) | Row::Barrel(_) => {
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
        let meshes = meshes(&rows, effects.surface)?;
        let mut bodies = vec![pair.a.body, pair.b.body];
        bodies.extend(effects.cages.iter().map(|(body, _)| *body));
        let mut found = Self {
            name: name.to_owned(),
            pair: bearing.ring_markers(pair),
            bodies,
            rows,
            meshes,
            effects,
            orientations: Vec::new(),
            ball_loads: false,
            ball_accelerations: false,
            effort: None,
        };
        found.orientations = found.spalled_balls();
        if !found.orientations.is_empty() && !found.turns() {
            return Err(BearingError::NotCarried(
                "a spall on a ball needs traction: without friction nothing turns the balls, and the spall does not come round",
            ));
        }
        Ok(found)
    }

    fn spalled_balls(&self) -> Vec<BallOrientation> {
        let mut found = Vec::new();
        for (_, row, ball, number) in self.numbered() {
            let faults = row.faults.iter().flat_map(|faults| faults.spalled());
            let own = faults.filter(|spalled| spalled.ball == ball);
            found
                .extend(own.map(|spalled| BallOrientation::new(number, spalled.spall.direction())));
        }
        found
    }

    /// Adds the load of every ball to the channels: `ball_<number>_inner_N`, `ball_<number>_outer_N`, and its place
    /// `ball_<number>_angle_rad`, counted from one, row after row.
    #[must_use]
    pub fn with_ball_loads(mut self) -> Self {
        self.ball_loads = true;
        self
    }

    /// Adds the acceleration of every ball's centre to the channels, world axes:
    /// `ball_<number>_acceleration_x_m_per_s2` and so on. It is the sum of all
    /// forces on the ball over its mass, its weight included where it has any.
    #[must_use]
    pub fn with_ball_accelerations(mut self) -> Self {
        self.ball_accelerations = true;
        self
    }

    /// Counts what is evaluated.
    #[must_use]
    pub fn counted(mut self, effort: Arc<BearingEffort>) -> Self {
        self.effort = Some(effort);
        self
    }

    /// Coordinates of a ball.
    pub(super) fn per_ball(&self) -> usize {
        if self.turns() { 6 } else { 3 }
    }

    /// Whether anything turns the balls.
    pub(super) fn turns(&self) -> bool {
        let rubs = |(_, pockets): &(BodyId, Pockets)| pockets.traction.is_some();
        self.effects.traction.is_some() || self.effects.cages.iter().any(rubs)
    }

    fn balls(&self) -> usize {
        self.numbered().count()
    }

    /// Rows and their balls that are there, with the numbers of these among all that are there.
    fn numbered(&self) -> impl Iterator<Item = (usize, &BallRow, usize, usize)> {
        let rows = self.rows.iter().enumerate();
        let there = rows.flat_map(|(place, row)| {
            let balls = (0..row.balls).filter(|ball| row.has(*ball));
            balls.map(move |ball| (place, row, ball))
        });
        there
            .enumerate()
            .map(|(number, (place, row, ball))| (place, row, ball, number))
    }

    /// What a user calls a ball of a row: its number, from 1, row after row, missing ones counted.
    fn label(&self, place: usize, ball: usize) -> usize {
        let before: usize = self.rows[..place].iter().map(|row| row.balls).sum();
        before + ball + 1
    }
}

/// The grooves as triangles, where asked for.
fn meshes(
    rows: &[BallRow],
    size: Option<TriangleSize>,
) -> Result<Vec<[GrooveTriangles; 2]>, BearingError> {
    let Some(size) = size else {
        return Ok(Vec::new());
    };
    if rows.iter().any(|row| row.faults.is_some()) {
        return Err(BearingError::NotCarried(
            "races as triangles have no faults: remove the surface, or the faults",
        ));
    }
    let of_row = |row| {
        let of_side = |side| GrooveTriangles::new(row, side, size);
        Ok([of_side(Side::Outer)?, of_side(Side::Inner)?])
    };
    rows.iter().map(of_row).collect()
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
        for (place, row, ball, _) in self.numbered() {
            let (diameter, mass) = row.ball_size(ball);
            let label = self.label(place, ball);
            for axis in axes {
                let name = format!("ball_{label}_{axis}_m");
                unknowns.push(Unknown::inertial(&name, mass, row.pitch_radius_m));
            }
            if self.turns() {
                let inertia = 0.1 * mass * diameter.powi(2);
                for axis in axes {
                    let name = format!("ball_{label}_turn_{axis}_rad");
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
        let pose = RingPose::from(&motion);
        let operation = Operation {
            inner_rad_per_s: spin_rad_per_s(b, &self.pair.b),
            outer_rad_per_s: spin_rad_per_s(a, &self.pair.a),
            ..Operation::default()
        };
        let origin = a.position_m + a.rotation * self.pair.a.position_m;
        let drift = a.velocity_m_per_s
            + a.rotation * a.angular_velocity_rad_per_s.cross(&self.pair.a.position_m);
        let per_ball = self.per_ball();
        let mut first = 0;
        for row in &self.rows {
            let starts = start_of_row(row, &pose, &operation);
            let there = starts
                .into_iter()
                .enumerate()
                .filter(|(ball, _)| row.has(*ball));
            for (_, start) in there {
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
        let mut found = SurfaceForce::NONE;
        for (place, row, ball_of_row, number) in self.numbered() {
            let ball = self.ball(view, row, ball_of_row, number);
            let (faults, turning) = self.faults(view, row, ball_of_row, number);
            let first = loads.first_unknown() + number * per_ball;
            let places = BallPlaces {
                place: first,
                spin: (per_ball == 6).then_some(first + 3),
                turning,
            };
            let mut add = |carrier: &Carrier<'_>, found: &SurfaceForce, loads: &mut Loads| {
                carrier.add(&ball, places, found, loads);
                power.stored_j += found.stored_j;
                power.dissipated_w += found.dissipated_w;
            };
            for ring in &rings {
                let touches =
                    self.at_race((row, place), &faults, ring, &ball, tangents, &mut found);
                if touches.is_some() {
                    add(&ring.carrier, &found, loads);
                }
            }
            if let Some((body, _)) = self.effects.cages.get(place) {
                let cage = Carrier::new(view.body(*body), loads.starts()[2 + place]);
                let which = (row, place, ball_of_row);
                let touches = self.in_pocket(which, &cage, &ball, tangents, &mut found);
                if touches.is_some() {
                    add(&cage, &found, loads);
                }
            }
            if let Some(gravity) = self.effects.gravity_m_per_s2 {
                let weight =
                    Vector3::from(gravity) * (row.ball_size(ball_of_row).1 * view.load_factor);
                loads.add_force(first, weight.as_slice());
                power.stored_j -= weight.dot(&ball.place_m);
            }
        }
        loads.power = power;
        Ok(())
    }

    fn begin(&mut self, view: &View<'_>) {
        let mut orientations = std::mem::take(&mut self.orientations);
        let [outer, _] = self.rings(view, [0, 0]);
        for orientation in &mut orientations {
            let first = orientation.ball * self.per_ball();
            let place = Vector3::from_column_slice(&view.unknowns()[first..first + 3]);
            let arm = place - outer.middle;
            let out = (arm - outer.axis * arm.dot(&outer.axis)).normalize();
            let axes = Matrix3::from_columns(&[out, outer.axis.cross(&out), outer.axis]);
            orientation.begin(&axes, self.turned(view, orientation.ball));
        }
        self.orientations = orientations;
    }

    fn commit(&mut self, view: &View<'_>) -> Result<(), ElementFailure> {
        let mut orientations = std::mem::take(&mut self.orientations);
        for orientation in &mut orientations {
            orientation.commit(self.turned(view, orientation.ball));
        }
        self.orientations = orientations;
        Ok(())
    }

    fn save(&self, out: &mut Vec<f64>) {
        self.orientations.iter().for_each(|o| o.save(out));
    }

    fn restore(&mut self, numbers: &[f64]) {
        for (orientation, saved) in self.orientations.iter_mut().zip(numbers.chunks(SAVED)) {
            orientation.restore(saved);
        }
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
            channels.extend(cage_motion_channels(cage));
        }
        for (place, _, ball, _) in self.numbered() {
            let ball = self.label(place, ball);
            if self.ball_loads {
                channels.extend(race_loads("ball", ball));
                let what = format!(
                    "place of ball {ball} round the axis of the outer ring, from its x towards y"
                );
                channels.push(Channel::new(format!("ball_{ball}_angle_rad"), "rad", what));
            }
            if self.ball_accelerations {
                let what = format!("acceleration of the centre of ball {ball}, world axes");
                channels.extend(["x", "y", "z"].map(|axis| {
                    let name = format!("ball_{ball}_acceleration_{axis}_m_per_s2");
                    Channel::new(name, "m/s²", what.clone())
                }));
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
        let per_cage = 3 + CAGE_MOTION;
        let mut of_balls = first_cage + per_cage * cages;
        for (place, row, ball_of_row, number) in self.numbered() {
            let ball = self.ball(view, row, ball_of_row, number);
            let (faults, _) = self.faults(view, row, ball_of_row, number);
            let [outer, inner] = [&rings[0], &rings[1]].map(|ring| {
                let mut found = SurfaceForce::NONE;
                let touches = self.at_race((row, place), &faults, ring, &ball, false, &mut found);
                touches.map(|()| found)
            });
            if let Some(inner) = &inner {
                force -= inner.force;
                let arm = ball.place_m - rings[1].middle;
                moment -= arm.cross(&inner.force) + inner.moment;
            }
            let against = rings[0].carrier.against(&ball);
            let arm = ball.place_m - rings[0].middle;
            let across = arm - rings[0].axis * arm.dot(&rings[0].axis);
            orbit += rings[0].axis.dot(&across.cross(&against.velocity)) / across.norm_squared();
            let mut on_ball: Vector3<f64> = [&outer, &inner]
                .into_iter()
                .flatten()
                .map(|f| f.force)
                .sum();
            if let Some((body, _)) = self.effects.cages.get(place) {
                let cage = Carrier::new(view.body(*body), 0);
                let which = (row, place, ball_of_row);
                let mut found = SurfaceForce::NONE;
                let touches = self.in_pocket(which, &cage, &ball, false, &mut found);
                if touches.is_some() {
                    on_ball += found.force;
                    for axis in 0..3 {
                        out[first_cage + per_cage * place + axis] -= found.force[axis];
                    }
                }
            }
            if self.ball_loads {
                let load = |found: &Option<SurfaceForce>| found.map_or(0.0, |f| f.load_n);
                let angle = rings[0].angle_rad(&arm);
                let of_ball = [load(&inner), load(&outer), angle];
                out[of_balls..][..3].copy_from_slice(&of_ball);
                of_balls += 3;
            }
            if self.ball_accelerations {
                let weight = self.effects.gravity_m_per_s2.map(Vector3::from);
                let fall = weight.unwrap_or_default() * view.load_factor;
                let acceleration: Vector3<f64> = on_ball / row.ball_size(ball_of_row).1 + fall;
                out[of_balls..][..3].copy_from_slice(acceleration.as_slice());
                of_balls += 3;
            }
        }
        for (place, (body, _)) in self.effects.cages.iter().enumerate() {
            let found = cage_motion(
                &rings[0].seen(),
                rings[1].seen().spin_rad_per_s,
                view.body(*body),
            );
            out[first_cage + per_cage * place + 3..][..CAGE_MOTION].copy_from_slice(&found);
        }
        let a = view.body(self.pair.a.body);
        let axes = a.rotation * self.pair.a.orientation().matrix();
        let (seen, turning) = (axes.tr_mul(&force), axes.tr_mul(&moment));
        let load = Vector6::new(seen.x, seen.y, seen.z, turning.x, turning.y, turning.z);
        sample_ring(&load, &force, out);
        out[RING_CHANNELS] = orbit / self.balls() as f64;
    }
}
