//! A sweep of speeds as one run in time: the speed of a motion as a function of time, and the windows in which it is measured.
//!
//! Stepped: each speed is held for `settle_s + measure_s`; between two the function goes as STEP does, in `change_s`, so that the state
//! carries over and a jump of the response shows at the speed where it happens. Ramped: the speed changes evenly, each window is an
//! equal part of the ramp.

use gearmesh_dynamics::{DynamicsError, Interpolation, Table, TimeFunction};

/// Which way the speeds are gone through.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Direction {
    /// As listed.
    Up,
    /// Backwards.
    Down,
    /// As listed, then backwards; the last speed is measured twice.
    UpDown,
}

/// How the speed changes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Course {
    /// From plateau to plateau.
    Stepped {
        /// Time for vibrations of the change to die out \[s\].
        settle_s: f64,
        /// Time that is measured \[s\].
        measure_s: f64,
        /// Time of the change \[s\].
        change_s: f64,
    },
    /// Evenly from the first to the last speed.
    Ramped {
        /// Time from the first to the last speed \[s\].
        duration_s: f64,
    },
}

/// A time in which the response is measured.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Window {
    /// Speed, the mean of a ramped window \[rad/s\].
    pub speed_rad_per_s: f64,
    /// Whether the list is gone through forwards.
    pub up: bool,
    /// Begin \[s\].
    pub from_s: f64,
    /// End \[s\].
    pub to_s: f64,
}

/// The speed over time, and what is measured.
#[derive(Debug, Clone, PartialEq)]
pub struct SpeedPlan {
    times_s: Vec<f64>,
    speeds_rad_per_s: Vec<f64>,
    interpolation: Interpolation,
    windows: Vec<Window>,
}

impl SpeedPlan {
    /// A plan for some speeds \[rad/s\].
    ///
    /// # Errors
    /// [`DynamicsError::Parameter`] for fewer than two speeds or times that are not positive.
    pub fn new(speeds: &[f64], direction: Direction, course: Course) -> Result<Self, DynamicsError> {
        let positive = |what, found: f64| {
            if found > 0.0 && found.is_finite() {
                return Ok(());
            }
            let allowed = "positive and finite";
            Err(DynamicsError::Parameter {
                what,
                found,
                allowed,
            })
        };
        if speeds.len() < 2 {
            return Err(DynamicsError::Parameter {
                what: "number of speeds of the sweep",
                found: speeds.len() as f64,
                allowed: "two or more",
            });
        }
        match course {
            Course::Stepped {
                settle_s,
                measure_s,
                change_s,
            } => {
                positive("settling time in s", settle_s)?;
                positive("measuring time in s", measure_s)?;
                positive("time of a change of speed in s", change_s)?;
            }
            Course::Ramped { duration_s } => positive("duration of the ramp in s", duration_s)?,
        }
        let backwards: Vec<f64> = speeds.iter().rev().copied().collect();
        let legs: &[(&[f64], bool)] = match direction {
            Direction::Up => &[(speeds, true)],
            Direction::Down => &[(&backwards, false)],
            Direction::UpDown => &[(speeds, true), (&backwards, false)],
        };
        let mut plan = Self {
            times_s: Vec::new(),
            speeds_rad_per_s: Vec::new(),
            interpolation: match course {
                // Its slopes vanish at the ends of a plateau, which makes each change a STEP.
                Course::Stepped { .. } => Interpolation::MonotoneCubic,
                Course::Ramped { .. } => Interpolation::Linear,
            },
            windows: Vec::new(),
        };
        for &(leg, up) in legs {
            match course {
                Course::Stepped {
                    settle_s,
                    measure_s,
                    change_s,
                } => plan.add_plateaus(leg, up, [settle_s, measure_s, change_s]),
                Course::Ramped { duration_s } => plan.add_ramp(leg, up, duration_s),
            }
        }
        Ok(plan)
    }

    fn end(&self) -> Option<(f64, f64)> {
        self.times_s
            .last()
            .copied()
            .zip(self.speeds_rad_per_s.last().copied())
    }

    fn point(&mut self, time_s: f64, speed: f64) {
        self.times_s.push(time_s);
        self.speeds_rad_per_s.push(speed);
    }

