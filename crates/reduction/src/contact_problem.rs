//! The tooth above the cut under a Hertz pressure, in plane strain, on a finely graded section.

use crate::ReductionError;
use faer::Mat;
use faer::sparse::Triplet;
use gearmesh_fe::{DofOrdering, Element, Factor, FeError, FeModel, Material, StiffnessMatrix};
use gearmesh_geometry::{Flank, GearDefinition, ProfileCurve};
use gearmesh_mesh::CutLine;
use gearmesh_mesh::contact_section::{ContactGrading, ContactSection};
use std::f64::consts::FRAC_PI_2;

/// Gauss's two-point rule on \[0, 1\].
const GAUSS: [f64; 2] = [0.211_324_865_405_187_1, 0.788_675_134_594_812_9];

/// What the problem asks of a tooth's profile; places are arc lengths along the loaded outline.
pub trait LoadedProfile: Sync {
    /// The tooth meshed for a load at a place.
    fn section(&self, centre_arc_m: f64, grading: ContactGrading) -> ContactSection;

    /// Unit normal of the loaded flank, into the material.
    fn normal(&self, arc_m: f64) -> [f64; 2];

    /// Where the flank begins and ends.
    fn flank_ends_m(&self) -> [f64; 2];
}

/// The right flank of an involute tooth.
pub struct InvoluteProfile<'a> {
    gear: &'a GearDefinition,
    cut: CutLine,
    curve: ProfileCurve,
}

impl LoadedProfile for InvoluteProfile<'_> {
    fn section(&self, centre_arc_m: f64, grading: ContactGrading) -> ContactSection {
        ContactSection::new(
            &self.gear.profile,
            &self.curve,
            &self.cut,
            centre_arc_m,
            grading,
        )
    }

    fn normal(&self, arc_m: f64) -> [f64; 2] {
        let profile = &self.gear.profile;
        let (xi, start) = (profile.form_roll_rad, self.curve.flank_start_m());
        let on_flank = (arc_m - start).max(0.0);
        profile
            .flank_frame(Flank::Right, profile.roll_from_rad(xi, on_flank))
            .0
    }

    fn flank_ends_m(&self) -> [f64; 2] {
        [self.curve.flank_start_m(), self.curve.flank_end_m()]
    }
}

/// The tooth above the cut under a Hertz pressure on its right flank, in plane strain.
pub struct ContactProblem<P> {
    profile: P,
    material: Material,
}

impl<'a> ContactProblem<InvoluteProfile<'a>> {
    /// The problem of a gear's tooth above a cut.
    pub fn new(gear: &'a GearDefinition, cut: CutLine, material: Material) -> Self {
        let curve = ProfileCurve::new(&gear.profile);
        Self::of_profile(InvoluteProfile { gear, cut, curve }, material)
    }

    /// As [`Self::deflection_at`], the pressure's centre given by its roll angle.
    ///
    /// # Errors
    /// [`ReductionError::Fe`] when the section is not held.
    pub fn deflection(
        &self,
        roll_rad: f64,
        half_width_m: f64,
        grading: ContactGrading,
    ) -> Result<f64, ReductionError> {
        let arc_m = self.profile.curve.arc_length_at_roll_m(roll_rad);
        self.deflection_at(arc_m, half_width_m, grading)
    }
}

impl<P: LoadedProfile> ContactProblem<P> {
    /// The problem of any profile.
    pub fn of_profile(profile: P, material: Material) -> Self {
        Self { profile, material }
    }

    /// c₀ \[m²/N\]: displacement of the contact centre along the inward normal per line load, under a Hertz pressure of
    /// half width `half_width_m` centred at an arc length. Where the flank ends within the half width, the pressure is
    /// cut off there and its resultant kept.
    ///
    /// # Errors
    /// [`ReductionError::Fe`] when the section is not held.
    pub fn deflection_at(
        &self,
        arc_m: f64,
        half_width_m: f64,
        grading: ContactGrading,
    ) -> Result<f64, ReductionError> {
        let section = self.profile.section(arc_m, grading);
        let held = Held::new(section.nodes.len(), &section.held);
        let factor = Factor::new(
            &self.stiffness(&section, &held)?,
            // Columns of the block are short: numbered as they are, the matrix has a narrow band.
            DofOrdering::natural(held.free_count),
        )?;
        let mut u = Mat::<f64>::zeros(held.free_count, 1);
        for (node, force) in self.pressure(&section, half_width_m) {
            for (axis, component) in force.into_iter().enumerate() {
                if let Some(free) = held.free_of[2 * node + axis] {
                    u[(free, 0)] += component;
                }
            }
        }
        factor.solve_in_place(u.as_mut());
        let centre = section.outline[section.centre];
        let normal = self.profile.normal(arc_m);
        Ok((0..2)
            .filter_map(|axis| held.free_of[2 * centre + axis].map(|free| (axis, free)))
            .map(|(axis, free)| normal[axis] * u[(free, 0)])
            .sum())
    }

