//! Ratings of a run: one pass over its rows, or over what a sweep has measured. Equations: docs/theory/rating.md.

use std::path::Path;

use gearmesh_model::{Column, DataArray, DataTree, FileError, RowLog};
use gearmesh_rating::{
    DamageError, TurningPoints, flank_pressure, lewis_stress_pa, miner_damage, rainflow,
};

use crate::system::{FatigueJob, NominalJob, RatingJob, RatingRule};

/// Rows read at once.
const BLOCK_ROWS: usize = 4096;

/// Microstrain in strain.
const MICRO: f64 = 1e-6;

/// A figure of a rating.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RatingFigure {
    /// Name with unit.
    pub name: &'static str,
    /// Unit.
    pub unit: &'static str,
    /// What it is.
    pub description: &'static str,
    /// Value; infinite lives are infinite.
    pub value: f64,
}

/// What a rating has given.
#[derive(Debug, Clone, PartialEq)]
pub struct RatingResult {
    /// What is rated.
    pub name: String,
    /// How.
    pub method: String,
    /// Why there are no figures, where there are none.
    pub problem: Option<String>,
    /// Figures.
    pub figures: Vec<RatingFigure>,
}

impl RatingResult {
    /// The value of a figure.
    #[must_use]
    pub fn figure(&self, name: &str) -> Option<f64> {
        let mut figures = self.figures.iter();
        figures.find(|f| f.name == name).map(|f| f.value)
    }
}

/// Name, unit, description.
type Kind = (&'static str, &'static str, &'static str);

const FATIGUE: [Kind; 8] = [
    ("least_stress_Pa", "Pa", "smallest stress at the gauge"),
    ("largest_stress_Pa", "Pa", "largest stress at the gauge"),
    ("cycles", "1", "cycles counted, halves as one half"),
    (
        "most_damaging_amplitude_Pa",
        "Pa",
        "stress amplitude of the cycle that does most of the damage, 0 without damage",
    ),
    (
        "most_damaging_mean_Pa",
        "Pa",
        "mean stress of the cycle that does most of the damage, 0 without damage",
    ),
    ("damage", "1", "Miner's sum of one passage of the history"),
    (
        "life_passages",
        "1",
        "passages of the history until the sum is 1",
    ),
    ("life_h", "h", "the same in hours"),
];

const NOMINAL: [Kind; 6] = [
    (
        "largest_force_N",
        "N",
        "largest normal force, which one tooth is taken to bear alone",
    ),
    ("lewis_factor_gear1", "1", "Lewis's form factor Y of gear 1"),
    ("lewis_factor_gear2", "1", "Lewis's form factor Y of gear 2"),
    (
        "lewis_stress_gear1_Pa",
        "Pa",
        "Lewis's nominal root stress of gear 1",
    ),
    (
        "lewis_stress_gear2_Pa",
        "Pa",
        "Lewis's nominal root stress of gear 2",
    ),
    (
        "hertz_pressure_Pa",
        "Pa",
        "largest flank pressure in single contact",
    ),
];

fn figures<const N: usize>(kinds: &[Kind; N], values: [f64; N]) -> Vec<RatingFigure> {
    let figure = |(&(name, unit, description), value): (&Kind, f64)| RatingFigure {
        name,
        unit,
        description,
        value,
    };
    kinds.iter().zip(values).map(figure).collect()
}

/// What is taken from the rows for one rating.
struct Collected<'a> {
    job: &'a RatingJob,
    /// Places of its columns.
    places: Vec<usize>,
    /// Times of the first and last row.
    span_s: Option<[f64; 2]>,
    points: TurningPoints,
    largest: f64,
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
            span_s: None,
            points: TurningPoints::default(),
            largest: f64::NEG_INFINITY,
            problem: (!complete).then(missing),
        }
    }

    fn take(&mut self, time_s: f64, row: &[f64]) {
        if time_s < self.job.from_s || self.problem.is_some() {
            return;
        }
        let [from, _] = self.span_s.unwrap_or([time_s; 2]);
        self.span_s = Some([from, time_s]);
        let values = self.places.iter().map(|&place| row[place]);
        match &self.job.rule {
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
        let figures = match (&self.job.rule, self.problem) {
            (_, Some(problem)) => Err(problem),
            (RatingRule::Nominal(job), None) => nominal(job, self.largest),
            (RatingRule::Fatigue(job), None) => {
                let [from, to] = self.span_s.unwrap_or_default();
                fatigue(job, self.points, to - from).map_err(|e| e.to_string())
            }
        };
        result(self.job, figures)
    }
}

