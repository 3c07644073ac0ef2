//! The sections of a bevel pair in slices once more, at a pose next to the one at which they were searched: as the
//! iterates of a step ask for them.
//!
//! Each contact goes from its place q by (∂q/∂pose) δ to the first order and is solved there as in a search. Guesses
//! over the turn of the pinion, and the question which sections are within reach, are left out; ∂q/∂pose, with which
//! slowly changing energies push, stays as it was.

use std::cell::Cell;

use gearmesh_geometry::Flank;
use nalgebra::{Matrix3, Vector3};

use super::contact_limits::LongEdge;
use super::nominal_contacts::small_turn;
use super::pose_derivatives::PoseDerivatives;
use super::section_points::{EDGES, edge_of, middle, nearest_on_section};
use super::sliced_mesh::BevelSlices;
use super::tooth_side::placed;
use crate::flank_contacts::{FlankContacts, TeethLine};
use crate::pose::{Pose, Vector6, stacked};

/// How far gear 2 may have moved \[m\]. A search looks so much farther that no section comes within reach that was out
/// of it.
pub(super) const NEARBY_M: f64 = 2e-6;

/// Sections that stand open by more do not touch at poses nearby.
const OPEN_M: f64 = 3.0 * NEARBY_M;

/// What a search leaves for the next ones nearby.
#[derive(Debug, Clone)]
pub(super) struct Searched {
    /// Displacement \[m\] and axes of gear 2 where its contacts were found last; none before the first search.
    stood: Option<(Vector3<f64>, Matrix3<f64>)>,
    /// How far gear 2 has moved since the search \[m\].
    moved_m: f64,
    /// How much vibration modes bent the flanks at the search, at the most \[m\].
    bent_m: f64,
    /// Turns of both gears' teeth \[rad\], one for each line that was found.
    pub turns_rad: Vec<[f64; 2]>,
    /// Sections to be solved.
    sought: Vec<Sought>,
}

/// A section and where its contact may be.
#[derive(Debug, Clone, Copy)]
struct Sought {
    line: usize,
    slice: usize,
    edge: Option<LongEdge>,
    at: [[f64; 2]; 2],
}

impl Searched {
    /// Brings the nearest pair of teeth to the front.
    pub(super) fn nearest_first(&mut self, found: &mut FlankContacts) {
        if let Some(first) = found.nearest_first() {
            self.turns_rad.swap(0, first);
        }
    }

    /// Memory for so many lines of so many slices.
    pub(super) fn with_capacity(lines: usize, slices: usize) -> Self {
        Self {
            stood: None,
            moved_m: 0.0,
            bent_m: 0.0,
            turns_rad: Vec::with_capacity(lines),
            sought: Vec::with_capacity(lines * slices),
        }
    }

    /// Says where a search was made; its lines follow.
    pub(super) fn begin(&mut self, pose: &Pose, bent_m: f64) {
        self.stood = Some((pose.displacement_m, pose.rotation));
        self.moved_m = 0.0;
        self.bent_m = bent_m;
        self.turns_rad.clear();
    }

    /// Goes on to a pose by a small step of gear 2; none if it has gone far since the search, or flanks have bent far.
    fn step(&mut self, pose: &Pose, size_m: f64, bent_m: f64) -> Option<Vector6> {
        let (displacement_m, rotation) = self.stood?;
        let turn = pose.rotation * rotation.transpose();
        let (moved_m, turned) = (pose.displacement_m - displacement_m, small_turn(&turn));
        self.moved_m += moved_m.norm() + size_m * turned.norm();
        self.stood = Some((pose.displacement_m, pose.rotation));
        // A turn by half a revolution has no skew part either.
        let came_m = self.moved_m + (bent_m - self.bent_m).max(0.0);
        let is_small = came_m < NEARBY_M && turn.trace() > 2.0;
        is_small.then(|| stacked(moved_m, turned))
    }
}

impl BevelSlices {
    /// Solves all sections of the last search once more, `list` and `found` being what it has found; `false` if one is
    /// no longer there, and what was found is then of no use.
    pub(super) fn find_again(
        &self,
        pose: &Pose,
        flank: Flank,
        (list, searched): (&mut Vec<PoseDerivatives>, &mut Searched),
        found: &mut FlankContacts,
    ) -> bool {
        let Some(step) = searched.step(pose, self.pair().mean_cone_m, found.bent_m) else {
            return false;
        };
        // Where nothing was near, one pair of teeth stands for all, and has no section.
        if list.is_empty() {
            return false;
        }
        // Flanks that are turned away: as they were.
        if found.contacts.iter().all(|contact| contact.gap_m > OPEN_M) {
            return true;
        }
        searched.sought.clear();
        for (contact, motion) in found.contacts.iter().zip(list.iter()) {
            let last = motion.found();
            let by = motion.places * step;
            searched.sought.push(Sought {
                line: contact.line,
                slice: contact.slice,
                edge: edge_of(last),
                at: [0, 1].map(|m: usize| [0, 1].map(|k: usize| last.at[m][k] + by[2 * m + k])),
            });
        }
        let side = &self.pair().sides[flank as usize];
        let points = Cell::new(0);
        let stands = (pose.rotation, pose.displacement_m);
        found.sections.clear();
        found.contacts.clear();
        let mut is_whole = true;
        for of_line in searched.sought.chunk_by(|a, b| a.line == b.line) {
            let line = of_line[0].line;
            let bodies = placed(&side.patches, searched.turns_rad[line], stands, &points);
            let (first, mut least_m) = (found.contacts.len(), f64::INFINITY);
            for sought in of_line {
                let s = middle(sought.slice, self.slices());
                let edges = std::iter::once(sought.edge).chain(EDGES);
                let point = nearest_on_section(&bodies, s, edges, sought.at);
                is_whole = point.is_some_and(|point| {
                    least_m = least_m.min(point.gap_m);
                    let motion = &mut list[found.contacts.len()];
                    *motion = if edge_of(&point) == sought.edge {
                        motion.next_to(&point, &pose.displacement_m)
                    } else {
                        PoseDerivatives::new(&point, &pose.displacement_m)
                    };
                    self.push(pose, flank, (line, sought.slice), (&point, motion), found)
                });
                if !is_whole {
                    break;
                }
            }
            if !is_whole {
                break;
            }
            found.lines[line] = TeethLine {
                section: first,
                ideal_gap_m: least_m,
                contacts: (first, of_line.len()),
                ..found.lines[line]
            };
        }
        self.pair().count_points(points.get());
        if is_whole {
            searched.nearest_first(found);
        }
        is_whole
    }
}
