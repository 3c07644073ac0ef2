//! The static curve of a pair for its `impact` or `iso6336` mesh: from the result of a `[pair]` scene, or computed from
//! the bodies' reduced gears.

use std::f64::consts::TAU;
use std::path::Path;

use gearmesh_contact::{
    ContactLines, ContactOptions, Drive, PathExtension, StaticContact,
    mesh_stiffness::MeshStiffness,
};
use gearmesh_drivetrain::{PairCurve, PairSamples};
use gearmesh_geometry::input::{Count, InputDocument};
use gearmesh_geometry::{Flank, GearDefinition, InputError};
use gearmesh_specification::gear_tables::{MM, UM};
use gearmesh_specification::system::gear_mesh::PathWord;
use gearmesh_specification::system::mesh_model::{MeshKind, PairStiffnessTable};

use super::mesh_model::SceneInvolutes;
use crate::pair::{Scene, SceneResult};

/// Harmonics of the mesh cycle where a scene says nothing.
const HARMONICS: usize = 20;
/// Positions a pitch of a curve that is computed: enough for the most harmonics, 50.
const POINTS_PER_PITCH: usize = 120;
/// Radius of the tip edges of a curve that is computed, as in `[pair]` scenes that state none \[m\].
const EDGE_RADIUS_M: f64 = 100e-6;
/// Difference of the centre distances up to which a result belongs to the mesh \[m\]: it changes the stiffness by less
/// than 1e-3.
const CENTRE_DISTANCE_M: f64 = 10e-6;

/// Curves over whole pitches.
struct Curves {
    start_rad: f64,
    pitches: usize,
    te_m: Vec<f64>,
    unloaded_m: Vec<f64>,
    tangent_n_per_m: Vec<f64>,
}

impl SceneInvolutes<'_, '_> {
    /// The curve that `stiffness` names; none where the table has no such key.
    pub(super) fn static_curve(&self, side: Flank) -> Result<Option<PairCurve>, InputError> {
        let Some(table) = self.table.model.pair_stiffness() else {
            return Ok(None);
        };
        let keys = &self.model_keys;
        let torque = *table.torque_Nm;
        let harmonics = table.harmonics.map_or(HARMONICS, Count::get);
        let curves = match (&table.from, table.local) {
            (Some(file), None) => self.stored(&self.folder.join(file), table)?,
            (Some(_), Some(_)) => {
                let problem = "is not used with `from`, whose curve has its own; remove it";
                return Err(keys.error("stiffness.local", problem));
            }
            (None, _) => self.computed(table, side)?,
        };
        if self.table.model.kind() == MeshKind::Impact && table.harmonics.is_some() {
            let problem = "is not used by kind = \"impact\", which takes the means; remove it";
            return Err(keys.error("stiffness.harmonics", problem));
        }
        let samples = PairSamples {
            start_roll_rad: self.flanks.pair.working_pressure_angle_rad.tan() + curves.start_rad,
            pitches: curves.pitches,
            teeth_1: self.flanks.pair.gear_1.teeth,
            force_n: torque / self.flanks.pair.gear_2.base_radius_m,
            te_m: &curves.te_m,
            unloaded_m: &curves.unloaded_m,
            tangent_n_per_m: &curves.tangent_n_per_m,
        };
        let curve = PairCurve::new(samples, harmonics).map_err(|e| keys.error("stiffness", e))?;
        Ok(Some(curve))
    }

    /// Takes the curves from the result of a `[pair]` scene of the same gears.
    fn stored(&self, file: &Path, table: &PairStiffnessTable) -> Result<Curves, InputError> {
        let keys = &self.model_keys;
        let shown = file.display();
        let fault = |problem: String| keys.error("stiffness.from", problem);
        if !file.exists() {
            let problem = format!(
                "the result {shown} does not exist; make it with `gearmesh run PAIR.toml -o {shown}` from a scene with a [pair]"
            );
            return Err(fault(problem));
        }
        let result = SceneResult::read(file).map_err(|e| fault(e.to_string()))?;
        let document = InputDocument::new(
            format!("scene inside {shown}"),
            result.source.scene_toml.clone(),
        );
        let scene = Scene::from_document(document, self.folder)?;
        for (i, gear) in self.flanks.gears.iter().enumerate() {
            let mut of_result = result.source.gears[i].definition_in(&shown)?.clone();
            scene.modify_flanks(i + 1, &mut of_result)?;
            if let Some(what) = difference(&of_result, &gear.definition) {
                let problem = format!(
                    "gear {} of the pair in {shown} is another one than the gear of {}: {what}",
                    i + 1,
                    gear.file.display()
                );
                return Err(fault(problem));
            }
        }
        let distances = [scene.centre_distance_m, self.flanks.pair.centre_distance_m];
        if (distances[0] - distances[1]).abs() > CENTRE_DISTANCE_M {
            let [of_result, here] = distances.map(|d| d / MM);
            let problem = format!(
                "the pair in {shown} has the centre distance {of_result:.4} mm, the bodies of this mesh stand {here:.4} mm apart"
            );
            return Err(fault(problem));
        }
        let close = |torque: &f64| (torque / *table.torque_Nm - 1.0).abs() < 1e-6;
        let Some(index) = result.torque_nm.iter().position(close) else {
            let known: Vec<String> = result.torque_nm.iter().map(f64::to_string).collect();
            let problem = format!(
                "found {}, but {shown} has the torques {} N m; take one of them, or run the pair with this one",
                table.torque_Nm,
                known.join(", ")
            );
            return Err(keys.error("stiffness.torque_Nm", problem));
        };
        Ok(Curves {
            start_rad: scene.start_rad,
            pitches: result.pitches,
            te_m: result.curve(&result.te_m, index).to_vec(),
            tangent_n_per_m: result.curve(&result.tangent_n_per_m, index).to_vec(),
            unloaded_m: result.unloaded_m,
        })
    }

