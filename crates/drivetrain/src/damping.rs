//! Damping of elastic teeth.
//!
//! Both kinds fade in with the penetration δ = −gap by s(δ) = STEP(δ, 0, 0, δ_full, 1): the force is continuous where
//! teeth meet and nothing acts on teeth that are apart.
//!
//! | kind | law |
//! | --- | --- |
//! | proportional to stiffness | the teeth are a Kelvin-Voigt solid: they feel the gap g + τ s(δ) ġ |
//! | viscous | F = max(0, F_elastic − c s(δ) ġ), c for each tooth pair, shared by its slices; for the whole mesh where the model has no single teeth (`iso6336`) |
//!
//! Neither pulls. The first spends τ ġᵀ K s ġ (but for what K changes within τ s ġ), the second c s ġ².

use gearmesh_dynamics::Iterate;

use crate::error::{DrivetrainError, not_negative, positive};
use crate::flank_contacts::FlankContacts;
use crate::models::hybrid::ReducedTeeth;
use crate::models::teeth_model::{TeethLoads, TeethModel};
use crate::step::step;

/// Kind and amount of damping.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Damping {
    /// τ \[s\]: damping over stiffness.
    StiffnessProportional {
        /// τ \[s\].
        time_s: f64,
        /// δ_full \[m\].
        full_depth_m: f64,
    },
    /// c \[N·s/m\] of a whole tooth pair, or of the mesh where the model has no single teeth.
    Viscous {
        /// c \[N·s/m\].
        coefficient_n_s_per_m: f64,
        /// δ_full \[m\].
        full_depth_m: f64,
    },
}

impl Damping {
    fn validate(self) -> Result<Self, DrivetrainError> {
        let owner = "mesh damping";
        let depth = match self {
            Self::StiffnessProportional {
                time_s,
                full_depth_m,
            } => {
                not_negative(owner, "the time in s", time_s)?;
                full_depth_m
            }
            Self::Viscous {
                coefficient_n_s_per_m,
                full_depth_m,
            } => {
                not_negative(owner, "the coefficient in N s/m", coefficient_n_s_per_m)?;
                full_depth_m
            }
        };
        positive(owner, "the depth of full damping in m", depth)?;
        Ok(self)
    }
}

/// Elastic teeth with damping. Without damping use the model itself.
pub struct Damped {
    teeth: Box<dyn TeethModel>,
    damping: Damping,
    slices: usize,
    felt: FlankContacts,
    /// ∂(felt gap)/∂gap and ∂(felt gap)/∂(gap rate) of each contact.
    felt_by: Vec<[f64; 2]>,
    /// τ s ġ, and the forces K τ s ġ that it makes.
    advance_m: Vec<f64>,
    drag_n: Vec<f64>,
}

impl Damped {
    /// Adds damping to teeth that have `slices` slices.
    ///
    /// # Errors
    /// [`DrivetrainError::Value`].
    pub fn new(
        teeth: impl Into<Box<dyn TeethModel>>,
        damping: Damping,
        slices: usize,
    ) -> Result<Self, DrivetrainError> {
        Ok(Self {
            teeth: teeth.into(),
            damping: damping.validate()?,
            slices,
            felt: FlankContacts::default(),
            felt_by: Vec::new(),
            advance_m: Vec::new(),
            drag_n: Vec::new(),
        })
    }

    /// Sets the gaps that the teeth feel, g + τ s ġ.
    fn feel(&mut self, flanks: &FlankContacts, [time_s, full_m]: [f64; 2]) {
        self.felt.along_teeth = flanks.along_teeth;
        self.felt.action_m_per_u = flanks.action_m_per_u;
        self.felt.lines.clone_from(&flanks.lines);
        self.felt.sections.clone_from(&flanks.sections);
        self.felt.contacts.clone_from(&flanks.contacts);
        for (felt, modal) in self.felt.modal.iter_mut().zip(&flanks.modal) {
            felt.copy_normal_from(modal);
        }
        self.felt_by.clear();
        self.advance_m.clear();
        for contact in &mut self.felt.contacts {
            let (share, slope) = step(-contact.gap_m, [0.0, 0.0], [full_m, 1.0]);
            let rate = contact.gap_rate_m_per_s;
            contact.gap_m += time_s * share * rate;
            self.advance_m.push(time_s * share * rate);
            self.felt_by
                .push([1.0 - time_s * rate * slope, time_s * share]);
        }
    }

