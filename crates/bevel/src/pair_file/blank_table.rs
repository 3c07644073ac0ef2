//! `[bevel]`: teeth and blank of a pair.

use gearmesh_geometry::InputError;
use gearmesh_geometry::given;
use gearmesh_geometry::input::{
    Bounded, Count, End, InputDocument, NotNegative, Positive, TableKeys, UpTo, Within,
};
use gearmesh_geometry::number_range;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::blank::{PairBlank, PairData, Taper, ToothForm};
use crate::error::BevelError;
use crate::hand::Hand;

/// Teeth and blank. Lists of two: pinion, gear.
#[derive(Debug, Clone, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BlankTable {
    /// Form of the teeth; "spiral" where not given.
    pub form: Option<ToothForm>,
    /// Numbers of teeth.
    pub teeth: [Count<5, 1000>; 2],
    /// Transverse module at the heel.
    pub outer_module_mm: Bounded<Positive>,
    /// Face widths, both from the same outer cone distance inwards.
    pub face_width_mm: [Bounded<Positive>; 2],
    /// "spiral": mean spiral angle.
    pub spiral_angle_deg: Option<Bounded<UpTo<50>>>,
    /// Normal pressure angle; 20 where not given.
    pub pressure_angle_deg: Option<Bounded<Within<10, 30>>>,
    /// Angle between the axes, both from apex to heel; 90 where not given.
    pub shaft_angle_deg: Option<Bounded<Within<10, 170>>>,
    /// "spiral", "zerol": hand of the pinion; the gear has the other.
    pub pinion_hand: Option<Hand>,
    /// Depth along the face; "standard" where not given.
    pub taper: Option<Taper>,
    /// "spiral", "zerol": nominal radius of the face mill.
    pub cutter_radius_mm: Option<Bounded<Positive>>,
    /// By how much of a module the pinion's outer tooth is thicker, and the gear's thinner, than by the balance of
    /// addenda; 0 where not given.
    pub thickness_shift: Option<Bounded<ThicknessShift>>,
    /// Normal backlash at the mean point; 0 where not given.
    pub backlash_mm: Option<Bounded<NotNegative>>,
}

number_range!(
    /// Shares of a module that a tooth can be thicker by: about a third of the tooth.
    pub ThicknessShift: End::At(-0.5), End::At(0.5)
);

impl BlankTable {
    pub(super) fn blank(&self, document: &InputDocument) -> Result<PairBlank, InputError> {
        let keys = TableKeys::new(document, "bevel");
        let form = self.form.unwrap_or(ToothForm::Spiral);
        let word = match form {
            ToothForm::Spiral => "spiral",
            ToothForm::Zerol => "zerol",
            ToothForm::Straight => "straight",
        };
        const MILLED: &str = "spiral zerol";
        keys.refuse_unused(
            ("form", word),
            &[
                (&given!(self; spiral_angle_deg), "spiral"),
                (&given!(self; pinion_hand, cutter_radius_mm), MILLED),
            ],
        )?;
        let spiral = match form {
            ToothForm::Spiral => *keys.needed(
                "spiral_angle_deg",
                self.spiral_angle_deg,
                "form = \"spiral\"",
            )?,
            ToothForm::Zerol | ToothForm::Straight => 0.0,
        };
        let hand = match form {
            ToothForm::Straight => Hand::Right,
            _ => keys.needed("pinion_hand", self.pinion_hand, "a face-milled pair")?,
        };
        let radius = match form {
            ToothForm::Straight => 0.0,
            _ => *keys.needed(
                "cutter_radius_mm",
                self.cutter_radius_mm,
                "a face-milled pair",
            )?,
        };
        let pressure = self.pressure_angle_deg.map_or(20.0, f64::from);
        let shaft = self.shaft_angle_deg.map_or(90.0, f64::from);
        let module = *self.outer_module_mm;
        let backlash = self.backlash_mm.map_or(0.0, f64::from);
        let ok = backlash < module;
        keys.require("backlash_mm", backlash, ok, "0 up to a module")?;
        let data = PairData {
            form,
            teeth: self.teeth.map(Count::get),
            outer_module_m: 1e-3 * module,
            face_width_m: self.face_width_mm.map(|b| 1e-3 * *b),
            spiral_angle_rad: spiral.to_radians(),
            pressure_angle_rad: pressure.to_radians(),
            shaft_angle_rad: shaft.to_radians(),
            pinion_hand: hand,
            taper: self.taper.unwrap_or(Taper::Standard),
            cutter_radius_m: 1e-3 * radius,
            thickness_shift: self.thickness_shift.map_or(0.0, f64::from),
            backlash_m: 1e-3 * backlash,
        };
        PairBlank::new(&data).map_err(|cause| match cause {
            BevelError::Blank { key, problem } => keys.error(key, problem),
            other => keys.error("", other),
        })
    }
}
