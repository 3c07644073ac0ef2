//! `[microgeometry]` of gear files and scenes: what is removed from the ideal flanks.

use super::topography_table::{Amount, TopographyTable};
use super::{MM, UM};
use crate::input::{InputDocument, InputError, TableKeys};
use crate::involute;
use crate::microgeometry::{
    EndRelief, FaceEnds, GearMicrogeometry, Microgeometry, ProfileCrowning, ProfileRelief,
    ReliefShape,
};
use crate::tooth::ToothGeometry;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::path::Path;

/// The keys of `[microgeometry]`. Amounts are removed along the flank normal; negative ones are added.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema, Default)]
#[serde(deny_unknown_fields)]
pub struct MicrogeometryTable {
    /// Tip relief at the tip circle.
    pub tip_relief_um: Option<Amount>,
    /// Diameter at which the tip relief begins; needed with it.
    pub tip_relief_start_diameter_mm: Option<f64>,
    /// How it grows with the roll length; "linear" where not given.
    pub tip_relief_shape: Option<ReliefWord>,
    /// Root relief at the form circle, where the involute begins.
    pub root_relief_um: Option<Amount>,
    /// Diameter at which the root relief begins; needed with it.
    pub root_relief_start_diameter_mm: Option<f64>,
    /// How it grows with the roll length; "linear" where not given.
    pub root_relief_shape: Option<ReliefWord>,
    /// Profile crowning (barrelling) at the tip circle, a parabola in roll length from profile_crowning_diameter_mm on.
    pub profile_crowning_um: Option<Amount>,
    /// Diameter at which the profile crowning is zero; needed with it.
    pub profile_crowning_diameter_mm: Option<f64>,
    /// Slope of the profile over the whole involute: half of it removed at the tip circle, half added at the form
    /// circle; 0 where not given.
    pub profile_angle_um: Option<Amount>,
    /// Lead crowning: a parabola over the face, zero at mid-face, this at both ends; 0 where not given.
    pub lead_crowning_um: Option<Amount>,
    /// Slope of the flank line over the whole face width (helix angle modification): half of it removed at +z, half
    /// added at -z, zero at mid-face; 0 where not given.
    pub flank_angle_um: Option<Amount>,
    /// End relief at the faces.
    pub end_relief_um: Option<Amount>,
    /// Length along the axis over which the end relief grows; needed with it.
    pub end_relief_length_mm: Option<f64>,
    /// How it grows along the axis; "linear" where not given.
    pub end_relief_shape: Option<ReliefWord>,
    /// The faces that have it; "both" where not given.
    pub end_relief_end: Option<FaceEnds>,
    /// Twist (bias): slope of the profile over the whole involute at the face towards +z less that at the one towards
    /// -z; 0 where not given.
    pub twist_um: Option<Amount>,
    /// Any other form: a table over the flank, added to the rest.
    pub topography: Option<TopographyTable>,
    /// Keys that are others on right flanks.
    pub right: Option<Box<MicrogeometryTable>>,
    /// Keys that are others on left flanks.
    pub left: Option<Box<MicrogeometryTable>>,
}

/// How a relief grows from its start to where its amount is stated.
#[derive(Debug, Clone, Copy, Default, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ReliefWord {
    /// With the distance.
    #[default]
    Linear,
    /// With its square.
    Parabolic,
    /// As a circle that touches the unmodified flank at the start.
    Arc,
}

