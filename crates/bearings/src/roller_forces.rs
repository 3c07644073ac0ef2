//! The forces on one roller between two races, lamina by lamina, at a place of it.
//!
//! A roller moves in its axial plane: centre (r, z) and tilt φ about the circumferential direction; it does not skew.
//! Each lamina touches a race along the race's normal, its contact being that of a circle about the roller's axis: a
//! tilt of the roller against the race moves the line of the force by less than (D/2) φ along the axis, which is left
//! out. Cylindrical rollers are led by the ribs of one ring: they do not move along z. Tapered ones lean on the inner
//! ring's rib with a spherical end. Formula (8) and what follows it in docs/theory/rolling_bearings.md.

use nalgebra::{Matrix2, Matrix3, Vector2, Vector3};

use crate::axial_plane::AxialPlane;
use crate::element_search::{Balance, Unbalanced};
use crate::line_contact::LineContact;
use crate::ring_pose::RingPose;
use crate::roller_row::{Lamina, RollerRow};

/// One roller at its angle.
pub(crate) struct Roller<'a> {
    pub row: &'a RollerRow,
    pub pose: &'a RingPose,
    pub plane: AxialPlane,
    pub number: usize,
    /// Speed of the cage \[rad/s\].
    pub orbit: f64,
    /// Speed about its own axis \[rad/s\].
    pub spin: f64,
    /// How far the outer race has moved away from the axis at each lamina \[m\]; empty where it is round.
    pub race_moved_m: &'a [f64],
}

/// A point of the roller that the inner ring presses: its place, the force on the ring and how that changes.
pub(crate) struct InnerPoint {
    pub w: Vector3<f64>,
    pub force: Vector3<f64>,
    pub by_point: Matrix3<f64>,
    /// ∂(r, z)/∂φ of the point.
    pub by_tilt: Vector2<f64>,
}

/// Everything at one place of the roller.
pub(crate) struct RollerState {
    /// Of the roller: r, z, about the circumferential direction.
    pub balance: Balance<3>,
    pub inner_load: f64,
    pub outer_load: f64,
    pub rib_load: f64,
}

impl Unbalanced<3> for RollerState {
    fn balance(&self) -> &Balance<3> {
        &self.balance
    }
}

