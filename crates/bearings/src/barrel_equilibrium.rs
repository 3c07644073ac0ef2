//! The equilibrium of one barrel roller between groove and sphere, lamina by lamina, in the axial plane of the inner
//! ring, and the load and stiffness of a whole row on that ring.
//!
//! Three unknowns: the place (r, z) of its middle and the tilt φ from r towards z. Each lamina is a circle about the
//! roller's axis: its outermost point meets the sphere, its innermost the groove. Forces have a potential, whose least
//! value is sought. The centrifugal force is left out: it is small in these slow bearings, and a roller that nothing
//! else presses would slide to the guide between the rows, which is not modelled.

use nalgebra::{Matrix2x3, Matrix3, Vector2, Vector3};

use crate::barrel_row::BarrelRow;
use crate::element_load::ElementLoad;
use crate::element_search::{Balance, ElementPlace, ElementSearch, NO_FORCE_N, Unbalanced};
use crate::error::BearingError;
use crate::operation::Operation;
use crate::ring_load::RingLoad;
use crate::ring_pose::RingPose;

/// One roller at its angle.
pub(crate) struct Barrel<'a> {
    pub row: &'a BarrelRow,
    /// Middle of the sphere in the roller's axes: away from the ring's axis, in the sense of turning, along the ring's
    /// axis.
    pub sphere: Vector3<f64>,
    pub number: usize,
    pub angle_rad: f64,
}

/// Everything at one place of the roller.
struct State {
    /// Of the roller: r, z, φ.
    balance: Balance<3>,
    loads: [f64; 2],
    largest: [f64; 2],
    /// Force on the sphere, its change with the sphere's middle at a place of the roller, and with the roller's place.
    pressed: Vector3<f64>,
    by_sphere: Matrix3<f64>,
    by_place: Matrix3<f64>,
}

/// The way of a point of the roller with its place: the point from the roller's middle, and its derivative by φ.
struct Point {
    arm: Vector2<f64>,
    by_tilt: Vector2<f64>,
}

impl Unbalanced<3> for State {
    fn balance(&self) -> &Balance<3> {
        &self.balance
    }
}

impl State {
    /// Adds a contact of the load `load` and slope `slope` along the normal n of a surface whose centre is at the
    /// distance `distance`.
    fn add(&mut self, point: &Point, n: &Vector2<f64>, (load, slope): (f64, f64), distance: f64) {
        let moves = Matrix2x3::new(1.0, 0.0, point.by_tilt[0], 0.0, 1.0, point.by_tilt[1]);
        let along = moves.tr_mul(n);
        self.balance.residual -= along * load;
        self.balance.tangent += along * (along * slope).transpose();
        let turning = (moves.tr_mul(&moves) - along * along.transpose()) * (load / distance);
        self.balance.tangent += turning;
        // The second derivative of a point by φ is minus its arm.
        self.balance.tangent[(2, 2)] -= load * n.dot(&point.arm);
        self.balance.scale += load;
    }
}