impl MicrogeometryTable {
    /// The microgeometry in SI units of a gear with this profile and face width \[m\]. The table stands at the dotted
    /// `path`; files are relative to `folder`, none where only this document will be kept.
    ///
    /// # Errors
    /// [`InputError`] at the key, or in a file.
    pub fn check(
        &self,
        (document, path): (&InputDocument, &str),
        (profile, face_width_m): (&ToothGeometry, f64),
        folder: Option<&Path>,
    ) -> Result<GearMicrogeometry, InputError> {
        let of_side = |name: &'static str, own: &Option<Box<Self>>| {
            let side = own.as_deref().map(|table| table.on_top_of(self));
            if let Some(table) = own
                .as_deref()
                .filter(|t| t.left.is_some() || t.right.is_some())
            {
                let word = if table.left.is_some() {
                    "left"
                } else {
                    "right"
                };
                let key = format!("{path}.{name}.{word}");
                return Err(document.error(
                    &key,
                    "does not belong into the table of one side; remove it",
                ));
            }
            let flank = FlankTable {
                of: SideTable {
                    table: side.as_ref().unwrap_or(self),
                    document,
                    path,
                    side: name,
                },
                profile,
                face_width_m,
            };
            flank.microgeometry(folder)
        };
        Ok(GearMicrogeometry {
            right: of_side("right", &self.right)?,
            left: of_side("left", &self.left)?,
        })
    }

    /// Checks what can be said without the teeth: amounts that are allowed, and beside each the diameter or length that
    /// it needs.
    ///
    /// # Errors
    /// [`InputError`] at the key.
    pub fn check_together(
        &self,
        (document, path): (&InputDocument, &str),
    ) -> Result<(), InputError> {
        for (side, own) in [("right", &self.right), ("left", &self.left)] {
            let table = own.as_deref().map(|table| table.on_top_of(self));
            let of = SideTable {
                table: table.as_ref().unwrap_or(self),
                document,
                path,
                side,
            };
            of.relief(&of.table.tip_relief())?;
            of.relief(&of.table.root_relief())?;
            of.profile_crowning()?;
            of.end_relief()?;
        }
        Ok(())
    }

    fn tip_relief(&self) -> StatedRelief {
        StatedRelief {
            amount: ("tip_relief_um", self.tip_relief_um),
            start: (
                "tip_relief_start_diameter_mm",
                self.tip_relief_start_diameter_mm,
            ),
            shape: ("tip_relief_shape", self.tip_relief_shape),
            to_root: false,
        }
    }

    fn root_relief(&self) -> StatedRelief {
        StatedRelief {
            amount: ("root_relief_um", self.root_relief_um),
            start: (
                "root_relief_start_diameter_mm",
                self.root_relief_start_diameter_mm,
            ),
            shape: ("root_relief_shape", self.root_relief_shape),
            to_root: true,
        }
    }

    /// The keys of one side, those of both sides where it is silent.
    fn on_top_of(&self, both: &Self) -> Self {
        let (own, both) = (self.clone(), both.clone());
        Self {
            tip_relief_um: own.tip_relief_um.or(both.tip_relief_um),
            tip_relief_start_diameter_mm: (own.tip_relief_start_diameter_mm)
                .or(both.tip_relief_start_diameter_mm),
            tip_relief_shape: own.tip_relief_shape.or(both.tip_relief_shape),
            root_relief_um: own.root_relief_um.or(both.root_relief_um),
            root_relief_start_diameter_mm: (own.root_relief_start_diameter_mm)
                .or(both.root_relief_start_diameter_mm),
            root_relief_shape: own.root_relief_shape.or(both.root_relief_shape),
            profile_crowning_um: own.profile_crowning_um.or(both.profile_crowning_um),
            profile_crowning_diameter_mm: (own.profile_crowning_diameter_mm)
                .or(both.profile_crowning_diameter_mm),
            profile_angle_um: own.profile_angle_um.or(both.profile_angle_um),
            lead_crowning_um: own.lead_crowning_um.or(both.lead_crowning_um),
            flank_angle_um: own.flank_angle_um.or(both.flank_angle_um),
            end_relief_um: own.end_relief_um.or(both.end_relief_um),
            end_relief_length_mm: own.end_relief_length_mm.or(both.end_relief_length_mm),
            end_relief_shape: own.end_relief_shape.or(both.end_relief_shape),
            end_relief_end: own.end_relief_end.or(both.end_relief_end),
            twist_um: own.twist_um.or(both.twist_um),
            topography: own.topography.or(both.topography),
            right: None,
            left: None,
        }
    }
}

