//! Functions of time with two derivatives, for loads and prescribed motion.

use crate::derivatives::Derivatives;
use crate::error::DynamicsError;
use crate::host_function::HostFunction;
use crate::table::Table;

/// A function of time. Its unit is that of what it drives; times are in seconds.
#[derive(Debug, Clone, PartialEq)]
pub enum TimeFunction {
    /// y = c
    Constant(f64),
    /// y = y₀ + s t
    Linear {
        /// Value at t = 0.
        at_zero: f64,
        /// Change per second.
        slope_per_s: f64,
    },
    /// STEP: y₀ before t₀, y₁ after t₁, y₀ + (y₁ − y₀) x² (3 − 2x) between, x = (t − t₀)/(t₁ − t₀). Continuous with its
    /// first derivative; the second jumps at both ends.
    Step(Step),
    /// y = c + A sin(2π f t + φ)
    Sine {
        /// Mean value c.
        offset: f64,
        /// Amplitude A.
        amplitude: f64,
        /// Frequency f.
        frequency_hz: f64,
        /// Phase φ.
        phase_rad: f64,
    },
    /// Interpolated from a table, end values held outside.
    Table(Table),
    /// Sum of functions.
    Sum(Vec<TimeFunction>),
    /// Product of two functions.
    Product(Box<TimeFunction>, Box<TimeFunction>),
    /// Computed by the calling program.
    Host(HostFunction),
}

/// The parameters of [`TimeFunction::Step`]; made by [`TimeFunction::step`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Step {
    start_s: f64,
    from: f64,
    end_s: f64,
    to: f64,
}

impl TimeFunction {
    /// STEP from (`start_s`, `from`) to (`end_s`, `to`).
    ///
    /// # Errors
    /// [`DynamicsError::Step`] if the end does not come after the start or a number is not finite.
    pub fn step(start_s: f64, from: f64, end_s: f64, to: f64) -> Result<Self, DynamicsError> {
        let finite = [start_s, from, end_s, to].iter().all(|y| y.is_finite());
        if !finite || end_s <= start_s {
            return Err(DynamicsError::Step { start_s, end_s });
        }
        Ok(Self::Step(Step {
            start_s,
            from,
            end_s,
            to,
        }))
    }

    /// Value and derivatives at a time. At a corner the derivative is that to the right.
    #[must_use]
    pub fn at(&self, time_s: f64) -> Derivatives {
        match self {
            Self::Constant(value) => Derivatives {
                value: *value,
                ..Derivatives::default()
            },
            Self::Linear {
                at_zero,
                slope_per_s,
            } => Derivatives {
                value: at_zero + slope_per_s * time_s,
                rate: *slope_per_s,
                acceleration: 0.0,
            },
            Self::Step(step) => step.at(time_s),
            Self::Sine {
                offset,
                amplitude,
                frequency_hz,
                phase_rad,
            } => {
                let omega = std::f64::consts::TAU * frequency_hz;
                let (sine, cosine) = (omega * time_s + phase_rad).sin_cos();
                Derivatives {
                    value: offset + amplitude * sine,
                    rate: omega * amplitude * cosine,
                    acceleration: -omega * omega * amplitude * sine,
                }
            }
            Self::Table(table) => table.at(time_s),
            Self::Host(function) => function.at(time_s),
            Self::Sum(terms) => terms.iter().fold(Derivatives::default(), |sum, term| {
                let y = term.at(time_s);
                Derivatives {
                    value: sum.value + y.value,
                    rate: sum.rate + y.rate,
                    acceleration: sum.acceleration + y.acceleration,
                }
            }),
            Self::Product(left, right) => {
                let (a, b) = (left.at(time_s), right.at(time_s));
                Derivatives {
                    value: a.value * b.value,
                    rate: a.rate * b.value + a.value * b.rate,
                    acceleration: a.acceleration * b.value
                        + 2.0 * a.rate * b.rate
                        + a.value * b.acceleration,
                }
            }
        }
    }

