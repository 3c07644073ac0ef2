//! Runs in time: `transient`, whose rows go to the log, and `speed-sweep`, whose rows go to the statistics of a window.
//!
//! Every so often, on demand, and never in the midst of a step, the run is broken off, its state is kept beside the
//! result, and it goes on. A run that is resumed from there gives the same bits as one that was never stopped.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};

use gearmesh_dynamics::{
    Accepted, EnergyBalance, OutputGrid, Simulation, StaticParams, System, equilibrium,
};
use gearmesh_model::{DataTree, FileError, RowLog};
use gearmesh_specification::system::output::MOST_ROWS;
use gearmesh_specification::system::solver::Start;

use super::column_statistics::ColumnStatistics;
use super::error::SystemRunError;
use super::job::{Advance, InTime, Outcome, RunHead, RunOptions};
use super::low_pass::RowFilter;
use super::mesh_pace::MeshPace;
use super::part_folder::PartFolder;
use super::rating;
use super::recorder::{Course, Moment, Recorder, Selection, time};
use super::result::SweepResult;
use super::result_kind::ResultKind;
use super::result_record::Contents;
use super::run_record::RunRecord;
use super::stored_checkpoint::{Recorded, from_tree, to_tree};
use crate::system::RatingJob;

/// Wall time between two calls of the progress.
const TOLD_EVERY: Duration = Duration::from_millis(200);

/// Begins a simulation; what the static equilibrium had to hold is added to the notes.
///
/// # Errors
/// [`SystemRunError::Dynamics`].
pub(super) fn begin(
    mut system: System,
    run: (&gearmesh_dynamics::Params, Start),
    notes: &mut Vec<String>,
) -> Result<Simulation, SystemRunError> {
    let (params, start) = run;
    if start == Start::AsGiven {
        return Ok(Simulation::new(system, *params)?);
    }
    let given = system.start().clone();
    let found = equilibrium(&mut system, &given, &StaticParams::default())?;
    for motion in found.held {
        notes.push(format!(
            "static equilibrium at the start: nothing resists {motion}, held where it was"
        ));
    }
    Ok(Simulation::from_state(system, found.state, *params)?)
}

/// Rows of a run, its start included.
pub(super) fn rows(run: &InTime) -> f64 {
    rows_until(run.end_s, run.interval_s)
}

/// Rows until a time.
pub(super) fn rows_until(end_s: f64, interval_s: f64) -> f64 {
    (end_s / interval_s + 1e-9).floor() + 1.0
}

/// What is made of the accepted steps.
struct Tape<'a> {
    run: &'a InTime,
    samples: u64,
    recorder: Recorder,
    rows: RowFilter,
    grid: OutputGrid,
    pace: MeshPace,
    /// Of all samples from the begin of the statistics on.
    statistics: ColumnStatistics,
    /// Of the window that is open.
    window: ColumnStatistics,
    closed: usize,
    /// Of the windows that are closed.
    figures: Vec<f64>,
    /// Energy at the start of the step.
    before: EnergyBalance,
}

impl<'a> Tape<'a> {
    fn new(
        run: &'a InTime,
        (head, system): (&RunHead, &System),
        selection: &Selection,
    ) -> Result<Self, SystemRunError> {
        let refused = |problem| SystemRunError::Interval {
            interval_s: run.interval_s,
            end_s: run.end_s,
            problem,
        };
        let intervals = rows(run) - 1.0;
        if intervals.is_nan() || intervals < 1.0 {
            return Err(refused("there is no row but the first"));
        }
        if intervals >= MOST_ROWS {
            return Err(refused("there are too many rows"));
        }
        let per_row = run.samples_per_row();
        let start = system.start();
        let recorder = Recorder::new(system, start, selection, vec![time()], Course::InTime);
        let columns = recorder.columns().len();
        let filter = RowFilter::new(recorder.columns(), per_row);
        let rows = filter.map_err(|_| refused("no filter fits its steps"))?;
        Ok(Self {
            run,
            samples: intervals as u64 * per_row as u64 + 1,
            recorder,
            rows,
            grid: OutputGrid::new(run.interval_s, start).in_parts(per_row as u64),
            pace: MeshPace::new(system, &head.meshes),
            statistics: ColumnStatistics::new(columns),
            window: ColumnStatistics::new(columns),
            closed: 0,
            figures: Vec::new(),
            before: EnergyBalance::default(),
        })
    }

    /// Turns are counted and energy is balanced from here.
    fn start_at(&mut self, simulation: &Simulation, selection: &Selection) {
        let abscissas = vec![self.recorder.columns()[0].clone()];
        let (system, state) = (simulation.system(), simulation.state());
        self.recorder = Recorder::new(system, state, selection, abscissas, Course::InTime);
        self.before = simulation.info().energy;
    }

