//! Which choices are tried: a particle swarm, then a simplex from its best, for each weighting of the objectives.
//!
//! Several objectives f_k are weighed as max_k w_k (f_k − least_k)/(largest_k − least_k) plus a hundredth of the mean,
//! least and largest from the searches for each alone (augmented Chebyshev scalarisation: Steuer and Choo, Mathematical
//! Programming 26 (1983) 326-344), which reaches hollow parts of the front, too. Every trial of every search counts for
//! the front.

use argmin::core::{CostFunction, Error, Executor, State};
use argmin::solver::neldermead::NelderMead;
use argmin::solver::particleswarm::ParticleSwarm;
use gearmesh_geometry::InputError;
use gearmesh_specification::optimise::{Optimisation, VariableTable};
use rand_xoshiro::Xoshiro256PlusPlus;
use rand_xoshiro::rand_core::SeedableRng;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

use super::evaluator::{Evaluator, Trial};
use super::pareto::front;
use crate::pair::warnings::{ColumnPressure, yielding};
use crate::study::{Scratch, StudyError};

/// What a choice costs that cannot be computed: more than any other, and a number that a simplex can average.
const FAILED: f64 = 1e30;

/// Share of the trials that the swarm has; the simplex has the others.
const SWARM: f64 = 0.6;

/// Edge of the first simplex, as a share of the bounds.
const EDGE: f64 = 0.08;

/// What was found.
#[derive(Debug, Clone, PartialEq)]
pub struct Optimum {
    /// Objectives of the scene as it is, under the same scatter; none where it cannot be computed.
    pub before: Option<Vec<f64>>,
    /// Trials that no other one beats, by the first objective; of one objective the best.
    pub front: Vec<Trial>,
    /// All trials.
    pub tried: Vec<Trial>,
    /// Of the front and the scene as it is, the column with the largest pressure, where steel yields under it.
    pub yielding: Option<ColumnPressure>,
    /// Stopped on demand: the front of what was tried until then.
    pub stopped: bool,
}

/// A search as argmin sees it: shares of the bounds in, a cost out.
struct Search<'a> {
    problem: &'a Optimisation,
    evaluator: &'a Evaluator<'a>,
    weighing: &'a Weighing,
    stop: &'a AtomicBool,
}

/// How objectives become one cost.
enum Weighing {
    /// One of them alone.
    Alone(usize),
    /// Of each weight, least value and scale.
    Between(Vec<(f64, f64, f64)>),
}

impl Weighing {
    fn cost(&self, objectives: &[f64]) -> f64 {
        match self {
            Self::Alone(number) => objectives[*number],
            Self::Between(weights) => {
                let shares = objectives.iter().zip(weights);
                let shares = shares.map(|(f, (weight, least, scale))| weight * (f - least) / scale);
                let (mut largest, mut sum) = (f64::NEG_INFINITY, 0.0);
                for share in shares {
                    largest = largest.max(share);
                    sum += share;
                }
                largest + 0.01 * sum / objectives.len() as f64
            }
        }
    }
}

impl CostFunction for Search<'_> {
    type Param = Vec<f64>;
    type Output = f64;

    fn cost(&self, shares: &Vec<f64>) -> Result<f64, Error> {
        if self.stop.load(Ordering::Relaxed) {
            // argmin has no other way out.
            return Err(Error::msg(STOPPED));
        }
        let values = values_at(self.problem, shares);
        // A simplex may leave the bounds: the nearest choice inside, and the way to it on top.
        let outside: f64 = shares.iter().map(|x| (x - x.clamp(0.0, 1.0)).abs()).sum();
        let found = self.evaluator.objectives_of(&values);
        let cost = found.map_or(FAILED, |objectives| self.weighing.cost(&objectives));
        Ok(cost + outside * (1.0 + cost.abs()))
    }
}

const STOPPED: &str = "stopped on demand";

/// Values of the variables at these shares of their bounds, to six digits of the bounds' distance.
fn values_at(problem: &Optimisation, shares: &[f64]) -> Vec<f64> {
    let variables = problem.tables.variable.iter();
    let value = |(variable, share): (&VariableTable, &f64)| {
        let share = (share.clamp(0.0, 1.0) * 1e6).round() / 1e6;
        variable.from * (1.0 - share) + variable.to * share
    };
    variables.zip(shares).map(value).collect()
}

