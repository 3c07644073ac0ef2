//! Ratings of a run: one pass over its rows, or over what a sweep has measured. Equations: docs/theory/rating.md.

use std::f64::consts::TAU;

use gearmesh_bearings::LoadHistory;
use gearmesh_model::{Column, FileError, RowLog};
use gearmesh_rating::TurningPoints;

use crate::rating::{PassageLength, RatingResult, nominal_figures, nominal_remark};
use crate::system::{RatingJob, RatingRule};

/// Rows read at once.
const BLOCK_ROWS: usize = 4096;

/// Share of a turn by which the ends of a history, on rows, may miss a whole one.
const TURN_ROUNDING: f64 = 1e-3;

/// Microstrain in strain.
const MICRO: f64 = 1e-6;

/// What is taken from the rows for one rating.
struct Collected<'a> {
    job: &'a RatingJob,
    /// Places of its columns.
    places: Vec<usize>,
    /// Place of the turns of the gauge's gear; none where they are not written, or nothing passes.
    turn_place: Option<usize>,
    /// Times of the first and last row.
    span_s: Option<[f64; 2]>,
    /// Turns of the gear there \[rad\].
    span_rad: Option<[f64; 2]>,
    points: TurningPoints,
    largest: f64,
    history: Option<LoadHistory>,
    problem: Option<String>,
}

impl<'a> Collected<'a> {
    fn new(job: &'a RatingJob, columns: &[Column]) -> Self {
        let place = |name: &String| columns.iter().position(|c| c.name == *name);
        let places: Vec<usize> = job.columns.iter().filter_map(place).collect();
        let complete = places.len() == job.columns.len();
        let missing = || format!("the result lacks one of {}", job.columns.join(", "));
        Self {
            job,
            places,
            turn_place: job.turn_column.as_ref().and_then(place),
            span_s: None,
            span_rad: None,
            points: TurningPoints::default(),
            largest: f64::NEG_INFINITY,
            history: match &job.rule {
                RatingRule::BearingLife(life) => Some(LoadHistory::new(&life.bearing)),
                _ => None,
            },
            problem: (!complete).then(missing),
        }
    }

    fn take(&mut self, time_s: f64, row: &[f64]) {
        if time_s < self.job.from_s || self.problem.is_some() {
            return;
        }
        let [from, _] = self.span_s.unwrap_or([time_s; 2]);
        self.span_s = Some([from, time_s]);
        if let Some(place) = self.turn_place {
            let [from, _] = self.span_rad.unwrap_or([row[place]; 2]);
            self.span_rad = Some([from, row[place]]);
        }
        let values = self.places.iter().map(|&place| row[place]);
        match &self.job.rule {
            RatingRule::BearingLife(life) => {
                if let Some(history) = &mut self.history {
                    // Rows are as far apart as the rows before.
                    history.add(&life.sample(1.0, &values.collect::<Vec<f64>>()));
                }
            }
            RatingRule::Nominal(_) => self.largest = values.fold(self.largest, largest),
            RatingRule::Fatigue(fatigue) => {
                let stress = fatigue.modulus_pa * MICRO * values.sum::<f64>();
                if let Err(error) = self.points.push(stress) {
                    self.problem = Some(error.to_string());
                }
            }
        }
    }

    fn result(self) -> RatingResult {
        let mut warnings = Vec::new();
        let figures = match (&self.job.rule, self.problem) {
            (_, Some(problem)) => Err(problem),
            (RatingRule::BearingLife(life), None) => match &self.history {
                Some(history) => (life.figures(history))
                    .map(|(figures, found)| {
                        warnings = found;
                        figures
                    })
                    .map_err(|e| e.to_string()),
                None => Err("there is no row".to_owned()),
            },
            (RatingRule::Nominal(job), None) => {
                warnings.extend(nominal_remark(job));
                nominal_figures(job, self.largest).map_err(|e| e.to_string())
            }
            (RatingRule::Fatigue(job), None) => {
                let [from, to] = self.span_s.unwrap_or_default();
                let length = PassageLength::Seconds(to - from);
                job.figures(self.points, length).map_err(|e| e.to_string())
            }
        };
        let missing = self.span_rad.and_then(less_than_a_turn);
        RatingResult::new(self.job.name.clone(), self.job.method.clone(), figures)
            .incomplete_by(missing)
            .warning(warnings)
    }
}

/// What a history lacks in which the gear turns less than once.
fn less_than_a_turn([from, to]: [f64; 2]) -> Option<String> {
    let turns = (to - from).abs() / TAU;
    (turns < 1.0 - TURN_ROUNDING).then(|| {
        format!("incomplete: the gauge's gear turns by {turns:.3} of a revolution in the history")
    })
}

/// The larger one; not a number if one of both is none.
fn largest(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() {
        f64::NAN
    } else {
        a.max(b)
    }
}

/// Ratings of a run whose rows are kept, the time, or the number of the equilibrium, in their first column. What a
/// rating cannot judge is its problem, not that of the run.
pub(super) fn of_rows(
    jobs: &[RatingJob],
    columns: &[Column],
    log: &mut RowLog,
) -> Result<Vec<RatingResult>, FileError> {
    if jobs.is_empty() {
        return Ok(Vec::new());
    }
    let mut all: Vec<Collected<'_>> = jobs
        .iter()
        .map(|job| Collected::new(job, columns))
        .collect();
    let (mut first, mut rows) = (0, Vec::new());
    while first < log.rows() {
        log.read(first, BLOCK_ROWS, &mut rows)?;
        for row in rows.chunks_exact(columns.len()) {
            all.iter_mut().for_each(|one| one.take(row[0], row));
        }
        first += BLOCK_ROWS as u64;
    }
    Ok(all.into_iter().map(Collected::result).collect())
}

/// Nominal ratings of a sweep: `figures` holds mean, deviation, least and largest of every column, window by window.
pub(super) fn of_windows(
    jobs: &[RatingJob],
    columns: &[Column],
    figures: &[f64],
) -> Vec<RatingResult> {
    let rated = |job: &RatingJob| {
        let mut collected = Collected::new(job, columns);
        for window in figures.chunks_exact(4 * columns.len()) {
            let most: Vec<f64> = window.iter().skip(3).step_by(4).copied().collect();
            collected.take(job.from_s, &most);
        }
        collected.result()
    };
    jobs.iter().map(rated).collect()
}
