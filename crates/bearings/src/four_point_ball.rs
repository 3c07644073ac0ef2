//! The equilibrium of one ball between the four arcs of a four-point contact bearing, and the load and stiffness of the
//! ball and of its row on the inner ring.
//!
//! The ball stays in its axial plane and has two unknowns there. Every arc presses it as one groove of
//! `ball_equilibrium.rs` does, or not at all. The centrifugal force is that of rolling at the nominal angle: with three
//! or four contacts no spin rolls at all of them, and the gyroscopic moment is left out. Forces have a potential, whose
//! least value is sought.

use nalgebra::{Matrix2, Matrix2x6, Matrix3, Vector2, Vector3};

use crate::axial_plane::AxialPlane;
use crate::element_load::{ElementLoad, OtherSide};
use crate::element_search::{Balance, ElementPlace, ElementSearch, NO_FORCE_N, Unbalanced};
use crate::error::BearingError;
use crate::four_point_row::{Arc, FourPointRow};
use crate::operation::Operation;
use crate::ring_load::{RingLoad, by_ring};
use crate::ring_pose::RingPose;

/// One ball at its angle.
pub(crate) struct FourPointBall<'a> {
    pub row: &'a FourPointRow,
    pub pose: &'a RingPose,
    pub plane: AxialPlane,
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
    /// Of the ball in its plane.
    balance: Balance<2>,
}

impl Unbalanced<2> for State {
    fn balance(&self) -> &Balance<2> {
        &self.balance
    }
}

impl FourPointBall<'_> {
    /// Contacts and forces with the ball's centre at (r, z).
    fn state(&self, place: &Vector2<f64>) -> State {
        let row = self.row;
        let a = &self.pose.axis;
        let at = self.plane.seen_from_ring(self.pose, place);
        let plane = self.plane.vectors();
        let mut state = State {
            inner: [Contact::default(); 2],
            outer: [Contact::default(); 2],
            w: at.w,
            force: Vector3::zeros(),
            by_point: Matrix3::zeros(),
            balance: Balance {
                residual: Vector2::new(self.centrifugal_n, 0.0),
                tangent: Matrix2::zeros(),
                scale: self.centrifugal_n,
            },
        };
        for (arc, contact) in row.inner.iter().zip(&mut state.inner) {
            let groove = &arc.groove;
            let (out, up) = (
                at.radius - groove.centre_radius_m,
                at.height - groove.centre_z_m,
            );
            let Some((length, cosine, sine)) = direction(arc, -out, -up) else {
                continue;
            };
            let (load, slope) = groove.contact.load(length - groove.arm_m);
            if load == 0.0 {
                continue;
            }
            let n = -(at.e * cosine + a * sine);
            let m = at.e * sine - a * cosine;
            state.force += n * load;
            state.by_point += n * (n * slope).transpose() + m * (m * (load / length)).transpose()
                - at.t * (at.t * (load * cosine / at.radius)).transpose();
            state.balance.scale += load;
            *contact = Contact {
                load,
                angle_rad: sine.atan2(cosine),
            };
        }
        state.balance.residual -= plane.tr_mul(&state.force);
        state.balance.tangent += plane.tr_mul(&(state.by_point * plane));
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
            state.balance.residual -= n * load;
            state.balance.tangent +=
                n * (n * slope).transpose() + m * (m * (load / length)).transpose();
            state.balance.scale += load;
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
        let mut best = (f64::NEG_INFINITY, Vector2::zeros());
        for inner in &row.inner {
            let groove = &inner.groove;
            let circle = (groove.centre_radius_m, groove.centre_z_m);
            let centre = self.plane.nearest(self.pose, circle);
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

    fn equilibrium(&self, start: Vector2<f64>) -> Result<(Vector2<f64>, State), BearingError> {
        let search = ElementSearch {
            arms: Vector2::repeat(1.0),
            longest_step_m: 0.2 * self.row.outer[0].groove.arm_m,
            rounding_m: 4e-16 * self.row.pitch_radius_m,
        };
        let found = search.run(start, |place| self.state(place));
        found.map_err(|given_up| BearingError::NoBallEquilibrium {
            ball: self.number + 1,
            angle_deg: self.plane.degrees(),
            unbalanced_n: given_up.left_n,
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
        if state.balance.scale > NO_FORCE_N {
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
        let Some(inverse) = state.balance.tangent.try_inverse() else {
            return;
        };
        let plane = self.plane.vectors();
        let (_, force_by_ring) = by_ring(w, force, by_point);
        let follows: Matrix2x6<f64> = -(inverse * plane.tr_mul(&force_by_ring));
        let moves = plane * follows;
        ring.add_following(w, force, &(by_point * moves), &moves);
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

impl FourPointRow {
    /// Adds the row's load and stiffness to the ring's, and hands the load of every ball to `each`. The search for a
    /// ball begins at its place, and writes there where it ends.
    ///
    /// # Errors
    /// [`BearingError::NoBallEquilibrium`].
    pub(crate) fn add(
        &self,
        pose: &RingPose,
        operation: &Operation,
        places: &mut [ElementPlace],
        ring: &mut RingLoad,
        mut each: impl FnMut(ElementLoad),
    ) -> Result<(), BearingError> {
        let orbit = self.orbit_rad_per_s(operation);
        for (number, place) in places.iter_mut().enumerate() {
            let angle_rad = self.angle_rad(number, operation);
            let (sine, cosine) = angle_rad.sin_cos();
            let ball = FourPointBall {
                row: self,
                pose,
                plane: AxialPlane {
                    e_r: Vector3::new(cosine, sine, 0.0),
                },
                number,
                centrifugal_n: self.ball_mass_kg * self.pitch_radius_m * orbit * orbit,
            };
            let mut load = ball.add(place, ring)?;
            load.angle_rad = angle_rad;
            load.orbit_rad_per_s = orbit;
            each(load);
        }
        Ok(())
    }
}

/// Length of a vector from a groove's centre, and cosine and sine of its contact angle, where it meets the arc.
fn direction(arc: &Arc, out: f64, up: f64) -> Option<(f64, f64, f64)> {
    let length = (out * out + up * up).sqrt().max(f64::MIN_POSITIVE);
    let (cosine, sine) = (out / length, up / length);
    arc.reaches(cosine, sine).then_some((length, cosine, sine))
}
