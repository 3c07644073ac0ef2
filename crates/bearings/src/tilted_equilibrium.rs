//! Where a ring that is held at a large tilt comes to rest: found from the straight ring, the tilt growing step by
//! step.

use crate::error::BearingError;
use crate::operation::Operation;
use crate::quasi_static::QuasiStaticBearing;
use crate::ring_equilibrium::{AppliedBearingLoad, TiltCondition};
use crate::ring_pose::RingPose;

/// Share of the tilt of the first step.
const FIRST_STEP: f64 = 0.25;

/// Share of the tilt below which steps are not shortened any more.
const LEAST_STEP: f64 = 1e-2;

impl QuasiStaticBearing {
    /// From the straight ring to the tilted one at rest; `failure` is what the direct search ended with.
    ///
    /// Each step begins where the last two lead on to. A step that finds no equilibrium is shortened.
    ///
    /// # Errors
    /// `failure` where no tilt is held, or the straight ring finds no equilibrium either;
    /// [`BearingError::NoEquilibriumAtTilt`] with the tilt that was reached.
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
            (self.iterate(start, load, resting, None))
                .or_else(|error| self.settle(start, load, resting, error))
        };
        let straight = tilted_by(0.0);
        let Ok(pose) = rest(self.first_guess(&straight), &straight) else {
            return Err(failure);
        };
        let (mut before, mut here) = ((0.0, pose.to_five()), (0.0, pose.to_five()));
        let mut step = FIRST_STEP;
        while here.0 < 1.0 {
            let next = (here.0 + step).min(1.0);
            let ahead = if here.0 > before.0 {
                (next - here.0) / (here.0 - before.0)
            } else {
                0.0
            };
            let mut start = here.1 + (here.1 - before.1) * ahead;
            (start[3], start[4]) = (next * tilt[0], next * tilt[1]);
            match rest(RingPose::from_five(&start), &tilted_by(next)) {
                Ok(found) => {
                    (before, here) = (here, (next, found.to_five()));
                    step *= 1.5;
                }
                Err(_) => step *= 0.5,
            }
            if step < LEAST_STEP {
                return Err(BearingError::NoEquilibriumAtTilt {
                    asked_mrad: 1e3 * size_rad,
                    found_mrad: 1e3 * here.0 * size_rad,
                });
            }
        }
        Ok(RingPose::from_five(&here.1))
    }
}
