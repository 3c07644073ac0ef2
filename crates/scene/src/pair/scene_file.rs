//! The scene of a gear pair at rest, read and checked: models, torques, angle range and gauges.

use gearmesh_contact::ContactOptions;
use gearmesh_geometry::gear_file::MicrogeometryTable;
use gearmesh_geometry::input::InputDocument;
use gearmesh_geometry::{Flank, InputError, Misalignment};
use gearmesh_specification::gear_tables::flank_errors::FlankErrorTable;
use gearmesh_specification::gear_tables::friction::PairFrictionTable;
use gearmesh_specification::gear_tables::path_word::PathWord;
use gearmesh_specification::gear_tables::seat::{BoreHold, EccentricityTable};
use gearmesh_specification::pair::{
    DEFAULT_EDGE_RADIUS_UM, GearTable, MisalignmentFrom, PairModel, PairTables,
};
use gearmesh_specification::rating::RatingTable;
use std::path::{Path, PathBuf};

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
        Self::from_document(tables.document(folder)?, folder)
    }

    /// Checks a scene that is already in memory; model paths are taken relative to `folder`.
    ///
    /// # Errors
    /// As [`Scene::read`].
    pub fn from_document(document: InputDocument, folder: &Path) -> Result<Self, InputError> {
        let (table, document) = PairTables::of(document)?;
        let (pair, teeth) = (&table.pair, table.mesh.teeth);
        let friction = teeth.friction.as_ref().map(PairFrictionTable::friction);
        let edge_radius_m = match teeth.path {
            Some(PathWord::LineOfAction) => None,
            Some(PathWord::Extended) | None => {
                let radius_um = teeth.edge_radius_um;
                Some(1e-6 * radius_um.map_or(DEFAULT_EDGE_RADIUS_UM, f64::from))
            }
        };
        let gear = |(model, table): (&PathBuf, GearTable), errors, eccentricity, gauges| PairGear {
            model: folder.join(model),
            slides: table.bore == Some(BoreHold::Sliding),
            microgeometry: table.microgeometry,
            errors,
            eccentricity,
            gauges,
        };
        let (first, second) = ((&pair.gear_1, table.gear_1), (&pair.gear_2, table.gear_2));
        let gears = [
            gear(
                first,
                teeth.errors_1,
                teeth.eccentricity_1,
                table.gauges.gear_1,
            ),
            gear(
                second,
                teeth.errors_2,
                teeth.eccentricity_2,
                table.gauges.gear_2,
            ),
        ];
        let PairModel::Hybrid { local, slices } = table.mesh.model;
        let notes = document.former_notes()?;
        let notes = notes.iter().map(ToString::to_string).collect();
        Ok(Self {
            title: table.title,
            gears,
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