impl Roller<'_> {
    /// Direction along the roller and across it (its derivative by φ).
    pub fn axes(&self, tilt: f64) -> (Vector2<f64>, Vector2<f64>) {
        let (sine, cosine) = tilt.sin_cos();
        let (r, z) = self.row.axis;
        let along = Vector2::new(r * cosine + z * sine, z * cosine - r * sine);
        (along, Vector2::new(along[1], -along[0]))
    }

    fn inner_point(
        &self,
        place: &Vector3<f64>,
        at_m: f64,
        normal: (f64, f64),
        law: impl Fn(f64) -> (f64, f64),
    ) -> (InnerPoint, f64) {
        let (along, across) = self.axes(place[2]);
        let p = Vector2::new(place[0], place[1]) + along * at_m;
        let a = &self.pose.axis;
        let at = self.plane.seen_from_ring(self.pose, &p);
        // Away from the axis of the ring; the ring is pushed the other way.
        let n = at.e * normal.0 + a * normal.1;
        let (load, slope) = law(normal.0 * at.radius + normal.1 * at.height);
        let point = InnerPoint {
            w: at.w,
            force: -n * load,
            // The load falls as the point moves along n.
            by_point: n * (n * slope).transpose()
                - at.t * (at.t * (load * normal.0 / at.radius)).transpose(),
            by_tilt: across * at_m,
        };
        (point, load)
    }

    /// Calls `each` with every contact with the inner ring: the point, its load, and the lamina's number where it is
    /// one.
    pub fn inner_points(
        &self,
        place: &Vector3<f64>,
        mut each: impl FnMut(InnerPoint, f64, Option<usize>),
    ) {
        let race = &self.row.inner;
        for (number, lamina) in self.row.laminae.iter().enumerate() {
            let (point, load) = self.inner_point(place, lamina.place_m, race.normal, |distance| {
                let approach = lamina.reach_m - (distance - race.offset_m);
                let (load, slope) = race.contact.line_load(approach);
                (load * lamina.length_m, slope * lamina.length_m)
            });
            each(point, load, Some(number));
        }
        if let Some(rib) = &self.row.rib {
            // The rib's normal points into the rib: the other sense of a race's.
            let outward = (-rib.normal.0, -rib.normal.1);
            let (point, load) = self.inner_point(place, rib.centre_m, outward, |distance| {
                let approach = (-distance - rib.offset_m).max(0.0);
                let slope = rib.stiffness_n_per_m15 * approach.sqrt();
                (slope * approach, 1.5 * slope)
            });
            each(point, load, None);
        }
    }

    /// Load of a lamina at the outer race, its slope and the energy of its contact.
    pub fn outer_load(&self, place: &Vector3<f64>, (number, lamina): (usize, &Lamina)) -> [f64; 3] {
        let race = &self.row.outer;
        let (along, _) = self.axes(place[2]);
        let p = Vector2::new(place[0], place[1]) + along * lamina.place_m;
        let moved_m = self.race_moved_m.get(number).copied().unwrap_or_default();
        let offset_m = race.offset_m + race.normal.0 * moved_m;
        let distance = offset_m - (race.normal.0 * p[0] + race.normal.1 * p[1]);
        let approach_m = lamina.reach_m - distance;
        let (load, slope) = race.contact.line_load(approach_m);
        let energy = LineContact::energy(load, approach_m);
        [load, slope, energy].map(|value| value * lamina.length_m)
    }

    pub fn state(&self, place: &Vector3<f64>) -> RollerState {
        let row = self.row;
        let (_, across) = self.axes(place[2]);
        let centrifugal = row.mass_kg * row.pitch_radius_m * self.orbit * self.orbit;
        let mut state = RollerState {
            balance: Balance {
                residual: Vector3::new(centrifugal, 0.0, -self.gyroscopic_nm()),
                tangent: Matrix3::zeros(),
                scale: centrifugal,
            },
            inner_load: 0.0,
            outer_load: 0.0,
            rib_load: 0.0,
        };
        self.inner_points(place, |point, load, lamina| {
            if load == 0.0 {
                return;
            }
            let force = -self.plane.part(&point.force);
            let stiffness = self.plane_block(&point.by_point);
            add_point(&mut state, &force, &stiffness, &point.by_tilt);
            match lamina {
                Some(_) => state.inner_load += load,
                None => state.rib_load += load,
            }
        });
        let (c, s) = row.outer.normal;
        let n = Vector2::new(c, s);
        for (number, lamina) in row.laminae.iter().enumerate() {
            let [load, slope, _] = self.outer_load(place, (number, lamina));
            if load > 0.0 {
                let stiffness = n * (n * slope).transpose();
                add_point(
                    &mut state,
                    &(-n * load),
                    &stiffness,
                    &(across * lamina.place_m),
                );
                state.outer_load += load;
            }
        }
        state.balance.scale += state.inner_load + state.outer_load + state.rib_load;
        if row.rib.is_none() {
            // Led along z by the ribs.
            state.balance.residual[1] = 0.0;
            state
                .balance
                .tangent
                .set_row(1, &nalgebra::RowVector3::zeros());
            state.balance.tangent.set_column(1, &Vector3::zeros());
            state.balance.tangent[(1, 1)] = 1.0;
        }
        state
    }

    /// ω_m × H about the circumferential direction, H of a body that spins about an inclined axis.
    pub fn gyroscopic_nm(&self) -> f64 {
        let (sine, cosine) = self.row.axis;
        let (own, across) = self.row.inertia_kg_m2;
        // Angular velocity: spin along the axis, in the sense of rolling, and the orbit along z.
        let sense = -cosine.signum();
        let along = sense * self.spin + self.orbit * cosine;
        let radial = own * along * sine - across * self.orbit * cosine * sine;
        self.orbit * radial
    }

    pub fn plane_block(&self, m: &Matrix3<f64>) -> Matrix2<f64> {
        let plane = self.plane.vectors();
        plane.tr_mul(&(m * plane))
    }
}

/// Adds a force at a point of the roller: the point moves with (r, z) and with φ by `by_tilt`.
fn add_point(
    state: &mut RollerState,
    force: &Vector2<f64>,
    stiffness: &Matrix2<f64>,
    by_tilt: &Vector2<f64>,
) {
    state.balance.residual[0] += force[0];
    state.balance.residual[1] += force[1];
    state.balance.residual[2] += by_tilt.dot(force);
    let by_tilt_force = stiffness * by_tilt;
    let mut block = state.balance.tangent.fixed_view_mut::<2, 2>(0, 0);
    block += stiffness;
    for axis in 0..2 {
        state.balance.tangent[(axis, 2)] += by_tilt_force[axis];
        state.balance.tangent[(2, axis)] += by_tilt_force[axis];
    }
    // ∂by_tilt/∂φ is minus the point's place along the roller, turned twice.
    let second = Vector2::new(by_tilt[1], -by_tilt[0]);
    state.balance.tangent[(2, 2)] += by_tilt.dot(&by_tilt_force) - second.dot(force);
}
