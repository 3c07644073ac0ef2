//! Bodies, shafts and gear meshes of a scene, and the meshes in its system.

use gearmesh_contact::CondensedFlanks;
use gearmesh_geometry::InputError;
use gearmesh_geometry::input::TableKeys;

use super::LoadedSystem;
use super::bodies::{Bodies, PlacedBody};
use super::connections::Connections;
use super::coupled::{Groups, MeshOfGroup};
use super::gear_mesh::PreparedMesh;
use super::parts::Parts;
use super::shafts::PlacedShaft;
use crate::system::built::BuiltGauge;

impl LoadedSystem {
    /// Adds meshes that are in no group, then those of the groups.
    pub(super) fn add_meshes(
        &self,
        meshes: Vec<PreparedMesh>,
        gauges: &[BuiltGauge],
        connections: &mut Connections<'_>,
    ) -> Result<(), InputError> {
        let (bodies, seated) = (connections.bodies, std::mem::take(&mut connections.seated));
        let (tables, document) = (&self.scene.tables.body, &self.scene.document);
        let mut groups = Groups::new(tables, document, bodies, (&meshes, seated))?;
        let mut left: Vec<Vec<MeshOfGroup>> = groups.meshes.iter().map(|_| Vec::new()).collect();
        for (mesh, group) in meshes.into_iter().zip(&groups.of_mesh) {
            mesh.add(gauges, group.map(|group| &mut left[group]), connections)?;
        }
        for meshes in left {
            groups.add(meshes, connections)?;
        }
        Ok(())
    }

    /// Bodies, those of shafts among them, and the shafts.
    pub(super) fn bodies_and_shafts(&self) -> Result<(Bodies, Vec<PlacedShaft>), InputError> {
        let (document, tables) = (&self.scene.document, &self.scene.tables);
        let (mut bodies, mut shafts) = (Bodies::default(), Vec::new());
        for (i, (table, gear)) in tables.body.iter().zip(&self.gears).enumerate() {
            let keys = TableKeys::new(document, format!("body.{i}"));
            let placed = PlacedBody::new(table, &keys, gear.clone())?;
            bodies.list.push(placed);
        }
        for (i, table) in tables.shaft.iter().enumerate() {
            let at = (document, format!("shaft.{i}"));
            shafts.push(PlacedShaft::new(table, at, &mut bodies)?);
        }
        Ok((bodies, shafts))
    }

    /// The meshes, two of them between no two bodies.
    pub(super) fn prepared_meshes(
        &self,
        bodies: &Bodies,
        parts: &mut Parts,
    ) -> Result<Vec<PreparedMesh>, InputError> {
        let document = &self.scene.document;
        let files = (document, self.scene.folder.as_path());
        let condensed = CondensedFlanks::default();
        let mut meshes: Vec<PreparedMesh> = Vec::new();
        for (i, table) in self.scene.tables.gear_mesh.iter().enumerate() {
            let (key, with) = (format!("gear_mesh.{i}"), (bodies, &condensed));
            let mesh = PreparedMesh::new(table, files, key, with, parts)?;
            let is_same =
                |other: &&PreparedMesh| other.bodies.iter().all(|body| mesh.bodies.contains(body));
            if let Some(earlier) = meshes.iter().find(is_same) {
                let problem = format!(
                    "`{}` and `{}` are in mesh already in `{}`; remove one of the two",
                    table.gear_1, table.gear_2, earlier.built.name
                );
                return Err(document.error(&format!("{}.gear_2", mesh.key), problem));
            }
            meshes.push(mesh);
        }
        Ok(meshes)
    }
}
