//! The scene file of a multibody system, read and checked as far as no other file is needed.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use gearmesh_geometry::InputError;
use gearmesh_geometry::input::{InputDocument, TableKeys};
use gearmesh_specification::former_forms::SYSTEM;
use gearmesh_specification::host_functions::HostFunctions;
use gearmesh_specification::names::{check_names, unknown};
use gearmesh_specification::system::SystemTables;
use gearmesh_specification::system::joint::MotionTable;
use gearmesh_specification::system::output::OutputTable;
use gearmesh_specification::system::run::Run;
use gearmesh_specification::system::solver::Solver;

use super::planetary::{self, PlanetarySet};
use crate::model_shelf::ModelShelf;

/// A scene of a multibody system. Other files are relative to `folder`.
#[derive(Debug, Clone)]
pub struct SystemScene {
    /// Title in prints and reports.
    pub title: String,
    /// What is done.
    pub run: Run,
    /// Integrator and start.
    pub solver: Solver,
    /// What is written.
    pub output: OutputTable,
    /// Its planetary sets.
    pub sets: Vec<PlanetarySet>,
    /// The tables of the file, and what follows from its planetary sets.
    pub tables: SystemTables,
    /// What to tell about the file beside its sense: tables in a former form.
    pub notes: Vec<String>,
    /// Functions of the calling program that it may name; none of a scene that was read.
    pub host: HostFunctions,
    /// The file, for later complaints and provenance.
    pub document: InputDocument,
    /// The file's folder.
    pub folder: PathBuf,
    /// The reduced gears that it names, as far as they were read.
    pub models: Arc<ModelShelf>,
}

impl SystemScene {
    /// Reads and checks a scene file.
    ///
    /// # Errors
    /// [`InputError`] with file, line, key, what was found and what is allowed.
    pub fn read(path: &Path) -> Result<Self, InputError> {
        let folder = path.parent().unwrap_or(Path::new(""));
        Self::from_document(InputDocument::read(path)?, folder)
    }

    /// Checks a scene that is already in memory.
    ///
    /// # Errors
    /// As [`SystemScene::read`].
    pub fn from_document(document: InputDocument, folder: &Path) -> Result<Self, InputError> {
        Self::with_models(document, folder, Arc::default())
    }

    /// The scene of tables in memory; `models`: reduced gears in memory, and those of files that were read before.
    ///
    /// # Errors
    /// [`InputError`] with the path of the field, what was found and what is allowed.
    pub fn new(
        tables: &SystemTables,
        folder: &Path,
        models: Arc<ModelShelf>,
    ) -> Result<Self, InputError> {
        let document = tables.document(folder)?;
        Self::with_models(document, folder, models)
    }

    fn with_models(
        document: InputDocument,
        folder: &Path,
        models: Arc<ModelShelf>,
    ) -> Result<Self, InputError> {
        let document = document.with_former(SYSTEM);
        let expanded = planetary::expand(document.clone(), (folder, &models));
        let checked = expanded.and_then(|(document, sets)| {
            let scene = Self::checked(document, sets, folder)?;
            Ok(Self { models, ..scene })
        });
        checked.map_err(|error| super::other_run_kind::explained(error, &document))
    }

    fn checked(
        document: InputDocument,
        sets: Vec<PlanetarySet>,
        folder: &Path,
    ) -> Result<Self, InputError> {
        let tables = SystemTables::of(&document)?;
        check_names(&document)?;
        if tables.body.is_empty() && tables.shaft.is_empty() {
            return Err(document.error("body", "is empty; a scene has at least one body or shaft"));
        }
        for (i, body) in tables.body.iter().enumerate() {
            if let Some(own) = &body.microgeometry {
                own.check_together((&document, &format!("body.{i}.microgeometry")))?;
            }
        }
        let run = tables.run.check(&document)?;
        let solver = tables.solver.check(&document, &run)?;
        if solver
            .params
            .is_some_and(|params| params.rho_infinity == 1.0)
            && !tables.joint.is_empty()
        {
            // An error of a joint's force dies out with ρ∞ (docs/theory/multibody.md).
            let problem = "found 1, with joints; allowed is less than 1, for nothing damps errors of joint forces then, which grow from step to step; take 0.99, which loses hardly any energy";
            return Err(TableKeys::new(&document, "solver").error("rho_infinity", problem));
        }
        tables.output.check(&document, &run)?;
        if let Some(name) = run.varied_motion() {
            let keys = TableKeys::new(&document, "run");
            let named = tables.motion.iter().find(|table| table.name() == name);
            let motion = named.ok_or_else(|| {
                let names: Vec<String> = tables.motion.iter().map(MotionTable::name).collect();
                keys.error("motion", unknown("motion", name, &names))
            })?;
            if motion.angle_deg.is_none() && motion.speed_rpm.is_none() {
                let problem = format!(
                    "`{name}` drives a place along an axis; allowed is a motion with angle_deg or speed_rpm"
                );
                return Err(keys.error("motion", problem));
            }
        }
        let notes = document.former_notes()?;
        Ok(Self {
            title: tables.title.clone(),
            notes: notes.iter().map(ToString::to_string).collect(),
            run,
            solver,
            output: tables.output.clone(),
            sets,
            tables,
            host: HostFunctions::default(),
            document,
            folder: folder.to_path_buf(),
            models: Arc::default(),
        })
    }
}
