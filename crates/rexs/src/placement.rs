//! Where components stand in space: vectors of a reference component, chained.

use crate::error::{Result, RexsError};
use crate::ledger::About;
use crate::source::Part;
pub use crate::vectors::{Frame, add, cross, dot, unit};
use std::collections::HashSet;

/// The frame of a component; none where it has no support vector.
///
/// # Errors
/// [`RexsError::Cycle`] for components whose places follow from each other, those of [`Part`].
pub fn frame(component: Part<'_>) -> Result<Option<Frame>> {
    let source = component.source;
    let mut chain: Vec<(Part<'_>, Frame)> = Vec::new();
    let mut seen = HashSet::new();
    let mut next = component;
    // The frame in which the last one of the chain stands.
    let outer = loop {
        if let Some(known) = source.frame(next.id) {
            break known;
        }
        let Some(own) = own_frame(next)? else {
            if chain.is_empty() {
                return Ok(None);
            }
            next.assume(
                About::Place,
                "other components stand in its frame, which is not given: taken as the gear unit's",
            );
            break Frame::WORLD;
        };
        chain.push((next, own));
        seen.insert(next.id);
        let reference = next.integer("reference_component_for_position")?;
        // Gear units say so that they stand in the world.
        let is_unit = next.kind == "gear_unit";
        let Some(id) = reference.filter(|&id| !(is_unit && id == next.id)) else {
            break Frame::WORLD;
        };
        let Some(parent) = source.part(id) else {
            let what = format!(
                "its place is given from component {id}, which is not in the file: taken as from the gear unit"
            );
            next.assume(About::Lost, what);
            break Frame::WORLD;
        };
        if seen.contains(&parent.id) {
            let from = chain.iter().position(|(c, _)| c.id == parent.id);
            let round = chain[from.unwrap_or(0)..].iter().map(|(c, _)| c.words());
            let words: Vec<String> = round.chain([parent.words()]).collect();
            let shown = match words.len() {
                0..=8 => words.join(" > "),
                n => format!(
                    "{} > ... ({} more) > {}",
                    words[..4].join(" > "),
                    n - 5,
                    words[n - 1]
                ),
            };
            return Err(RexsError::Cycle {
                what: "components whose place is given from each other",
                chain: shown,
            });
        }
        next = parent;
    };
    let mut frame = outer;
    for (component, own) in chain.iter().rev() {
        frame = Frame {
            origin_mm: frame.point(own.origin_mm),
            axes: own.axes.map(|axis| frame.direction(axis)),
        };
        source.keep_frame(component.id, frame);
    }
    Ok(Some(frame))
}

fn own_frame(component: Part<'_>) -> Result<Option<Frame>> {
    let Some(origin_mm) = component.vector("support_vector")? else {
        return Ok(None);
    };
    let u = component.vector("u_axis_vector")?;
    let w = component.vector("w_axis_vector")?;
    let wrong = |attribute: &str| {
        let allowed = "u and w are vectors that are not zero and not along each other";
        component.wrong(attribute, "no direction", allowed)
    };
    if u.is_none() || w.is_none() {
        let what = "no u or w axis given: those of its reference component";
        component.assume(About::Place, what);
    }
    let u = unit(u.unwrap_or([1.0, 0.0, 0.0])).ok_or_else(|| wrong("u_axis_vector"))?;
    let w = w.unwrap_or(if u[2].abs() > 0.9 {
        [1.0, 0.0, 0.0]
    } else {
        [0.0, 0.0, 1.0]
    });
    // w may be given across u only roughly.
    let w = unit(add(w, u, -dot(w, u))).ok_or_else(|| wrong("w_axis_vector"))?;
    Ok(Some(Frame {
        origin_mm,
        axes: [u, cross(w, u), w],
    }))
}
