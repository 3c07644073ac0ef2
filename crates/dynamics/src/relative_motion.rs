//! Motion of one marker relative to another, its Jacobian, and forces that act between the two.
//!
//! A marker is a frame fixed in a body. With X, R position and rotation of a marker in the world,
//!
//! ```text
//! u = R_Aᵀ (X_B − X_A)        Q = R_Aᵀ R_B        ω = Q ω_B − ω_A       all seen in A
//! (u̇, ω) = J ν,   ν = (ẋ_a, Ω_a, ẋ_b, Ω_b)       J: 6 × 12
//! ```
//!
//! A force f on B and a moment μ on B, both along A's axes and acting in the point of B, with the reaction on A's
//! body, have the generalised force Jᵀ(f, μ). Its derivative for constant (f, μ) is the geometric tangent. Everything
//! that acts between two markers, joint or force element, is built from these. Derivation: docs/theory/multibody.md.

use nalgebra::{Matrix3, Rotation3, SMatrix, SVector, UnitQuaternion, Vector3};

use crate::body::{BodyId, GROUND};
use crate::rotation::skew;
use crate::state::BodyMotion;

/// A frame fixed in a body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Marker {
    /// The body.
    pub body: BodyId,
    /// Its origin from the body's reference point, body axes \[m\].
    pub position_m: Vector3<f64>,
    /// Body axes from marker axes; none where they are the same.
    orientation: Option<Rotation3<f64>>,
}

impl Marker {
    /// A marker with the body's own axes.
    #[must_use]
    pub fn at(body: BodyId, position_m: [f64; 3]) -> Self {
        Self {
            body,
            position_m: Vector3::from(position_m),
            orientation: None,
        }
    }

    /// A marker of the world.
    #[must_use]
    pub fn ground(position_m: [f64; 3]) -> Self {
        Self::at(GROUND, position_m)
    }

    /// The same place and axes on another body.
    #[must_use]
    pub fn on(mut self, body: BodyId) -> Self {
        self.body = body;
        self
    }

    /// The marker turned against the body's axes.
    #[must_use]
    pub fn oriented(mut self, orientation: UnitQuaternion<f64>) -> Self {
        let same = orientation == UnitQuaternion::identity();
        self.orientation = (!same).then(|| orientation.to_rotation_matrix());
        self
    }

    /// Body axes from marker axes.
    #[must_use]
    pub fn orientation(&self) -> Rotation3<f64> {
        self.orientation.unwrap_or_else(Rotation3::identity)
    }

    /// A matrix times that.
    fn turn(&self, matrix: Matrix3<f64>) -> Matrix3<f64> {
        match &self.orientation {
            None => matrix,
            Some(orientation) => matrix * orientation.matrix(),
        }
    }

    /// The same place as this one with its z axis along a direction of the body; x and y are any that fit. A direction
    /// of length zero leaves the axes as they are.
    #[must_use]
    pub fn along(self, z_axis: [f64; 3]) -> Self {
        let direction = Vector3::from(z_axis);
        let turn = UnitQuaternion::rotation_between(&Vector3::z(), &direction);
        self.oriented(turn.unwrap_or_else(|| {
            UnitQuaternion::from_axis_angle(&Vector3::x_axis(), std::f64::consts::PI)
        }))
    }
}

/// Two markers, A and B.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MarkerPair {
    /// The frame in which the motion is seen.
    pub a: Marker,
    /// The marker whose motion is seen.
    pub b: Marker,
}

/// 6×12 Jacobian: rows (u, rotation), columns (x, rotation) of body a, then of body b.
pub type Jacobian = SMatrix<f64, 6, 12>;
/// 12×12 tangent of a generalised force.
pub type PairTangent = SMatrix<f64, 12, 12>;

