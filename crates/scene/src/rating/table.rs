//! `[[rating]]` of scenes of both kinds. Which gauge or mesh is meant is said by other keys in each: `body`, `mesh` and
//! `from_s` in multibody scenes, `gear` in those of a pair.
//!
//! | kind | what | keys |
//! | --- | --- | --- |
//! | `fatigue` | cycles and damage of the stress at a root gauge | `gauge`, `sn_table`; `method`, `surface`, `mean_stress`, `tensile_strength_MPa`, `passage` |
//! | `nominal` | Lewis's root stress and Hertz's pressure under the largest normal force | `load_point` |

use std::path::PathBuf;

use gearmesh_geometry::InputError;
use gearmesh_geometry::input::TableKeys;
use gearmesh_rating::{LoadPoint, MeanStress, Passage, SurfaceState};
use schemars::JsonSchema;
use serde::Deserialize;

/// A megapascal in pascals.
const MPA: f64 = 1e6;

/// `[[rating]]` as it stands in the file.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[allow(non_snake_case)]
pub struct RatingTable {
    /// What is computed.
    pub kind: RatingKind,
    /// Multibody scenes: the part of the run before this time is left out; 0 where not given.
    pub from_s: Option<f64>,
    /// `fatigue`: name of a gauge that a `[[gauge]]` reads, or `[gauges]` in scenes of a pair.
    pub gauge: Option<String>,
    /// `fatigue`, multibody scenes: body of the gauge; needed where gauges of several bodies have that name.
    pub body: Option<String>,
    /// `fatigue`, scenes of a pair: gear of the gauge, 1 or 2; needed where gauges of both have that name.
    pub gear: Option<usize>,
    /// `fatigue`: S-N table (.toml) of local stress amplitudes at zero mean, relative to the scene.
    pub sn_table: Option<PathBuf>,
    /// `fatigue`: method of strain recovery, 1 or 2; 2 where not given.
    pub method: Option<usize>,
    /// `fatigue`: "plane-strain" (stress E ε/(1 − ν²), middle of a wide tooth) or "uniaxial" (E ε, near the end faces);
    /// "plane-strain" where not given.
    pub surface: Option<SurfaceWord>,
    /// `fatigue`: "none" or "goodman"; "none" where not given.
    pub mean_stress: Option<MeanStressWord>,
    /// `fatigue` with "goodman": tensile strength of the material.
    pub tensile_strength_MPa: Option<f64>,
    /// `fatigue`: "repeated" (the history goes on and on, its end joined to its start) or "once"; "repeated" where not
    /// given.
    pub passage: Option<PassageWord>,
    /// `nominal`, multibody scenes: name of a `[[gear_mesh]]`.
    pub mesh: Option<String>,
    /// `nominal`: where the whole force acts on the tooth for Lewis's stress: "highest-single-contact", or "tip", safer
    /// and for any contact ratio; the former where not given.
    pub load_point: Option<LoadPointWord>,
}

/// `rating.kind`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum RatingKind {
    /// Rainflow count and Miner's sum of recovered root stress.
    Fatigue,
    /// Lewis and Hertz under the largest force.
    Nominal,
}

impl RatingKind {
    /// Name in files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Fatigue => "fatigue",
            Self::Nominal => "nominal",
        }
    }
}

/// `surface`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum SurfaceWord {
    /// Held along the axis.
    #[default]
    PlaneStrain,
    /// Free to contract.
    Uniaxial,
}

/// `mean_stress`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum MeanStressWord {
    /// The mean is not looked at.
    #[default]
    None,
    /// Goodman's line.
    Goodman,
}

/// `passage`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum PassageWord {
    /// Again and again.
    #[default]
    Repeated,
    /// Once.
    Once,
}

/// `load_point`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum LoadPointWord {
    /// The highest point of single contact.
    #[default]
    HighestSingleContact,
    /// The tip.
    Tip,
}

