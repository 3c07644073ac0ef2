//! `eigen`: natural frequencies about equilibria or motions, with the share of each body in them.

use gearmesh_dynamics::{
    DynamicsError, NaturalMode, State, StaticParams, System, equilibrium, natural_modes,
    natural_modes_up_to, strain_shares,
};
use nalgebra::{DVector, Vector3};
use std::ops::ControlFlow;
use std::sync::atomic::Ordering;

use super::error::SystemRunError;
use super::in_time::begin;
use super::job::{Advance, EigenJob, EigenPoint, Outcome, RunHead, RunOptions};
use super::result::EigenResult;
use super::result_kind::ResultKind;
use super::result_record::Contents;

/// Runs all operating points. It is not resumed: an unfinished one begins anew.
pub(super) fn run_eigen(
    mut head: RunHead,
    job: &EigenJob,
    options: &RunOptions<'_>,
) -> Result<Outcome, SystemRunError> {
    let mut results = Vec::with_capacity(job.points.len());
    let (mut bodies, mut elements) = (Vec::new(), Vec::new());
    for (number, point) in job.points.iter().enumerate() {
        let system = (job.system_at)(*point)?;
        bodies = system
            .bodies()
            .iter()
            .map(|body| body.name.clone())
            .collect();
        elements = system.elements().map(str::to_owned).collect();
        let mut notes = Vec::new();
        let Some(found) = about(system, point, job, &mut notes, options)? else {
            return Ok(Outcome::Stopped);
        };
        results.push(found);
        if number == 0 {
            head.notes.append(&mut notes);
        }
        (options.progress)(Advance {
            done: number as f64 + 1.0,
            total: job.points.len() as f64,
            resumed: false,
        });
        if options.stop.load(Ordering::Relaxed) {
            return Ok(Outcome::Stopped);
        }
    }
    let mut contents = Contents::of_run(ResultKind::Eigen, head);
    (contents.bodies, contents.elements) = (bodies, elements);
    contents.eigen = results;
    contents.write(options.output)?;
    Ok(Outcome::Finished)
}

/// Modes about one operating point; none if the run was stopped on the way.
fn about(
    mut system: System,
    point: &EigenPoint,
    job: &EigenJob,
    notes: &mut Vec<String>,
    options: &RunOptions<'_>,
) -> Result<Option<EigenResult>, SystemRunError> {
    let (mut system, state, modes) = match job.settle {
        Some(settling) => {
            let mut simulation = begin(system, (&settling.params, settling.start), notes)?;
            let mut found = None;
            simulation.run(f64::INFINITY, |step| {
                if step.to.time_s >= settling.time_s * (1.0 - 1e-12) {
                    found = Some(modes_of(step.system, step.to, job));
                }
                if found.is_some() || options.stop.load(Ordering::Relaxed) {
                    ControlFlow::Break(())
                } else {
                    ControlFlow::Continue(())
                }
            })?;
            let Some(modes) = found else { return Ok(None) };
            let state = simulation.state().clone();
            (simulation.into_system(), state, modes?)
        }
        None => {
            let start = system.start().clone();
            let found = equilibrium(&mut system, &start, &StaticParams::default())?;
            for motion in found.held {
                notes.push(format!("nothing resists {motion}: held where it was"));
            }
            let modes = modes_of(&mut system, &found.state, job)?;
            (system, found.state, modes)
        }
    };
    let strain = strain_shares(&mut system, &state, &modes)?;
    let participation = modes
        .iter()
        .map(|mode| participation(&system, &state, mode))
        .collect();
    Ok(Some(EigenResult {
        point: *point,
        modes,
        participation,
        strain,
    }))
}

/// All modes about a state, or those up to the highest frequency that is asked for.
fn modes_of(
    system: &mut System,
    state: &State,
    job: &EigenJob,
) -> Result<Vec<NaturalMode>, DynamicsError> {
    match job.most_frequency_hz {
        Some(most) => natural_modes_up_to(system, state, most),
        None => natural_modes(system, state),
    }
}

/// Share of each body in the kinetic energy of a mode: yᴴ M y of the body over the sum, y its amplitudes in body axes.
pub fn participation(system: &System, state: &State, mode: &NaturalMode) -> Vec<f64> {
    let mut first = 0;
    let energy = |(id, body): (_, &gearmesh_dynamics::Body)| {
        let mass = body.mass_matrix_in_body_axes();
        let to_body = system.body_motion(state, id).rotation.transpose();
        let own = &mode.shape[first..first + mass.nrows()];
        first += mass.nrows();
        let of_part = |part: usize| {
            let mut y = DVector::from_iterator(own.len(), own.iter().map(|a| a[part]));
            for block in [0, 3] {
                let turned: Vector3<f64> = to_body * y.fixed_rows::<3>(block);
                y.fixed_rows_mut::<3>(block).copy_from(&turned);
            }
            y.dot(&(&mass * &y))
        };
        of_part(0) + of_part(1)
    };
    let energies: Vec<f64> = system.body_ids().zip(system.bodies()).map(energy).collect();
    let total: f64 = energies.iter().sum();
    energies.iter().map(|energy| energy / total).collect()
}
