//! The contacts of one tooth pair as the pinion turns: of both surfaces, and of edges with the mate's flank.

use crate::assembly::{Assembly, AssemblyError};
use crate::blank::PairBlank;
use crate::contact_point::{Mesh, Touch};
use crate::contact_search::ContactSearch;
use crate::error::BevelError;
use crate::flank::Flank;

pub use crate::contact_point::ContactKind;

/// Contacts of one tooth pair.
#[derive(Debug, Clone, PartialEq)]
pub struct PairContacts {
    /// Turn of the pinion between two samples \[rad\].
    pub step_rad: f64,
    /// Number of sample, pinion turn in steps, and the contact at which the pair touches first.
    pub contacts: Vec<(i64, ContactKind, Touch)>,
    /// Turns of the pinion between which the flanks themselves touch; none where only edges do \[rad\].
    pub flank_span_rad: Option<[f64; 2]>,
}

/// Pitches to either side within which contacts are searched.
const REACH: i64 = 3;
/// Halvings for the ends of the path.
const HALVINGS: usize = 32;
/// Parts of the way into an assembly with errors.
const MOST_PARTS: usize = 64;

/// Contact of the extended surfaces at pinion turn 0 in an assembly with errors, from the mean points of the pair as
/// designed.
///
/// # Errors
/// [`BevelError::NoContact`].
pub fn first_touch(
    flanks: [&Flank; 2],
    blank: &PairBlank,
    error: &AssemblyError,
) -> Result<(Assembly, Touch), BevelError> {
    let mut parts = 1;
    while parts <= MOST_PARTS {
        let mut here = Some(Touch {
            at: [flanks[0].mean().at, flanks[1].mean().at],
            pinion_turn_rad: 0.0,
            gear_turn_rad: 0.0,
            points: [flanks[0].mean().point, flanks[1].mean().point],
        });
        for k in 0..=parts {
            let assembly = Assembly::new(blank, &error.scaled(k as f64 / parts as f64));
            let mesh = Mesh {
                flanks,
                assembly: &assembly,
            };
            here = here.and_then(|touch| mesh.touch(0.0, &touch));
        }
        if let Some(touch) = here {
            return Ok((Assembly::new(blank, error), touch));
        }
        parts *= 4;
    }
    Err(BevelError::NoContact {
        hint: "surfaces in line contact have no single point, others may be too far apart; make the errors smaller or the flanks crowned",
    })
}

/// All contacts of one tooth pair, sampled so many times a pitch of the pinion.
pub(crate) fn pair_contacts(search: &ContactSearch<'_>, per_pitch: usize) -> PairContacts {
    let teeth = search.mesh().flanks[0].blank.teeth;
    let step_rad = std::f64::consts::TAU / (teeth as f64 * per_pitch as f64);
    // The flanks of a tooth look the other way half a turn on.
    let reach = REACH.min(teeth as i64 / 4 + 1) * per_pitch as i64;
    let mut contacts = Vec::new();
    for i in -reach..=reach {
        if let Some((kind, touch)) = search.first_touch(i as f64 * step_rad) {
            contacts.push((i, kind, touch));
        }
    }
    let on_flanks = |(_, kind, _): &(i64, ContactKind, Touch)| *kind == ContactKind::Flanks;
    let ends = [
        contacts.iter().find(|c| on_flanks(c)),
        contacts.iter().rev().find(|c| on_flanks(c)),
    ];
    let flank_span_rad = match ends {
        [Some(first), Some(last)] => {
            let end = |touch: &Touch, way: f64| end_of(search, touch, way * step_rad);
            Some([end(&first.2, -1.0), end(&last.2, 1.0)])
        }
        _ => None,
    };
    PairContacts {
        step_rad,
        contacts,
        flank_span_rad,
    }
}

/// Turn at which the path leaves the flanks, between a contact on them and the next sample, by halving.
fn end_of(search: &ContactSearch<'_>, inside: &Touch, step: f64) -> f64 {
    let mut near = inside.pinion_turn_rad;
    let mut far = near + step;
    for _ in 0..HALVINGS {
        let middle = 0.5 * (near + far);
        match search.first_touch(middle) {
            Some((ContactKind::Flanks, _)) => near = middle,
            _ => far = middle,
        }
    }
    near
}