/// A relief of the profile by its keys, each with its name.
struct StatedRelief {
    amount: (&'static str, Option<Amount>),
    start: (&'static str, Option<f64>),
    shape: (&'static str, Option<ReliefWord>),
    to_root: bool,
}

/// The keys that act on one side of a gear's teeth.
struct SideTable<'a> {
    table: &'a MicrogeometryTable,
    document: &'a InputDocument,
    path: &'a str,
    side: &'static str,
}

impl SideTable<'_> {
    /// Where a key stands: in the table of the side, or in that of both.
    fn place(&self, key: &str) -> String {
        let own = format!("{}.{}.{key}", self.path, self.side);
        if self.document.has(&own) {
            own
        } else {
            format!("{}.{key}", self.path)
        }
    }

    fn error(&self, key: &str, problem: impl std::fmt::Display) -> InputError {
        self.document.error(&self.place(key), problem)
    }

    fn require(&self, key: &str, value: f64, ok: bool, allowed: &str) -> Result<(), InputError> {
        let place = self.place(key);
        TableKeys::new(self.document, &place).require("", value, ok, allowed)
    }

    /// An amount \[m\] and the length in millimetres that belongs to it; none where neither is given, nor any of
    /// `others`.
    fn together(
        &self,
        (amount_key, amount_um): (&str, Option<Amount>),
        (length_key, length_mm): (&str, Option<f64>),
        others: &[(&str, bool)],
    ) -> Result<Option<(f64, f64)>, InputError> {
        let given = others
            .iter()
            .filter(|(_, given)| *given)
            .map(|(key, _)| *key);
        match (amount_um, length_mm) {
            (Some(amount_um), Some(length_mm)) => Ok(Some((UM * amount_um, length_mm))),
            (Some(_), None) => Err(self.error(amount_key, format!("needs {length_key}"))),
            (None, _) => match length_mm
                .map(|_| length_key)
                .into_iter()
                .chain(given)
                .next()
            {
                None => Ok(None),
                Some(key) => Err(self.error(key, format!("is not used without {amount_key}"))),
            },
        }
    }

    /// Amount \[m\] of a relief of the profile and the diameter \[mm\] where it begins.
    fn relief(&self, stated: &StatedRelief) -> Result<Option<(f64, f64)>, InputError> {
        let (key, shape) = stated.shape;
        self.together(stated.amount, stated.start, &[(key, shape.is_some())])
    }

    /// Amount \[m\] of the profile crowning and the diameter \[mm\] where it is zero.
    fn profile_crowning(&self) -> Result<Option<(f64, f64)>, InputError> {
        let diameter = self.table.profile_crowning_diameter_mm;
        self.together(
            ("profile_crowning_um", self.table.profile_crowning_um),
            ("profile_crowning_diameter_mm", diameter),
            &[],
        )
    }

    /// Amount \[m\] and length \[mm\] of the end relief.
    fn end_relief(&self) -> Result<Option<(f64, f64)>, InputError> {
        let table = self.table;
        let others = [
            ("end_relief_shape", table.end_relief_shape.is_some()),
            ("end_relief_end", table.end_relief_end.is_some()),
        ];
        self.together(
            ("end_relief_um", table.end_relief_um),
            ("end_relief_length_mm", table.end_relief_length_mm),
            &others,
        )
    }
}

/// An amount \[m\], zero where not given.
fn amount_m(amount_um: Option<Amount>) -> f64 {
    UM * amount_um.unwrap_or_default()
}

/// The keys of one side, and the teeth that they act on.
struct FlankTable<'a> {
    of: SideTable<'a>,
    profile: &'a ToothGeometry,
    face_width_m: f64,
}