/// A rating, checked as far as no part of the scene is needed.
#[derive(Debug, Clone, PartialEq)]
pub enum Rating {
    /// Rainflow count and Miner's sum.
    Fatigue(FatigueRule),
    /// Lewis and Hertz, where the force acts for Lewis's stress.
    Nominal(LoadPoint),
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

impl RatingTable {
    /// Checks the keys of the chosen kind and refuses those of others.
    ///
    /// # Errors
    /// [`InputError`] naming the key.
    pub fn check(&self, keys: &TableKeys<'_>) -> Result<Rating, InputError> {
        let word = self.kind.name();
        let fatigue: &[&str] = &["fatigue"];
        keys.refuse_unused(
            ("kind", word),
            &[
                ("gauge", self.gauge.is_some(), fatigue),
                ("body", self.body.is_some(), fatigue),
                ("gear", self.gear.is_some(), fatigue),
                ("sn_table", self.sn_table.is_some(), fatigue),
                ("method", self.method.is_some(), fatigue),
                ("surface", self.surface.is_some(), fatigue),
                ("mean_stress", self.mean_stress.is_some(), fatigue),
                (
                    "tensile_strength_MPa",
                    self.tensile_strength_MPa.is_some(),
                    fatigue,
                ),
                ("passage", self.passage.is_some(), fatigue),
                ("mesh", self.mesh.is_some(), &["nominal"]),
                ("load_point", self.load_point.is_some(), &["nominal"]),
            ],
        )?;
        let kind = format!("kind = \"{word}\"");
        if self.kind == RatingKind::Nominal {
            return Ok(Rating::Nominal(match self.load_point.unwrap_or_default() {
                LoadPointWord::HighestSingleContact => LoadPoint::HighestSingleContact,
                LoadPointWord::Tip => LoadPoint::Tip,
            }));
        }
        let method = self.method.unwrap_or(2);
        keys.require("method", method as f64, (1..=2).contains(&method), "1 or 2")?;
        Ok(Rating::Fatigue(FatigueRule {
            gauge: keys.needed("gauge", self.gauge.clone(), &kind)?,
            method,
            surface: match self.surface.unwrap_or_default() {
                SurfaceWord::PlaneStrain => SurfaceState::PlaneStrain,
                SurfaceWord::Uniaxial => SurfaceState::Uniaxial,
            },
            mean_stress: self.mean_stress(keys)?,
            passage: match self.passage.unwrap_or_default() {
                PassageWord::Repeated => Passage::Repeated,
                PassageWord::Once => Passage::Once,
            },
            sn_table: keys.needed("sn_table", self.sn_table.clone(), &kind)?,
        }))
    }

    /// Refuses the keys of multibody scenes, for a scene of a pair.
    ///
    /// # Errors
    /// [`InputError`] for the first of them that is given.
    pub fn refuse_keys_of_systems(&self, keys: &TableKeys<'_>) -> Result<(), InputError> {
        for (key, given, instead) in [
            (
                "body",
                self.body.is_some(),
                "; gear = 1 or 2 says whose gauge it is",
            ),
            ("mesh", self.mesh.is_some(), ", which has one mesh"),
            ("from_s", self.from_s.is_some(), ", which has no time"),
        ] {
            if given {
                let problem = format!("is not used by a scene of a [pair]{instead}; remove it");
                return Err(keys.error(key, problem));
            }
        }
        Ok(())
    }

    /// Refuses the key of scenes of a pair, for a multibody scene.
    ///
    /// # Errors
    /// [`InputError`] where it is given.
    pub fn refuse_keys_of_pairs(&self, keys: &TableKeys<'_>) -> Result<(), InputError> {
        match self.gear {
            None => Ok(()),
            Some(_) => Err(keys.error(
                "gear",
                "is not used by a multibody scene; body says whose gauge it is; remove it",
            )),
        }
    }

    fn mean_stress(&self, keys: &TableKeys<'_>) -> Result<MeanStress, InputError> {
        let key = "tensile_strength_MPa";
        let rule = self.mean_stress.unwrap_or_default();
        match (rule, self.tensile_strength_MPa) {
            (MeanStressWord::None, None) => Ok(MeanStress::None),
            (MeanStressWord::None, Some(_)) => Err(keys.error(
                key,
                "is used by mean_stress = \"goodman\" only; remove one of the two",
            )),
            (MeanStressWord::Goodman, strength) => {
                let strength = keys.needed(key, strength, "mean_stress = \"goodman\"")?;
                keys.require(key, strength, strength > 0.0, "more than 0")?;
                Ok(MeanStress::Goodman {
                    tensile_strength_pa: MPA * strength,
                })
            }
        }
    }
}
