//! `tangent_of`: bearings that are linear about the operating point of their bearing file.
//!
//! The operating point is the static equilibrium under the loads of t = 0 with balls or rollers in equilibrium, at the
//! speeds of the start. There load and tangent are taken; the equilibrium of the scene with these linear bearings is
//! sought, and load and tangent are taken anew where the ring stands then, until they do not change. In exact numbers
//! the first turn is the last: load and slope are those of the bearing itself.

use gearmesh_bearings::{BearingError, Control, Operation, QuasiStaticBearing, RingPose};
use gearmesh_dynamics::{Marker, MarkerPair, State, System};
use gearmesh_specification::system::bearing::{BearingModel, BearingTable};
use nalgebra::{Matrix5, Vector3, Vector5};

/// A bearing whose tangent is taken.
#[derive(Debug, Clone)]
pub(in crate::system) struct TangentSeat {
    /// Number of the bearing.
    pub bearing: usize,
    pair: MarkerPair,
    rolling: QuasiStaticBearing,
    control: Control,
}

/// Load and slope of a bearing at its operating point.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::system) struct Tangent {
    /// Number of the bearing.
    pub bearing: usize,
    /// e₀: x, y, z \[m\], tilt about x, about y \[rad\].
    pub at: Vector5<f64>,
    /// Load on the shaft there \[N, N·m\].
    pub load: Vector5<f64>,
    /// Stiffness \[N/m, N/rad, N·m/rad\].
    pub stiffness: Matrix5<f64>,
}

/// Whether there are any.
pub(in crate::system::assembly) fn any(tables: &[BearingTable]) -> bool {
    let takes = |table: &BearingTable| matches!(&table.model, BearingModel::Linear(model) if model.tangent_of.is_some());
    tables.iter().any(takes)
}

impl TangentSeat {
    pub(super) fn new(
        bearing: usize,
        (pair, rolling): (MarkerPair, QuasiStaticBearing),
        control: Control,
    ) -> Self {
        Self {
            bearing,
            pair,
            rolling,
            control,
        }
    }

    /// Load and tangent where the rings stand in a state.
    pub(in crate::system::assembly) fn tangent(
        &self,
        system: &System,
        state: &State,
    ) -> Result<Tangent, BearingError> {
        let [a, b] =
            [self.pair.a.body, self.pair.b.body].map(|body| system.body_motion(state, body));
        let motion = self.pair.motion(&a, &b);
        let speed = |marker: &Marker, turning: &Vector3<f64>| {
            turning.dot(&(marker.orientation() * Vector3::z()))
        };
        let operation = Operation {
            inner_rad_per_s: speed(&self.pair.b, &b.angular_velocity_rad_per_s),
            outer_rad_per_s: speed(&self.pair.a, &a.angular_velocity_rad_per_s),
            control: self.control,
            ..Operation::default()
        };
        let pose = RingPose {
            centre_m: motion.displacement_m,
            axis: motion.rotation.column(2).into(),
        };
        let ring = self.rolling.evaluate(&pose, &operation)?;
        let (u, c) = (pose.centre_m, pose.axis);
        // Moments: μ = Wᵀ q with W of `MatrixBearing`; tilts: δe = c_z φ for a φ across z.
        let moments = Vector5::new(1.0, 1.0, 1.0, 1.0 / c.z, 1.0 / c.z);
        let load = ring.five().component_mul(&moments);
        let by_tilt = [c.y, -c.x];
        let slope = Matrix5::from_fn(|i, j| {
            let mut slope = ring.tangent[(i, j)] * moments[i];
            if i >= 3 && j >= 3 {
                slope -= load[i] * by_tilt[j - 3] / c.z;
            }
            if j >= 3 { slope / c.z } else { slope }
        });
        Ok(Tangent {
            bearing: self.bearing,
            at: Vector5::new(u.x, u.y, u.z, -c.y, c.x),
            load,
            stiffness: -slope,
        })
    }
}

impl Tangent {
    /// Whether another one has the same stiffness, each entry measured by the diagonal of its row and column.
    pub(in crate::system::assembly) fn is_as(&self, other: &Self) -> bool {
        const SAME: f64 = 1e-6;
        let (one, two) = (&self.stiffness, &other.stiffness);
        let size = |i: usize, j: usize| (one[(i, i)] * one[(j, j)]).abs().sqrt();
        let mut pairs = (0..5).flat_map(|i| (0..5).map(move |j| (i, j)));
        pairs.all(|(i, j)| (one[(i, j)] - two[(i, j)]).abs() <= SAME * size(i, j))
    }

    /// In words, for the notes.
    pub(in crate::system::assembly) fn in_words(&self, name: &str, turns: usize) -> String {
        let (u, k) = (&self.at, &self.stiffness);
        format!(
            "bearing `{name}`: tangent at the operating point, unchanged after {turns} turns: displacement {:.4}, {:.4}, {:.4} um, tilt {:.4}, \
             {:.4} mrad; stiffness {:.5e}, {:.5e}, {:.5e} N/mm, {:.5e}, {:.5e} N m/rad",
            1e6 * u[0],
            1e6 * u[1],
            1e6 * u[2],
            1e3 * u[3],
            1e3 * u[4],
            1e-3 * k[(0, 0)],
            1e-3 * k[(1, 1)],
            1e-3 * k[(2, 2)],
            k[(3, 3)],
            k[(4, 4)]
        )
    }
}
