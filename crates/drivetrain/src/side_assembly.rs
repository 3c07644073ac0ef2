//! One side of a mesh at one pose, put together: contact forces and friction to the load on the gears and their modes,
//! with the tangents.

use gearmesh_geometry::Flank;

use crate::flank_contacts::FlankContacts;
use crate::flank_kinematics::FlankKinematics;
use crate::friction::{Drag, Friction};
use crate::mesh_load::{MeshEffort, MeshLoad};
use crate::modal_loads::{ContactChange, ModalLoads};
use crate::models::teeth_model::TeethLoads;
use crate::pose::Vector6;

/// Friction of one contact for a normal force of one newton.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct FlankFriction {
    /// μ: signed as the sliding of gear 2 along w⊥, positive where flanks slide along the teeth as well.
    pub coefficient: f64,
    /// Force on gear 2 along the tangents of the kinematics.
    pub shares: [f64; 2],
    /// Force on gear 1 and gear 2 along their profiles, positive towards the tip.
    pub towards_tips: [f64; 2],
}

/// What an evaluation writes to.
pub(crate) struct Parts<'a> {
    pub result: &'a mut MeshLoad,
    pub modal: &'a mut ModalLoads,
    pub friction: &'a mut [FlankFriction],
    /// Load on gear 2 per unit force of each contact.
    pub directions: &'a mut [Vector6],
    pub effort: &'a mut MeshEffort,
}

/// One side at one pose.
pub(crate) struct Assembly<'a> {
    pub rates: Vector6,
    /// How the gap rate of each contact changes with the pose; empty without tangents.
    pub rate_by_pose: &'a [Vector6],
    pub found: &'a FlankContacts,
    pub loads: &'a TeethLoads,
    pub flank: Flank,
    pub kinematics: &'a dyn FlankKinematics,
    pub friction: Option<Friction>,
    pub modal_rates: [&'a [f64]; 2],
}

impl Assembly<'_> {
    pub(crate) fn add(&self, parts: Parts<'_>, tangents: bool) {
        let (found, loads, result) = (self.found, self.loads, parts.result);
        for (section, energy) in found.sections.iter().zip(&loads.energy_by_roll) {
            for (rate, gradient) in energy.iter().zip(&section.roll_gradient) {
                result.load += *rate * gradient;
            }
        }
        for (section, energy) in found.sections.iter().zip(&loads.energy_by_height) {
            for (rate, gradient) in energy.iter().zip(&section.along_gradient) {
                if *rate != 0.0 {
                    result.load += *rate * gradient;
                }
            }
        }
        for (section, energy) in found.sections.iter().zip(&loads.energy_by_share) {
            result.load += *energy * section.share_gradient;
        }
        for (i, contact) in found.contacts.iter().enumerate() {
            let force = loads.normal_n[i];
            // A contact without force has no stiffness either.
            if force <= 0.0 {
                continue;
            }
            let mut direction = contact.gradient;
            let drag = self
                .friction
                .map(|friction| self.drag(friction, i, tangents));
            let mut friction_n = [0.0; 2];
            if let Some(drag) = &drag {
                parts.effort.friction += 1;
                parts.friction[i] = self.on_flanks(drag, i);
                friction_n = drag.shares.map(|share| force * share);
                direction += drag.load;
                result.power.dissipated_w += force * drag.dissipated_w;
                result.friction_w += force * drag.dissipated_w;
                if tangents {
                    result.by_position += force * drag.by_position;
                    result.by_velocity += force * drag.by_velocity;
                }
            }
            result.load += force * direction;
            parts.directions[i] = direction;
            if parts.modal.count() > 0 {
                parts.modal.add_force(i, (force, friction_n), found);
            }
            if tangents {
                let (by_pose, by_rates) = self.force_gradients(i);
                result.by_position += direction * by_pose.transpose();
                result.by_velocity += direction * by_rates.transpose();
                if parts.modal.count() > 0 {
                    let change = ContactChange {
                        direction,
                        by_pose,
                        by_rates,
                        rubbing: drag.map(|drag| (drag, force)),
                    };
                    parts.modal.add_tangents(i, &change, loads, found);
                }
            }
        }
        if tangents {
            let (found, forces_n) = (self.found, &loads.normal_n);
            result.by_position += (self.kinematics).load_curvature(found, forces_n, self.flank);
        }
    }

    /// Friction of a contact.
    fn drag(&self, friction: Friction, contact: usize, tangents: bool) -> Drag {
        let found = self.found;
        let along = (self.kinematics).sliding(found, contact, self.flank, tangents);
        let vibration = |tangent: usize| {
            found.sliding_by_vibration_m_per_s((contact, tangent), &self.modal_rates)
        };
        friction.along(&along, vibration, &self.rates)
    }

    /// The same as the flanks see it.
    fn on_flanks(&self, drag: &Drag, contact: usize) -> FlankFriction {
        // Of one tangent w⊥ the tip of either gear lies where friction −μ w⊥ on gear 2 and μ w⊥ on gear 1 point for μ
        // σ > 0.
        let of_profile = [self.kinematics.hand(self.flank) * drag.coefficient; 2];
        let towards_tips = match self.kinematics.tangents_on_flanks(contact, self.flank) {
            None => of_profile,
            Some(tangents) => [0, 1].map(|gear: usize| {
                let on_gear = if gear == 0 { -1.0 } else { 1.0 };
                let along = |a: usize| drag.shares[a] * tangents[gear][a][0];
                on_gear * (along(0) + along(1))
            }),
        };
        FlankFriction {
            coefficient: drag.coefficient,
            shares: drag.shares,
            towards_tips,
        }
    }

    /// ∂F_i/∂(increments) and ∂F_i/∂(rates).
    fn force_gradients(&self, i: usize) -> (Vector6, Vector6) {
        let (found, loads) = (self.found, self.loads);
        let (mut by_pose, mut by_rates) = (Vector6::zeros(), Vector6::zeros());
        let (first, stiffnesses) = loads.row(&loads.stiffness_n_per_m, i);
        let (_, dampings) = loads.row(&loads.damping_n_s_per_m, i);
        let entries = stiffnesses.iter().zip(dampings);
        for (j, (&stiffness, &damping)) in (first..).zip(entries) {
            let contact = &found.contacts[j];
            if stiffness != 0.0 {
                by_pose -= stiffness * contact.gradient;
            }
            if damping != 0.0 {
                by_rates -= damping * contact.gradient;
                by_pose -= damping * self.rate_by_pose[j];
            }
        }
        (by_pose, by_rates)
    }
}
