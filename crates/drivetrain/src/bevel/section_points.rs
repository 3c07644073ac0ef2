//! Where a section of gear 1's flank across the tooth, at one place along the face, is nearest to gear 2's flank.
//!
//! The section is a curve on the flank, s held. As in nearest_points.rs,
//!
//! ```text
//! inside both        d·t₂ = 0 (2),  ∂r₁/∂v·n₂ = 0
//! gear 1's tip       d·t₂ = 0 (2),  v of gear 1 at its end: the section's end on the face
//! gear 2's tip       d·∂r₁/∂v = 0,  d·∂r₂/∂s = 0,  v of gear 2 at its end: the section across the tip's edge
//! ```
//!
//! The row of sections follows the line on which the flanks nearly touch; where the tips touch it follows their edges.

use nalgebra::{Vector3, Vector4};

use super::nearest_points::{Held, Nearest, Placed, equations, solve};

/// Slack of the ends: rounding.
const SLACK: f64 = 1e-9;

/// Which tip holds a section's contact: of gear 1, of gear 2, or none.
pub(crate) type TipHeld = Option<usize>;

/// What may hold a section, whichever comes first.
pub(super) const TIPS: [TipHeld; 3] = [None, Some(0), Some(1)];

/// Coordinates of a section that stand still.
fn held(s: f64, tip: TipHeld) -> Held {
    let mut held = [[Some(s), None], [None; 2]];
    if let Some(member) = tip {
        held[member][1] = Some(1.0);
    }
    held
}

/// The tip that holds a contact.
pub(crate) fn tip_of(found: &Nearest) -> TipHeld {
    (0..2).find(|m| found.held[*m][1].is_some())
}

/// The nearest points of a section under the first of these tips that holds it, from a guess nearby.
pub(crate) fn nearest_on_section(
    bodies: &[Placed<'_>; 2],
    s: f64,
    tips: impl IntoIterator<Item = TipHeld>,
    start: [[f64; 2]; 2],
) -> Option<Nearest> {
    let holds = |found: &Nearest, tip: TipHeld| {
        (0..2).all(|m| match tip == Some(m) {
            // Beyond the tip the gap would shrink further.
            true => found.slope(m, 1) <= 1e-12,
            false => found.at[m][1] <= 1.0 + SLACK,
        })
    };
    for tip in tips {
        let found = solve(bodies, held(s, tip), start);
        if found.as_ref().is_some_and(|found| holds(found, tip)) {
            return found;
        }
    }
    None
}

/// Place along gear 1's face of a slice's middle, from toe 0 to heel 1.
pub(super) fn middle(slice: usize, slices: usize) -> f64 {
    (slice as f64 + 0.5) / slices as f64
}

/// Contacts of all sections at a pose, from a contact of the flanks outwards, and from what holds it.
pub(super) fn sections(
    bodies: &[Placed<'_>; 2],
    at: [[f64; 2]; 2],
    tip: TipHeld,
    slices: usize,
) -> Vec<Option<Nearest>> {
    let mut all = vec![None; slices];
    let first = ((at[0][0] * slices as f64) as usize).min(slices - 1);
    let mut go = |numbers: &mut dyn Iterator<Item = usize>| {
        let (mut start, mut tip) = (at, tip);
        for slice in numbers {
            let s = middle(slice, slices);
            let shift = s - start[0][0];
            let mut guess = start;
            guess[0][0] = s;
            guess[1][0] += shift;
            let order = std::iter::once(tip).chain(TIPS.into_iter().filter(|other| *other != tip));
            all[slice] = nearest_on_section(bodies, s, order, guess);
            if let Some(found) = &all[slice] {
                (start, tip) = (found.at, tip_of(found));
            }
        }
    };
    go(&mut (first..slices));
    go(&mut (0..first).rev());
    all
}

/// Tangent of the line of nearest points on gear 1 per unit of s \[m\], where no tip holds it.
pub(crate) fn line_tangent(found: &Nearest) -> Option<Vector3<f64>> {
    let (_, slopes) = equations(&found.held, &found.at, &found.points);
    // The equation that holds s is the third; it moves by as much as s.
    let along = slopes.lu().solve(&Vector4::new(0.0, 0.0, 1.0, 0.0))?;
    let [by_s, by_v] = found.points[0].dr;
    Some(by_s * along[0] + by_v * along[1])
}
