//! Where parts of a system are added once its bodies are in it: joints and force elements, with their names for people.

use gearmesh_bearings::QuasiStaticElement;
use gearmesh_dynamics::elements::ForceElement;
use gearmesh_dynamics::{Joint, JointKind, SystemBuilder};
use gearmesh_geometry::InputError;
use gearmesh_geometry::input::TableKeys;

use super::bearings::cages::PlacedCage;
use super::bearings::tangent::Tangent;
use super::bodies::{Bodies, Seat};
use super::parts::Parts;
use crate::system::scene::SystemScene;

/// A bearing whose rollers press on the bore of a gear, left for the meshes of that gear.
pub(super) struct SeatedBearing {
    /// Number of the bearing.
    pub number: usize,
    /// Number of the gear's body.
    pub body: usize,
    pub element: QuasiStaticElement,
}

/// Where parts are added, and how they are to be.
pub(super) struct Connections<'a> {
    pub scene: &'a SystemScene,
    pub bodies: &'a Bodies,
    /// Whether balls that move are taken in equilibrium.
    pub at_rest: bool,
    /// Cages that stand among the bodies.
    pub cages: &'a [PlacedCage],
    /// Bearings of which a tangent is taken, where it is known already.
    pub tangents: &'a [Tangent],
    pub builder: SystemBuilder,
    pub parts: Parts,
    /// What is left for meshes.
    pub seated: Vec<SeatedBearing>,
}

impl<'a> Connections<'a> {
    /// The keys of an item of a list of the scene.
    pub(super) fn keys(&self, list: &str, number: usize) -> TableKeys<'a> {
        TableKeys::new(&self.scene.document, format!("{list}.{number}"))
    }

    /// Adds a force element on bodies.
    pub(super) fn element(
        &mut self,
        (name, kind): (&str, &'static str),
        bodies: &[Option<usize>],
        element: impl ForceElement + 'static,
    ) {
        self.builder.element(element);
        let part = self.bodies.part(name, kind, bodies);
        self.parts.elements.push(part);
    }

    /// Adds a joint in a seat.
    pub(super) fn joint(
        &mut self,
        keys: &TableKeys<'_>,
        (name, word): (&str, &'static str),
        seat: &Seat,
        kind: JointKind,
    ) -> Result<(), InputError> {
        let at = self.bodies.markers(seat);
        let joint = Joint::new(name, kind, at.a, at.b);
        self.builder.joint(joint.map_err(|e| keys.error("", e))?);
        let part = self.bodies.part(name, word, &seat.ends);
        self.parts.joints.push(part);
        Ok(())
    }
}
