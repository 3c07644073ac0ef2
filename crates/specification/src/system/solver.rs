//! `[solver]`: the integrator and where it starts.

use gearmesh_dynamics::scheme::{AdaptiveStep, Params, StepControl};
use gearmesh_geometry::InputError;
use gearmesh_geometry::given;
use gearmesh_geometry::input::{Bounded, Count, End, InputDocument, Positive, TableKeys, Within};
use gearmesh_geometry::number_range;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::run::Run;

/// `[solver]` as written in the file. Used by runs that step through time.
#[derive(Debug, Clone, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SolverTable {
    /// What is left of the highest frequencies after a step, 0 to 1, with joints below 1; 0.8 where not given.
    pub rho_infinity: Option<Bounded<Within<0, 1>>>,
    /// Fixed step.
    pub step_s: Option<Bounded<Positive>>,
    /// Adaptive step, instead of `step_s`.
    pub adaptive: Option<AdaptiveTable>,
    /// End of Newton's iteration: share of the step's own increment. Where not given, a tenth of the step's own error.
    pub newton_tolerance: Option<Bounded<NewtonTolerance>>,
    /// Newton iterations after which a step is given up; 20 where not given.
    pub most_iterations: Option<Count<2, 1000>>,
    /// Where the motion begins; "as-given" where not given.
    pub start: Option<Start>,
}

number_range!(
    /// Shares of a step's increment that Newton's iteration can tell from rounding and from the step's own error.
    pub NewtonTolerance: End::At(1e-14), End::At(1e-3)
);

/// `[solver.adaptive]`.
#[derive(Debug, Clone, Copy, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AdaptiveTable {
    /// Longest step.
    pub largest_step_s: Bounded<Positive>,
    /// First step; a thousandth of the longest where not given.
    pub first_step_s: Option<Bounded<Positive>>,
    /// Shortest step, below which the run ends with advice; a millionth of the longest where not given.
    pub least_step_s: Option<Bounded<Positive>>,
    /// Allowed error of a place in one step.
    pub translation_tolerance_um: Bounded<Positive>,
    /// Allowed error of a rotation in one step.
    pub rotation_tolerance_urad: Bounded<Positive>,
}

/// Where a motion begins.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Start {
    /// Places and speeds as the bodies state them, moved onto the joints.
    #[default]
    AsGiven,
    /// Places in static equilibrium under the loads at t = 0, speeds as the bodies state them.
    Equilibrium,
}

/// The integrator and the start, checked.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Solver {
    /// Parameters of the integrator; none for runs that do not step through time.
    pub params: Option<Params>,
    /// Where the motion begins.
    pub start: Start,
}

impl SolverTable {
    /// Checks the table for a run.
    ///
    /// # Errors
    /// [`InputError`] naming the key.
    pub fn check(&self, document: &InputDocument, run: &Run) -> Result<Solver, InputError> {
        let keys = TableKeys::new(document, "solver");
        if run.simulated_s().is_none() {
            let kind = run.kind().name();
            let stated = given!(self; rho_infinity, step_s, adaptive, newton_tolerance, most_iterations, start);
            let problem = format!(
                "is not used by run.kind = \"{kind}\", which does not step through time; remove it"
            );
            keys.refuse(&stated, problem)?;
            return Ok(Solver {
                params: None,
                start: Start::AsGiven,
            });
        }
        let mut params = match (self.step_s, self.adaptive) {
            (Some(step_s), None) => Params::fixed(*step_s),
            (None, Some(adaptive)) => {
                adaptive.check(&TableKeys::new(document, "solver.adaptive"))?
            }
            (Some(_), Some(_)) => {
                let problem = "is given together with solver.adaptive; remove one of the two";
                return Err(keys.error("step_s", problem));
            }
            (None, None) => {
                let problem = "missing; give a fixed step, or a table [solver.adaptive]";
                return Err(keys.error("step_s", problem));
            }
        };
        if let Some(rho) = self.rho_infinity {
            params.rho_infinity = *rho;
        }
        params.newton_tolerance = self.newton_tolerance.map(f64::from);
        if let Some(most) = self.most_iterations {
            params.most_iterations = most.get();
        }
        let longest = params.step.longest_s();
        if let Some(simulated) = run.simulated_s()
            && longest > simulated
        {
            let key = match self.step_s {
                Some(_) => "step_s",
                None => "adaptive.largest_step_s",
            };
            let problem = format!("found {longest}, longer than the run of {simulated} s");
            return Err(keys.error(key, problem));
        }
        Ok(Solver {
            params: Some(params),
            start: self.start.unwrap_or_default(),
        })
    }
}

impl AdaptiveTable {
    fn check(&self, keys: &TableKeys<'_>) -> Result<Params, InputError> {
        let largest = *self.largest_step_s;
        let mut params = Params::adaptive(
            largest,
            1e-6 * *self.translation_tolerance_um,
            1e-6 * *self.rotation_tolerance_urad,
        );
        if let StepControl::Adaptive(limits) = &mut params.step {
            let AdaptiveStep {
                first_step_s,
                least_step_s,
                ..
            } = limits;
            if let Some(first) = self.first_step_s.map(f64::from) {
                let ok = first <= largest;
                keys.require("first_step_s", first, ok, "at most largest_step_s")?;
                *first_step_s = first;
                *least_step_s = least_step_s.min(first);
            }
            if let Some(least) = self.least_step_s.map(f64::from) {
                let ok = least <= *first_step_s;
                keys.require("least_step_s", least, ok, "at most the first step")?;
                *least_step_s = least;
            }
        }
        Ok(params)
    }
}
