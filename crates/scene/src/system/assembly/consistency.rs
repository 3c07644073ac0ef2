//! Whether the tables of a scene fit each other: names, flexibilities, outputs.

use gearmesh_geometry::InputError;
use gearmesh_geometry::input::TableKeys;
use gearmesh_specification::names::unknown;
use gearmesh_specification::system::body::Flexibility;
use gearmesh_specification::system::mesh_model::MeshKind;

use super::LoadedSystem;
use super::bodies::Bodies;
use super::gear_mesh::PreparedMesh;
use super::parts::Parts;
use crate::system::built::BuiltPart;

impl LoadedSystem {
    /// Names of bodies, of joints with motions, and of force elements must differ among each other.
    pub(super) fn refuse_repeated_names(&self) -> Result<(), InputError> {
        let [bodies, joints, elements] = self.scene.named_tables();
        for (what, names) in [
            ("body or shaft", bodies),
            ("joint or motion", joints),
            ("load, spring, bearing or mesh", elements),
        ] {
            for (i, (key, name)) in names.iter().enumerate() {
                let keys = TableKeys::new(&self.scene.document, key);
                if name.is_empty() {
                    return Err(keys.error("name", "is empty"));
                }
                if names[..i].iter().any(|(_, earlier)| earlier == name) {
                    let problem =
                        format!("`{name}` is the name of another {what}; give each its own");
                    return Err(keys.error("name", problem));
                }
            }
        }
        Ok(())
    }

    /// A stated flexibility must be one that the meshes of the body can feel.
    pub(super) fn check_flexibility(
        &self,
        bodies: &Bodies,
        meshes: &[PreparedMesh],
    ) -> Result<(), InputError> {
        for (i, table) in self.scene.tables.body.iter().enumerate() {
            let Some(flexibility) = table.flexibility else {
                continue;
            };
            let keys = TableKeys::new(&self.scene.document, format!("body.{i}"));
            let mut own = meshes.iter().filter(|mesh| mesh.bodies.contains(&i));
            let hybrid = own.clone().find(|mesh| mesh.model == MeshKind::Hybrid);
            // Their K is that of the surfaces, and modes move the flanks.
            let on_modes = own.any(|mesh| match mesh.model {
                MeshKind::NodeToSurface => true,
                MeshKind::Impact => bodies.list[i].cylindrical().is_some(),
                _ => false,
            });
            let problem = match (flexibility, hybrid, &bodies.list[i].gear) {
                (Flexibility::Modal, None, Some(_)) if on_modes => continue,
                (_, _, None) => "is stated for a body that is no gear; remove it".to_string(),
                (Flexibility::Rigid, Some(mesh), _) => format!(
                    "is \"rigid\", but `{}` is a hybrid mesh, which takes the static patterns of both gears; write \"reduced\"",
                    mesh.built.name
                ),
                (Flexibility::Reduced | Flexibility::Modal, None, _) => format!(
                    "is \"{}\", which its meshes cannot feel: \"reduced\" and \"modal\" need a hybrid mesh, \"modal\" a node-to-surface one or one of cylindrical gears by impact, too; write \"rigid\"",
                    flexibility.name()
                ),
                _ => continue,
            };
            return Err(keys.error("flexibility", problem));
        }
        Ok(())
    }

    /// Names in `[output]` must exist.
    pub(super) fn check_output(&self, bodies: &Bodies, parts: &Parts) -> Result<(), InputError> {
        let keys = TableKeys::new(&self.scene.document, "output");
        let output = &self.scene.output;
        let named = |parts: &'_ [BuiltPart]| parts.iter().map(|part| part.name.clone()).collect();
        let known: [Vec<String>; 3] = [
            bodies.names().map(str::to_owned).collect(),
            named(&parts.joints),
            named(&parts.elements),
        ];
        let stated = [
            ("bodies", "body", &output.bodies),
            ("joints", "joint or motion", &output.joints),
            ("elements", "force element", &output.elements),
        ];
        for ((key, what, stated), known) in stated.into_iter().zip(known) {
            for (i, name) in stated.iter().flatten().enumerate() {
                if !known.contains(name) {
                    let problem = unknown(what, name, &known);
                    return Err(keys.error(&format!("{key}.{i}"), problem));
                }
            }
        }
        Ok(())
    }
}
