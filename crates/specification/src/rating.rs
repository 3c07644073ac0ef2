//! `[[rating]]` of scenes of both kinds. Which gauge or mesh is meant is said by other keys in each: `body`, `mesh` and
//! `from_s` in multibody scenes, `gear` in those of a pair.
//!
//! | kind | what | keys |
//! | --- | --- | --- |
//! | `fatigue` | cycles and damage of the stress at a root gauge | `gauge`, `sn_table`; `method`, `surface`, `mean_stress`, `tensile_strength_MPa`, `passage` |
//! | `nominal` | Lewis's root stress and Hertz's pressure under the largest normal force | `load_point` |
//! | `bearing-life` | L10, L10r and L10mr of a bearing under the loads of a run | `bearing`, `file`, `viscosity_mm2_per_s`, `contamination` |

use std::path::PathBuf;

use gearmesh_geometry::InputError;
use gearmesh_geometry::input::{Bounded, Count, Positive, TableKeys, Within};
use gearmesh_geometry::kinds;
use gearmesh_rating::{LoadPoint, MeanStress, Passage, SurfaceState};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A megapascal in pascals.
const MPA: f64 = 1e6;

/// `[[rating]]` as written in the file.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[serde(remote = "Self", rename_all = "kebab-case", deny_unknown_fields)]
#[schemars(tag = "kind", rename = "RatingTable")]
pub enum RatingTable {
    /// Rainflow count and Miner's sum of recovered root stress.
    Fatigue(FatigueTable),
    /// Lewis and Hertz under the largest force.
    Nominal(NominalTable),
    /// Rating life of a bearing.
    BearingLife(BearingLifeTable),
}

kinds!(RatingTable, "kind");

/// Keys of `kind = "fatigue"`.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[allow(non_snake_case)]
pub struct FatigueTable {
    /// Name of a gauge that a `[[gauge]]` reads, or `[gauges]` in scenes of a pair.
    pub gauge: String,
    /// S-N table (.toml) of local stress amplitudes at zero mean, relative to the scene.
    pub sn_table: PathBuf,
    /// Multibody scenes: the part of the run before this time is left out; 0 where not given.
    pub from_s: Option<f64>,
    /// Multibody scenes: body of the gauge; needed where gauges of several bodies have that name.
    pub body: Option<String>,
    /// Scenes of a pair: gear of the gauge, 1 or 2; needed where gauges of both have that name.
    pub gear: Option<Count<1, 2>>,
    /// Method of strain recovery, 1 or 2; 2 where not given.
    pub method: Option<Count<1, 2>>,
    /// "plane-strain" (stress E ε/(1 − ν²), middle of a wide tooth) or "uniaxial" (E ε, near the end faces);
    /// "plane-strain" where not given.
    #[serde(default)]
    pub surface: SurfaceWord,
    /// "none" or "goodman"; "none" where not given.
    #[serde(default)]
    pub mean_stress: MeanStressWord,
    /// With "goodman": tensile strength of the material.
    pub tensile_strength_MPa: Option<Bounded<Positive>>,
    /// "repeated" (the history goes on and on, its end joined to its start) or "once"; "repeated" where not given.
    #[serde(default)]
    pub passage: PassageWord,
}

/// Keys of `kind = "nominal"`.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct NominalTable {
    /// Multibody scenes: the part of the run before this time is left out; 0 where not given.
    pub from_s: Option<f64>,
    /// Multibody scenes: name of a `[[gear_mesh]]`.
    pub mesh: Option<String>,
    /// Where the whole force acts on the tooth for Lewis's stress: "highest-single-contact", or "tip", safer and for
    /// any contact ratio; the former where not given.
    #[serde(default)]
    pub load_point: LoadPointWord,
    /// Tolerance class of ISO 1328-1, 0 to 12, the worse one of both gears: with 4 or better teeth of a virtual contact
    /// ratio above 2.05 have a deep tooth factor Y_DT below 1 (ISO 6336-3). 1 where not given.
    pub tolerance_class: Option<Count<0, 12>>,
}

/// Keys of `kind = "bearing-life"`, multibody scenes only.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BearingLifeTable {
    /// Name of a `[[bearing]]`, not of kind "rigid".
    pub bearing: String,
    /// Bearing file (docs/bearings.md), from the scene's folder: needed where the bearing's model names none.
    pub file: Option<String>,
    /// The part of the run before this time is left out; 0 where not given.
    pub from_s: Option<f64>,
    /// Viscosity of the lubricant at the bearing's temperature, for L10mr.
    pub viscosity_mm2_per_s: Option<Bounded<Positive>>,
    /// With a viscosity: e_C of ISO 281, 0 (heavily contaminated) to 1 (clean).
    pub contamination: Option<Bounded<Within<0, 1>>>,
}

/// `surface`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum SurfaceWord {
    /// Held along the axis.
    #[default]
    PlaneStrain,
    /// Free to contract.
    Uniaxial,
}

/// `mean_stress`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum MeanStressWord {
    /// The mean is not looked at.
    #[default]
    None,
    /// Goodman's line.
    Goodman,
}

