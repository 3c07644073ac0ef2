//! A flank on whose element faces forces stand at single places, without a grid of hats: unit loads of a point, and of
//! a line that is uniform along the tooth.
//!
//! A place is put on the faces along the normal in its section, so that its height stays; on a helical flank the axial
//! part of a force is then moved by the distance to the face, some micrometres. The loads have the form of those of the
//! flank grid ([`crate::flank_loads`]), and everything that takes the ones takes the others: the factor of the body,
//! the tooth-only submodel, gauges. Each place needs a solution of its own, where the grid's are combined
//! (docs/theory/reduction.md, forces on single elements).

use crate::ReductionError;
use crate::face_projection::{FaceSurface, OffEveryFace, Projection};
use crate::flank_loads::{FlankFrames, GridLoad, SparseVector, normals};
use crate::near_field::PlaneTooth;
use crate::tooth_submodel::{Deformation, ToothSubmodel};
use crate::toothed_mesh::ToothedMesh;
use gearmesh_geometry::{Flank, GearDefinition, ProfileCurve};
use gearmesh_model::FlankGrid;
use std::collections::BTreeMap;

/// Gauss's rule with three points on -1 to 1: shape functions of second degree along a straight tooth are integrated
/// exactly, on a helical one to the fifth degree of the twist over an element.
const GAUSS: [(f64, f64); 3] = [
    (-0.774_596_669_241_483_4, 5.0 / 9.0),
    (0.0, 8.0 / 9.0),
    (0.774_596_669_241_483_4, 5.0 / 9.0),
];
/// Planes between layers that differ by less are one \[m\].
const SAME_PLANE_M: f64 = 1e-9;

/// One flank of one tooth in the faces of its elements.
#[derive(Debug, Clone)]
pub struct ProjectedFlank<'a> {
    frames: FlankFrames<'a>,
    surface: FaceSurface,
    /// Heights between which the faces lie, increasing.
    planes_m: Vec<f64>,
}

impl<'a> ProjectedFlank<'a> {
    /// Of a mesh with these nodes \[m\].
    pub fn new(
        gear: &'a GearDefinition,
        mesh: &impl ToothedMesh,
        nodes_m: &[[f64; 3]],
        (tooth, side): (usize, Flank),
    ) -> Self {
        let curve = ProfileCurve::new(&gear.profile);
        let faces = mesh.outline_faces(tooth, side, [curve.flank_start_m(), curve.flank_end_m()]);
        let mut planes_m: Vec<f64> = faces.iter().flat_map(|face| face.range_m(1)).collect();
        planes_m.sort_by(f64::total_cmp);
        planes_m.dedup_by(|b, a| *b - *a < SAME_PLANE_M);
        Self {
            frames: FlankFrames::new(gear, mesh, tooth, side),
            surface: FaceSurface::new(&faces, nodes_m),
            planes_m,
        }
    }

    /// The faces.
    pub fn surface(&self) -> &FaceSurface {
        &self.surface
    }

    /// The point of a face under a place, given by roll angle and height.
    ///
    /// # Errors
    /// [`OffEveryFace`] beside the flank.
    pub fn project(&self, roll_rad: f64, z_m: f64) -> Result<Projection, OffEveryFace> {
        let [[x, y, _], _, _] = self.frames.directions(roll_rad, z_m);
        let point_m = self.frames.point_m(roll_rad, z_m);
        self.surface.project(point_m, [x, y, 0.0])
    }

    /// Unit loads at a place.
    ///
    /// # Errors
    /// [`OffEveryFace`] beside the flank.
    pub fn point(&self, roll_rad: f64, z_m: f64) -> Result<GridLoad, OffEveryFace> {
        self.summed([(roll_rad, z_m, 1.0)])
    }

    /// Unit loads that are uniform over a stretch of height, each part of it at the roll angle of its height: a slice
    /// of a contact line. Force and moment are those of the line; where it passes from face to face within a layer of
    /// elements, their nodes have the shares of three points a layer.
    ///
    /// # Errors
    /// [`OffEveryFace`] where it goes on beside the flank.
    pub fn line(
        &self,
        [from, to]: [f64; 2],
        roll_rad: impl Fn(f64) -> f64,
    ) -> Result<GridLoad, OffEveryFace> {
        // In each layer of elements by itself: shape functions have kinks between them.
        let inner = self.planes_m.iter().filter(|z| (from..to).contains(z));
        let mut ends: Vec<f64> = [from, to].into_iter().chain(inner.copied()).collect();
        ends.sort_by(f64::total_cmp);
        let pieces = ends.windows(2).filter(|ends| ends[1] > ends[0]);
        self.summed(pieces.flat_map(|ends| {
            let (middle, half) = (0.5 * (ends[0] + ends[1]), 0.5 * (ends[1] - ends[0]));
            let roll = &roll_rad;
            GAUSS.map(|(at, weight)| {
                let z = middle + half * at;
                (roll(z), z, half * weight)
            })
        }))
    }

    /// Unit loads of the slices of a line at one roll angle, each uniform over its width: those that the grid's loads
    /// are combined to.
    ///
    /// # Errors
    /// [`OffEveryFace`] beside the flank.
    pub fn slices(&self, grid: &FlankGrid, roll_rad: f64) -> Result<Vec<GridLoad>, OffEveryFace> {
        let edge = |slice: usize| grid.z_m[2 * slice];
        (0..grid.slices)
            .map(|slice| self.line([edge(slice), edge(slice + 1)], |_| roll_rad))
            .collect()
    }

    /// Loads at places (roll angle, height, weight) as one of a newton.
    fn summed(
        &self,
        places: impl IntoIterator<Item = (f64, f64, f64)>,
    ) -> Result<GridLoad, OffEveryFace> {
        let mut parts: [BTreeMap<usize, f64>; 3] = Default::default();
        let mut sum = 0.0;
        for (roll_rad, z_m, weight) in places {
            let at = self.project(roll_rad, z_m)?;
            sum += weight;
            let directions = self.frames.directions(roll_rad, z_m);
            for (part, direction) in parts.iter_mut().zip(directions) {
                for (dof, value) in self.surface.load(&at, direction) {
                    *part.entry(dof).or_default() += weight * value;
                }
            }
        }
        Ok(GridLoad::of_unit((parts, sum)))
    }
}

/// w_p \[m²/N\]: deflection per line load of lines at some roll angles in plane strain, on the tooth-only submodel of
/// the gear's own section and element, read under the line itself. What [`crate::near_field::mesh_compliance`] is for
/// hats.
///
/// # Errors
/// [`ReductionError`] when the submodel is not held or a line lies beside the flank.
pub fn line_near_field(
    gear: &GearDefinition,
    plane: &PlaneTooth,
    side: Flank,
    rolls_rad: &[f64],
) -> Result<Vec<f64>, ReductionError> {
    let flank = ProjectedFlank::new(gear, &plane.mesh, &plane.mesh.nodes, (0, side));
    let ends = [plane.z_m[0], plane.z_m[plane.z_m.len() - 1]];
    let loads: Vec<GridLoad> = rolls_rad
        .iter()
        .map(|&roll| flank.line(ends, |_| roll))
        .collect::<Result<_, _>>()?;
    let (model, deformation) = (&plane.model, Deformation::PlaneStrain);
    let submodel = ToothSubmodel::new(model, &plane.mesh, side, &loads, deformation)?;
    let rows: Vec<&SparseVector> = normals(&loads);
    let products = submodel.products(&rows);
    let own = (0..loads.len()).map(|k| products[k * loads.len() + k] * (ends[1] - ends[0]));
    Ok(own.collect())
}
