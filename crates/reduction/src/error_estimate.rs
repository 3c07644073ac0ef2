//! Discretisation error of the reduced compliance, on the loaded tooth and on others, and of the gauges, from coarser
//! meshes.
//!
//! Coarser sections and coarser layers may change a figure in opposite senses: incompatible modes make coarse sections
//! too soft, thick layers are too stiff. A mesh that is coarser in both would show their difference only. So a first
//! mesh has longer elements in the section (by s = 1.5), a second one in the section and along the axis, and the sizes
//! of both changes are added:
//!
//! ```text
//! error = S (|fine − sections| + |sections − both|)/(s^p − 1)
//! ```
//!
//! Gauges: p = 2, as strain at element centres has it and is found (1.8 to 2.5 in plane strain), S = 2. Deflections:
//! smooth bodies converge with p = 2, at the sharp inner edges between web, rim and hub p falls to 2λ = 1.09 (see
//! `gearmesh_mesh::layers`); p = 1 is taken, S = 3. S is the factor of safety of Roache's grid convergence index: 3
//! where two meshes tell nothing of the order, 1.25 where three have confirmed it. What is found against converged
//! quadratic elements is up to 1.5 times the bare estimate of a gauge, 2.7 times that of a deflection: graded meshes
//! are not similar to the last element. In plane strain, and of tetrahedra, which have no layers along the axis, one
//! coarser mesh tells all.
//!
//! P. J. Roache, *Perspective: a method for uniform reporting of grid refinement studies*, J. Fluids Eng. 116 (1994)
//! 405-413.

use crate::flank_loads::{SparseVector, flank_loads};
use crate::gauge_row::gauge_row;
use crate::gear_body::GearBody;
use crate::tooth_submodel::{Deformation, ToothSubmodel};
use crate::tooth_vectors::summed;
use crate::{Progress, ReductionError, Within};
use gearmesh_geometry::{Element, GearDefinition};
use gearmesh_mesh::python::PythonEnvironment;
use gearmesh_model::{FlankGrid, GaugeRows};

/// Ratio of the element lengths.
const COARSENING: f64 = 1.5;
/// Order and factor of safety of a deflection.
const DEFLECTION: (i32, f64) = (1, 3.0);
/// Order and factor of safety of a gauge's reading.
const GAUGE: (i32, f64) = (2, 2.0);

/// Estimated relative errors.
pub struct ErrorEstimate {
    /// Of the deflection under a load over the whole width in the middle of tooth 0's flank, C_g.
    pub loaded_tooth: f64,
    /// Of C_hub at the same place of other teeth: the largest of the next two on either side and the opposite one.
    pub other_teeth: f64,
    /// Of each gauge's reading for loads on its own tooth.
    pub gauges: Vec<f64>,
}

/// What the estimate compares of one mesh.
struct Figures {
    /// Deflection of tooth 0 under its own load, then of the others that are looked at.
    deflections: Vec<f64>,
    /// Of each gauge its reading for loads over the whole width, station by station.
    gauges: Vec<Vec<f64>>,
}

/// Teeth whose deflection is looked at, tooth 0 loaded.
fn teeth_looked_at(teeth: usize) -> [usize; 6] {
    [0, 1, teeth - 1, 2, teeth - 2, teeth / 2]
}