impl FlankTable<'_> {
    fn microgeometry(&self, folder: Option<&Path>) -> Result<Microgeometry, InputError> {
        let table = self.of.table;
        let topography = table.topography.as_ref();
        Ok(Microgeometry {
            form_roll_rad: self.profile.form_roll_rad,
            tip_roll_rad: self.profile.tip_roll_rad,
            face_width_m: self.face_width_m,
            profile_crowning: self.profile_crowning()?,
            tip_relief: self.relief(table.tip_relief())?,
            root_relief: self.relief(table.root_relief())?,
            profile_angle_m: amount_m(table.profile_angle_um),
            lead_crowning_m: amount_m(table.lead_crowning_um),
            flank_angle_m: amount_m(table.flank_angle_um),
            end_relief: self.end_relief()?,
            twist_m: amount_m(table.twist_um),
            topography: topography
                .map(|table| {
                    let place = self.of.place("topography");
                    table.check(
                        &TableKeys::new(self.of.document, &place),
                        self.profile,
                        folder,
                    )
                })
                .transpose()?,
        })
    }

    fn profile_crowning(&self) -> Result<Option<ProfileCrowning>, InputError> {
        let Some((amount_m, diameter_mm)) = self.of.profile_crowning()? else {
            return Ok(None);
        };
        self.require_on_involute("profile_crowning_diameter_mm", diameter_mm, false)?;
        Ok(Some(ProfileCrowning {
            amount_m,
            centre_roll_rad: self.roll_rad(diameter_mm),
        }))
    }

    fn relief(&self, stated: StatedRelief) -> Result<Option<ProfileRelief>, InputError> {
        let Some((amount_m, diameter_mm)) = self.of.relief(&stated)? else {
            return Ok(None);
        };
        self.require_on_involute(stated.start.0, diameter_mm, stated.to_root)?;
        let start_roll_rad = self.roll_rad(diameter_mm);
        let end_roll_rad = match stated.to_root {
            true => self.profile.form_roll_rad,
            false => self.profile.tip_roll_rad,
        };
        let length_m = self.profile.base_radius_m * (end_roll_rad - start_roll_rad).abs();
        let shape = self.shape(stated.shape.1, stated.amount, length_m)?;
        Ok(Some(ProfileRelief {
            amount_m,
            start_roll_rad,
            shape,
        }))
    }

    fn end_relief(&self) -> Result<Option<EndRelief>, InputError> {
        let table = self.of.table;
        let amount = ("end_relief_um", table.end_relief_um);
        let Some((amount_m, length_mm)) = self.of.end_relief()? else {
            return Ok(None);
        };
        let ends = table.end_relief_end.unwrap_or_default();
        let share = if ends == FaceEnds::Both { 0.5 } else { 1.0 };
        let most = share * self.face_width_m / MM;
        let ok = length_mm > 0.0 && length_mm <= most * (1.0 + 1e-12);
        self.of.require(
            "end_relief_length_mm",
            length_mm,
            ok,
            &format!("more than 0 to {most:.4}"),
        )?;
        Ok(Some(EndRelief {
            amount_m,
            length_m: MM * length_mm,
            shape: self.shape(table.end_relief_shape, amount, MM * length_mm)?,
            ends,
        }))
    }

    fn shape(
        &self,
        word: Option<ReliefWord>,
        (key, amount_um): (&str, Option<Amount>),
        length_m: f64,
    ) -> Result<ReliefShape, InputError> {
        Ok(match word.unwrap_or_default() {
            ReliefWord::Linear => ReliefShape::Linear,
            ReliefWord::Parabolic => ReliefShape::Parabolic,
            ReliefWord::Arc => {
                let (amount, most) = (*amount_um.unwrap_or_default(), length_m / UM);
                let allowed = format!(
                    "less than {most:.1} in magnitude: an arc is not deeper than it is long"
                );
                self.of
                    .require(key, amount, amount.abs() < most, &allowed)?;
                ReliefShape::Arc { length_m }
            }
        })
    }

    /// Diameters of the form circle and of the tip circle \[mm\].
    fn involute_mm(&self) -> (f64, f64) {
        let form_m = involute::radius_m(self.profile.form_roll_rad, self.profile.base_radius_m);
        (2.0 * form_m / MM, 2.0 * self.profile.tip_radius_m / MM)
    }

    /// Demands a diameter between form and tip circle: with the form circle, and without the tip circle, or, of what
    /// reaches to the root, the other way round.
    fn require_on_involute(
        &self,
        key: &str,
        diameter_mm: f64,
        to_root: bool,
    ) -> Result<(), InputError> {
        let (form, tip) = self.involute_mm();
        let open = if to_root { form } else { tip };
        let (low, high) = (form.min(tip), form.max(tip));
        let ok = (low..=high).contains(&diameter_mm) && diameter_mm != open;
        let allowed = match (to_root, form < tip) {
            (true, true) => format!("above {form:.3} to {tip:.3}"),
            (false, true) => format!("{form:.3} to below {tip:.3}"),
            (true, false) => format!("{tip:.3} to below {form:.3}"),
            (false, false) => format!("above {tip:.3} to {form:.3}"),
        };
        let allowed = format!("{allowed}: the involute part of the flank");
        self.of.require(key, diameter_mm, ok, &allowed)
    }

    /// Roll angle of the flank at a diameter in millimetres.
    fn roll_rad(&self, diameter_mm: f64) -> f64 {
        involute::roll_angle_rad(0.5 * diameter_mm * MM, self.profile.base_radius_m)
    }
}
