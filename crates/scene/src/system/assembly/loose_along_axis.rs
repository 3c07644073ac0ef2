//! Bodies that only cylindrical rollers support: nothing holds them along their axis.
//!
//! The teeth of a planet do not either: along the pin the forces of its meshes balance wherever it stands. A shaft's
//! teeth do only where two of its meshes are helical, for they may lean against each other; one alone drives the shaft
//! out of its bearings, spur teeth leave it where it is. What is loose drifts as soon as a bearing tilts or a load has
//! a part along the axis, and no equilibrium is found.

use std::collections::HashMap;

use gearmesh_bearings::definition::BearingGeometry;
use gearmesh_geometry::InputError;
use gearmesh_geometry::input::TableKeys;
use gearmesh_specification::system::mesh_model::MeshKind;

use super::LoadedSystem;
use super::bearings::placed_bearing;
use super::bodies::Bodies;
use super::gear_mesh::PreparedMesh;
use super::linked::firsts;
use super::parts::Parts;
use crate::system::built::BuiltPart;

/// What holds a piece along its axis.
#[derive(Debug, Clone, Copy, Default)]
struct Support {
    /// A bearing with cylindrical rollers, by its place among the `[[bearing]]`s.
    cylindrical: Option<usize>,
    /// Something that carries along the axis, too.
    carries: bool,
    /// Meshes whose teeth push along the axis.
    pushing_meshes: usize,
}

impl LoadedSystem {
    /// Refuses bodies that only cylindrical rollers support, where an equilibrium is sought.
    pub(super) fn refuse_loose_along_axis(
        &self,
        bodies: &Bodies,
        meshes: &[PreparedMesh],
        parts: &Parts,
    ) -> Result<(), InputError> {
        let pieces = Pieces::new(bodies, parts);
        let mut supports = vec![Support::default(); bodies.list.len()];
        for mesh in meshes.iter().filter(|mesh| pushes(mesh)) {
            for piece in distinct(mesh.bodies.map(|body| pieces.of_body[body])) {
                supports[piece].pushing_meshes += 1;
            }
        }
        let bearings = self.scene.tables.bearing.iter().enumerate();
        let numbers: HashMap<&str, usize> = bearings
            .map(|(number, table)| (table.name.as_str(), number))
            .collect();
        for part in parts.joints.iter().chain(&parts.elements) {
            let left = pieces.left_by(part);
            // No bearing's file is read for what is held already.
            if left.iter().all(|&piece| supports[piece].carries) {
                continue;
            }
            let bearing = numbers.get(part.name.as_str());
            let cylindrical = match bearing {
                Some(&number) if self.is_cylindrical(number)? => Some(number),
                _ => None,
            };
            for piece in left {
                let support = &mut supports[piece];
                support.carries |= cylindrical.is_none() && part.kind != "torsion spring";
                support.cylindrical = support.cylindrical.or(cylindrical);
            }
        }
        for (placed, &piece) in bodies.list.iter().zip(&pieces.of_body) {
            let support = supports[piece];
            let (Some(number), false) = (support.cylindrical, support.carries) else {
                continue;
            };
            let name = &placed.body.name;
            let mut planets = self.scene.sets.iter().flat_map(|set| &set.planets);
            let advice = if planets.any(|planet| planet == name) {
                "write support = \"floating\" for the planets, which does, or give them a bearing that carries along the axis, too"
            } else if support.pushing_meshes < 2 {
                "give it a bearing that carries along the axis, too (balls, tapered rollers), or hold it by a spring or a joint"
            } else {
                continue;
            };
            let problem = format!(
                "cylindrical rollers hold nothing along their axis, and nothing else holds `{name}` there; {advice}"
            );
            let key = format!("bearing.{number}.model");
            return Err(self.scene.document.error(&key, problem));
        }
        Ok(())
    }

    /// Whether a `[[bearing]]` has cylindrical rollers.
    fn is_cylindrical(&self, number: usize) -> Result<bool, InputError> {
        let Some(file) = self.scene.tables.bearing[number].model.file() else {
            return Ok(false);
        };
        let keys = TableKeys::new(&self.scene.document, format!("bearing.{number}"));
        let found = placed_bearing::read(("model.file", file), &self.scene.folder, &keys)?;
        Ok(match &found.definition.geometry {
            BearingGeometry::Roller(rollers) => rollers.taper.is_none() && rollers.barrel.is_none(),
            BearingGeometry::Ball(_) => false,
        })
    }
}

/// Whether the teeth of a mesh push along the axis.
fn pushes(mesh: &PreparedMesh) -> bool {
    let helical = mesh
        .built
        .stage
        .is_none_or(|stage| stage.overlap_ratio > 0.0);
    mesh.model != MeshKind::Kinematic && helical
}

/// Each of two once.
fn distinct([first, second]: [usize; 2]) -> impl Iterator<Item = usize> {
    let other = (second != first).then_some(second);
    std::iter::once(first).chain(other)
}

/// Bodies that beams and fixed joints hold together.
struct Pieces<'b> {
    /// Numbers of the bodies by name.
    numbers: HashMap<&'b str, usize>,
    /// The piece of each body: the number of its first body.
    of_body: Vec<usize>,
}

impl<'b> Pieces<'b> {
    fn new(bodies: &'b Bodies, parts: &Parts) -> Self {
        let names = bodies.names().enumerate();
        let numbers: HashMap<&str, usize> = names.map(|(number, name)| (name, number)).collect();
        let ties = parts.joints.iter().chain(&parts.elements);
        let ties = ties.filter(|part| ["beam", "fixed"].contains(&part.kind));
        let links = ties.filter_map(|part| match &part.bodies[..] {
            [a, b] => Some([*numbers.get(a.as_str())?, *numbers.get(b.as_str())?]),
            _ => None,
        });
        let of_body = firsts(bodies.list.len(), links);
        Self { numbers, of_body }
    }

    /// The pieces that a part holds to something else, the ground included.
    fn left_by(&self, part: &BuiltPart) -> Vec<usize> {
        let piece = |name: &String| {
            self.numbers
                .get(name.as_str())
                .map(|body| self.of_body[*body])
        };
        let pieces: Vec<Option<usize>> = part.bodies.iter().map(piece).collect();
        if pieces.windows(2).all(|two| two[0] == two[1]) {
            return Vec::new();
        }
        pieces.into_iter().flatten().collect()
    }
}
