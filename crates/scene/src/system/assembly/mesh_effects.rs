//! What of a gear mesh is computed, and what is not, in words for the plan.

use super::mesh_model::SceneInvolutes;
use super::parts::Parts;
use gearmesh_specification::gear_tables::UM;
use gearmesh_specification::system::gear_mesh::TouchingFlanks;
use gearmesh_specification::system::mesh_model::{MeshKind, MeshModel};

impl SceneInvolutes<'_, '_> {
    /// Lists the effects of this mesh.
    pub(super) fn effects(&self, parts: &mut Parts) {
        let (table, teeth) = (self.table, &self.teeth);
        let kind = table.model.kind();
        let name = |what: &str| format!("mesh `{}`: {what}", table.name);
        if kind == MeshKind::Kinematic {
            return;
        }
        let both = teeth.flanks == TouchingFlanks::Both;
        let backlash_um = self.flanks.pair.backlash_m() / UM;
        let backlash = format!("both sides, {backlash_um:.1} um of backlash");
        parts.effect(name("backlash"), both.then_some(backlash));
        parts.effect(name("damping"), table.model.damping_in_words());
        let friction = teeth.friction.as_ref();
        let rubs = "`coulomb`, regularised".to_string();
        parts.effect(name("friction"), friction.map(|_| rubs));
        parts.effect(name("microgeometry"), self.acting_microgeometry());
        let errors = teeth.errors_1.iter().chain(&teeth.errors_2);
        let cracks = match &table.model {
            MeshModel::Analytic(model) => model.cracks_1.len() + model.cracks_2.len(),
            _ => 0,
        };
        let of_models = (self.flanks.gears.iter().zip([1, 2])).filter_map(|(gear, number)| {
            let crack = gear.model.as_ref()?.crack.as_ref()?;
            Some(format!("gear {number}: {}", crack.description()))
        });
        let kinds: Vec<String> = (errors.map(|error| error.kind().to_owned()))
            .chain(std::iter::repeat_n("root-crack".to_owned(), cracks))
            .chain(of_models)
            .collect();
        let all = (!kinds.is_empty()).then(|| kinds.join(", "));
        parts.effect(name("errors and faults"), all);
        let eccentric = teeth.eccentricity_1.or(teeth.eccentricity_2);
        let moves = "runout and wobble of the gear on its body".to_string();
        parts.effect(name("eccentricity"), eccentric.map(|_| moves));
    }

    /// The microgeometry of both gears in words; none where none acts.
    fn acting_microgeometry(&self) -> Option<String> {
        let on = self.table.microgeometry.unwrap_or(true)
            && self
                .flanks
                .gears
                .iter()
                .any(|gear| gear.has_microgeometry());
        let of_curve = match (self.table.model.kind(), &self.flanks.curve) {
            (MeshKind::Iso6336, Some(_)) => ", in the pair's static curve",
            _ => "",
        };
        let [first, second] = self.flanks.gears.map(|gear| gear.microgeometry_in_words());
        on.then(|| format!("gear 1 {first}; gear 2 {second}{of_curve}"))
    }

    /// The same for plan and result.
    pub(super) fn microgeometry_note(&self) -> Option<String> {
        let words = self.acting_microgeometry()?;
        Some(format!("mesh `{}`: flanks of {words}", self.table.name))
    }
}
