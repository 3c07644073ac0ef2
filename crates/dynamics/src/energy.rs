//! Energy of the system and its balance over a run.
//!
//! ```text
//! E(t) − E(0) + ∫ dissipated − ∫ supplied = error of the balance
//! ```
//!
//! Powers are integrated by the trapezoidal rule over the accepted steps, an error of the second order like the
//! integrator's own.
//!
//! What the error is judged against is the work done, whatever its sign: ∫ W dt with
//!
//! ```text
//! W = Σ |power of each load and motion| + dissipated + Σ |m_i v̇_i v_i|      m: diagonal of the mass matrix
//! ```
//!
//! The last sum is the work of all forces together on each degree of freedom. Kinetic energy that a body just has is no
//! work: a fast flywheel must not hide that a mesh makes energy out of nothing.

/// Energies and powers at one time.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Energy {
    /// Kinetic energy \[J\].
    pub kinetic_j: f64,
    /// Energy stored in springs, modes and the field of gravity \[J\].
    pub potential_j: f64,
    /// Power turned into heat \[W\].
    pub dissipated_w: f64,
    /// Power of applied loads and prescribed motions \[W\].
    pub supplied_w: f64,
}

impl Energy {
    /// Kinetic and potential energy \[J\].
    #[must_use]
    pub fn total_j(&self) -> f64 {
        self.kinetic_j + self.potential_j
    }
}

/// The balance up to now.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct EnergyBalance {
    /// At the start.
    pub first: Energy,
    /// Now.
    pub last: Energy,
    /// Heat since the start \[J\].
    pub dissipated_j: f64,
    /// Work of applied loads and prescribed motions since the start \[J\].
    pub supplied_j: f64,
    /// Largest magnitude of the balance's error so far \[J\].
    pub largest_error_j: f64,
    /// Work done since the start, whatever its sign \[J\] (module page).
    pub work_j: f64,
    /// Its rate now \[W\].
    pub work_rate_w: f64,
}

impl EnergyBalance {
    pub(crate) fn begin(energy: Energy, work_rate_w: f64) -> Self {
        Self {
            first: energy,
            last: energy,
            work_rate_w,
            ..Self::default()
        }
    }

    pub(crate) fn advance(&mut self, energy: Energy, work_rate_w: f64, step_s: f64) {
        self.work_j += 0.5 * step_s * (self.work_rate_w + work_rate_w);
        self.work_rate_w = work_rate_w;
        self.dissipated_j += 0.5 * step_s * (self.last.dissipated_w + energy.dissipated_w);
        self.supplied_j += 0.5 * step_s * (self.last.supplied_w + energy.supplied_w);
        self.last = energy;
        self.largest_error_j = self.largest_error_j.max(self.error_j().abs());
    }

    /// Error of the balance now \[J\].
    #[must_use]
    pub fn error_j(&self) -> f64 {
        self.last.total_j() - self.first.total_j() + self.dissipated_j - self.supplied_j
    }

    /// The numbers, for a checkpoint.
    pub(crate) fn numbers(&self) -> [f64; 13] {
        let [a, b] = [self.first, self.last];
        [
            a.kinetic_j,
            a.potential_j,
            a.dissipated_w,
            a.supplied_w,
            b.kinetic_j,
            b.potential_j,
            b.dissipated_w,
            b.supplied_w,
            self.dissipated_j,
            self.supplied_j,
            self.largest_error_j,
            self.work_j,
            self.work_rate_w,
        ]
    }

    pub(crate) fn from_numbers(n: &[f64; 13]) -> Self {
        let energy = |at: usize| Energy {
            kinetic_j: n[at],
            potential_j: n[at + 1],
            dissipated_w: n[at + 2],
            supplied_w: n[at + 3],
        };
        Self {
            first: energy(0),
            last: energy(4),
            dissipated_j: n[8],
            supplied_j: n[9],
            largest_error_j: n[10],
            work_j: n[11],
            work_rate_w: n[12],
        }
    }
}