/// Motion of marker B as seen in marker A.
#[derive(Debug, Clone, Copy)]
pub struct RelativeMotion {
    /// u \[m\].
    pub displacement_m: Vector3<f64>,
    /// Q: A axes from B axes.
    pub rotation: Matrix3<f64>,
    /// u̇ \[m/s\].
    pub velocity_m_per_s: Vector3<f64>,
    /// ω, A axes \[rad/s\].
    pub angular_velocity_rad_per_s: Vector3<f64>,
    /// A marker axes from body a axes.
    a_from_body: Matrix3<f64>,
    /// A marker axes from world axes.
    a_from_world: Matrix3<f64>,
    /// A marker axes from body b axes.
    a_from_b: Matrix3<f64>,
    point_b: Vector3<f64>,
    /// Point of B from body a's reference point, A axes.
    arm: Vector3<f64>,
    /// R_Aᵀ(V_B − V_A)
    slip: Vector3<f64>,
    omega_a: Vector3<f64>,
    /// R_Aᵀ R_a (Ω_a × p_A) and R_Aᵀ R_b (Ω_b × p_B) need these.
    spin_a: Vector3<f64>,
    spin_b: Vector3<f64>,
}

impl MarkerPair {
    /// The motion at given motions of both bodies.
    #[must_use]
    pub fn motion(&self, a: &BodyMotion, b: &BodyMotion) -> RelativeMotion {
        let a_from_world = self.a.turn(a.rotation).transpose();
        let (point_a, point_b) = (self.a.position_m, self.b.position_m);
        let a_from_b = a_from_world * b.rotation;
        let a_from_body = self.a.turn(Matrix3::identity()).transpose();
        let gap = b.position_m - a.position_m;
        let arm = a_from_world * gap + a_from_b * point_b;
        let displacement = arm - a_from_body * point_a;
        let spin_a = a.angular_velocity_rad_per_s.cross(&point_a);
        let spin_b = b.angular_velocity_rad_per_s.cross(&point_b);
        let slip = a_from_world * (b.velocity_m_per_s - a.velocity_m_per_s) + a_from_b * spin_b
            - a_from_body * spin_a;
        let omega_a = a_from_body * a.angular_velocity_rad_per_s;
        RelativeMotion {
            displacement_m: displacement,
            rotation: self.b.turn(a_from_b),
            velocity_m_per_s: slip - omega_a.cross(&displacement),
            angular_velocity_rad_per_s: a_from_b * b.angular_velocity_rad_per_s - omega_a,
            a_from_body,
            a_from_world,
            a_from_b,
            point_b,
            arm,
            slip,
            omega_a,
            spin_a,
            spin_b,
        }
    }
}

impl RelativeMotion {
    /// (u̇, ω).
    #[must_use]
    pub fn rates(&self) -> SVector<f64, 6> {
        let (v, w) = (self.velocity_m_per_s, self.angular_velocity_rad_per_s);
        SVector::from([v[0], v[1], v[2], w[0], w[1], w[2]])
    }

    /// c: the z axis of B, A axes.
    fn axis(&self) -> Vector3<f64> {
        self.rotation.column(2).into()
    }

    /// How fast the z axis of B tilts against that of A, A axes \[rad/s\]: c × ċ = ω − (ω·c) c. Spin of B about its own
    /// axis is no part of it, however the axis lies.
    #[must_use]
    pub fn tilt_rate_rad_per_s(&self) -> Vector3<f64> {
        self.tilt_rate_by_velocity() * self.angular_velocity_rad_per_s
    }

    /// Its derivative by ω: 1 − c cᵀ.
    #[must_use]
    pub fn tilt_rate_by_velocity(&self) -> Matrix3<f64> {
        let c = self.axis();
        Matrix3::identity() - c * c.transpose()
    }

    /// Its derivative by the rotation of B against A, A axes, ω constant \[1/s\].
    #[must_use]
    pub fn tilt_rate_by_rotation(&self) -> Matrix3<f64> {
        let (c, w) = (self.axis(), self.angular_velocity_rad_per_s);
        // dc = φ × c
        (Matrix3::from_diagonal_element(c.dot(&w)) + c * w.transpose()) * skew(&c)
    }

