//! The calibration of a bevel tooth's near field, in sections normal to the tooth.
//!
//! A contact line of a bevel flank runs nearly along the tooth; what a load on it does close by is a plane problem in
//! the section across it. Both halves of the calibration are made there as for cylindrical gears: c₀ on a fine section
//! with the true outlines, W on the tooth's own mesh seen along the tooth (`BevelSection`), under its own hats. The
//! tooth tapers, so that there are several sections along it.

use faer::Mat;
use gearmesh_bevel::{BevelGear, FlankPatch};
use gearmesh_fe::{Factor, Material, assemble_stiffness};
use gearmesh_geometry::Flank;
use gearmesh_geometry::profile_curve::distance_to_line_m;
use gearmesh_mesh::BevelSection;
use gearmesh_mesh::contact_section::{ContactGrading, ContactSection, ToothEdges};
use gearmesh_model::{BevelNearField, FlankGrid, SmoothCurve};
use nalgebra::Vector3;

use super::loads::{area_m2, shares_of};
use crate::ReductionError;
use crate::contact_problem::{ContactProblem, LoadedProfile};
use crate::face_overlap::overlap_points;
use crate::flank_loads::overlapping;
use crate::gear_body::solid_model;
use crate::near_field::{HALF_WIDTH_IN_MODULES, contact_at, edge_distances_m, grading};
use crate::tooth_submodel::Deformation;

/// Places of the sections, as shares of the way from toe to heel.
const SECTIONS: [f64; 3] = [0.1, 0.5, 0.9];

/// One flank in one normal section, turned over for left flanks so that the loaded one is the right one.
struct SectionProfile {
    loaded: SmoothLine,
    opposite: SmoothLine,
    cut: Vec<[f64; 2]>,
    root: [[f64; 2]; 2],
    /// u of the points of the loaded line, by arc length.
    shares: Vec<f64>,
    /// Arc length of the flank's lower line and of its tip.
    ends_m: [f64; 2],
}

impl SectionProfile {
    fn new(section: &BevelSection, patch: &FlankPatch, side: Flank) -> Self {
        let (own, other, sign) = match side {
            Flank::Right => (0, 1, 1.0),
            Flank::Left => (1, 0, -1.0),
        };
        let turned = |p: &[f64; 2]| [p[0], sign * p[1]];
        let line = |k: usize| SmoothLine::new(section.outline_m[k].iter().map(turned).collect());
        let mut cut: Vec<[f64; 2]> = section.cut_m.iter().map(turned).collect();
        if side == Flank::Left {
            cut.reverse();
        }
        let heights = &section.heights_m[own];
        let shares: Vec<f64> = heights
            .iter()
            .map(|height| shares_of(patch, section.cone_m, *height)[0])
            .collect();
        let loaded = line(own);
        let (_, end) = loaded.end();
        let mut profile = Self {
            loaded,
            opposite: line(other),
            cut,
            root: [own, other].map(|k| turned(&section.roots_m[k])),
            shares,
            ends_m: [0.0, end],
        };
        profile.ends_m[0] = profile.arc_at(0.0);
        profile
    }

    /// Arc length of a share u.
    fn arc_at(&self, u: f64) -> f64 {
        let (x, y) = (&self.shares, &self.loaded.arcs);
        let k = x.partition_point(|x| *x < u).clamp(1, x.len() - 1);
        let t = (u - x[k - 1]) / (x[k] - x[k - 1]);
        y[k - 1] + t.clamp(0.0, 1.0) * (y[k] - y[k - 1])
    }

    /// Distance along the normal at a share to the opposite side, or to the line between the roots.
    fn opposite_distance_m(&self, u: f64) -> f64 {
        let arc = self.arc_at(u);
        let (p, n) = (self.loaded.at(arc)[0], self.normal(arc));
        let mut line = vec![self.root[0], self.root[1]];
        line.extend(&self.opposite.points);
        let best = distance_to_line_m(p, n, &line);
        if best.is_finite() {
            best
        } else {
            let (q, _) = self.opposite.end();
            (q[0] - p[0]).hypot(q[1] - p[1])
        }
    }
}

