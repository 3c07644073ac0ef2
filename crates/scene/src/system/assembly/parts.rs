//! Names and kinds of what has been built, in the order of the system.

use super::bearings::tangent::TangentSeat;
use super::bodies::Bodies;
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
    /// A joint between bodies.
    pub(super) fn joint(
        &mut self,
        name: &str,
        kind: &'static str,
        bodies: &Bodies,
        ends: [Option<usize>; 2],
    ) {
        self.joints.push(part(name, kind, bodies, &ends));
    }

    /// A force element between bodies.
    pub(super) fn element(
        &mut self,
        name: &str,
        kind: &'static str,
        bodies: &Bodies,
        ends: [Option<usize>; 2],
    ) {
        self.elements.push(part(name, kind, bodies, &ends));
    }

    /// A force element on one body.
    pub(super) fn element_on(
        &mut self,
        name: &str,
        kind: &'static str,
        bodies: &Bodies,
        body: usize,
    ) {
        self.elements.push(part(name, kind, bodies, &[Some(body)]));
    }

    /// An effect, computed in some way or not at all.
    pub(super) fn effect(&mut self, name: impl Into<String>, computed: Option<String>) {
        self.effects.push(Effect {
            name: name.into(),
            computed,
        });
    }
}

fn part(name: &str, kind: &'static str, bodies: &Bodies, ends: &[Option<usize>]) -> BuiltPart {
    BuiltPart {
        name: name.to_owned(),
        kind,
        bodies: ends
            .iter()
            .map(|end| bodies.name(*end).to_owned())
            .collect(),
    }
}