    /// What does not go with this run: its name, and what is wrong with it.
    fn contradiction(&self, time_s: f64, recorded: &Recorded) -> Option<(String, String)> {
        let windows = self.run.windows.len();
        let columns = self.recorder.columns().len();
        let [statistics, window] = &recorded.statistics;
        let closed = 4 * columns * recorded.closed.min(windows);
        for (item, found, needed) in [
            ("angles", &recorded.angles, self.recorder.save().len()),
            ("statistics", statistics, self.statistics.save().len()),
            ("window", window, self.window.save().len()),
            ("windows", &recorded.windows, closed),
        ] {
            let found = found.len();
            if found != needed {
                let problem = format!("it has {found} entries, {needed} are needed");
                return Some((format!("recorded/{item}"), problem));
            }
        }
        if !self.rows.fits(&recorded.rows, self.samples) {
            let problem = "it is not that of these rows".to_owned();
            return Some(("recorded/rows".to_owned(), problem));
        }
        if recorded.next_sample > self.samples || recorded.closed > windows {
            let problem = format!("there are {} rows and {windows} windows", self.samples);
            return Some(("recorded/progress".to_owned(), problem));
        }
        // A run that has come to its end has no checkpoint.
        let last_s = self.run.end_s + self.run.interval_s;
        let problem = format!(
            "its time is {time_s} s, the run ends at {} s",
            self.run.end_s
        );
        (time_s > last_s).then(|| ("simulation/scalars".to_owned(), problem))
    }

    /// A run that goes on from its checkpoint, the wall time before, and the notes of its start.
    fn resumed(
        &mut self,
        system: System,
        mut tree: DataTree,
        path: PathBuf,
    ) -> Result<(Simulation, f64, Vec<String>), SystemRunError> {
        let damaged = |source| SystemRunError::Checkpoint { source };
        let (checkpoint, recorded) = from_tree(&mut tree, &path).map_err(damaged)?;
        let simulation = Simulation::resume(system, self.run.params, &checkpoint)?;
        let time_s = simulation.state().time_s;
        if let Some((item, problem)) = self.contradiction(time_s, &recorded) {
            let source = FileError::Contradiction {
                path,
                item,
                problem,
            };
            return Err(damaged(source));
        }
        let wall_s = recorded.wall_s;
        // A resumed run does not make them again.
        let notes = tree.take_text(&path, NOTES).map_err(damaged)?;
        self.resume_at(&simulation, recorded);
        Ok((
            simulation,
            wall_s,
            notes.lines().map(str::to_owned).collect(),
        ))
    }

    fn resume_at(&mut self, simulation: &Simulation, recorded: Recorded) {
        self.recorder.restore(&recorded.angles);
        let start = simulation.state();
        let grid = OutputGrid::new(self.run.interval_s, start);
        let parts = self.run.samples_per_row() as u64;
        self.grid = grid.in_parts(parts).from_index(recorded.next_sample);
        self.rows.restore(&recorded.rows);
        self.statistics.restore(&recorded.statistics[0]);
        self.window.restore(&recorded.statistics[1]);
        (self.closed, self.figures) = (recorded.closed, recorded.windows);
        self.before = simulation.info().energy;
    }

    fn recorded(&self, wall_s: f64) -> Recorded {
        Recorded {
            next_sample: self.grid.next_index(),
            wall_s,
            angles: self.recorder.save(),
            rows: self.rows.save(),
            statistics: [self.statistics.save(), self.window.save()],
            windows: self.figures.clone(),
            closed: self.closed,
        }
    }

    fn is_complete(&self) -> bool {
        self.grid.next_index() >= self.samples
    }

    /// Takes the output times within a step. Allocates nothing, but where a window closes.
    fn take(&mut self, step: &mut Accepted<'_>, log: &mut RowLog) -> Result<(), SystemRunError> {
        let (from_s, to_s) = (step.from.time_s, step.to.time_s);
        let (info, to) = (step.info, step.to);
        self.pace.follow(step.system, to, to_s - from_s)?;
        let lambda = [step.lambda_from, step.lambda];
        let acceleration = [step.acceleration_from, step.acceleration];
        let Self {
            run,
            samples,
            recorder,
            rows,
            grid,
            statistics,
            window,
            closed,
            figures,
            before,
            pace: _,
        } = self;
        let mut outcome = Ok(());
        let mut index = grid.next_index();
        grid.visit(step, |state, system| {
            let due = index < *samples && outcome.is_ok();
            index += 1;
            // Rounding must not move a sample out of its window.
            let now = state.time_s + 1e-9 * run.interval_s;
            while let Some(open) = run.windows.get(*closed).filter(|open| now >= open.to_s) {
                assert!(open.from_s < open.to_s);
                close(window, figures);
                *closed += 1;
            }
            let open = run.windows.get(*closed);
            if !due || (!run.windows.is_empty() && open.is_none_or(|open| now < open.from_s)) {
                return;
            }
            let row = recorder.finite_row(
                system,
                &Moment {
                    abscissas: &[state.time_s],
                    state,
                    lambda,
                    acceleration,
                    share: (state.time_s - from_s) / (to_s - from_s),
                    energy: [before, &info.energy],
                    step_s: to_s - from_s,
                    largest_violation: info.largest_violation,
                },
            );
            let row = match row {
                Ok(row) => row,
                Err(error) => {
                    outcome = Err(error);
                    return;
                }
            };
            if run.windows.is_empty() {
                if now >= run.statistics_from_s {
                    statistics.add(row);
                }
                outcome = (rows.add(row, |row| log.append(row))).map_err(SystemRunError::from);
            } else {
                window.add(row);
            }
        });
        recorder.commit(step.system, to);
        *before = info.energy;
        outcome
    }

