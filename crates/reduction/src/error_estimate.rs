//! Discretisation error of the reduced compliance, on the loaded tooth and on others, and of the gauges, from coarser
//! meshes.
//!
//! Errors may have opposite senses: incompatible modes make coarse sections of teeth too soft; thick layers, and long
//! elements beside the sharp edges of webs and openings, are too stiff. A mesh that is coarser in all would show their
//! difference only. So a first mesh has longer elements in the teeth (by s = 1.5), a second one in the body and along
//! the axis, too, and the sizes of both changes are added:
//!
//! ```text
//! error = S (|fine − teeth| + |teeth − all|)/(s^p − 1)
//! ```
//!
//! Of bevel gears, whose bodies have no edges between web and rim, the first mesh has longer elements in the whole
//! section.
//!
//! Gauges: p = 2, as displacements of nodes have it and is found (1.7 to 3.7 in plane strain), over the loads that
//! strain them most, by RMS. Deflections: solid bodies converge with p = 2; at the sharp inner edges between web, rim
//! and hub p falls to 2λ = 1.09 (see `gearmesh_mesh::layers`), and p = 1 is taken. S is the factor of safety of
//! Roache's grid convergence index: 3 where two meshes tell nothing of the order, 1.25 where three have confirmed it.
//! Graded meshes are not similar to the last element: what is found against converged quadratic elements is up to 1.1
//! times the bare estimate of a gauge and of the loaded tooth's deflection, 2.7 times that of other teeth. So S = 2 for
//! gauges and the loaded tooth, 3 for other teeth, and for the loaded tooth over openings: sides at their corners are
//! as short on coarser meshes. Of two loaded teeth the errors of both are added, as if they had one sign. In plane
//! strain, and of tetrahedra, which have no layers along the axis, one coarser mesh tells all.
//!
//! P. J. Roache, *Perspective: a method for uniform reporting of grid refinement studies*, J. Fluids Eng. 116 (1994)
//! 405-413.

use crate::flank_loads::{GridLoad, SparseVector, flank_loads};
use crate::gauge_row::gauge_row;
use crate::gear_body::{GearBody, MeshedGear};
use crate::repeated_mesh::RepeatedMesh;
use crate::tooth_submodel::ToothSubmodel;
use crate::tooth_vectors::summed;
use crate::toothed_mesh::ToothParts;
use crate::{Progress, ReductionError, Within};
use gearmesh_geometry::{Blank, Element, Flank, GearDefinition, MeshSettings};
use gearmesh_model::{FlankGrid, GaugeRows, ReducedGear, ReductionChecks};

/// Ratio of the element lengths.
const COARSENING: f64 = 1.5;
/// Order of a solid body's deflections, and of a gauge's reading.
const SMOOTH: i32 = 2;
/// Order of the deflections of a body with sharp inner edges.
pub(crate) const WITH_EDGES: i32 = 1;
/// Factors of safety: of the loaded tooth's deflection and of gauges, and of the deflections of other teeth.
pub(crate) const SAFETY: f64 = 2.0;
const SAFETY_OF_OTHERS: f64 = 3.0;

/// Estimated relative errors.
pub struct ErrorEstimate {
    /// Of the deflection under a load over the whole width in the middle of tooth 0's flank, C_g.
    pub loaded_tooth: f64,
    /// Of C_hub at the same place of other teeth, the next two on either side and the opposite one: the root of the sum
    /// of the squares, over that of their deflections. A tooth that hardly moves counts little: no contact feels it.
    pub other_teeth: f64,
    /// Of the deflection of tooth 0 while it and the next one carry the same load: the errors of both loads' parts
    /// added.
    pub both_teeth: f64,
    /// Of each gauge's largest readings for loads on its own tooth.
    pub gauges: Vec<f64>,
}

impl ErrorEstimate {
    /// Writes the estimates among the checks and to the gauges.
    pub(crate) fn state(self, further: &mut Vec<(String, f64)>, gauges: &mut [GaugeRows]) {
        for (name, error) in [
            (ReductionChecks::LOADED_TOOTH_ERROR, self.loaded_tooth),
            (ReductionChecks::OTHER_TEETH_ERROR, self.other_teeth),
            (ReductionChecks::BOTH_TEETH_ERROR, self.both_teeth),
        ] {
            further.push((name.to_string(), error));
        }
        for (gauge, error) in gauges.iter_mut().zip(self.gauges) {
            gauge.error_estimate_relative = error;
        }
    }
}

/// What the estimate compares of one mesh.
pub(crate) struct Figures {
    /// Deflection of tooth 0 under its own load, then of the others that are looked at.
    deflections: Vec<f64>,
    /// Of each gauge its reading for loads over the whole width, station by station.
    gauges: Vec<Vec<f64>>,
}