impl LoadedProfile for SectionProfile {
    fn section(&self, centre_arc_m: f64, grading: ContactGrading) -> ContactSection {
        let ((right, tip), (left, over)) = (self.loaded.end(), self.opposite.end());
        let edges = ToothEdges {
            loaded: &|arc| self.loaded.at(arc)[0],
            opposite: &|share| self.opposite.at(share * over)[0],
            tip: &|share| [0, 1].map(|axis| right[axis] + share * (left[axis] - right[axis])),
            cut: &self.cut,
            marks_m: [0.0, self.ends_m[0], tip, tip],
        };
        ContactSection::of_edges(&edges, centre_arc_m, grading)
    }

    fn normal(&self, arc_m: f64) -> [f64; 2] {
        let [_, t] = self.loaded.at(arc_m);
        // Outwards along the loaded outline the tooth lies counter-clockwise.
        let length = t[0].hypot(t[1]);
        [-t[1] / length, t[0] / length]
    }

    fn flank_ends_m(&self) -> [f64; 2] {
        self.ends_m
    }
}

/// A smooth line through points by its arc length.
struct SmoothLine {
    points: Vec<[f64; 2]>,
    arcs: Vec<f64>,
    coordinates: [SmoothCurve; 2],
}

impl SmoothLine {
    fn new(points: Vec<[f64; 2]>) -> Self {
        let mut arcs = vec![0.0];
        for pair in points.windows(2) {
            let step = (pair[1][0] - pair[0][0]).hypot(pair[1][1] - pair[0][1]);
            arcs.push(arcs[arcs.len() - 1] + step);
        }
        let coordinates = [0, 1].map(|axis| {
            let values = points.iter().map(|point| point[axis]).collect();
            SmoothCurve::new(arcs.clone(), values)
        });
        Self {
            points,
            arcs,
            coordinates,
        }
    }

    /// Point and slope at an arc length.
    fn at(&self, arc: f64) -> [[f64; 2]; 2] {
        let of_axis = self.coordinates.each_ref().map(|curve| curve.at(arc));
        [0, 1].map(|kind| of_axis.map(|both| both[kind]))
    }

    /// Its end and the arc length there.
    fn end(&self) -> ([f64; 2], f64) {
        let arc = self.arcs[self.arcs.len() - 1];
        (self.at(arc)[0], arc)
    }
}

/// Distances along the normal to the opposite side \[m\] at shares up the flanks, flank by flank, in the section at a
/// share of the face.
///
/// # Errors
/// [`ReductionError::Mesh`] where the tool leaves no surface.
pub fn opposite_distances_m(
    gear: &BevelGear,
    patches: &[FlankPatch],
    shares: &[f64],
    along: f64,
) -> Result<Vec<Vec<f64>>, ReductionError> {
    let section = BevelSection::new(gear, along)?;
    let flanks = gear.reduction.flanks.iter().zip(patches);
    Ok(flanks
        .map(|(&side, patch)| {
            let profile = SectionProfile::new(&section, patch, side);
            let distance = |u: &f64| profile.opposite_distance_m(*u);
            shares.iter().map(distance).collect()
        })
        .collect())
}

