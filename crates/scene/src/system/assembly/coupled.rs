//! Which meshes are solved together: hybrid ones that share a gear body whose deflection all of them feel.

use gearmesh_drivetrain::{CoupledMeshes, MeshElement, MeshToCouple};
use gearmesh_dynamics::SystemBuilder;
use gearmesh_geometry::InputError;
use gearmesh_geometry::input::{InputDocument, TableKeys};

use super::bodies::Bodies;
use super::gear_mesh::PreparedMesh;
use crate::system::tables::body::{BodyTable, Coupling};
use crate::system::tables::mesh_model::MeshKind;

/// A mesh that is left for its group.
pub(super) struct MeshOfGroup {
    pub name: String,
    pub element: MeshElement,
    /// Numbers of its bodies.
    pub bodies: [usize; 2],
    pub key: String,
}

/// Bodies whose deflection all their meshes feel, and the meshes that are solved together.
pub(super) struct Groups {
    coupled: Vec<bool>,
    /// Group of each mesh.
    pub of_mesh: Vec<Option<usize>>,
    /// Numbers of the meshes of each group.
    pub meshes: Vec<Vec<usize>>,
}

/// Whether a mesh can be solved with others.
fn is_eligible(mesh: &PreparedMesh, bodies: &Bodies) -> bool {
    let mut both = mesh.bodies.iter().map(|body| &bodies.list[*body]);
    mesh.model == MeshKind::Hybrid
        && both.all(|body| body.cylindrical().is_some() && body.modes == 0)
}

impl Groups {
    /// # Errors
    /// [`InputError`] for a `coupling` that no mesh follows.
    pub(super) fn new(
        tables: &[BodyTable],
        document: &InputDocument,
        bodies: &Bodies,
        meshes: &[PreparedMesh],
    ) -> Result<Self, InputError> {
        let eligible: Vec<bool> = meshes
            .iter()
            .map(|mesh| is_eligible(mesh, bodies))
            .collect();
        let meshes_of = |body: usize| {
            let own = meshes.iter().zip(&eligible);
            own.filter(|(mesh, eligible)| **eligible && mesh.bodies.contains(&body))
                .count()
        };
        let mut coupled = vec![false; bodies.list.len()];
        for (body, place) in coupled.iter_mut().enumerate() {
            let stated = tables.get(body).and_then(|table| table.coupling);
            let own = meshes_of(body);
            if stated.is_some() && own < 2 {
                let key = format!("body.{body}");
                let problem = format!(
                    "is not used: it is of gears in two or more hybrid meshes whose gears have no vibration modes, `{}` is in {own}; remove it",
                    tables[body].name
                );
                return Err(TableKeys::new(document, &key).error("coupling", problem));
            }
            *place = own > 1 && stated.unwrap_or_default() == Coupling::AllMeshes;
        }
        let mut groups = Self {
            coupled,
            of_mesh: vec![None; meshes.len()],
            meshes: Vec::new(),
        };
        for first in 0..meshes.len() {
            if groups.of_mesh[first].is_none() && eligible[first] {
                groups.gather(first, meshes, &eligible);
            }
        }
        Ok(groups)
    }

    /// The group of a mesh: all that are linked to it by coupled bodies.
    fn gather(&mut self, first: usize, meshes: &[PreparedMesh], eligible: &[bool]) {
        let (group, mut found) = (self.meshes.len(), vec![first]);
        let mut next = 0;
        while let Some(&mesh) = found.get(next) {
            next += 1;
            for body in meshes[mesh].bodies.into_iter().filter(|b| self.coupled[*b]) {
                let beside = (0..meshes.len())
                    .filter(|other| eligible[*other] && meshes[*other].bodies.contains(&body));
                for other in beside {
                    if !found.contains(&other) {
                        found.push(other);
                    }
                }
            }
        }
        if found.len() < 2 {
            return;
        }
        found.sort_unstable();
        for mesh in &found {
            self.of_mesh[*mesh] = Some(group);
        }
        self.meshes.push(found);
    }

    /// Adds the meshes of a group to the system.
    ///
    /// # Errors
    /// [`InputError`] where the models do not fit.
    pub(super) fn add(
        &self,
        meshes: Vec<MeshOfGroup>,
        (document, bodies): (&InputDocument, &Bodies),
        builder: &mut SystemBuilder,
    ) -> Result<String, InputError> {
        let Some(key) = meshes.first().map(|mesh| mesh.key.clone()) else {
            return Ok(String::new());
        };
        let model = |body: usize| bodies.list[body].model().filter(|_| self.coupled[body]);
        let mut names = Vec::new();
        let each = meshes.into_iter().map(|mesh| {
            names.push(format!("`{}`", mesh.name));
            MeshToCouple {
                models: mesh.bodies.map(|body| model(body).map(|model| &**model)),
                element: mesh.element,
            }
        });
        let each: Vec<MeshToCouple<'_>> = each.collect();
        let name = format!("{} and meshes on its gears", names[0].trim_matches('`'));
        let (together, parts) = CoupledMeshes::new(&name, each)
            .map_err(|error| TableKeys::new(document, &key).error("", error))?;
        builder.element(together);
        for part in parts {
            builder.element(part);
        }
        Ok(format!(
            "meshes {} are solved together: they share gears, which deflect at each under the forces of the others",
            names.join(", ")
        ))
    }
}
