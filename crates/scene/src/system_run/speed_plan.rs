//! A sweep of speeds as one run in time: the speed of a motion as a function of time, and the windows in which it is
//! measured.
//!
//! Stepped: each speed has a slot of `settle_s + measure_s`. In the first quarter of the settling time the function
//! goes there as STEP does, so that the state carries over and a jump of the response shows at the speed where it
//! happens. Ramped: the speed changes evenly, each window is an equal part of the ramp.

use gearmesh_dynamics::{DynamicsError, Interpolation, Table, TimeFunction};
use gearmesh_specification::system::run::{Direction, Schedule, SpeedSweep};

/// Share of the settling time in which the speed changes.
const CHANGE: f64 = 0.25;

/// Windows of a ramp.
const RAMP_WINDOWS: usize = Schedule::RAMP_WINDOWS;

/// A time in which the response is measured.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
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
    /// The plan of a sweep.
    pub fn new(sweep: &SpeedSweep) -> Self {
        let (first, last) = (sweep.from_rad_per_s, sweep.to_rad_per_s);
        let legs: &[bool] = match sweep.direction {
            Direction::Up => &[true],
            Direction::Down => &[false],
            Direction::UpDown => &[true, false],
        };
        let mut plan = Self {
            times_s: Vec::new(),
            speeds_rad_per_s: Vec::new(),
            interpolation: match sweep.schedule {
                // Its slopes vanish at the ends of a plateau, which makes each change a STEP.
                Schedule::Stepped { .. } => Interpolation::MonotoneCubic,
                Schedule::Ramped { .. } => Interpolation::Linear,
            },
            windows: Vec::new(),
        };
        for &up in legs {
            let ends = if up { [first, last] } else { [last, first] };
            match sweep.schedule {
                Schedule::Stepped {
                    speeds,
                    settle_s,
                    measure_s,
                } => plan.add_plateaus(ends, up, speeds, [settle_s, measure_s]),
                Schedule::Ramped { ramp_s } => plan.add_ramp(ends, up, ramp_s),
            }
        }
        plan
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

    fn add_plateaus(
        &mut self,
        ends: [f64; 2],
        up: bool,
        count: usize,
        [settle_s, measure_s]: [f64; 2],
    ) {
        for i in 0..count {
            let share = i as f64 / (count - 1).max(1) as f64;
            let speed = (1.0 - share) * ends[0] + share * ends[1];
            let begin = match self.end() {
                None => {
                    self.point(0.0, speed);
                    0.0
                }
                Some((time_s, before)) => {
                    // At the turning point the plateau goes on.
                    if before.to_bits() != speed.to_bits() {
                        self.point(time_s + CHANGE * settle_s, speed);
                    }
                    time_s
                }
            };
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

    fn add_ramp(&mut self, [first, last]: [f64; 2], up: bool, duration_s: f64) {
        let begin = self.end().map_or(0.0, |(time_s, _)| time_s);
        if self.times_s.is_empty() {
            self.point(begin, first);
        }
        self.point(begin + duration_s, last);
        for i in 0..RAMP_WINDOWS {
            let edge = |i: usize| begin + duration_s * i as f64 / RAMP_WINDOWS as f64;
            let share = (i as f64 + 0.5) / RAMP_WINDOWS as f64;
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

    fn sweep(schedule: Schedule) -> SpeedSweep {
        SpeedSweep {
            motion: "driver".to_owned(),
            from_rad_per_s: 10.0,
            to_rad_per_s: 30.0,
            direction: Direction::UpDown,
            schedule,
        }
    }

    #[test]
    fn plateaus_hold_their_speed_and_changes_are_steps() {
        let plan = SpeedPlan::new(&sweep(Schedule::Stepped {
            speeds: 3,
            settle_s: 0.4,
            measure_s: 0.25,
        }));
        let speed = plan.function().unwrap();
        let speeds: Vec<f64> = plan.windows().iter().map(|w| w.speed_rad_per_s).collect();
        assert_eq!(speeds, [10.0, 20.0, 30.0, 30.0, 20.0, 10.0]);
        for window in plan.windows() {
            for t in [window.from_s - 0.29, window.from_s, window.to_s - 1e-9] {
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
        assert!((plan.end_s() - 6.0 * 0.65).abs() < 1e-12);
        assert!(plan.windows()[2].up && !plan.windows()[3].up);
    }

    #[test]
    fn a_ramp_is_cut_into_equal_windows() {
        let plan = SpeedPlan::new(&sweep(Schedule::Ramped { ramp_s: 2.0 }));
        let speed = plan.function().unwrap();
        assert_eq!(plan.end_s(), 4.0);
        for pair in plan.windows().windows(2) {
            assert!((pair[0].to_s - pair[1].from_s).abs() < 1e-12);
        }
        for window in plan.windows() {
            let middle = 0.5 * (window.from_s + window.to_s);
            assert!((speed.at(middle).value - window.speed_rad_per_s).abs() < 1e-9);
        }
    }
}
