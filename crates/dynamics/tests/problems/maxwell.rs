//! A Maxwell element along x between the ground and a body: a spring in series with a damper, whose length is a
//! coordinate of the element.

use gearmesh_dynamics::elements::{Channel, ForceElement, Loads, Power, View};
use gearmesh_dynamics::{BodyId, ElementFailure, Unknown};

/// u: length of the damper [m]; the spring is as long as what is left, x − u.
pub struct Maxwell {
    pub body: [BodyId; 1],
    pub stiffness_n_per_m: f64,
    pub damping_n_s_per_m: f64,
}

impl ForceElement for Maxwell {
    fn name(&self) -> &str {
        "maxwell"
    }

    fn bodies(&self) -> &[BodyId] {
        &self.body
    }

    // One coordinate with a rate, u̇ = Q. A change by 1 mm matters as much as a turn by one radian.
    fn unknowns(&self) -> Vec<Unknown> {
        vec![Unknown::rate("damper_length_m", 1e-3)]
    }

    fn evaluate(&mut self, view: &View<'_>, loads: &mut Loads) -> Result<(), ElementFailure> {
        let (x, u) = (view.body(self.body[0]).position_m.x, view.unknowns()[0]);
        let (k, c) = (self.stiffness_n_per_m, self.damping_n_s_per_m);
        let pull = k * (x - u);
        // Place of u among the local degrees of freedom: behind those of the body.
        let own = loads.first_unknown();
        loads.add_force(0, &[-pull]);
        loads.add_force(own, &[pull / c]);
        loads.power = Power {
            stored_j: 0.5 * pull * pull / k,
            dissipated_w: pull * pull / c,
            supplied_w: 0.0,
        };
        if loads.wants_tangents() {
            loads.add_by_position(0, 0, -k);
            loads.add_by_position(0, own, k);
            loads.add_by_position(own, 0, k / c);
            loads.add_by_position(own, own, -k / c);
        }
        Ok(())
    }

    fn channels(&self) -> Vec<Channel> {
        vec![Channel::new("damper_length_m", "m", "length of the damper")]
    }

    fn sample(&mut self, view: &View<'_>, out: &mut [f64]) {
        out[0] = view.unknowns()[0];
    }
}
