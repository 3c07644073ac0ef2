//! `[[rating]]`: is a tooth strong enough, and for how long; computed after the run from what it writes.
//!
//! | kind | what | keys |
//! | --- | --- | --- |
//! | `fatigue` | cycles and damage of the stress at a root gauge | `gauge`, `sn_table`; `method`, `surface`, `mean_stress`, `tensile_strength_MPa`, `passage` |
//! | `nominal` | Lewis's root stress and Hertz's pressure under the largest normal force | `mesh`; `load_point` |

use std::path::{Path, PathBuf};

use gearmesh_geometry::InputError;
use gearmesh_geometry::input::{InputDocument, TableKeys};
use gearmesh_rating::{MeanStress, Passage, SnCurve, SnError, SnTable, SnTableError, SurfaceState};
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
    /// The part of the run before this time is left out: 0 where not given.
    pub from_s: Option<f64>,
    /// `fatigue`: name of a gauge that a `[[gauge]]` reads.
    pub gauge: Option<String>,
    /// `fatigue`: body of the gauge; needed where gauges of several bodies have that name.
    pub body: Option<String>,
    /// `fatigue`: S-N table (.toml) of local stress amplitudes at zero mean, relative to the scene.
    pub sn_table: Option<PathBuf>,
    /// `fatigue`: method of strain recovery, 1 or 2; 2 where not given.
    pub method: Option<usize>,
    /// `fatigue`: "plane-strain" (stress E ε/(1 − ν²), middle of a wide tooth) or "uniaxial" (E ε, near the end faces); "plane-strain" where
    /// not given.
    pub surface: Option<SurfaceWord>,
    /// `fatigue`: "none" or "goodman"; "none" where not given.
    pub mean_stress: Option<MeanStressWord>,
    /// `fatigue` with "goodman": tensile strength of the material.
    pub tensile_strength_MPa: Option<f64>,
    /// `fatigue`: "repeated" (the history goes on and on, its end joined to its start) or "once"; "repeated" where not given.
    pub passage: Option<PassageWord>,
    /// `nominal`: name of a `[[gear_mesh]]`.
    pub mesh: Option<String>,
    /// `nominal`: where the whole force acts on the tooth for Lewis's stress: "highest-single-contact", or "tip", safer and for any contact
    /// ratio; the former where not given.
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

/// A rating, checked as far as no part of the system is needed.
#[derive(Debug, Clone, PartialEq)]
pub enum Rating {
    /// Rainflow count and Miner's sum.
    Fatigue(FatigueRule),
    /// Lewis and Hertz.
    Nominal {
        /// Name of the gear mesh.
        mesh: String,
        /// Where the force acts for Lewis's stress.
        load_point: LoadPointWord,
    },
}

/// How a stress history is judged.
#[derive(Debug, Clone, PartialEq)]
pub struct FatigueRule {
    /// Gauge.
    pub gauge: String,
    /// Its body, where stated.
    pub body: Option<String>,
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
            return Ok(Rating::Nominal {
                mesh: keys.needed("mesh", self.mesh.clone(), &kind)?,
                load_point: self.load_point.unwrap_or_default(),
            });
        }
        let method = self.method.unwrap_or(2);
        keys.require("method", method as f64, (1..=2).contains(&method), "1 or 2")?;
        Ok(Rating::Fatigue(FatigueRule {
            gauge: keys.needed("gauge", self.gauge.clone(), &kind)?,
            body: self.body.clone(),
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

/// Reads an S-N table; complaints name its file, line and key, that of the scene where there is no such file.
///
/// # Errors
/// [`InputError`].
pub fn read_sn_table(path: &Path, keys: &TableKeys<'_>) -> Result<SnCurve, InputError> {
    if !path.is_file() {
        let problem = format!("the S-N table {} does not exist", path.display());
        return Err(keys.error("sn_table", problem));
    }
    let document = InputDocument::read(path)?;
    let table: SnTable = document.parse()?;
    table
        .curve()
        .map_err(|error| document.error(&place(&error), error))
}

/// The key that a complaint about an S-N table is about.
fn place(error: &SnTableError) -> String {
    let amplitude = |row: &usize| format!("stress_amplitude_MPa.{}", row - 1);
    let cycles = |row: &usize| format!("cycles.{}", row - 1);
    match error {
        SnTableError::SlopeBelow | SnTableError::Curve(SnError::Slope { .. }) => "below".into(),
        SnTableError::Curve(SnError::NotDecreasing { row, .. }) => amplitude(row),
        SnTableError::Curve(SnError::CyclesNotIncreasing { row, .. }) => cycles(row),
        SnTableError::Curve(SnError::NotPositive { row, what, .. }) if *what == "cycles" => {
            cycles(row)
        }
        SnTableError::Curve(SnError::NotPositive { row, .. }) => amplitude(row),
        _ => "cycles".into(),
    }
}
