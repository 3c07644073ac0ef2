//! `kinematic`: an ideal ratio, pitch circles that roll on each other. A joint, not a force: no elasticity, no
//! backlash, no contact lines.
//!
//! ```text
//! z₁ (φ₁ − β) + z₂ (φ₂ − β) constant,      β: polar angle of the line of centres; z negative of a ring
//! ```
//!
//! So it holds for axes that stand and for those that a carrier takes round, where it is Willis' equation. The reaction
//! is the tangential force in the pitch point; the radial and the axial part of a real tooth force do no work and are
//! not there.

use gearmesh_dynamics::{Joint, Marker, MarkerPair};

/// Couples the turns of two gears. The markers are the gears' frames, z along the axes, both z axes the same way;
/// `teeth` of gear 1 and gear 2, negative of a ring.
#[must_use]
pub fn kinematic_mesh(name: &str, [gear_1, gear_2]: [Marker; 2], teeth: [i64; 2]) -> Joint {
    let pair = MarkerPair {
        a: gear_1,
        b: gear_2,
    };
    Joint::rolling(name, pair, teeth.map(|teeth| teeth as f64))
}
