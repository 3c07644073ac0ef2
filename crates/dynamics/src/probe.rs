//! Force and tangents of one element at a motion: what a test of its tangents by differences needs.

use nalgebra::DMatrix;

use crate::state::State;
use crate::system::{System, view};

/// What an element adds at a motion, in the local order of [`crate::Loads`].
#[derive(Debug, Clone, PartialEq)]
pub struct Probe {
    /// Generalised force, and Q of the element's own coordinates.
    pub force: Vec<f64>,
    /// ∂force/∂increments.
    pub by_position: DMatrix<f64>,
    /// ∂force/∂velocities.
    pub by_velocity: DMatrix<f64>,
    /// Degree of freedom of the system behind each local one; none for the ground's.
    pub dofs: Vec<Option<usize>>,
}

impl System {
    /// Asks an element at the configuration of `from` moved by `increment`, with the velocities `velocity`, each with
    /// one number for every degree of freedom. None where there is no such element, or it has no force there.
    #[must_use]
    pub fn probe(
        &mut self,
        element: &str,
        from: &State,
        increment: &[f64],
        velocity: &[f64],
    ) -> Option<Probe> {
        let mut state = from.clone();
        state.set_moved(from, increment, &self.layout);
        state.velocity.copy_from_slice(velocity);
        self.refresh(&state);
        let view = view(&self.motions, &self.layout, &state, 1.0);
        let mut slots = self.slots.iter_mut();
        let slot = slots.find(|slot| slot.element.name() == element)?;
        let own = slot.own(&view, &state);
        slot.loads.begin(true);
        slot.element.evaluate(&own, &mut slot.loads).ok()?;
        Some(Probe {
            force: slot.loads.force.clone(),
            by_position: slot.loads.by_position.to_dense(),
            by_velocity: slot.loads.by_velocity.to_dense(),
            dofs: slot.system_dofs(),
        })
    }
}
