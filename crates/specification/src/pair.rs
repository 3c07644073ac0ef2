//! The scene of a gear pair at rest: its tables, as written in the file, and what they say together.

use crate::former_forms::PAIR;
use crate::gear_tables::flank_errors::FlankErrorTable;
use crate::gear_tables::friction::PairFrictionTable;
use crate::gear_tables::path_word::PathWord;
use crate::gear_tables::seat::{BoreHold, EccentricityTable};
use crate::rating::RatingTable;
use gearmesh_contact::LocalContact;
use gearmesh_geometry::gear_file::MicrogeometryTable;
use gearmesh_geometry::input::{Bounded, Count, End, InputDocument, Positive, Within};
use gearmesh_geometry::{Flank, InputError, kinds, number_range};
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
    /// The tables of a file, checked, and the file with its tables in today's form.
    ///
    /// # Errors
    /// [`InputError`] with file, line, key, what was found and what is allowed.
    pub fn of(document: InputDocument) -> Result<(Self, InputDocument), InputError> {
        let document = document.with_former(PAIR);
        let tables: Self = document.parse()?;
        tables.check_together(&document)?;
        Ok((tables, document))
    }

    /// The document of tables in memory; other files are relative to `folder`.
    ///
    /// # Errors
    /// [`InputError`] for values that no file can hold.
    pub fn document(&self, folder: &Path) -> Result<InputDocument, InputError> {
        InputDocument::of_values(self, folder)
    }

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

/// `misalignment_from`.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MisalignmentFrom {
    /// Result of a `static` run, relative to the scene.
    pub result: PathBuf,
    /// Name of the gear mesh in it.
    pub mesh: String,
    /// Which equilibrium, from 0; the last where not given.
    pub point: Option<usize>,
}

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
pub const DEFAULT_EDGE_RADIUS_UM: f64 = 100.0;

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
