//! `[bevel]`: teeth and blank of a pair.

use gearmesh_geometry::InputError;
use gearmesh_geometry::input::{InputDocument, TableKeys};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::blank::{PairBlank, PairData, Taper, ToothForm};
use crate::error::BevelError;
use crate::hand::Hand;

/// Teeth and blank. Lists of two: pinion, gear.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct BlankTable {
    /// Form of the teeth; "spiral" where not given.
    form: Option<ToothForm>,
    /// Numbers of teeth.
    teeth: [usize; 2],
    /// Transverse module at the heel.
    outer_module_mm: f64,
    /// Face widths, both from the same outer cone distance inwards.
    face_width_mm: [f64; 2],
    /// "spiral": mean spiral angle.
    spiral_angle_deg: Option<f64>,
    /// Normal pressure angle; 20 where not given.
    pressure_angle_deg: Option<f64>,
    /// Angle between the axes, both from apex to heel; 90 where not given.
    shaft_angle_deg: Option<f64>,
    /// "spiral", "zerol": hand of the pinion; the gear has the other.
    pinion_hand: Option<Hand>,
    /// Depth along the face; "standard" where not given.
    taper: Option<Taper>,
    /// "spiral", "zerol": nominal radius of the face mill.
    cutter_radius_mm: Option<f64>,
    /// By how much of a module the pinion's outer tooth is thicker, and the gear's thinner, than by the balance of
    /// addenda; 0 where not given.
    thickness_shift: Option<f64>,
    /// Normal backlash at the mean point; 0 where not given.
    backlash_mm: Option<f64>,
}

impl BlankTable {
    pub(super) fn blank(&self, document: &InputDocument) -> Result<PairBlank, InputError> {
        let keys = TableKeys::new(document, "bevel");
        let form = self.form.unwrap_or(ToothForm::Spiral);
        let word = match form {
            ToothForm::Spiral => "spiral",
            ToothForm::Zerol => "zerol",
            ToothForm::Straight => "straight",
        };
        const MILLED: &[&str] = &["spiral", "zerol"];
        keys.refuse_unused(
            ("form", word),
            &[
                (
                    "spiral_angle_deg",
                    self.spiral_angle_deg.is_some(),
                    &["spiral"],
                ),
                ("pinion_hand", self.pinion_hand.is_some(), MILLED),
                ("cutter_radius_mm", self.cutter_radius_mm.is_some(), MILLED),
            ],
        )?;
        for (i, &teeth) in self.teeth.iter().enumerate() {
            if !(5..=1000).contains(&teeth) {
                return Err(keys.error(
                    &format!("teeth.{i}"),
                    format!("found {teeth}, allowed is 5 to 1000"),
                ));
            }
        }
        keys.require(
            "outer_module_mm",
            self.outer_module_mm,
            self.outer_module_mm > 0.0,
            "more than 0",
        )?;
        for (i, &width) in self.face_width_mm.iter().enumerate() {
            keys.require(
                &format!("face_width_mm.{i}"),
                width,
                width > 0.0,
                "more than 0",
            )?;
        }
        let spiral = match form {
            ToothForm::Spiral => {
                let angle = keys.needed(
                    "spiral_angle_deg",
                    self.spiral_angle_deg,
                    "form = \"spiral\"",
                )?;
                keys.require(
                    "spiral_angle_deg",
                    angle,
                    angle > 0.0 && angle <= 50.0,
                    "more than 0, at most 50",
                )?;
                angle
            }
            ToothForm::Zerol | ToothForm::Straight => 0.0,
        };
        let hand = match form {
            ToothForm::Straight => Hand::Right,
            _ => keys.needed("pinion_hand", self.pinion_hand, "a face-milled pair")?,
        };
        let radius = match form {
            ToothForm::Straight => 0.0,
            _ => {
                let radius = keys.needed(
                    "cutter_radius_mm",
                    self.cutter_radius_mm,
                    "a face-milled pair",
                )?;
                keys.require("cutter_radius_mm", radius, radius > 0.0, "more than 0")?;
                radius
            }
        };
        let pressure = self.pressure_angle_deg.unwrap_or(20.0);
        keys.require(
            "pressure_angle_deg",
            pressure,
            (10.0..=30.0).contains(&pressure),
            "10 to 30",
        )?;
        let shaft = self.shaft_angle_deg.unwrap_or(90.0);
        keys.require(
            "shaft_angle_deg",
            shaft,
            (10.0..=170.0).contains(&shaft),
            "10 to 170",
        )?;
        let shift = self.thickness_shift.unwrap_or(0.0);
        keys.require("thickness_shift", shift, shift.abs() <= 0.5, "-0.5 to 0.5")?;
        let backlash = self.backlash_mm.unwrap_or(0.0);
        keys.require(
            "backlash_mm",
            backlash,
            (0.0..self.outer_module_mm).contains(&backlash),
            "0 up to a module",
        )?;
        let data = PairData {
            form,
            teeth: self.teeth,
            outer_module_m: 1e-3 * self.outer_module_mm,
            face_width_m: self.face_width_mm.map(|b| 1e-3 * b),
            spiral_angle_rad: spiral.to_radians(),
            pressure_angle_rad: pressure.to_radians(),
            shaft_angle_rad: shaft.to_radians(),
            pinion_hand: hand,
            taper: self.taper.unwrap_or(Taper::Standard),
            cutter_radius_m: 1e-3 * radius,
            thickness_shift: shift,
            backlash_m: 1e-3 * backlash,
        };
        PairBlank::new(&data).map_err(|cause| match cause {
            BevelError::Blank { key, problem } => keys.error(key, problem),
            other => keys.error("", other),
        })
    }
}
