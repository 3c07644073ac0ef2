//! One side of a mesh at one pose, put together: forces of its contacts along their directions, and what these change by (`gear_mesh.rs`).

use gearmesh_geometry::Flank;

use crate::flank_contacts::FlankContacts;
use crate::flank_kinematics::FlankKinematics;
use crate::friction::Friction;
use crate::gear_mesh::MeshEffort;
use crate::mesh_load::MeshLoad;
use crate::modal_loads::{ContactChange, ModalLoads, Rubbing};
use crate::pose::Vector6;
use crate::teeth_model::TeethLoads;

/// What an evaluation writes to.
pub(crate) struct Parts<'a> {
    pub result: &'a mut MeshLoad,
    pub modal: &'a mut ModalLoads,
    pub coefficients: &'a mut [f64],
    pub effort: &'a mut MeshEffort,
}

/// One side at one pose, put together.
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
    /// Adds load, power, friction and what they push on modes.
    pub(crate) fn add(&self, parts: Parts<'_>, tangents: bool) {
        let (found, loads, result) = (self.found, self.loads, parts.result);
        let sigma = self.flank.mirror();
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
            let mut to_tip_n = 0.0;
            let mut rubbing = None;
            let second =
                (self.friction).and_then(|_| self.kinematics.second_sliding(found, i, self.flank));
            if let (Some(friction), Some(second)) = (self.friction, &second) {
                parts.effort.friction += 1;
                let first = (
                    self.kinematics.sliding(found, i, self.flank),
                    self.kinematics.sliding_gradient(found, i, self.flank),
                );
                let drag = friction.in_plane([&first, second], &self.rates);
                parts.coefficients[i] = drag.coefficient;
                direction += drag.load;
                result.power.dissipated_w += force * drag.dissipated_w;
                if tangents {
                    result.by_position += force * drag.by_position;
                    result.by_velocity += force * drag.by_velocity;
                }
            } else if let Some(friction) = self.friction {
                parts.effort.friction += 1;
                let k = self.kinematics.sliding(found, i, self.flank);
                let vibration = found.tip_speed_m_per_s(i, &self.modal_rates);
                let speed_m_per_s = k.dot(&self.rates) - sigma * vibration;
                let (mu, slope) = friction.coefficient(speed_m_per_s);
                parts.coefficients[i] = mu;
                direction -= mu * k;
                to_tip_n = sigma * mu * force;
                result.power.dissipated_w += mu * force * speed_m_per_s;
                if tangents {
                    let turned = self.kinematics.sliding_gradient(found, i, self.flank);
                    let speed_by_pose = turned.tr_mul(&self.rates);
                    result.by_position -= mu * force * turned;
                    result.by_position -= slope * force * k * speed_by_pose.transpose();
                    result.by_velocity -= slope * force * k * k.transpose();
                    rubbing = Some(Rubbing {
                        sigma,
                        coefficient: mu,
                        force_by_speed: slope * force,
                        direction: k,
                        speed_by_pose,
                    });
                }
            }
            result.load += force * direction;
            if parts.modal.count() > 0 {
                parts.modal.add_force(i, [force, to_tip_n], found);
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
                        rubbing,
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

    /// ∂F_i/∂(increments) and ∂F_i/∂(rates).
    fn force_gradients(&self, i: usize) -> (Vector6, Vector6) {
        let (found, loads) = (self.found, self.loads);
        let n = found.contacts.len();
        let (mut by_pose, mut by_rates) = (Vector6::zeros(), Vector6::zeros());
        for (j, contact) in found.contacts.iter().enumerate() {
            let stiffness = loads.stiffness_n_per_m[i * n + j];
            if stiffness != 0.0 {
                by_pose -= stiffness * contact.gradient;
            }
            let damping = loads.damping_n_s_per_m[i * n + j];
            if damping != 0.0 {
                by_rates -= damping * contact.gradient;
                by_pose -= damping * self.rate_by_pose[j];
            }
        }
        (by_pose, by_rates)
    }
}
