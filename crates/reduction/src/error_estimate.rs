//! Discretisation error of the reduced compliance, on the loaded tooth and on others, and of the gauges, from a second,
//! coarser mesh.
//!
//! With all element lengths larger by s and an error of order p, the fine value's error is about
//! |fine − coarse| / (s^p − 1). The strain at element centres between which a gauge interpolates converges with p = 2. So does
//! the compliance of a smooth body; at the sharp inner edges between web, rim and hub p falls to 2λ = 1.09 (see
//! `gearmesh_mesh::layers`), and p = 1 is assumed for deflections. Graded meshes are not similar to the last element, so
//! that this is an estimate.

use crate::flank_loads::{SparseVector, flank_loads};
use crate::gauge_row::gauge_row;
use crate::gear_body::GearBody;
use crate::tooth_submodel::{Deformation, ToothSubmodel};
use crate::tooth_vectors::summed;
use crate::{ReductionError, Silent};
use gearmesh_geometry::GearDefinition;
use gearmesh_mesh::python::PythonEnvironment;
use gearmesh_model::{FlankGrid, GaugeRows};

/// Ratio of the element lengths.
const COARSENING: f64 = 1.5;
/// Order of the error of a deflection.
const DEFLECTION_ORDER: i32 = 1;
/// Order of the error of a gauge's reading.
const GAUGE_ORDER: i32 = 2;

/// Estimated relative errors.
pub struct ErrorEstimate {
    /// Of the deflection under a load over the whole width in the middle of tooth 0's flank, C_g.
    pub loaded_tooth: f64,
    /// Of C_hub at the same place of other teeth: the largest of the next two on either side and the opposite one. Coarser layers
    /// and coarser sections often change it in opposite senses, so that on a single tooth the difference may vanish by accident.
    pub other_teeth: f64,
    /// Of each gauge's reading for loads on its own tooth.
    pub gauges: Vec<f64>,
}

/// The same gear with coarser elements.
fn coarsened(gear: &GearDefinition) -> GearDefinition {
    let mut coarse = gear.clone();
    // The estimate is that of the sound gear.
    coarse.crack = None;
    let mesh = &mut coarse.mesh;
    mesh.flank_m *= COARSENING;
    mesh.fillet_m *= COARSENING;
    mesh.axial_m *= COARSENING;
    mesh.body_m *= COARSENING;
    // Judged by the fine mesh; the coarse one only serves to estimate.
    mesh.min_scaled_jacobian = 0.05;
    coarse
}

/// Weights of a load over the whole width at a roll station, per load of one flank: the axial hats overlap, each inner
/// one carries its share of the width.
pub(crate) fn line_load(grid: &FlankGrid, station: usize) -> Vec<(usize, f64)> {
    let n = grid.z_m.len();
    (0..n)
        .map(|j| {
            let share = if j == 0 || j == n - 1 { 0.5 } else { 1.0 } / (n - 1) as f64;
            (grid.load(station, j), share)
        })
        .collect()
}

fn compliance_of(weights: &[(usize, f64)], c: impl Fn(usize, usize) -> f64) -> f64 {
    weights
        .iter()
        .flat_map(|&(l, a)| weights.iter().map(move |&(m, b)| (l, m, a * b)))
        .map(|(l, m, w)| w * c(l, m))
        .sum()
}

/// Estimates the errors of a reduction that has just been made.
///
/// # Errors
/// [`ReductionError`] when the coarse mesh cannot be made or solved.
pub fn estimate(
    gear: &GearDefinition,
    python: &PythonEnvironment,
    gauges: &[GaugeRows],
    c_hub: &[f64],
    c_tooth: &[f64],
    grid: &FlankGrid,
) -> Result<ErrorEstimate, ReductionError> {
    let coarse = coarsened(gear);
    let body = GearBody::new(&coarse, python, &Silent)?;
    let count = grid.len();
    let side = gear.reduction.flanks[0];
    let loads = flank_loads(&coarse, &body.mesh, grid, 0, side);
    let submodel =
        ToothSubmodel::new(&body.model, &body.mesh, side, &loads, Deformation::of(gear))?;
    let weights = line_load(grid, grid.roll_angles_rad.len() / 2);

    let line = summed(
        weights
            .iter()
            .flat_map(|&(load, share)| {
                let normal = &loads[load].normal;
                normal.iter().map(move |&(dof, value)| (dof, share * value))
            })
            .collect(),
    );
    let normals: Vec<&SparseVector> = loads.iter().map(|l| &l.normal).collect();
    let w = submodel.products(&normals);
    let mut rows = vec![line];
    for gauge in &gear.gauges {
        rows.push(gauge_row(
            &coarse,
            &body.mesh,
            &body.model,
            gauge,
            gauge.tooth,
        )?);
    }
    let rows: Vec<&SparseVector> = rows.iter().collect();
    let all = body.readings(&rows, &normals, &Silent);
    // Normal loads of a row's own tooth; the line load stands on tooth 0.
    let own = |row: usize, tooth: usize| &all[row][tooth * count..(tooth + 1) * count];
    let readings: Vec<&[f64]> = gear
        .gauges
        .iter()
        .enumerate()
        .map(|(k, gauge)| own(k + 1, gauge.tooth))
        .collect();
    // Rows of C_hub are [tooth][flank of the response][load][response]; those of the first flank are asked for.
    let flanks = gear.reduction.flanks.len();
    let block = |tooth: usize| &c_hub[tooth * flanks * count * count..][..count * count];
    let deflection_error = |tooth: usize| {
        let mut fine = compliance_of(&weights, |l, m| block(tooth)[l * count + m]);
        let mut coarse: f64 = (weights.iter())
            .map(|&(load, share)| share * own(0, tooth)[load])
            .sum();
        if tooth == 0 {
            fine -= compliance_of(&weights, |l, m| c_tooth[l * count + m]);
            coarse -= compliance_of(&weights, |l, m| w[m * count + l]);
        }
        (coarse / fine - 1.0).abs() / (COARSENING.powi(DEFLECTION_ORDER) - 1.0)
    };
    let teeth = gear.tooth.teeth;
    let others = [1, teeth - 1, 2, teeth - 2, teeth / 2];
    // What a gauge reads under loads over the whole width, station by station.
    let by_station = |reading: &dyn Fn(usize) -> f64| -> Vec<f64> {
        (0..grid.roll_angles_rad.len())
            .map(|station| {
                line_load(grid, station)
                    .into_iter()
                    .map(|(load, share)| share * reading(load))
                    .sum()
            })
            .collect()
    };
    let gauge_errors = gauges
        .iter()
        .zip(&readings)
        .map(|(gauge, coarse)| {
            let first = gauge.tooth * flanks * count;
            let fine = by_station(&|load| gauge.adjoint[3 * (first + load)]);
            let coarse = by_station(&|load| coarse[load]);
            let difference: f64 = fine.iter().zip(&coarse).map(|(f, c)| (f - c).powi(2)).sum();
            let norm: f64 = fine.iter().map(|f| f * f).sum();
            (difference / norm).sqrt() / (COARSENING.powi(GAUGE_ORDER) - 1.0)
        })
        .collect();
    Ok(ErrorEstimate {
        loaded_tooth: deflection_error(0),
        other_teeth: others.map(deflection_error).into_iter().fold(0.0, f64::max),
        gauges: gauge_errors,
    })
}
