//! The cases of a multibody study: a result file each, and its figures.

use std::f64::consts::PI;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use gearmesh_model::FileError;
use gearmesh_specification::names::unknown;
use gearmesh_specification::study::Study;

use super::cases::{Found, Selected, SelectedValue, StudyError};
use super::elsewhere::SentCase;
use super::figure::{Figure, FigureKinds, RATINGS, SETS, Wanted, line_amplitude, resonance};
use super::subject::Subject;
use crate::pair::warnings::yielding;
use crate::rating::figure_names;
use crate::system::SystemScene;
use crate::system_run::{
    Figures, LOW_PASS_BAND, Outcome, PartFolder, ResultKind, ResultSize, RunHead, RunJob, RunKind,
    RunOptions, SetFigures, SystemResult, SystemRunError, Window, inputs, recorded_columns, run,
};

/// Wall time between checkpoints of a case.
const CHECKPOINTS: Duration = Duration::from_secs(60);

/// Wall time between two looks at a case that another study has in hand.
const WAITING: Duration = Duration::from_millis(200);

/// Digits of the digest in a file's name.
const NAME_DIGITS: usize = 16;

/// What is reported of a mode.
const MODE_COLUMNS: [&str; 2] = ["frequency_Hz", "damping_ratio"];

/// The columns that a run of the scene will have, and what may be asked of them.
///
/// # Errors
/// [`StudyError`] for a scene that cannot be built.
pub(super) fn column_names(scene: &SystemScene) -> Result<(Vec<String>, FigureKinds), StudyError> {
    let job = RunJob::from_scene(scene.clone().load()?)?;
    let kinds = match &job.kind {
        RunKind::Transient(_) => FigureKinds::InTime,
        RunKind::SpeedSweep(_) => FigureKinds::OfSweep,
        RunKind::Static(_) => FigureKinds::OfSeries,
        RunKind::Eigen(_) => {
            let modes = 1..=job.system.degrees_of_freedom();
            let names = modes.flat_map(|k| MODE_COLUMNS.map(|what| mode_column(k, what)));
            return Ok((names.collect(), FigureKinds::OfSeries));
        }
    };
    let columns = recorded_columns(&job).into_iter();
    let ratings = job.ratings.iter();
    let of_ratings = ratings.flat_map(|rating| {
        let names = figure_names(&rating.rule).into_iter();
        names.map(|figure| rating_column(&rating.name, figure))
    });
    let of_sets = job.head.sets.iter();
    let of_sets = of_sets.flat_map(|set| SetFigures::NAMES.map(|name| set_column(&set.name, name)));
    let of_sets = of_sets.filter(|_| kinds != FigureKinds::OfSweep);
    let all = columns.map(|column| column.name).chain(of_ratings);
    let all = all.chain(of_sets);
    Ok((all.collect(), kinds))
}

/// Mesh periods at least over which lines at mesh orders are judged: Hann's window tells what is three of its spacings
/// apart.
const LEAST_PERIODS: f64 = 8.0;

/// A mesh whose frequency stays, and what of its spectrum the rows of a run tell.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct SteadyMesh {
    /// Name of the element.
    pub name: String,
    /// Mesh frequency \[Hz\].
    pub hz: f64,
    /// Highest frequency at which spectra of the rows are right, whatever the step \[Hz\].
    pub most_hz: f64,
}

/// The meshes of a recorded motion whose frequency stays from `from_s` on (0: from where its statistics begin), over
/// enough periods.
///
/// # Errors
/// [`StudyError`] for a scene that cannot be built.
pub(crate) fn steady_meshes(
    scene: &SystemScene,
    from_s: f64,
) -> Result<Vec<SteadyMesh>, StudyError> {
    let loaded = scene.clone().load()?;
    let meshes = loaded.build()?.meshes;
    let RunKind::Transient(run) = RunJob::from_scene(loaded)?.kind else {
        return Ok(Vec::new());
    };
    let from_s = if from_s == 0.0 {
        run.statistics_from_s
    } else {
        from_s
    };
    // Earlier than statistics begin, speeds may change.
    if from_s < run.statistics_from_s {
        return Ok(Vec::new());
    }
    let steady = meshes.into_iter().filter_map(|mesh| {
        let hz = mesh.steady_hz?;
        ((run.end_s - from_s) * hz >= LEAST_PERIODS).then(|| SteadyMesh {
            name: mesh.name,
            hz,
            most_hz: 0.5 * LOW_PASS_BAND / run.interval_s,
        })
    });
    Ok(steady.collect())
}

