//! The bearing file: TOML with units in the keys, checked key by key, turned into a [`BearingDefinition`] in SI units.

mod ball_keys;
mod barrel_keys;
mod catalogue_keys;
mod element_keys;
mod fault_keys;
mod fit_keys;
mod friction_keys;
mod roller_keys;
mod row_keys;

use std::path::Path;

use gearmesh_geometry::InputError;
use gearmesh_geometry::gear_file::PoissonRatio;
use gearmesh_geometry::input::{Beside, Bounded, InputDocument, Positive, TableKeys};
use gearmesh_geometry::kinds;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::definition::{
    Arrangement, BallBearingKind, BearingDefinition, BearingGeometry, BearingMaterial, Preload,
    StatedRatings,
};
use crate::estimate::Estimate;
use ball_keys::{AngularContactKeys, BallKeys, DeepGrooveKeys, FourPointKeys};
use barrel_keys::SphericalRollerKeys;
use catalogue_keys::{CatalogueKeys, Line};
use roller_keys::{CylindricalRollerKeys, RollerKeys, TaperedRollerKeys};
use row_keys::{PreloadKeys, RowKeys};

pub use fault_keys::{FaultTable, SideWord};

/// A millimetre in metres.
const MM: f64 = 1e-3;
/// A micrometre in metres.
const UM: f64 = 1e-6;

/// JSON Schema (draft 2020-12) of bearing files. Each kind has its keys.
pub fn schema() -> schemars::Schema {
    gearmesh_geometry::input::file_schema::<BearingFile>()
}

/// A bearing file: the keys of a kind beside those that all bearings have.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[serde(remote = "Self", rename_all = "kebab-case", deny_unknown_fields)]
#[schemars(tag = "kind", rename = "gearmesh bearing")]
enum BearingFile {
    /// Ball bearing that carries axial loads both ways.
    DeepGroove(Of<Beside<BallKeys, Beside<RowKeys, DeepGrooveKeys>>>),
    /// Ball bearing that carries axial loads one way.
    AngularContact(Of<Beside<BallKeys, Paired<AngularContactKeys>>>),
    /// Ball bearing whose grooves have two arcs each: a ball touches at up to four points.
    FourPoint(Of<Beside<BallKeys, FourPointKeys>>),
    /// Balls between two washers.
    ThrustBall(Of<Beside<BallKeys, PreloadKeys>>),
    /// Roller bearing that carries no axial loads.
    CylindricalRoller(Of<Beside<RollerKeys, Beside<RowKeys, CylindricalRollerKeys>>>),
    /// Roller bearing that carries axial loads one way.
    TaperedRoller(Of<Beside<RollerKeys, Paired<TaperedRollerKeys>>>),
    /// Two rows of barrels in a sphere: carries axial loads both ways and tilts freely.
    SphericalRoller(Of<Beside<RollerKeys, SphericalRollerKeys>>),
    /// Estimated from a line of a catalogue.
    Catalogue(Of<Paired<CatalogueKeys>>),
}

kinds!(BearingFile, "kind");

/// A bearing of a kind.
type Of<K> = Beside<GeneralKeys, K>;

/// Bearings that are mounted in pairs and pressed against each other.
type Paired<K> = Beside<RowKeys, Beside<PreloadKeys, K>>;

impl BearingFile {
    fn general(&self) -> &GeneralKeys {
        match self {
            Self::DeepGroove(Beside(general, _))
            | Self::AngularContact(Beside(general, _))
            | Self::FourPoint(Beside(general, _))
            | Self::ThrustBall(Beside(general, _))
            | Self::CylindricalRoller(Beside(general, _))
            | Self::TaperedRoller(Beside(general, _))
            | Self::SphericalRoller(Beside(general, _))
            | Self::Catalogue(Beside(general, _)) => general,
        }
    }
}

/// Keys of all bearings.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct GeneralKeys {
    /// Name in prints; needed except where a catalogue names the bearing.
    name: Option<String>,
    /// Bore. "catalogue": needed without `designation`; otherwise only checked against the races.
    bore_mm: Option<Bounded<Positive>>,
    /// Outside diameter, as `bore_mm`.
    outside_diameter_mm: Option<Bounded<Positive>>,
    /// Width, as `bore_mm`.
    width_mm: Option<Bounded<Positive>>,
    /// Place of the first ball or roller, from x towards y; 0 where not given.
    first_angle_deg: Option<f64>,
    /// Material of balls or rollers; steel, 206 GPa, 0.3, 7850 kg/m³, where not given.
    element_material: Option<MaterialTable>,
    /// Material of the rings; steel where not given.
    ring_material: Option<MaterialTable>,
    /// Load ratings of the whole bearing; those not given are computed. "catalogue": those of one bearing, `dynamic_N`
    /// and `static_N` needed without `designation`.
    ratings: Option<RatingsTable>,
    /// Fits of the rings and temperatures: the clearance in operation follows from them; the bearing as stated where
    /// not given.
    fit: Option<fit_keys::FitTable>,
    /// Friction torque by Palmgren's model; none is computed where not given.
    friction: Option<friction_keys::FrictionTable>,
    /// What is wrong with the bearing, one table a fault; sound where there is none.
    #[serde(default)]
    fault: Vec<FaultTable>,
}

