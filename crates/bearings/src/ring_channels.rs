//! What every bearing between two bodies shows of its load on the inner ring.

use gearmesh_dynamics::elements::{Channel, load_channels};
use nalgebra::{Vector3, Vector6};

/// Number of the channels.
pub(crate) const RING_CHANNELS: usize = 10;

/// `force_shaft_x_N` … and `moment_shaft_x_Nm` … on the inner ring along the axes of the outer one, `force_world_x_N`
/// …, and the force across the axis.
pub(crate) fn ring_channels() -> Vec<Channel> {
    load_channels("shaft_")
}

/// Loads of a ball or roller at both races.
pub(crate) fn race_loads(element: &str, number: usize) -> [Channel; 2] {
    ["inner", "outer"].map(|race| {
        let what = format!("load of {element} {number} at the {race} race");
        Channel::new(format!("{element}_{number}_{race}_N"), "N", what)
    })
}

/// Their values: of a load along the axes of the outer ring, and its force in world axes.
pub(crate) fn sample_ring(load: &Vector6<f64>, force_world: &Vector3<f64>, out: &mut [f64]) {
    out[..6].copy_from_slice(load.as_slice());
    out[6..9].copy_from_slice(force_world.as_slice());
    out[9] = load[0].hypot(load[1]);
}