/// Rows and columns of the result of a multibody scene; none where it keeps none.
///
/// # Errors
/// [`StudyError`] for a scene that cannot be built.
pub(crate) fn result_size(subject: &Subject) -> Result<Option<ResultSize>, StudyError> {
    let Subject::System(scene) = subject else {
        return Ok(None);
    };
    let job = RunJob::from_scene(scene.clone().load()?)?;
    Ok(ResultSize::of(&job))
}

/// Runs a case, or waits for the other study in the same folder that is at it; none if it was stopped.
pub(super) fn run_case(
    scene: SystemScene,
    folder: &Path,
    stop: &AtomicBool,
) -> Result<Option<PathBuf>, StudyError> {
    waiting(|| run_unless_there(scene.clone(), folder, stop))
}

/// Tries again while another process has the case in hand.
fn waiting<T>(attempt: impl Fn() -> Result<T, StudyError>) -> Result<T, StudyError> {
    loop {
        match attempt() {
            Err(StudyError::Run(SystemRunError::File(FileError::InUse { .. }))) => {
                std::thread::sleep(WAITING);
            }
            outcome => return outcome,
        }
    }
}

/// Runs a case unless its result is there already; none if it was stopped.
fn run_unless_there(
    scene: SystemScene,
    folder: &Path,
    stop: &AtomicBool,
) -> Result<Option<PathBuf>, StudyError> {
    if stop.load(Ordering::Relaxed) {
        return Ok(None);
    }
    let job = RunJob::from_scene(scene.load()?)?;
    let identity = job.head.identity();
    let file = folder.join(file_name(&identity));
    if is_there(&file, &identity) {
        PartFolder::remove_left(&file)?;
        return Ok(Some(file));
    }
    Ok(run_into(job, &file, stop)?.then_some(file))
}

/// Name of a case's file.
pub(super) fn file_name(identity: &str) -> String {
    let digits: String = identity.chars().take(NAME_DIGITS).collect();
    format!("{digits}.h5")
}

/// Whether a file is the whole result of a case.
pub(super) fn is_there(file: &Path, identity: &str) -> bool {
    SystemResult::open(file).is_ok_and(|result| result.head.identity() == identity)
}

/// The study's columns of a case; none where its file is not there.
pub(super) fn stored(study: &Study, file: &Path, identity: &str) -> Option<Found> {
    let result = SystemResult::open(file).ok()?;
    (result.head.identity() == identity).then(|| found(study, &result))
}

/// What tells the result of a scene from others.
pub(super) fn head(scene: &SystemScene) -> RunHead {
    RunHead {
        scene_toml: scene.document.text.clone(),
        inputs: inputs(scene),
        ..RunHead::default()
    }
}

/// Runs a case that was sent, unless it is there or another process is at it: whether it was computed, none if it was
/// stopped. Its result says what it would have said where the case comes from.
pub(super) fn run_sent(
    scene: SystemScene,
    case: &SentCase,
    folder: &Path,
    stop: &AtomicBool,
) -> Result<Option<bool>, StudyError> {
    let file = folder.join(&case.file);
    waiting(|| {
        if is_there(&file, &case.identity) {
            return Ok(Some(false));
        }
        if stop.load(Ordering::Relaxed) {
            return Ok(None);
        }
        let mut job = RunJob::from_scene(scene.clone().load()?)?;
        job.head.scene_toml.clone_from(&case.text);
        job.head.inputs.clone_from(&case.inputs);
        Ok(run_into(job, &file, stop)?.then_some(true))
    })
}

/// False where it was stopped.
fn run_into(job: RunJob, file: &Path, stop: &AtomicBool) -> Result<bool, StudyError> {
    let options = RunOptions {
        output: file,
        restart: false,
        checkpoint_interval: CHECKPOINTS,
        stop,
        progress: &|_| (),
    };
    Ok(run(job, &options)? == Outcome::Finished)
}

/// What a study takes from a result.
pub(super) fn found(study: &Study, result: &SystemResult) -> Found {
    let wanted = Wanted::of_study(study);
    Found {
        figures: selected(&wanted, study.tables.from_s, result),
        yielding: (result.pressures().ok()).and_then(|columns| yielding(columns.into_iter())),
    }
}

