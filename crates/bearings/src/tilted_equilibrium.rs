//! Where a ring that is held at a large tilt comes to rest: found from the straight ring, the tilt growing step by
//! step.

use crate::ball_equilibrium::FAR_SIDE;
use crate::error::BearingError;
use crate::operation::Operation;
use crate::quasi_static::{QuasiStaticBearing, Row};
use crate::ring_equilibrium::{AppliedBearingLoad, TiltCondition};
use crate::ring_pose::RingPose;

/// Share of the tilt of the first step.
const FIRST_STEP: f64 = 0.25;

/// Share of the tilt below which steps are not shortened any more.
const LEAST_STEP: f64 = 1e-3;

/// Share of the tilt beyond the last equilibrium at which the elements are asked what ends it.
const BEYOND: f64 = 1e-2;

impl QuasiStaticBearing {
    /// From the straight ring to the tilted one at rest; `failure` is what the direct search ended with.
    ///
    /// Each step begins where the last two lead on to. A step that finds no equilibrium is shortened.
    ///
    /// # Errors
    /// `failure` where no tilt is held, or the straight ring finds no equilibrium either;
    /// [`BearingError::TiltedBeyondGroove`] where balls then leave their groove, [`BearingError::NoEquilibriumAtTilt`]
    /// otherwise, both with the tilt that was reached.
    pub(crate) fn tilt_up(
        &self,
        load: &AppliedBearingLoad,
        resting: &Operation,
        failure: BearingError,
    ) -> Result<RingPose, BearingError> {
        let TiltCondition::Held(tilt) = load.tilt else {
            return Err(failure);
        };
        let size_rad = tilt[0].hypot(tilt[1]);
        if size_rad == 0.0 {
            return Err(failure);
        }
        let tilted_by = |share: f64| AppliedBearingLoad {
            tilt: TiltCondition::Held(tilt.map(|t| share * t)),
            ..*load
        };
        let rest = |start: RingPose, load: &AppliedBearingLoad| {
            (self.iterate(start, load, resting, (None, None, &mut 0)))
                .or_else(|error| self.settle(start, load, resting, (error, None)))
        };
        let straight = tilted_by(0.0);
        let Ok(pose) = rest(self.first_guess(&straight), &straight) else {
            return Err(failure);
        };
        let (mut before, mut here) = ((0.0, pose.to_five()), (0.0, pose.to_five()));
        let mut step = FIRST_STEP;
        while here.0 < 1.0 {
            let next = (here.0 + step).min(1.0);
            // Where the last two places lead on to.
            let on = |share: f64| {
                let way = here.0 - before.0;
                let ahead = if way > 0.0 {
                    (share - here.0) / way
                } else {
                    0.0
                };
                let mut five = here.1 + (here.1 - before.1) * ahead;
                (five[3], five[4]) = (share * tilt[0], share * tilt[1]);
                RingPose::from_five(&five)
            };
            if step < LEAST_STEP {
                let beyond = on(here.0 + BEYOND);
                return Err(self.tilt_limit(size_rad, here.0, &beyond, resting));
            }
            match rest(on(next), &tilted_by(next)) {
                Ok(found) => {
                    (before, here) = (here, (next, found.to_five()));
                    step *= 1.5;
                }
                Err(_) => step *= 0.5,
            }
        }
        Ok(RingPose::from_five(&here.1))
    }

    /// Why no more tilt than the share that was found has an equilibrium: what the elements say a little beyond.
    fn tilt_limit(
        &self,
        asked_rad: f64,
        found: f64,
        beyond: &RingPose,
        resting: &Operation,
    ) -> BearingError {
        let (asked_mrad, found_mrad) = (1e3 * asked_rad, 1e3 * asked_rad * found);
        match (self.evaluate(beyond, resting), &self.rows[0]) {
            (Err(BearingError::PulledOut), Row::Ball(row)) => BearingError::TiltedBeyondGroove {
                asked_mrad,
                found_mrad,
                end_deg: (FAR_SIDE * row.free_angle_rad.abs()).to_degrees(),
            },
            _ => BearingError::NoEquilibriumAtTilt {
                asked_mrad,
                found_mrad,
            },
        }
    }
}
