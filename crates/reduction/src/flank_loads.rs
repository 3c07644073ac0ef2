//! Unit loads on a flank, spread by hat functions over a grid of roll stations and axial stations.
//!
//! Load (i, j) is the traction h_i(ξ) h_j(z) d(ξ), scaled to a total of one newton, on the flank surface; d is the
//! inward normal, the profile tangent towards the tip, or +z. Consistent nodal loads: ∫ N_a h_i h_j d dA with the shape
//! functions of the element faces. The integral is split at the stations, so that in each piece Gauss's rule is exact
//! up to the curvature of the involute.
//!
//! Helical teeth: the section at z is turned by the mesh's twist, and the inward normal has an axial component,
//! n = cos β_b n_t ∓ sin β_b e_z (− on right flanks of a right-hand gear). The profile tangent stays in the section.
//! The flank's area grows by the same factor 1/cos β_b everywhere and drops out of the unit loads.

use crate::face_overlap::overlap_points;
use crate::toothed_mesh::ToothedMesh;
use gearmesh_geometry::{Flank, GearDefinition, ProfileCurve, ToothGeometry};
use gearmesh_mesh::OutlineFace;
use gearmesh_model::FlankGrid;
use std::collections::BTreeMap;
use std::f64::consts::TAU;

/// A sparse load or row: (degree of freedom, weight), by increasing degree of freedom.
pub type SparseVector = Vec<(usize, f64)>;

/// The three unit loads of one grid point, or of another place on a flank.
#[derive(Debug, Clone, PartialEq)]
pub struct GridLoad {
    /// Along the inward normal.
    pub normal: SparseVector,
    /// Along the profile towards the tip.
    pub tangential: SparseVector,
    /// Along +z.
    pub axial: SparseVector,
}

impl GridLoad {
    /// Of forces along the three directions whose common weight has this sum: one newton each.
    pub(crate) fn of_unit((directions, sum): ([BTreeMap<usize, f64>; 3], f64)) -> Self {
        let [normal, tangential, axial] = directions.map(|map| {
            map.into_iter()
                .map(|(dof, value)| (dof, value / sum))
                .collect()
        });
        Self {
            normal,
            tangential,
            axial,
        }
    }
}

/// The flank grid of a gear: roll stations evenly over the flank, from the form circle to its end, of a ring from its
/// end to the form circle; axial stations at the edges and middles of the slices.
pub fn flank_grid(gear: &GearDefinition) -> FlankGrid {
    let profile = &gear.profile;
    let n = gear.reduction.roll_stations - 1;
    let [first, last] = profile.flank_rolls_rad();
    let slices = gear.reduction.slices;
    let width = gear.tooth.face_width_m;
    FlankGrid {
        roll_angles_rad: (0..=n)
            .map(|i| first + (last - first) * i as f64 / n as f64)
            .collect(),
        z_m: (0..=2 * slices)
            .map(|j| width * (j as f64 / (2 * slices) as f64 - 0.5))
            .collect(),
        slices,
    }
}

/// Numbers i of the intervals between stations i and i + 1, which grow or fall, that overlap a range.
pub(crate) fn overlapping(stations: &[f64], range: [f64; 2]) -> impl Iterator<Item = usize> {
    (0..stations.len() - 1).filter(move |&i| {
        let [low, high] = ordered([stations[i], stations[i + 1]]);
        low < range[1] && high > range[0]
    })
}

fn ordered([a, b]: [f64; 2]) -> [f64; 2] {
    [a.min(b), a.max(b)]
}

/// All unit loads on one flank of one tooth, numbered as [`FlankGrid::load`].
pub fn flank_loads(
    gear: &GearDefinition,
    mesh: &impl ToothedMesh,
    grid: &FlankGrid,
    tooth: usize,
    side: Flank,
) -> Vec<GridLoad> {
    let profile = &gear.profile;
    let curve = ProfileCurve::new(profile);
    let (start, end) = (curve.flank_start_m(), curve.flank_end_m());
    let roll_at = |s: f64| profile.roll_from_rad(profile.form_roll_rad, s - start);
    let station_arcs: Vec<f64> = grid
        .roll_angles_rad
        .iter()
        .map(|&xi| curve.arc_length_at_roll_m(xi))
        .collect();
    let frames = FlankFrames::new(gear, mesh, tooth, side);

    let [xi, z] = [&grid.roll_angles_rad, &grid.z_m];
    let faces = mesh.outline_faces(tooth, side, [start, end]);
    grid_loads(&faces, grid, [&station_arcs, z], |[arc, height], [i, j]| {
        let roll = roll_at(arc);
        HatLoad {
            shares: [
                (roll - xi[i]) / (xi[i + 1] - xi[i]),
                (height - z[j]) / (z[j + 1] - z[j]),
            ],
            density: 1.0,
            directions: frames.directions(roll, height),
        }
    })
}

/// Where the points of one flank of one tooth stand, and the directions of forces there.
#[derive(Debug, Clone)]
pub(crate) struct FlankFrames<'a> {
    profile: &'a ToothGeometry,
    side: Flank,
    tooth_angle_rad: f64,
    twist_rad_per_m: f64,
    /// Of the base helix.
    helix_sin_cos: (f64, f64),
}

