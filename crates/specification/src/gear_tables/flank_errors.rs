//! `errors_1`, `errors_2`: gear errors and faults, one variant a kind; `cracks_1`, `cracks_2`.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use gearmesh_drivetrain::errors::broken_tooth::BrokenTooth;
use gearmesh_drivetrain::errors::deviation_table::DeviationTable;
use gearmesh_drivetrain::errors::pitch::PitchErrors;
use gearmesh_drivetrain::errors::spall::{Spall, SpallPatch};
use gearmesh_drivetrain::errors::tip_chip::{FaceEnd, TipChip};
use gearmesh_drivetrain::{FlankError, RootCrack};
use gearmesh_geometry::input::{Bounded, NumberTable, Positive, TableKeys};
use gearmesh_geometry::{Flank, InputError, ToothGeometry, kinds};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{MM, UM};

/// End of the face width.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
pub enum EndWord {
    /// Towards +z.
    #[serde(rename = "+z")]
    Positive,
    /// Towards −z.
    #[serde(rename = "-z")]
    Negative,
}

/// An error or fault.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[serde(remote = "Self", rename_all = "kebab-case", deny_unknown_fields)]
#[schemars(tag = "kind", rename = "FlankErrorTable")]
pub enum FlankErrorTable {
    /// Each flank of one side stands back by an amount.
    Pitch {
        /// Side.
        side: Flank,
        /// Material removed along the normal, one value a tooth, tooth 0 first.
        removed_um: Vec<f64>,
    },
    /// Measured profile and lead.
    Deviation {
        /// The tooth; all where not given.
        tooth: Option<usize>,
        /// File with the columns roll_deg and removed_um.
        profile: Option<PathBuf>,
        /// File with the columns z_mm and removed_um.
        lead: Option<PathBuf>,
    },
    /// A tooth broken off.
    BrokenTooth {
        /// The tooth.
        tooth: usize,
        /// Radius above which it is gone.
        above_radius_mm: Bounded<Positive>,
    },
    /// A chip off the tip at one end of a tooth.
    TipChip {
        /// The tooth.
        tooth: usize,
        /// The end.
        end: EndWord,
        /// How far it reaches below the tip on the face.
        height_mm: Bounded<Positive>,
        /// How far it reaches inwards along the tip.
        length_mm: Bounded<Positive>,
    },
    /// Material lost from a patch of a flank.
    Spall {
        /// The tooth.
        tooth: usize,
        /// Side.
        side: Flank,
        /// Lower and upper radius.
        radii_mm: [f64; 2],
        /// Lower and upper axial position from mid-face.
        z_mm: [f64; 2],
        /// Depth.
        depth_um: Bounded<Positive>,
        /// Length in roll angle over which the edges fall; 0.5 where not given.
        edge_deg: Option<Bounded<Positive>>,
    },
}

/// Length in roll angle over which the edges of a spall fall where the scene states none: about the width of a Hertz
/// contact on teeth of some millimetres' module.
const DEFAULT_EDGE_DEG: f64 = 0.5;

kinds!(FlankErrorTable, "kind");

