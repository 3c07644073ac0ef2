//! Stiffness of `impact` and `iso6336` meshes: stated, after ISO 6336-1, or from the pair's own static curve; and what
//! it is, in words.

use gearmesh_geometry::given;
use gearmesh_specification::gear_tables::{MM, UM};
use gearmesh_specification::system::mesh_model::{ImpactTable, Iso6336Table, MeshModel};
use std::path::Path;

use gearmesh_contact::SliceLayout;
use gearmesh_drivetrain::{DrivetrainError, Impact, MeshSpring, PowerStiffness};
use gearmesh_geometry::input::TableKeys;
use gearmesh_geometry::{Flank, GearDefinition, InputError};

use super::mesh_model::SceneInvolutes;
use crate::system::iso_stiffness::{N_PER_MM_UM, REFERENCE_LINE_LOAD_N_PER_M, iso_stiffness};
use crate::system::stage_summary::StageSummary;

/// K in N/mm^e and e of `impact` as a scene states them.
pub(super) fn stated_impact(
    table: &ImpactTable,
    keys: &TableKeys<'_>,
) -> Result<(f64, f64), InputError> {
    let needed_by = "kind = \"impact\" without `stiffness`";
    let k = keys.needed(
        "stiffness_N_per_mm_e",
        table.stiffness_N_per_mm_e,
        needed_by,
    )?;
    let unit = "the unit of stiffness_N_per_mm_e, N/mm^e,";
    let e = keys.needed("exponent", table.exponent, unit)?;
    Ok((*k, *e))
}

/// The law of `impact` with its stiffness.
pub(super) fn impact_law(
    table: &ImpactTable,
    keys: &TableKeys<'_>,
    stiffness: Result<PowerStiffness, DrivetrainError>,
    slices: usize,
) -> Result<Impact, InputError> {
    let stiffness = stiffness.map_err(|error| keys.error("", error))?;
    let (damping, depth_m) = match (table.damping_N_s_per_mm, table.full_damping_depth_um) {
        // Without damping the depth has no meaning.
        (None, None) => (0.0, UM),
        (damping, depth) => {
            let [c, d] = ["damping_N_s_per_mm", "full_damping_depth_um"];
            let damping = keys.needed(c, damping, d)?;
            let depth = keys.needed(d, depth, c)?;
            (*damping / MM, UM * depth)
        }
    };
    Impact::new(stiffness, damping, depth_m, slices).map_err(|error| keys.error("", error))
}

/// Of a key beside `stiffness`.
const STATED_TWICE: &str =
    "is not used where `stiffness` takes it from the pair's curve; remove one of the two";

impl SceneInvolutes<'_, '_> {
    /// K in N/mm^e and e of `impact`.
    fn impact_stiffness(&self, table: &ImpactTable) -> Result<(f64, f64), InputError> {
        let keys = &self.model_keys;
        if table.hertz.is_some() {
            let problem = "is for bevel pairs, whose flanks touch in points; state stiffness_N_per_mm_e and exponent, or take `stiffness`";
            return Err(keys.error("hertz", problem));
        }
        if let Some(curve) = &self.flanks.curve {
            keys.refuse(&given!(table; stiffness_N_per_mm_e), STATED_TWICE)?;
            return Ok(curve.pair_law(
                self.flanks.pair,
                self.zone_width_m(),
                table.exponent.map(f64::from),
            ));
        }
        stated_impact(table, keys)
    }

    /// The law of `impact`.
    pub(super) fn impact(&self, table: &ImpactTable, slices: usize) -> Result<Impact, InputError> {
        let (k, e) = self.impact_stiffness(table)?;
        let stiffness = PowerStiffness::n_per_mm_e(k, e);
        impact_law(table, &self.model_keys, stiffness, slices)
    }

    /// c_γα of `iso6336` \[N/m²\] where no curve gives it, and how it was found.
    fn mesh_stiffness_n_per_m2(&self, table: &Iso6336Table) -> Result<(f64, String), InputError> {
        let keys = &self.model_keys;
        match (table.stiffness_N_per_mm_um, table.line_load_N_per_mm) {
            (Some(_), Some(_)) => Err(keys.error(
                "line_load_N_per_mm",
                "is not used where stiffness_N_per_mm_um is stated; remove one of the two",
            )),
            (Some(stiffness), None) => Ok((N_PER_MM_UM * stiffness, "as stated".to_owned())),
            (None, line_load) => {
                let line_load = line_load.map_or(REFERENCE_LINE_LOAD_N_PER_M, |q| *q / MM);
                let single = iso_stiffness(self.definitions(), line_load);
                let mesh = single.mesh_n_per_m2(self.flanks.pair.contact_ratio());
                let how = format!(
                    "after ISO 6336-1 method B, single stiffness c' {:.3}",
                    single.single()
                );
                Ok((mesh, how))
            }
        }
    }

