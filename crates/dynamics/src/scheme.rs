//! Coefficients of the generalized-alpha scheme and parameters of a run.
//!
//! ```text
//! Δq = h v_n + h² ((½ − β) a_n + β a_{n+1})                       q_{n+1} = q_n exp(Δq)
//! v_{n+1} = v_n + h ((1 − γ) a_n + γ a_{n+1})
//! (1 − α_m) a_{n+1} + α_m a_n = (1 − α_f) v̇_{n+1} + α_f v̇_n
//!
//! α_m = (2ρ − 1)/(ρ + 1),  α_f = ρ/(ρ + 1),  γ = ½ − Δ,  β = ¼ (1 − Δ)²,      Δ = α_m − α_f
//! ```
//!
//! Sources: J. Chung, G. M. Hulbert, J. Appl. Mech. 60 (1993) 371-375; O. Brüls, A. Cardona, M. Arnold, Mech. Mach.
//! Theory 48 (2012) 121-137.

use crate::error::DynamicsError;

/// Coefficients for one ρ∞.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Scheme {
    pub alpha_m: f64,
    pub alpha_f: f64,
    pub gamma: f64,
    pub beta: f64,
    /// Δ: a_n is v̇ at t_n + Δ h, to the second order.
    pub shift: f64,
    /// C: the error of one step is C h³ v̈ in the position. In directions that joints prescribe, where the position has
    /// none, the velocity is off by C h² v̈ instead. C = 1/6 − Δ/2 − β = −(1/12 + Δ²/4).
    pub error_constant: f64,
}

impl Scheme {
    pub(crate) fn new(rho_infinity: f64) -> Self {
        let rho = rho_infinity;
        let alpha_m = (2.0 * rho - 1.0) / (rho + 1.0);
        let alpha_f = rho / (rho + 1.0);
        let shift = alpha_m - alpha_f;
        Self {
            alpha_m,
            alpha_f,
            gamma: 0.5 - shift,
            beta: 0.25 * (1.0 - shift).powi(2),
            shift,
            error_constant: -(1.0 / 12.0 + 0.25 * shift * shift),
        }
    }

    /// D: the error of one step is D h³ v⃛ in the velocity. With a_n = v̇ + Δh v̈ + k h² v⃛ the scheme gives k = Δ(α_m
    /// − ½), and D = k + γ(½ + Δ) − 1/6 = Δ(α_m − ½) + 1/12 − Δ².
    pub(crate) fn velocity_error_constant(&self) -> f64 {
        let shift = self.shift;
        shift * (self.alpha_m - 0.5) + 1.0 / 12.0 - shift * shift
    }

    /// dv̇/da at constant a_n: the factor of the mass matrix in the iteration matrix.
    pub(crate) fn mass_factor(&self) -> f64 {
        (1.0 - self.alpha_m) / (1.0 - self.alpha_f)
    }
}

/// How the linear system of a step is solved. Results agree to rounding.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum LinearSolver {
    /// Whichever takes less time for the size and the connections of the system.
    #[default]
    Automatic,
    /// As a dense matrix.
    Dense,
    /// As a sparse matrix.
    Sparse,
}

/// How long steps are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum StepControl {
    /// All alike \[s\].
    Fixed {
        /// The step.
        step_s: f64,
    },
    /// As long as the estimated error of one step stays below the tolerances.
    Adaptive(AdaptiveStep),
}

impl StepControl {
    /// The longest step \[s\].
    #[must_use]
    pub fn longest_s(&self) -> f64 {
        match self {
            Self::Fixed { step_s } => *step_s,
            Self::Adaptive(limits) => limits.largest_step_s,
        }
    }
}

/// Limits of the adaptive step. The error of one step is estimated as |C| h² |v̇_{n+1} − v̇_n| for each degree of
/// freedom.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AdaptiveStep {
    /// First step \[s\].
    pub first_step_s: f64,
    /// Shortest step: below it the run ends with advice \[s\].
    pub least_step_s: f64,
    /// Longest step \[s\].
    pub largest_step_s: f64,
    /// Allowed error of a place in one step \[m\].
    pub translation_tolerance_m: f64,
    /// Allowed error of a rotation in one step \[rad\].
    pub rotation_tolerance_rad: f64,
    /// Allowed error of a modal coordinate in one step \[√kg·m\].
    pub modal_tolerance: f64,
}