fn result(job: &RatingJob, figures: Result<Vec<RatingFigure>, String>) -> RatingResult {
    let (figures, problem) = match figures {
        Ok(figures) => (figures, None),
        Err(problem) => (Vec::new(), Some(problem)),
    };
    RatingResult {
        name: job.name.clone(),
        method: job.method.clone(),
        problem,
        figures,
    }
}

/// The larger one; not a number if one of both is none.
fn largest(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() {
        f64::NAN
    } else {
        a.max(b)
    }
}

fn fatigue(
    job: &FatigueJob,
    points: TurningPoints,
    passage_s: f64,
) -> Result<Vec<RatingFigure>, DamageError> {
    let points = points.finish()?;
    let damage = miner_damage(
        &rainflow(&points, job.passage)?,
        &job.curve,
        job.mean_stress,
    )?;
    let worst = damage.most_damaging;
    Ok(figures(
        &FATIGUE,
        [
            points.iter().copied().fold(f64::INFINITY, f64::min),
            points.iter().copied().fold(f64::NEG_INFINITY, f64::max),
            damage.cycles,
            worst.map_or(0.0, |cycle| cycle.amplitude()),
            worst.map_or(0.0, |cycle| cycle.mean()),
            damage.per_passage,
            damage.passages_to_failure(),
            damage.life_h(passage_s),
        ],
    ))
}

fn nominal(job: &NominalJob, force_n: f64) -> Result<Vec<RatingFigure>, String> {
    if !force_n.is_finite() {
        return Err(format!("the largest normal force is {force_n} N"));
    }
    let pressure = flank_pressure(
        &job.pair,
        job.pressure_roll_1_rad,
        force_n / job.face_width_m,
        job.materials,
    );
    let tangential_n = force_n * job.pair.gear_1.base_radius_m / job.pair.gear_1.reference_radius_m;
    let [first, second] = job.lewis_factors;
    let lewis = |factor| lewis_stress_pa(tangential_n, job.face_width_m, job.module_m, factor);
    let pressure_pa = pressure.map_err(|e| e.to_string())?.peak_pressure_pa;
    Ok(figures(
        &NOMINAL,
        [
            force_n,
            first,
            second,
            lewis(first),
            lewis(second),
            pressure_pa,
        ],
    ))
}

/// Ratings of a run whose rows are kept, the time in their first column. What a rating cannot judge is its problem, not that of the run.
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

/// Puts ratings into a result.
pub(super) fn put(tree: &mut DataTree, ratings: &[RatingResult]) {
    for (i, rating) in ratings.iter().enumerate() {
        let name = |part: &str| format!("ratings/{i}/{part}");
        tree.put_text(name("name"), rating.name.clone());
        tree.put_text(name("method"), rating.method.clone());
        tree.put_text(name("problem"), rating.problem.clone().unwrap_or_default());
        for f in &rating.figures {
            let value = DataArray::scalar(f.value, f.unit, f.description);
            tree.put(name(f.name), value);
        }
    }
}

/// Takes them out again.
pub(super) fn take(tree: &mut DataTree, path: &Path) -> Result<Vec<RatingResult>, FileError> {
    let count = tree.children("ratings").len();
    let mut rating = |i: usize| {
        let name = |part: &str| format!("ratings/{i}/{part}");
        let problem = Some(tree.take_text(path, &name("problem"))?).filter(|p| !p.is_empty());
        let mut figures = Vec::new();
        for &(figure, unit, description) in FATIGUE.iter().chain(&NOMINAL) {
            if tree.arrays.contains_key(&name(figure)) {
                figures.push(RatingFigure {
                    name: figure,
                    unit,
                    description,
                    value: tree.take_scalar(path, &name(figure))?,
                });
            }
        }
        Ok(RatingResult {
            name: tree.take_text(path, &name("name"))?,
            method: tree.take_text(path, &name("method"))?,
            problem,
            figures,
        })
    };
    (0..count).map(&mut rating).collect()
}
