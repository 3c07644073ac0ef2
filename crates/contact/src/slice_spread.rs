//! What the calibrated correction of a slice's own term leaves for its neighbours.
//!
//! The correction is that of an endless line load. A slice is short: near its ends the true near field, which is narrow, is
//! fully there, that of the hats, which reaches some tenths of a module, is not. So the correction of a single slice is
//! smaller than the endless one, and what is missing there belongs to the neighbours. Along the line both near fields are
//! those of a point load on a half space (Johnson eq. 3.22b), smeared over a distance r across the line:
//!
//! ```text
//! K_r(z) = (k/2) [ 1/√(z² + r²) − 1/√(z² + h²/4) ],     k = 2(1 − ν²)/(πE)
//! ```
//!
//! The second part ends it at about the depth h of the tooth; it matters on slices wider than that only. The mean distance of two points of a Hertz strip of half width a from its centre is r = 4a/(3π). For the truth a = a₀; for
//! the hats the half width of a strip as stiff as they are, a_h = a₀ exp((c₀ − w_h)/k). With s the uniform density of a slice
//! force, f that of its hats ([`axial_shares`]) and g the same on the neighbour,
//!
//! ```text
//! e = ∫∫ s_i K_r s_j dz dz' − ∫∫ f_i K_{r_h} f_j dz dz'                      j next to i
//! ```
//!
//! is added to the compliance of neighbours and taken from the own one, so that a uniform load deflects as before.

use crate::slice_compliance::axial_shares;
use std::f64::consts::PI;

/// Slices of the stretch on which the integrals are done; the densities of the two in the middle end inside it.
const SLICES: usize = 6;
/// Integration cells in a slice.
const CELLS: usize = 48;
/// Largest share of the own correction that goes to one neighbour. An alternating load then still sees a third of it: the
/// compliance stays positive. Reached only where slices are narrower than the hats' near field.
const LARGEST_SHARE: f64 = 1.0 / 6.0;

/// How much of two neighbouring slices' densities lie at each distance, and with it the term between them.
pub struct NeighbourTerm {
    uniform: Vec<f64>,
    hats: Vec<f64>,
}

impl Default for NeighbourTerm {
    fn default() -> Self {
        Self::new()
    }
}

impl NeighbourTerm {
    /// The overlaps, which depend on neither width nor material.
    pub fn new() -> Self {
        let first = SLICES / 2 - 1;
        Self {
            uniform: overlaps(&uniform(first), &uniform(first + 1)),
            hats: overlaps(&hats(first), &hats(first + 1)),
        }
    }

    /// e \[m/N\] for slices of `width_m`, from k \[m²/N\], c₀ − w_h \[m²/N\] at a₀ \[m\], and the tooth's depth h \[m\].
    pub fn at(
        &self,
        k_m2_per_n: f64,
        missing_m2_per_n: f64,
        half_width_m: f64,
        (depth_m, width_m): (f64, f64),
    ) -> f64 {
        let smeared = |half_width_m: f64| 4.0 * half_width_m / (3.0 * PI);
        let narrow = smeared(half_width_m);
        let wide = smeared(half_width_m * (missing_m2_per_n / k_m2_per_n).exp());
        let end = 0.5 * depth_m / width_m;
        let product = |overlaps: &[f64], r: f64| {
            smeared_product(overlaps, r) - smeared_product(overlaps, end)
        };
        let true_term = product(&self.uniform, narrow / width_m);
        let hat_term = product(&self.hats, wide / width_m);
        let term = 0.5 * k_m2_per_n / width_m * (true_term - hat_term);
        let largest = LARGEST_SHARE * missing_m2_per_n.max(0.0) / width_m;
        term.clamp(-largest, largest)
    }
}

/// Density of a slice's unit force in each cell, slices one unit wide.
fn uniform(slice: usize) -> Vec<f64> {
    let mut density = vec![0.0; SLICES * CELLS];
    density[slice * CELLS..(slice + 1) * CELLS].fill(1.0);
    density
}

fn hats(slice: usize) -> Vec<f64> {
    let mut stations = [0.0; 2 * SLICES + 1];
    for (station, share) in axial_shares(slice, SLICES) {
        // A hat of one newton on stations half a unit apart is two high.
        stations[station] = 2.0 * share;
    }
    (0..SLICES * CELLS)
        .map(|cell| {
            let at = (cell as f64 + 0.5) / CELLS as f64 * 2.0;
            let below = at as usize;
            let share = at - below as f64;
            (1.0 - share) * stations[below] + share * stations[below + 1]
        })
        .collect()
}

/// Σ f_i g_j over all cells at each distance j − i, from −(n − 1) to n − 1.
fn overlaps(f: &[f64], g: &[f64]) -> Vec<f64> {
    let n = f.len() as isize;
    (1 - n..n)
        .map(|apart| {
            (0..n)
                .filter(|i| (0..n).contains(&(i + apart)))
                .map(|i| f[i as usize] * g[(i + apart) as usize])
                .sum()
        })
        .collect()
}

/// ∫∫ f(z) g(z′) / √((z − z′)² + r²) dz dz′ from the overlaps of f and g, each cell of g integrated exactly.
fn smeared_product(overlaps: &[f64], r: f64) -> f64 {
    let size = 1.0 / CELLS as f64;
    let primitive = |z: f64| (z / r).asinh();
    let middle = (overlaps.len() / 2) as f64;
    let at_distance = overlaps.iter().enumerate().map(|(k, overlap)| {
        let z = (k as f64 - middle) * size;
        overlap * (primitive(z + 0.5 * size) - primitive(z - 0.5 * size)) * size
    });
    at_distance.sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two uniform slices side by side: ∫∫ = G(2) − 2 G(1) + G(0), G the second primitive of the kernel.
    #[test]
    fn uniform_slices_agree_with_the_closed_form() {
        for r in [0.02, 0.1, 0.5] {
            let second = |z: f64| z * (z / r).asinh() - z.hypot(r);
            let exact = second(2.0) - 2.0 * second(1.0) + second(0.0);
            let found = smeared_product(&overlaps(&uniform(2), &uniform(3)), r);
            assert!((found / exact - 1.0).abs() < 2e-3, "{r}: {found} {exact}");
        }
    }

    /// On slices much wider than the hats' near field little is left but the overlap of the hats, which is taken back; on
    /// narrow ones the neighbour gets its part, at most the sixth.
    #[test]
    fn the_term_grows_as_slices_get_narrow() {
        let (k, missing, a0) = (2.8e-12, 6e-12, 1e-4);
        let term = NeighbourTerm::new();
        let share = |width: f64| term.at(k, missing, a0, (3e-3, width)) * width / missing;
        // What the hats of neighbours overlap, times their near field over the right one.
        let overlap: f64 = (hats(2).iter().zip(hats(3)))
            .map(|(f, g)| f * g)
            .sum::<f64>()
            / CELLS as f64;
        let wide = 4.0 * a0 / (3.0 * PI) * f64::exp(missing / k);
        let expected = -overlap * k * f64::ln(1.5e-3 / wide) / missing;
        assert!(
            expected < 0.0 && (share(2.0) / expected - 1.0).abs() < 0.02,
            "{}",
            share(2.0)
        );
        assert!(share(2e-3) > share(4e-3) && share(2e-3) > 0.01);
        assert!(share(1e-4) <= LARGEST_SHARE * (1.0 + 1e-12));
    }
}
