//! Names and kinds of what has been built, in the order of the system.

use super::bearings::tangent::TangentSeat;
use crate::system::built::{BuiltPart, BuiltTogether, Effect};

/// Joints, force elements, notes and effects.
#[derive(Default)]
pub(super) struct Parts {
    pub joints: Vec<BuiltPart>,
    pub elements: Vec<BuiltPart>,
    pub notes: Vec<String>,
    pub effects: Vec<Effect>,
    /// Meshes that are solved together.
    pub together: Vec<BuiltTogether>,
    /// Bearings whose tangent is taken.
    pub tangents: Vec<TangentSeat>,
}

impl Parts {
    /// An effect, computed in some way or not at all.
    pub(super) fn effect(&mut self, name: impl Into<String>, computed: Option<String>) {
        self.effects.push(Effect {
            name: name.into(),
            computed,
        });
    }
}
