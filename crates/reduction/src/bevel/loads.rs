//! Unit loads on a bevel flank, spread by hats over a grid of shares up the flank and along it.
//!
//! Load (i, j) has the density h_i(u) h_j(s) a(u, s)/g(s) per du ds along the inward normal, a = |∂r/∂s × ∂r/∂u| the
//! flank's area, g(s) = ∫₀¹ a du: over the profile hats are weighted by the area, along the tooth equally, so that
//! slices of equal force make an even load along s. Places, areas and normals are those of the flank itself, shape
//! functions those of the faces.

use gearmesh_bevel::{BevelGear, FlankPatch};
use gearmesh_geometry::Flank;
use gearmesh_mesh::BevelMesh;
use gearmesh_model::FlankGrid;

use crate::flank_loads::{GridLoad, HatLoad, grid_loads};

/// Abscissae on \[0, 1\] and weights of Gauss's rule with three points: a is nearly linear in u.
const GAUSS: [(f64, f64); 3] = [
    (0.112_701_665_379_258_3, 5.0 / 18.0),
    (0.5, 8.0 / 18.0),
    (0.887_298_334_620_741_7, 5.0 / 18.0),
];

/// The flank grid: stations evenly from the lower line to the tip, and at edges and middles of slices from toe to heel.
pub fn bevel_grid(gear: &BevelGear) -> FlankGrid {
    let n = gear.reduction.roll_stations - 1;
    let slices = gear.reduction.slices;
    let width = gear.blank().face_width_m;
    FlankGrid {
        roll_angles_rad: (0..=n).map(|i| i as f64 / n as f64).collect(),
        z_m: (0..=2 * slices)
            .map(|j| width * (j as f64 / (2 * slices) as f64 - 0.5))
            .collect(),
        slices,
    }
}

/// Area of a flank per unit of s and u \[m²\].
pub fn area_m2(patch: &FlankPatch, [s, u]: [f64; 2]) -> f64 {
    let [along, up] = patch.point([s, u]).dr;
    along.cross(&up).norm()
}

/// Shares (u, s) of a place on the blank \[m\].
pub fn shares_of(patch: &FlankPatch, cone_m: f64, height_m: f64) -> [f64; 2] {
    let [toe, heel] = patch.cones_m;
    let s = (cone_m - toe) / (heel - toe);
    let [low, high] = [0.0, 1.0].map(|u| patch.place_m([s, u])[1]);
    [(height_m - low) / (high - low), s]
}

/// All unit loads on one flank of tooth 0, numbered as [`FlankGrid::load`].
pub fn bevel_loads(
    mesh: &BevelMesh,
    patch: &FlankPatch,
    side: Flank,
    grid: &FlankGrid,
) -> Vec<GridLoad> {
    let width = patch.cones_m[1] - patch.cones_m[0];
    let us = &grid.roll_angles_rad;
    let along: Vec<f64> = grid.z_m.iter().map(|z| z / width + 0.5).collect();
    let lines = &mesh.outline_m[usize::from(side == Flank::Left)];
    let faces = mesh.outline_faces(0, side, |k, section| {
        let [cone, height] = lines[section][k];
        shares_of(patch, cone, height)
    });
    let profile_area = |s: f64| -> f64 {
        GAUSS
            .iter()
            .map(|(u, weight)| weight * area_m2(patch, [s, *u]))
            .sum()
    };
    grid_loads(&faces, grid, [us, &along], |[u, s], [i, j]| {
        let at = patch.point([s, u]);
        let up = at.dr[1].normalize();
        let lengthwise = (at.dr[0] - up * up.dot(&at.dr[0])).normalize();
        HatLoad {
            shares: [
                (u - us[i]) / (us[i + 1] - us[i]),
                (s - along[j]) / (along[j + 1] - along[j]),
            ],
            density: at.dr[0].cross(&at.dr[1]).norm() / profile_area(s),
            directions: [at.n, up, lengthwise].map(<[f64; 3]>::from),
        }
    })
}
