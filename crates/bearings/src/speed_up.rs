//! From the place at rest to the one at speed: the branch that a ring follows as its speed rises.
//!
//! Balls of angular-contact bearings may have two equilibria at one place of the ring: carried by both grooves at a
//! steep inner angle or on the inner one's edge, or at the bottom of the outer groove, beyond the end of the inner one.
//! Which one holds depends on what was before. Here it is the one that is reached when the speed rises from rest: a
//! ball stays on the inner ring as long as an equilibrium with it leads on. Where none does, the ring slides down the
//! potential energy to the next one, and balls drop on the way.

use crate::element_load::ElementLoad;
use crate::element_place::ElementPlaces;
use crate::error::BearingError;
use crate::operation::Operation;
use crate::quasi_static::QuasiStaticBearing;
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
    /// What its elements carry.
    loads: Vec<ElementLoad>,
    /// Balls that the inner ring pressed in the equilibrium before, and that have left it.
    dropped: usize,
}

impl QuasiStaticBearing {
    /// From rest to speed, in shorter steps of the square of the speed where a step fails or lets balls drop.
    ///
    /// # Errors
    /// [`BearingError`] where none is found.
    pub(crate) fn speed_up(
        &self,
        rest: RingPose,
        load: &AppliedBearingLoad,
        operation: &Operation,
    ) -> Result<(RingPose, ElementPlaces), BearingError> {
        let mut loads = Vec::new();
        let at_rest = operation.at_rest();
        let mut unknown = ElementPlaces::unknown(&self.rows);
        self.evaluate_each(&rest, &at_rest, &mut unknown, |ball| loads.push(ball))?;
        let mut here = Stand {
            share: 0.0,
            pose: rest,
            places: ElementPlaces::unknown(&self.rows),
            loads,
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
            let found = self.stand(&here, (load, &part, next));
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
                    other.or_else(|error| self.slide(&here, (load, &part, next), error))?
                }
            };
        }
        Ok((here.pose, here.places))
    }

    fn stand(
        &self,
        before: &Stand,
        (load, operation, share): (&AppliedBearingLoad, &Operation, f64),
    ) -> Result<Stand, BearingError> {
        let mut places = before.places.clone();
        let pose = self.iterate(
            before.pose,
            load,
            operation,
            (None, Some(&mut places), &mut 0),
        )?;
        self.at(before, (pose, places), operation, share)
    }

    /// Where no equilibrium leads on, the one that the ring slides to down the potential energy.
    fn slide(
        &self,
        before: &Stand,
        (load, operation, share): (&AppliedBearingLoad, &Operation, f64),
        error: BearingError,
    ) -> Result<Stand, BearingError> {
        let mut places = before.places.clone();
        let pose = self.settle(before.pose, load, operation, (error, Some(&mut places)))?;
        self.at(before, (pose, places), operation, share)
    }

    /// An equilibrium that was found.
    fn at(
        &self,
        before: &Stand,
        (pose, mut places): (RingPose, ElementPlaces),
        operation: &Operation,
        share: f64,
    ) -> Result<Stand, BearingError> {
        let mut loads = Vec::with_capacity(before.loads.len());
        self.evaluate_each(&pose, operation, &mut places, |ball| loads.push(ball))?;
        let dropped = (before.loads.iter().zip(&loads))
            .filter(|(before, now)| before.inner_load_n > 0.0 && now.has_dropped())
            .count();
        Ok(Stand {
            share,
            pose,
            places,
            loads,
            dropped,
        })
    }
}
