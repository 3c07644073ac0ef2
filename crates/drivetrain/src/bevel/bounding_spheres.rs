//! First guess of where two flanks touch: each is parted into cells with a sphere around each.

use gearmesh_bevel::FlankPatch;
use nalgebra::{Matrix3, Vector3};

/// Cells along the face and up the flank.
const ALONG: usize = 6;
const UP: usize = 3;
const CELLS: usize = ALONG * UP;

/// Spheres around the cells of a flank, in the member's frame.
#[derive(Debug, Clone)]
pub(crate) struct BoundingSpheres {
    centres_m: [Vector3<f64>; CELLS],
    radius_m: f64,
}

impl BoundingSpheres {
    /// Of a flank.
    pub(crate) fn new(patch: &FlankPatch) -> Self {
        let corner = |cell: usize, x: f64, y: f64| {
            let [i, k] = [cell / UP, cell % UP];
            let at = [(i as f64 + x) / ALONG as f64, (k as f64 + y) / UP as f64];
            patch.point(at).r
        };
        let centres_m = std::array::from_fn(|cell| corner(cell, 0.5, 0.5));
        let mut radius_m: f64 = 0.0;
        for (cell, centre) in centres_m.iter().enumerate() {
            for (x, y) in [(0.0, 0.0), (0.0, 1.0), (1.0, 0.0), (1.0, 1.0)] {
                radius_m = radius_m.max((corner(cell, x, y) - centre).norm());
            }
        }
        Self {
            centres_m,
            radius_m,
        }
    }

    /// Middle of a cell on its flank.
    fn middle(cell: usize) -> [f64; 2] {
        let [i, k] = [cell / UP, cell % UP];
        [
            (i as f64 + 0.5) / ALONG as f64,
            (k as f64 + 0.5) / UP as f64,
        ]
    }

    /// Middles of the two cells that are nearest, if their spheres meet; each flank turned and moved.
    pub(crate) fn meet(
        flanks: [&Self; 2],
        rotations: [&Matrix3<f64>; 2],
        apart_m: Vector3<f64>,
    ) -> Option<[[f64; 2]; 2]> {
        let [first, second] = flanks;
        // Seen in the second flank's frame.
        let back = rotations[1].transpose();
        let turn = back * rotations[0];
        let shift = back * apart_m;
        let mut least = (first.radius_m + second.radius_m).powi(2);
        let mut found = None;
        for (i, centre) in first.centres_m.iter().enumerate() {
            let centre = turn * centre - shift;
            for (j, other) in second.centres_m.iter().enumerate() {
                let square = (other - centre).norm_squared();
                if square < least {
                    least = square;
                    found = Some([Self::middle(i), Self::middle(j)]);
                }
            }
        }
        found
    }
}
