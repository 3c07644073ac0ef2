//! A gear mesh: kinematics, a model for each side of the teeth, friction; force and tangents on the six relative increments.
//!
//! ```text
//! load = Σ_i (F_i g_i + T_i k_i) + Σ_lines Σ_gears (∂E*/∂ξ) ∂ξ            g = ∂gap, k: friction direction
//! ∂load = Σ_i (g_i − μ_i k_i) ∂F_iᵀ + Σ_i F_i ∂g_i + friction,   ∂F_i = −Σ_j (K_ij ∂gap_j + D_ij ∂(gap rate)_j)
//! ```
//!
//! Virtual work makes the load: it is a force on gear 2 and its reaction on gear 1 by construction. Left out of the tangent: how the
//! compliance and the microgeometry's slope change with the pose, of the order of deflection over the pitch, 1e-3 of the stiffness.

use gearmesh_dynamics::Power;
use gearmesh_geometry::FlankSide;

use crate::error::DrivetrainError;
use crate::friction::{Friction, Sliding};
use crate::mesh_kinematics::{FlankContacts, Matrix6, MeshKinematics};
use crate::pose::{Pose, Vector6};
use crate::teeth_model::{TeethLoads, TeethModel};

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
}

impl Default for MeshLoad {
    fn default() -> Self {
        Self {
            load: Vector6::zeros(),
            by_position: Matrix6::zeros(),
            by_velocity: Matrix6::zeros(),
            power: Power::default(),
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

struct Side {
    flank: FlankSide,
    model: Box<dyn TeethModel>,
    found: FlankContacts,
    loads: TeethLoads,
}

/// A mesh of two gears.
pub struct GearMesh {
    kinematics: MeshKinematics,
    sides: Vec<Side>,
    friction: Option<Friction>,
    effort: MeshEffort,
}

impl GearMesh {
    /// A mesh with contact on the flanks of one side; add the other by [`GearMesh::with_side`].
    ///
    /// # Errors
    /// [`DrivetrainError::UnusedFlankErrors`] if the kinematics have flank errors that the model cannot feel.
    pub fn new(
        kinematics: MeshKinematics,
        flank: FlankSide,
        model: impl TeethModel + 'static,
    ) -> Result<Self, DrivetrainError> {
        let mesh = Self {
            kinematics,
            sides: Vec::new(),
            friction: None,
            effort: MeshEffort::default(),
        };
        mesh.with_side(flank, model)
    }

    /// Adds contact on the flanks of another side: with both, backlash is what the tooth thickness leaves. A side that is there already is
    /// replaced.
    ///
    /// # Errors
    /// As [`GearMesh::new`].
    pub fn with_side(
        mut self,
        flank: FlankSide,
        model: impl TeethModel + 'static,
    ) -> Result<Self, DrivetrainError> {
        if !model.resolves_teeth() && self.kinematics.has_errors() {
            return Err(DrivetrainError::UnusedFlankErrors);
        }
        let capacity = self.kinematics.capacity();
        self.sides.retain(|side| side.flank != flank);
        self.sides.push(Side {
            flank,
            model: Box::new(model),
            found: FlankContacts::with_capacity(self.kinematics.slices_m().len(), capacity),
            loads: TeethLoads::with_capacity(capacity),
        });
        Ok(self)
    }

    /// Adds friction.
    #[must_use]
    pub fn with_friction(mut self, friction: Friction) -> Self {
        self.friction = Some(friction);
        self
    }

    /// Kinematics.
    #[must_use]
    pub fn kinematics(&self) -> &MeshKinematics {
        &self.kinematics
    }

    /// What was computed so far.
    #[must_use]
    pub fn effort(&self) -> MeshEffort {
        self.effort
    }

    /// Teeth facing each other at the last pose, and their normal forces \[N\]; none if that side is not modelled.
    #[must_use]
    pub fn side(&self, flank: FlankSide) -> Option<(&FlankContacts, &[f64])> {
        let side = self.sides.iter().find(|side| side.flank == flank)?;
        Some((&side.found, &side.loads.normal_n))
    }

    /// The sides that are modelled.
    pub fn flanks(&self) -> impl Iterator<Item = FlankSide> {
        self.sides.iter().map(|side| side.flank)
    }

    /// Transmission error along the line of action \[m\] of the last pose on the first side: the gap that ideal flanks would have,
    /// r_b2 θ₂ − r_b1 θ₁ at the nominal centre distance. None where no teeth face each other.
    #[must_use]
    pub fn transmission_error_m(&self) -> Option<f64> {
        let line = self.sides.first()?.found.lines.first()?;
        Some(line.ideal_gap_m)
    }

    /// Forgets warm starts.
    pub fn forget(&mut self) {
        for side in &mut self.sides {
            side.model.forget();
        }
    }

    /// Load at a pose, with tangents where `tangents`.
    ///
    /// # Errors
    /// [`DrivetrainError`] of the kinematics or the model.
    pub fn evaluate(&mut self, pose: &Pose, tangents: bool) -> Result<MeshLoad, DrivetrainError> {
        let mut result = MeshLoad::default();
        self.effort.poses += 1;
        for side in &mut self.sides {
            self.kinematics
                .contacts(pose, side.flank, &mut side.found)?;
            let (contacts, lines) = (side.found.contacts.len(), side.found.lines.len());
            side.loads.begin(contacts, lines);
            if contacts == 0 {
                continue;
            }
            self.effort.models += 1;
            side.model.evaluate(&side.found, &mut side.loads)?;
            result.power.stored_j += side.loads.stored_j;
            result.power.dissipated_w += side.loads.dissipated_w;
            let base_radii = [0, 1].map(|i| self.kinematics.gears()[i].base_radius_m);
            let assembly = Assembly {
                pose,
                rates: pose.rates(),
                side,
                base_radii,
                friction: self.friction,
            };
            assembly.add(&mut result, tangents, &mut self.effort);
        }
        Ok(result)
    }
}

/// One side at one pose, put together.
struct Assembly<'a> {
    pose: &'a Pose,
    rates: Vector6,
    side: &'a Side,
    base_radii: [f64; 2],
    friction: Option<Friction>,
}

impl Assembly<'_> {
    fn add(&self, result: &mut MeshLoad, tangents: bool, effort: &mut MeshEffort) {
        let (found, loads) = (&self.side.found, &self.side.loads);
        let sigma = self.side.flank.mirror();
        for (line, energy) in found.lines.iter().zip(&loads.energy_by_roll) {
            for (rate, gradient) in energy.iter().zip(&line.roll_gradient) {
                result.load += *rate * gradient;
            }
        }
        for (i, contact) in found.contacts.iter().enumerate() {
            let force = loads.normal_n[i];
            let (plane, line) = (&found.planes[contact.slice], &found.lines[contact.line]);
            let mut direction = contact.gradient;
            if force > 0.0
                && let Some(friction) = self.friction
            {
                effort.friction += 1;
                let on_gear_1 = (self.base_radii[0], line.touching_roll_rad[0]);
                let sliding = Sliding::new(plane, self.pose, sigma, on_gear_1);
                let (mu, slope) = friction.coefficient(sliding.speed_m_per_s);
                direction -= mu * sliding.direction;
                result.power.dissipated_w += mu * force * sliding.speed_m_per_s;
                if tangents {
                    let turned = Sliding::direction_gradient(plane, self.pose, sigma, on_gear_1);
                    let speed_by_pose = turned.tr_mul(&self.rates);
                    let k = sliding.direction;
                    result.by_position -= mu * force * turned;
                    result.by_position -= slope * force * k * speed_by_pose.transpose();
                    result.by_velocity -= slope * force * k * k.transpose();
                }
            }
            result.load += force * direction;
            if tangents {
                let (by_pose, by_rates) = self.force_gradients(i);
                result.by_position += direction * by_pose.transpose();
                result.by_velocity += direction * by_rates.transpose();
            }
        }
        if tangents {
            self.add_curvature(result);
        }
    }

    /// ∂F_i/∂(increments) and ∂F_i/∂(rates).
    fn force_gradients(&self, i: usize) -> (Vector6, Vector6) {
        let (found, loads) = (&self.side.found, &self.side.loads);
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
                let plane = &found.planes[contact.slice];
                let curvature = plane.gap_curvature(self.pose, self.side.flank, self.base_radii[1]);
                by_pose -= damping * (curvature.tr_mul(&self.rates));
            }
        }
        (by_pose, by_rates)
    }

    fn add_curvature(&self, result: &mut MeshLoad) {
        let (found, loads) = (&self.side.found, &self.side.loads);
        for (slice, plane) in found.planes.iter().enumerate() {
            let forces = found.contacts.iter().zip(&loads.normal_n);
            let of_plane: f64 = forces
                .filter(|(contact, _)| contact.slice == slice)
                .map(|(_, force)| force)
                .sum();
            if of_plane > 0.0 {
                result.by_position +=
                    of_plane * plane.gap_curvature(self.pose, self.side.flank, self.base_radii[1]);
            }
        }
    }
}
