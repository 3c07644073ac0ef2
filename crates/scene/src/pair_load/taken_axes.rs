//! The axes of a pair as a static run of its gearbox has found them, with shafts and bearings that deflect.

use std::path::Path;

use gearmesh_geometry::input::{InputDocument, TableKeys};
use gearmesh_geometry::{Flank, GearPair, InputError, Misalignment};
use gearmesh_specification::names::unknown;
use gearmesh_specification::pair::MisalignmentFrom;

use crate::system_run::{ResultKind, SystemResult};

/// Loads that differ by less are one: tooth friction and rounding of what a user writes.
const SAME_LOAD: f64 = 0.02;

/// Refuses several torques: an equilibrium is that of one.
///
/// # Errors
/// [`InputError`] at the torques.
pub(super) fn refuse_further_torques(
    document: &InputDocument,
    torques_nm: &[f64],
) -> Result<(), InputError> {
    let [first, others @ ..] = torques_nm else {
        return Ok(());
    };
    if others.iter().all(|torque| torque == first) {
        return Ok(());
    }
    let problem = format!(
        "found {torques_nm:?} with pair.misalignment_from, whose axes are those of one equilibrium; allowed is the torque of that equilibrium \
         alone: write a scene for each torque, each with the `point` of its own equilibrium"
    );
    Err(document.error("run.torques_Nm", problem))
}

/// The result; `at` complains about a key.
fn opened(
    path: &Path,
    at: impl Fn(&str, String) -> InputError,
) -> Result<SystemResult, InputError> {
    if !path.is_file() {
        let shown = path.display();
        let problem = format!(
            "the result {shown} does not exist; make it with `gearmesh run SCENE.toml -o {shown}`, run.kind = \"static\""
        );
        return Err(at("result", problem));
    }
    let result = SystemResult::open(path).map_err(|error| at("result", error.to_string()))?;
    match result.kind {
        ResultKind::Static => Ok(result),
        kind => {
            let problem = format!("found a result of kind \"{kind}\", allowed is \"static\"");
            Err(at("result", problem))
        }
    }
}

/// What was taken from a result.
pub(super) struct TakenAxes {
    pub misalignment: Misalignment,
    /// What was taken, in words.
    pub note: String,
    /// Normal force of the mesh \[N\] there; none where the result does not have it.
    normal_force_n: Option<f64>,
}

impl TakenAxes {
    /// The axes of a pair with so many teeth in contact on these flanks.
    ///
    /// # Errors
    /// [`InputError`] at the key, when the result has no such mesh or point, other teeth, or its mesh carries on the
    /// other flanks.
    pub(super) fn of(
        from: &MisalignmentFrom,
        keys: &TableKeys<'_>,
        folder: &Path,
        (teeth, flank): ([usize; 2], Flank),
    ) -> Result<Self, InputError> {
        let at =
            |key: &str, problem: String| keys.error(&format!("misalignment_from.{key}"), problem);
        let path = folder.join(&from.result);
        let result = opened(&path, at)?;
        let unreadable = |error: gearmesh_model::FileError| at("result", error.to_string());
        let meshes = &result.head.meshes;
        let mesh = meshes.iter().find(|mesh| mesh.name == from.mesh);
        let mesh = mesh.ok_or_else(|| {
            let known: Vec<String> = meshes.iter().map(|mesh| mesh.name.clone()).collect();
            at("mesh", unknown("gear mesh", &from.mesh, &known))
        })?;
        let swapped = mesh.teeth != teeth;
        if swapped && mesh.teeth != [teeth[1], teeth[0]] {
            let [z1, z2] = mesh.teeth;
            let problem = format!(
                "`{}` has {z1} and {z2} teeth, the pair {} and {}",
                from.mesh, teeth[0], teeth[1]
            );
            return Err(at("mesh", problem));
        }
        let rows = result.rows.rows();
        let last = rows.saturating_sub(1);
        let point = from.point.unwrap_or(last);
        if point >= rows {
            let problem = format!("found {point}, the result has points 0 to {last}");
            return Err(at("point", problem));
        }
        let loaded = result.loaded_flank(&from.mesh, point).map_err(unreadable)?;
        // Sides are those of the mesh's gear 1, which is the pair's gear 2 where both are swapped.
        let loaded = loaded.map(|side| mesh.circles().side_of(usize::from(swapped), side));
        if let Some(other) = loaded.filter(|side| *side != flank) {
            let problem = format!(
                "`{}` carries on its {} flanks there, the pair on its {} ones; set pair.flank = \"{}\"",
                from.mesh,
                other.name(),
                flank.name(),
                other.name()
            );
            return Err(at("mesh", problem));
        }
        let axes = (result.mesh_axes(mesh, point, swapped)).map_err(unreadable)?;
        let axes = axes.ok_or_else(|| {
            let [a, b] = &mesh.bodies;
            let problem = format!(
                "the result has no places of the bodies `{a}` and `{b}`; name them in output.bodies of its scene"
            );
            at("result", problem)
        })?;
        let misalignment = axes.misalignment(flank);
        let inclination = 1e3 * misalignment.inclination_rad;
        let deviation = 1e3 * misalignment.deviation_rad;
        for (what, value) in [("inclination", inclination), ("deviation", deviation)] {
            if value.is_nan() || value.abs() > 10.0 {
                let problem = format!(
                    "`{}` has an {what} of {value:.3} mrad, allowed is -10 to 10: the misalignment is treated as small",
                    from.mesh
                );
                return Err(at("mesh", problem));
            }
        }
        let note = format!(
            "misalignment of mesh `{}` at point {point} of {}: inclination_mrad = {inclination:.6}, deviation_mrad = {deviation:.6}; its centre distance there is {:.4} mm",
            from.mesh,
            path.display(),
            1e3 * axes.centre_distance_m
        );
        let normal_force_n = (result.loaded_force_n(&from.mesh, point)).map_err(unreadable)?;
        Ok(Self {
            misalignment,
            note,
            normal_force_n,
        })
    }

    /// What to say where the pair carries another load than its axes were found under.
    pub fn other_load(&self, pair: &GearPair, torque_nm: f64) -> Option<String> {
        let lever_m = pair.gear_2.base_radius_m * pair.base_helix_angle_rad().cos();
        let there_nm = self.normal_force_n? * lever_m;
        ((torque_nm / there_nm - 1.0).abs() > SAME_LOAD).then(|| {
            format!(
                "run.torques_Nm is {torque_nm} N m, but the axes of pair.misalignment_from are those under {there_nm:.4} N m on gear 2: K_Hbeta \
                 is that of the pair on axes of another load"
            )
        })
    }
}