/// `passage`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum PassageWord {
    /// Again and again.
    #[default]
    Repeated,
    /// Once.
    Once,
}

/// `load_point`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum LoadPointWord {
    /// The highest point of single contact.
    #[default]
    HighestSingleContact,
    /// The tip.
    Tip,
}

/// How a stress history is judged.
#[derive(Debug, Clone, PartialEq)]
pub struct FatigueRule {
    /// Gauge.
    pub gauge: String,
    /// Method of strain recovery, 1 or 2.
    pub method: usize,
    /// From strain to stress.
    pub surface: SurfaceState,
    /// What the mean of a cycle does.
    pub mean_stress: MeanStress,
    /// How often the history is passed.
    pub passage: Passage,
    /// S-N table as the scene names it.
    pub sn_table: PathBuf,
}

impl FatigueRule {
    /// How it judges, in words.
    #[must_use]
    pub fn method(&self) -> String {
        let mean = match self.mean_stress {
            MeanStress::None => "without regard to the mean",
            MeanStress::Goodman { .. } => "mean by Goodman's line",
        };
        let passage = match self.passage {
            Passage::Once => "passed once",
            Passage::Repeated => "repeated",
        };
        let surface = match self.surface {
            SurfaceState::PlaneStrain => "plane strain",
            SurfaceState::Uniaxial => "uniaxial",
        };
        format!(
            "cycles and damage of the stress ({surface}) from strain by method {}, S-N table {}, {mean}, history {passage}",
            self.method,
            self.sn_table.display()
        )
    }
}

impl FatigueTable {
    /// The rule, checked as far as no part of the scene is needed.
    ///
    /// # Errors
    /// [`InputError`] naming the key.
    pub fn rule(&self, keys: &TableKeys<'_>) -> Result<FatigueRule, InputError> {
        Ok(FatigueRule {
            gauge: self.gauge.clone(),
            method: self.method.map_or(2, Count::get),
            surface: match self.surface {
                SurfaceWord::PlaneStrain => SurfaceState::PlaneStrain,
                SurfaceWord::Uniaxial => SurfaceState::Uniaxial,
            },
            mean_stress: self.mean_stress(keys)?,
            passage: match self.passage {
                PassageWord::Repeated => Passage::Repeated,
                PassageWord::Once => Passage::Once,
            },
            sn_table: self.sn_table.clone(),
        })
    }

    fn mean_stress(&self, keys: &TableKeys<'_>) -> Result<MeanStress, InputError> {
        let key = "tensile_strength_MPa";
        match (self.mean_stress, self.tensile_strength_MPa) {
            (MeanStressWord::None, None) => Ok(MeanStress::None),
            (MeanStressWord::None, Some(_)) => Err(keys.error(
                key,
                "is used by mean_stress = \"goodman\" only; remove one of the two",
            )),
            (MeanStressWord::Goodman, strength) => {
                let strength = keys.needed(key, strength, "mean_stress = \"goodman\"")?;
                Ok(MeanStress::Goodman {
                    tensile_strength_pa: MPA * *strength,
                })
            }
        }
    }
}

impl NominalTable {
    /// Where the force acts for Lewis's stress.
    #[must_use]
    pub fn load_point(&self) -> LoadPoint {
        match self.load_point {
            LoadPointWord::HighestSingleContact => LoadPoint::HighestSingleContact,
            LoadPointWord::Tip => LoadPoint::Tip,
        }
    }
}

impl RatingTable {
    /// Time from which rows count, where it is stated.
    #[must_use]
    pub fn from_s(&self) -> Option<f64> {
        match self {
            Self::Fatigue(table) => table.from_s,
            Self::Nominal(table) => table.from_s,
            Self::BearingLife(table) => table.from_s,
        }
    }

    /// Refuses the keys of multibody scenes, for a scene of a pair.
    ///
    /// # Errors
    /// [`InputError`] for the first of them that is given.
    pub fn refuse_keys_of_systems(&self, keys: &TableKeys<'_>) -> Result<(), InputError> {
        let (key, instead) = match self {
            Self::Fatigue(table) if table.body.is_some() => {
                ("body", "; gear = 1 or 2 says whose gauge it is")
            }
            Self::Nominal(table) if table.mesh.is_some() => ("mesh", ", which has one mesh"),
            Self::BearingLife(_) => ("bearing", ", which has no bearings"),
            _ if self.from_s().is_some() => ("from_s", ", which has no time"),
            _ => return Ok(()),
        };
        let problem = format!("is not used by a scene of a [pair]{instead}; remove it");
        Err(keys.error(key, problem))
    }

    /// Refuses the key of scenes of a pair, for a multibody scene.
    ///
    /// # Errors
    /// [`InputError`] where it is given.
    pub fn refuse_keys_of_pairs(&self, keys: &TableKeys<'_>) -> Result<(), InputError> {
        match self {
            Self::Fatigue(FatigueTable { gear: Some(_), .. }) => Err(keys.error(
                "gear",
                "is not used by a multibody scene; body says whose gauge it is; remove it",
            )),
            _ => Ok(()),
        }
    }
}
