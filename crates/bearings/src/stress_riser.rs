//! What the ends of a roller suffer beyond the load of their laminae.
//!
//! Laminae do not feel each other: that the pressure rises where a roller or its race ends is in none of their loads.
//! ISO/TS 16281:2008 weights the loads of the laminae with a function of their place before they are summed to the
//! dynamic equivalent loads; its approximation for both races is equation (60), as quoted in
//! github.com/minzhun/ISO16281 (`RollerBearing.py`):
//!
//! ```text
//! f[k] = 1 − 0.01/ln(1.985 |(2k − n_s − 1)/(2 n_s − 2)|),   k = 1 … n_s
//! ```
//!
//! axisforge's `iso_16281/roller_bearing/postprocessing.py` quotes the same, with the standard's conditions: a profile
//! by its equations (42) to (44), a medium load, less than 4′ of misalignment. docs/theory/rolling_bearings.md sets it
//! beside a roller on a half-space.
//!
//! It is 1 in the middle and 2.328 at both ends, whatever n_s is, so that the life of evenly loaded rollers without a
//! profile depends on n_s.

/// f of the lamina `number`, counted from 0, among so many; 1 for a roller of one lamina.
#[must_use]
pub fn stress_riser(number: usize, laminae: usize) -> f64 {
    if laminae < 2 {
        return 1.0;
    }
    let (k, all) = (number as f64 + 1.0, laminae as f64);
    // The logarithm of the middle is −∞, which leaves 1.
    1.0 - 0.01 / (1.985 * ((2.0 * k - all - 1.0) / (2.0 * all - 2.0)).abs()).ln()
}