impl FlankErrorTable {
    /// Name in files.
    #[must_use]
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Pitch { .. } => "pitch",
            Self::Deviation { .. } => "deviation",
            Self::BrokenTooth { .. } => "broken-tooth",
            Self::TipChip { .. } => "tip-chip",
            Self::Spall { .. } => "spall",
        }
    }

    /// Complains about numbers that the gear cannot have, by the keys that stand in the file.
    fn check(
        &self,
        gear: &ToothGeometry,
        keys: &TableKeys<'_>,
        key: &str,
    ) -> Result<(), InputError> {
        let at = |name: &str| format!("{key}.{name}");
        let rising = |name: &str, [low, high]: [f64; 2]| match low < high {
            true => Ok(()),
            false => Err(keys.error(
                &at(name),
                format!("found [{low}, {high}], allowed is [lower, upper]"),
            )),
        };
        let (kind, last) = (self.kind(), gear.teeth - 1);
        if let Some(tooth) = self.tooth().filter(|tooth| *tooth > last) {
            let problem =
                format!("{kind}: there is no tooth {tooth}; the gear has teeth 0 to {last}");
            return Err(keys.error(&at("tooth"), problem));
        }
        match self {
            Self::Pitch { removed_um, .. } => {
                let (found, teeth) = (removed_um.len(), gear.teeth);
                if found == teeth {
                    return Ok(());
                }
                let problem = format!("found {found} numbers, allowed are {teeth}: one a tooth");
                Err(keys.error(&at("removed_um"), problem))
            }
            Self::Deviation { .. } | Self::TipChip { .. } => Ok(()),
            Self::BrokenTooth {
                above_radius_mm, ..
            } => {
                let tip = gear.tip_radius_m / MM;
                let allowed = format!("less than the tip radius, {tip:.3}");
                let found = **above_radius_mm;
                keys.require(&at("above_radius_mm"), found, found < tip, &allowed)
            }
            Self::Spall { radii_mm, z_mm, .. } => {
                rising("radii_mm", *radii_mm)?;
                rising("z_mm", *z_mm)
            }
        }
    }

    /// Whether it is not the same on all teeth.
    pub fn tells_teeth_apart(&self) -> bool {
        !matches!(self, Self::Deviation { tooth: None, .. })
    }

    /// The tooth that has it; none where all may have.
    fn tooth(&self) -> Option<usize> {
        match self {
            Self::Pitch { .. } => None,
            Self::Deviation { tooth, .. } => *tooth,
            Self::BrokenTooth { tooth, .. }
            | Self::TipChip { tooth, .. }
            | Self::Spall { tooth, .. } => Some(*tooth),
        }
    }

    /// Puts the error on a gear; files relative to `folder`.
    ///
    /// # Errors
    /// [`InputError`] at `key`, or in a file.
    pub fn on_gear(
        &self,
        (gear, face_width_m): (&ToothGeometry, f64),
        (keys, key): (&TableKeys<'_>, &str),
        folder: &Path,
    ) -> Result<Arc<dyn FlankError>, InputError> {
        self.check(gear, keys, key)?;
        let fault = |error| keys.error(key, error);
        Ok(match self {
            Self::Pitch { side, removed_um } => {
                let removed = removed_um.iter().map(|value| UM * value).collect();
                Arc::new(PitchErrors::new(*side, removed, gear.teeth).map_err(fault)?)
            }
            Self::Deviation {
                tooth,
                profile,
                lead,
            } => {
                if profile.is_none() && lead.is_none() {
                    return Err(keys.error(key, "kind = \"deviation\" needs profile, lead or both"));
                }
                let rows = |file: &Option<PathBuf>, head: &str, unit: f64| match file {
                    None => Ok(Vec::new()),
                    Some(file) => {
                        let numbers = NumberTable::read(&folder.join(file), &[head, "removed_um"])?;
                        numbers.require_increasing(0)?;
                        let pairs = numbers.column(0).iter().zip(numbers.column(1));
                        Ok::<_, InputError>(pairs.map(|(x, y)| [unit * x, UM * y]).collect())
                    }
                };
                let profile = rows(profile, "roll_deg", 1f64.to_radians())?;
                let table =
                    DeviationTable::new(&profile, &rows(lead, "z_mm", MM)?).map_err(fault)?;
                match tooth {
                    None => Arc::new(table),
                    Some(tooth) => Arc::new(table.on_tooth(*tooth)),
                }
            }
            Self::BrokenTooth {
                tooth,
                above_radius_mm,
            } => Arc::new(BrokenTooth::new(gear, *tooth, MM * *above_radius_mm).map_err(fault)?),
            Self::TipChip {
                tooth,
                end,
                height_mm,
                length_mm,
            } => {
                let end = match end {
                    EndWord::Positive => FaceEnd::Positive,
                    EndWord::Negative => FaceEnd::Negative,
                };
                let lengths = [MM * *height_mm, MM * *length_mm];
                Arc::new(TipChip::new((gear, face_width_m), *tooth, end, lengths).map_err(fault)?)
            }
            Self::Spall {
                tooth,
                side,
                radii_mm,
                z_mm,
                depth_um,
                edge_deg,
            } => {
                let patch = SpallPatch {
                    tooth: *tooth,
                    side: *side,
                    radii_m: radii_mm.map(|r| MM * r),
                    z_m: z_mm.map(|z| MM * z),
                    depth_m: UM * *depth_um,
                    edge_rad: edge_deg.map_or(DEFAULT_EDGE_DEG, f64::from).to_radians(),
                };
                Arc::new(Spall::new(gear, patch).map_err(fault)?)
            }
        })
    }
}

/// A root crack, as section loss of a beam tooth.
#[derive(Debug, Clone, Copy, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CrackTable {
    /// The tooth.
    pub tooth: usize,
    /// Side on which it opens.
    pub side: Flank,
    /// Radius at which it starts, on the root fillet.
    pub start_radius_mm: f64,
    /// Depth.
    pub depth_mm: f64,
    /// Angle to the tooth's centre line: 0 runs towards the centre of the gear, 90 straight across.
    pub angle_deg: f64,
}

impl CrackTable {
    /// The tooth and its crack.
    #[must_use]
    pub fn crack(&self) -> (usize, RootCrack) {
        let crack = RootCrack {
            side: self.side,
            start_radius_m: MM * self.start_radius_mm,
            depth_m: MM * self.depth_mm,
            angle_rad: self.angle_deg.to_radians(),
        };
        (self.tooth, crack)
    }
}
