//! Bearing of a whole 5×5 stiffness and damping matrix about an operating point; spins freely about its axis.
//!
//! A sits in the housing, B on the shaft, z is the axis. With c the z axis of B seen in A and W(c) the rows (c_z, 0,
//! −c_x) and (0, c_z, −c_y),
//!
//! ```text
//! e = (u, −c_y, c_x),   ė = (u̇, W ω)
//! q = q₀ − K (e − e₀) − C ė,   f = (q₁, q₂, q₃),   μ = Wᵀ (q₄, q₅)
//! ```
//!
//! W ω is the rate of (−c_y, c_x), because dc = φ × c, so that the load does the work qᵀė; Wᵀ q is across c, so that B
//! turns freely. K need not be symmetric: the tangent of a bearing at speed is not, and what it does is then work from
//! outside.

use nalgebra::{Matrix2x3, Matrix5, Matrix6, SMatrix, Vector2, Vector3, Vector5};

use super::Power;
use super::marker_element::{Law, LawTangent, MarkerElement, PairLoad};
use crate::error::DynamicsError;
use crate::relative_motion::{MarkerPair, RelativeMotion};
use crate::rotation::skew;

/// Parameters of such a bearing; A axes, order x, y, z, tilt about x, tilt about y.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MatrixBearing {
    /// K \[N/m, N/rad, N·m/rad\].
    pub stiffness: Matrix5<f64>,
    /// C \[N·s/m, N·s/rad, N·m·s/rad\].
    pub damping: Matrix5<f64>,
    /// e₀: the operating point \[m, rad\].
    pub at: Vector5<f64>,
    /// q₀: load on the shaft there \[N, N·m\].
    pub load: Vector5<f64>,
}

impl MatrixBearing {
    /// About a place without load.
    #[must_use]
    pub fn unloaded(stiffness: Matrix5<f64>, damping: Matrix5<f64>) -> Self {
        Self {
            stiffness,
            damping,
            at: Vector5::zeros(),
            load: Vector5::zeros(),
        }
    }

    /// The bearing between housing (A) and shaft (B).
    ///
    /// # Errors
    /// [`DynamicsError::Value`] if an entry is not finite.
    pub fn between(
        self,
        name: &str,
        pair: MarkerPair,
    ) -> Result<MarkerElement<Self>, DynamicsError> {
        let matrices = self.stiffness.iter().chain(self.damping.iter());
        let vectors = self.at.iter().chain(self.load.iter());
        for found in matrices.chain(vectors) {
            let owner = format!("force element `{name}`");
            let entry = ("an entry of its matrices", *found);
            DynamicsError::require(owner, entry, found.is_finite(), "finite")?;
        }
        Ok(MarkerElement::new(name, pair, self))
    }

    /// q and its parts: K (e − e₀), C ė and ė.
    fn generalised(&self, motion: &RelativeMotion) -> Generalised {
        let (u, v) = (motion.displacement_m, motion.velocity_m_per_s);
        let c: Vector3<f64> = motion.rotation.column(2).into();
        let turning = tilting(&c) * motion.angular_velocity_rad_per_s;
        let stretch = Vector5::new(u[0], u[1], u[2], -c[1], c[0]) - self.at;
        let rate = Vector5::new(v[0], v[1], v[2], turning[0], turning[1]);
        let elastic = self.load - self.stiffness * stretch;
        let viscous = self.damping * rate;
        Generalised {
            c,
            elastic,
            viscous,
            rate,
            stretch,
        }
    }
}

struct Generalised {
    c: Vector3<f64>,
    elastic: Vector5<f64>,
    viscous: Vector5<f64>,
    rate: Vector5<f64>,
    stretch: Vector5<f64>,
}

/// W.
fn tilting(c: &Vector3<f64>) -> Matrix2x3<f64> {
    Matrix2x3::new(c[2], 0.0, -c[0], 0.0, c[2], -c[1])
}

/// Wᵀ t, whose derivative by c is [[0, 0, t₁], [0, 0, t₂], [−t₁, −t₂, 0]].
fn tilt_by_axis(t: &Vector2<f64>) -> nalgebra::Matrix3<f64> {
    nalgebra::Matrix3::new(0.0, 0.0, t[0], 0.0, 0.0, t[1], -t[0], -t[1], 0.0)
}

impl Law for MatrixBearing {
    fn load(&self, motion: &RelativeMotion) -> (PairLoad, Power) {
        let at = self.generalised(motion);
        let q = at.elastic - at.viscous;
        let moment = tilting(&at.c).tr_mul(&Vector2::new(q[3], q[4]));
        let load = PairLoad::new(q[0], q[1], q[2], moment[0], moment[1], moment[2]);
        let symmetric = (self.stiffness + self.stiffness.transpose()) * 0.5;
        let around = (self.stiffness - self.stiffness.transpose()) * 0.5;
        let power = Power {
            stored_j: at.stretch.dot(&(symmetric * at.stretch)) * 0.5 - self.load.dot(&at.stretch),
            dissipated_w: at.rate.dot(&at.viscous),
            supplied_w: -at.rate.dot(&(around * at.stretch)),
        };
        (load, power)
    }

    /// z along the shaft; x and y do not turn with it.
    fn axes(&self) -> &'static str {
        "shaft_"
    }

    fn tangent(&self, motion: &RelativeMotion) -> LawTangent {
        let at = self.generalised(motion);
        let q = at.elastic - at.viscous;
        let omega = motion.angular_velocity_rad_per_s;
        // dc = −[c]× φ
        let turned = -skew(&at.c);
        let w = tilting(&at.c);
        // Rows: e by (u, φ), ė by (u, φ) at held rates, ė by (u̇, ω).
        let mut stretch_by = SMatrix::<f64, 5, 6>::zeros();
        let mut rate_by_place = SMatrix::<f64, 5, 6>::zeros();
        let mut rate_by = SMatrix::<f64, 5, 6>::zeros();
        for axis in 0..3 {
            stretch_by[(axis, axis)] = 1.0;
            rate_by[(axis, axis)] = 1.0;
        }
        stretch_by.fixed_view_mut::<2, 3>(3, 3).copy_from(&w);
        rate_by.fixed_view_mut::<2, 3>(3, 3).copy_from(&w);
        let w_by_c = Matrix2x3::new(
            -omega[2], 0.0, omega[0], // c_z ω_x − c_x ω_z
            0.0, -omega[2], omega[1], // c_z ω_y − c_y ω_z
        );
        rate_by_place
            .fixed_view_mut::<2, 3>(3, 3)
            .copy_from(&(w_by_c * turned));
        let q_by_place = -self.stiffness * stretch_by - self.damping * rate_by_place;
        let q_by_velocity = -self.damping * rate_by;
        let whole = |of_q: &SMatrix<f64, 5, 6>| {
            let mut all = Matrix6::zeros();
            let forces = of_q.fixed_rows::<3>(0);
            all.fixed_rows_mut::<3>(0).copy_from(&forces);
            let moments = w.tr_mul(&of_q.fixed_rows::<2>(3));
            all.fixed_rows_mut::<3>(3).copy_from(&moments);
            all
        };
        let mut by_position = whole(&q_by_place);
        let mut block = by_position.fixed_view_mut::<3, 3>(3, 3);
        block += tilt_by_axis(&Vector2::new(q[3], q[4])) * turned;
        LawTangent {
            by_position,
            by_velocity: whole(&q_by_velocity),
        }
    }
}
