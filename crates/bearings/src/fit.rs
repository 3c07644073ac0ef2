//! Fits and heat: from the clearance of a bearing on the shelf to that of a bearing in operation.
//!
//! Rings, shaft and housing are cylinders in plane stress (Lamé); a ring's raceway is the cylinder of its diameter at
//! the groove's bottom or the roller's middle. Formulas (F1) to (F3) of docs/theory/rolling_bearings.md.

use crate::build_rows::half_taper_rad;
use crate::definition::{BearingDefinition, BearingGeometry};
use crate::row::Row;

pub use crate::definition::seats::{Fit, Seat};

/// A seat in operation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SeatInOperation {
    /// By how much the diameters overlap once all have their temperatures; negative: loose \[m\].
    pub interference_m: f64,
    /// Pressure between ring and seat; 0 where the ring is loose \[Pa\].
    pub pressure_pa: f64,
    /// Largest stress round the ring: tension at the bore of an inner, compression at the raceway of an outer one
    /// \[Pa\].
    pub hoop_stress_pa: f64,
    /// Change of the raceway's diameter by the pressure \[m\].
    pub raceway_m: f64,
}

/// From the stated to the operating clearance, term by term: changes of the radial clearance, positive where it grows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OperatingClearance {
    /// Of the bearing on the shelf \[m\].
    pub stated_m: f64,
    /// By the shaft that widens the inner ring \[m\].
    pub by_shaft_m: f64,
    /// By the housing that squeezes the outer ring \[m\].
    pub by_housing_m: f64,
    /// By the heat of the inner ring \[m\].
    pub by_inner_heat_m: f64,
    /// By the heat of the outer ring \[m\].
    pub by_outer_heat_m: f64,
    /// By the heat of balls or rollers \[m\].
    pub by_element_heat_m: f64,
    /// The seat on the shaft.
    pub shaft: Option<SeatInOperation>,
    /// The seat in the housing.
    pub housing: Option<SeatInOperation>,
}

impl OperatingClearance {
    /// In operation; negative: interference \[m\].
    #[must_use]
    pub fn operating_m(&self) -> f64 {
        self.stated_m + self.change_m()
    }

    /// By how much it grows \[m\].
    #[must_use]
    pub fn change_m(&self) -> f64 {
        self.by_shaft_m
            + self.by_housing_m
            + self.by_inner_heat_m
            + self.by_outer_heat_m
            + self.by_element_heat_m
    }

    /// Growth of the inner and of the outer raceway against the balls or rollers, as radii \[m\].
    fn races_m(&self) -> [f64; 2] {
        // Half of what the elements grow is felt at each race.
        let element = 0.25 * self.by_element_heat_m;
        [
            -0.5 * (self.by_shaft_m + self.by_inner_heat_m) - element,
            0.5 * (self.by_housing_m + self.by_outer_heat_m) + element,
        ]
    }

    /// Moves the races of a row that was built with the stated clearance.
    pub(crate) fn apply(&self, row: &mut Row) {
        let [inner, outer] = self.races_m();
        match row {
            Row::Ball(row) => {
                row.inner.centre_radius_m += inner;
                row.outer.centre_radius_m += outer;
            }
            // Files do not have the fits of these.
            Row::FourPoint(_) | Row::Barrel(_) => {}
            Row::Roller(row) => {
                row.inner.offset_m += row.inner.normal.0 * inner;
                row.outer.offset_m += row.outer.normal.0 * outer;
                if let Some(rib) = &mut row.rib {
                    rib.offset_m += rib.normal.0 * inner;
                }
            }
        }
    }
}

/// Ratio (b² + a²)/(b² − a²) of a cylinder between the diameters a < b, whose pressed surface widens by p d (ratio ±
/// ν)/E.
fn ratio(a: f64, b: f64) -> f64 {
    (b * b + a * a) / (b * b - a * a)
}

/// What a seat presses into or out of a ring between its seated diameter and its raceway. `sense` is 1 for the inner
/// ring round a shaft, −1 for the outer ring in a housing.
fn seated(
    seat: &Seat,
    (seated_m, raceway_m): (f64, f64),
    (young_pa, poisson): (f64, f64),
    ring_growth: f64,
    sense: f64,
) -> SeatInOperation {
    let growth = seat.expansion_per_k * seat.rise_k;
    let interference_m = seat.interference_m + sense * seated_m * (growth - ring_growth);
    let between = |a: f64, b: f64| ratio(a.min(b), a.max(b));
    let ring = (between(seated_m, raceway_m) + sense * poisson) / young_pa;
    let held = (between(seat.far_diameter_m, seated_m) - sense * seat.poisson) / seat.young_pa;
    let pressure_pa = (interference_m / (seated_m * (ring + held))).max(0.0);
    let section = (raceway_m * raceway_m - seated_m * seated_m).abs();
    // Round the free surface of a ring under p at the other one: 2 p d²/(F² − d²).
    let free_pa = 2.0 * pressure_pa * seated_m * seated_m / section;
    SeatInOperation {
        interference_m,
        pressure_pa,
        hoop_stress_pa: if sense > 0.0 {
            pressure_pa * between(seated_m, raceway_m)
        } else {
            0.0 - free_pa
        },
        raceway_m: sense * raceway_m * free_pa / young_pa,
    }
}

/// Diameters of the raceways, inner and outer: of grooves at their bottoms, of tapered races at the rollers' middle
/// \[m\].
#[must_use]
pub fn raceways_m(geometry: &BearingGeometry) -> [f64; 2] {
    match geometry {
        BearingGeometry::Ball(g) => {
            let (inner, outer) = g.raceway_diameters_m();
            [inner, outer]
        }
        BearingGeometry::Roller(g) => {
            let axis = g
                .taper
                .map_or(0.0, |t| t.contact_angle_rad - half_taper_rad(g));
            let across = g.diameter_m * axis.cos();
            [g.pitch_diameter_m - across, g.pitch_diameter_m + across]
        }
    }
}

impl BearingDefinition {
    /// The clearance in operation, term by term; none without a fit.
    #[must_use]
    pub fn operating_clearance(&self) -> Option<OperatingClearance> {
        let fit = self.fit.as_ref()?;
        let [inner_m, outer_m] = raceways_m(&self.geometry);
        let (stated_m, element_m) = match &self.geometry {
            BearingGeometry::Ball(g) => (g.radial_clearance_m(), g.ball_diameter_m),
            BearingGeometry::Roller(g) => (g.radial_clearance_m, g.diameter_m),
        };
        let ring = self.ring_material.elastic();
        let growth =
            [fit.inner_rise_k, fit.outer_rise_k].map(|rise| fit.ring_expansion_per_k * rise);
        let shaft =
            (fit.shaft).map(|seat| seated(&seat, (fit.bore_m, inner_m), ring, growth[0], 1.0));
        let housing = (fit.housing)
            .map(|seat| seated(&seat, (fit.outside_m, outer_m), ring, growth[1], -1.0));
        let raceway = |seat: Option<SeatInOperation>| seat.map_or(0.0, |seat| seat.raceway_m);
        Some(OperatingClearance {
            stated_m,
            by_shaft_m: -raceway(shaft),
            by_housing_m: raceway(housing),
            by_inner_heat_m: -inner_m * growth[0],
            by_outer_heat_m: outer_m * growth[1],
            by_element_heat_m: -2.0 * element_m * fit.element_expansion_per_k * fit.element_rise_k,
            shaft,
            housing,
        })
    }
}