    /// Closes the windows that reach the end of the run, and writes the rows that have waited.
    fn finish(&mut self, log: &mut RowLog) -> Result<(), SystemRunError> {
        if self.run.windows.is_empty() {
            self.rows.finish(|row| log.append(row))?;
        }
        while self.closed < self.run.windows.len() {
            close(&mut self.window, &mut self.figures);
            self.closed += 1;
        }
        Ok(())
    }

    /// Writes what was recorded: the rows, or the figures of the windows.
    fn write(
        &self,
        mut contents: Contents,
        ratings: &[RatingJob],
        output: &Path,
        log: &mut RowLog,
    ) -> Result<(), SystemRunError> {
        let (run, columns) = (self.run, self.recorder.columns());
        if run.windows.is_empty() {
            let written = self.rows.columns(columns);
            contents.statistics = self.statistics.figures();
            contents.statistics_from_s = Some(run.statistics_from_s);
            contents.folded = self.rows.folded();
            contents.samples_per_row = Some(run.samples_per_row() as f64);
            contents.ratings = rating::of_rows(ratings, &written, log)?;
            contents.write_with_rows(output, ("time", &written, log))?;
        } else {
            let sweep = SweepResult::of_run(&run.windows, columns.to_vec(), &self.figures);
            contents.ratings = rating::of_windows(ratings, columns, &self.figures);
            contents.sweep = Some(sweep);
            contents.write(output)?;
        }
        Ok(())
    }
}

fn close(window: &mut ColumnStatistics, figures: &mut Vec<f64>) {
    for column in window.figures() {
        figures.extend([column.mean, column.deviation, column.least, column.largest]);
    }
    *window = ColumnStatistics::new(window.columns());
}

/// Runs to the end, or until it is asked to stop.
pub(super) fn run_in_time(
    mut head: RunHead,
    system: System,
    (selection, ratings): (&Selection, &[RatingJob]),
    (kind, run): (ResultKind, &InTime),
    options: &RunOptions<'_>,
) -> Result<Outcome, SystemRunError> {
    let mut tape = Tape::new(run, (&head, &system), selection)?;
    let written = tape.rows.columns(tape.recorder.columns());
    let (identity, width) = (head.identity(), written.len());
    let (mut part, saved) = PartFolder::open(options.output, &identity, width, options.restart)?;
    let tell = |time_s: f64, resumed| {
        (options.progress)(Advance {
            done: time_s.min(run.end_s),
            total: run.end_s,
            resumed,
        });
    };
    let (mut simulation, mut wall_s) = match saved {
        None => {
            let simulation = begin(system, (&run.params, run.start), &mut head.notes)?;
            tape.start_at(&simulation, selection);
            (simulation, 0.0)
        }
        Some(tree) => {
            let path = PartFolder::beside(options.output);
            let (simulation, wall_s, notes) = tape.resumed(system, tree, path)?;
            head.notes = notes;
            (simulation, wall_s)
        }
    };
    tell(simulation.state().time_s, wall_s > 0.0);
    let mut begun = Instant::now();
    while !tape.is_complete() {
        let (leg, mut told) = (Instant::now(), Instant::now());
        let (mut taken, mut stopped) = (Ok(()), false);
        simulation.run(f64::INFINITY, |step| {
            taken = tape.take(step, part.log());
            let now = Instant::now();
            if now - told > TOLD_EVERY {
                told = now;
                tell(step.to.time_s, false);
            }
            stopped = options.stop.load(Ordering::Relaxed);
            let due = now - leg >= options.checkpoint_interval;
            if taken.is_err() || tape.is_complete() || stopped || due {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        })?;
        taken?;
        wall_s += begun.elapsed().as_secs_f64();
        begun = Instant::now();
        if !tape.is_complete() {
            let mut tree = to_tree(&simulation.checkpoint(), &tape.recorded(wall_s));
            tree.put_text(NOTES, head.notes.join("\n"));
            part.save(tree)?;
            if stopped {
                return Ok(Outcome::Stopped);
            }
        }
    }
    tape.finish(part.log())?;
    // The last step may go past the end: rows are interpolated, and nothing behind it is used.
    let simulated_s = simulation.state().time_s.min(run.end_s);
    let mut contents = Contents::of_run(kind, head);
    contents.record = Some(RunRecord::new(simulation.info(), simulated_s, wall_s));
    tape.write(contents, ratings, options.output, part.log())?;
    part.finish()?;
    Ok(Outcome::Finished)
}

/// Text of a checkpoint with the notes of the start.
const NOTES: &str = "notes";
