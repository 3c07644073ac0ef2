//! What a mesh does at a pose: load, tangents, energy; and how often it was computed.

use gearmesh_dynamics::Power;

use crate::pose::Vector6;
use crate::slice_plane::Matrix6;

/// What a mesh does at a pose.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeshLoad {
    /// Force \[N\] and moment \[N·m\] on gear 2 in its origin, gear 1 axes.
    pub load: Vector6,
    /// ∂load/∂(increments of the pose); zero unless asked for.
    pub by_position: Matrix6,
    /// ∂load/∂(rates of the pose); zero unless asked for.
    pub by_velocity: Matrix6,
    /// Energy and power.
    pub power: Power,
    /// Power that friction of the teeth takes, within that of `power` \[W\].
    pub friction_w: f64,
}

impl Default for MeshLoad {
    fn default() -> Self {
        Self {
            load: Vector6::zeros(),
            by_position: Matrix6::zeros(),
            by_velocity: Matrix6::zeros(),
            power: Power::default(),
            friction_w: 0.0,
        }
    }
}

/// How often each part of a mesh was computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct MeshEffort {
    /// Poses.
    pub poses: u64,
    /// Evaluations of a model, one for each side that has teeth facing each other.
    pub models: u64,
    /// Contacts whose friction was computed.
    pub friction: u64,
}
