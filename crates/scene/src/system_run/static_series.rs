//! `static`: equilibria, one after the other, each found from the one before; each load factor in a system of its own.

use gearmesh_dynamics::{
    EnergyBalance, Equilibrium, State, StaticParams, System, equilibrium, next_equilibrium,
};
use gearmesh_model::Column;
use std::sync::atomic::Ordering;

use super::error::SystemRunError;
use super::job::{Advance, Outcome, RunHead, RunOptions, StaticJob, StaticPoint};
use super::part_folder::PartFolder;
use super::rating;
use super::recorder::{Course, Moment, Recorder, Selection};
use super::result_kind::ResultKind;
use super::result_record::Contents;
use crate::system::RatingJob;

/// Runs a series. It is not resumed: an unfinished one begins anew.
pub(super) fn run_static(
    mut head: RunHead,
    nominal: &System,
    (selection, ratings): (&Selection, &[RatingJob]),
    job: &StaticJob,
    options: &RunOptions<'_>,
) -> Result<Outcome, SystemRunError> {
    let points = &job.points;
    let abscissas = abscissas_of(points);
    let start = nominal.start();
    let mut recorder = Recorder::new(nominal, start, selection, abscissas, Course::Static);
    let columns = recorder.columns().to_vec();
    let (mut part, _) = PartFolder::open(options.output, &head.identity(), columns.len(), true)?;
    let still = vec![0.0; nominal.degrees_of_freedom()];
    let none = EnergyBalance::default();
    // Each load factor begins where the first one began, then goes on from point to point.
    let mut first: Option<State> = None;
    let mut last: Option<(f64, System, Equilibrium)> = None;
    for (number, point) in points.iter().enumerate() {
        let (mut system, found) = solved(job, point, last.take(), first.as_ref())?;
        if number == 0 {
            let held = found.held.iter();
            let notes = held.map(|motion| format!("nothing resists {motion}: held where it was"));
            head.notes.extend(notes);
        }
        recorder.commit(&system, &found.state);
        let mut values = vec![number as f64, point.load_factor];
        values.extend(point.angle_rad);
        values.push(found.iterations as f64);
        let row = recorder.finite_row(
            &mut system,
            &Moment {
                abscissas: &values,
                state: &found.state,
                lambda: [&found.lambda; 2],
                acceleration: [&still; 2],
                share: 1.0,
                energy: [&none; 2],
                step_s: 0.0,
                largest_violation: 0.0,
            },
        )?;
        part.log().append(row)?;
        first.get_or_insert_with(|| found.state.clone());
        last = Some((point.load_factor, system, found));
        (options.progress)(Advance {
            done: number as f64 + 1.0,
            total: points.len() as f64,
            resumed: false,
        });
        if options.stop.load(Ordering::Relaxed) {
            part.finish()?;
            return Ok(Outcome::Stopped);
        }
    }
    let mut contents = Contents::of_run(ResultKind::Static, head);
    contents.ratings = rating::of_rows(ratings, &columns, part.log())?;
    let rows = ("equilibrium", &columns[..], part.log());
    contents.write_with_rows(options.output, rows)?;
    part.finish()?;
    Ok(Outcome::Finished)
}

/// The equilibrium of a point: on from the one before, of the same load factor, or from the first one of the series.
fn solved(
    job: &StaticJob,
    point: &StaticPoint,
    before: Option<(f64, System, Equilibrium)>,
    first: Option<&State>,
) -> Result<(System, Equilibrium), SystemRunError> {
    let params = StaticParams::default();
    let on_the_way = StaticParams {
        load_steps: point.steps,
        ..params
    };
    if let Some((factor, mut system, before)) = before
        && factor.to_bits() == point.load_factor.to_bits()
    {
        let found = next_equilibrium(&mut system, &before, point.time_s, &on_the_way)?;
        return Ok((system, found));
    }
    let mut system = (job.system_at)(point.load_factor)?;
    let mut state = first.unwrap_or(system.start()).clone();
    let found = if first.is_none() && point.time_s > state.time_s {
        // From where the scene begins, where teeth touch, and on to the first position.
        let begun = equilibrium(&mut system, &state, &params)?;
        next_equilibrium(&mut system, &begun, point.time_s, &on_the_way)?
    } else {
        state.time_s = point.time_s;
        equilibrium(&mut system, &state, &params)?
    };
    Ok((system, found))
}

/// The first columns of a series.
pub(super) fn abscissas_of(points: &[StaticPoint]) -> Vec<Column> {
    let varied = points.iter().any(|point| point.angle_rad.is_some());
    let mut columns = vec![
        Column::new("point", "1", "number of the equilibrium"),
        Column::new("load_factor", "1", "share of the scene's loads"),
    ];
    if varied {
        columns.push(Column::new(
            "angle_rad",
            "rad",
            "angle of the varied motion",
        ));
    }
    columns.push(Column::new("iterations", "1", "iterations of the solver"));
    columns
}
