//! The equilibrium of one ball between two grooves, and its load and stiffness on the inner ring.
//!
//! Each ball stays in its axial plane (the cage holds it there) and has two unknowns, the place of its centre b in
//! that plane. A groove is half a torus: a circle of radius R, the line of the groove's centres, and round it the
//! groove's radius r, up to contact angles of 90° (in thrust bearings from 0° to 180°). With the distance ℓ of b from
//! that circle the approach is δ = ℓ − (r − D/2), the force Q = k δ^1.5 points to the circle. The inner groove ends in
//! a rim: a ball beyond its end touches this edge, δ = D/2 − ℓ with the distance ℓ of b from it. Formulas (3) to (7) of
//! docs/theory/rolling_bearings.md.

mod race_control;
mod whole_row;

use nalgebra::{Matrix2, Matrix2x6, Matrix3, Matrix3x2, Matrix3x6, Vector2, Vector3};

use crate::axial_plane::{AxialPlane, FromRing};
use crate::ball_kinematics::{BallInMotion, BallMotion, ContactAngles, RaceControl};
use crate::ball_row::{BallRow, Groove};
use crate::element_load::ElementLoad;
use crate::element_search::{ElementPlace, NO_FORCE_N};
use crate::error::BearingError;
use crate::operation::Operation;
use crate::ring_load::{RingLoad, by_ring};
use crate::ring_pose::RingPose;

/// Share of the free contact angle up to which a ball of an angular-contact bearing may touch its groove on the side
/// away from the load, where a shoulder is missing.
pub(crate) const FAR_SIDE: f64 = 0.5;

/// Newton's iterations of one ball before it is given up.
const MOST_ITERATIONS: usize = 60;

/// One ball at its angle.
pub(crate) struct Ball<'a> {
    pub row: &'a BallRow,
    /// Its grooves, those of the row unless something is wrong with them or with the ball.
    pub inner: &'a Groove,
    pub outer: &'a Groove,
    pub pose: &'a RingPose,
    pub operation: &'a Operation,
    pub plane: AxialPlane,
    pub number: usize,
}

/// The contact with the inner ring for a place of the ball.
struct InnerContact {
    /// The ball's centre.
    at: FromRing,
    /// From the groove's centre to the ball's centre; from the ball's centre to the rim where it touches that.
    n: Vector3<f64>,
    /// ∂n/∂α.
    m: Vector3<f64>,
    /// Distance of the ball's centre from the groove's centre; negative, from the rim where it touches that: ∂n is then
    /// what it is on a groove.
    length: f64,
    cosine: f64,
    sine: f64,
    load: f64,
    slope: f64,
}

struct OuterContact {
    /// From the groove's centre to the ball's centre, in the ball's plane.
    n: Vector2<f64>,
    m: Vector2<f64>,
    length: f64,
    load: f64,
    slope: f64,
}

/// Everything at one place of the ball.
struct State {
    inner: InnerContact,
    outer: OuterContact,
    motion: Option<(BallMotion, RaceControl)>,
    /// Force on the ball in its plane; zero at equilibrium.
    residual: Vector2<f64>,
}

impl State {
    /// Sum of the sizes of all forces \[N\].
    fn scale(&self) -> f64 {
        let centrifugal = self.motion.map_or(0.0, |(m, _)| m.centrifugal_n.value);
        self.inner.load + self.outer.load + centrifugal
    }

    /// Friction at the inner and outer race that carries the gyroscopic moment: value and derivatives by α_i, α_o.
    fn friction(&self) -> [(f64, [f64; 2]); 2] {
        let none = (0.0, [0.0; 2]);
        match &self.motion {
            None => [none; 2],
            Some((motion, control)) => {
                let friction = (motion.friction_n.value, motion.friction_n.by);
                match control {
                    RaceControl::Outer => [none, friction],
                    RaceControl::Inner => [friction, none],
                }
            }
        }
    }
}

