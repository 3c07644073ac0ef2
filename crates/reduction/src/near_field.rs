//! The calibration of the local term: the near field of a narrow load in plane strain, on a fine section of one tooth
//! and on the gear's own mesh.
//!
//! Both problems have the supports of the tooth-only submodel: the cut and the opposite side of the tooth held. What
//! lies beyond them is the same in both, so that their difference is what the mesh and its hats get wrong near the load
//! (docs/theory/near_field.md). The calibration belongs to a tooth and its mesh, not to the body: it is made once.

use crate::ReductionError;
use crate::contact_problem::ContactProblem;
use crate::error_estimate::line_load;
use crate::flank_loads::{flank_loads, normals};
use crate::gear_body::model_of;
use crate::tooth_submodel::{Deformation, ToothSubmodel};
use gearmesh_fe::FeModel;
use gearmesh_geometry::{Element, Flank, GearDefinition};
use gearmesh_mesh::contact_section::ContactGrading;
use gearmesh_mesh::{CutLine, GearMesh};
use gearmesh_model::{FlankGrid, NearField};
use rayon::prelude::*;

/// Half width a₀ of the calibrating pressure in modules. A steel pair of ratio 1 has a/m of 0.02 to 0.06 between light
/// and full load; the correction to the true width is exact to O((a/h)²), h some 0.7 to 1.5 modules.
pub const HALF_WIDTH_IN_MODULES: f64 = 0.03;

/// Elements in the calibrating half width.
const ELEMENTS_IN_HALF_WIDTH: f64 = 8.0;
/// Growth of the element length per length, away from the load.
const GROWTH: f64 = 0.15;
/// Largest element length in modules.
const LARGEST_IN_MODULES: f64 = 0.2;
/// Ratio of the element lengths of the two gradings from which c₀ is extrapolated.
const COARSENING: f64 = 2.0;
/// Places near the edge: distances from it in a₀.
const EDGE_PLACES: [f64; 7] = [0.0, 0.1, 0.45, 1.0, 1.2, 1.7, 2.4];
/// Further places down the flank.
const FLANK_PLACES: usize = 9;

/// Grading of the fine section, its element lengths and growth multiplied by `factor`.
pub fn grading(module_m: f64, factor: f64) -> ContactGrading {
    let half_width = HALF_WIDTH_IN_MODULES * module_m;
    ContactGrading {
        smallest_m: factor * half_width / ELEMENTS_IN_HALF_WIDTH,
        plateau_m: 1.25 * half_width,
        growth: factor * GROWTH,
        largest_m: factor * LARGEST_IN_MODULES * module_m,
    }
}

/// The value at vanishing element length from those of [`grading`] 1 and 2: the error is of second order.
pub fn extrapolated(fine: f64, coarse: f64) -> f64 {
    fine + (fine - coarse) / (COARSENING * COARSENING - 1.0)
}

/// Roll angles of the places. Where the pressure reaches the edge (distance below a₀) c₀ is no logarithm any more:
/// there they stand at fixed multiples of a₀; farther down with equal steps of a measure that is dense towards both
/// ends.
pub fn places(gear: &GearDefinition) -> Vec<f64> {
    let (profile, module) = (&gear.profile, gear.tooth.module_m);
    let [low, high] = profile.flank_rolls_rad();
    let length = 0.5 * profile.base_radius_m * (high * high - low * low);
    let distances = edge_distances_m(length, module);
    let mut rolls: Vec<f64> = distances
        .iter()
        .map(|d| profile.roll_from_rad(profile.flank_end_roll_rad, -d))
        .map(|roll| roll.clamp(low, high))
        .collect();
    rolls.sort_by(f64::total_cmp);
    // The flank's own ends are meant exactly, not to the rounding of the bisection.
    let last = rolls.len() - 1;
    (rolls[0], rolls[last]) = (low, high);
    rolls
}

/// Distances of the places from the tip's edge on a flank of that length, from the edge on.
pub(crate) fn edge_distances_m(length: f64, module: f64) -> Vec<f64> {
    let a0 = HALF_WIDTH_IN_MODULES * module;
    let mut distances: Vec<f64> = EDGE_PLACES.iter().map(|n| n * a0).collect();
    // Towards the edge like ln(1 + d/a₀), towards the cut, some half a module below the flank, like another logarithm.
    let measure = |d: f64| (1.0 + d / a0).ln() - 1.6 * (1.0 - d / (length + 0.5 * module)).ln();
    let first = distances[EDGE_PLACES.len() - 1];
    for k in 1..=FLANK_PLACES {
        let share = k as f64 / FLANK_PLACES as f64;
        let wanted = measure(first) + share * (measure(length) - measure(first));
        let (mut below, mut above) = (first, length);
        for _ in 0..60 {
            let middle = 0.5 * (below + above);
            if measure(middle) < wanted {
                below = middle;
            } else {
                above = middle;
            }
        }
        distances.push(below);
    }
    // One more above the lowest: the slope there is known from one side only.
    let n = distances.len();
    distances.insert(n - 1, 0.5 * (distances[n - 2] + distances[n - 1]));
    distances
}

/// c₀ at places, extrapolated from two gradings, and the largest relative step to it from the finer one. `deflection`
/// solves a place with a grading.
///
/// # Errors
/// Those of `deflection`.
pub(crate) fn contact_at(
    places: &[f64],
    module_m: f64,
    deflection: impl Fn(f64, ContactGrading) -> Result<f64, ReductionError> + Sync,
) -> Result<(Vec<f64>, f64), ReductionError> {
    let at_all = |factor: f64| -> Result<Vec<f64>, ReductionError> {
        let grading = grading(module_m, factor);
        let places = places.par_iter();
        places.map(|&place| deflection(place, grading)).collect()
    };
    let (fine, coarse) = (at_all(1.0)?, at_all(COARSENING)?);
    let pairs = fine.iter().zip(&coarse);
    let best: Vec<f64> = pairs
        .map(|(fine, coarse)| extrapolated(*fine, *coarse))
        .collect();
    let steps = fine.iter().zip(&best);
    let residual = steps
        .map(|(fine, best)| (fine / best - 1.0).abs())
        .fold(0.0, f64::max);
    Ok((best, residual))
}