impl Barrel<'_> {
    fn points(&self, tilt: f64, each: usize) -> [Point; 2] {
        let (sine, cosine) = tilt.sin_cos();
        let (c, s) = self.row.across;
        let out = Vector2::new(c * cosine - s * sine, s * cosine + c * sine);
        let along = Vector2::new(-out[1], out[0]);
        let lamina = &self.row.laminae[each];
        [-lamina.reach_m, lamina.reach_m].map(|reach| Point {
            arm: along * lamina.place_m + out * reach,
            by_tilt: along * reach - out * lamina.place_m,
        })
    }

    fn state(&self, place: &Vector3<f64>, mut each: impl FnMut(f64, f64)) -> State {
        let row = self.row;
        let middle = Vector2::new(place[0], place[1]);
        let groove = Vector2::new(row.groove_centre_m.0, row.groove_centre_m.1);
        let length = row.lamina_length_m;
        let mut state = State {
            balance: Balance {
                residual: Vector3::zeros(),
                tangent: Matrix3::zeros(),
                scale: 0.0,
            },
            loads: [0.0; 2],
            largest: [0.0; 2],
            pressed: Vector3::zeros(),
            by_sphere: Matrix3::zeros(),
            by_place: Matrix3::zeros(),
        };
        for number in 0..row.laminae.len() {
            let [inner, outer] = self.points(place[2], number);
            let from = middle + inner.arm - groove;
            let distance = from.norm();
            let (load, slope) = row.contacts[0].line_load(distance - row.groove_radius_m);
            let inner_load = load * length;
            if load > 0.0 {
                let n = from / distance;
                state.add(&inner, &n, (inner_load, slope * length), distance);
            }
            let point = middle + outer.arm;
            let from = Vector3::new(
                point[0] - self.sphere[0],
                -self.sphere[1],
                point[1] - self.sphere[2],
            );
            let distance = from.norm();
            let (load, slope) = row.contacts[1].line_load(distance - row.sphere_radius_m);
            let outer_load = load * length;
            if load > 0.0 {
                let n = from / distance;
                let flat = Vector2::new(n[0], n[2]);
                let by_point = n * (n * (slope * length)).transpose()
                    + (Matrix3::identity() - n * n.transpose()) * (outer_load / distance);
                let moves = Matrix3::from_columns(&[
                    Vector3::x(),
                    Vector3::z(),
                    Vector3::new(outer.by_tilt[0], 0.0, outer.by_tilt[1]),
                ]);
                state.add(&outer, &flat, (outer_load, slope * length), distance);
                state.pressed += n * outer_load;
                state.by_sphere -= by_point;
                state.by_place += by_point * moves;
            }
            each(inner_load, outer_load);
            for (place, load) in [inner_load, outer_load].into_iter().enumerate() {
                state.loads[place] += load;
                state.largest[place] = state.largest[place].max(load / length);
            }
        }
        state
    }

    /// A quarter of a roller's length \[m\], by which moments count as forces.
    fn arm_m(&self) -> f64 {
        0.25 * self.row.laminae.len() as f64 * self.row.lamina_length_m
    }

    /// Halfway between the races.
    fn start(&self) -> Vector3<f64> {
        let row = self.row;
        Vector3::new(
            row.middle_m.0 + 0.5 * self.sphere[0],
            row.middle_m.1 + 0.5 * self.sphere[2],
            0.0,
        )
    }

    fn equilibrium(&self, start: Vector3<f64>) -> Result<(Vector3<f64>, State), BearingError> {
        let search = ElementSearch {
            arms: Vector3::new(1.0, 1.0, self.arm_m()),
            longest_step_m: 50e-6,
            rounding_m: 4e-16 * self.row.pitch_radius_m,
        };
        let found = search.run(start, |place| self.state(place, |_, _| {}));
        found.map_err(|given_up| BearingError::NoRollerEquilibrium {
            roller: self.number + 1,
            angle_deg: self.angle_rad.to_degrees(),
            unbalanced_n: given_up.left_n,
        })
    }

    /// Equilibrium: the load, the force on the sphere in the roller's axes and its change with the sphere's middle, the
    /// roller following.
    pub fn rest(
        &self,
        found: &mut ElementPlace,
        each_lamina: &mut impl FnMut(f64, f64),
    ) -> Result<(ElementLoad, Vector3<f64>, Matrix3<f64>), BearingError> {
        let near = found.take().and_then(|place| self.equilibrium(place).ok());
        let (place, state) = match near {
            Some(near) => near,
            None => self.equilibrium(self.start())?,
        };
        if state.balance.scale > NO_FORCE_N {
            *found = Some(place);
        }
        self.state(&place, &mut *each_lamina);
        let row = self.row;
        let angle = row.across.1.atan2(row.across.0);
        let load = ElementLoad {
            angle_rad: self.angle_rad,
            inner_load_n: state.loads[0],
            outer_load_n: state.loads[1],
            inner_contact_angle_rad: angle,
            outer_contact_angle_rad: angle,
            radial_m: place[0] - row.middle_m.0,
            axial_m: place[1] - row.middle_m.1,
            tilt_rad: place[2],
            inner_line_load_n_per_m: state.largest[0],
            outer_line_load_n_per_m: state.largest[1],
            ..ElementLoad::default()
        };
        // The roller follows the sphere: H δv = Jᵀ A δs, with Jᵀ A the transpose of what its place does to the force.
        let followed = state
            .balance
            .tangent
            .lu()
            .solve(&state.by_place.transpose())
            .map_or_else(Matrix3::zeros, |follows| state.by_place * follows);
        Ok((load, state.pressed, state.by_sphere + followed))
    }
}