    /// Plane-strain stiffness per width over the free degrees of freedom: that of hexahedra one unit thick whose
    /// nodes do not move along the axis, and in the plane alike on both faces.
    fn stiffness(
        &self,
        section: &ContactSection,
        held: &Held,
    ) -> Result<StiffnessMatrix, ReductionError> {
        let count = section.nodes.len();
        // As thick as the smallest element; the result per width does not depend on it.
        let thickness = section.smallest_m;
        let nodes = [-0.5 * thickness, 0.5 * thickness]
            .into_iter()
            .flat_map(|z| section.nodes.iter().map(move |p| [p[0], p[1], z]))
            .collect();
        let hexes: Vec<[u32; 8]> = section
            .quads
            .iter()
            .map(|q| std::array::from_fn(|i| (q[i % 4] + count * (i / 4)) as u32))
            .collect();
        let model = FeModel::new(nodes, hexes, self.material, Element::Hex8Incompatible)?;
        let mut entries = Vec::with_capacity(64 * section.quads.len());
        for (element, quad) in section.quads.iter().enumerate() {
            let k = model.element_stiffness(element)?;
            for (row, column) in (0..8).flat_map(|r| (0..8).map(move |c| (r, c))) {
                let free = |i: usize| held.free_of[2 * quad[i / 2] + i % 2];
                let (Some(i), Some(j)) = (free(row), free(column)) else {
                    continue;
                };
                // Rows and columns of the lower and of the upper face, 12 apart, are summed.
                let (r, c) = (3 * (row / 2) + row % 2, 3 * (column / 2) + column % 2);
                let sum = k[(r, c)] + k[(r + 12, c)] + k[(r, c + 12)] + k[(r + 12, c + 12)];
                entries.push(Triplet::new(i, j, sum / thickness));
            }
        }
        StiffnessMatrix::try_new_from_triplets(held.free_count, held.free_count, &entries).map_err(
            |_| {
                ReductionError::Fe(FeError::OutOfMemory {
                    bytes: size_of_val(entries.as_slice()),
                })
            },
        )
    }

    /// Consistent nodal forces per width of a Hertz pressure with unit resultant. With s = s_c + a sin θ the integrand
    /// p ds = (2/π) cos²θ dθ is smooth.
    fn pressure(&self, section: &ContactSection, half_width_m: f64) -> Vec<(usize, [f64; 2])> {
        let end = self.profile.flank_ends_m()[1];
        let centre = section.outline_arc_m[section.centre];
        let angle = |s: f64| {
            ((s - centre) / half_width_m)
                .clamp(-1.0, 1.0)
                .asin()
                .clamp(-FRAC_PI_2, FRAC_PI_2)
        };
        let mut forces = Vec::new();
        let mut total = 0.0;
        for (nodes, arcs) in section
            .outline
            .windows(2)
            .zip(section.outline_arc_m.windows(2))
        {
            let (from, to) = (angle(arcs[0]), angle(arcs[1].min(end)));
            if to <= from {
                continue;
            }
            let mut ends = [[0.0; 2]; 2];
            for share in GAUSS {
                let theta = from + share * (to - from);
                let s = centre + half_width_m * theta.sin();
                let load = 0.5 * (to - from) * theta.cos().powi(2);
                total += load;
                let upper = ((s - arcs[0]) / (arcs[1] - arcs[0])).clamp(0.0, 1.0);
                let normal = self.profile.normal(s);
                for (force, shape) in ends.iter_mut().zip([1.0 - upper, upper]) {
                    for axis in 0..2 {
                        force[axis] += load * shape * normal[axis];
                    }
                }
            }
            forces.extend(nodes.iter().copied().zip(ends));
        }
        for (_, force) in &mut forces {
            for component in force {
                *component /= total;
            }
        }
        forces
    }
}

/// Free degrees of freedom of a plane problem, two per node.
struct Held {
    free_of: Vec<Option<usize>>,
    free_count: usize,
}

impl Held {
    fn new(node_count: usize, held: &[usize]) -> Self {
        let mut is_free = vec![true; 2 * node_count];
        for &node in held {
            is_free[2 * node] = false;
            is_free[2 * node + 1] = false;
        }
        let mut free_count = 0;
        let free_of = is_free
            .into_iter()
            .map(|free| {
                free.then(|| {
                    free_count += 1;
                    free_count - 1
                })
            })
            .collect();
        Self {
            free_of,
            free_count,
        }
    }
}
