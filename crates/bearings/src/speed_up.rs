//! From the place at rest to the one at speed: the branch that a ring follows as its speed rises.
//!
//! Balls of angular-contact bearings may have two equilibria at one place of the ring: carried by both grooves at a
//! steep inner angle, or at the bottom of the outer groove, beyond the end of the inner one. Which one holds depends on
//! what was before. Here it is the one that is reached when the speed rises from rest: a ball stays between both
//! grooves as long as an equilibrium with it leads on, and drops where none does.

use crate::element_load::ElementLoad;
use crate::element_place::ElementPlaces;
use crate::error::BearingError;
use crate::operation::Operation;
use crate::quasi_static::{QuasiStaticBearing, Row};
use crate::ring_equilibrium::AppliedBearingLoad;
use crate::ring_pose::RingPose;

/// Share of the square of the speed below which steps are not shortened any more.
const LEAST_STEP: f64 = 1e-4;

/// First step after a ball has dropped, as a share of the square of the speed.
const STEP_AFTER_DROP: f64 = 0.02;

/// An equilibrium on the way.
struct Stand {
    /// Share of the square of the speed.
    share: f64,
    pose: RingPose,
    places: ElementPlaces,
    /// Of each ball, whether the inner ring presses it.
    carried: Vec<bool>,
    /// Balls that the inner ring pressed in the equilibrium before, and that have left it.
    dropped: usize,
}

impl QuasiStaticBearing {
    /// From rest to speed, in shorter steps of the square of the speed where a step fails or lets balls drop.
    ///
    /// # Errors
    /// [`BearingError`] where no equilibrium leads on, with balls dropped neither.
    pub(crate) fn speed_up(
        &self,
        rest: RingPose,
        load: &AppliedBearingLoad,
        operation: &Operation,
    ) -> Result<(RingPose, ElementPlaces), BearingError> {
        let mut carried = Vec::new();
        let at_rest = Operation {
            inner_rad_per_s: 0.0,
            outer_rad_per_s: 0.0,
            ..*operation
        };
        let mut unknown = ElementPlaces::unknown(&self.rows);
        self.evaluate_each(&rest, &at_rest, &mut unknown, |ball| {
            carried.push(ball.inner_load_n > 0.0);
        })?;
        let mut here = Stand {
            share: 0.0,
            pose: rest,
            places: ElementPlaces::unknown(&self.rows),
            carried,
            dropped: 0,
        };
        let mut step = 1.0_f64;
        while here.share < 1.0 {
            let next = (here.share + step).min(1.0);
            let part = Operation {
                inner_rad_per_s: operation.inner_rad_per_s * next.sqrt(),
                outer_rad_per_s: operation.outer_rad_per_s * next.sqrt(),
                ..*operation
            };
            let found = self.stand(&here, here.places.clone(), (load, &part, next));
            here = match found {
                Ok(found) if found.dropped == 0 => {
                    step *= 2.0;
                    found
                }
                _ if step > LEAST_STEP => {
                    step *= 0.25;
                    continue;
                }
                other => {
                    step = STEP_AFTER_DROP;
                    other.or_else(|error| self.let_drop(&here, (load, &part, next), error))?
                }
            };
        }
        Ok((here.pose, here.places))
    }

    fn stand(
        &self,
        before: &Stand,
        mut places: ElementPlaces,
        (load, operation, share): (&AppliedBearingLoad, &Operation, f64),
    ) -> Result<Stand, BearingError> {
        let pose = self.iterate(before.pose, load, operation, (None, Some(&mut places)))?;
        let (mut carried, mut dropped) = (Vec::new(), 0);
        self.evaluate_each(&pose, operation, &mut places, |ball| {
            let was_carried = before.carried.get(carried.len()).copied().unwrap_or(false);
            dropped += usize::from(was_carried && ball.left_inner_ring);
            carried.push(ball.inner_load_n > 0.0);
        })?;
        Ok(Stand {
            share,
            pose,
            places,
            carried,
            dropped,
        })
    }

    /// Where no equilibrium leads on, one with the steepest balls at the bottom of the outer groove: as few of them as it
    /// takes.
    fn let_drop(
        &self,
        before: &Stand,
        aim: (&AppliedBearingLoad, &Operation, f64),
        error: BearingError,
    ) -> Result<Stand, BearingError> {
        let mut loads = Vec::new();
        let mut places = before.places.clone();
        let all = |ball: ElementLoad| loads.push(ball);
        self.evaluate_each(&before.pose, aim.1, &mut places, all)?;
        let rows = self.rows.iter().enumerate();
        let mut carried: Vec<_> = rows
            .flat_map(|(row, of)| (0..of.elements()).map(move |ball| (row, ball)))
            .zip(&loads)
            .filter(|(_, load)| load.inner_load_n > 0.0)
            .collect();
        let steepness = |load: &ElementLoad| load.inner_contact_angle_rad.abs();
        carried.sort_by(|(_, a), (_, b)| steepness(b).total_cmp(&steepness(a)));
        let mut places = before.places.clone();
        for ((row, ball), load) in carried {
            let Row::Ball(of) = &self.rows[row] else {
                return Err(error);
            };
            places.set(row, ball, of.bottom(load.centrifugal_n));
            match self.stand(before, places.clone(), aim) {
                Ok(found) if found.dropped > 0 => return Ok(found),
                _ => {}
            }
        }
        Err(error)
    }
}