/// Parameters of the integrator.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Params {
    /// ρ∞, what is left of the highest frequencies after a step: 1 keeps all energy (and all noise of the reactions), 0
    /// removes them at once. Default 0.8.
    pub rho_infinity: f64,
    /// Step length.
    pub step: StepControl,
    /// Newton ends when what is left is estimated below a tenth of the step's own error (docs/theory/multibody.md); or,
    /// where a share is stated, below that share of the step's own largest increment, for places, rotations and modal
    /// coordinates each, a rotation counting as a motion of places at the system's size. Default: none stated.
    pub newton_tolerance: Option<f64>,
    /// Newton iterations after which a step is given up. Default 20; three are usual.
    pub most_iterations: usize,
    /// How the linear system is solved. Default: whichever is faster.
    pub linear_solver: LinearSolver,
}

impl Params {
    /// Fixed steps, defaults otherwise.
    #[must_use]
    pub fn fixed(step_s: f64) -> Self {
        Self {
            rho_infinity: 0.8,
            step: StepControl::Fixed { step_s },
            newton_tolerance: None,
            most_iterations: 20,
            linear_solver: LinearSolver::Automatic,
        }
    }

    /// Adaptive steps, defaults otherwise: the shortest step is 1e-6 of the longest, modal tolerance that of places.
    #[must_use]
    pub fn adaptive(
        largest_step_s: f64,
        translation_tolerance_m: f64,
        rotation_tolerance_rad: f64,
    ) -> Self {
        Self {
            step: StepControl::Adaptive(AdaptiveStep {
                first_step_s: 1e-3 * largest_step_s,
                least_step_s: 1e-6 * largest_step_s,
                largest_step_s,
                translation_tolerance_m,
                rotation_tolerance_rad,
                modal_tolerance: translation_tolerance_m,
            }),
            ..Self::fixed(largest_step_s)
        }
    }

    pub(crate) fn first_step_s(&self) -> f64 {
        match self.step {
            StepControl::Fixed { step_s } => step_s,
            StepControl::Adaptive(limits) => limits.first_step_s,
        }
    }

    pub(crate) fn validate(&self) -> Result<(), DynamicsError> {
        let require = |what, found: f64, is_allowed, allowed| {
            if is_allowed {
                return Ok(());
            }
            Err(DynamicsError::Parameter {
                what,
                found,
                allowed,
            })
        };
        let positive = |what, found: f64| {
            let is_allowed = found > 0.0 && found.is_finite();
            require(what, found, is_allowed, "positive and finite")
        };
        let rho = self.rho_infinity;
        require("rho_infinity", rho, (0.0..=1.0).contains(&rho), "0 to 1")?;
        if let Some(found) = self.newton_tolerance {
            let is_allowed = (1e-14..=1e-3).contains(&found);
            require("newton_tolerance", found, is_allowed, "1e-14 to 1e-3")?;
        }
        positive("most_iterations", self.most_iterations as f64)?;
        match self.step {
            StepControl::Fixed { step_s } => positive("step in s", step_s),
            StepControl::Adaptive(limits) => {
                positive("least step in s", limits.least_step_s)?;
                positive(
                    "first step over least step, less 1, plus rounding",
                    limits.first_step_s / limits.least_step_s - 1.0 + 1e-12,
                )?;
                positive(
                    "largest step over first step, less 1, plus rounding",
                    limits.largest_step_s / limits.first_step_s - 1.0 + 1e-12,
                )?;
                positive("translation tolerance in m", limits.translation_tolerance_m)?;
                positive("rotation tolerance in rad", limits.rotation_tolerance_rad)?;
                positive("modal tolerance", limits.modal_tolerance)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coefficients_are_those_of_chung_and_hulbert() {
        let s = Scheme::new(0.8);
        let [m, f] = [0.6 / 1.8, 0.8 / 1.8];
        assert!((s.alpha_m - m).abs() < 1e-15 && (s.alpha_f - f).abs() < 1e-15);
        assert!((s.gamma - (0.5 + f - m)).abs() < 1e-15);
        assert!((s.beta - 0.25 * (s.gamma + 0.5).powi(2)).abs() < 1e-15);
        assert!((s.error_constant - (1.0 / 6.0 - s.shift / 2.0 - s.beta)).abs() < 1e-15);
    }
}
