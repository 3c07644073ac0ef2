//! `[blank.slots]` and `[blank.holes]`: openings of the body.

use super::blank_table::LEAST_WALL;
use super::{MM, TableKeys};
use crate::blank::{Holes, Openings, Slots};
use crate::input::{Bounded, Count, End, InputDocument, InputError, Positive, Within};
use crate::number_range;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

number_range!(
    /// Angles that a slot covers in degrees.
    SlotWidth: End::Beyond(0.0), End::Beyond(180.0)
);

/// The keys of `[blank.slots]`.
#[derive(Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct SlotsTable {
    /// Number round the axis.
    count: Count<1, 200>,
    /// Inner radius.
    inner_radius_mm: Bounded<Positive>,
    /// Outer radius.
    outer_radius_mm: f64,
    /// Angle that one slot covers.
    width_deg: Bounded<SlotWidth>,
    /// Angle of the first one's middle from tooth 0.
    phase_deg: Bounded<Within<-360, 360>>,
    /// Radius of the corners.
    corner_radius_mm: f64,
}

/// The keys of `[blank.holes]`.
#[derive(Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct HolesTable {
    /// Number round the axis.
    count: Count<1, 200>,
    /// Diameter of the circle through the holes' centres.
    pitch_circle_diameter_mm: f64,
    /// Diameter of a hole.
    diameter_mm: f64,
    /// Angle of the first one's middle from tooth 0.
    phase_deg: Bounded<Within<-360, 360>>,
}

impl SlotsTable {
    /// The slots, in SI units.
    fn check(self, document: &InputDocument, least_mm: f64) -> Result<Slots, InputError> {
        let keys = TableKeys::new(document, "blank.slots");
        keys.require(
            "outer_radius_mm",
            self.outer_radius_mm,
            self.outer_radius_mm >= *self.inner_radius_mm + least_mm,
            &format!("at least inner_radius_mm and {least_mm:.4}, a thousandth of a module"),
        )?;
        let narrowest_deg = (least_mm / *self.inner_radius_mm).to_degrees();
        keys.require(
            "width_deg",
            *self.width_deg,
            *self.width_deg >= narrowest_deg,
            &format!("at least {narrowest_deg:.4}: a thousandth of a module at inner_radius_mm"),
        )?;
        let height = self.outer_radius_mm - *self.inner_radius_mm;
        let chord = *self.inner_radius_mm * self.width_deg.to_radians();
        let largest = 0.45 * height.min(chord);
        keys.require(
            "corner_radius_mm",
            self.corner_radius_mm,
            self.corner_radius_mm >= 0.1 * least_mm && self.corner_radius_mm <= largest,
            &format!(
                "at least {:.5}, a ten-thousandth of a module, and at most {largest:.4}: a little less than half of the slot's height and inner width",
                0.1 * least_mm
            ),
        )?;
        Ok(Slots {
            count: self.count.get(),
            inner_radius_m: *self.inner_radius_mm * MM,
            outer_radius_m: self.outer_radius_mm * MM,
            width_rad: self.width_deg.to_radians(),
            phase_rad: self.phase_deg.to_radians(),
            corner_radius_m: self.corner_radius_mm * MM,
        })
    }
}

impl HolesTable {
    /// The holes, in SI units.
    fn check(self, document: &InputDocument, least_mm: f64) -> Result<Holes, InputError> {
        let keys = TableKeys::new(document, "blank.holes");
        keys.require(
            "diameter_mm",
            self.diameter_mm,
            self.diameter_mm >= least_mm,
            &format!("at least {least_mm:.4}, a thousandth of a module"),
        )?;
        keys.require(
            "pitch_circle_diameter_mm",
            self.pitch_circle_diameter_mm,
            self.pitch_circle_diameter_mm > self.diameter_mm,
            "more than diameter_mm",
        )?;
        Ok(Holes {
            count: self.count.get(),
            pitch_radius_m: 0.5 * self.pitch_circle_diameter_mm * MM,
            radius_m: 0.5 * self.diameter_mm * MM,
            phase_rad: self.phase_deg.to_radians(),
        })
    }
}

/// The openings, in SI units; they must fit the body between the radii `body_mm` and leave spokes.
pub(super) fn check_openings(
    slots: Option<SlotsTable>,
    holes: Option<HolesTable>,
    document: &InputDocument,
    body_mm: (f64, f64),
    module_m: f64,
) -> Result<Option<Openings>, InputError> {
    let least_mm = LEAST_WALL * module_m / MM;
    let (key, openings) = match (slots, holes) {
        (None, None) => return Ok(None),
        (Some(_), Some(_)) => {
            return Err(document.error(
                "blank.holes",
                "slots and holes are both given; a blank has one kind of opening",
            ));
        }
        (Some(slots), None) => (
            "blank.slots",
            Openings::Slots(slots.check(document, least_mm)?),
        ),
        (None, Some(holes)) => (
            "blank.holes",
            Openings::Holes(holes.check(document, least_mm)?),
        ),
    };
    check_fit(&openings, body_mm, module_m)
        .and_then(|()| check_spokes(&openings, module_m))
        .map_err(|problem| document.error(key, problem))?;
    Ok(Some(openings))
}

fn check_fit(openings: &Openings, body_mm: (f64, f64), module_m: f64) -> Result<(), String> {
    let (inner_m, outer_m) = openings.radii_m();
    let (inner_mm, outer_mm) = (inner_m / MM, outer_m / MM);
    let margin_mm = 0.25 * module_m / MM;
    let (least_mm, largest_mm) = (body_mm.0 + margin_mm, body_mm.1 - margin_mm);
    if inner_mm < least_mm || outer_mm > largest_mm {
        return Err(format!(
            "they reach from radius {inner_mm:.3} to {outer_mm:.3} mm; allowed is {least_mm:.3} to {largest_mm:.3} mm, a quarter module inside the body's edges"
        ));
    }
    Ok(())
}

fn check_spokes(openings: &Openings, module_m: f64) -> Result<(), String> {
    let width_rad = 2.0 * openings.half_width_rad();
    let spoke_rad = TAU / openings.count() as f64 - width_rad;
    let least_rad = module_m / openings.radii_m().0;
    if spoke_rad < least_rad {
        return Err(format!(
            "{} openings of {:.3} deg meet: {:.3} deg are left between them, allowed is at least {:.3} deg (one module at their inner radius)",
            openings.count(),
            width_rad.to_degrees(),
            spoke_rad.to_degrees(),
            least_rad.to_degrees()
        ));
    }
    Ok(())
}