/// Teeth whose deflection is looked at, tooth 0 loaded.
fn teeth_looked_at(teeth: usize) -> [usize; 6] {
    [0, 1, teeth - 1, 2, teeth - 2, teeth / 2]
}

/// Which elements of a coarser mesh are longer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Longer {
    /// In the section of the teeth.
    Teeth,
    /// In that of the body, too.
    Section,
    /// Along the axis, too.
    All,
}

/// The same mesh with longer elements.
pub(crate) fn coarsened(mesh: &MeshSettings, longer: Longer) -> MeshSettings {
    let from = |least: Longer| if longer >= least { COARSENING } else { 1.0 };
    MeshSettings {
        flank_m: COARSENING * mesh.flank_m,
        fillet_m: COARSENING * mesh.fillet_m,
        body_m: from(Longer::Section) * mesh.body_m,
        axial_m: from(Longer::All) * mesh.axial_m,
        // Judged by the fine mesh; the coarse ones only serve to estimate.
        min_scaled_jacobian: 0.05,
        ..*mesh
    }
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

/// What a mesh is asked: loads on one flank of tooth 0, and the teeth that have gauges.
pub(crate) struct Asked<'a> {
    /// Where loads stand.
    pub(crate) grid: &'a FlankGrid,
    /// The loaded flank.
    pub(crate) side: Flank,
    /// Tooth of each gauge.
    pub(crate) gauge_teeth: Vec<usize>,
}

/// Figures of the coarser meshes, from the finest to the coarsest.
///
/// They are made before the reduction's own mesh is factorised: factors of two meshes never stand in memory side by
/// side.
pub struct CoarserMeshes {
    figures: Vec<Figures>,
    /// Order with which deflections of the body converge.
    order: i32,
    /// Factor of safety of the loaded tooth's deflection.
    safety: f64,
}

/// A cylindrical gear with the meshes that the estimate solves, from the finest to the coarsest.
pub(crate) fn coarser_gears(gear: &GearDefinition) -> Vec<GearDefinition> {
    let one_step = gear.mesh.plane_strain || gear.mesh.element == Element::Tet10;
    let steps: &[Longer] = if one_step {
        &[Longer::All]
    } else {
        &[Longer::Teeth, Longer::All]
    };
    let coarser = steps.iter().map(|&longer| GearDefinition {
        // The estimate is that of the sound gear.
        crack: None,
        mesh: coarsened(&gear.mesh, longer),
        ..gear.clone()
    });
    coarser.collect()
}

/// Solves the coarser meshes of a cylindrical gear, those of [`coarser_gears`].
///
/// # Errors
/// [`ReductionError`] when a coarse mesh cannot be solved.
pub(crate) fn coarser_meshes(
    gear: &GearDefinition,
    coarser: Vec<(GearDefinition, MeshedGear)>,
    grid: &FlankGrid,
    progress: &dyn Progress,
) -> Result<CoarserMeshes, ReductionError> {
    let asked = Asked {
        grid,
        side: gear.reduction.flanks[0],
        gauge_teeth: gear.gauges.iter().map(|gauge| gauge.tooth).collect(),
    };
    let order = match gear.blank {
        Blank::Solid { openings: None, .. } => SMOOTH,
        _ => WITH_EDGES,
    };
    let safety = match gear.blank.openings() {
        None => SAFETY,
        Some(_) => SAFETY_OF_OTHERS,
    };
    let figures = |(coarse, meshed): (GearDefinition, MeshedGear), progress: &dyn Progress| {
        let body = meshed.held(&coarse, progress)?;
        let loads = flank_loads(&coarse, &body.mesh, grid, 0, asked.side);
        let rows = (coarse.gauges.iter())
            .map(|gauge| gauge_row(&coarse, &body.mesh, &body.model, gauge, gauge.tooth))
            .collect::<Result<_, _>>()?;
        mesh_figures(&asked, &body, (&loads, rows), progress)
    };
    each_mesh(coarser, (order, safety), progress, figures)
}

/// One mesh after the other, from the finest to the coarsest.
pub(crate) fn each_mesh<T>(
    coarser: Vec<T>,
    (order, safety): (i32, f64),
    progress: &dyn Progress,
    mut figures_of: impl FnMut(T, &dyn Progress) -> Result<Figures, ReductionError>,
) -> Result<CoarserMeshes, ReductionError> {
    let count = coarser.len();
    let figures = coarser.into_iter().enumerate().map(|(k, coarse)| {
        let progress = Within {
            all: progress,
            part: format!("error estimate, coarser mesh {} of {count}", k + 1),
        };
        figures_of(coarse, &progress)
    });
    Ok(CoarserMeshes {
        figures: figures.collect::<Result<_, _>>()?,
        order,
        safety,
    })
}