impl Ball<'_> {
    /// Equilibrium, then load and tangent.
    pub fn add(
        &self,
        found: &mut ElementPlace,
        ring: &mut RingLoad,
    ) -> Result<ElementLoad, BearingError> {
        let before = found.take().map(|place| Vector2::new(place[0], place[1]));
        // A ball that hardly carries any more may not be found from where it stood before.
        let near = before.and_then(|place| self.balanced(place).ok());
        let (place, state) = match near {
            Some(near) => near,
            None => match self.starts() {
                [Some(start), None] | [None, Some(start)] => self.balanced(start)?,
                [Some(first), Some(second)] => self
                    .balanced(first)
                    .or_else(|error| self.balanced(second).map_err(|_| error))?,
                [None, None] => return Ok(self.unloaded()),
            },
        };
        self.refuse_far_side(&state)?;
        if state.scale() > NO_FORCE_N {
            *found = Some(Vector3::new(place[0], place[1], 0.0));
            self.add_to_ring(&state, ring);
        }
        Ok(self.report(&place, &state))
    }

    /// Where the iteration begins, and where it begins again if that fails; none where the ball is loose and nothing
    /// presses it.
    ///
    /// Where the centrifugal force is more than what the rings press with, the ball is sought at the bottom of the
    /// outer groove: contacts that hardly touch have no slope to begin with, and the way along a groove is narrow.
    fn starts(&self) -> [Option<Vector2<f64>>; 2] {
        let row = self.row;
        let (inner, outer) = (self.inner, self.outer);
        let a = &self.pose.axis;
        let circle = (inner.centre_radius_m, inner.centre_z_m);
        let centre = self.plane.nearest(self.pose, circle);
        let from = Vector2::new(outer.centre_radius_m, outer.centre_z_m);
        let between = centre - from;
        let distance = between.norm();
        let approach = distance - inner.arm_m - outer.arm_m;
        // In the outer groove under its centrifugal force alone.
        // Washers of a thrust bearing have no bottom on the way out.
        let has_bottom = outer.reaches(1.0, 0.0);
        let pressed_m = (has_bottom && self.operation.is_turning()).then(|| {
            let angles = ContactAngles {
                inner: (1.0, 0.0),
                outer: (1.0, 0.0),
            };
            let motion = self.motion_at(&angles, RaceControl::Outer);
            let pressed = motion.centrifugal_n.value / outer.contact.stiffness_n_per_m15;
            pressed.cbrt().powi(2)
        });
        let thrown = pressed_m.map(|depth| from + Vector2::new(outer.arm_m + depth, 0.0));
        if approach > 0.0 {
            // Two springs in series along the line between the groove centres.
            let ratio = outer.contact.stiffness_n_per_m15 / inner.contact.stiffness_n_per_m15;
            let depth = approach / (1.0 + ratio.cbrt().powi(2));
            let least = pressed_m.unwrap_or(0.0);
            let between = from + between * ((outer.arm_m + depth.max(least)) / distance);
            return if depth > least {
                [Some(between), thrown]
            } else {
                [thrown, Some(between)]
            };
        }
        if thrown.is_some() {
            return [thrown, None];
        }
        // The ring's tilt and the ball's plane make a difference of second order: within it the iteration decides.
        let doubt = self.pose.centre_m.norm_squared() / row.pitch_radius_m
            + row.pitch_radius_m * (a.x * a.x + a.y * a.y);
        let touching = (approach > -doubt).then(|| from + between * (outer.arm_m / distance));
        [touching, None]
    }

    fn motion_at(&self, angles: &ContactAngles, control: RaceControl) -> BallMotion {
        let row = self.row;
        let (diameter_m, mass_kg) = row.ball_size(self.number);
        let ball = BallInMotion {
            diameter_ratio: 0.5 * diameter_m / row.pitch_radius_m,
            mass_kg,
            pitch_radius_m: row.pitch_radius_m,
            ball_radius_m: 0.5 * diameter_m,
        };
        let speeds = (
            self.operation.inner_rad_per_s,
            self.operation.outer_rad_per_s,
        );
        ball.at(angles, speeds, control)
    }

    /// Contacts and forces with the ball's centre at (r, z).
    fn state(&self, place: &Vector2<f64>, control: RaceControl) -> State {
        let inner = self.inner_contact(place);
        let outer = self.outer_contact(place);
        let motion = self.operation.is_turning().then(|| {
            let outer = (outer.n[0], outer.n[1]);
            if self.inner.reaches(inner.cosine, inner.sine) {
                let inner = (inner.cosine, inner.sine);
                let angles = ContactAngles { inner, outer };
                return (self.motion_at(&angles, control), control);
            }
            // Out of the inner groove's reach: the ball turns as one that both grooves face alike.
            let angles = ContactAngles {
                inner: outer,
                outer,
            };
            let motion = self.motion_at(&angles, control).by_outer_alone();
            (motion, control)
        });
        let mut state = State {
            residual: -self.plane.part(&inner.n) * inner.load - outer.n * outer.load,
            inner,
            outer,
            motion,
        };
        if let Some((motion, _)) = &state.motion {
            state.residual[0] += motion.centrifugal_n.value;
            let [inner, outer] = state.friction();
            state.residual -= self.plane.part(&state.inner.m) * inner.0 + state.outer.m * outer.0;
        }
        state
    }

    fn inner_contact(&self, place: &Vector2<f64>) -> InnerContact {
        let groove = self.inner;
        let a = &self.pose.axis;
        let at = self.plane.seen_from_ring(self.pose, place);
        let (out, up) = (
            at.radius - groove.centre_radius_m,
            at.height - groove.centre_z_m,
        );
        // Between a micrometre and a metre: no need of `hypot`, which takes five times as long.
        let length = (out * out + up * up).sqrt().max(f64::MIN_POSITIVE);
        let mut contact = (out, up, length);
        let mut approach = 0.0;
        if groove.reaches(-out / length, -up / length) {
            approach = length - groove.arm_m;
        } else {
            // A groove is the half of its torus that faces the ball, and the rim at its end.
            let ball_radius_m = 0.5 * self.row.ball_size(self.number).0;
            let (out, up, length) = groove.rim_to_centre((out, up), ball_radius_m);
            if length < ball_radius_m {
                contact = (out, up, -length);
                approach = ball_radius_m - length;
            }
        }
        let (out, up, length) = contact;
        let (cosine, sine) = (-out / length, -up / length);
        let (load, slope) = groove.contact.load(approach);
        InnerContact {
            n: -(at.e * cosine + a * sine),
            m: at.e * sine - a * cosine,
            at,
            length,
            cosine,
            sine,
            load,
            slope,
        }
    }

    fn outer_contact(&self, place: &Vector2<f64>) -> OuterContact {
        let groove = self.outer;
        let d = place - Vector2::new(groove.centre_radius_m, groove.centre_z_m);
        let length = d.norm().max(f64::MIN_POSITIVE);
        let n = d / length;
        let approach = if groove.reaches(n[0], n[1]) {
            length - groove.arm_m
        } else {
            0.0
        };
        let (load, slope) = groove.contact.load(approach);
        OuterContact {
            n,
            m: Vector2::new(-n[1], n[0]),
            length,
            load,
            slope,
        }
    }

    /// Change of the inner contact's force on the ring by a displacement of the ball relative to it, without the part
    /// of δφ × f.
    fn inner_by_point(&self, state: &State) -> Matrix3<f64> {
        let c = &state.inner;
        let [(friction, by), _] = state.friction();
        let by_angle = c.m / c.length;
        let hoop = (-c.load * c.cosine + friction * c.sine) / c.at.radius;
        c.n * (c.n * c.slope).transpose()
            + c.m * (c.m * (c.load / c.length)).transpose()
            + c.at.t * (c.at.t * hoop).transpose()
            + (c.m * by[0] - c.n * friction) * by_angle.transpose()
    }

    /// −∂residual/∂place, and the part of ∂residual that goes through α_i alone, by a displacement relative to the
    /// ring.
    fn plane_tangent(
        &self,
        state: &State,
        plane: &Matrix3x2<f64>,
        by_point: &Matrix3<f64>,
    ) -> (Matrix2<f64>, Vector2<f64>) {
        let (i, o) = (&state.inner, &state.outer);
        let [inner, outer] = state.friction();
        let m_i = self.plane.part(&i.m);
        let mut tangent = plane.tr_mul(&(by_point * plane));
        tangent +=
            o.n * (o.n * o.slope).transpose() + o.m * (o.m * (o.load / o.length)).transpose();
        let mut through_inner = Vector2::zeros();
        if let Some((motion, _)) = &state.motion {
            let by_o = o.m / o.length;
            let mut through_outer = o.m * outer.1[1] - o.n * outer.0 + m_i * inner.1[1];
            through_outer[0] -= motion.centrifugal_n.by[1];
            through_inner = o.m * outer.1[0];
            through_inner[0] -= motion.centrifugal_n.by[0];
            tangent += through_outer * by_o.transpose();
            tangent += through_inner * (plane.tr_mul(&i.m) / i.length).transpose();
        }
        (tangent, through_inner)
    }

    /// Newton's method with backtracking on the residual.
    fn equilibrium(
        &self,
        start: Vector2<f64>,
        control: RaceControl,
    ) -> Result<(Vector2<f64>, State), BearingError> {
        let plane = self.plane.vectors();
        let mut place = start;
        let mut state = self.state(&place, control);
        for _ in 0..MOST_ITERATIONS {
            let size = state.residual.norm();
            let scale = state.scale();
            if size <= 1e-14 * scale || scale <= NO_FORCE_N {
                return Ok((place, state));
            }
            let by_point = self.inner_by_point(&state);
            let (tangent, _) = self.plane_tangent(&state, &plane, &by_point);
            let Some(inverse) = tangent.try_inverse() else {
                break;
            };
            let step = inverse * state.residual;
            // Rounding of the ball's place: nothing finer can be resolved.
            if step.norm() <= 4e-16 * self.row.pitch_radius_m {
                return Ok((place, state));
            }
            let mut factor = (0.2 * self.outer.arm_m / step.norm()).min(1.0);
            let least = 1e-6 * factor;
            loop {
                let next = place + step * factor;
                let found = self.state(&next, control);
                if found.residual.norm() < size {
                    (place, state) = (next, found);
                    break;
                }
                factor *= 0.5;
                if factor < least {
                    // No descent: rounding of the residual, or no equilibrium.
                    if size <= 1e-9 * scale + NO_FORCE_N {
                        return Ok((place, state));
                    }
                    return Err(self.no_equilibrium(size));
                }
            }
        }
        let size = state.residual.norm();
        Err(self.no_equilibrium(size))
    }

    /// Angular-contact bearings have no groove on the side away from their load: a ball that climbs there has left the
    /// bearing.
    fn refuse_far_side(&self, state: &State) -> Result<(), BearingError> {
        let (free, inner) = (self.row.free_angle_rad, &state.inner);
        if inner.sine * free >= 0.0 {
            return Ok(());
        }
        let angle = inner.sine.atan2(inner.cosine);
        let climbs = angle * free.signum() < -FAR_SIDE * free.abs();
        if free != 0.0 && inner.load > NO_FORCE_N && climbs {
            return Err(BearingError::PulledOut);
        }
        Ok(())
    }

    fn no_equilibrium(&self, unbalanced_n: f64) -> BearingError {
        BearingError::NoBallEquilibrium {
            ball: self.number + 1,
            angle_deg: self.plane.degrees(),
            unbalanced_n,
        }
    }

    fn add_to_ring(&self, state: &State, ring: &mut RingLoad) {
        let c = &state.inner;
        let [(friction, by), _] = state.friction();
        if c.load == 0.0 && friction == 0.0 {
            return;
        }
        let plane = self.plane.vectors();
        let by_point = self.inner_by_point(state);
        let force = c.n * c.load + c.m * friction;
        ring.add_at_fixed_point(&c.at.w, &force, &by_point);
        // How the ball follows: tangent δv = −C δq.
        let (tangent, through_inner) = self.plane_tangent(state, &plane, &by_point);
        let Some(inverse) = tangent.try_inverse() else {
            return;
        };
        let (relative, force_by_ring) = by_ring(&c.at.w, &force, &by_point);
        let through = through_inner * (relative.tr_mul(&c.m) / c.length).transpose();
        let follows: Matrix2x6<f64> = -(inverse * (plane.tr_mul(&force_by_ring) + through));
        // The friction depends on the outer contact's angle, too.
        let by_outer = (state.outer.m / state.outer.length).transpose() * by[1];
        let by_place = by_point * plane + c.m * by_outer;
        let moves = plane * follows;
        ring.add_following(&c.at.w, &force, &(by_place * follows), &moves);
        if friction != 0.0 {
            self.add_friction_moment(state, &(relative + moves), &follows, ring);
        }
    }

    /// The friction at the inner race acts on the ball's surface, not at its middle: moment −(D/2) τ t.
    fn add_friction_moment(
        &self,
        state: &State,
        relative: &Matrix3x6<f64>,
        follows: &Matrix2x6<f64>,
        ring: &mut RingLoad,
    ) {
        let c = &state.inner;
        let [(friction, by), _] = state.friction();
        let arm = -0.5 * self.row.ball_diameter_m;
        let by_inner = (relative.tr_mul(&c.m) / c.length).transpose() * by[0];
        let by_outer = (state.outer.m / state.outer.length).transpose() * follows * by[1];
        let mut turned = Matrix3x6::zeros();
        turned
            .fixed_view_mut::<3, 3>(0, 3)
            .copy_from(&-c.at.t.cross_matrix());
        turned -= c.at.e * (relative.tr_mul(&c.at.t) / c.at.radius).transpose();
        let mut moment = ring.load.fixed_rows_mut::<3>(3);
        moment += c.at.t * (arm * friction);
        let mut block = ring.tangent.fixed_view_mut::<3, 6>(3, 0);
        block += (c.at.t * (by_inner + by_outer) + turned * friction) * arm;
    }

    fn unloaded(&self) -> ElementLoad {
        ElementLoad {
            angle_rad: self.row.angle_rad(self.number, self.operation),
            inner_contact_angle_rad: self.row.free_angle_rad,
            outer_contact_angle_rad: self.row.free_angle_rad,
            ..ElementLoad::default()
        }
    }

    fn report(&self, place: &Vector2<f64>, state: &State) -> ElementLoad {
        let row = self.row;
        let motion = state.motion.as_ref().map(|(motion, _)| motion);
        ElementLoad {
            angle_rad: row.angle_rad(self.number, self.operation),
            inner_load_n: state.inner.load,
            outer_load_n: state.outer.load,
            inner_contact_angle_rad: if self.inner.reaches(state.inner.cosine, state.inner.sine) {
                state.inner.sine.atan2(state.inner.cosine)
            } else {
                row.free_angle_rad
            },
            outer_contact_angle_rad: state.outer.n[1].atan2(state.outer.n[0]),
            radial_m: place[0] - row.pitch_radius_m,
            axial_m: place[1] - row.middle_z_m,
            centrifugal_n: motion.map_or(0.0, |m| m.centrifugal_n.value),
            gyroscopic_nm: motion.map_or(0.0, |m| 0.5 * row.ball_diameter_m * m.friction_n.value),
            orbit_rad_per_s: motion.map_or(0.0, |m| m.orbit_rad_per_s),
            spin_rad_per_s: motion.map_or(0.0, |m| m.spin_rad_per_s),
            controlled_by_inner: matches!(state.motion, Some((_, RaceControl::Inner))),
            beyond_inner_groove: motion.is_some()
                && row.free_angle_rad != 0.0
                && (state.inner.length < 0.0
                    || !self.inner.reaches(state.inner.cosine, state.inner.sine)),
            ..ElementLoad::default()
        }
    }
}
