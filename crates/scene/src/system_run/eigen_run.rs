//! `eigen`: natural frequencies about equilibria or motions, with the share of each body in them.

use gearmesh_dynamics::{
    DynamicsError, NaturalMode, State, StaticParams, System, equilibrium, natural_modes,
    natural_modes_up_to, strain_shares,
};
use gearmesh_model::FileError;
use nalgebra::{DVector, Vector3};
use std::collections::HashMap;
use std::ops::ControlFlow;
use std::sync::atomic::Ordering;

use super::error::SystemRunError;
use super::in_time::begin;
use super::job::{Advance, EigenJob, EigenPoint, MeshRecord, Outcome, RunHead, RunOptions};
use super::recorder::joint_moments;
use super::result::EigenResult;
use super::result_kind::ResultKind;
use super::result_record::Contents;
use super::stages::StageLoad;
use crate::system::names::element_column;

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
        let Some(found) = about(system, point, (job, &head.meshes), &mut notes, options)? else {
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
    head.notes.extend(open_meshes(&results, &head.meshes));
    head.notes
        .extend(torques_that_follow(&results, &job.torques));
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
    (job, meshes): (&EigenJob, &[MeshRecord]),
    notes: &mut Vec<String>,
    options: &RunOptions<'_>,
) -> Result<Option<EigenResult>, SystemRunError> {
    let (mut system, state, lambda, modes) = match job.settle {
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
            let (state, lambda) = (simulation.state().clone(), simulation.lambda().to_vec());
            (simulation.into_system(), state, lambda, modes?)
        }
        None => {
            let start = system.start().clone();
            let found = equilibrium(&mut system, &start, &StaticParams::default())?;
            for motion in found.held {
                notes.push(format!("nothing resists {motion}: held where it was"));
            }
            let modes = modes_of(&mut system, &found.state, job)?;
            (system, found.state, found.lambda, modes)
        }
    };
    let strain = strain_shares(&mut system, &state, &modes)?;
    let loads = loads_of(&mut system, (&state, &lambda), meshes)?;
    let participation = modes
        .iter()
        .map(|mode| participation(&system, &state, mode))
        .collect();
    Ok(Some(EigenResult {
        point: *point,
        modes,
        participation,
        strain,
        loads,
    }))
}

/// Meshes without a pair of teeth that carries: their stiffness is in none of the modes.
fn open_meshes(results: &[EigenResult], meshes: &[MeshRecord]) -> Vec<String> {
    let mut notes = Vec::new();
    for (i, mesh) in meshes.iter().enumerate() {
        let is_open = |point: &&EigenResult| {
            let mut loads = point.loads.iter();
            loads.any(|(of, load)| *of == i && load.loaded_pairs == Some(0.0))
        };
        let open: Vec<&EigenResult> = results.iter().filter(is_open).collect();
        if let Some(first) = open.first() {
            notes.push(format!(
                "warning: mesh `{}` is open at {} of {} operating points (the first one at load factor {}): no pair of teeth carries, so its stiffness is in \
                 none of the modes there and its gears turn free of each other. A load that presses the flanks together closes it",
                mesh.name,
                open.len(),
                results.len(),
                first.point.load_factor
            ));
        }
    }
    notes
}

/// Damping ratios below this are rounding.
const LEAST_RATIO: f64 = 1e-7;

/// Says why modes of a scene without damping die out and grow: without damping the eigenvalues lie as ±s, and off the
/// imaginary axis only where stiffness is not symmetric, as that of a torque on a body which tilts
/// (docs/theory/multibody.md, "Loads that follow").
fn torques_that_follow(results: &[EigenResult], torques: &[String]) -> Option<String> {
    let modes = results.iter().flat_map(|point| &point.modes);
    let vibrating = modes.filter(|mode| mode.angular_frequency_rad_per_s != 0.0);
    let [least, most] = vibrating
        .map(NaturalMode::damping_ratio)
        .fold([0.0_f64; 2], |[a, b], ratio| [a.min(ratio), b.max(ratio)]);
    let is_undamped = (most + least).abs() < 1e-2 * most;
    if torques.is_empty() || most < LEAST_RATIO || !is_undamped {
        return None;
    }
    Some(format!(
        "damping ratios of up to ±{:.3} % in modes of a scene without damping come from {}: a torque on a body that tilts follows the body or keeps its axis, \
         and does work over a closed way of tilts, so that stiffness is not symmetric. Modes with the minus sign grow where no damping holds them",
        100.0 * most,
        torques
            .iter()
            .map(|name| format!("`{name}`"))
            .collect::<Vec<_>>()
            .join(", ")
    ))
}

/// What the meshes carry at an operating point; `kinematic` ones are joints with reactions λ.
fn loads_of(
    system: &mut System,
    (state, lambda): (&State, &[f64]),
    meshes: &[MeshRecord],
) -> Result<Vec<(usize, StageLoad)>, FileError> {
    let channels = system.channels();
    let names: Vec<&str> = system.elements().collect();
    let of = |name: &&str| channels.iter().filter(|(owner, _)| owner == name).count();
    let counts: Vec<usize> = names.iter().map(of).collect();
    let mut values = vec![0.0; channels.len()];
    system.sample(state, &counts, &mut values);
    let columns = channels
        .iter()
        .map(|(owner, channel)| element_column(owner, &channel.name));
    let moments = joint_moments(system, state, lambda);
    let by_column: HashMap<String, f64> = columns.zip(values).chain(moments).collect();
    let mut loads = Vec::new();
    for (i, mesh) in meshes.iter().enumerate() {
        let load = StageLoad::of(mesh, |column| Ok(by_column.get(column).copied()))?;
        loads.extend(load.map(|load| (i, load)));
    }
    Ok(loads)
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
