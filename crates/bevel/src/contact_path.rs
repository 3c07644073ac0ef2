//! The contacts of one tooth pair as the pinion turns: of both surfaces, and of edges with the mate's flank.

use crate::assembly::{Assembly, AssemblyError};
use crate::blank::PairBlank;
use crate::contact_point::{EdgeKind, EdgeLine, Mesh, Touch};
use crate::cut_surface::SurfacePoint;
use crate::error::BevelError;
use crate::flank::Flank;

/// What touches.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ContactKind {
    /// Both flanks inside their limits.
    Flanks,
    /// An edge of a member, 0 the pinion, on the other's flank.
    Edge {
        /// Member with the edge.
        member: usize,
        /// Edge.
        edge: EdgeKind,
    },
}

/// Contacts of one tooth pair.
#[derive(Debug, Clone, PartialEq)]
pub struct PairContacts {
    /// Turn of the pinion between two samples \[rad\].
    pub step_rad: f64,
    /// Number of sample, pinion turn in steps, and contact. Of a number there may be several.
    pub contacts: Vec<(i64, ContactKind, Touch)>,
    /// Turns of the pinion between which the flanks themselves touch; none where only edges do \[rad\].
    pub flank_span_rad: Option<[f64; 2]>,
}

/// Pitches to either side within which contacts are searched.
const REACH: i64 = 3;
/// Halvings for the ends of the path.
const HALVINGS: usize = 40;
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