/// Figures of columns of a result, from a time on \[s\], or what keeps them from being read.
pub(super) fn selected(
    wanted: &[Wanted],
    from_s: f64,
    result: &SystemResult,
) -> Result<Vec<Selected>, String> {
    if let Some(problem) = result.problem() {
        return Err(problem);
    }
    let of = |one: &Wanted| match result.kind {
        _ if one.is_of_rating() => of_rating(result, one),
        _ if one.is_of_set() => of_set(result, one),
        ResultKind::SpeedSweep => of_sweep(result, one),
        ResultKind::Eigen => of_modes(result, one),
        ResultKind::Transient | ResultKind::Static => of_rows(result, one, from_s),
    };
    wanted.iter().map(of).collect()
}

fn say(error: FileError) -> String {
    error.to_string()
}

/// What is reported of a series: all its figures, or the one that is asked for.
fn told(one: &Wanted, unit: &str, figures: Figures) -> Selected {
    let value = one.figure().and_then(|figure| figure.value(&figures));
    Selected {
        value: value.map_or(SelectedValue::Series(figures), SelectedValue::Single),
        ..single(one, unit, 0.0)
    }
}

/// One number, which is that of all torques.
fn single(one: &Wanted, unit: &str, value: f64) -> Selected {
    Selected {
        column: one.name(),
        unit: unit.to_owned(),
        torque_nm: None,
        value: SelectedValue::Single(value),
    }
}

/// Name of the column of a rating's figure.
fn rating_column(rating: &str, figure: &str) -> String {
    format!("{RATINGS}{rating}/{figure}")
}

/// Name of the column of a planetary set's figure.
fn set_column(set: &str, figure: &str) -> String {
    format!("{SETS}{set}/{figure}")
}

/// A figure of a planetary set of the run.
fn of_set(result: &SystemResult, one: &Wanted) -> Result<Selected, String> {
    for found in result.sets().map_err(say)? {
        for (name, unit, value) in found.figures() {
            if set_column(&found.set.name, name) == one.column {
                return Ok(single(one, unit, value));
            }
        }
    }
    let column = &one.column;
    Err(format!(
        "the run has no {column}: its parts are not recorded, or the set carries no load"
    ))
}

/// A figure of a rating of the run.
fn of_rating(result: &SystemResult, one: &Wanted) -> Result<Selected, String> {
    for rated in &result.ratings {
        let mut figures = rated.figures.iter();
        if let Some(f) = figures.find(|f| rating_column(&rated.name, f.name) == one.column) {
            return Ok(single(one, f.unit, f.value));
        }
        if let Some(problem) = &rated.problem
            && one.column.starts_with(&rating_column(&rated.name, ""))
        {
            return Err(format!("{} is not rated: {problem}", rated.name));
        }
    }
    let all = result.ratings.iter();
    let names: Vec<String> = all
        .flat_map(|r| r.figures.iter().map(|f| rating_column(&r.name, f.name)))
        .collect();
    Err(unknown("column", &one.column, &names))
}

/// Of a run in time or of equilibria.
fn of_rows(result: &SystemResult, one: &Wanted, from_s: f64) -> Result<Selected, String> {
    let mut columns = result.rows.columns().iter();
    let Some(column) = columns.find(|column| column.name == one.column) else {
        let names = result.rows.columns().iter().map(|c| &c.name[..]);
        return Err(unknown("column", &one.column, &names.collect::<Vec<_>>()));
    };
    let in_time = result.kind == ResultKind::Transient;
    let is_line = matches!(one.figure(), Some(Figure::Line(_)));
    // Those of the run itself, which has seen more than its rows hold.
    let place = (result.rows.columns().iter()).position(|column| column.name == one.column);
    let own = place.and_then(|place| result.statistics.get(place));
    if let (true, false, true, Some(figures)) = (in_time, is_line, from_s == 0.0, own) {
        return Ok(told(one, &column.unit, *figures));
    }
    let from_s = if in_time && from_s == 0.0 {
        result.statistics_from_s
    } else {
        from_s
    };
    let mut first = 0;
    // Equilibria have no time.
    if from_s > 0.0 {
        let times = result.rows.read("time_s").map_err(say)?;
        // Half a step of the clock's rounding belongs to the first row.
        first = times.partition_point(|time| *time < from_s * (1.0 - 1e-12));
        if first == times.len() {
            return Err(format!(
                "from_s = {from_s} is after the end of the run at {} s",
                times.last().copied().unwrap_or_default()
            ));
        }
    }
    let values = if is_line {
        result.read_for_spectrum(&one.column)
    } else {
        result.rows.read(&one.column)
    };
    let values = &values.map_err(say)?[first..];
    if let Some(Figure::Line(hz)) = one.figure() {
        let interval_s = result.interval_s().map_err(say)?;
        let band = if result.has_low_pass(&one.column) {
            result.spectrum_band()
        } else {
            1.0
        };
        let end_hz = (1e6 * 0.5 * band / interval_s).round() / 1e6;
        if values.len() < 8 || hz > end_hz {
            return Err(format!(
                "{}: the rows are {interval_s} s apart, {} of them; their spectrum is right up to {end_hz} Hz",
                one.name(),
                values.len()
            ));
        }
        if let Some(problem) = result.folded_in_words(&one.column) {
            return Err(problem);
        }
        let amplitude = line_amplitude(values, interval_s, hz);
        return Ok(single(one, &column.unit, amplitude));
    }
    Ok(told(one, &column.unit, Figures::of(values)))
}

