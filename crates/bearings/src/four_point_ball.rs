//! The equilibrium of one ball between the four arcs of a four-point contact bearing, and what it does to the inner
//! ring.
//!
//! The ball stays in its axial plane and has two unknowns there. Every arc presses it as one groove of
//! `ball_equilibrium.rs` does, or not at all. The centrifugal force is that of rolling at the nominal angle: with three
//! or four contacts no spin rolls at all of them, and the gyroscopic moment is left out. Forces have a potential, whose
//! least value is sought.

use nalgebra::{Matrix2, Matrix2x6, Matrix3, Matrix3x2, Matrix3x6, Vector2, Vector3};

use crate::element_load::{ElementLoad, OtherSide};
use crate::element_place::ElementPlace;
use crate::error::BearingError;
use crate::four_point_row::{Arc, FourPointRow};
use crate::ring_load::RingLoad;
use crate::ring_pose::{RingPose, cross};

/// Forces that count as none \[N\].
const NO_FORCE_N: f64 = 1e-9;

/// Newton's iterations of one ball before it is given up.
const MOST_ITERATIONS: usize = 200;

/// One ball at its angle.
pub(crate) struct FourPointBall<'a> {
    pub row: &'a FourPointRow,
    pub pose: &'a RingPose,
    /// Radial unit vector at its angle.
    pub e_r: Vector3<f64>,
    pub number: usize,
    pub centrifugal_n: f64,
}

/// One contact.
#[derive(Debug, Clone, Copy, Default)]
struct Contact {
    load: f64,
    angle_rad: f64,
}

/// Everything at one place of the ball.
struct State {
    /// Inner and outer contacts of positive, then of negative angles.
    inner: [Contact; 2],
    outer: [Contact; 2],
    /// Ball's centre from the ring's middle.
    w: Vector3<f64>,
    /// Force of the inner contacts on the ring, and its change by a displacement of the ball against the ring.
    force: Vector3<f64>,
    by_point: Matrix3<f64>,
    /// Force on the ball in its plane, zero at equilibrium, and minus its change with the place.
    residual: Vector2<f64>,
    tangent: Matrix2<f64>,
    /// Sum of the sizes of all forces.
    scale: f64,
}

