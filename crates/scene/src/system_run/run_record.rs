//! What a run in time has needed and how exact it was, as scalars of the result.

use gearmesh_dynamics::RunInfo;
use gearmesh_model::{Fields, FileError, Record};

/// Effort and accuracy of a run in time.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct RunRecord {
    /// Time that was simulated, to the end of the run \[s\].
    pub simulated_s: f64,
    /// Wall time, that of all legs of a resumed run \[s\].
    pub wall_s: f64,
    /// Accepted steps.
    pub steps: f64,
    /// Steps repeated because the estimated error was too large.
    pub rejected: f64,
    /// Steps repeated because Newton's iteration did not converge.
    pub unconverged: f64,
    /// Newton iterations.
    pub iterations: f64,
    /// Factorisations of the iteration matrix.
    pub factorisations: f64,
    /// Evaluations of the equations.
    pub evaluations: f64,
    /// Shortest accepted step \[s\].
    pub least_step_s: f64,
    /// Longest accepted step \[s\].
    pub largest_step_s: f64,
    /// Largest violation of a joint equation (m or rad).
    pub largest_violation: f64,
    /// Largest violation of the rate of a joint equation (m/s or rad/s).
    pub largest_violation_rate: f64,
    /// Kinetic and potential energy at the start \[J\].
    pub first_energy_j: f64,
    /// Kinetic and potential energy at the end \[J\].
    pub last_energy_j: f64,
    /// Heat \[J\].
    pub dissipated_j: f64,
    /// Work of loads and prescribed motions \[J\].
    pub supplied_j: f64,
    /// Largest error of the energy balance \[J\].
    pub largest_energy_error_j: f64,
    /// Work done, whatever its sign: of loads and prescribed motions, heat, and of all forces on each degree of freedom
    /// \[J\]. Not a number in results of versions that did not keep it.
    pub work_j: f64,
}

/// Share of the work done that the energy balance may be off by. Figures of a run are asked for to some per cent, and
/// no force or stress can be trusted further than the energy that drives it. What a run is known to lose is far below:
/// teeth that leave the rigid path take a deflection over two base pitches, below 0.5 % at the largest deflection that
/// goes without a warning.
pub const MOST_ENERGY_ERROR: f64 = 0.01;

/// Share of the energy that a system has to begin or to end with that counts as work where less is done: below it is
/// rounding.
const RESTING: f64 = 1e-6;

/// Name in the file, unit, description, place in the record.
type Field = (
    &'static str,
    &'static str,
    &'static str,
    fn(&mut RunRecord) -> &mut f64,
);

macro_rules! fields {
    ($($name:literal $unit:literal $what:literal $of:ident;)*) => {
        [$(($name, $unit, $what, |r| &mut r.$of)),*]
    };
}

const FIELDS: [Field; 18] = fields! {
    "simulated_s" "s" "time that was simulated, to the end of the run" simulated_s;
    "wall_s" "s" "wall time of the run" wall_s;
    "steps" "1" "accepted steps" steps;
    "rejected" "1" "steps repeated for their estimated error" rejected;
    "unconverged" "1" "steps repeated because Newton's iteration did not converge" unconverged;
    "iterations" "1" "Newton iterations" iterations;
    "factorisations" "1" "factorisations of the iteration matrix" factorisations;
    "evaluations" "1" "evaluations of the equations" evaluations;
    "least_step_s" "s" "shortest accepted step" least_step_s;
    "largest_step_s" "s" "longest accepted step" largest_step_s;
    "largest_violation" "m or rad" "largest violation of a joint equation" largest_violation;
    "largest_violation_rate" "m/s or rad/s" "largest violation of the rate of a joint equation" largest_violation_rate;
    "first_energy_J" "J" "kinetic and potential energy at the start" first_energy_j;
    "last_energy_J" "J" "kinetic and potential energy at the end" last_energy_j;
    "dissipated_J" "J" "heat" dissipated_j;
    "supplied_J" "J" "work of loads and prescribed motions" supplied_j;
    "largest_energy_error_J" "J" "largest error of the energy balance" largest_energy_error_j;
    "work_J" "J" "work done, whatever its sign: of loads and prescribed motions, heat, and of all forces on each degree of freedom" work_j;
};

const WORK: &str = "work_J";

impl RunRecord {
    /// The record of a simulation.
    pub fn new(info: &RunInfo, simulated_s: f64, wall_s: f64) -> Self {
        Self {
            simulated_s,
            wall_s,
            steps: info.steps as f64,
            rejected: info.rejected as f64,
            unconverged: info.unconverged as f64,
            iterations: info.iterations as f64,
            factorisations: info.factorisations as f64,
            evaluations: info.evaluations as f64,
            least_step_s: info.step_range_s.0,
            largest_step_s: info.step_range_s.1,
            largest_violation: info.largest_violation,
            largest_violation_rate: info.largest_violation_rate,
            first_energy_j: info.energy.first.total_j(),
            last_energy_j: info.energy.last.total_j(),
            dissipated_j: info.energy.dissipated_j,
            supplied_j: info.energy.supplied_j,
            largest_energy_error_j: info.energy.largest_error_j,
            work_j: info.energy.work_j,
        }
    }

    /// Simulated over wall time: above 1 the simulation runs ahead of the clock.
    pub fn real_time_factor(&self) -> f64 {
        self.simulated_s / self.wall_s
    }

    /// Largest error of the energy balance over the work done.
    pub fn relative_energy_error(&self) -> f64 {
        let energy = self.first_energy_j.abs().max(self.last_energy_j.abs());
        let work = self.work_j.max(RESTING * energy);
        if self.largest_energy_error_j > 0.0 {
            self.largest_energy_error_j / work
        } else {
            0.0
        }
    }

    /// What is wrong with the energy of the run: its balance is off by more than `MOST_ENERGY_ERROR` of the work done.
    pub fn energy_problem(&self) -> Option<String> {
        let relative = self.relative_energy_error();
        // Work that was not kept is not judged; an error that is no number is one.
        if relative <= MOST_ENERGY_ERROR || self.work_j.is_nan() {
            return None;
        }
        Some(format!(
            "the energy of this run does not balance: up to {:.3e} J came from nowhere or were lost, {:.1} % of the {:.3e} J of work done, and \
             allowed is {} %; the column energy/error_J says when. Teeth pass through each other, a force jumps, or steps are too long for what \
             happens in them: look there, and take shorter steps",
            self.largest_energy_error_j,
            100.0 * relative,
            self.work_j,
            100.0 * MOST_ENERGY_ERROR
        ))
    }

    /// Names in the file and values.
    pub fn entries(mut self) -> impl Iterator<Item = (&'static str, &'static str, f64)> {
        FIELDS
            .into_iter()
            .map(move |(name, unit, _, field)| (name, unit, *field(&mut self)))
    }
}

impl Record for RunRecord {
    fn fields(&mut self, f: &mut Fields<'_>) -> Result<(), FileError> {
        for (name, unit, text, field) in FIELDS {
            // Older programs did not keep it.
            if name == WORK && !f.has(name) {
                self.work_j = f64::NAN;
                continue;
            }
            f.number(name, field(self), unit, text)?;
        }
        Ok(())
    }
}