    fn add_plateaus(&mut self, leg: &[f64], up: bool, [settle_s, measure_s, change_s]: [f64; 3]) {
        for &speed in leg {
            let begin = match self.end() {
                None => 0.0,
                // The same speed again: the plateau goes on.
                Some((time_s, before)) if before.to_bits() == speed.to_bits() => time_s,
                Some((time_s, _)) => time_s + change_s,
            };
            if self.times_s.last().is_none_or(|last| begin > *last) {
                self.point(begin, speed);
            }
            let from_s = begin + settle_s;
            let to_s = from_s + measure_s;
            self.point(to_s, speed);
            self.windows.push(Window {
                speed_rad_per_s: speed,
                up,
                from_s,
                to_s,
            });
        }
    }

    fn add_ramp(&mut self, leg: &[f64], up: bool, duration_s: f64) {
        let (first, last) = (leg[0], leg[leg.len() - 1]);
        let begin = self.end().map_or(0.0, |(time_s, _)| time_s);
        if self.times_s.is_empty() {
            self.point(begin, first);
        }
        self.point(begin + duration_s, last);
        let count = leg.len();
        for i in 0..count {
            let edge = |i: usize| begin + duration_s * i as f64 / count as f64;
            let share = (i as f64 + 0.5) / count as f64;
            self.windows.push(Window {
                speed_rad_per_s: first + share * (last - first),
                up,
                from_s: edge(i),
                to_s: edge(i + 1),
            });
        }
    }

    /// The speed \[rad/s\] over time.
    ///
    /// # Errors
    /// [`DynamicsError::Table`] where a time is lost in rounding: a change too short for the length of the run.
    pub fn function(&self) -> Result<TimeFunction, DynamicsError> {
        let (times, speeds) = (self.times_s.clone(), self.speeds_rad_per_s.clone());
        Table::new("speed of the sweep", times, speeds, self.interpolation).map(TimeFunction::Table)
    }

    /// What is measured, in the order of time.
    pub fn windows(&self) -> &[Window] {
        &self.windows
    }

    /// End of the run \[s\].
    pub fn end_s(&self) -> f64 {
        self.end().map_or(0.0, |(time_s, _)| time_s)
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn plateaus_hold_their_speed_and_changes_are_steps() {
        let course = Course::Stepped {
            settle_s: 0.5,
            measure_s: 0.25,
            change_s: 0.1,
        };
        let plan = SpeedPlan::new(&[10.0, 20.0, 15.0], Direction::UpDown, course).unwrap();
        let speed = plan.function().unwrap();
        assert_eq!(plan.windows().len(), 6);
        for window in plan.windows() {
            for t in [window.from_s - 0.49, window.from_s, window.to_s - 1e-9] {
                let at = speed.at(t);
                assert_eq!((at.value, at.rate), (window.speed_rad_per_s, 0.0));
            }
            assert!((window.to_s - window.from_s - 0.25).abs() < 1e-12);
        }
        let first = plan.windows()[0].to_s;
        let step = TimeFunction::step(first, 10.0, first + 0.1, 20.0).unwrap();
        for s in [0.1, 0.5, 0.8] {
            let t = first + 0.1 * s;
            assert!((speed.at(t).value - step.at(t).value).abs() < 1e-12);
        }
        let last = plan.windows()[5];
        assert!((plan.end_s() - last.to_s).abs() < 1e-12 && !last.up);
        assert_eq!(last.speed_rad_per_s, 10.0);
    }

    #[test]
    fn a_ramp_is_cut_into_equal_windows() {
        let course = Course::Ramped { duration_s: 2.0 };
        let plan = SpeedPlan::new(&[0.0, 1.0, 2.0, 4.0], Direction::UpDown, course).unwrap();
        let speed = plan.function().unwrap();
        assert_eq!(plan.end_s(), 4.0);
        for pair in plan.windows().windows(2) {
            assert_eq!(pair[0].to_s, pair[1].from_s);
        }
        for window in plan.windows() {
            let middle = 0.5 * (window.from_s + window.to_s);
            assert!((speed.at(middle).value - window.speed_rad_per_s).abs() < 1e-12);
        }
    }

    #[test]
    fn impossible_sweeps_are_refused() {
        let stepped = |change_s| Course::Stepped {
            settle_s: 1.0,
            measure_s: 1.0,
            change_s,
        };
        assert!(SpeedPlan::new(&[1.0], Direction::Up, stepped(1.0)).is_err());
        assert!(SpeedPlan::new(&[1.0, 2.0], Direction::Up, stepped(0.0)).is_err());
        let ramped = Course::Ramped {
            duration_s: f64::NAN,
        };
        assert!(SpeedPlan::new(&[1.0, 2.0], Direction::Up, ramped).is_err());
    }
}
