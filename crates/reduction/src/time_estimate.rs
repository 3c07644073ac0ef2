//! How long a reduction will take, from the sizes that [`MemoryEstimate`](crate::MemoryEstimate) estimates:
//!
//! ```text
//! t = s (1.0 + 5.6e-6 n + 5.2e-11 (N/2 + 1) c³ + 2.8e-7 L + 3.0e-10 f³)   seconds
//! ```
//!
//! n nodes of the gear, N sectors, c degrees of freedom of a cut, L numbers in the factor of a sector, f degrees of
//! freedom of a tooth's foot; what the solutions take is in the term of L. The coefficients are fitted to measured
//! times (docs/theory/reduction.md); s is how much slower this machine makes a product of matrices than that one did.

use std::time::Instant;

use faer::Mat;
use gearmesh_geometry::GearDefinition;
use gearmesh_mesh::MeshSize;

/// Seconds: to begin, a node, a number of the harmonics' work, of a sector's factor, of the feet's work.
const SECONDS: [f64; 5] = [1.0, 5.6e-6, 5.2e-11, 2.8e-7, 3.0e-10];
/// Share of the time without the coarser meshes of the error estimate.
const WITHOUT_ESTIMATE: f64 = 0.6;
/// Rows of the product that tells the machine's speed, how often it is made, and its shortest time where the
/// coefficients were fitted \[s\].
const PRODUCT: (usize, usize, f64) = (512, 20, 2.2e-3);

/// Work of a reduction that costs time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Work([f64; 5]);

impl Work {
    /// `factor`: numbers in the factor of a sector.
    pub(crate) fn new(gear: &GearDefinition, size: &MeshSize, factor: f64) -> Self {
        let sectors = gear.sectors() as f64;
        let cut = if sectors > 1.0 {
            3.0 * size.cut_nodes
        } else {
            0.0
        };
        let foot = 3.0 * size.foot_nodes;
        Self([
            1.0,
            size.nodes,
            (0.5 * sectors + 1.0) * cut.powi(3),
            factor,
            foot.powi(3),
        ])
    }

    /// Where the coefficients were fitted \[s\].
    fn fitted_seconds(&self) -> f64 {
        self.0.iter().zip(SECONDS).map(|(work, a)| work * a).sum()
    }

    /// On this machine \[s\], on all its threads, with the error estimate or without.
    pub(crate) fn seconds(&self, estimate_error: bool) -> f64 {
        let share = if estimate_error {
            1.0
        } else {
            WITHOUT_ESTIMATE
        };
        share * slowness() * self.fitted_seconds()
    }
}

/// The shortest time of a few products of matrices, over that where the coefficients were fitted.
fn slowness() -> f64 {
    let (rows, times, fitted_s) = PRODUCT;
    let a = Mat::from_fn(rows, rows, |i, j| 1.0 / (1.0 + (i + j) as f64));
    let once = |_| {
        let clock = Instant::now();
        std::hint::black_box(&a * &a);
        clock.elapsed().as_secs_f64()
    };
    (0..times).map(once).fold(f64::INFINITY, f64::min) / fitted_s
}

#[cfg(test)]
#[allow(clippy::unwrap_used, clippy::print_stdout)]
mod tests {
    use crate::{MemoryEstimate, OfflineJob};
    use gearmesh_geometry::GearDefinition;
    use gearmesh_geometry::input::InputDocument;

    /// Times of `gearmesh reduce` with error estimate over s as it was then, on two cores (2026-11-29): within a
    /// third. (No clock is asked.)
    #[test]
    fn estimates_are_within_a_third_of_measured_times() {
        for (text, measured_s) in [
            (include_str!("../../../fe_models/gearbox_17.toml"), 4.6),
            (include_str!("../../../fe_models/pinion_25_m2.toml"), 6.3),
            (include_str!("../../../fe_models/gear1.toml"), 7.9),
            (include_str!("../../../fe_models/gear2.toml"), 13.9),
            (include_str!("../../../fe_models/gear3.toml"), 45.2),
            (include_str!("../../../fe_models/helical2.toml"), 22.9),
            (include_str!("../../../fe_models/gearbox_73.toml"), 29.1),
            (include_str!("../../../fe_models/ring_75.toml"), 6.5),
            (
                include_str!("../../../fe_models/wheel_47_drilled.toml"),
                17.0,
            ),
            (include_str!("../../../fe_models/wheel_64_holes.toml"), 61.0),
        ] {
            let gear = GearDefinition::from_document(&InputDocument::new("g.toml", text)).unwrap();
            let estimate = MemoryEstimate::new(&gear, OfflineJob::Reduction).unwrap();
            let estimated_s = estimate.work.fitted_seconds();
            println!("{}: {estimated_s:.1} s, measured {measured_s} s", gear.name);
            assert!(
                (estimated_s / measured_s - 1.0).abs() < 1.0 / 3.0,
                "{}",
                gear.name
            );
        }
    }
}