/// Searches for the least objectives. Runs of multibody scenes write in the folder `scratch`. `progress` gets how many
/// of how many searches are done.
///
/// # Errors
/// [`StudyError`] for a file whose keys, columns or torques the scene does not have, and where no choice can be
/// computed.
pub fn optimise(
    problem: &Optimisation,
    scratch: &Path,
    stop: &AtomicBool,
    progress: &(dyn Fn(usize, usize) + Sync),
) -> Result<Optimum, StudyError> {
    let evaluator = Evaluator::new(problem, Scratch::new(scratch, stop))?;
    let count = evaluator.objectives();
    let all = problem.searches();
    let before = evaluator.as_it_is();
    let mut stopped = false;
    let mut ends: Vec<Trial> = Vec::new();
    for number in 0..all {
        let weighing = weighing(number, count, &ends, all);
        let search = || Search {
            problem,
            evaluator: &evaluator,
            weighing: &weighing,
            stop,
        };
        let seed = problem.tables.seed.wrapping_add(number as u64);
        if run_search(problem, &search, seed).is_err() {
            stopped = true;
            break;
        }
        if number < count {
            let tried = evaluator.tried();
            let best = tried
                .iter()
                .min_by(|a, b| a.objectives[number].total_cmp(&b.objectives[number]));
            let Some(best) = best else {
                return Err(nothing_sound(problem, &evaluator).into());
            };
            ends.push(best.clone());
        }
        progress(number + 1, all);
    }
    let tried = evaluator.tried();
    let front = front(&tried);
    Ok(Optimum {
        before: before.as_ref().map(|trial| trial.objectives.clone()),
        yielding: yielding(
            (front.iter().chain(&before)).filter_map(|trial| trial.yielding.clone()),
        ),
        front,
        tried,
        stopped,
    })
}

fn nothing_sound(problem: &Optimisation, evaluator: &Evaluator<'_>) -> InputError {
    let told = evaluator.failure().unwrap_or_default();
    problem.document.error(
        "variable",
        format!("no choice between the bounds can be computed: {told}"),
    )
}

/// A swarm, then a simplex from where it ends. An error is a stop on demand.
fn run_search<'a>(
    problem: &Optimisation,
    search: &dyn Fn() -> Search<'a>,
    seed: u64,
) -> Result<(), Error> {
    let (trials, variables) = (problem.tables.trials, problem.tables.variable.len());
    let particles = (6 + 2 * variables).min(trials / 4);
    let swarms = ((SWARM * trials as f64) as usize / particles).max(2);
    let bounds = (vec![0.0; variables], vec![1.0; variables]);
    let swarm = ParticleSwarm::new(bounds, particles)
        .with_rng_generator(Xoshiro256PlusPlus::seed_from_u64(seed));
    // The first population is tried before the first iteration.
    let swarmed = Executor::new(search(), swarm)
        .configure(|state| state.max_iters(swarms as u64 - 1))
        .run()?;
    let Some(best) = swarmed.state().get_best_param() else {
        return Ok(());
    };
    let best = best.position.clone();
    let left = trials.saturating_sub(swarms * particles + variables + 1);
    let mut corners = vec![best.clone()];
    for variable in 0..variables {
        let mut corner = best.clone();
        // Away from the nearer bound.
        corner[variable] += if best[variable] < 0.5 { EDGE } else { -EDGE };
        corners.push(corner);
    }
    let simplex = NelderMead::new(corners).with_sd_tolerance(0.0)?;
    // An iteration tries one or two choices, seldom more.
    Executor::new(search(), simplex)
        .configure(|state| state.max_iters((left / 2) as u64))
        .run()?;
    Ok(())
}

/// What a search looks for: each objective alone first, then between their ends.
fn weighing(number: usize, count: usize, ends: &[Trial], all: usize) -> Weighing {
    if number < count {
        return Weighing::Alone(number);
    }
    let weights = between(number - count, count, all - count);
    let of = |k: usize| {
        let own = ends.iter().map(|end| end.objectives[k]);
        let least = own.clone().fold(f64::INFINITY, f64::min);
        let scale = own.fold(f64::NEG_INFINITY, f64::max) - least;
        (weights[k], least, if scale > 0.0 { scale } else { 1.0 })
    };
    Weighing::Between((0..count).map(of).collect())
}

/// Weights of a search between the objectives: of two evenly spaced, of more by Kronecker's sequence of the golden
/// ratio and its likes, spread over the simplex.
fn between(number: usize, count: usize, searches: usize) -> Vec<f64> {
    if count == 2 {
        let share = (number + 1) as f64 / (searches + 1) as f64;
        return vec![1.0 - share, share];
    }
    // Steps of the sequence: powers of the root of x^count = x + 1.
    let root = (0..60).fold(1.5_f64, |x, _| (x + 1.0).powf(1.0 / count as f64));
    let mut cuts: Vec<f64> = (1..count)
        .map(|k| ((number + 1) as f64 * root.powi(-(k as i32))).fract())
        .collect();
    cuts.sort_by(f64::total_cmp);
    cuts.push(1.0);
    let mut before = 0.0;
    cuts.iter()
        .map(|cut| {
            let weight = (cut - before).max(1e-3);
            before = *cut;
            weight
        })
        .collect()
}
