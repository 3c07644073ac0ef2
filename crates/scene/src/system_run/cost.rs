//! What a run in time will cost on this machine, found by making some of its steps.
//!
//! ```text
//! wall = T Σ_k [(1 − w) a_k + w b_k]/n        a_k, b_k: wall time per simulated second without rows and with them
//! ```
//!
//! w is the share of the time T in which rows are recorded: all of it but in a stepped sweep. Steps do not cost the
//! same everywhere: teeth that only just touch are cheap, loaded ones are not, at high speed more corrections are
//! needed, and an adaptive step changes its length. So each of n trials begins as the run does, from equilibrium where
//! the scene says so, and takes its rows; a sweep is tried at several of its speeds. Not in it: what a motion comes to
//! later than the trials last, reading the models, writing the file.

use std::ops::ControlFlow;
use std::time::{Duration, Instant};

use gearmesh_dynamics::{Motion, OutputGrid, Params, Simulation, System, TimeFunction};
use gearmesh_geometry::InputError;
use gearmesh_specification::system::run::Run;
use gearmesh_specification::system::solver::Start;

use super::error::SystemRunError;
use super::from_scene::varied;
use super::in_time::begin;
use super::job::{InTime, RunJob, RunKind};
use super::recorded_columns::ResultSize;
use super::recorder::{Course, Moment, Recorder, Selection, time};
use crate::system::{LoadedSystem, SystemPlan, SystemScene, step_in_words};

/// Wall time of all trials together, equilibria not counted: enough for some thousand steps of a pair.
const TRIALS: Duration = Duration::from_millis(1000);

/// Speeds of a sweep, or operating points, that are tried at most.
const MOST_TRIALS: usize = 5;

/// Steps before the clock starts: caches, the first factorisation, and whatever the start shakes.
const FIRST_STEPS: usize = 20;

/// Steps, time and what they cost.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RunCost {
    /// Time that is simulated \[s\].
    pub simulated_s: f64,
    /// Steps; with adaptive ones as many as the trials needed.
    pub steps: f64,
    /// Wall time \[s\].
    pub wall_s: f64,
    /// Trials.
    pub trials: usize,
}

/// A run from its start, or at one of its speeds.
struct Trial<'a> {
    params: &'a Params,
    start: Start,
    /// Samples every so often \[s\]; none where nothing is recorded.
    interval_s: Option<f64>,
    /// Share of the time in which rows are recorded.
    recorded: f64,
    end_s: f64,
    budget: Duration,
}

/// Steps and wall time per simulated second.
#[derive(Clone, Copy)]
struct Pace {
    steps_per_s: f64,
    wall_per_s: f64,
}

impl RunCost {
    /// Makes some steps of a scene's run and times them; none where it does not step through time.
    ///
    /// # Errors
    /// [`InputError`] when the steps fail: the run would, too.
    pub fn timed(loaded: &LoadedSystem) -> Result<Option<Self>, InputError> {
        Self::of(loaded).map_err(|error| match error {
            SystemRunError::Input(error) => error,
            SystemRunError::Dynamics(error) => loaded.scene.complaint(&error),
            other => loaded.scene.document.error("run", other),
        })
    }

    fn of(loaded: &LoadedSystem) -> Result<Option<Self>, SystemRunError> {
        let Some(simulated_s) = loaded.scene.run.simulated_s() else {
            return Ok(None);
        };
        let job = RunJob::from_scene(loaded.clone())?;
        let selection = &job.selection;
        let mut paces = Vec::new();
        match job.kind {
            RunKind::Static(_) => return Ok(None),
            RunKind::Transient(run) => {
                paces.push(Trial::of(&run, 1.0, TRIALS).make(job.system, selection)?);
            }
            RunKind::SpeedSweep(run) => {
                let measured: f64 = run.windows.iter().map(|w| w.to_s - w.from_s).sum();
                // The way back costs what the way there costs.
                let there = run.windows.iter().filter(|w| w.up == run.windows[0].up);
                let speeds: Vec<f64> = there.map(|w| w.speed_rad_per_s).collect();
                let Run::SpeedSweep(sweep) = &loaded.scene.run else {
                    return Ok(None);
                };
                for speed in spread(&speeds) {
                    let function = Motion::Speed(TimeFunction::Constant(speed));
                    let built = loaded.build_varied(&varied(&sweep.motion, function, 1.0))?;
                    let budget = TRIALS / MOST_TRIALS as u32;
                    let trial = Trial::of(&run, measured / run.end_s, budget);
                    paces.push(trial.make(built.system, selection)?);
                }
            }
            RunKind::Eigen(eigen) => {
                let Some(settling) = eigen.settle else {
                    return Ok(None);
                };
                for point in spread(&eigen.points) {
                    let trial = Trial {
                        params: &settling.params,
                        start: settling.start,
                        interval_s: None,
                        recorded: 0.0,
                        end_s: settling.time_s,
                        budget: TRIALS / MOST_TRIALS as u32,
                    };
                    paces.push(trial.make((eigen.system_at)(point)?, selection)?);
                }
            }
        }
        let trials = paces.len();
        let mean = |of: fn(&Pace) -> f64| paces.iter().map(of).sum::<f64>() / trials as f64;
        Ok(Some(Self {
            simulated_s,
            steps: simulated_s * mean(|pace| pace.steps_per_s),
            wall_s: simulated_s * mean(|pace| pace.wall_per_s),
            trials,
        }))
    }
}

