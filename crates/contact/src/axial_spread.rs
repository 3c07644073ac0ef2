//! How the forces of contact slices sit on the axial stations of one gear, wherever the slices lie on its face.
//!
//! A gear's own slices have the shares of [`axial_shares`]. They are the means over a slice of a force at a point z
//! that is shared as
//!
//! ```text
//! φ_j(z) = h_j(z) + Σ_k λ_k(z) x_kj
//! ```
//!
//! h_j: hats of the stations; x_k: what slice k has besides (¼, ½, ¼), which keeps its second moment; λ_k: broken lines
//! on the stations whose mean is one over slice k and zero over all others, and which add up to one. The mean of φ over
//! any other stretch of the face is therefore continuous in its ends, adds up to one, keeps the first moment away from
//! the faces, and the second one of a stretch as wide as a slice; slices that fill the face with equal forces make an
//! exactly uniform load.

use gearmesh_model::ReducedGear;

use crate::placed_slice::axial_shares;

/// Shares smaller than this are rounding. No unit.
const ROUNDING: f64 = 1e-14;

/// Shares of a unit force on each slice, as (axial station, share).
#[derive(Debug, Clone, PartialEq)]
pub struct AxialSpread {
    rows: Vec<Vec<(usize, f64)>>,
    width_m: f64,
}

impl AxialSpread {
    /// A gear's own slices over its whole face.
    #[must_use]
    pub fn own(gear: &ReducedGear) -> Self {
        let slices = gear.grid.slices;
        Self {
            rows: (0..slices)
                .map(|slice| axial_shares(slice, slices).collect())
                .collect(),
            width_m: gear.slice_width_m(),
        }
    }

    /// Slices of `width_m` whose middles stand at `centres_m` of the gear's mid-face; within its face.
    #[must_use]
    pub fn new(gear: &ReducedGear, centres_m: impl IntoIterator<Item = f64>, width_m: f64) -> Self {
        Self::on_face((gear.grid.slices, gear.face_width_m), centres_m, width_m)
    }

    /// The same on a face of so many own slices and this width \[m\].
    #[must_use]
    pub fn on_face(
        (slices, face_width_m): (usize, f64),
        centres_m: impl IntoIterator<Item = f64>,
        width_m: f64,
    ) -> Self {
        let own_m = face_width_m / slices as f64;
        let rows = centres_m.into_iter().map(|centre_m| {
            let from_face = centre_m + 0.5 * face_width_m;
            let ends = [-0.5, 0.5].map(|half| (from_face + half * width_m) / own_m);
            stretch_shares(ends, slices)
        });
        Self {
            rows: rows.collect(),
            width_m,
        }
    }

    /// Number of slices.
    #[must_use]
    pub fn slices(&self) -> usize {
        self.rows.len()
    }

    /// Width of a slice \[m\].
    #[must_use]
    pub fn width_m(&self) -> f64 {
        self.width_m
    }

    /// Stations and shares of a slice.
    #[must_use]
    pub fn shares(&self, slice: usize) -> &[(usize, f64)] {
        &self.rows[slice]
    }
}

/// Shares of a unit force that is uniform between two places of a face, in widths of its `slices` own slices from its
/// lower end.
pub(crate) fn stretch_shares([low, high]: [f64; 2], slices: usize) -> Vec<(usize, f64)> {
    let stations = 2 * slices + 1;
    let inside = |x: f64| x.clamp(0.0, slices as f64);
    let (low, high) = (inside(low), inside(high));
    let mut shares: Vec<f64> = (0..stations)
        .map(|j| (hat_integral(high, j) - hat_integral(low, j)) / (high - low))
        .collect();
    let hats = shares.clone();
    for slice in 0..slices {
        let weight: f64 = own_weights(slice, slices)
            .filter_map(|(j, value)| Some(value * hats.get(j)?))
            .sum();
        for (j, share) in axial_shares(slice, slices) {
            let plain = match j.abs_diff(2 * slice + 1) {
                0 => 0.5,
                1 => 0.25,
                _ => 0.0,
            };
            shares[j] += weight * (share - plain);
        }
    }
    let kept = shares.into_iter().enumerate();
    kept.filter(|(_, share)| share.abs() > ROUNDING).collect()
}

