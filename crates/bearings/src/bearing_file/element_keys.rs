//! What balls and rollers share: their number, size and circle, and the clearance.

use std::fmt;

use gearmesh_geometry::InputError;
use gearmesh_geometry::input::TableKeys;

use super::UM;

/// Balls or rollers of a row at most: those of the largest slewing bearings are a few hundred.
const MOST_ELEMENTS: f64 = 1000.0;

/// A row has at least this share of the rollers that go round: fewer carry no ring of that size.
const LEAST_OF_ROLLERS: f64 = 0.1;

/// Balls and rollers may be too large for their rings by this share of their diameter: for balls of 8 mm 80 um,
/// several times what tight fits take away.
const MOST_INTERFERENCE: f64 = 0.01;

/// Share of a limit of the clearance within which a number counts as the limit: 0.52 + 0.53 − 1 is not 0.05 to the
/// last digit.
const ROUNDING: f64 = 1e-12;

/// Balls or rollers on their circle.
pub(super) struct Elements {
    pub number: usize,
    pub diameter_mm: f64,
    pub pitch_mm: f64,
}

impl Elements {
    /// A number of balls of a diameter on a pitch diameter \[mm\].
    pub fn balls(stated: (usize, f64, f64), keys: &TableKeys<'_>) -> Result<Self, InputError> {
        Self::checked(["ball", "balls"], stated, 0.0, keys)
    }

    /// The same of rollers.
    pub fn rollers(stated: (usize, f64, f64), keys: &TableKeys<'_>) -> Result<Self, InputError> {
        Self::checked(["roller", "rollers"], stated, LEAST_OF_ROLLERS, keys)
    }

    fn checked(
        [word, number_key]: [&str; 2],
        (number, diameter_mm, pitch_mm): (usize, f64, f64),
        least_share: f64,
        keys: &TableKeys<'_>,
    ) -> Result<Self, InputError> {
        let allowed = format!("more than the {word}'s diameter, {diameter_mm}");
        keys.require(
            "pitch_diameter_mm",
            pitch_mm,
            pitch_mm > diameter_mm,
            &allowed,
        )?;
        // Neighbours must not touch.
        let room = (std::f64::consts::PI / (diameter_mm / pitch_mm).asin()).floor();
        let least = (least_share * room).ceil().max(3.0);
        let allowed = match room <= MOST_ELEMENTS {
            true => format!(
                "{least} to {room}, as many {number_key} of {diameter_mm} mm as go round on {pitch_mm} mm"
            ),
            false => format!("{least} to {MOST_ELEMENTS}"),
        };
        let is_within = (least..=room.min(MOST_ELEMENTS)).contains(&(number as f64));
        keys.require(number_key, number as f64, is_within, &allowed)?;
        Ok(Self {
            number,
            diameter_mm,
            pitch_mm,
        })
    }
}

/// Radial clearances that a bearing can have: down to an interference of a hundredth of the diameter of its balls or
/// rollers, up to, not including, a most.
pub(super) struct Clearances {
    least_m: f64,
    most_m: f64,
    word: &'static str,
    why: &'static str,
}

impl Clearances {
    /// Of balls of a diameter that touch both grooves up to the clearance `most_m`.
    pub fn of_balls(diameter_m: f64, most_m: f64) -> Self {
        Self {
            least_m: -MOST_INTERFERENCE * diameter_m,
            most_m,
            word: "ball",
            why: ": with more no ball touches both rings",
        }
    }

    /// Of rollers of a diameter.
    pub fn of_rollers(diameter_m: f64) -> Self {
        Self {
            least_m: -MOST_INTERFERENCE * diameter_m,
            most_m: 1e-3,
            word: "roller",
            why: "",
        }
    }

    /// Whether balls or rollers go in between.
    pub fn holds_elements(&self, clearance_m: f64) -> bool {
        clearance_m >= self.least_m
    }

    /// Whether balls or rollers touch both rings somewhere.
    pub fn touches(&self, clearance_m: f64) -> bool {
        clearance_m < self.most_m * (1.0 - ROUNDING)
    }

    /// Whether a bearing can have it.
    pub fn allows(&self, clearance_m: f64) -> bool {
        self.holds_elements(clearance_m) && self.touches(clearance_m)
    }

    /// `radial_clearance_um`, 0 where it is not given, in metres.
    pub fn stated_m(
        &self,
        stated_um: Option<f64>,
        keys: &TableKeys<'_>,
    ) -> Result<f64, InputError> {
        let um = stated_um.unwrap_or(0.0);
        let clearance_m = UM * um;
        keys.require(
            "radial_clearance_um",
            um,
            self.allows(clearance_m),
            &self.to_string(),
        )?;
        Ok(clearance_m)
    }
}

impl fmt::Display for Clearances {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            to,
            "{:.1} (interference of a hundredth of the {}'s diameter) up to, not including, {:.1}{}",
            self.least_m / UM,
            self.word,
            self.most_m / UM,
            self.why
        )
    }
}