/// `[element_material]`, `[ring_material]`: linear elastic, isotropic.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[allow(non_snake_case)]
struct MaterialTable {
    /// Young's modulus.
    young_GPa: Bounded<Positive>,
    /// Poisson's ratio.
    poisson: Bounded<PoissonRatio>,
    /// Density; of the elements only, for their centrifugal force. 7850 where not given.
    density_kg_per_m3: Option<Bounded<Positive>>,
}

/// `[ratings]`: load ratings of the whole bearing.
#[derive(Debug, Clone, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[allow(non_snake_case)]
struct RatingsTable {
    /// C, dynamic; by ISO 281 where not given.
    dynamic_N: Option<Bounded<Positive>>,
    /// C₀, static; by ISO 76 where not given.
    static_N: Option<Bounded<Positive>>,
    /// C_u, fatigue load limit; from C₀ by ISO 281, annex B, where not given.
    fatigue_N: Option<Bounded<Positive>>,
}

/// What a bearing file holds.
#[derive(Debug, Clone, PartialEq)]
pub struct BearingFromFile {
    /// The bearing.
    pub definition: BearingDefinition,
    /// How its inside was estimated, for `kind = "catalogue"`.
    pub estimate: Option<Estimate>,
    /// Remarks for the user.
    pub notes: Vec<String>,
    /// What the user should look at: estimates that fit badly.
    pub warnings: Vec<String>,
    /// Numbers that look like those of another unit.
    pub unit_slips: Vec<InputError>,
}

impl BearingFromFile {
    /// Whether a document is meant as a bearing: it says of what kind at its top, and holds no teeth.
    ///
    /// # Errors
    /// [`InputError`] for a document that is no TOML.
    pub fn recognises(document: &InputDocument) -> Result<bool, InputError> {
        let keys = document.top_keys()?;
        Ok(keys.contains("kind") && !keys.contains("tooth"))
    }

    /// Reads and checks a bearing file.
    ///
    /// # Errors
    /// [`InputError`] for an unreadable file, a key or value that is not allowed, or a bearing that cannot be
    /// assembled.
    pub fn read(path: &Path) -> Result<Self, InputError> {
        Self::from_document(&InputDocument::read(path)?)
    }

    /// Checks a bearing file that is already in memory.
    ///
    /// # Errors
    /// As [`Self::read`].
    pub fn from_document(document: &InputDocument) -> Result<Self, InputError> {
        let file: BearingFile = document.parse()?;
        let keys = TableKeys::new(document, "");
        let mut notes = Vec::new();
        let inside = file.inside(document, &keys, &mut notes)?;
        let general = file.general();
        let name = general.name.clone().or(inside.name);
        let name = name.ok_or_else(|| keys.error("name", "missing; give the bearing a name"))?;
        let geometry = inside.geometry;
        let estimate = inside.estimate;
        let warnings = estimate.iter().filter_map(|e| e.poor_fit.clone()).collect();
        let definition = BearingDefinition {
            name,
            friction: (general.friction.as_ref())
                .map(|table| friction_keys::friction(table, document, &geometry))
                .transpose()?,
            fit: (general.fit.as_ref())
                .map(|table| fit_keys::fit(table, document, inside.boundary_m, &geometry))
                .transpose()?,
            faults: fault_keys::faults(&general.fault, document, &geometry, &inside.arrangement)?,
            element_material: material(&general.element_material, document, "element_material")?,
            ring_material: material(&general.ring_material, document, "ring_material")?,
            arrangement: inside.arrangement,
            preload: inside.preload,
            first_angle_rad: general.first_angle_deg.unwrap_or(0.0).to_radians(),
            stated_ratings: inside.ratings,
            geometry,
        };
        if estimate.is_none() {
            check_boundary(general, &keys, &definition)?;
        }
        fit_keys::require_operating(&definition, document)?;
        Ok(Self {
            definition,
            estimate,
            notes,
            warnings,
            unit_slips: document.unit_slips(),
        })
    }
}

/// What the keys of a kind say.
struct Inside {
    geometry: BearingGeometry,
    arrangement: Arrangement,
    preload: Preload,
    ratings: StatedRatings,
    /// Bore and outside diameter \[m\].
    boundary_m: (Option<f64>, Option<f64>),
    estimate: Option<Estimate>,
    /// Name in a catalogue.
    name: Option<String>,
}

