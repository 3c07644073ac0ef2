//! Natural modes of a result, opened.

use std::path::Path;

use gearmesh_operations::MovingModes;
use gearmesh_scene::system_run::SystemResult;
use serde::Deserialize;
use serde_json::Value;

use crate::problem::Problem;

/// Which mode.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ModeAsked {
    /// Operating point, from 0.
    point: usize,
    /// Mode, from 0.
    mode: usize,
}

/// A result of natural frequencies, opened.
#[derive(Debug)]
pub struct ModesSession {
    modes: MovingModes,
}

impl ModesSession {
    /// Reads the machine of the result.
    ///
    /// # Errors
    /// [`Problem`] for files that are not as they were in the run, and for a result without modes.
    pub fn new(file: &Path, result: SystemResult) -> Result<Self, Problem> {
        Ok(Self {
            modes: MovingModes::new(file, result)?,
        })
    }

    /// The machine, and its modes in words.
    pub fn description(&self) -> Value {
        self.modes.description()
    }

    /// A period of a mode.
    ///
    /// # Errors
    /// [`Problem::Input`] for a mode that is not there.
    pub fn frames(&self, asked: &ModeAsked) -> Result<Value, Problem> {
        Ok(self.modes.frames(asked.point, asked.mode)?)
    }
}
