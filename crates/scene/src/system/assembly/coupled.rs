//! Which meshes are solved together: hybrid ones that share a gear body whose deflection all of them feel, and those of
//! gears on rollers that press on the bore, with their bearings.

use gearmesh_drivetrain::{CoupledMeshes, GearOnRollers, MeshElement, MeshToCouple};
use gearmesh_dynamics::SystemBuilder;
use gearmesh_dynamics::elements::ForceElement;
use gearmesh_geometry::InputError;
use gearmesh_geometry::input::{InputDocument, TableKeys};

use super::bodies::Bodies;
use super::elements::SeatedBearing;
use super::gear_mesh::PreparedMesh;
use super::parts::Parts;
use crate::system::built::BuiltTogether;
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
                let key = format!("body.{body}");
                let problem = format!(
                    "is not used: it is of gears in two or more hybrid meshes whose gears have no vibration modes, `{}` is in {own}; remove it",
                    tables[body].name
                );
                return Err(TableKeys::new(document, &key).error("coupling", problem));
            }
            *place = own > 1 && stated.unwrap_or_default() == Coupling::AllMeshes;
            if bodies.list[body].bore_motions().is_some() {
                let on_it = seated.iter().filter(|bearing| bearing.body == body).count();
                let key = format!("body.{body}");
                refuse_bore(&TableKeys::new(document, &key), stated, [on_it, own])?;
                *place = true;
            }
        }
        let mut groups = Self {
            coupled,
            of_mesh: vec![None; meshes.len()],
            meshes: Vec::new(),
            seated,
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
        let on_rollers = |mesh: &usize| {
            let mut both = meshes[*mesh].bodies.iter();
            both.any(|body| self.seated.iter().any(|bearing| bearing.body == *body))
        };
        if found.len() < 2 && !found.iter().any(on_rollers) {
            return;
        }
        found.sort_unstable();
        for mesh in &found {
            self.of_mesh[*mesh] = Some(group);
        }
        self.meshes.push(found);
    }

    /// Adds the meshes of a group to the system, and the bearings in their gears' bores.
    ///
    /// # Errors
    /// [`InputError`] where the models do not fit.
    pub(super) fn add(
        &mut self,
        meshes: Vec<MeshOfGroup>,
        (document, bodies): (&InputDocument, &Bodies),
        (builder, parts): (&mut SystemBuilder, &mut Parts),
    ) -> Result<(), InputError> {
        let Some(key) = meshes.first().map(|mesh| mesh.key.clone()) else {
            return Ok(());
        };
        let of_group = meshes.iter().map(|mesh| mesh.name.clone()).collect();
        let is_on = |bearing: &SeatedBearing| {
            let mut all = meshes.iter().flat_map(|mesh| mesh.bodies);
            all.any(|body| body == bearing.body)
        };
        let (own, others) = std::mem::take(&mut self.seated)
            .into_iter()
            .partition(is_on);
        self.seated = others;
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
        let name = format!("{} and meshes on its gears", names[0].trim_matches('`'));
        let (together, meshes, bearings) = CoupledMeshes::new(&name, each, gears)
            .map_err(|error| TableKeys::new(document, &key).error("", error))?;
        parts.together.push(BuiltTogether {
            element: name,
            meshes: of_group,
            found: together.found(),
        });
        builder.element(together);
        for part in meshes.into_iter().chain(bearings) {
            builder.element(part);
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
        parts.notes.push(note);
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
