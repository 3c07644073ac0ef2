//! `[tooth]`: the teeth and the tool that cuts them.

use super::cutter_table::CutterTable;
use super::{MM, TableKeys};
use crate::definition::{Gearing, InternalRoot, ToothDefinition};
use crate::given;
use crate::input::{Bounded, End, InputDocument, InputError, NotNegative, Positive, Within};
use crate::number_range;
use schemars::JsonSchema;
use serde::Deserialize;
use std::f64::consts::PI;

/// The keys of `[tooth]`.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct ToothTable {
    /// Number of teeth; negative for a ring with internal teeth.
    teeth: i64,
    /// Module; of helical teeth in the normal section.
    module_mm: Bounded<Module>,
    /// Pressure angle of the rack, of helical teeth in the normal section; 20 where not given.
    pressure_angle_deg: Option<Bounded<Within<10, 35>>>,
    /// Profile shift coefficient x in modules, positive towards the tip; 0 where not given.
    profile_shift: Option<Bounded<Within<-2, 2>>>,
    /// Addendum of the tip in modules; 1 where not given. Not with tip_diameter_mm.
    addendum: Option<f64>,
    /// Dedendum in modules: addendum of the cutting rack; 1.25 where not given. Not where a pinion cutter makes the
    /// root of internal teeth.
    dedendum: Option<Bounded<Positive>>,
    /// Tip radius of the cutting rack in modules; 0.38 where not given. External teeth only.
    rack_tip_radius: Option<Bounded<NotNegative>>,
    /// What makes the root of internal teeth, "cutter" or "full-round"; "cutter" where not given.
    root: Option<RootWord>,
    /// The pinion cutter of internal teeth; one that suits them where not given.
    cutter: Option<CutterTable>,
    /// Tip diameter where it is not reference diameter + 2 m (addendum + x), of internal teeth − 2 m (addendum + x).
    tip_diameter_mm: Option<f64>,
    /// Reduction of the tooth thickness on the reference circle, for backlash; 0 where not given.
    #[serde(default)]
    thickness_allowance_mm: f64,
    /// Chamfer of the tip edges, radially and circumferentially; 0 where not given.
    tip_chamfer_mm: Option<Bounded<NotNegative>>,
    /// Face width.
    face_width_mm: Bounded<FaceWidth>,
    /// Helix angle on the reference cylinder, without sign; 0 (spur teeth) where not given.
    helix_angle_deg: Option<Bounded<HelixAngle>>,
    /// Hand of helical teeth, "right" or "left"; needed with helix_angle_deg.
    hand: Option<Hand>,
}

/// Hand of a helix: the teeth of a right-hand gear with an upright axis rise to the right.
#[derive(Deserialize, JsonSchema, Clone, Copy, PartialEq)]
#[serde(rename_all = "kebab-case")]
enum Hand {
    Right,
    Left,
}

/// What makes the root of internal teeth.
#[derive(Deserialize, JsonSchema, Clone, Copy, PartialEq, Default)]
#[serde(rename_all = "kebab-case")]
enum RootWord {
    /// A pinion cutter.
    #[default]
    Cutter,
    /// A tool with a full root radius, such as a broach.
    FullRound,
}

number_range!(
    /// Modules in millimetres.
    Module: End::At(0.01), End::At(200.0)
);

number_range!(
    /// Face widths in millimetres.
    FaceWidth: End::At(0.01), End::At(10_000.0)
);

number_range!(
    /// Helix angles without sign in degrees.
    HelixAngle: End::At(0.0), End::Beyond(45.0), "the sense of the helix is set by hand"
);