/// Of all windows of a sweep together, each with the same weight.
fn of_sweep(result: &SystemResult, one: &Wanted) -> Result<Selected, String> {
    let Some(sweep) = &result.sweep else {
        return Err("the result has no sweep".to_owned());
    };
    let place = sweep.columns.iter().position(|c| c.name == one.column);
    let Some(place) = place else {
        let names: Vec<&str> = sweep.columns.iter().map(|c| &c.name[..]).collect();
        return Err(unknown("column", &one.column, &names));
    };
    let windows = || sweep.figures.iter().map(move |window| window[place]);
    let unit = &sweep.columns[place].unit;
    match one.figure() {
        Some(Figure::Resonance) => {
            let rpm = |window: &Window| window.speed_rad_per_s.abs() * 30.0 / PI;
            let all: Vec<(f64, f64)> = (sweep.windows.iter().zip(windows()))
                .map(|(window, f)| (rpm(window), f.peak_to_peak()))
                .collect();
            let (speeds, swings): (Vec<f64>, Vec<f64>) = all.into_iter().unzip();
            Ok(single(one, "1/min", resonance(&speeds, &swings)))
        }
        // The largest swing at one speed, not that over all speeds.
        Some(Figure::PeakToPeak) => {
            let most = windows().map(|f| f.peak_to_peak()).fold(0.0, f64::max);
            Ok(single(one, unit, most))
        }
        _ => {
            let count = sweep.figures.len() as f64;
            let mean = windows().map(|f| f.mean).sum::<f64>() / count;
            let squares = windows().map(|f| f.deviation.powi(2) + (f.mean - mean).powi(2));
            let figures = Figures {
                mean,
                deviation: (squares.sum::<f64>() / count).sqrt(),
                least: windows().map(|f| f.least).fold(f64::INFINITY, f64::min),
                largest: windows()
                    .map(|f| f.largest)
                    .fold(f64::NEG_INFINITY, f64::max),
            };
            Ok(told(one, unit, figures))
        }
    }
}

/// Name of a column of the K-th mode that vibrates, from 1.
fn mode_column(number: usize, what: &str) -> String {
    format!("mode_{number}_{what}")
}

/// Frequency or damping of a mode over all operating points.
fn of_modes(result: &SystemResult, one: &Wanted) -> Result<Selected, String> {
    let mut values = Vec::with_capacity(result.eigen.len());
    let mut unit = "Hz";
    for point in &result.eigen {
        let modes = point.modes.iter();
        let mut modes = modes.filter(|mode| mode.angular_frequency_rad_per_s > 0.0);
        let numbered = modes.by_ref().enumerate();
        let mut count = 0;
        let mut found = None;
        for (k, mode) in numbered {
            count = k + 1;
            if one.column == mode_column(count, MODE_COLUMNS[0]) {
                found = Some(mode.frequency_hz());
            } else if one.column == mode_column(count, MODE_COLUMNS[1]) {
                unit = "1";
                let total = mode.growth_per_s.hypot(mode.angular_frequency_rad_per_s);
                found = Some(-mode.growth_per_s / total);
            }
        }
        values.push(
            found.ok_or_else(|| {
                format!("there is no `{}`: {count} modes vibrate here", one.column)
            })?,
        );
    }
    Ok(told(one, unit, Figures::of(&values)))
}
