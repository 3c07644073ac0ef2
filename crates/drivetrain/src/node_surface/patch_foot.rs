//! Foot of a point on the patches of a flank: the local search.
//!
//! On a patch x(ξ, η) the foot of y solves (y − x)·∂x/∂ξ = (y − x)·∂x/∂η = 0 (Newton's method); a foot beyond the
//! patch's edge moves on to the
//! next one. Over a ridge, where either patch sends the point to the other, the foot is on the edge between them.

use nalgebra::Vector3;

use super::digital_flank::{DigitalFlank, shapes, slopes};

/// Newton's steps on a patch, patches that are walked over, and the step that ends the former (patches are 1 long).
const STEPS: usize = 8;
const WALK: usize = 400;
const CLOSE: f64 = 1e-11;
/// Beyond the edge by less is on it.
const EDGE: f64 = 1e-9;

/// Where a point stands over a flank.
#[derive(Debug, Clone, Copy)]
pub(super) struct Foot {
    pub patch: [usize; 2],
    pub within: [f64; 2],
    /// Unit normal out of the material.
    pub normal: Vector3<f64>,
    /// ∂x/∂ξ and ∂x/∂η.
    pub slopes: [Vector3<f64>; 2],
    /// Distance along the normal \[m\], negative in the material.
    pub gap_m: f64,
}

impl DigitalFlank {
    /// The foot of a point in the frame of the tooth, from a patch near it; none beside the flank.
    pub(super) fn foot(&self, y: &Vector3<f64>, from: [usize; 2]) -> Option<Foot> {
        let mut patch = [0, 1].map(|k: usize| from[k].min(self.patches[k] - 1));
        let mut left = None;
        for _ in 0..WALK {
            let corners = self.corners(patch);
            let within = on_patch(&corners, y)?;
            let steps = [0, 1].map(|k: usize| beyond(within[k]));
            let mut next = patch;
            let mut beside = false;
            for k in 0..2 {
                let to = patch[k] as isize + steps[k];
                let held = to.clamp(0, self.patches[k] as isize - 1);
                beside |= held != to && held == patch[k] as isize;
                next[k] = held as usize;
            }
            if next == patch || left == Some(next) {
                if beside {
                    return None;
                }
                return Some(self.standing(patch, &corners, within, y));
            }
            left = Some(patch);
            patch = next;
        }
        None
    }

    fn standing(
        &self,
        patch: [usize; 2],
        corners: &[Vector3<f64>; 4],
        within: [f64; 2],
        y: &Vector3<f64>,
    ) -> Foot {
        let within = within.map(|x| x.clamp(0.0, 1.0));
        let slopes = slopes(corners, within);
        let normal = self.outwards * slopes[0].cross(&slopes[1]).normalize();
        Foot {
            patch,
            within,
            normal,
            slopes,
            gap_m: normal.dot(&(y - at(corners, within))),
        }
    }
}

/// Patches to walk on by.
fn beyond(x: f64) -> isize {
    if (-EDGE..=1.0 + EDGE).contains(&x) {
        0
    } else {
        x.floor().clamp(-50.0, 50.0) as isize
    }
}

fn at(corners: &[Vector3<f64>; 4], within: [f64; 2]) -> Vector3<f64> {
    let each = corners.iter().zip(shapes(within));
    each.map(|(corner, shape)| corner * shape).sum()
}

/// ξ and η of the foot on the patch continued; none where Newton's method ends nowhere.
fn on_patch(corners: &[Vector3<f64>; 4], y: &Vector3<f64>) -> Option<[f64; 2]> {
    let twist = corners[3] - corners[2] - corners[1] + corners[0];
    let mut place = [0.5; 2];
    for _ in 0..STEPS {
        let apart = y - at(corners, place);
        let [by_x, by_e] = slopes(corners, place);
        let (f, g) = (apart.dot(&by_x), apart.dot(&by_e));
        let (a, c) = (by_x.norm_squared(), by_e.norm_squared());
        let b = by_x.dot(&by_e) - apart.dot(&twist);
        let det = a * c - b * b;
        if det <= 1e-6 * a * c {
            return None;
        }
        let step = [(c * f - b * g) / det, (a * g - b * f) / det];
        // Far from the patch it is a plane for the walk.
        place = [0, 1].map(|k: usize| (place[k] + step[k]).clamp(-60.0, 60.0));
        if step[0].abs().max(step[1].abs()) < CLOSE {
            break;
        }
        if place.iter().any(|x| !(-2.0..=3.0).contains(x)) {
            break;
        }
    }
    Some(place)
}
