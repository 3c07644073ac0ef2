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
//! Lower lines at which a patch ends hold as tips do.
//!
//! The row of sections follows the line on which the flanks nearly touch; where the tips touch it follows their edges.

use nalgebra::{Vector3, Vector4};

use super::contact_limits::LongEdge;
use super::nearest_points::{Held, Nearest, Placed, equations, solve};

/// Slack of the ends: rounding.
const SLACK: f64 = 1e-9;

/// What may hold a section, whichever comes first: nothing, or an edge along the face.
pub(super) const EDGES: [Option<LongEdge>; 5] = [
    None,
    Some(LongEdge::ALL[0]),
    Some(LongEdge::ALL[1]),
    Some(LongEdge::ALL[2]),
    Some(LongEdge::ALL[3]),
];

/// Coordinates of a section that stand still.
fn held(s: f64, edge: Option<LongEdge>) -> Held {
    let mut held = [[Some(s), None], [None; 2]];
    if let Some(edge) = edge {
        held[edge.member][1] = Some(edge.end());
    }
    held
}

/// The edge along the face that holds a contact.
pub(crate) fn edge_of(found: &Nearest) -> Option<LongEdge> {
    LongEdge::of(&found.held)
}

/// The nearest points of a section under the first of these edges that holds it, from a guess nearby.
pub(crate) fn nearest_on_section(
    bodies: &[Placed<'_>; 2],
    s: f64,
    edges: impl IntoIterator<Item = Option<LongEdge>>,
    start: [[f64; 2]; 2],
) -> Option<Nearest> {
    let holds = |found: &Nearest, edge: Option<LongEdge>| {
        (0..2).all(|m| match edge.filter(|edge| edge.member == m) {
            // Beyond the edge the gap would shrink further.
            Some(edge) => {
                (2.0 * edge.end() - 1.0) * found.slope(m, 1) <= 1e-12
                    && edge.is_before_the_tooth(found)
            }
            None => found.at[m][1] <= 1.0 + SLACK,
        })
    };
    let is_there = |edge: &Option<LongEdge>| edge.is_none_or(|edge| edge.is_there(bodies));
    for edge in edges.into_iter().filter(is_there) {
        let found = solve(bodies, held(s, edge), start);
        if found.as_ref().is_some_and(|found| holds(found, edge)) {
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
    edge: Option<LongEdge>,
    slices: usize,
) -> Vec<Option<Nearest>> {
    let mut all = vec![None; slices];
    let first = ((at[0][0] * slices as f64) as usize).min(slices - 1);
    let mut go = |numbers: &mut dyn Iterator<Item = usize>| {
        let (mut start, mut edge) = (at, edge);
        for slice in numbers {
            let s = middle(slice, slices);
            let shift = s - start[0][0];
            let mut guess = start;
            guess[0][0] = s;
            guess[1][0] += shift;
            let others = EDGES.into_iter().filter(|other| *other != edge);
            let order = std::iter::once(edge).chain(others);
            all[slice] = nearest_on_section(bodies, s, order, guess);
            if let Some(found) = &all[slice] {
                (start, edge) = (found.at, edge_of(found));
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