impl ToothTable {
    /// The teeth, in SI units. Whether they can exist together is [`crate::ToothGeometry`]'s to say.
    pub(super) fn check(self, document: &InputDocument) -> Result<ToothDefinition, InputError> {
        let keys = TableKeys::new(document, "tooth");
        let internal = self.teeth < 0;
        keys.require(
            "teeth",
            self.teeth as f64,
            (5..=1000).contains(&self.teeth) || (-1000..=-12).contains(&self.teeth),
            "5 to 1000, or -1000 to -12 for internal teeth",
        )?;
        self.refuse_other_tools(&keys, internal)?;
        let helix_angle_rad = self.check_helix(&keys)?;
        // Half the transverse pitch.
        let thickness = 0.5 * PI * *self.module_mm / helix_angle_rad.cos();
        keys.require(
            "thickness_allowance_mm",
            self.thickness_allowance_mm,
            (0.0..thickness).contains(&self.thickness_allowance_mm),
            &format!("0 up to half a pitch, {thickness:.3}"),
        )?;
        if self.addendum.is_some() && self.tip_diameter_mm.is_some() {
            return Err(keys.error(
                "addendum",
                "addendum and tip_diameter_mm both set the tip circle; give one of them",
            ));
        }
        let mut tooth = ToothDefinition {
            teeth: self.teeth.unsigned_abs() as usize,
            gearing: Gearing::External,
            module_m: *self.module_mm * MM,
            pressure_angle_rad: self.pressure_angle_deg.map_or(20.0, f64::from).to_radians(),
            profile_shift: self.profile_shift.map_or(0.0, f64::from),
            addendum: self.addendum.unwrap_or(1.0),
            dedendum: self.dedendum.map_or(1.25, f64::from),
            rack_tip_radius: self.rack_tip_radius.map_or(0.38, f64::from),
            tip_diameter_m: self.tip_diameter_mm.map(|v| v * MM),
            thickness_allowance_m: self.thickness_allowance_mm * MM,
            tip_chamfer_m: self.tip_chamfer_mm.map_or(0.0, f64::from) * MM,
            face_width_m: *self.face_width_mm * MM,
            helix_angle_rad,
        };
        if internal {
            tooth.gearing = Gearing::Internal(match self.root.unwrap_or_default() {
                RootWord::FullRound => InternalRoot::FullRound,
                RootWord::Cutter => {
                    let cutter = self.cutter.unwrap_or_default();
                    InternalRoot::Cutter(cutter.check(document, &tooth)?)
                }
            });
        }
        Ok(tooth)
    }

    /// Refuses the keys of tools that do not cut these teeth.
    fn refuse_other_tools(&self, keys: &TableKeys, internal: bool) -> Result<(), InputError> {
        let full_round = self.root == Some(RootWord::FullRound);
        if !internal {
            let why = "is used by internal teeth only, teeth = -99; remove it";
            return keys.refuse(&given!(self; root, cutter), why);
        }
        if full_round {
            let why = "is not used by root = \"full-round\"; remove it";
            keys.refuse(&given!(self; cutter), why)?;
        }
        let why = "is not used by internal teeth, which no rack can cut; remove it, and give cutter.tip_radius or root = \"full-round\"";
        keys.refuse(&given!(self; rack_tip_radius), why)?;
        if full_round {
            return Ok(());
        }
        let why = "is not used by internal teeth whose root a pinion cutter makes; remove it and give cutter.addendum";
        keys.refuse(&given!(self; dedendum), why)
    }

    /// The signed helix angle \[rad\], positive for a right hand.
    fn check_helix(&self, keys: &TableKeys) -> Result<f64, InputError> {
        let degrees = self.helix_angle_deg.map_or(0.0, f64::from);
        match (degrees == 0.0, self.hand) {
            (true, None) => Ok(0.0),
            (true, Some(_)) => Err(keys.error(
                "hand",
                "is not used with helix_angle_deg = 0; leave it out or give the helix angle",
            )),
            (false, None) => Err(keys.error(
                "helix_angle_deg",
                "needs hand = \"right\" or \"left\"; the gears of a pair have opposite hands",
            )),
            (false, Some(Hand::Right)) => Ok(degrees.to_radians()),
            (false, Some(Hand::Left)) => Ok(-degrees.to_radians()),
        }
    }
}
