//! The bearing file: TOML with units in the keys, checked key by key, turned into a [`BearingDefinition`] in SI units.

mod arrangement_keys;
mod ball_keys;
mod barrel_keys;
mod catalogue_keys;
mod element_keys;
mod fault_keys;
mod fit_keys;
mod friction_keys;
mod roller_keys;
mod unused_keys;

use std::path::Path;

use gearmesh_geometry::InputError;
use gearmesh_geometry::gear_file::PoissonRatio;
use gearmesh_geometry::input::{
    Bounded, Count, End, InputDocument, NotNegative, Positive, TableKeys, Within,
};
use gearmesh_geometry::{kinds, number_range};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::catalogue::CatalogueType;
use crate::definition::{
    BallBearingKind, BearingDefinition, BearingGeometry, BearingMaterial, StatedRatings,
};
use crate::estimate::Estimate;

pub use fault_keys::{FaultTable, SideWord};

/// A millimetre in metres.
const MM: f64 = 1e-3;
/// A micrometre in metres.
const UM: f64 = 1e-6;

/// JSON Schema (draft 2020-12) of bearing files. Which keys a kind uses is said in their descriptions and checked when the file is read.
pub fn schema() -> schemars::Schema {
    gearmesh_geometry::input::file_schema::<BearingFile>()
}

/// A bearing file.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[schemars(title = "gearmesh bearing")]
#[serde(deny_unknown_fields)]
#[allow(non_snake_case)]
struct BearingFile {
    /// Name in prints; that of the catalogue where one is named.
    name: Option<String>,
    /// What it is, and which keys describe it.
    kind: Kind,
    /// Bore. "catalogue": needed without `designation`; otherwise only checked against the races.
    bore_mm: Option<Bounded<Positive>>,
    /// Outside diameter, as `bore_mm`.
    outside_diameter_mm: Option<Bounded<Positive>>,
    /// Width, as `bore_mm`.
    width_mm: Option<Bounded<Positive>>,
    /// Ball bearings: number of balls in a row. "catalogue": where it is known.
    balls: Option<usize>,
    /// Ball bearings: diameter of the balls. "catalogue": where it is known.
    ball_diameter_mm: Option<Bounded<Positive>>,
    /// Diameter of the circle of the balls' or rollers' middles. "catalogue": where it is known; the middle between bore and outside diameter otherwise.
    pitch_diameter_mm: Option<Bounded<Positive>>,
    /// Ball bearings: radius of the inner groove over the ball's diameter, more than 0.5; of a thrust bearing that of the washer on the shaft.
    inner_conformity: Option<Bounded<Conformity>>,
    /// Ball bearings: radius of the outer groove over the ball's diameter, more than 0.5; of a thrust bearing that of the washer in the housing.
    outer_conformity: Option<Bounded<Conformity>>,
    /// "angular-contact": contact angle without load. "four-point": that of a ball that touches at all four points. "tapered-roller": angle of the outer race against the axis. "spherical-roller": of the load lines. "catalogue": of angular-contact, four-point and tapered roller bearings.
    contact_angle_deg: Option<f64>,
    /// "deep-groove", "four-point", "cylindrical-roller", "spherical-roller", "catalogue": play across the axis from one side to the other; negative: interference, as fits leave it; 0 where not given.
    radial_clearance_um: Option<f64>,
    /// "deep-groove", "angular-contact": diameters of the grooves' bottoms, inner and outer, instead of clearance or contact angle.
    raceway_diameters_mm: Option<[f64; 2]>,
    /// "deep-groove", "angular-contact", "four-point", "catalogue": heights of the shoulders above the bottoms of the inner and outer groove, of the higher one where they differ; estimated where not
    /// given (0.2 of the ball's diameter or 30° beyond the contact angle). Contact ellipses that reach beyond are warned of.
    shoulder_heights_mm: Option<[f64; 2]>,
    /// Roller bearings: number of rollers in a row. "catalogue": where it is known.
    rollers: Option<usize>,
    /// Roller bearings: diameter of the rollers, in their middle. "catalogue": where it is known.
    roller_diameter_mm: Option<Bounded<Positive>>,
    /// Roller bearings: length of the rollers that carries. "catalogue": where it is known.
    roller_length_mm: Option<Bounded<Positive>>,
    /// "spherical-roller": radius of the rollers' profile; 0.97 of the radius of the sphere inside the outer ring where not given.
    roller_profile_radius_mm: Option<f64>,
    /// "spherical-roller": radius of the profile of the inner ring's groove; that of the sphere inside the outer ring where not given.
    inner_groove_radius_mm: Option<f64>,
    /// "cylindrical-roller", "tapered-roller": end profile; logarithmic by ISO/TS 16281 where not given.
    profile: Option<ProfileTable>,
    /// Roller bearings: laminae of a roller; 40 where not given.
    laminae: Option<Count<2, 1000>>,
    /// "tapered-roller": radius of the roller's spherical end over the distance of that end from the apex; 0.95 where not given.
    end_radius_ratio: Option<Bounded<EndRadiusRatio>>,
    /// "tapered-roller": height of the contact with the rib above the inner race's edge; a fifth of the roller's large radius where not given.
    rib_height_mm: Option<f64>,
    /// "catalogue": a designation such as "6205", "7010 C", "NU 204" or "30206": boundary dimensions by ISO 15 and ISO 355.
    designation: Option<String>,
    /// "catalogue": type, where no designation is given.
    r#type: Option<CatalogueType>,
    /// Two rows: "O" (back to back), "X" (face to face) or "tandem"; one row where not given. "catalogue" with two rows in its rings: "O" where not given.
    arrangement: Option<ArrangementWord>,
    /// Distance of the two rows. "catalogue" with two rows in its rings: half the width where not given.
    row_distance_mm: Option<Bounded<Positive>>,
    /// "angular-contact", "thrust-ball", "tapered-roller": axial force that the rows of a pair carry at rest without load; of a single row that which its place without
    /// load stands for.
    preload_N: Option<Bounded<NotNegative>>,
    /// "angular-contact", "thrust-ball", "tapered-roller": axial displacement by which each row's inner ring is pressed in; negative for play.
    preload_um: Option<Bounded<Within<-1000, 1000>>>,
    /// Place of the first ball or roller, from x towards y; 0 where not given.
    first_angle_deg: Option<f64>,
    /// Material of balls or rollers; steel, 206 GPa, 0.3, 7850 kg/m³, where not given.
    element_material: Option<MaterialTable>,
    /// Material of the rings; steel where not given.
    ring_material: Option<MaterialTable>,
    /// Load ratings of the whole bearing; those not given are computed. "catalogue": those of one bearing, `dynamic_N` and `static_N` needed without
    /// `designation`.
    ratings: Option<RatingsTable>,
    /// Fits of the rings and temperatures: the clearance in operation follows from them; the bearing as stated where not given.
    fit: Option<fit_keys::FitTable>,
    /// Friction torque by Palmgren's model; none is computed where not given.
    friction: Option<friction_keys::FrictionTable>,
    /// What is wrong with the bearing, one table a fault; sound where there is none.
    #[serde(default)]
    fault: Vec<FaultTable>,
}