impl<'a> FlankFrames<'a> {
    pub fn new(
        gear: &'a GearDefinition,
        mesh: &impl ToothedMesh,
        tooth: usize,
        side: Flank,
    ) -> Self {
        let (profile, twist_rad_per_m) = (&gear.profile, mesh.twist_rad_per_m());
        Self {
            profile,
            side,
            tooth_angle_rad: TAU * tooth as f64 / gear.tooth.teeth as f64,
            twist_rad_per_m,
            helix_sin_cos: (profile.base_radius_m * twist_rad_per_m).atan().sin_cos(),
        }
    }

    fn turned(&self, [x, y]: [f64; 2], z_m: f64) -> [f64; 2] {
        let (sin, cos) = (self.tooth_angle_rad + self.twist_rad_per_m * z_m).sin_cos();
        [cos * x - sin * y, sin * x + cos * y]
    }

    /// Unit vectors along the inward normal, along the profile towards the tip, and along +z.
    pub fn directions(&self, roll_rad: f64, z_m: f64) -> [[f64; 3]; 3] {
        let (normal, tangent) = self.profile.flank_frame(self.side, roll_rad);
        let [[n_x, n_y], [t_x, t_y]] = [normal, tangent].map(|v| self.turned(v, z_m));
        let (sin, cos) = self.helix_sin_cos;
        [
            [cos * n_x, cos * n_y, -self.side.mirror() * sin],
            [t_x, t_y, 0.0],
            [0.0, 0.0, 1.0],
        ]
    }

    /// Place in space \[m\].
    pub fn point_m(&self, roll_rad: f64, z_m: f64) -> [f64; 3] {
        let [x, y] = self.turned(self.profile.flank_point_m(self.side, roll_rad), z_m);
        [x, y, z_m]
    }
}

/// What loads at a point of a cell of the grid.
pub(crate) struct HatLoad {
    /// How far through the cell the point lies, up the flank and along it.
    pub shares: [f64; 2],
    /// Load per area of the faces' places.
    pub density: f64,
    /// Normal, up the profile, along the tooth.
    pub directions: [[f64; 3]; 3],
}

/// All unit loads on some faces, numbered as [`FlankGrid::load`]. `stations`: those of the grid as the faces have their
/// places, up the flank and along it; `at` tells the load at a place in the cell between two of each.
pub(crate) fn grid_loads(
    faces: &[OutlineFace],
    grid: &FlankGrid,
    stations: [&[f64]; 2],
    at: impl Fn([f64; 2], [usize; 2]) -> HatLoad,
) -> Vec<GridLoad> {
    let mut sums = vec![0.0; grid.len()];
    let mut parts: Vec<[BTreeMap<usize, f64>; 3]> = vec![Default::default(); grid.len()];
    for face in faces {
        let [up, along] = [0, 1].map(|axis| overlapping(stations[axis], face.range_m(axis)));
        let along: Vec<usize> = along.collect();
        for (i, j) in up.flat_map(|i| along.iter().map(move |&j| (i, j))) {
            let [up, along] = stations;
            let window = [[up[i], up[i + 1]], [along[j], along[j + 1]]].map(ordered);
            for point in overlap_points(face, window[0], window[1]) {
                let load = at(point.place_m, [i, j]);
                let shapes = face.shape.shapes(point.natural);
                let [a, b] = load.shares;
                // In a cell of the grid four hats are not zero.
                for (number, hat) in [
                    (grid.load(i, j), (1.0 - a) * (1.0 - b)),
                    (grid.load(i, j + 1), (1.0 - a) * b),
                    (grid.load(i + 1, j), a * (1.0 - b)),
                    (grid.load(i + 1, j + 1), a * b),
                ] {
                    let weight = point.area_m2 * load.density * hat;
                    sums[number] += weight;
                    for (node, shape) in face.nodes.iter().zip(&shapes) {
                        let value = weight * shape[0];
                        for (part, direction) in parts[number].iter_mut().zip(&load.directions) {
                            for (axis, share) in direction.iter().enumerate() {
                                if *share != 0.0 {
                                    let dof = 3 * *node as usize + axis;
                                    *part.entry(dof).or_default() += value * share;
                                }
                            }
                        }
                    }
                }
            }
        }
    }
    parts.into_iter().zip(sums).map(GridLoad::of_unit).collect()
}

/// The normal ones of some loads.
pub(crate) fn normals<'a>(loads: impl IntoIterator<Item = &'a GridLoad>) -> Vec<&'a SparseVector> {
    loads.into_iter().map(|load| &load.normal).collect()
}

/// Some loads in all three directions.
pub(crate) fn directions<'a>(
    loads: impl IntoIterator<Item = &'a GridLoad>,
) -> Vec<&'a SparseVector> {
    let of_load = |load: &'a GridLoad| [&load.normal, &load.tangential, &load.axial];
    loads.into_iter().flat_map(of_load).collect()
}

/// Product of a sparse row with a full vector.
pub fn dot(row: &SparseVector, full: &[f64]) -> f64 {
    row.iter().map(|&(dof, value)| value * full[dof]).sum()
}