    /// The spring of `iso6336` on one side of the teeth.
    pub(super) fn spring(
        &self,
        table: &Iso6336Table,
        side: Flank,
        layout: &SliceLayout,
    ) -> Result<MeshSpring, InputError> {
        let slices = layout.slices;
        let middle = self.flanks.pair.working_pressure_angle_rad.tan();
        let helix = self.flanks.pair.base_helix_angle_rad();
        if let Some(curve) = &self.flanks.curve {
            self.model_keys.refuse(
                &given!(table; stiffness_N_per_mm_um, line_load_N_per_mm, stiffness_amplitude),
                STATED_TWICE,
            )?;
            let slope = self
                .flanks
                .pair
                .clone()
                .on_flanks(side)
                .roll_slope_1_rad_per_m();
            let ahead = layout.centres_m().iter().map(|z| slope * z).collect();
            return Ok(MeshSpring::on_curve(curve, slices, middle)
                .with_phase_of_mid_face(ahead)
                .on_base_helix(helix));
        }
        let (per_width, _) = self.mesh_stiffness_n_per_m2(table)?;
        let spring = MeshSpring::new(per_width * self.zone_width_m(), slices, middle)
            .map_err(self.fault())?
            .on_base_helix(helix);
        match table.stiffness_amplitude {
            None => Ok(spring),
            Some(amplitude) => spring
                .with_sine(*amplitude, middle, self.flanks.pair.gear_1.teeth)
                .map_err(self.fault()),
        }
    }

    /// The stage at a glance, its stiffness that of ISO 6336-1 whatever the model.
    pub(super) fn stage(&self) -> StageSummary {
        StageSummary::new(self.flanks.pair, self.definitions(), self.zone_width_m())
    }

    fn definitions(&self) -> [&GearDefinition; 2] {
        self.flanks.gears.map(|gear| &gear.definition)
    }

    /// What stiffness the mesh has, for plan and result; nothing for models that have none of their own.
    pub(super) fn stiffness_note(&self) -> Result<Option<String>, InputError> {
        let c_gamma =
            |stiffness_n_per_m: f64| stiffness_n_per_m / self.zone_width_m() / N_PER_MM_UM;
        let source = self.table.model.pair_stiffness();
        let words = match (&self.table.model, &self.flanks.curve, source) {
            (MeshModel::Impact(table), Some(curve), Some(source)) => {
                let (k, e) = self.impact_stiffness(table)?;
                format!(
                    "K {k:.5e} N/mm^e of each pair of teeth, e {e:.4}, from {} at {} N m: its mean deflection and mean tangent; secant c_gamma {:.3} N/(mm um)",
                    curve_name(source.from.as_deref()),
                    source.torque_Nm,
                    c_gamma(curve.mean_secant_n_per_m())
                )
            }
            (MeshModel::Iso6336(_), Some(curve), Some(source)) => {
                let tangent = curve.tangent_n_per_m();
                let shares: Vec<String> = (tangent.amplitudes().take(3))
                    .map(|a| format!("{:.2}", 100.0 * a / tangent.mean()))
                    .collect();
                let harmonics = match shares.as_slice() {
                    [] => "no harmonics: it excites nothing".to_owned(),
                    some => format!(
                        "{} harmonics, the first {} % of it",
                        tangent.amplitudes().count(),
                        some.join(", ")
                    ),
                };
                format!(
                    "c_gamma {:.3} N/(mm um), the tangent at {} N m of {} (secant {:.3}), {harmonics}; its static transmission error is kept within {:.3} um",
                    c_gamma(tangent.mean()),
                    source.torque_Nm,
                    curve_name(source.from.as_deref()),
                    c_gamma(curve.mean_secant_n_per_m()),
                    curve.remainder_m() / UM
                )
            }
            (MeshModel::Iso6336(table), ..) => {
                let (stiffness, how) = self.mesh_stiffness_n_per_m2(table)?;
                let cycle = match table.stiffness_amplitude {
                    Some(a) if *a > 0.0 => {
                        format!("a sine of {:.2} % over the mesh cycle", 100.0 * a)
                    }
                    _ => "constant over the mesh cycle: it excites no vibration and has no transmission error that varies \
                          (stiffness_amplitude or `stiffness` give it a cycle)"
                        .to_owned(),
                };
                let c_gamma = stiffness / N_PER_MM_UM;
                format!("c_gamma {c_gamma:.3} N/(mm um) {how}, {cycle}")
            }
            _ => return Ok(None),
        };
        Ok(Some(format!("mesh `{}`: {words}", self.table.name)))
    }
}

/// Where a curve comes from, in words.
fn curve_name(from: Option<&Path>) -> String {
    from.map_or("the static curve of the reduced gears".to_owned(), |path| {
        path.display().to_string()
    })
}
