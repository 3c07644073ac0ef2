//! Friction between a ball and a surface against their slip s: T = κ(F, |s|) s, opposing it and smooth at zero.
//!
//! | law | T/F or T |
//! | --- | --- |
//! | Coulomb | μ s/√(s² + s₀²) |
//! | table | μ(s) by points, without overshoot between them; T = 0 at s = 0 |
//! | fluid | A τ_E asinh(η s/(τ_E h)), η = η₀ exp(α p̄): K. L. Johnson, J. L. Tevaarwerk, *Shear behaviour of elastohydrodynamic oil films*, Proc. R. Soc. A 356 (1977) 215-236 |
//!
//! A = πab is the Hertz ellipse under F, p̄ = F/A its mean pressure, h the thickness of the film, which is given. A ∝
//! F^⅔, so that p̄ ∝ F^⅓.

use std::f64::consts::PI;

use gearmesh_dynamics::{Interpolation, Table};

use crate::error::BearingError;
use crate::point_contact::PointContact;

/// A law of friction.
#[derive(Debug, Clone)]
pub enum Traction {
    /// μ s/√(s² + s₀²).
    Coulomb {
        /// μ.
        coefficient: f64,
        /// s₀ \[m/s\]: the slip at which the coefficient has come to 71 % of μ.
        transition_speed_m_per_s: f64,
    },
    /// μ(s) by points from (0, 0) on; the last value goes on.
    Table(Table),
    /// A film of fluid.
    Fluid(FluidTraction),
}

/// A film that shears by Eyring's law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FluidTraction {
    /// η₀ \[Pa·s\].
    pub viscosity_pa_s: f64,
    /// α \[1/Pa\].
    pub pressure_viscosity_per_pa: f64,
    /// τ_E \[Pa\].
    pub eyring_stress_pa: f64,
    /// h \[m\].
    pub film_thickness_m: f64,
}

/// κ and its derivatives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Slip {
    /// κ = T/s \[N·s/m\].
    pub resistance: f64,
    /// ∂κ/∂F.
    pub by_load: f64,
    /// (∂κ/∂s)/s, finite at zero.
    pub by_half_square: f64,
}

impl Traction {
    /// Coulomb friction.
    ///
    /// # Errors
    /// [`BearingError::Parameter`] where the coefficient is negative or the speed not positive.
    pub fn coulomb(coefficient: f64, transition_speed_m_per_s: f64) -> Result<Self, BearingError> {
        BearingError::not_negative("the coefficient of friction", coefficient)?;
        BearingError::positive("the transition speed in m/s", transition_speed_m_per_s)?;
        Ok(Self::Coulomb {
            coefficient,
            transition_speed_m_per_s,
        })
    }

    /// A table of slip \[m/s\] and coefficient; (0, 0) is put before it.
    ///
    /// # Errors
    /// [`BearingError::Parameter`] where slips do not rise from above 0, or a coefficient is negative.
    pub fn table(points: &[(f64, f64)]) -> Result<Self, BearingError> {
        let mut speeds = vec![0.0];
        let mut values = vec![0.0];
        for &(speed, value) in points {
            BearingError::require(
                "a slip of the traction table in m/s",
                speed,
                speed > speeds[speeds.len() - 1] && speed.is_finite(),
                "above the one before it, the first above 0",
            )?;
            BearingError::not_negative("a coefficient of the traction table", value)?;
            speeds.push(speed);
            values.push(value);
        }
        let table = Table::new("traction", speeds, values, Interpolation::MonotoneCubic);
        let table = table.map_err(|_| BearingError::Parameter {
            what: "the number of points of the traction table",
            found: points.len() as f64,
            allowed: "at least one",
        })?;
        Ok(Self::Table(table))
    }

    /// κ under a load F \[N\] at a slip \[m/s\], in a contact.
    pub(crate) fn slip(&self, contact: &PointContact, load_n: f64, slip_m_per_s: f64) -> Slip {
        match self {
            Self::Coulomb {
                coefficient,
                transition_speed_m_per_s,
            } => {
                let square = slip_m_per_s.powi(2) + transition_speed_m_per_s.powi(2);
                let per_load = coefficient / square.sqrt();
                Slip {
                    resistance: load_n * per_load,
                    by_load: per_load,
                    by_half_square: -load_n * per_load / square,
                }
            }
            Self::Table(table) => of_table(table, load_n, slip_m_per_s),
            Self::Fluid(fluid) => fluid.slip(contact, load_n, slip_m_per_s),
        }
    }
}

fn of_table(table: &Table, load_n: f64, slip: f64) -> Slip {
    let at = table.at(slip);
    // Below the smallest slip that matters the table is a line.
    if slip < 1e-9 {
        return Slip {
            resistance: load_n * at.rate,
            by_load: at.rate,
            by_half_square: 0.0,
        };
    }
    let per_load = at.value / slip;
    Slip {
        resistance: load_n * per_load,
        by_load: per_load,
        by_half_square: load_n * (at.rate - per_load) / (slip * slip),
    }
}

impl FluidTraction {
    /// A film with these properties.
    ///
    /// # Errors
    /// [`BearingError::Parameter`] where a number is not positive (α may be 0).
    pub fn validated(self) -> Result<Self, BearingError> {
        BearingError::positive("the viscosity in Pa s", self.viscosity_pa_s)?;
        BearingError::positive("the Eyring stress in Pa", self.eyring_stress_pa)?;
        BearingError::positive("the film thickness in m", self.film_thickness_m)?;
        let alpha = self.pressure_viscosity_per_pa;
        BearingError::not_negative("the pressure-viscosity coefficient in 1/Pa", alpha)?;
        Ok(self)
    }

    fn slip(&self, contact: &PointContact, load_n: f64, slip: f64) -> Slip {
        if load_n <= 0.0 {
            return Slip {
                resistance: 0.0,
                by_load: 0.0,
                by_half_square: 0.0,
            };
        }
        let ellipse = contact.ellipse(load_n);
        let area = PI * ellipse.half_length_m * ellipse.half_width_m;
        let rise = self.pressure_viscosity_per_pa * load_n / area;
        let shear = self.viscosity_pa_s * rise.exp() / self.film_thickness_m;
        let x = shear * slip / self.eyring_stress_pa;
        let root = (1.0 + x * x).sqrt();
        // asinh(x)/x and its derivative over x.
        let (share, share_by) = if x < 1e-3 {
            (1.0 - x * x / 6.0, -1.0 / 3.0 + 0.3 * x * x)
        } else {
            let share = x.asinh() / x;
            (share, (1.0 / root - share) / (x * x))
        };
        let resistance = area * shear * share;
        Slip {
            resistance,
            by_load: (2.0 * resistance + area * shear * rise / root) / (3.0 * load_n),
            by_half_square: area * shear * share_by * (shear / self.eyring_stress_pa).powi(2),
        }
    }
}