/// Calibrates the tooth of a gear on its mesh.
///
/// # Errors
/// [`ReductionError`] when a section cannot be solved.
pub fn calibrate(
    gear: &GearDefinition,
    mesh: &GearMesh,
    model: &FeModel,
    grid: &FlankGrid,
) -> Result<NearField, ReductionError> {
    let mut mesh_m2_per_n = Vec::new();
    for &side in &gear.reduction.flanks {
        mesh_m2_per_n.extend(mesh_compliance(gear, mesh, model, grid, side)?);
    }
    calibration(gear, mesh.section.cell.cut_line(), model, mesh_m2_per_n)
}

/// The calibration of a tooth above a cut with W, as [`mesh_compliance`] gives it for each loaded flank, at hand.
///
/// # Errors
/// [`ReductionError`] when a section cannot be solved.
pub fn calibration(
    gear: &GearDefinition,
    cut: CutLine,
    model: &FeModel,
    mesh_m2_per_n: Vec<f64>,
) -> Result<NearField, ReductionError> {
    let module = gear.tooth.module_m;
    let half_width_m = HALF_WIDTH_IN_MODULES * module;
    let roll_angles_rad = places(gear);
    let problem = ContactProblem::new(gear, cut, *model.material());
    let (contact_m2_per_n, residual) = contact_at(&roll_angles_rad, module, |roll, grading| {
        problem.deflection(roll, half_width_m, grading)
    })?;
    Ok(NearField {
        half_width_m,
        roll_angles_rad,
        contact_m2_per_n,
        mesh_m2_per_n,
        element_m: grading(module, 1.0).smallest_m,
        residual,
    })
}

/// Deflections per line load \[m²/N\], `[load station][response station]`, from those of all loads of a flank in plane
/// strain, `[response][load]`: loads and means over the width.
pub(crate) fn line_compliance(grid: &FlankGrid, products: &[f64], width_m: f64) -> Vec<f64> {
    let (count, stations) = (grid.len(), grid.roll_angles_rad.len());
    let lines: Vec<_> = (0..stations).map(|i| line_load(grid, i)).collect();
    lines
        .iter()
        .flat_map(|load| {
            lines.iter().map(|response| {
                let sum: f64 = load
                    .iter()
                    .flat_map(|&(l, a)| response.iter().map(move |&(m, b)| (l, m, a * b)))
                    .map(|(l, m, share)| share * products[m * count + l])
                    .sum();
                // One newton over the width is a line load of 1/width.
                sum * width_m
            })
        })
        .collect()
}

/// The tooth of a gear's own cross-section, element and material, not twisted, for plane strain.
#[derive(Debug)]
pub struct PlaneTooth {
    /// One layer of the section; of tetrahedra, which are no stack of layers with one field, all of the tooth's width.
    pub mesh: GearMesh,
    /// Its model.
    pub model: FeModel,
    /// Stations along the axis that loads uniform over the width stand on \[m\].
    pub z_m: Vec<f64>,
}

impl PlaneTooth {
    /// That of a gear's mesh and model; `grid` has the stations along the axis.
    ///
    /// # Errors
    /// [`ReductionError`] for a section of no worth at all.
    pub fn new(
        gear: &GearDefinition,
        mesh: &GearMesh,
        model: &FeModel,
        grid: &FlankGrid,
    ) -> Result<Self, ReductionError> {
        if gear.mesh.element == Element::Tet10 {
            let mesh = mesh.straight_teeth();
            return Ok(Self {
                model: model_of(gear, &mesh)?,
                z_m: grid.z_m.clone(),
                mesh,
            });
        }
        // Plane strain does not know the thickness; one about as thick as the elements are long keeps them compact.
        let mesh = mesh.single_layer(gear.mesh.flank_m)?;
        let connectivity = mesh.elements.connectivity().to_vec();
        let material = *model.material();
        let element = model.element_of(0);
        Ok(Self {
            model: FeModel::from_connectivity(mesh.nodes.clone(), connectivity, material, element)?,
            z_m: mesh.layers.planes_m.clone(),
            mesh,
        })
    }
}

/// W = N₂ᵀK₂⁻¹N₂ \[m²/N\], `[load station][response station]`: the tooth-only submodel of the gear's own
/// cross-section and element in plane strain, loaded by its own hats along the profile, uniformly over the width, of
/// which the mean is taken (tetrahedra: docs/theory/imported_mesh.md).
///
/// # Errors
/// [`ReductionError::Fe`] when the submodel is not held.
pub fn mesh_compliance(
    gear: &GearDefinition,
    mesh: &GearMesh,
    model: &FeModel,
    grid: &FlankGrid,
    side: Flank,
) -> Result<Vec<f64>, ReductionError> {
    let plane = PlaneTooth::new(gear, mesh, model, grid)?;
    let width_m = plane.z_m[plane.z_m.len() - 1] - plane.z_m[0];
    let across = FlankGrid {
        z_m: plane.z_m,
        ..grid.clone()
    };
    let loads = flank_loads(gear, &plane.mesh, &across, 0, side);
    let deformation = Deformation::PlaneStrain;
    let submodel = ToothSubmodel::new(&plane.model, &plane.mesh, side, &loads, deformation)?;
    let products = submodel.products(&normals(&loads));
    Ok(line_compliance(&across, &products, width_m))
}
