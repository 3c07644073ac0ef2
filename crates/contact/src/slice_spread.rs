//! What the calibrated correction of a slice's own term leaves for its neighbours.
//!
//! The correction is that of an endless line load. A slice is short: near its ends the true near field, which is
//! narrow, is fully there, that of the hats, which reaches some tenths of a module, is not. So the correction of a
//! single slice is smaller than the endless one, and what is missing there belongs to the neighbours. Along the line
//! both near fields are those of a point load on a half space (Johnson eq. 3.22b), smeared over a distance r across the
//! line:
//!
//! ```text
//! K(z) = (k/2) ⟨ 1/√(z² + ρ²) ⟩ − (k/2) / √(z² + h²/4),     k = 2(1 − ν²)/(πE)
//! ```
//!
//! The second part ends it at about the depth h of the tooth; it matters on slices wider than that only. ⟨⟩ is the mean
//! over the distances ρ across the line between force and deflection (`Distances`): under the Hertz pressure those from
//! its middle; between the hats those of two points of one hat each, scaled so that an endless line is as stiff as the
//! hats on the mesh, ⟨ln ρ⟩_h = ⟨ln ρ⟩ + (c₀ − w_h)/k. The ends of a slice see ⟨ρ⟩ as well, which is why the shape
//! matters. With s the uniform density of a slice force, f that of its hats ([`crate::axial_spread`]),
//!
//! ```text
//! e = ∫∫ s_i K s_j dz dz' − ∫∫ f_i K_h f_j dz dz'                      j next to i
//! ```
//!
//! is added to the compliance of neighbours and taken from the own one, so that a uniform load deflects as before.

use crate::axial_spread::stretch_shares;
use std::f64::consts::FRAC_PI_2;

/// Slices of the stretch on which the integrals are done; the densities of the two in the middle end inside it.
const SLICES: usize = 8;
/// Integration cells in a slice.
const CELLS: usize = 48;
/// Distances across the line for which the kernel is taken.
const DISTANCES: usize = 12;
/// Largest share of the own correction that goes to one neighbour. An alternating load then still sees a third of it:
/// the compliance stays positive. Reached only where slices are narrower than the hats' near field.
const LARGEST_SHARE: f64 = 1.0 / 6.0;

/// How much of two neighbouring slices' densities lie at each distance, and with it the term between them.
pub struct NeighbourTerm {
    uniform: Vec<f64>,
    hats: Vec<f64>,
    from_hertz_centre: Distances,
    between_hats: Distances,
}

/// Distances across the contact line, per half width of the load, and their weights, which add up to one.
struct Distances(Vec<(f64, f64)>);

impl Distances {
    /// Of a density on 0 to `last`, at places that lie closer towards zero, where the logarithm is steep.
    fn new(last: f64, density: impl Fn(f64) -> (f64, f64)) -> Self {
        let places = (0..DISTANCES).map(|k| (k as f64 + 0.5) / DISTANCES as f64);
        let points: Vec<(f64, f64)> = places
            .map(|u| {
                let (at, density) = density(last * u * u);
                (at, density * u)
            })
            .collect();
        let total: f64 = points.iter().map(|(_, weight)| weight).sum();
        Self(points.into_iter().map(|(at, w)| (at, w / total)).collect())
    }

    /// Of the points of a Hertz strip from its middle, by the angle whose sine they are.
    fn from_hertz_centre() -> Self {
        Self::new(FRAC_PI_2, |angle| (angle.sin(), angle.cos().powi(2)))
    }

    /// Between two points of the same triangular hat: a cubic B-spline.
    fn between_hats() -> Self {
        let spline = |x: f64| match x {
            x if x < 1.0 => 2.0 / 3.0 - x * x + 0.5 * x * x * x,
            x => (2.0 - x).powi(3) / 6.0,
        };
        Self::new(2.0, |x| (x, spline(x)))
    }

    /// ⟨ln ρ⟩ for a half width of one.
    fn mean_logarithm(&self) -> f64 {
        self.0.iter().map(|(at, weight)| weight * at.ln()).sum()
    }

    /// ⟨∫∫ f g / √((z − z′)² + ρ²)⟩ for a half width of `half_width` slices, from the overlaps of f and g.
    fn product(&self, overlaps: &[f64], half_width: f64) -> f64 {
        (self.0.iter())
            .map(|(at, weight)| weight * smeared_product(overlaps, at * half_width))
            .sum()
    }
}

