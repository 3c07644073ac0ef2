//! Friction torque by Palmgren's model as T. A. Harris gives it (*Rolling Bearing Analysis*, chapter on friction): a
//! viscous part that the lubricant makes without load, a part by the load, and the seals. Formulas (R1) to (R3) of
//! docs/theory/rolling_bearings.md. Lengths in mm, viscosity in mm²/s, speed in rpm inside the formulas, as published.

use std::f64::consts::PI;

use crate::build_rows::half_taper_rad;
use crate::definition::{BallBearingKind, BearingDefinition, BearingGeometry};
use crate::element_load::ElementLoad;
use crate::operation::Operation;
use crate::quasi_static::RowLoads;
use crate::ratings::Ratings;
use crate::static_safety::axial_factor;

pub use crate::definition::friction_factors::{Friction, LoadFactor};

/// Friction of a bearing under its loads.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct FrictionTorque {
    /// By the lubricant \[N·m\].
    pub viscous_nm: f64,
    /// By the load \[N·m\].
    pub load_nm: f64,
    /// By the seals \[N·m\].
    pub seals_nm: f64,
    /// Speed of the rings against each other \[rad/s\].
    pub speed_rad_per_s: f64,
}

impl FrictionTorque {
    /// All together \[N·m\].
    #[must_use]
    pub fn total_nm(&self) -> f64 {
        self.viscous_nm + self.load_nm + self.seals_nm
    }

    /// What turns into heat \[W\].
    #[must_use]
    pub fn power_w(&self) -> f64 {
        self.total_nm() * self.speed_rad_per_s
    }
}

/// f₀ and f₁ by the type of bearing in an oil bath: Harris' tables, of ranges their middle;
/// docs/theory/rolling_bearings.md has a second source.
#[must_use]
pub fn usual_factors(geometry: &BearingGeometry) -> (f64, LoadFactor) {
    match geometry {
        BearingGeometry::Ball(g) => match g.kind {
            BallBearingKind::DeepGroove => (
                2.0,
                LoadFactor::OfStaticLoad {
                    factor: 0.0005,
                    power: 0.55,
                },
            ),
            // Files do not have the friction of the last two.
            BallBearingKind::AngularContact
            | BallBearingKind::FourPoint { .. }
            | BallBearingKind::Thrust => (
                3.3,
                LoadFactor::OfStaticLoad {
                    factor: 0.001,
                    power: 0.33,
                },
            ),
        },
        BearingGeometry::Roller(g) => match g.taper {
            None => (3.0, LoadFactor::Stated(0.0003)),
            Some(_) => (6.0, LoadFactor::Stated(0.0004)),
        },
    }
}

/// (νn)^⅔, constant below νn = 160^1.5 where the film's friction no longer falls.
fn speed_factor(viscosity: f64, speed_rpm: f64) -> f64 {
    (viscosity * speed_rpm).powf(2.0 / 3.0).max(160.0)
}

/// Radial and axial load of a row, of what its elements press the outer race with \[N\].
fn row_load_n(elements: &[ElementLoad]) -> (f64, f64) {
    let (mut x, mut y, mut axial) = (0.0, 0.0, 0.0);
    for e in elements {
        let (sine, cosine) = e.angle_rad.sin_cos();
        let across = e.outer_load_n * e.outer_contact_angle_rad.cos();
        x += across * cosine;
        y += across * sine;
        axial += e.outer_load_n * e.outer_contact_angle_rad.sin();
    }
    (f64::hypot(x, y), axial.abs())
}

/// The load P₁ that makes friction \[N\].
fn load_n(geometry: &BearingGeometry, (radial, axial): (f64, f64)) -> f64 {
    let thrust = match geometry {
        BearingGeometry::Ball(g) => match g.kind {
            BallBearingKind::DeepGroove => 3.0 * axial - 0.1 * radial,
            _ => 0.9 * axial / g.free_angle_rad.tan() - 0.1 * radial,
        },
        BearingGeometry::Roller(g) => g.taper.map_or(0.0, |taper| {
            let angle = taper.contact_angle_rad - half_taper_rad(g);
            0.8 * axial / angle.tan()
        }),
    };
    radial.max(thrust)
}

/// P₀ = X₀ F_r + Y₀ F_a of a row of balls by ISO 76, at least F_r; Y₀ = 0.5 where its table has no angle \[N\].
fn static_load_n(geometry: &BearingGeometry, (radial, axial): (f64, f64)) -> f64 {
    let (x, y) = match geometry {
        BearingGeometry::Ball(g) if g.kind == BallBearingKind::AngularContact => {
            let factor = axial_factor(g.free_angle_rad.to_degrees());
            (0.5, factor.unwrap_or(0.5))
        }
        _ => (0.6, 0.5),
    };
    radial.max(x * radial + y * axial)
}

impl Friction {
    /// Under the loads of all elements.
    ///
    /// ```text
    /// M₀ = 1e-7 f₀ (νn)^⅔ d_m³,   M₁ = f₁ P₁ d_m      N mm, a row
    /// ```
    #[must_use]
    pub fn torque(
        &self,
        definition: &BearingDefinition,
        loads: &RowLoads,
        operation: &Operation,
    ) -> FrictionTorque {
        let speed_rad_per_s = (operation.inner_rad_per_s - operation.outer_rad_per_s).abs();
        let pitch_mm = 1e3
            * match &definition.geometry {
                BearingGeometry::Ball(g) => g.pitch_diameter_m,
                BearingGeometry::Roller(g) => g.pitch_diameter_m,
            };
        let rows = loads.elements.len() as f64;
        let static_n = Ratings::of(definition).static_n / rows;
        let speed = speed_factor(self.viscosity_mm2_per_s, speed_rad_per_s * 30.0 / PI);
        let by_load = |row: &Vec<ElementLoad>| {
            let forces = row_load_n(row);
            let factor = match self.load_factor {
                LoadFactor::Stated(factor) => factor,
                LoadFactor::OfStaticLoad { factor, power } => {
                    factor * (static_load_n(&definition.geometry, forces) / static_n).powf(power)
                }
            };
            factor * load_n(&definition.geometry, forces) * pitch_mm
        };
        FrictionTorque {
            viscous_nm: 1e-3 * rows * 1e-7 * self.viscous_factor * speed * pitch_mm.powi(3),
            load_nm: 1e-3 * loads.elements.iter().map(by_load).sum::<f64>(),
            seals_nm: self.seals_nm,
            speed_rad_per_s,
        }
    }
}
