//! The scene of a multibody system: its tables, as written in the file, and their checks. One file per table; those
//! that pairs have, too, are in `gear_tables/`.

pub mod bearing;
pub mod body;
pub mod connection;
pub mod function;
pub mod gear_mesh;
pub mod joint;
pub mod load;
pub mod mesh_model;
pub mod output;
pub mod planet_pin;
pub mod planetary;
pub mod python_element;
pub mod run;
pub mod shaft;
pub mod solver;

use std::path::Path;

use bearing::BearingTable;
use body::BodyTable;
use connection::{BushingTable, SpringTable, TorsionSpringTable};
use gear_mesh::GearMeshTable;
use gearmesh_geometry::InputError;
use gearmesh_geometry::input::InputDocument;
use joint::{JointTable, MotionTable};
use load::LoadTable;
use output::OutputTable;
use planetary::PlanetaryTable;
use python_element::PythonElementTable;
use run::RunTable;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use shaft::ShaftTable;
use solver::SolverTable;

use crate::rating::RatingTable;

/// The keys of the file.
#[derive(Debug, Clone, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SystemTables {
    /// Title in prints and reports.
    pub title: String,
    /// What is done.
    pub run: RunTable,
    /// Integrator and start.
    #[serde(default)]
    pub solver: SolverTable,
    /// What is written.
    #[serde(default)]
    pub output: OutputTable,
    /// Acceleration of weight, world axes; no weight where not given.
    pub gravity_m_per_s2: Option<[f64; 3]>,
    /// Bodies.
    #[serde(default)]
    pub body: Vec<BodyTable>,
    /// Joints.
    #[serde(default)]
    pub joint: Vec<JointTable>,
    /// Prescribed motions.
    #[serde(default)]
    pub motion: Vec<MotionTable>,
    /// Forces and torques.
    #[serde(default)]
    pub load: Vec<LoadTable>,
    /// Line springs.
    #[serde(default)]
    pub spring: Vec<SpringTable>,
    /// Torsion springs.
    #[serde(default)]
    pub torsion_spring: Vec<TorsionSpringTable>,
    /// Bushings.
    #[serde(default)]
    pub bushing: Vec<BushingTable>,
    /// Bearings.
    #[serde(default)]
    pub bearing: Vec<BearingTable>,
    /// Shafts.
    #[serde(default)]
    pub shaft: Vec<ShaftTable>,
    /// Force elements that a Python function computes.
    #[serde(default)]
    pub python_element: Vec<PythonElementTable>,
    /// Gear meshes.
    #[serde(default)]
    pub gear_mesh: Vec<GearMeshTable>,
    /// Planetary sets; their bodies, joints, bearings, motions, loads and meshes stand behind those of the file.
    #[serde(default)]
    pub planetary: Vec<PlanetaryTable>,
    /// Strain gauges of reduced gears.
    #[serde(default)]
    pub gauge: Vec<GaugeTable>,
    /// What is judged after the run.
    #[serde(default)]
    pub rating: Vec<RatingTable>,
}

/// `[[gauge]]`: gauges of a reduced gear that are read.
#[derive(Debug, Clone, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GaugeTable {
    /// The gear's body.
    pub body: String,
    /// Names of gauges in its model.
    pub names: Vec<String>,
}

impl SystemTables {
    /// The tables of a file in today's form: one in a former form is brought into it by
    /// [`InputDocument::with_former`] and [`crate::former_forms::SYSTEM`].
    ///
    /// # Errors
    /// [`InputError`] with file, line, key, what was found and what is allowed.
    pub fn of(document: &InputDocument) -> Result<Self, InputError> {
        document.parse()
    }

    /// The planetary sets of a file whose other tables may name what follows from them.
    ///
    /// # Errors
    /// As [`SystemTables::of`].
    pub fn planetary_sets(document: &InputDocument) -> Result<Vec<PlanetaryTable>, InputError> {
        #[derive(Deserialize)]
        struct Sets {
            #[serde(default)]
            planetary: Vec<PlanetaryTable>,
        }
        Ok(document.parse::<Sets>()?.planetary)
    }

    /// The document of tables in memory; other files are relative to `folder`.
    ///
    /// # Errors
    /// [`InputError`] for values that no file can hold.
    pub fn document(&self, folder: &Path) -> Result<InputDocument, InputError> {
        InputDocument::of_values(self, folder)
    }
}
