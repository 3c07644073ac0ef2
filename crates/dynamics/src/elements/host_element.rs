//! An element whose law is a function of the calling program: for prototypes, at the price of its calls.
//!
//! The law gets the motion of marker B as seen in A and gives the load on B. Its tangents are taken by differences:
//!
//! ```text
//! ∂load/∂x_i ≈ (load(x + h_i e_i) − load(x)) / h_i,   h = 1e-8 (m, rad) and 1e-6 (m/s, rad/s)
//! ```
//!
//! which makes twelve further calls wherever tangents are wanted. Differences that are somewhat wrong cost iterations,
//! not accuracy.

use std::sync::Arc;

use nalgebra::{Rotation3, SMatrix, Vector3};

use super::marker_element::{PairLoad, load_channels};
use super::{Channel, ForceElement, Loads, Power, View};
use crate::body::BodyId;
use crate::error::ElementFailure;
use crate::relative_angle::RelativeAngle;
use crate::relative_motion::{MarkerPair, RelativeMotion};

/// Steps of the differences: metres and radians, and the same per second.
const STEPS: [f64; 2] = [1e-8, 1e-6];

/// The motion of marker B as seen in A, A axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HostMotion {
    /// Time \[s\].
    pub time_s: f64,
    /// Place of B from A \[m\].
    pub displacement_m: [f64; 3],
    /// Tilt of B's z axis about x and y of A, and the turn about z, counted over any number of turns \[rad\].
    pub rotation_rad: [f64; 3],
    /// Rate of the displacement \[m/s\].
    pub velocity_m_per_s: [f64; 3],
    /// Angular velocity of B against A \[rad/s\].
    pub angular_velocity_rad_per_s: [f64; 3],
}

/// Load on B, A axes: force \[N\] in the point of B, moment \[N·m\]. Must depend on the motion alone.
pub type HostLaw = dyn Fn(&HostMotion) -> Result<[f64; 6], ElementFailure> + Send + Sync;

/// A law of the calling program between two markers. Channels: those of [`load_channels`].
pub struct HostElement {
    name: String,
    pair: MarkerPair,
    bodies: [BodyId; 2],
    law: Arc<HostLaw>,
    angle: RelativeAngle,
}

impl HostElement {
    /// Puts a law between two markers.
    #[must_use]
    pub fn new(name: &str, pair: MarkerPair, law: Arc<HostLaw>) -> Self {
        Self {
            name: name.to_owned(),
            bodies: [pair.a.body, pair.b.body],
            pair,
            law,
            angle: RelativeAngle::default(),
        }
    }

    fn motion(&self, view: &View<'_>) -> RelativeMotion {
        let [a, b] = self.bodies.map(|body| view.body(body));
        self.pair.motion(a, b)
    }

    fn load(&self, time_s: f64, motion: &RelativeMotion) -> Result<PairLoad, ElementFailure> {
        let z = motion.rotation.column(2);
        let told = HostMotion {
            time_s,
            displacement_m: motion.displacement_m.into(),
            rotation_rad: [
                (-z[1]).atan2(z[2]),
                z[0].atan2(z[2]),
                self.angle.value(motion),
            ],
            velocity_m_per_s: motion.velocity_m_per_s.into(),
            angular_velocity_rad_per_s: motion.angular_velocity_rad_per_s.into(),
        };
        let load = PairLoad::from((self.law)(&told)?);
        if load.iter().all(|part| part.is_finite()) {
            return Ok(load);
        }
        Err(format!(
            "its law gave {:?}, which are not all finite",
            load.as_slice()
        )
        .into())
    }

    /// ∂load/∂(u, rotation, u̇, ω).
    fn tangent(
        &self,
        time_s: f64,
        motion: &RelativeMotion,
        load: &PairLoad,
    ) -> Result<SMatrix<f64, 6, 12>, ElementFailure> {
        let mut tangent = SMatrix::<f64, 6, 12>::zeros();
        for column in 0..12 {
            let (kind, axis) = (column / 3, column % 3);
            let step = STEPS[kind / 2];
            let along = step * Vector3::ith(axis, 1.0);
            let mut moved = *motion;
            match kind {
                0 => moved.displacement_m += along,
                1 => moved.rotation = Rotation3::new(along).into_inner() * moved.rotation,
                2 => moved.velocity_m_per_s += along,
                _ => moved.angular_velocity_rad_per_s += along,
            }
            let slope = (self.load(time_s, &moved)? - load) / step;
            tangent.set_column(column, &slope);
        }
        Ok(tangent)
    }
}

impl ForceElement for HostElement {
    fn name(&self) -> &str {
        &self.name
    }

    fn bodies(&self) -> &[BodyId] {
        &self.bodies
    }

    fn evaluate(&mut self, view: &View<'_>, loads: &mut Loads) -> Result<(), ElementFailure> {
        let motion = self.motion(view);
        let load = self.load(view.time_s, &motion)?;
        let along = motion.velocity_m_per_s.dot(&load.fixed_rows::<3>(0));
        let about = motion
            .angular_velocity_rad_per_s
            .dot(&load.fixed_rows::<3>(3));
        // Whether it stores energy or brings it in, nobody knows: all of it comes from outside.
        loads.power = Power {
            supplied_w: along + about,
            ..Power::default()
        };
        let places = [loads.starts()[0], loads.starts()[1]];
        loads.add_pair_force(places, &motion.generalised_force(&load));
        if loads.wants_tangents() {
            let law = self.tangent(view.time_s, &motion, &load)?;
            let by_motion = law.fixed_columns::<6>(0).into_owned();
            let by_rates = law.fixed_columns::<6>(6).into_owned();
            let jacobian = motion.jacobian();
            let along = by_motion * jacobian + by_rates * motion.rate_jacobian(&jacobian);
            let by_position = jacobian.tr_mul(&along) + motion.geometric_tangent(&jacobian, &load);
            let by_velocity = jacobian.tr_mul(&(by_rates * jacobian));
            loads.add_pair_tangents(places, &by_position, &by_velocity);
        }
        Ok(())
    }

    fn begin(&mut self, view: &View<'_>) {
        let motion = self.motion(view);
        self.angle.begin(&motion);
    }

    fn commit(&mut self, view: &View<'_>) -> Result<(), ElementFailure> {
        let motion = self.motion(view);
        self.angle.commit(&motion);
        Ok(())
    }

    fn save(&self, out: &mut Vec<f64>) {
        out.push(self.angle.committed_rad());
    }

    fn restore(&mut self, numbers: &[f64]) {
        self.angle.restore(numbers[0]);
    }

    fn channels(&self) -> Vec<Channel> {
        load_channels("")
    }

    fn sample(&mut self, view: &View<'_>, out: &mut [f64]) {
        let motion = self.motion(view);
        // A law that fails here fails in the next step, which can say so.
        let Ok(load) = self.load(view.time_s, &motion) else {
            out.fill(f64::NAN);
            return;
        };
        let force = load.fixed_rows::<3>(0).into_owned();
        out[..6].copy_from_slice(load.as_slice());
        out[6..9].copy_from_slice(motion.to_world(&force).as_slice());
    }
}
