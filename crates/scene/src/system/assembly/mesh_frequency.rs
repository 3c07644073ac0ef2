//! How often teeth come into mesh, and whether the steps of a run follow it.
//!
//! ```text
//! f = z₁ |ω₁ − ω_c|/2π,      ω_c = e·(d × ḋ)/|d × e|²
//! ```
//!
//! ω₁: turn of gear 1 about its axis e; d: from gear 1's origin to gear 2's. ω_c is the turn of the line of centres,
//! that of the carrier where axes are carried round; zero where they stand. Bevel gears have their origins in one point
//! and no line of centres.

use std::f64::consts::TAU;

use gearmesh_dynamics::scheme::StepControl;
use gearmesh_geometry::InputError;
use gearmesh_specification::system::mesh_model::MeshKind;
use gearmesh_specification::system::run::Run;
use nalgebra::Vector3;

use super::bodies::Bodies;
use super::gear_mesh::PreparedMesh;
use crate::system::scene::SystemScene;

/// Steps that a mesh period needs at least: the scheme's error of a motion at the mesh frequency, |C| (2π/10)² with C
/// of docs/theory/multibody.md, is then 3.4 % of its inertia force. At five steps it is 14 %, at two the mesh frequency
/// itself is folded.
pub(crate) const STEPS_A_PERIOD: f64 = 10.0;

/// Origins that are nearer to each other across the axis than this \[m\] are those of bevel gears, apart by no more
/// than their bearings deflect.
const LEAST_APART_M: f64 = 1e-3;

/// How fast the line of centres turns about gear 1's axis \[rad/s\], from places and velocities of the two gears and
/// that axis.
pub(crate) fn line_of_centres_rad_per_s(
    between_m: &Vector3<f64>,
    rate_m_per_s: &Vector3<f64>,
    axis: &Vector3<f64>,
) -> f64 {
    let square = between_m.cross(axis).norm_squared();
    if square > LEAST_APART_M * LEAST_APART_M {
        axis.dot(&between_m.cross(rate_m_per_s)) / square
    } else {
        0.0
    }
}

/// The same for a mesh of a scene.
pub(super) fn carrier_rad_per_s(mesh: &PreparedMesh, bodies: &Bodies) -> f64 {
    let [first, second] = mesh.bodies.map(|body| &bodies.list[body]);
    line_of_centres_rad_per_s(
        &(second.body.position_m - first.body.position_m),
        &(second.body.velocity_m_per_s - first.body.velocity_m_per_s),
        &first.axis(),
    )
}

/// Speed of gear 1 about its axis against the line of centres \[rad/s\].
pub(super) fn spin_rad_per_s(mesh: &PreparedMesh, bodies: &Bodies) -> f64 {
    bodies.list[mesh.bodies[0]].spin() - carrier_rad_per_s(mesh, bodies)
}

/// Mesh frequency \[Hz\].
pub(super) fn frequency_hz(mesh: &PreparedMesh, bodies: &Bodies) -> f64 {
    mesh.built.teeth[0] as f64 * spin_rad_per_s(mesh, bodies).abs() / TAU
}

/// The highest mesh frequency \[Hz\] of all states, and the mesh's name. A ratio has no teeth to be followed.
pub(super) fn highest<'a>(
    meshes: &'a [PreparedMesh],
    states: &[&Bodies],
) -> Option<(f64, &'a str)> {
    let toothed = meshes
        .iter()
        .filter(|mesh| mesh.model != MeshKind::Kinematic);
    let of_mesh = |mesh: &'a PreparedMesh| {
        let each = states.iter();
        each.map(move |bodies| (frequency_hz(mesh, bodies), &*mesh.built.name))
    };
    toothed.flat_map(of_mesh).max_by(|a, b| a.0.total_cmp(&b.0))
}

/// Pitches of the fastest toothed mesh for a radian of the motion that a static series varies, from the bodies at
/// 1 rad/s of it; 0 in other runs.
pub(super) fn pitches_per_rad(run: &Run, meshes: &[PreparedMesh], bodies: &Bodies) -> f64 {
    match (run, highest(meshes, &[bodies])) {
        (Run::Static { .. }, Some((hz, _))) => hz,
        _ => 0.0,
    }
}

/// Refuses a step that is too long for the meshes at the speeds that the scene states: those of the start and those to
/// which its motions go.
pub(super) fn refuse_long_steps(
    scene: &SystemScene,
    meshes: &[PreparedMesh],
    states: [&Bodies; 2],
) -> Result<(), InputError> {
    let Some(params) = scene.solver.params else {
        return Ok(());
    };
    let step_s = params.step.longest_s();
    let key = match params.step {
        StepControl::Fixed { .. } => "solver.step_s",
        StepControl::Adaptive(_) => "solver.adaptive.largest_step_s",
    };
    let Some((highest_hz, name)) = highest(meshes, &states) else {
        return Ok(());
    };
    if step_s * highest_hz * STEPS_A_PERIOD <= 1.0 + 1e-9 {
        return Ok(());
    }
    let problem = format!(
        "found {step_s} s, {:.3} periods of mesh `{name}`, whose frequency is {highest_hz:.3} Hz at the highest speed that the scene \
         states; allowed is at most {:.2e} s, a tenth of the mesh period",
        step_s * highest_hz,
        floored(1.0 / (STEPS_A_PERIOD * highest_hz))
    );
    Err(scene.document.error(key, problem))
}

/// A step rounded down to three figures, so that it may be copied from a message.
pub(crate) fn floored(step_s: f64) -> f64 {
    let unit = 10f64.powf(step_s.log10().floor() - 2.0);
    (step_s / unit * (1.0 + 1e-12)).floor() * unit
}
