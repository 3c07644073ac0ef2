//! The weight of one body: m g in the centre of mass of the (deformed) body.
//!
//! ```text
//! force m g,   moment s × Rᵀg,   modal L_t Rᵀg,   energy −(m x + R s)ᵀg      s = m c + L_tᵀη
//! ```

use nalgebra::Vector3;

use super::{ForceElement, Loads, Power, View};
use crate::body::{Body, BodyId};
use crate::error::ElementFailure;
use crate::rotation::skew;

/// Weight of one body.
#[derive(Debug, Clone)]
pub struct Gravity {
    name: String,
    body: [BodyId; 1],
    mass: f64,
    first_moment: Vector3<f64>,
    coupling: Vec<Vector3<f64>>,
    acceleration: Vector3<f64>,
}

impl Gravity {
    /// The weight of `body`, whose number is `id`, under an acceleration \[m/s²\], world axes.
    #[must_use]
    pub fn new(id: BodyId, body: &Body, acceleration_m_per_s2: [f64; 3]) -> Self {
        let row = |i: usize, modes: &crate::body::Modes| {
            Vector3::from_fn(|axis, _| modes.coupling[(i, axis)])
        };
        let coupling = body
            .modes
            .iter()
            .flat_map(|modes| (0..modes.coupling.nrows()).map(move |i| row(i, modes)));
        Self {
            name: format!("weight of {}", body.name),
            body: [id],
            mass: body.mass_kg,
            first_moment: body.mass_kg * body.center_of_mass_m,
            coupling: coupling.collect(),
            acceleration: Vector3::from(acceleration_m_per_s2),
        }
    }
}

impl ForceElement for Gravity {
    fn name(&self) -> &str {
        &self.name
    }

    fn bodies(&self) -> &[BodyId] {
        &self.body
    }

    fn evaluate(&mut self, view: &View<'_>, loads: &mut Loads) -> Result<(), ElementFailure> {
        let motion = view.body(self.body[0]);
        let g = view.load_factor * self.acceleration;
        let own = motion.rotation.transpose() * g;
        let mut moment = self.first_moment;
        for (i, (eta, t)) in view
            .modal(self.body[0])
            .iter()
            .zip(&self.coupling)
            .enumerate()
        {
            moment += *eta * t;
            loads.add_force(6 + i, &[t.dot(&own)]);
        }
        loads.add_force(0, (self.mass * g).as_slice());
        loads.add_force(3, moment.cross(&own).as_slice());
        loads.power = Power {
            stored_j: -self.mass * motion.position_m.dot(&g) - moment.dot(&own),
            ..Power::default()
        };
        if loads.wants_tangents() {
            // δ(Rᵀg) = Rᵀg × δψ
            loads.add_block_by_position(3, 3, &(skew(&moment) * skew(&own)));
            for (i, t) in self.coupling.iter().enumerate() {
                let turned = t.cross(&own);
                for axis in 0..3 {
                    loads.add_by_position(6 + i, 3 + axis, turned[axis]);
                    loads.add_by_position(3 + axis, 6 + i, turned[axis]);
                }
            }
        }
        Ok(())
    }
}
