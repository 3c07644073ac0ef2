//! `path`: where the path of contact ends.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Ends of the path of contact.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum PathWord {
    /// Contact on the rigid path only.
    LineOfAction,
    /// Tip edges go on touching.
    #[default]
    Extended,
}
