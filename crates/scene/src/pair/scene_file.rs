//! The scene file: a gear pair, its models, torques, angle range and gauges.

use super::taken_misalignment::MisalignmentFrom;
use crate::former_forms::PAIR;
use crate::gear_tables::flank_errors::FlankErrorTable;
use crate::gear_tables::friction::PairFrictionTable;
use crate::gear_tables::path_word::PathWord;
use crate::gear_tables::seat::{BoreHold, EccentricityTable};
use crate::rating::RatingTable;
use gearmesh_contact::{ContactOptions, LocalContact};
use gearmesh_geometry::gear_file::MicrogeometryTable;
use gearmesh_geometry::input::{Bounded, Count, End, InputDocument, Positive, Within};
use gearmesh_geometry::{Flank, InputError, Misalignment, kinds, number_range};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// The keys of the file.
#[derive(Debug, Clone, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PairTables {
    /// Title in prints and reports.
    pub title: String,
    /// The gears and how they stand.
    pub pair: PairTable,
    /// What gear 1 has beside its body.
    #[serde(default)]
    pub gear_1: GearTable,
    /// What gear 2 has beside its body.
    #[serde(default)]
    pub gear_2: GearTable,
    /// Model of the teeth.
    pub mesh: MeshTable,
    /// Torques and angles.
    pub run: RunTable,
    /// Gauges to read.
    #[serde(default)]
    pub gauges: GaugesTable,
    /// What is judged after the run, at each torque.
    #[serde(default)]
    pub rating: Vec<RatingTable>,
}

impl PairTables {
    /// What keys say together.
    fn check_together(&self, document: &InputDocument) -> Result<(), InputError> {
        let (pair, teeth) = (&self.pair, &self.mesh.teeth);
        for (key, value) in [
            ("pair.inclination_mrad", pair.inclination_mrad),
            ("pair.deviation_mrad", pair.deviation_mrad),
        ] {
            if value.is_some() && pair.misalignment_from.is_some() {
                let problem =
                    "is stated and taken from a result (misalignment_from); remove one of the two";
                return Err(document.error(key, problem));
            }
        }
        if self.run.torques_Nm.is_empty() {
            let problem = "is empty; name at least one torque on gear 2";
            return Err(document.error("run.torques_Nm", problem));
        }
        if matches!(teeth.path, Some(PathWord::LineOfAction)) && teeth.edge_radius_um.is_some() {
            let problem =
                "is not used on the line of action; set path = \"extended\" or leave it out";
            return Err(document.error("mesh.teeth.edge_radius_um", problem));
        }
        let gears = [(1, &self.gear_1), (2, &self.gear_2)];
        for (number, gear) in gears {
            if let Some(own) = &gear.microgeometry {
                own.check_together((document, &format!("gear_{number}.microgeometry")))?;
            }
        }
        for (number, gear) in gears {
            if gear.bore == Some(BoreHold::Rollers) {
                let problem = "found \"rollers\", allowed are \"bonded\" and \"sliding\": a pair has no bearing; state the gears as [[body]] of a scene, \
                               with the [[bearing]] whose outer ring is the bore";
                return Err(document.error(&format!("gear_{number}.bore"), problem));
            }
        }
        Ok(())
    }
}

/// `[pair]`.
#[derive(Debug, Clone, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PairTable {
    /// Reduced model (.h5) of the driving gear, relative to the scene.
    pub gear_1: PathBuf,
    /// Reduced model of the driven gear.
    pub gear_2: PathBuf,
    /// Centre distance.
    pub centre_distance_mm: Bounded<Positive>,
    /// Hand of the flanks in contact; "right" (gear 1 turns clockwise) where not given.
    #[serde(default = "default_flank")]
    pub flank: Flank,
    /// Mid-face of gear 2 from that of gear 1 along the axes; 0 where not given.
    pub axial_offset_mm: Option<Bounded<Within<-10_000, 10_000>>>,
    /// Axis error in the plane of the axes; 0 where not given.
    pub inclination_mrad: Option<Bounded<SmallAngle>>,
    /// Axis error across the plane of the axes; 0 where not given.
    pub deviation_mrad: Option<Bounded<SmallAngle>>,
    /// Axis errors as a static run of the gearbox has found them, instead of the two.
    pub misalignment_from: Option<MisalignmentFrom>,
}

number_range!(
    /// Angles between axes.
    pub SmallAngle: End::At(-10.0), End::At(10.0), "the misalignment is treated as small"
);

number_range!(
    /// Torques under which a pair rests.
    pub ClosingTorque: End::Beyond(0.0), End::Open, "the static solution needs a load that closes the contact"
);

/// `[gear_1]` and `[gear_2]`.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema, Default)]
#[serde(deny_unknown_fields)]
pub struct GearTable {
    /// Microgeometry, instead of all that the gear file inside the model states.
    pub microgeometry: Option<MicrogeometryTable>,
    /// Reduced gear with [reduction.bore]: "bonded", the bore is glued to a rigid pin; "sliding", it slides on it, and
    /// what turns the gear acts evenly round it; "bonded" where not given. "rollers" need a scene of bodies.
    pub bore: Option<BoreHold>,
}

