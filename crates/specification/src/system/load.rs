//! `[[load]]`: a force or a torque on a body as a function of time.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::function::FunctionTable;

/// `[[load]]` as written in the file: either `torque_Nm` or `force_N`.
#[derive(Debug, Clone, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[allow(non_snake_case)]
pub struct LoadTable {
    /// Name; "torque on BODY" or "force on BODY" where not given.
    pub name: Option<String>,
    /// The body.
    pub body: String,
    /// Torque.
    pub torque_Nm: Option<FunctionTable>,
    /// Force.
    pub force_N: Option<FunctionTable>,
    /// Direction; a torque without it acts about the body's z axis.
    pub along: Option<[f64; 3]>,
    /// Axes of `along`; "world" where not given.
    pub axes: Option<AxesWord>,
    /// Point of the force from the body's origin, body axes; [0, 0, 0] where not given.
    pub at_mm: Option<[f64; 3]>,
}

/// Axes in which a direction stands still.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum AxesWord {
    /// The world's.
    #[default]
    World,
    /// The body's.
    Body,
}

impl LoadTable {
    /// Its name, given or made.
    #[must_use]
    pub fn name(&self) -> String {
        let kind = if self.torque_Nm.is_some() {
            "torque"
        } else {
            "force"
        };
        self.name
            .clone()
            .unwrap_or_else(|| format!("{kind} on {}", self.body))
    }
}
