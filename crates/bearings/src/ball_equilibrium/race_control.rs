//! Which race controls a ball: where it rests by outer-race control, or by the race that lets less power go into spin.

use nalgebra::Vector2;

use super::{Ball, State};
use crate::ball_kinematics::RaceControl;
use crate::ball_row::Groove;
use crate::error::BearingError;
use crate::operation::Control;

impl Ball<'_> {
    /// Its place and state in equilibrium, by the race that controls it.
    pub(super) fn balanced(
        &self,
        start: Vector2<f64>,
    ) -> Result<(Vector2<f64>, State), BearingError> {
        match self.operation.control {
            Control::OuterRace => self.equilibrium(start, RaceControl::Outer),
            Control::LeastSpin => {
                let (place, outer) = self.equilibrium(start, RaceControl::Outer)?;
                if outer.motion.is_none() || outer.inner.load <= 0.0 {
                    return Ok((place, outer));
                }
                // A ball that the inner race hardly presses finds no hold there: the outer one leads it.
                let Ok((other, inner)) = self.equilibrium(place, RaceControl::Inner) else {
                    return Ok((place, outer));
                };
                if self.spin_power(&inner) < self.spin_power(&outer) {
                    Ok((other, inner))
                } else {
                    Ok((place, outer))
                }
            }
        }
    }

    /// Σ Q a E |spin|, which the power of spin friction is proportional to under one coefficient of friction.
    fn spin_power(&self, state: &State) -> f64 {
        let Some((motion, _)) = &state.motion else {
            return 0.0;
        };
        let share = |groove: &Groove, load: f64, spin: f64| {
            load * groove.contact.ellipse(load).half_length_m
                * groove.contact.second_integral
                * spin.abs()
        };
        let [inner, outer] = motion.contact_spin_rad_per_s;
        share(self.inner, state.inner.load, inner) + share(self.outer, state.outer.load, outer)
    }
}