    /// Q as a quaternion.
    #[must_use]
    pub fn quaternion(&self) -> UnitQuaternion<f64> {
        UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(self.rotation))
    }

    /// A vector in A axes in world axes.
    #[must_use]
    pub fn to_world(&self, in_a: &Vector3<f64>) -> Vector3<f64> {
        self.a_from_world.tr_mul(in_a)
    }

    /// J: derivative of (u, rotation of B against A in A axes) by the increments of both bodies, and of (u̇, ω) by
    /// their velocities.
    #[must_use]
    pub fn jacobian(&self) -> Jacobian {
        let mut j = Jacobian::zeros();
        j.fixed_view_mut::<3, 3>(0, 0)
            .copy_from(&(-self.a_from_world));
        j.fixed_view_mut::<3, 3>(0, 3)
            .copy_from(&(skew(&self.arm) * self.a_from_body));
        j.fixed_view_mut::<3, 3>(0, 6).copy_from(&self.a_from_world);
        j.fixed_view_mut::<3, 3>(0, 9)
            .copy_from(&(-self.a_from_b * skew(&self.point_b)));
        j.fixed_view_mut::<3, 3>(3, 3)
            .copy_from(&(-self.a_from_body));
        j.fixed_view_mut::<3, 3>(3, 9).copy_from(&self.a_from_b);
        j
    }

    /// Derivative of (u̇, ω) by the configuration increments at constant velocities.
    #[must_use]
    pub fn rate_jacobian(&self, jacobian: &Jacobian) -> Jacobian {
        let upper = jacobian.fixed_rows::<3>(0);
        let lower = jacobian.fixed_rows::<3>(3);
        let mut d = Jacobian::zeros();
        let mut top = -skew(&self.omega_a) * upper;
        let by_a = skew(&self.slip) * self.a_from_body + self.a_from_body * skew(&self.spin_a);
        let by_b = self.a_from_b * skew(&self.spin_b);
        let mut part = top.fixed_view_mut::<3, 3>(0, 3);
        part += by_a;
        let mut part = top.fixed_view_mut::<3, 3>(0, 9);
        part -= by_b;
        d.fixed_rows_mut::<3>(0).copy_from(&top);
        let turning = self.angular_velocity_rad_per_s + self.omega_a;
        d.fixed_rows_mut::<3>(3)
            .copy_from(&(-skew(&turning) * lower));
        d
    }

    /// Jᵀ (f, μ) without forming J.
    #[must_use]
    pub fn generalised_force(&self, load: &SVector<f64, 6>) -> SVector<f64, 12> {
        let f = Vector3::new(load[0], load[1], load[2]);
        let mu = Vector3::new(load[3], load[4], load[5]);
        let world = self.a_from_world.transpose() * f;
        let on_a = -(self.a_from_body.transpose() * (self.arm.cross(&f) + mu));
        let on_b =
            self.point_b.cross(&(self.a_from_b.transpose() * f)) + self.a_from_b.transpose() * mu;
        let mut force = SVector::<f64, 12>::zeros();
        force.fixed_rows_mut::<3>(0).copy_from(&(-world));
        force.fixed_rows_mut::<3>(3).copy_from(&on_a);
        force.fixed_rows_mut::<3>(6).copy_from(&world);
        force.fixed_rows_mut::<3>(9).copy_from(&on_b);
        force
    }

    /// ∂(Jᵀ load)/∂increments for a load (f, μ) that is constant in A axes.
    #[must_use]
    pub fn geometric_tangent(&self, jacobian: &Jacobian, load: &SVector<f64, 6>) -> PairTangent {
        let f = skew(&Vector3::new(load[0], load[1], load[2]));
        let mu = skew(&Vector3::new(load[3], load[4], load[5]));
        let mut tangent = PairTangent::zeros();
        // A's axes carry the force along: R_A (α × f), α = rotation of A.
        let carried = self.a_from_world.transpose() * f * self.a_from_body;
        tangent.fixed_view_mut::<3, 3>(0, 3).copy_from(&carried);
        tangent.fixed_view_mut::<3, 3>(6, 3).copy_from(&(-carried));
        // The arm from body a's reference point moves with u.
        let arm = self.a_from_body.transpose() * f * jacobian.fixed_rows::<3>(0);
        let mut rows = tangent.fixed_rows_mut::<3>(3);
        rows += arm;
        // Body b turns under the load.
        let to_b = self.a_from_b.transpose();
        let turned = (skew(&self.point_b) * to_b * f + to_b * mu) * jacobian.fixed_rows::<3>(3);
        let mut rows = tangent.fixed_rows_mut::<3>(9);
        rows += turned;
        tangent
    }
}
