//! What a mesh model is: gaps in, normal forces and their derivatives out.
//!
//! | model | what resists | file |
//! | --- | --- | --- |
//! | `kinematic` | an ideal ratio, a joint and no force | `kinematic.rs` |
//! | `impact` | K δ^e with damping, as in ADAMS | `impact.rs` |
//! | `iso6336` | one stiffness for the whole mesh, after ISO 6336-1 | `iso6336.rs` |
//! | `analytic` | each tooth a beam on its foundation, Hertz | `analytic.rs` |
//! | `hybrid` | two reduced gears and the complementarity problem | `hybrid.rs` |

use gearmesh_dynamics::Iterate;

use crate::error::DrivetrainError;
use crate::flank_contacts::FlankContacts;
use crate::models::hybrid::ReducedTeeth;

/// Normal forces of the contacts of one side of the teeth, and their derivatives. Reused from call to call.
#[derive(Debug, Clone, Default)]
pub struct TeethLoads {
    /// Whether the force of a contact depends on its own gap alone: stiffness and damping are then one number a
    /// contact in place of matrices.
    pub single: bool,
    /// F \[N\], zero or positive, one a contact.
    pub normal_n: Vec<f64>,
    /// K = −∂F/∂gap \[N/m\], row: force.
    pub stiffness_n_per_m: Vec<f64>,
    /// D = −∂F/∂(gap rate) \[N·s/m\], row: force.
    pub damping_n_s_per_m: Vec<f64>,
    /// ∂E*/∂ξ at constant forces \[J/rad\] for each section, gear 1 and gear 2: how the complementary energy of the
    /// teeth changes as the contacts walk over them. The mesh feels it as a generalised force.
    pub energy_by_roll: Vec<[f64; 2]>,
    /// The same as they walk along the teeth \[J/m\].
    pub energy_by_height: Vec<[f64; 2]>,
    /// ∂E*/∂(share of the width) \[J\] for each section; felt alike.
    pub energy_by_share: Vec<f64>,
    /// Elastic energy \[J\].
    pub stored_j: f64,
    /// Power turned into heat by the normal forces \[W\].
    pub dissipated_w: f64,
}

impl TeethLoads {
    /// Sizes for a set of contacts, all zero.
    pub fn begin(&mut self, contacts: usize, sections: usize) {
        let zero = |values: &mut Vec<f64>, size: usize| {
            values.clear();
            values.resize(size, 0.0);
        };
        zero(&mut self.normal_n, contacts);
        let entries = contacts * if self.single { 1 } else { contacts };
        zero(&mut self.stiffness_n_per_m, entries);
        zero(&mut self.damping_n_s_per_m, entries);
        self.energy_by_roll.clear();
        self.energy_by_roll.resize(sections, [0.0; 2]);
        self.energy_by_height.clear();
        self.energy_by_height.resize(sections, [0.0; 2]);
        zero(&mut self.energy_by_share, sections);
        self.stored_j = 0.0;
        self.dissipated_w = 0.0;
    }

    /// Where stiffness and damping of a contact by its own gap stand.
    #[must_use]
    pub fn own(&self, contact: usize) -> usize {
        if self.single {
            contact
        } else {
            contact * (self.normal_n.len() + 1)
        }
    }

    /// The row of a contact in stiffness or damping, and the contact to which its first entry belongs.
    #[must_use]
    pub fn row<'a>(&self, matrix: &'a [f64], contact: usize) -> (usize, &'a [f64]) {
        let n = self.normal_n.len();
        if self.single {
            (contact, &matrix[contact..=contact])
        } else {
            (0, &matrix[contact * n..][..n])
        }
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
    /// Normal forces at given gaps and gap rates, into `loads`, which has been sized and is all zero; stiffness and
    /// damping at least where `tangents`. Must depend on its arguments only, but for rounding: a warm start from what
    /// was last remembered is allowed.
    ///
    /// # Errors
    /// Whatever keeps the model from giving forces.
    fn evaluate(
        &mut self,
        flanks: &FlankContacts,
        tangents: bool,
        loads: &mut TeethLoads,
    ) -> Result<(), DrivetrainError>;

    /// Says of the next evaluations how their motions stand to each other: what changes slowly may be kept from
    /// [`Iterate::First`] for the [`Iterate::Correction`]s that follow.
    fn expect(&mut self, _iterate: Iterate) {}

    /// K d: how much the forces of the last evaluation fall when the gaps open by d \[m\], into `forces`. For models
    /// that fill the stiffness in every evaluation, as those with a spring of its own for each contact do.
    fn apply_stiffness(
        &mut self,
        _flanks: &FlankContacts,
        loads: &TeethLoads,
        opening_m: &[f64],
        forces_n: &mut [f64],
    ) {
        for (row, force) in forces_n.iter_mut().enumerate() {
            let (first, entries) = loads.row(&loads.stiffness_n_per_m, row);
            let openings = &opening_m[first..];
            *force = entries.iter().zip(openings).map(|(k, d)| k * d).sum();
        }
    }

    /// Whether single teeth carry: if not, their errors cannot be felt and are refused.
    fn resolves_teeth(&self) -> bool {
        true
    }

    /// Whether each contact is a spring of its own, so that [`TeethLoads::single`] holds.
    fn acts_singly(&self) -> bool {
        false
    }

    /// Whether the model's compliance is that of reduced gears, from which the share of vibration modes can be taken.
    fn takes_modes(&self) -> bool {
        false
    }

    /// The reduced teeth behind the model, where its contacts can be solved with those of other meshes: between
    /// [`Self::prepare`] and [`Self::evaluate`] forces are then found outside.
    fn coupled(&self) -> Option<&ReducedTeeth> {
        None
    }

    /// The same to be changed.
    fn coupled_mut(&mut self) -> Option<&mut ReducedTeeth> {
        None
    }

    /// Of models that couple: takes the contacts within reach, for forces that are found with those of other meshes.
    /// `deepest_m`: the deepest overlap of all of them.
    ///
    /// # Errors
    /// As [`Self::evaluate`].
    fn prepare(&mut self, _flanks: &FlankContacts, _deepest_m: f64) -> Result<(), DrivetrainError> {
        Ok(())
    }

    /// ∂(gap that the teeth feel)/∂gap and ∂/∂(gap rate) of a contact that was prepared, and how far the felt gap is
    /// ahead of the gap \[m\].
    fn felt(&self, _contact: usize) -> ([f64; 2], f64) {
        ([1.0, 0.0], 0.0)
    }

    /// Takes the forces of the last evaluation as the start of the next ones. Not called after evaluations for output:
    /// a run must not depend on when it is looked at.
    fn remember(&mut self) {}

    /// Appends what is remembered, always as many numbers, so that a run that is resumed repeats bit by bit.
    fn save(&self, _out: &mut Vec<f64>) {}

    /// Takes what [`Self::save`] wrote.
    fn restore(&mut self, _numbers: &[f64]) {}
}

impl<T: TeethModel + 'static> From<T> for Box<dyn TeethModel> {
    fn from(model: T) -> Self {
        Box::new(model)
    }
}