/// The same gear with coarser elements in the section, and along the axis.
fn coarsened(gear: &GearDefinition, axial: bool) -> GearDefinition {
    let mut coarse = gear.clone();
    // The estimate is that of the sound gear.
    coarse.crack = None;
    let mesh = &mut coarse.mesh;
    mesh.flank_m *= COARSENING;
    mesh.fillet_m *= COARSENING;
    mesh.body_m *= COARSENING;
    if axial {
        mesh.axial_m *= COARSENING;
    }
    // Judged by the fine mesh; the coarse ones only serve to estimate.
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

/// A gauge's reading of loads over the whole width, station by station.
fn by_station(grid: &FlankGrid, reading: impl Fn(usize) -> f64) -> Vec<f64> {
    let of_line = |station| {
        let loads = line_load(grid, station).into_iter();
        loads.map(|(load, share)| share * reading(load)).sum()
    };
    (0..grid.roll_angles_rad.len()).map(of_line).collect()
}

/// Estimates the errors of a reduction that has just been made.
///
/// # Errors
/// [`ReductionError`] when a coarse mesh cannot be made or solved.
pub fn estimate(
    gear: &GearDefinition,
    python: &PythonEnvironment,
    gauges: &[GaugeRows],
    c_hub: &[f64],
    c_tooth: &[f64],
    grid: &FlankGrid,
    progress: &dyn Progress,
) -> Result<ErrorEstimate, ReductionError> {
    let fine = reduced_figures(gear, gauges, c_hub, c_tooth, grid);
    let one_step = gear.mesh.plane_strain || gear.mesh.element == Element::Tet10;
    let steps: &[bool] = if one_step { &[true] } else { &[false, true] };
    let mut meshes = vec![fine];
    for (k, &axial) in steps.iter().enumerate() {
        let progress = Within {
            all: progress,
            part: format!("error estimate, coarser mesh {} of {}", k + 1, steps.len()),
        };
        meshes.push(mesh_figures(
            &coarsened(gear, axial),
            python,
            grid,
            &progress,
        )?);
    }
    let error = |(order, safety): (i32, f64), values: &dyn Fn(&Figures) -> Vec<f64>| -> f64 {
        let all: Vec<Vec<f64>> = meshes.iter().map(values).collect();
        let norm = |v: &[f64]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
        let steps = all.windows(2).map(|pair| {
            let difference: Vec<f64> = pair[0].iter().zip(&pair[1]).map(|(a, b)| a - b).collect();
            norm(&difference)
        });
        safety * steps.sum::<f64>() / (COARSENING.powi(order) - 1.0) / norm(&all[0])
    };
    let deflection = |k: usize| error(DEFLECTION, &|figures| vec![figures.deflections[k]]);
    Ok(ErrorEstimate {
        loaded_tooth: deflection(0),
        other_teeth: (1..6).map(deflection).fold(0.0, f64::max),
        gauges: (0..gauges.len())
            .map(|k| error(GAUGE, &|figures| figures.gauges[k].clone()))
            .collect(),
    })
}

/// The figures of the reduction.
fn reduced_figures(
    gear: &GearDefinition,
    gauges: &[GaugeRows],
    c_hub: &[f64],
    c_tooth: &[f64],
    grid: &FlankGrid,
) -> Figures {
    let count = grid.len();
    let weights = line_load(grid, grid.roll_angles_rad.len() / 2);
    // Rows of C_hub are [tooth][flank of the response][load][response]; those of the first flank are asked for.
    let flanks = gear.reduction.flanks.len();
    let deflection = |tooth: usize| {
        let block = &c_hub[tooth * flanks * count * count..][..count * count];
        let mut value = compliance_of(&weights, |l, m| block[l * count + m]);
        if tooth == 0 {
            value -= compliance_of(&weights, |l, m| c_tooth[l * count + m]);
        }
        value
    };
    let of_gauge = |gauge: &GaugeRows| {
        let first = gauge.tooth * flanks * count;
        by_station(grid, |load| gauge.adjoint[3 * (first + load)])
    };
    Figures {
        deflections: teeth_looked_at(gear.tooth.teeth).map(deflection).to_vec(),
        gauges: gauges.iter().map(of_gauge).collect(),
    }
}

/// The same of another mesh.
fn mesh_figures(
    gear: &GearDefinition,
    python: &PythonEnvironment,
    grid: &FlankGrid,
    progress: &dyn Progress,
) -> Result<Figures, ReductionError> {
    let body = GearBody::new(gear, python, progress)?;
    progress.stage("solving");
    let count = grid.len();
    let side = gear.reduction.flanks[0];
    let loads = flank_loads(gear, &body.mesh, grid, 0, side);
    let submodel =
        ToothSubmodel::new(&body.model, &body.mesh, side, &loads, Deformation::of(gear))?;
    let weights = line_load(grid, grid.roll_angles_rad.len() / 2);
    let shares = weights.iter().flat_map(|&(load, share)| {
        let normal = &loads[load].normal;
        normal.iter().map(move |&(dof, value)| (dof, share * value))
    });
    let line = summed(shares.collect());
    let normals: Vec<&SparseVector> = loads.iter().map(|l| &l.normal).collect();
    let w = submodel.products(&normals);
    let mut rows = vec![line];
    for gauge in &gear.gauges {
        let row = gauge_row(gear, &body.mesh, &body.model, gauge, gauge.tooth)?;
        rows.push(row);
    }
    let rows: Vec<&SparseVector> = rows.iter().collect();
    let all = body.readings(&rows, &normals, progress);
    // Normal loads of a row's own tooth; the line load stands on tooth 0.
    let own = |row: usize, tooth: usize| &all[row][tooth * count..(tooth + 1) * count];
    let deflection = |tooth: usize| {
        let on_tooth = own(0, tooth);
        let mut value: f64 = (weights.iter())
            .map(|&(load, share)| share * on_tooth[load])
            .sum();
        if tooth == 0 {
            value -= compliance_of(&weights, |l, m| w[m * count + l]);
        }
        value
    };
    let of_gauge = |(k, tooth): (usize, usize)| by_station(grid, |load| own(k + 1, tooth)[load]);
    let teeth = gear.gauges.iter().map(|gauge| gauge.tooth).enumerate();
    Ok(Figures {
        deflections: teeth_looked_at(gear.tooth.teeth).map(deflection).to_vec(),
        gauges: teeth.map(of_gauge).collect(),
    })
}
