//! An element that pushes on nothing and writes a column: the distance of two bodies.

use gearmesh_dynamics::elements::{Channel, ForceElement, Loads, View};
use gearmesh_dynamics::{BodyId, ElementFailure};

pub struct DistanceSensor {
    pub bodies: [BodyId; 2],
}

impl ForceElement for DistanceSensor {
    fn name(&self) -> &str {
        "sensor"
    }

    fn bodies(&self) -> &[BodyId] {
        &self.bodies
    }

    fn evaluate(&mut self, _view: &View<'_>, _loads: &mut Loads) -> Result<(), ElementFailure> {
        Ok(())
    }

    // In a result the column is `elements/sensor/distance_m`.
    fn channels(&self) -> Vec<Channel> {
        let what = "distance between the origins of the two bodies";
        vec![Channel::new("distance_m", "m", what)]
    }

    // One number for each channel, in the same order; called for rows that are written, and for nothing else.
    fn sample(&mut self, view: &View<'_>, out: &mut [f64]) {
        let [a, b] = self.bodies.map(|body| view.body(body).position_m);
        out[0] = (b - a).norm();
    }
}