/// ∫ from the lower face to x of the hat of station j; stations are half a unit apart.
fn hat_integral(x: f64, j: usize) -> f64 {
    let y = (2.0 * x - j as f64).clamp(-1.0, 1.0);
    let below = if y < 0.0 {
        0.5 * (1.0 + y) * (1.0 + y)
    } else {
        1.0 - 0.5 * (1.0 - y) * (1.0 - y)
    };
    0.5 * below
}

/// λ of a slice at the stations where it is not zero.
fn own_weights(slice: usize, slices: usize) -> impl Iterator<Item = (usize, f64)> {
    let middle = 2 * slice + 1;
    let faces = [slice == 0, slice + 1 == slices];
    let edges = faces.map(|face| if face { 1.0 } else { 0.5 });
    // The mean over the slice, (edge + 2 middle + edge)/4, is one; over a neighbour (½ − 2/4 + 0)/4 = 0.
    let own = 2.0 - 0.5 * (edges[0] + edges[1]);
    let below = (slice > 0).then(|| (middle - 2, -0.25));
    let above = (slice + 1 < slices).then_some((middle + 2, -0.25));
    let near = [
        (middle - 1, edges[0]),
        (middle, own),
        (middle + 1, edges[1]),
    ];
    below.into_iter().chain(near).chain(above)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn dense(shares: &[(usize, f64)], slices: usize) -> Vec<f64> {
        let mut all = vec![0.0; 2 * slices + 1];
        for (j, share) in shares {
            all[*j] += share;
        }
        all
    }

    #[test]
    fn own_slices_have_their_own_shares() {
        for slices in [1, 2, 3, 7] {
            for slice in 0..slices {
                let ends = [slice as f64, slice as f64 + 1.0];
                let found = dense(&stretch_shares(ends, slices), slices);
                let own: Vec<_> = axial_shares(slice, slices).collect();
                for (a, b) in found.iter().zip(dense(&own, slices)) {
                    assert!((a - b).abs() < 1e-14, "{slice} of {slices}: {a} {b}");
                }
            }
        }
    }

    /// A force of one newton with the moments of a uniform load, wherever it lies away from the faces; hats of the
    /// stations have the variance 1/24.
    #[test]
    fn a_stretch_anywhere_has_the_moments_of_a_uniform_load() {
        let slices = 9;
        for low in [3.0, 3.1, 3.37, 3.5, 3.93] {
            for width in [0.5, 1.0, 1.5] {
                let shares = stretch_shares([low, low + width], slices);
                let middle = low + 0.5 * width;
                let moment = |power: i32| -> f64 {
                    let about = |j: usize| 0.5 * j as f64 - middle;
                    let terms = shares.iter().map(|&(j, share)| match power {
                        0 => share,
                        1 => share * about(j),
                        _ => share * (about(j).powi(2) + 1.0 / 24.0),
                    });
                    terms.sum()
                };
                assert!((moment(0) - 1.0).abs() < 1e-13 && moment(1).abs() < 1e-13);
                let second = width * width / 12.0;
                assert!(
                    (moment(2) - second).abs() < 1e-13,
                    "{low} {width} {}",
                    moment(2)
                );
            }
        }
    }

    /// Stretches side by side that fill the face make the uniform load of the own slices, whatever their widths.
    #[test]
    fn stretches_that_fill_the_face_make_a_uniform_load() {
        for slices in [1, 2, 5] {
            let ends = [0.0, 0.3, 0.45, 0.8, 1.0].map(|share| share * slices as f64);
            let mut sum = vec![0.0; 2 * slices + 1];
            for pair in ends.windows(2) {
                let own = dense(&stretch_shares([pair[0], pair[1]], slices), slices);
                for (place, share) in sum.iter_mut().zip(own) {
                    *place += (pair[1] - pair[0]) * share;
                }
            }
            for (j, found) in sum.iter().enumerate() {
                let expected = if j == 0 || j == 2 * slices { 0.25 } else { 0.5 };
                assert!((found - expected).abs() < 1e-13, "{slices} {j} {found}");
            }
        }
    }
}
