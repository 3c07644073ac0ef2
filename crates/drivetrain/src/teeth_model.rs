//! What a mesh model is: gaps in, normal forces and their derivatives out.
//!
//! | model | what resists | file |
//! | --- | --- | --- |
//! | `kinematic` | an ideal ratio, a joint and no force | `models/kinematic.rs` |
//! | `impact` | K δ^e with damping, as in ADAMS | `models/impact.rs` |
//! | `iso6336` | one stiffness for the whole mesh, after ISO 6336-1 | `models/iso6336.rs` |
//! | `analytic` | each tooth a beam on its foundation, Hertz | `models/analytic.rs` |
//! | `hybrid` | two reduced gears and the complementarity problem | `models/hybrid.rs` |

use crate::error::DrivetrainError;
use crate::mesh_kinematics::FlankContacts;

/// Normal forces of the contacts of one side of the teeth, and their derivatives. Reused from call to call.
#[derive(Debug, Clone, Default)]
pub struct TeethLoads {
    /// F \[N\], zero or positive, one a contact.
    pub normal_n: Vec<f64>,
    /// K = −∂F/∂gap \[N/m\], row: force.
    pub stiffness_n_per_m: Vec<f64>,
    /// D = −∂F/∂(gap rate) \[N·s/m\], row: force.
    pub damping_n_s_per_m: Vec<f64>,
    /// ∂E*/∂ξ at constant forces \[J/rad\] for each line, gear 1 and gear 2: how the complementary energy of the teeth changes as the
    /// contacts walk over them. The mesh feels it as a generalised force.
    pub energy_by_roll: Vec<[f64; 2]>,
    /// Elastic energy \[J\].
    pub stored_j: f64,
    /// Power turned into heat by the normal forces \[W\].
    pub dissipated_w: f64,
}

impl TeethLoads {
    /// Sizes for a set of contacts, all zero.
    pub fn begin(&mut self, contacts: usize, lines: usize) {
        let zero = |values: &mut Vec<f64>, size: usize| {
            values.clear();
            values.resize(size, 0.0);
        };
        zero(&mut self.normal_n, contacts);
        zero(&mut self.stiffness_n_per_m, contacts * contacts);
        zero(&mut self.damping_n_s_per_m, contacts * contacts);
        self.energy_by_roll.clear();
        self.energy_by_roll.resize(lines, [0.0; 2]);
        self.stored_j = 0.0;
        self.dissipated_w = 0.0;
    }

    /// Memory for at most so many contacts.
    #[must_use]
    pub fn with_capacity(contacts: usize) -> Self {
        let mut loads = Self::default();
        loads.begin(contacts, contacts);
        loads.begin(0, 0);
        loads
    }
}

/// A model of the teeth of one side.
pub trait TeethModel: Send {
    /// Normal forces at given gaps and gap rates, into `loads`, which has been sized and is all zero. Must depend on its arguments
    /// only, but for rounding: a warm start is allowed.
    ///
    /// # Errors
    /// Whatever keeps the model from giving forces.
    fn evaluate(
        &mut self,
        flanks: &FlankContacts,
        loads: &mut TeethLoads,
    ) -> Result<(), DrivetrainError>;

    /// Whether single teeth carry: if not, their errors cannot be felt and are refused.
    fn resolves_teeth(&self) -> bool {
        true
    }

    /// Forgets warm starts. Called at the end of every accepted step, so that a run that is resumed there repeats bit by bit.
    fn forget(&mut self) {}
}

impl TeethModel for Box<dyn TeethModel> {
    fn evaluate(
        &mut self,
        flanks: &FlankContacts,
        loads: &mut TeethLoads,
    ) -> Result<(), DrivetrainError> {
        (**self).evaluate(flanks, loads)
    }

    fn resolves_teeth(&self) -> bool {
        (**self).resolves_teeth()
    }

    fn forget(&mut self) {
        (**self).forget();
    }
}