    /// ∫₀ᵗ y dt; `None` for a product and for what the calling program computes, whose integrals have no closed form
    /// here.
    #[must_use]
    pub fn integral(&self, time_s: f64) -> Option<f64> {
        match self {
            Self::Constant(value) => Some(value * time_s),
            Self::Linear {
                at_zero,
                slope_per_s,
            } => Some(time_s * (at_zero + 0.5 * slope_per_s * time_s)),
            Self::Step(step) => Some(step.integral(time_s) - step.integral(0.0)),
            Self::Sine {
                offset,
                amplitude,
                frequency_hz,
                phase_rad,
            } => {
                let omega = std::f64::consts::TAU * frequency_hz;
                if omega == 0.0 {
                    return Some(time_s * (offset + amplitude * phase_rad.sin()));
                }
                let swing =
                    amplitude / omega * (phase_rad.cos() - (omega * time_s + phase_rad).cos());
                Some(offset * time_s + swing)
            }
            Self::Table(table) => Some(table.integral(time_s) - table.integral(0.0)),
            Self::Sum(terms) => terms
                .iter()
                .try_fold(0.0, |sum, term| Some(sum + term.integral(time_s)?)),
            Self::Product(..) | Self::Host(_) => None,
        }
    }
}

impl Step {
    fn at(&self, time_s: f64) -> Derivatives {
        let length = self.end_s - self.start_s;
        let x = (time_s - self.start_s) / length;
        let rise = self.to - self.from;
        if !(0.0..1.0).contains(&x) {
            let value = if x < 0.0 { self.from } else { self.to };
            return Derivatives {
                value,
                ..Derivatives::default()
            };
        }
        Derivatives {
            value: self.from + rise * x * x * (3.0 - 2.0 * x),
            rate: rise * 6.0 * x * (1.0 - x) / length,
            acceleration: rise * (6.0 - 12.0 * x) / (length * length),
        }
    }

    /// Integral from `start_s`.
    fn integral(&self, time_s: f64) -> f64 {
        let length = self.end_s - self.start_s;
        let x = ((time_s - self.start_s) / length).clamp(0.0, 1.0);
        let inside = length * (self.from * x + (self.to - self.from) * x.powi(3) * (1.0 - 0.5 * x));
        let before = (time_s - self.start_s).min(0.0) * self.from;
        let after = (time_s - self.end_s).max(0.0) * self.to;
        before + inside + after
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::table::Interpolation;

    fn functions() -> Vec<TimeFunction> {
        let sine = TimeFunction::Sine {
            offset: 0.3,
            amplitude: 2.0,
            frequency_hz: 0.7,
            phase_rad: 0.4,
        };
        let step = TimeFunction::step(0.5, -1.0, 2.0, 3.0).unwrap();
        let points = |kind| {
            let times = vec![-0.5, 0.4, 1.0, 1.7, 2.6];
            let table = Table::new("t", times, vec![1.0, 2.0, 2.5, 0.0, 0.1], kind);
            TimeFunction::Table(table.unwrap())
        };
        vec![
            TimeFunction::Constant(4.0),
            TimeFunction::Linear {
                at_zero: 1.0,
                slope_per_s: -2.0,
            },
            step.clone(),
            sine.clone(),
            points(Interpolation::Linear),
            points(Interpolation::MonotoneCubic),
            TimeFunction::Sum(vec![sine.clone(), step.clone()]),
            TimeFunction::Product(Box::new(sine), Box::new(step)),
        ]
    }

    #[test]
    fn derivatives_and_integral_fit_the_value() {
        for f in functions() {
            for t in [-0.9, 0.21, 0.77, 1.5, 2.41, 3.3] {
                let h = 1e-5;
                let [before, here, after] = [t - h, t, t + h].map(|t| f.at(t));
                assert!(((after.value - before.value) / (2.0 * h) - here.rate).abs() < 1e-7);
                assert!(((after.rate - before.rate) / (2.0 * h) - here.acceleration).abs() < 1e-6);
                if let (Some(a), Some(b)) = (f.integral(t - h), f.integral(t + h)) {
                    assert!(
                        ((b - a) / (2.0 * h) - here.value).abs() < 1e-8,
                        "{f:?} at {t}"
                    );
                    assert!(f.integral(0.0).unwrap().abs() < 1e-15);
                }
            }
        }
    }

    #[test]
    fn step_must_go_forward() {
        assert!(TimeFunction::step(1.0, 0.0, 1.0, 2.0).is_err());
        assert!(TimeFunction::step(0.0, f64::NAN, 1.0, 2.0).is_err());
    }
}