/// Calibrates the flanks of a tooth.
///
/// # Errors
/// [`ReductionError`] when a section cannot be made or solved.
pub fn section_fields(
    gear: &BevelGear,
    patches: &[FlankPatch],
    grid: &FlankGrid,
) -> Result<BevelNearField, ReductionError> {
    let module = gear.mean_module_m();
    let half_width_m = HALF_WIDTH_IN_MODULES * module;
    let material = Material::new(gear.material.young_pa, gear.material.poisson)?;
    let sections: Vec<BevelSection> = SECTIONS
        .iter()
        .map(|along| BevelSection::new(gear, *along))
        .collect::<Result<_, _>>()?;
    let mut profiles = Vec::new();
    for (&side, patch) in gear.reduction.flanks.iter().zip(patches) {
        for section in &sections {
            let profile = SectionProfile::new(section, patch, side);
            profiles.push((section, patch, side, profile));
        }
    }
    let length = |p: &SectionProfile| p.ends_m[1] - p.ends_m[0];
    let mean = profiles.iter().map(|p| length(&p.3)).sum::<f64>() / profiles.len() as f64;
    // The same places on all flanks and sections, at distances from the edge that fit the mean one.
    let distances = edge_distances_m(mean, module);
    let mut profile: Vec<f64> = distances.iter().rev().map(|d| 1.0 - d / mean).collect();
    let last = profile.len() - 1;
    (profile[0], profile[last]) = (0.0, 1.0);

    let mut field = BevelNearField {
        half_width_m,
        sections_m: SECTIONS
            .iter()
            .map(|s| (s - 0.5) * gear.blank().face_width_m)
            .collect(),
        profile: profile.clone(),
        profile_length_m: profiles.iter().map(|p| length(&p.3)).collect(),
        element_m: grading(module, 1.0).smallest_m,
        ..BevelNearField::default()
    };
    for (section, patch, side, profile) in profiles {
        let distances = grid.roll_angles_rad.iter();
        field
            .opposite_distance_m
            .extend(distances.map(|u| profile.opposite_distance_m(*u)));
        let plane = mesh_compliance(gear, section, patch, side, grid)?;
        field.mesh_m2_per_n.extend(plane);
        let arcs: Vec<f64> = field.profile.iter().map(|u| profile.arc_at(*u)).collect();
        let problem = ContactProblem::of_profile(profile, material);
        let (contact, residual) = contact_at(&arcs, module, |arc, grading| {
            problem.deflection_at(arc, half_width_m, grading)
        })?;
        field.residual = field.residual.max(residual);
        field.contact_m2_per_n.extend(contact);
    }
    Ok(field)
}

/// W \[m²/N\], `[load station][response station]`: the tooth's own section, element and hats in plane strain.
fn mesh_compliance(
    gear: &BevelGear,
    section: &BevelSection,
    patch: &FlankPatch,
    side: Flank,
    grid: &FlankGrid,
) -> Result<Vec<f64>, ReductionError> {
    // Plane strain does not know the thickness; one about as thick as the elements are long keeps them compact.
    let thickness = gear.mesh.flank_m;
    let layer = section.layer(side, thickness);
    let (material, element) = (&gear.material, gear.mesh.element);
    let model = solid_model(layer.nodes, &layer.elements, material, element)?;
    let us = &grid.roll_angles_rad;
    let stations = us.len();
    let [x, y] = section.axes.map(Vector3::from);
    let mut loads = vec![vec![0.0; 3 * model.node_count()]; stations];
    let mut sums = vec![0.0; stations];
    for mut face in layer.faces {
        let mut s = 0.0;
        for place in &mut face.places_m {
            let [u, along] = shares_of(patch, section.cone_m, place[0]);
            (place[0], s) = (u, along);
        }
        for i in overlapping(us, face.range_m(0)) {
            for point in overlap_points(&face, [us[i], us[i + 1]], [0.0, 1.0]) {
                let u = point.place_m[0];
                let at = [s, u];
                let n = patch.point(at).n;
                let n = [n.dot(&x), n.dot(&y)];
                let size = n[0].hypot(n[1]);
                let share = (u - us[i]) / (us[i + 1] - us[i]);
                for (station, hat) in [(i, 1.0 - share), (i + 1, share)] {
                    let weight = point.area_m2 * area_m2(patch, at) * hat;
                    sums[station] += weight;
                    for (node, shape) in face.nodes.iter().zip(face.shape.shapes(point.natural)) {
                        for axis in 0..2 {
                            loads[station][3 * *node as usize + axis] +=
                                weight * shape[0] * n[axis] / size;
                        }
                    }
                }
            }
        }
    }
    let dofs = Deformation::PlaneStrain.dofs(model.node_count(), &layer.held)?;
    let stiffness = assemble_stiffness(&model, &dofs)?;
    let factor = Factor::of_model(&model, &dofs, &stiffness)?;
    let at = |free: usize, station: usize| loads[station][dofs.full_of(free)] / sums[station];
    let forces = Mat::from_fn(dofs.free_count(), stations, at);
    let mut u = forces.clone();
    factor.solve_in_place(u.as_mut());
    let products = forces.transpose() * &u;
    // One newton over the thickness is a line load of 1/thickness.
    Ok((0..stations * stations)
        .map(|k| thickness * products[(k / stations, k % stations)])
        .collect())
}