impl NeighbourTerm {
    /// The overlaps, which depend on neither width nor material; `own_width`: that of the model's own slices, on which
    /// its stations lie, over that of the slices.
    pub fn new(own_width: f64) -> Self {
        let first = SLICES / 2 - 1;
        Self {
            uniform: overlaps(&uniform(first), &uniform(first + 1)),
            hats: overlaps(&hats(first, own_width), &hats(first + 1, own_width)),
            from_hertz_centre: Distances::from_hertz_centre(),
            between_hats: Distances::between_hats(),
        }
    }

    /// e \[m/N\] for slices of `width_m`, from k \[m²/N\], c₀ − w_h \[m²/N\] at a₀ \[m\], and the tooth's depth h
    /// \[m\].
    pub fn at(
        &self,
        k_m2_per_n: f64,
        missing_m2_per_n: f64,
        half_width_m: f64,
        (depth_m, width_m): (f64, f64),
    ) -> f64 {
        let (hertz, between) = (&self.from_hertz_centre, &self.between_hats);
        let further =
            missing_m2_per_n / k_m2_per_n + hertz.mean_logarithm() - between.mean_logarithm();
        let hat_m = half_width_m * further.exp();
        let end = 0.5 * depth_m / width_m;
        let true_term = hertz.product(&self.uniform, half_width_m / width_m)
            - smeared_product(&self.uniform, end);
        let hat_term =
            between.product(&self.hats, hat_m / width_m) - smeared_product(&self.hats, end);
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

/// The stretch begins where slices of the model and of the contact begin together, and the model's go on beyond its
/// ends.
fn hats(slice: usize, own_width: f64) -> Vec<f64> {
    let own_slices = (SLICES as f64 / own_width).ceil() as usize;
    let mut stations = vec![0.0; 2 * own_slices + 2];
    let ends = [slice, slice + 1].map(|edge| edge as f64 / own_width);
    for (station, share) in stretch_shares(ends, own_slices) {
        // A hat of one newton is one over the spacing of the stations high.
        stations[station] = 2.0 / own_width * share;
    }
    (0..SLICES * CELLS)
        .map(|cell| {
            let at = (cell as f64 + 0.5) / CELLS as f64 * 2.0 / own_width;
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
    // Slices reach a few neighbours only: most overlaps are zero.
    let at_distance = (overlaps.iter().enumerate())
        .filter(|(_, overlap)| **overlap != 0.0)
        .map(|(k, overlap)| {
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

    /// On a Hertz strip ⟨ρ⟩ = 4a/(3π) and ⟨ln ρ⟩ = ln(a/2) − 1/2; two points of a hat of half width one are 7/15 apart
    /// in the mean.
    #[test]
    fn distances_have_the_means_of_their_densities() {
        let mean = |d: &Distances| d.0.iter().map(|(at, weight)| at * weight).sum::<f64>();
        let (hertz, hats) = (Distances::from_hertz_centre(), Distances::between_hats());
        assert!((mean(&hertz) - 4.0 / (3.0 * std::f64::consts::PI)).abs() < 1e-3);
        assert!((mean(&hats) - 7.0 / 15.0).abs() < 1e-3);
        assert!((hertz.mean_logarithm() - (0.5_f64.ln() - 0.5)).abs() < 0.01);
    }

    /// On slices much wider than the hats' near field little is left but the overlap of the hats, which is taken back;
    /// on narrow ones the neighbour gets its part, at most the sixth.
    #[test]
    fn the_term_grows_as_slices_get_narrow() {
        let (k, missing, a0) = (2.8e-12, 6e-12, 1e-4);
        let term = NeighbourTerm::new(1.0);
        let share = |width: f64| term.at(k, missing, a0, (3e-3, width)) * width / missing;
        // What the hats of neighbours overlap, times their near field over the right one.
        let overlap: f64 = (hats(2, 1.0).iter().zip(hats(3, 1.0)))
            .map(|(f, g)| f * g)
            .sum::<f64>()
            / CELLS as f64;
        let wide = 0.5 * a0 * f64::exp(missing / k - 0.5);
        let expected = -overlap * k * f64::ln(1.5e-3 / wide) / missing;
        assert!(
            expected < 0.0 && (share(2.0) / expected - 1.0).abs() < 0.02,
            "{}",
            share(2.0)
        );
        assert!(share(1e-3) > share(2e-3) && share(2e-3) > share(4e-3) && share(1e-3) > 0.01);
        assert!(share(1e-4) <= LARGEST_SHARE * (1.0 + 1e-12));
    }
}