    fn proportional(
        &mut self,
        (flanks, tangents): (&FlankContacts, bool),
        loads: &mut TeethLoads,
        law: [f64; 2],
    ) -> Result<(), DrivetrainError> {
        // Open flanks feel what is there: nothing to copy.
        if flanks.contacts.iter().all(|contact| contact.gap_m >= 0.0) {
            return self.teeth.evaluate(flanks, tangents, loads);
        }
        self.feel(flanks, law);
        self.teeth.evaluate(&self.felt, tangents, loads)?;
        let n = flanks.contacts.len();
        self.drag_n.resize(n, 0.0);
        (self.teeth).apply_stiffness(&self.felt, loads, &self.advance_m, &mut self.drag_n);
        for (i, contact) in flanks.contacts.iter().enumerate() {
            loads.dissipated_w += contact.gap_rate_m_per_s * self.drag_n[i];
            // The energy V at the true gap g, from the felt one g + a: V(g) = V(g + a) + F·a + ½ aᵀK a, so that what
            // the forces do is the change of V and aᵀK ġ but for what K changes.
            let mean_n = loads.normal_n[i] + 0.5 * self.drag_n[i];
            loads.stored_j += mean_n * self.advance_m[i];
        }
        if tangents {
            let rows = loads.stiffness_n_per_m.chunks_exact_mut(n.max(1));
            for (row, damping) in rows.zip(loads.damping_n_s_per_m.chunks_exact_mut(n.max(1))) {
                for ((k, d), [by_gap, by_rate]) in row.iter_mut().zip(damping).zip(&self.felt_by) {
                    *d = *k * by_rate;
                    *k *= by_gap;
                }
            }
        }
        Ok(())
    }

    fn viscous(
        &mut self,
        (flanks, tangents): (&FlankContacts, bool),
        loads: &mut TeethLoads,
        [coefficient, full_m]: [f64; 2],
    ) -> Result<(), DrivetrainError> {
        self.teeth.evaluate(flanks, tangents, loads)?;
        let n = flanks.contacts.len();
        let each = coefficient / self.slices as f64;
        // One spring for the mesh has one damper: the other pairs that it stands for have none of their own.
        let everywhere = self.teeth.resolves_teeth();
        for (i, contact) in flanks.contacts.iter().enumerate() {
            if !everywhere && loads.normal_n[i] == 0.0 {
                continue;
            }
            let each = each * flanks.section(contact).share;
            let (share, slope) = step(-contact.gap_m, [0.0, 0.0], [full_m, 1.0]);
            let rate = contact.gap_rate_m_per_s;
            let damped = loads.normal_n[i] - each * share * rate;
            if damped > 0.0 {
                loads.dissipated_w += each * share * rate * rate;
                loads.normal_n[i] = damped;
                loads.stiffness_n_per_m[i * n + i] -= each * slope * rate;
                loads.damping_n_s_per_m[i * n + i] += each * share;
            } else {
                loads.dissipated_w += loads.normal_n[i] * rate;
                loads.normal_n[i] = 0.0;
                loads.stiffness_n_per_m[i * n..][..n].fill(0.0);
            }
        }
        Ok(())
    }
}

impl TeethModel for Damped {
    fn evaluate(
        &mut self,
        flanks: &FlankContacts,
        tangents: bool,
        loads: &mut TeethLoads,
    ) -> Result<(), DrivetrainError> {
        let flanks = (flanks, tangents);
        match self.damping {
            Damping::StiffnessProportional {
                time_s,
                full_depth_m,
            } => self.proportional(flanks, loads, [time_s, full_depth_m]),
            Damping::Viscous {
                coefficient_n_s_per_m,
                full_depth_m,
            } => self.viscous(flanks, loads, [coefficient_n_s_per_m, full_depth_m]),
        }
    }

    fn expect(&mut self, iterate: Iterate) {
        self.teeth.expect(iterate);
    }

    fn resolves_teeth(&self) -> bool {
        self.teeth.resolves_teeth()
    }

    fn takes_modes(&self) -> bool {
        self.teeth.takes_modes()
    }

    fn coupled(&self) -> Option<&ReducedTeeth> {
        self.teeth.coupled()
    }

    fn coupled_mut(&mut self) -> Option<&mut ReducedTeeth> {
        self.teeth.coupled_mut()
    }

    fn prepare(&mut self, flanks: &FlankContacts, deepest_m: f64) -> Result<(), DrivetrainError> {
        let open = flanks.contacts.iter().all(|contact| contact.gap_m >= 0.0);
        match self.damping {
            Damping::StiffnessProportional {
                time_s,
                full_depth_m,
            } if !open => {
                self.feel(flanks, [time_s, full_depth_m]);
                self.teeth.prepare(&self.felt, deepest_m)
            }
            _ => {
                self.felt_by.clear();
                self.teeth.prepare(flanks, deepest_m)
            }
        }
    }

    fn felt(&self, contact: usize) -> ([f64; 2], f64) {
        match self.felt_by.get(contact) {
            Some(felt_by) => (*felt_by, self.advance_m[contact]),
            None => ([1.0, 0.0], 0.0),
        }
    }

    fn remember(&mut self) {
        self.teeth.remember();
    }

    fn save(&self, out: &mut Vec<f64>) {
        self.teeth.save(out);
    }

    fn restore(&mut self, numbers: &[f64]) {
        self.teeth.restore(numbers);
    }
}
