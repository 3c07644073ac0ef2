//! `static`: equilibria, one after the other, each found from the one before.

use gearmesh_dynamics::{EnergyBalance, StaticParams, System, equilibrium, next_equilibrium};
use gearmesh_model::Column;
use std::sync::atomic::Ordering;

use super::error::SystemRunError;
use super::job::{Advance, Outcome, RunHead, RunOptions, StaticPoint};
use super::part_folder::PartFolder;
use super::recorder::{Course, Moment, Recorder, Selection};
use super::result;

/// Runs a series. It is not resumed: an unfinished one begins anew.
pub(super) fn run_static(
    mut head: RunHead,
    mut system: System,
    selection: &Selection,
    points: &[StaticPoint],
    options: &RunOptions<'_>,
) -> Result<Outcome, SystemRunError> {
    let column = |name: &str, unit: &str, description: &str| Column {
        name: name.to_owned(),
        unit: unit.to_owned(),
        description: description.to_owned(),
    };
    let varied = points.iter().any(|point| point.angle_rad.is_some());
    let mut abscissas = vec![
        column("point", "1", "number of the equilibrium"),
        column("load_factor", "1", "share of loads and weights"),
    ];
    if varied {
        abscissas.push(column("angle_rad", "rad", "angle of the varied motion"));
    }
    abscissas.push(column("iterations", "1", "iterations of the solver"));
    let start = system.start().clone();
    let mut recorder = Recorder::new(&system, &start, selection, abscissas, Course::Static);
    let columns = recorder.columns().to_vec();
    let (mut part, _) = PartFolder::open(options.output, &head.identity(), columns.len(), true)?;
    let (still, none) = (
        vec![0.0; system.degrees_of_freedom()],
        EnergyBalance::default(),
    );
    let mut state = start;
    for (number, point) in points.iter().enumerate() {
        state.time_s = point.time_s;
        let params = StaticParams {
            load_factor: point.load_factor,
            ..StaticParams::default()
        };
        let found = if number == 0 {
            equilibrium(&mut system, &state, &params)?
        } else {
            next_equilibrium(&mut system, &state, &params)?
        };
        if number == 0 {
            head.notes.extend(
                found
                    .held
                    .iter()
                    .map(|motion| format!("nothing resists {motion}: held where it was")),
            );
        }
        recorder.commit(&system, &found.state);
        let mut abscissas = vec![number as f64, point.load_factor];
        abscissas.extend(point.angle_rad);
        abscissas.push(found.iterations as f64);
        let row = recorder.row(
            &mut system,
            &Moment {
                abscissas: &abscissas,
                state: &found.state,
                lambda: [&found.lambda; 2],
                acceleration: [&still; 2],
                share: 1.0,
                energy: [&none; 2],
                step_s: 0.0,
                largest_violation: 0.0,
            },
        );
        part.log().append(row)?;
        state = found.state;
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
    let tree = result::base(&head, "static", None);
    let rows = ("equilibrium", &columns[..], part.log());
    result::write_rows(options.output, &tree, rows)?;
    part.finish()?;
    Ok(Outcome::Finished)
}
