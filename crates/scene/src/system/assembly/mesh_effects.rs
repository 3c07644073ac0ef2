//! What of a gear mesh is computed, and what is not, in words for the plan.

use super::mesh_model::SceneMesh;
use super::parts::Parts;
use crate::system::tables::UM;
use crate::system::tables::gear_mesh::TouchingFlanks;
use crate::system::tables::mesh_model::{MeshKind, MeshModel};

impl SceneMesh<'_, '_> {
    /// Lists the effects of this mesh.
    pub(super) fn effects(&self, parts: &mut Parts) {
        let (table, teeth) = (self.table, &self.teeth);
        let kind = table.model.kind();
        let name = |what: &str| format!("mesh `{}`: {what}", table.name);
        if kind == MeshKind::Kinematic {
            return;
        }
        let flanks = match teeth.flanks {
            TouchingFlanks::Both => Some(format!(
                "both sides, {:.1} um of backlash",
                self.pair.backlash_m() / UM
            )),
            TouchingFlanks::Right | TouchingFlanks::Left => None,
        };
        parts.effect(name("backlash"), flanks);
        let damping = match (&table.model, table.model.damping()) {
            (_, Some(damping)) => Some(damping.words().to_string()),
            (MeshModel::Impact(impact), None) if impact.damping_N_s_per_mm.is_some() => {
                Some("STEP of the depth".to_string())
            }
            (MeshModel::NodeToSurface(nodes), None) if nodes.damping_N_s_per_mm.is_some() => {
                Some("STEP of the depth".to_string())
            }
            (_, None) => None,
        };
        parts.effect(name("damping"), damping);
        parts.effect(
            name("friction"),
            teeth
                .friction
                .as_ref()
                .map(|_| "`coulomb`, regularised".to_string()),
        );
        parts.effect(name("microgeometry"), self.acting_microgeometry());
        let errors = teeth.errors_1.iter().chain(&teeth.errors_2);
        let kinds: Vec<&str> = errors.map(|error| error.kind()).collect();
        let cracks = match &table.model {
            MeshModel::Analytic(model) => model.cracks_1.len() + model.cracks_2.len(),
            _ => 0,
        };
        let of_models = (self.gears.iter().zip([1, 2])).filter_map(|(gear, number)| {
            let crack = gear.model.as_ref()?.crack.as_ref()?;
            Some(format!("gear {number}: {}", crack.description()))
        });
        let kinds: Vec<String> = (kinds.into_iter().map(str::to_owned))
            .chain(std::iter::repeat_n("root-crack".to_owned(), cracks))
            .chain(of_models)
            .collect();
        parts.effect(
            name("errors and faults"),
            (!kinds.is_empty()).then(|| kinds.join(", ")),
        );
        let eccentric = teeth.eccentricity_1.is_some() || teeth.eccentricity_2.is_some();
        parts.effect(
            name("eccentricity"),
            eccentric.then(|| "runout and wobble of the gear on its body".to_string()),
        );
    }

    /// The microgeometry of both gears in words; none where none acts.
    fn acting_microgeometry(&self) -> Option<String> {
        let on = self.table.microgeometry.unwrap_or(true)
            && self.gears.iter().any(|gear| gear.has_microgeometry());
        let from_curve = self.table.model.kind() == MeshKind::Iso6336 && self.curve.is_some();
        let of_curve = if from_curve {
            ", in the pair's static curve"
        } else {
            ""
        };
        let [first, second] = self.gears.map(|gear| gear.microgeometry_in_words());
        on.then(|| format!("gear 1 {first}; gear 2 {second}{of_curve}"))
    }

    /// The same for plan and result.
    pub(super) fn microgeometry_note(&self) -> Option<String> {
        let words = self.acting_microgeometry()?;
        Some(format!("mesh `{}`: flanks of {words}", self.table.name))
    }
}