impl CoarserMeshes {
    /// Estimates the errors of a reduction on a flank grid from what the coarser meshes differ by.
    pub fn errors_of(self, reduced: &ReducedGear, grid: &FlankGrid) -> ErrorEstimate {
        let mut meshes = self.figures;
        meshes.insert(0, reduced_figures(reduced, grid));
        let norm = |v: &[f64]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
        let error = |(order, safety): (i32, f64), values: &dyn Fn(&Figures) -> Vec<f64>| -> f64 {
            let all: Vec<Vec<f64>> = meshes.iter().map(values).collect();
            let steps = all.windows(2).map(|pair| {
                let difference: Vec<f64> =
                    pair[0].iter().zip(&pair[1]).map(|(a, b)| a - b).collect();
                norm(&difference)
            });
            safety * steps.sum::<f64>() / (COARSENING.powi(order) - 1.0) / norm(&all[0])
        };
        let of_others = (self.order, SAFETY_OF_OTHERS);
        let loaded_tooth = error((self.order, self.safety), &|figures| {
            vec![figures.deflections[0]]
        });
        let next_tooth = error(of_others, &|figures| vec![figures.deflections[1]]);
        let [own, next] = [0, 1].map(|tooth: usize| meshes[0].deflections[tooth]);
        ErrorEstimate {
            loaded_tooth,
            other_teeth: error(of_others, &|figures| figures.deflections[1..].to_vec()),
            both_teeth: (loaded_tooth * own + next_tooth * next.abs()) / (own + next),
            gauges: (0..reduced.gauges.len())
                .map(|k| {
                    let kept = large_readings(&meshes[0].gauges[k]);
                    error((SMOOTH, SAFETY), &|figures| {
                        kept.iter().map(|&at| figures.gauges[k][at]).collect()
                    })
                })
                .collect(),
        }
    }
}

/// Stations whose loads make a gauge read at least half of its largest reading. What people read, the range of a
/// strain, is made there; loads beside a gauge strain it little, and their readings err most.
fn large_readings(readings: &[f64]) -> Vec<usize> {
    let largest = readings.iter().fold(0.0f64, |most, x| most.max(x.abs()));
    let is_large = |at: &usize| readings[*at].abs() >= 0.5 * largest;
    (0..readings.len()).filter(is_large).collect()
}

/// The figures of the reduction; the estimate looks at the first of the flanks that carry loads.
fn reduced_figures(reduced: &ReducedGear, grid: &FlankGrid) -> Figures {
    let count = grid.len();
    let weights = line_load(grid, grid.roll_angles_rad.len() / 2);
    // Rows of C_hub are [tooth][flank of the response][load][response]; those of the first flank are asked for.
    let flanks = reduced.flanks.len();
    let deflection = |tooth: usize| {
        let block = &reduced.c_hub[tooth * flanks * count * count..][..count * count];
        let mut value = compliance_of(&weights, |l, m| block[l * count + m]);
        if tooth == 0 {
            value -= compliance_of(&weights, |l, m| reduced.c_tooth[l * count + m]);
        }
        value
    };
    let of_gauge = |gauge: &GaugeRows| {
        let first = gauge.tooth * flanks * count;
        by_station(grid, |load| gauge.adjoint[3 * (first + load)])
    };
    Figures {
        deflections: teeth_looked_at(reduced.teeth).map(deflection).to_vec(),
        gauges: reduced.gauges.iter().map(of_gauge).collect(),
    }
}

/// The same of another mesh; `loads` on the first flank of tooth 0, and the gauges' rows.
pub(crate) fn mesh_figures<M: RepeatedMesh + ToothParts>(
    asked: &Asked<'_>,
    body: &GearBody<M>,
    (loads, gauge_rows): (&[GridLoad], Vec<SparseVector>),
    progress: &dyn Progress,
) -> Result<Figures, ReductionError> {
    progress.stage("solving");
    let (grid, count) = (asked.grid, asked.grid.len());
    let (model, mesh) = (&body.model, &body.mesh);
    let submodel = ToothSubmodel::new(model, mesh, asked.side, loads, body.deformation)?;
    let weights = line_load(grid, grid.roll_angles_rad.len() / 2);
    let shares = weights.iter().flat_map(|&(load, share)| {
        let normal = &loads[load].normal;
        normal.iter().map(move |&(dof, value)| (dof, share * value))
    });
    let line = summed(shares.collect());
    let normals: Vec<&SparseVector> = loads.iter().map(|l| &l.normal).collect();
    let w = submodel.products(&normals);
    let rows: Vec<&SparseVector> = std::iter::once(&line).chain(&gauge_rows).collect();
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
    let teeth = asked.gauge_teeth.iter().copied().enumerate();
    Ok(Figures {
        deflections: teeth_looked_at(body.mesh.teeth()).map(deflection).to_vec(),
        gauges: teeth.map(of_gauge).collect(),
    })
}