number_range!(
    /// Radius of a groove over the ball's diameter.
    Conformity: End::Beyond(0.5), End::At(1.0), "0.5 is the ball's own radius"
);

number_range!(
    /// Radius of a roller's end over its distance from the apex.
    EndRadiusRatio: End::Beyond(0.2), End::Beyond(1.0), "at 1 the end fits the rib all over"
);

/// `kind`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
enum Kind {
    /// Ball bearing that carries axial loads both ways.
    DeepGroove,
    /// Ball bearing that carries axial loads one way.
    AngularContact,
    /// Ball bearing whose grooves have two arcs each: a ball touches at up to four points.
    FourPoint,
    /// Balls between two washers.
    ThrustBall,
    /// Bears no axial loads.
    CylindricalRoller,
    /// Roller bearing that carries axial loads one way.
    TaperedRoller,
    /// Two rows of barrels in a sphere: carries axial loads both ways and tilts freely.
    SphericalRoller,
    /// Estimated from a line of a catalogue.
    Catalogue,
}

impl Kind {
    fn word(self) -> &'static str {
        match self {
            Self::DeepGroove => "deep-groove",
            Self::AngularContact => "angular-contact",
            Self::FourPoint => "four-point",
            Self::ThrustBall => "thrust-ball",
            Self::CylindricalRoller => "cylindrical-roller",
            Self::TaperedRoller => "tapered-roller",
            Self::SphericalRoller => "spherical-roller",
            Self::Catalogue => "catalogue",
        }
    }
}

/// `arrangement`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
enum ArrangementWord {
    /// Back to back.
    O,
    /// Face to face.
    X,
    /// Alike.
    #[serde(rename = "tandem")]
    Tandem,
}