impl BearingFile {
    fn inside(
        &self,
        document: &InputDocument,
        keys: &TableKeys<'_>,
        notes: &mut Vec<String>,
    ) -> Result<Inside, InputError> {
        use BearingGeometry::{Ball, Roller};
        let none = Preload::None;
        let (geometry, arrangement, preload) = match self {
            Self::DeepGroove(Beside(_, Beside(balls, Beside(rows, own)))) => {
                let geometry = ball_keys::deep_groove(balls, own, keys, notes)?;
                (Ball(geometry), rows.arrangement(keys)?, none)
            }
            Self::AngularContact(Beside(_, Beside(balls, Beside(rows, Beside(preload, own))))) => {
                let geometry = ball_keys::angular_contact(balls, own, keys, notes)?;
                (
                    Ball(geometry),
                    rows.arrangement(keys)?,
                    preload.preload(keys)?,
                )
            }
            Self::FourPoint(Beside(_, Beside(balls, own))) => {
                let geometry = ball_keys::four_point(balls, own, keys)?;
                (Ball(geometry), Arrangement::Single, none)
            }
            Self::ThrustBall(Beside(_, Beside(balls, preload))) => {
                let geometry = ball_keys::thrust(balls, keys)?;
                (Ball(geometry), Arrangement::Single, preload.preload(keys)?)
            }
            Self::CylindricalRoller(Beside(_, Beside(rollers, Beside(rows, own)))) => {
                let geometry = roller_keys::cylindrical(rollers, own, keys)?;
                (Roller(geometry), rows.arrangement(keys)?, none)
            }
            Self::TaperedRoller(Beside(_, Beside(rollers, Beside(rows, Beside(preload, own))))) => {
                let geometry = roller_keys::tapered(rollers, own, keys)?;
                (
                    Roller(geometry),
                    rows.arrangement(keys)?,
                    preload.preload(keys)?,
                )
            }
            Self::SphericalRoller(Beside(_, Beside(rollers, own))) => {
                let (geometry, rows) = barrel_keys::geometry(rollers, own, keys)?;
                (Roller(geometry), rows, none)
            }
            Self::Catalogue(Beside(general, Beside(rows, Beside(preload, own)))) => {
                let line = Line {
                    general,
                    rows,
                    preload,
                    own,
                };
                return catalogue_keys::inside(line, document, keys, notes);
            }
        };
        let general = self.general();
        let stated = |mm: Option<Bounded<Positive>>| mm.map(|value| MM * value);
        Ok(Inside {
            geometry,
            arrangement,
            preload,
            ratings: general.stated_ratings(),
            boundary_m: (stated(general.bore_mm), stated(general.outside_diameter_mm)),
            estimate: None,
            name: None,
        })
    }
}

impl GeneralKeys {
    fn stated_ratings(&self) -> StatedRatings {
        let stated = self.ratings.clone().unwrap_or_default();
        StatedRatings {
            dynamic_n: stated.dynamic_N.map(f64::from),
            static_n: stated.static_N.map(f64::from),
            fatigue_n: stated.fatigue_N.map(f64::from),
        }
    }
}

fn material(
    table: &Option<MaterialTable>,
    document: &InputDocument,
    name: &str,
) -> Result<BearingMaterial, InputError> {
    let Some(table) = table else {
        return Ok(BearingMaterial::STEEL);
    };
    let keys = TableKeys::new(document, name);
    if name == "ring_material" && table.density_kg_per_m3.is_some() {
        return Err(keys.error(
            "density_kg_per_m3",
            "is not used: the mass of the rings belongs to the bodies that carry them; remove it",
        ));
    }
    Ok(BearingMaterial {
        young_pa: 1e9 * table.young_GPa,
        poisson: *table.poisson,
        density_kg_per_m3: table
            .density_kg_per_m3
            .map_or(BearingMaterial::STEEL.density_kg_per_m3, f64::from),
    })
}

/// The races must lie between bore and outside diameter where these are given.
fn check_boundary(
    general: &GeneralKeys,
    keys: &TableKeys<'_>,
    definition: &BearingDefinition,
) -> Result<(), InputError> {
    let (inner_m, outer_m) = match &definition.geometry {
        // Washers reach beyond the middles of the balls.
        BearingGeometry::Ball(g) if g.kind == BallBearingKind::Thrust => {
            (g.pitch_diameter_m, g.pitch_diameter_m)
        }
        BearingGeometry::Ball(g) => g.raceway_diameters_m(),
        BearingGeometry::Roller(g) => (
            g.pitch_diameter_m - g.diameter_m,
            g.pitch_diameter_m + g.diameter_m,
        ),
    };
    if let Some(bore) = general.bore_mm {
        let most = inner_m / MM;
        let allowed = format!("less than {most:.3}, the diameter of the inner race");
        keys.require("bore_mm", *bore, *bore < most, &allowed)?;
    }
    if let Some(outside) = general.outside_diameter_mm {
        let least = outer_m / MM;
        let allowed = format!("more than {least:.3}, the diameter of the outer race");
        keys.require("outside_diameter_mm", *outside, *outside > least, &allowed)?;
    }
    Ok(())
}