impl FourPointBall<'_> {
    fn plane(&self) -> Matrix3x2<f64> {
        Matrix3x2::from_columns(&[self.e_r, Vector3::z()])
    }

    /// Contacts and forces with the ball's centre at (r, z).
    fn state(&self, place: &Vector2<f64>) -> State {
        let row = self.row;
        let a = &self.pose.axis;
        let w = self.e_r * place[0] + Vector3::z() * place[1] - self.pose.centre_m;
        let height = w.dot(a);
        let radial = w - a * height;
        let radius = radial.norm();
        let e = radial / radius;
        let t = a.cross(&e);
        let plane = self.plane();
        let mut state = State {
            inner: [Contact::default(); 2],
            outer: [Contact::default(); 2],
            w,
            force: Vector3::zeros(),
            by_point: Matrix3::zeros(),
            residual: Vector2::new(self.centrifugal_n, 0.0),
            tangent: Matrix2::zeros(),
            scale: self.centrifugal_n,
        };
        for (arc, contact) in row.inner.iter().zip(&mut state.inner) {
            let groove = &arc.groove;
            let (out, up) = (radius - groove.centre_radius_m, height - groove.centre_z_m);
            let Some((length, cosine, sine)) = direction(arc, -out, -up) else {
                continue;
            };
            let (load, slope) = groove.contact.load(length - groove.arm_m);
            if load == 0.0 {
                continue;
            }
            let n = -(e * cosine + a * sine);
            let m = e * sine - a * cosine;
            state.force += n * load;
            state.by_point += n * (n * slope).transpose() + m * (m * (load / length)).transpose()
                - t * (t * (load * cosine / radius)).transpose();
            state.scale += load;
            *contact = Contact {
                load,
                angle_rad: sine.atan2(cosine),
            };
        }
        state.residual -= plane.tr_mul(&state.force);
        state.tangent += plane.tr_mul(&(state.by_point * plane));
        for (arc, contact) in row.outer.iter().zip(&mut state.outer) {
            let groove = &arc.groove;
            let d = place - Vector2::new(groove.centre_radius_m, groove.centre_z_m);
            let Some((length, cosine, sine)) = direction(arc, d[0], d[1]) else {
                continue;
            };
            let (load, slope) = groove.contact.load(length - groove.arm_m);
            if load == 0.0 {
                continue;
            }
            let n = Vector2::new(cosine, sine);
            let m = Vector2::new(-sine, cosine);
            state.residual -= n * load;
            state.tangent += n * (n * slope).transpose() + m * (m * (load / length)).transpose();
            state.scale += load;
            *contact = Contact {
                load,
                angle_rad: sine.atan2(cosine),
            };
        }
        state
    }

    /// Between the two arcs whose centres are farthest apart for their arms: those press most.
    fn start(&self) -> Vector2<f64> {
        let row = self.row;
        let a = &self.pose.axis;
        let e = (self.e_r - a * self.e_r.dot(a)).normalize();
        let mut best = (f64::NEG_INFINITY, Vector2::zeros());
        for inner in &row.inner {
            let groove = &inner.groove;
            let centre = self.pose.centre_m + e * groove.centre_radius_m + a * groove.centre_z_m;
            let centre = Vector2::new(self.e_r.dot(&centre), centre.z);
            for outer in &row.outer {
                let from = Vector2::new(outer.groove.centre_radius_m, outer.groove.centre_z_m);
                let between = centre - from;
                let distance = between.norm();
                let approach = distance - groove.arm_m - outer.groove.arm_m;
                if approach > best.0 && distance > 0.0 {
                    // Between both centres, the approach shared equally.
                    let way = (outer.groove.arm_m + 0.5 * approach) / distance;
                    best = (approach, from + between * way);
                }
            }
        }
        best.1
    }

    /// Newton's method; steps that do not lessen the unbalanced force are turned towards it and shortened.
    fn equilibrium(&self, start: Vector2<f64>) -> Result<(Vector2<f64>, State), BearingError> {
        let arm = self.row.outer[0].groove.arm_m;
        let mut place = start;
        let mut state = self.state(&place);
        let mut lift = 0.0_f64;
        for _ in 0..MOST_ITERATIONS {
            let size = state.residual.norm();
            if size <= 1e-14 * state.scale || state.scale <= NO_FORCE_N {
                return Ok((place, state));
            }
            let stiffest = state.tangent.amax().max(1e3);
            let raised = state.tangent + Matrix2::identity() * ((lift + 1e-14) * stiffest);
            let Some(step) = raised.try_inverse().map(|inverse| inverse * state.residual) else {
                lift = (10.0 * lift).max(1e-6);
                continue;
            };
            if step.norm() <= 4e-16 * self.row.pitch_radius_m {
                return Ok((place, state));
            }
            let factor = (0.2 * arm / step.norm()).min(1.0);
            let next = place + step * factor;
            let found = self.state(&next);
            if found.residual.norm() < size {
                (place, state) = (next, found);
                lift = if lift < 1e-8 { 0.0 } else { 0.1 * lift };
            } else {
                if size <= 1e-9 * state.scale + NO_FORCE_N && lift > 1.0 {
                    return Ok((place, state));
                }
                lift = (10.0 * lift).max(1e-6);
            }
        }
        let size = state.residual.norm();
        if size <= 1e-9 * state.scale + NO_FORCE_N {
            return Ok((place, state));
        }
        Err(BearingError::NoBallEquilibrium {
            ball: self.number + 1,
            angle_deg: self.e_r.y.atan2(self.e_r.x).to_degrees(),
            unbalanced_n: size,
        })
    }

    /// Equilibrium, then load and tangent.
    pub fn add(
        &self,
        found: &mut ElementPlace,
        ring: &mut RingLoad,
    ) -> Result<ElementLoad, BearingError> {
        let before = found.take().map(|place| Vector2::new(place[0], place[1]));
        let near = before.and_then(|place| self.equilibrium(place).ok());
        let (place, state) = match near {
            Some(near) => near,
            None => self.equilibrium(self.start())?,
        };
        if state.scale > NO_FORCE_N {
            *found = Some(Vector3::new(place[0], place[1], 0.0));
            self.add_to_ring(&state, ring);
        }
        Ok(self.report(&place, &state))
    }

    fn add_to_ring(&self, state: &State, ring: &mut RingLoad) {
        if state.inner.iter().all(|contact| contact.load == 0.0) {
            return;
        }
        let (w, force, by_point) = (&state.w, &state.force, &state.by_point);
        ring.add_at_fixed_point(w, force, by_point);
        let Some(inverse) = state.tangent.try_inverse() else {
            return;
        };
        let plane = self.plane();
        let turn = cross(force);
        let mut by_ring = Matrix3x6::zeros();
        by_ring.fixed_view_mut::<3, 3>(0, 0).copy_from(&-by_point);
        by_ring
            .fixed_view_mut::<3, 3>(0, 3)
            .copy_from(&(by_point * cross(w) - turn));
        let follows: Matrix2x6<f64> = -(inverse * plane.tr_mul(&by_ring));
        let force_follows = by_point * plane * follows;
        let mut block = ring.tangent.fixed_view_mut::<3, 6>(0, 0);
        block += force_follows;
        let mut block = ring.tangent.fixed_view_mut::<3, 6>(3, 0);
        block += cross(w) * force_follows - turn * (plane * follows);
    }

    /// The side that carries more first.
    fn report(&self, place: &Vector2<f64>, state: &State) -> ElementLoad {
        let row = self.row;
        let sum = |side: usize| state.inner[side].load + state.outer[side].load;
        let (first, second) = if sum(1) > sum(0) { (1, 0) } else { (0, 1) };
        let angle = |contact: &Contact, side: usize| {
            if contact.load > 0.0 {
                contact.angle_rad
            } else {
                row.inner[side].side * row.free_angle_rad
            }
        };
        ElementLoad {
            inner_load_n: state.inner[first].load,
            outer_load_n: state.outer[first].load,
            inner_contact_angle_rad: angle(&state.inner[first], first),
            outer_contact_angle_rad: angle(&state.outer[first], first),
            other_side: Some(OtherSide {
                inner_load_n: state.inner[second].load,
                outer_load_n: state.outer[second].load,
                inner_contact_angle_rad: angle(&state.inner[second], second),
                outer_contact_angle_rad: angle(&state.outer[second], second),
            }),
            radial_m: place[0] - row.pitch_radius_m,
            axial_m: place[1] - row.middle_z_m,
            centrifugal_n: self.centrifugal_n,
            ..ElementLoad::default()
        }
    }
}

/// Length of a vector from a groove's centre, and cosine and sine of its contact angle, where it meets the arc.
fn direction(arc: &Arc, out: f64, up: f64) -> Option<(f64, f64, f64)> {
    let length = (out * out + up * up).sqrt().max(f64::MIN_POSITIVE);
    let (cosine, sine) = (out / length, up / length);
    arc.reaches(cosine, sine).then_some((length, cosine, sine))
}
