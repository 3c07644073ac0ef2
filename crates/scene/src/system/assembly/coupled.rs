//! Which meshes are solved together: hybrid ones that share a gear body whose deflection all of them feel, and those of
//! gears on rollers that press on the bore, with their bearings.

use gearmesh_drivetrain::{CoupledMeshes, GearOnRollers, MeshElement, MeshToCouple};
use gearmesh_dynamics::elements::ForceElement;
use gearmesh_geometry::InputError;
use gearmesh_geometry::input::{InputDocument, TableKeys};
use gearmesh_specification::system::body::{BodyTable, Coupling};
use gearmesh_specification::system::mesh_model::MeshKind;

use super::bodies::Bodies;
use super::connections::{Connections, SeatedBearing};
use super::gear_mesh::PreparedMesh;
use super::linked::firsts;
use crate::system::built::BuiltTogether;

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
    /// Bearings that are still to be added.
    seated: Vec<SeatedBearing>,
}

/// Whether a mesh can be solved with others.
pub(super) fn is_eligible(mesh: &PreparedMesh, bodies: &Bodies) -> bool {
    let mut both = mesh.bodies.iter().map(|body| &bodies.list[*body]);
    mesh.model == MeshKind::Hybrid
        && both.all(|body| body.cylindrical().is_some() && body.modes == 0)
}

impl Groups {
    /// # Errors
    /// [`InputError`] for a `coupling` that no mesh follows, and for a bore on rollers whose bearing is missing or that
    /// no mesh follows.
    pub(super) fn new(
        tables: &[BodyTable],
        document: &InputDocument,
        bodies: &Bodies,
        (meshes, seated): (&[PreparedMesh], Vec<SeatedBearing>),
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
                let problem = format!(
                    "is not used: it is of gears in two or more hybrid meshes whose gears have no vibration modes, `{}` is in {own}; remove it",
                    tables[body].name
                );
                return Err(document.error(&format!("body.{body}.coupling"), problem));
            }
            *place = own > 1 && stated.unwrap_or_default() == Coupling::AllMeshes;
            if bodies.list[body].bore_motions().is_some() {
                let on_it = seated.iter().filter(|bearing| bearing.body == body).count();
                let keys = TableKeys::new(document, format!("body.{body}"));
                refuse_bore(&keys, stated, [on_it, own])?;
                *place = true;
            }
        }
        let mut groups = Self {
            coupled,
            of_mesh: vec![None; meshes.len()],
            meshes: Vec::new(),
            seated,
        };
        groups.gather(meshes, &eligible);
        Ok(groups)
    }

    /// Finds the groups: meshes that are linked by coupled bodies.
    fn gather(&mut self, meshes: &[PreparedMesh], eligible: &[bool]) {
        let all = || (0..meshes.len()).filter(|mesh| eligible[*mesh]);
        let on = |body: usize| all().filter(move |mesh| meshes[*mesh].bodies.contains(&body));
        let coupled = (0..self.coupled.len()).filter(|body| self.coupled[*body]);
        let links = coupled.flat_map(|body| on(body).zip(on(body).skip(1)));
        let first = firsts(meshes.len(), links.map(|(one, next)| [one, next]));
        let is_on_rollers = |mesh: &usize| {
            let mut both = meshes[*mesh].bodies.iter();
            both.any(|body| self.seated.iter().any(|bearing| bearing.body == *body))
        };
        for lead in all() {
            let found: Vec<usize> = all().filter(|mesh| first[*mesh] == lead).collect();
            if found.len() < 2 && !found.iter().any(is_on_rollers) {
                continue;
            }
            for mesh in &found {
                self.of_mesh[*mesh] = Some(self.meshes.len());
            }
            self.meshes.push(found);
        }
    }

    /// Adds the meshes of a group to the system, and the bearings in their gears' bores.
    ///
    /// # Errors
    /// [`InputError`] where the models do not fit.
    pub(super) fn add(
        &mut self,
        meshes: Vec<MeshOfGroup>,
        connections: &mut Connections<'_>,
    ) -> Result<(), InputError> {
        let bodies = connections.bodies;
        let Some(key) = meshes.first().map(|mesh| mesh.key.clone()) else {
            return Ok(());
        };
        let of_group: Vec<String> = meshes.iter().map(|mesh| mesh.name.clone()).collect();
        let quoted = |name: &String| format!("`{name}`");
        let names: Vec<String> = of_group.iter().map(quoted).collect();
        let is_on = |bearing: &SeatedBearing| {
            let mut all = meshes.iter().flat_map(|mesh| mesh.bodies);
            all.any(|body| body == bearing.body)
        };
        let (own, others) = std::mem::take(&mut self.seated)
            .into_iter()
            .partition(is_on);
        self.seated = others;
        let model = |body: usize| bodies.list[body].model().filter(|_| self.coupled[body]);
        let each = meshes.into_iter().map(|mesh| MeshToCouple {
            models: mesh.bodies.map(|body| model(body).map(|model| &**model)),
            element: mesh.element,
        });
        let each: Vec<MeshToCouple<'_>> = each.collect();
        let (mut gears, mut rollers, mut key) = (Vec::new(), Vec::new(), key);
        for bearing in own {
            let gear = &bodies.list[bearing.body];
            if let (Some(model), Some(motions)) = (gear.model(), gear.bore_motions()) {
                rollers.push(format!("`{}`", bearing.element.name()));
                key = format!("bearing.{}", bearing.number);
                gears.push(GearOnRollers {
                    bearing: bearing.element,
                    gear: model,
                    motions,
                });
            }
        }
        let name = format!("{} and meshes on its gears", of_group[0]);
        let (together, meshes, bearings) = CoupledMeshes::new(&name, each, gears)
            .map_err(|error| connections.scene.document.error(&key, error))?;
        connections.parts.together.push(BuiltTogether {
            element: name,
            meshes: of_group,
            found: together.found(),
        });
        connections.builder.element(together);
        for part in meshes.into_iter().chain(bearings) {
            connections.builder.element(part);
        }
        let names = names.join(", ");
        let shared = match rollers.is_empty() {
            true => "they share gears, which deflect at each under the forces of the others".into(),
            false => format!(
                "with the rollers of {}, which press on bores that bend",
                rollers.join(", ")
            ),
        };
        let note = format!("meshes {names} are solved together: {shared}");
        connections.parts.notes.push(note);
        Ok(())
    }
}

/// Refuses a bore on rollers without its one bearing, without a mesh that feels it, or with a `coupling`.
fn refuse_bore(
    keys: &TableKeys<'_>,
    coupling: Option<Coupling>,
    [bearings, meshes]: [usize; 2],
) -> Result<(), InputError> {
    if bearings != 1 {
        let problem = format!(
            "is \"rollers\", which takes one bearing of kind \"quasi-static\" without `housing` whose body_1, the outer ring, is this body; found {bearings}"
        );
        return Err(keys.error("bore", problem));
    }
    if meshes == 0 {
        let problem = "is \"rollers\", which hybrid meshes follow whose gears have no vibration modes; the body is in none";
        return Err(keys.error("bore", problem));
    }
    if coupling == Some(Coupling::OwnMesh) {
        let problem = "is not used with bore = \"rollers\", which all meshes of the body feel; remove one of the two";
        return Err(keys.error("coupling", problem));
    }
    Ok(())
}