    /// Computes the curves over one pitch, as a `[pair]` scene of the bodies' reduced gears would.
    fn computed(&self, table: &PairStiffnessTable, side: Flank) -> Result<Curves, InputError> {
        let keys = &self.model_keys;
        let model = |i: usize| {
            self.flanks.gears[i].model.as_deref().ok_or_else(|| {
                let problem = format!(
                    "missing; the stiffness can only be computed where both bodies name reduced gears (.h5), found {}: name the result of a [pair] scene",
                    self.flanks.gears[i].file.display()
                );
                keys.error("stiffness.from", problem)
            })
        };
        let models = [model(0)?, model(1)?];
        let pair = self.flanks.pair.clone().on_flanks(side);
        let extended = self.teeth.path == PathWord::Extended;
        let extension =
            (extended && !pair.is_helical()).then(|| PathExtension::new(&pair, EDGE_RADIUS_M));
        let on = self.table.microgeometry.unwrap_or(true);
        let microgeometry = |i: usize| {
            let own = self.flanks.gears[i]
                .definition
                .microgeometry
                .of(pair.flank_of(i));
            if on { own.clone() } else { Default::default() }
        };
        let base_2 = pair.gear_2.base_radius_m;
        let lines = ContactLines {
            microgeometry_1: microgeometry(0),
            microgeometry_2: microgeometry(1),
            extension,
            zone: self.layout(1).reference,
            pair,
        };
        let options = ContactOptions {
            local: table.local.unwrap_or_default(),
            friction: None,
        };
        let fault = |e: gearmesh_contact::ContactError| keys.error("stiffness", e);
        let mut contact =
            StaticContact::new(lines, models[0], models[1], options).map_err(fault)?;
        let step = TAU / self.flanks.pair.gear_1.teeth as f64 / POINTS_PER_PITCH as f64;
        let mut curves = Curves {
            start_rad: 0.0,
            pitches: 1,
            te_m: Vec::with_capacity(POINTS_PER_PITCH),
            unloaded_m: Vec::with_capacity(POINTS_PER_PITCH),
            tangent_n_per_m: Vec::with_capacity(POINTS_PER_PITCH),
        };
        for k in 0..POINTS_PER_PITCH {
            let state = contact
                .solve(k as f64 * step, Drive::Torque(*table.torque_Nm))
                .map_err(fault)?;
            let stiffness = MeshStiffness::of(&state, base_2);
            curves.te_m.push(state.transmission_error_m);
            curves.unloaded_m.push(state.unloaded_m);
            curves.tangent_n_per_m.push(stiffness.tangent_n_per_m);
        }
        Ok(curves)
    }
}

/// In what two gears differ, as far as the teeth of a pair feel it.
fn difference(of_result: &GearDefinition, here: &GearDefinition) -> Option<String> {
    let (a, b) = (&of_result.profile, &here.profile);
    let differ = |a: f64, b: f64| (a - b).abs() > 1e-9 * a.abs().max(b.abs());
    if a.teeth != b.teeth {
        return Some(format!("{} teeth for {}", a.teeth, b.teeth));
    }
    for (what, a, b, unit) in [
        ("base radius", a.base_radius_m, b.base_radius_m, MM),
        ("tip radius", a.tip_radius_m, b.tip_radius_m, MM),
        ("root radius", a.root_radius_m, b.root_radius_m, MM),
        (
            "face width",
            of_result.tooth.face_width_m,
            here.tooth.face_width_m,
            MM,
        ),
        (
            "tooth thickness on the base circle",
            2.0 * a.base_half_angle_rad * a.base_radius_m,
            2.0 * b.base_half_angle_rad * b.base_radius_m,
            UM,
        ),
    ] {
        if differ(a, b) {
            let word = if unit == MM { "mm" } else { "um" };
            return Some(format!("{what} {:.6} for {:.6} {word}", a / unit, b / unit));
        }
    }
    (of_result.microgeometry != here.microgeometry).then(|| "its microgeometry differs".to_owned())
}