/// The least turn that takes the axis z to the ring's axis a, and how the ring's frame turns with a rotation of the
/// ring about fixed axes: by W δφ, W = P − a (e_z P)/(1 + a_z), P = 1 − a aᵀ.
fn least_turn(a: &Vector3<f64>) -> (Matrix3<f64>, Matrix3<f64>) {
    let share = 1.0 / (1.0 + a.z);
    let turn = Matrix3::new(
        1.0 - a.x * a.x * share,
        -a.x * a.y * share,
        a.x,
        -a.x * a.y * share,
        1.0 - a.y * a.y * share,
        a.y,
        -a.x,
        -a.y,
        a.z,
    );
    let across = Matrix3::identity() - a * a.transpose();
    let by_turn = across - a * (across.row(2) * share);
    (turn, by_turn)
}

impl BarrelRow {
    /// Adds the row's load and stiffness to the ring's, and hands the load of every roller to `each`. The search for a
    /// roller begins at its place in the inner ring's axes, and writes there where it ends.
    ///
    /// # Errors
    /// [`BearingError::NoRollerEquilibrium`].
    pub(crate) fn add(
        &self,
        pose: &RingPose,
        operation: &Operation,
        places: &mut [ElementPlace],
        ring: &mut RingLoad,
        mut each: impl FnMut(ElementLoad),
        mut each_lamina: impl FnMut(f64, f64),
    ) -> Result<(), BearingError> {
        let (turn, by_turn) = least_turn(&pose.axis);
        let sphere = -(turn.tr_mul(&pose.centre_m));
        let ratio = 0.5 * self.diameter_m * self.across.0 / self.pitch_radius_m;
        let (inner, outer) = (operation.inner_rad_per_s, operation.outer_rad_per_s);
        let orbit = 0.5 * (inner * (1.0 - ratio) + outer * (1.0 + ratio));
        let (mut force, mut by_sphere) = (Vector3::zeros(), Matrix3::zeros());
        for (number, place) in places.iter_mut().enumerate() {
            let angle_rad = operation.element_angle_rad(self.first_angle_rad, number, self.rollers);
            let (sine, cosine) = angle_rad.sin_cos();
            let axes = Matrix3::new(cosine, -sine, 0.0, sine, cosine, 0.0, 0.0, 0.0, 1.0);
            let barrel = Barrel {
                row: self,
                sphere: axes.tr_mul(&sphere),
                number,
                angle_rad,
            };
            let (mut load, pressed, change) = barrel.rest(place, &mut each_lamina)?;
            force += axes * pressed;
            by_sphere += axes * change * axes.transpose();
            load.orbit_rad_per_s = orbit;
            each(load);
        }
        // What the rollers press the sphere with they press the ring with the other way, through the sphere's middle.
        let force: Vector3<f64> = -(turn * force);
        let stiffness = turn * by_sphere * turn.transpose();
        let (arm, hold) = (pose.centre_m.cross_matrix(), force.cross_matrix());
        let by_rotation = (stiffness * arm - hold) * by_turn;
        let mut part = ring.load.fixed_rows_mut::<3>(0);
        part += force;
        let mut part = ring.load.fixed_rows_mut::<3>(3);
        part -= pose.centre_m.cross(&force);
        let mut block = ring.tangent.fixed_view_mut::<3, 3>(0, 0);
        block += stiffness;
        let mut block = ring.tangent.fixed_view_mut::<3, 3>(0, 3);
        block += by_rotation;
        let mut block = ring.tangent.fixed_view_mut::<3, 3>(3, 0);
        block += hold - arm * stiffness;
        let mut block = ring.tangent.fixed_view_mut::<3, 3>(3, 3);
        block -= arm * by_rotation;
        Ok(())
    }
}