fn default_flank() -> Flank {
    Flank::Right
}

/// `[mesh]`.
#[derive(Debug, Clone, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "PairMeshTable")]
pub struct MeshTable {
    /// Model of the teeth.
    pub model: PairModel,
    /// What touches and how.
    #[serde(default)]
    pub teeth: PairTeethTable,
}

/// `mesh.model`.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[serde(remote = "Self", rename_all = "kebab-case", deny_unknown_fields)]
#[schemars(tag = "kind", rename = "PairModel")]
pub enum PairModel {
    /// Finite element compliance and the contact problem of the slices.
    Hybrid {
        /// Local contact; "calibrated" where not given.
        #[serde(default)]
        local: LocalContact,
        /// Slices over the overlap of the faces; those of the models where not given.
        slices: Option<usize>,
    },
}

kinds!(PairModel, "kind");

impl Default for PairModel {
    fn default() -> Self {
        Self::Hybrid {
            local: LocalContact::default(),
            slices: None,
        }
    }
}

/// `mesh.teeth`.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema, Default)]
#[serde(deny_unknown_fields, default)]
pub struct PairTeethTable {
    /// Ends of the path of contact; "extended" where not given, "line-of-action" for helical teeth.
    pub path: Option<PathWord>,
    /// With path = "extended": radius of the tip edges; 100 where not given.
    pub edge_radius_um: Option<Bounded<Within<1, 1000>>>,
    /// Tooth friction; none where not given.
    pub friction: Option<PairFrictionTable>,
    /// Errors and faults of gear 1.
    pub errors_1: Vec<FlankErrorTable>,
    /// Errors and faults of gear 2.
    pub errors_2: Vec<FlankErrorTable>,
    /// Place of gear 1 on its body: runout and wobble.
    pub eccentricity_1: Option<EccentricityTable>,
    /// Place of gear 2 on its body.
    pub eccentricity_2: Option<EccentricityTable>,
}

/// Radius of a tip edge where the scene states none, in micrometres: a deburred edge.
const DEFAULT_EDGE_RADIUS_UM: f64 = 100.0;

/// `[run]`.
#[derive(Debug, Clone, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[allow(non_snake_case)]
pub struct RunTable {
    /// Torques on gear 2.
    pub torques_Nm: Vec<Bounded<ClosingTorque>>,
    /// First driver angle; 0 where not given.
    pub start_deg: Option<Bounded<Within<-36_000, 36_000>>>,
    /// Pitches of gear 1 to run through.
    pub pitches: Count<1, 100_000>,
    /// Positions per pitch.
    pub points_per_pitch: Count<4, 100_000>,
}

/// `[gauges]`.
#[derive(Debug, Clone, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GaugesTable {
    /// Gauges of gear 1, by name.
    #[serde(default)]
    pub gear_1: Vec<String>,
    /// Gauges of gear 2, by name.
    #[serde(default)]
    pub gear_2: Vec<String>,
}

/// A gear of a pair.
#[derive(Debug, Clone)]
pub struct PairGear {
    /// Its reduced model.
    pub model: PathBuf,
    /// Its microgeometry; that of the gear file inside the model where none is given.
    pub microgeometry: Option<MicrogeometryTable>,
    /// Whether its bore slides on a rigid pin.
    pub slides: bool,
    /// Its errors and faults.
    pub errors: Vec<FlankErrorTable>,
    /// Its place on its body.
    pub eccentricity: Option<EccentricityTable>,
    /// Gauges to read, by name.
    pub gauges: Vec<String>,
}

/// A scene that has been read and checked. Paths are relative to the scene file's folder.
#[derive(Debug, Clone)]
pub struct Scene {
    /// Title in prints and reports.
    pub title: String,
    /// The driving gear and the driven one.
    pub gears: [PairGear; 2],
    /// Centre distance \[m\].
    pub centre_distance_m: f64,
    /// Mid-face of gear 2 from that of gear 1 along the axes \[m\].
    pub axial_offset_m: f64,
    /// Hand of the flanks in contact, on both gears.
    pub flank: Flank,
    /// Axis errors that the scene states.
    pub misalignment: Misalignment,
    /// Result from which they are taken instead.
    pub misalignment_from: Option<MisalignmentFrom>,
    /// Slices over the overlap of the faces; those of the models where none are given.
    pub slices: Option<usize>,
    /// Local contact and friction.
    pub contact: ContactOptions,
    /// Radius of the tip edges \[m\] where the path is `extended`; none where it is `line-of-action`.
    pub edge_radius_m: Option<f64>,
    /// Whether the scene leaves the path open: `extended` but for helical teeth.
    pub path_by_default: bool,
    /// Torques on gear 2 \[N·m\].
    pub torques_nm: Vec<f64>,
    /// First driver angle \[rad\].
    pub start_rad: f64,
    /// Pitches of gear 1 to run through.
    pub pitches: usize,
    /// Positions per pitch.
    pub points_per_pitch: usize,
    /// What is judged after the run; checked when the models are known.
    pub ratings: Vec<RatingTable>,
    /// Where the scene is.
    pub folder: PathBuf,
    /// What to tell about the file beside its sense: tables in a former form.
    pub notes: Vec<String>,
    /// The file, for later complaints and provenance.
    pub document: InputDocument,
}