/// `[profile]`: material taken off a roller towards its ends.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[serde(remote = "Self", rename_all = "kebab-case", deny_unknown_fields)]
#[schemars(tag = "kind", rename = "ProfileTable")]
enum ProfileTable {
    /// Nothing is taken off.
    Straight {},
    /// At x from the middle of the length L: s ln(1/(1 − (2x/L)²)).
    Logarithmic {
        /// s; 0.35 ‰ (tapered: 0.45 ‰) of the diameter where not given.
        scale_um: Option<Bounded<Within<0, 1000>>>,
    },
    /// A circle.
    Crowned {
        /// Radius of the crown.
        radius_mm: Bounded<Positive>,
    },
}

kinds!(ProfileTable, "kind");

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
    /// [`InputError`] for an unreadable file, a key or value that is not allowed, or a bearing that cannot be assembled.
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
        unused_keys::by_kind(&file, &keys)?;
        let mut notes = Vec::new();
        let stated = |mm: Option<Bounded<Positive>>| mm.map(|value| MM * value);
        let mut boundary = (stated(file.bore_mm), stated(file.outside_diameter_mm));
        let (geometry, estimate, name, from_catalogue) = match file.kind {
            Kind::DeepGroove | Kind::AngularContact | Kind::FourPoint | Kind::ThrustBall => {
                let geometry = ball_keys::geometry(&file, &keys, &mut notes)?;
                (BearingGeometry::Ball(geometry), None, None, None)
            }
            Kind::CylindricalRoller | Kind::TaperedRoller => {
                let geometry = roller_keys::geometry(&file, &keys)?;
                (BearingGeometry::Roller(geometry), None, None, None)
            }
            Kind::SphericalRoller => {
                let (geometry, rows) = barrel_keys::geometry(&file, &keys)?;
                let own = (Some(rows), StatedRatings::default());
                (BearingGeometry::Roller(geometry), None, None, Some(own))
            }
            Kind::Catalogue => {
                let found = catalogue_keys::geometry(&file, document, &keys, &mut notes)?;
                boundary = (Some(found.boundary_m.0), Some(found.boundary_m.1));
                (
                    found.geometry,
                    Some(found.estimate),
                    found.name,
                    Some((found.rows, found.ratings)),
                )
            }
        };
        let name = match (file.name.clone(), name) {
            (Some(name), _) | (None, Some(name)) => name,
            (None, None) => return Err(keys.error("name", "missing; give the bearing a name")),
        };
        let stated = file.ratings.clone().unwrap_or_default();
        let fit = (file.fit.as_ref())
            .map(|table| fit_keys::fit(table, document, boundary, &geometry))
            .transpose()?;
        let stated = StatedRatings {
            dynamic_n: stated.dynamic_N.map(f64::from),
            static_n: stated.static_N.map(f64::from),
            fatigue_n: stated.fatigue_N.map(f64::from),
        };
        let (arrangement, stated_ratings) = match from_catalogue {
            None => (arrangement_keys::arrangement(&file, &keys)?, stated),
            Some((Some(rows), _)) => (rows, stated),
            Some((None, of_one)) => {
                let arrangement = arrangement_keys::arrangement(&file, &keys)?;
                let bearings = arrangement.rows().len();
                let ratings = of_one.of_several(bearings, &geometry, stated.fatigue_n);
                (arrangement, ratings)
            }
        };
        let warnings = estimate.iter().filter_map(|e| e.poor_fit.clone()).collect();
        let definition = BearingDefinition {
            name,
            friction: (file.friction.as_ref())
                .map(|table| friction_keys::friction(table, document, &geometry))
                .transpose()?,
            fit,
            faults: fault_keys::faults(&file.fault, document, &geometry, &arrangement)?,
            geometry,
            element_material: material(&file.element_material, document, "element_material")?,
            ring_material: material(&file.ring_material, document, "ring_material")?,
            arrangement,
            preload: arrangement_keys::preload(&file, &keys)?,
            first_angle_rad: file.first_angle_deg.unwrap_or(0.0).to_radians(),
            stated_ratings,
        };
        check_boundary(&file, &keys, &definition)?;
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
    file: &BearingFile,
    keys: &TableKeys<'_>,
    definition: &BearingDefinition,
) -> Result<(), InputError> {
    if file.kind == Kind::Catalogue {
        return Ok(());
    }
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
    if let Some(bore) = file.bore_mm.map(f64::from) {
        let most = inner_m / MM;
        keys.require(
            "bore_mm",
            bore,
            bore < most,
            &format!("less than {most:.3}, the diameter of the inner race"),
        )?;
    }
    if let Some(outside) = file.outside_diameter_mm.map(f64::from) {
        let least = outer_m / MM;
        keys.require(
            "outside_diameter_mm",
            outside,
            outside > least,
            &format!("more than {least:.3}, the diameter of the outer race"),
        )?;
    }
    Ok(())
}