impl Mesh<'_> {
    /// Whether both points of a contact lie on the flanks.
    pub fn on_flanks(&self, touch: &Touch) -> bool {
        self.own(touch)
            .is_some_and(|own| (0..2).all(|i| self.flanks[i].holds(&own[i])))
    }

    fn own(&self, touch: &Touch) -> Option<[SurfacePoint; 2]> {
        Some([
            self.flanks[0].point(touch.at[0])?,
            self.flanks[1].point(touch.at[1])?,
        ])
    }

    /// How far the gear is ahead of constant ratio in the sense in which the pinion drives it \[rad\].
    pub fn lead_rad(&self, touch: &Touch) -> f64 {
        let sense = self.flanks[0].side.facing(self.flanks[0].blank.hand);
        -sense * (touch.gear_turn_rad + self.assembly.ratio * touch.pinion_turn_rad)
    }

    /// All contacts of one tooth pair, sampled so many times a pitch of the pinion.
    pub fn pair_contacts(&self, first: &Touch, per_pitch: usize) -> PairContacts {
        let step_rad =
            std::f64::consts::TAU / (self.flanks[0].blank.teeth as f64 * per_pitch as f64);
        let surface = self.surface_path(first, step_rad, REACH * per_pitch as i64);
        let inside: Vec<bool> = surface.iter().map(|(_, t)| self.on_flanks(t)).collect();
        let mut contacts: Vec<_> = surface
            .iter()
            .zip(&inside)
            .filter(|(_, inside)| **inside)
            .map(|((i, t), _)| (*i, ContactKind::Flanks, *t))
            .collect();
        let flank_span_rad = match (
            inside.iter().position(|x| *x),
            inside.iter().rposition(|x| *x),
        ) {
            (Some(a), Some(b)) => Some([
                self.end_of(&surface[a].1, a.checked_sub(1).map(|k| &surface[k].1)),
                self.end_of(&surface[b].1, surface.get(b + 1).map(|s| &s.1)),
            ]),
            _ => None,
        };
        for member in 0..2 {
            for kind in [EdgeKind::Tip, EdgeKind::Toe, EdgeKind::Heel] {
                self.edge_path(
                    member,
                    kind,
                    &surface,
                    step_rad,
                    per_pitch as i64,
                    &mut contacts,
                );
            }
        }
        contacts.sort_by_key(|c| c.0);
        PairContacts {
            step_rad,
            contacts,
            flank_span_rad,
        }
    }

    /// Turn at which the path leaves the flanks, between a contact inside and its neighbour outside.
    fn end_of(&self, inside: &Touch, outside: Option<&Touch>) -> f64 {
        let Some(outside) = outside else {
            return inside.pinion_turn_rad;
        };
        let mut near = *inside;
        let mut far = outside.pinion_turn_rad;
        for _ in 0..HALVINGS {
            let middle = 0.5 * (near.pinion_turn_rad + far);
            match self.touch(middle, &near) {
                Some(touch) if self.on_flanks(&touch) => near = touch,
                _ => far = middle,
            }
        }
        near.pinion_turn_rad
    }

    /// Contacts of the extended surfaces, in the order of the turn.
    fn surface_path(&self, first: &Touch, step: f64, most: i64) -> Vec<(i64, Touch)> {
        let mut list = vec![(0, *first)];
        for sign in [-1, 1] {
            let mut here = *first;
            for i in 1..=most {
                let Some(next) = self.touch((sign * i) as f64 * step, &here) else {
                    break;
                };
                let far = |k: usize, p: &SurfacePoint| {
                    let flank = self.flanks[k];
                    let [cone, height] = flank.place(&p.r);
                    let width = flank.blank.face_width_m;
                    let depth = flank.blank.outer_addendum_m + flank.blank.outer_dedendum_m;
                    cone < flank.blank.inner_cone_m() - width
                        || cone > flank.blank.outer_cone_m + width
                        || height.abs() > 1.5 * depth
                };
                if self
                    .own(&next)
                    .is_none_or(|own| far(0, &own[0]) || far(1, &own[1]))
                {
                    break;
                }
                list.push((sign * i, next));
                here = next;
            }
        }
        list.sort_by_key(|(i, _)| *i);
        list
    }

    /// Contacts of an edge, begun where the extended surfaces' path crosses it.
    fn edge_path(
        &self,
        member: usize,
        kind: EdgeKind,
        surface: &[(i64, Touch)],
        step: f64,
        per_pitch: i64,
        found: &mut Vec<(i64, ContactKind, Touch)>,
    ) {
        let flank = self.flanks[member];
        let edge = EdgeLine::of(flank, member, kind);
        let beyond = |touch: &Touch| {
            self.own(touch).is_some_and(|own| {
                let [cone, height] = flank.place(&own[member].r);
                match kind {
                    EdgeKind::Tip => height > flank.blank.addendum_m(cone),
                    EdgeKind::Toe => cone < flank.blank.inner_cone_m(),
                    EdgeKind::Heel => cone > flank.blank.outer_cone_m,
                }
            })
        };
        for pair in surface.windows(2) {
            if beyond(&pair[0].1) == beyond(&pair[1].1) {
                continue;
            }
            for sign in [-1, 1] {
                let mut here = pair[0].1;
                let start = if sign < 0 { pair[0].0 } else { pair[1].0 };
                for i in 0..2 * per_pitch {
                    let number = start + sign * i;
                    let Some(next) = self.edge_touch(number as f64 * step, &edge, &here) else {
                        break;
                    };
                    if !self.edge_is_real(member, kind, &next) {
                        break;
                    }
                    here = next;
                    found.push((number, ContactKind::Edge { member, edge: kind }, next));
                }
            }
        }
    }

    /// Whether the edge's point lies between the edge's ends, and the mate's point on its flank.
    fn edge_is_real(&self, member: usize, kind: EdgeKind, touch: &Touch) -> bool {
        let Some(own) = self.own(touch) else {
            return false;
        };
        let blank = &self.flanks[member].blank;
        let [cone, height] = self.flanks[member].place(&own[member].r);
        let slack = 1e-9 * blank.mean_cone_m;
        let on_edge = match kind {
            EdgeKind::Tip => {
                cone >= blank.inner_cone_m() - slack && cone <= blank.outer_cone_m + slack
            }
            EdgeKind::Toe | EdgeKind::Heel => {
                height <= blank.addendum_m(cone) + slack && own[member].above_end >= 0.0
            }
        };
        // A tooth is no longer touched from its front: normals of edge and flank still face each other.
        on_edge
            && self.flanks[1 - member].holds(&own[1 - member])
            && touch.points[0].n.dot(&touch.points[1].n) < 0.0
    }
}
