//! Bodies that only cylindrical rollers support: nothing holds them along their axis.
//!
//! The teeth of a planet do not either: along the pin the forces of its meshes balance wherever it stands. A shaft's
//! teeth do only where two of its meshes are helical, for they may lean against each other; one alone drives the shaft
//! out of its bearings, spur teeth leave it where it is. What is loose drifts as soon as a bearing tilts or a load has
//! a part along the axis, and no equilibrium is found.

use gearmesh_bearings::definition::BearingGeometry;
use gearmesh_geometry::InputError;
use gearmesh_geometry::input::TableKeys;

use super::LoadedSystem;
use super::bearings::rolling_bearing;
use super::bodies::Bodies;
use super::gear_mesh::PreparedMesh;
use super::parts::Parts;
use crate::system::built::BuiltPart;
use crate::system::tables::mesh_model::MeshKind;

impl LoadedSystem {
    /// Refuses bodies that only cylindrical rollers support, where an equilibrium is sought.
    pub(super) fn refuse_loose_along_axis(
        &self,
        bodies: &Bodies,
        meshes: &[PreparedMesh],
        parts: &Parts,
    ) -> Result<(), InputError> {
        let is_planet = |name: &str| {
            let planets = self.scene.sets.iter().flat_map(|set| &set.planets);
            planets.into_iter().any(|planet| planet == name)
        };
        let pushes = |mesh: &&PreparedMesh| {
            mesh.model != MeshKind::Kinematic
                && mesh.stage.is_none_or(|stage| stage.overlap_ratio > 0.0)
        };
        for whole in in_one_piece(bodies, parts) {
            let name = whole[0];
            let is_on_it = |mesh: &&PreparedMesh| {
                let mut gears = mesh.bodies.iter().map(|&body| bodies.name(Some(body)));
                gears.any(|gear| whole.contains(&gear))
            };
            let advice = if is_planet(name) {
                "write support = \"floating\" for the planets, which does, or give them a bearing that carries along the axis, too"
            } else if meshes.iter().filter(pushes).filter(is_on_it).count() < 2 {
                "give it a bearing that carries along the axis, too (balls, tapered rollers), or hold it by a spring or a joint"
            } else {
                continue;
            };
            let leaves = |part: &&BuiltPart| {
                let on_it = |body: &String| whole.contains(&body.as_str());
                part.kind != "torsion spring"
                    && part.bodies.iter().any(on_it)
                    && !part.bodies.iter().all(on_it)
            };
            let holding = parts.joints.iter().chain(&parts.elements).filter(leaves);
            if let Some(number) = self.only_cylindrical(holding)? {
                let problem = format!(
                    "cylindrical rollers hold nothing along their axis, and nothing else holds `{name}` there; {advice}"
                );
                let key = format!("bearing.{number}");
                return Err(TableKeys::new(&self.scene.document, &key).error("model", problem));
            }
        }
        Ok(())
    }

    /// One of these parts, by its place among the `[[bearing]]`s, where all of them have cylindrical rollers.
    fn only_cylindrical<'p>(
        &self,
        parts: impl Iterator<Item = &'p BuiltPart>,
    ) -> Result<Option<usize>, InputError> {
        let mut found = None;
        for part in parts {
            let mut bearings = self.scene.tables.bearing.iter();
            found = bearings.position(|table| table.name == part.name);
            match found {
                Some(number) if self.is_cylindrical(number)? => {}
                _ => return Ok(None),
            }
        }
        Ok(found)
    }

    /// Whether a `[[bearing]]` has cylindrical rollers.
    fn is_cylindrical(&self, number: usize) -> Result<bool, InputError> {
        let Some(file) = self.scene.tables.bearing[number].model.file() else {
            return Ok(false);
        };
        let key = format!("bearing.{number}");
        let keys = TableKeys::new(&self.scene.document, &key);
        let found = rolling_bearing::definition("model.file", file, &self.scene.folder, &keys)?;
        let rollers = match &found.geometry {
            BearingGeometry::Roller(rollers) => rollers,
            BearingGeometry::Ball(_) => return Ok(false),
        };
        Ok(rollers.taper.is_none() && rollers.barrel.is_none())
    }
}

/// Names of the bodies that beams and fixed joints hold together, each set in the order of the scene.
fn in_one_piece<'b>(bodies: &'b Bodies, parts: &Parts) -> Vec<Vec<&'b str>> {
    let mut wholes: Vec<Vec<&str>> = (bodies.list.iter())
        .map(|placed| vec![placed.body.name.as_str()])
        .collect();
    let ties = parts.joints.iter().chain(&parts.elements);
    for part in ties.filter(|part| ["beam", "fixed"].contains(&part.kind)) {
        let place = |body: &String| {
            wholes
                .iter()
                .position(|whole| whole.contains(&body.as_str()))
        };
        let [Some(a), Some(b)] = [0, 1].map(|end| place(&part.bodies[end])) else {
            continue;
        };
        if a != b {
            let moved = wholes.remove(a.max(b));
            wholes[a.min(b)].extend(moved);
        }
    }
    wholes
}