impl Scene {
    /// Reads and checks a scene file.
    ///
    /// # Errors
    /// [`InputError`] with file, line, key, what was found and what is allowed.
    pub fn read(path: &Path) -> Result<Self, InputError> {
        let folder = path.parent().unwrap_or(Path::new(""));
        Self::from_document(InputDocument::read(path)?, folder)
    }

    /// The scene of tables in memory; file names are relative to `folder`, models in memory are those of the shelf it
    /// is loaded with.
    ///
    /// # Errors
    /// [`InputError`] with the path of the field, what was found and what is allowed.
    pub fn new(tables: &PairTables, folder: &Path) -> Result<Self, InputError> {
        Self::from_document(InputDocument::of_values(tables, folder)?, folder)
    }

    /// Checks a scene that is already in memory; model paths are taken relative to `folder`.
    ///
    /// # Errors
    /// As [`Scene::read`].
    pub fn from_document(document: InputDocument, folder: &Path) -> Result<Self, InputError> {
        let document = document.with_former(PAIR);
        let table: PairTables = document.parse()?;
        table.check_together(&document)?;
        let (pair, teeth) = (&table.pair, table.mesh.teeth);
        let friction = teeth.friction.as_ref().map(PairFrictionTable::friction);
        let edge_radius_m = match teeth.path {
            Some(PathWord::LineOfAction) => None,
            Some(PathWord::Extended) | None => {
                let radius_um = teeth.edge_radius_um;
                Some(1e-6 * radius_um.map_or(DEFAULT_EDGE_RADIUS_UM, f64::from))
            }
        };
        let gear_1 = PairGear {
            model: folder.join(&pair.gear_1),
            microgeometry: table.gear_1.microgeometry,
            slides: table.gear_1.bore == Some(BoreHold::Sliding),
            errors: teeth.errors_1,
            eccentricity: teeth.eccentricity_1,
            gauges: table.gauges.gear_1,
        };
        let gear_2 = PairGear {
            model: folder.join(&pair.gear_2),
            microgeometry: table.gear_2.microgeometry,
            slides: table.gear_2.bore == Some(BoreHold::Sliding),
            errors: teeth.errors_2,
            eccentricity: teeth.eccentricity_2,
            gauges: table.gauges.gear_2,
        };
        let PairModel::Hybrid { local, slices } = table.mesh.model;
        let notes = document.former_notes()?;
        let notes = notes.iter().map(ToString::to_string).collect();
        Ok(Self {
            title: table.title,
            gears: [gear_1, gear_2],
            centre_distance_m: *pair.centre_distance_mm * 1e-3,
            axial_offset_m: pair.axial_offset_mm.map_or(0.0, f64::from) * 1e-3,
            flank: pair.flank,
            misalignment: Misalignment {
                inclination_rad: pair.inclination_mrad.map_or(0.0, f64::from) * 1e-3,
                deviation_rad: pair.deviation_mrad.map_or(0.0, f64::from) * 1e-3,
            },
            misalignment_from: pair.misalignment_from.clone(),
            slices,
            contact: ContactOptions { local, friction },
            edge_radius_m,
            path_by_default: teeth.path.is_none() && teeth.edge_radius_um.is_none(),
            torques_nm: table.run.torques_Nm.iter().map(|torque| **torque).collect(),
            start_rad: table.run.start_deg.map_or(0.0, f64::from).to_radians(),
            pitches: table.run.pitches.get(),
            points_per_pitch: table.run.points_per_pitch.get(),
            ratings: table.rating,
            folder: folder.into(),
            notes,
            document,
        })
    }

    /// Whether teeth of a gear (1 or 2) differ by its errors or its place: it repeats after a revolution only.
    #[must_use]
    pub fn tells_teeth_apart(&self, gear: usize) -> bool {
        let gear = &self.gears[gear - 1];
        gear.eccentricity.is_some() || (gear.errors.iter()).any(FlankErrorTable::tells_teeth_apart)
    }

    /// The scene without what only decides the forces: for reading results, which have them.
    #[must_use]
    pub fn with_known_forces(self) -> Self {
        let gears = self.gears.map(|gear| PairGear {
            microgeometry: None,
            errors: Vec::new(),
            ..gear
        });
        Self {
            misalignment_from: None,
            gears,
            ..self
        }
    }

    /// Number of positions.
    pub fn positions(&self) -> usize {
        self.pitches * self.points_per_pitch
    }
}
