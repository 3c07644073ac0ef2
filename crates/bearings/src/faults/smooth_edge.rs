//! The edge of a spall: how far a ball has sunk on its way from the rim.
//!
//! A ball that rolls over a rim turns about it: a distance x behind the rim its centre has sunk by x²/(2R), 1/R the sum
//! of the curvatures of ball and race along the way, until it lies on the floor, at e = √(2Rd). Between two rims at the
//! distance L it sinks by L²/(8R) at most. That curve has a kink where the ball meets the floor; here the depth grows
//! over the same length e by the quintic of class C²,
//!
//! ```text
//! S(ξ) = 6ξ⁵ − 15ξ⁴ + 10ξ³,  ξ = x/e
//! ```
//!
//! so that forces and their derivatives are smooth in the place of the ball, whatever the step in time is.

/// A length over which something begins.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct SmoothEdge {
    /// From the middle to the rim \[m\].
    pub half_m: f64,
    /// e \[m\].
    pub entry_m: f64,
}

impl SmoothEdge {
    /// Share of the depth at a distance from the middle, with two derivatives by that distance.
    pub fn share(&self, from_middle_m: f64) -> [f64; 3] {
        let behind = self.half_m - from_middle_m.abs();
        if behind <= 0.0 {
            return [0.0; 3];
        }
        let x = behind / self.entry_m;
        if x >= 1.0 {
            return [1.0, 0.0, 0.0];
        }
        let inward = -from_middle_m.signum() / self.entry_m;
        let slope = 30.0 * x * x * (1.0 - x).powi(2);
        let bend = 60.0 * x * (1.0 - x) * (1.0 - 2.0 * x);
        [
            x * x * x * (10.0 - x * (15.0 - 6.0 * x)),
            slope * inward,
            bend * inward * inward,
        ]
    }
}

/// How deep a rigid ball sinks between two rims \[m\]: d, or L²/(8R) where that is less.
pub(crate) fn reached_m(depth_m: f64, length_m: f64, curvature_per_m: f64) -> f64 {
    depth_m.min(0.125 * length_m * length_m * curvature_per_m)
}

/// e = √(2Rd) \[m\].
pub(crate) fn entry_m(reached_m: f64, curvature_per_m: f64) -> f64 {
    (2.0 * reached_m / curvature_per_m).sqrt()
}
