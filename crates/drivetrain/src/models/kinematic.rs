//! `kinematic`: an ideal ratio, r_b1 φ₁ + r_b2 φ₂ constant. A joint, not a force: no elasticity, no backlash, no contact lines, and the
//! reaction is a moment on each shaft only.

use gearmesh_dynamics::{Joint, MarkerPair};

/// Couples the turns of two gears. Each pair is (marker of the housing, marker of the gear), z along the axis, both z axes the same
/// way; `teeth` of gear 1 and gear 2.
#[must_use]
pub fn kinematic_mesh(name: &str, [gear_1, gear_2]: [MarkerPair; 2], teeth: [usize; 2]) -> Joint {
    Joint::ratio(name, (gear_1, teeth[0] as f64), (gear_2, teeth[1] as f64))
}