/// At most [`MOST_TRIALS`] of some values, those in the middle of equal parts: their mean is that of all by the
/// midpoint rule.
fn spread<T: Copy>(values: &[T]) -> Vec<T> {
    let count = values.len().min(MOST_TRIALS);
    (0..count)
        .map(|i| values[(2 * i + 1) * values.len() / (2 * count)])
        .collect()
}

impl<'a> Trial<'a> {
    /// Of a run in time that records rows in a share of it.
    fn of(run: &'a InTime, recorded: f64, budget: Duration) -> Self {
        Self {
            params: &run.params,
            start: run.start,
            interval_s: Some(run.interval_s / run.samples_per_row() as f64),
            recorded,
            end_s: run.end_s,
            budget,
        }
    }

    fn make(&self, system: System, selection: &Selection) -> Result<Pace, SystemRunError> {
        let mut simulation = begin(system, (self.params, self.start), &mut Vec::new())?;
        let mut first = 0;
        simulation.run(0.1 * self.end_s, |_| {
            first += 1;
            if first < FIRST_STEPS {
                ControlFlow::Continue(())
            } else {
                ControlFlow::Break(())
            }
        })?;
        let mut pace = Pace {
            steps_per_s: 0.0,
            wall_per_s: 0.0,
        };
        let parts = [
            (1.0 - self.recorded, None),
            (self.recorded, self.interval_s),
        ];
        for (share, interval_s) in parts.into_iter().filter(|(share, _)| *share > 0.0) {
            let found = self.go_on(&mut simulation, selection, interval_s)?;
            pace.steps_per_s += share * found.steps_per_s;
            pace.wall_per_s += share * found.wall_per_s;
        }
        Ok(pace)
    }

    /// Goes on for half the budget where there is another part, for all of it otherwise, or as long as the run lasts.
    fn go_on(
        &self,
        simulation: &mut Simulation,
        selection: &Selection,
        interval_s: Option<f64>,
    ) -> Result<Pace, SystemRunError> {
        let is_alone = self.recorded <= 0.0 || self.recorded >= 1.0;
        let budget = if is_alone {
            self.budget
        } else {
            self.budget / 2
        };
        let state = simulation.state();
        let (begun_s, system) = (state.time_s, simulation.system());
        let mut rows = interval_s.map(|interval_s| {
            let next = (begun_s / interval_s).floor() as u64 + 1;
            (
                OutputGrid::new(interval_s, state).from_index(next),
                Recorder::new(system, state, selection, vec![time()], Course::InTime),
            )
        });
        let mut before = simulation.info().energy;
        let mut steps = 0_u32;
        let clock = Instant::now();
        // One step at least, however short the run is.
        simulation.run(f64::INFINITY, |step| {
            let (from_s, to_s) = (step.from.time_s, step.to.time_s);
            let (info, to) = (step.info, step.to);
            let lambda = [step.lambda_from, step.lambda];
            let acceleration = [step.acceleration_from, step.acceleration];
            if let Some((grid, recorder)) = &mut rows {
                grid.visit(step, |state, system| {
                    recorder.row(
                        system,
                        &Moment {
                            abscissas: &[state.time_s],
                            state,
                            lambda,
                            acceleration,
                            share: (state.time_s - from_s) / (to_s - from_s),
                            energy: [&before, &info.energy],
                            step_s: to_s - from_s,
                            largest_violation: info.largest_violation,
                        },
                    );
                });
                recorder.commit(step.system, to);
                before = info.energy;
            }
            steps += 1;
            if clock.elapsed() < budget && to_s < self.end_s {
                ControlFlow::Continue(())
            } else {
                ControlFlow::Break(())
            }
        })?;
        let simulated_s = simulation.state().time_s - begun_s;
        Ok(Pace {
            steps_per_s: f64::from(steps) / simulated_s,
            wall_per_s: clock.elapsed().as_secs_f64() / simulated_s,
        })
    }
}

impl SystemPlan {
    /// Adds the size of the result, where it has rows.
    #[must_use]
    pub fn with_result(mut self, size: Option<ResultSize>) -> Self {
        if let Some(size) = size {
            self.lines.push(format!("result     {size}"));
        }
        self
    }

    /// Adds what the run will cost.
    #[must_use]
    pub fn with_cost(mut self, scene: &SystemScene, cost: Option<RunCost>) -> Self {
        let (Some(params), Some(cost)) = (scene.solver.params, cost) else {
            return self;
        };
        let (step_s, word) = step_in_words(params.step);
        let step_cost_s = cost.wall_s / cost.steps;
        self.lines.push(format!(
            "cost       {} s in steps of {step_s} s ({word}): {:.0} steps of {:.1} us, about {} s; from {}",
            (1e6 * cost.simulated_s).round() / 1e6,
            cost.steps,
            1e6 * step_cost_s,
            rounded(cost.wall_s),
            match cost.trials {
                1 => "a trial from the start".to_string(),
                trials => format!("{trials} trials over the range"),
            }
        ));
        (self.steps, self.step_cost_s) = (Some(cost.steps), Some(step_cost_s));
        self
    }
}

/// Two digits that count.
fn rounded(seconds: f64) -> String {
    if seconds >= 10.0 {
        format!("{seconds:.0}")
    } else {
        format!("{seconds:.2}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn trials_stand_in_the_middle_of_equal_parts() {
        let values: Vec<usize> = (0..37).collect();
        assert_eq!(spread(&values), [3, 11, 18, 25, 33]);
        assert_eq!(spread(&values[..3]), [0, 1, 2]);
        assert_eq!(spread(&values[..0]), [0_usize; 0]);
    }
}
