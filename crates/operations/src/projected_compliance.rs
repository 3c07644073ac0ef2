//! Deflection of a flank by forces on single element faces: the gear is meshed and factorised again, and each slice of
//! each line is solved for, where the reduced gear combines what it has.

use crate::failure::{Failure, Result};
use crate::watch::Watch;
use gearmesh_contact::LocalContact;
use gearmesh_contact::flank_deflection::{FlankDeflection, FlankLoad};
use gearmesh_geometry::{Flank, GearDefinition, involute};
use gearmesh_model::ReducedGear;
use gearmesh_reduction::flank_loads::{GridLoad, SparseVector};
use gearmesh_reduction::near_field::PlaneTooth;
use gearmesh_reduction::projected_flank::{ProjectedFlank, line_near_field};
use gearmesh_reduction::tooth_submodel::{Deformation, ToothSubmodel};
use gearmesh_reduction::{GearBody, ReductionError, Silent};
use std::f64::consts::PI;
use std::time::Instant;

/// What was found, and what it took.
#[derive(Debug)]
pub struct ProjectedDeflections {
    /// Of each load.
    pub deflections: Vec<FlankDeflection>,
    /// Solutions with the factor of the whole gear: one a slice of each load.
    pub solutions: usize,
    /// Seconds of wall time for mesh and factor.
    pub factor_s: f64,
    /// For the faces under all loads and their nodal forces.
    pub projection_s: f64,
    /// For the solutions, near fields included.
    pub solutions_s: f64,
}

/// Deflection of tooth `at_tooth` under uniform line loads on one flank of one tooth, which the reduced gear in `file`
/// says to be `by_grid`.
///
/// # Errors
/// [`Failure`] for a gear of which the factor is another one than the reduced gear's: with a crack, cut into its shaft,
/// or meshed elsewhere.
pub fn projected_deflections(
    (model, file): (&ReducedGear, &str),
    (loads, by_grid): (&[FlankLoad], &[FlankDeflection]),
    (at_tooth, local): (usize, LocalContact),
    watch: &Watch<'_>,
) -> Result<ProjectedDeflections> {
    let gear = model.input.definition_in(file)?;
    demand_own_factor(gear, file)?;
    let (tooth, side) = loads
        .first()
        .map_or((0, Flank::Right), |l| (l.tooth, l.flank));
    let python = watch.python()?;
    let clock = Instant::now();
    let body = watch.offline(&gear.name, |told| GearBody::new(gear, &python, told))?;
    let factor_s = clock.elapsed().as_secs_f64();

    let clock = Instant::now();
    // Rounding of a radius may put a load beyond the ends of the flank.
    let [low, high] = gear.profile.flank_rolls_rad();
    let roll = |load: &FlankLoad| involute::roll_angle_rad(load.radius_m, model.base_radius_m);
    let rolls: Vec<f64> = loads
        .iter()
        .map(|load| roll(load).clamp(low, high))
        .collect();
    let on = |tooth: usize| -> Result<Vec<GridLoad>, ReductionError> {
        let flank = ProjectedFlank::new(gear, &body.mesh, body.model.nodes(), (tooth, side));
        let of_lines = rolls.iter().map(|&roll| flank.slices(&model.grid, roll));
        Ok(of_lines.collect::<Result<Vec<_>, _>>()?.concat())
    };
    let (lines, at_zero) = (on(tooth)?, on(0)?);
    let projection_s = clock.elapsed().as_secs_f64();

    let clock = Instant::now();
    let rows: Vec<&SparseVector> = lines.iter().map(|line| &line.normal).collect();
    let vectors: Vec<&SparseVector> = at_zero.iter().map(|line| &line.normal).collect();
    let read = body.readings(&rows, &vectors, &Silent);
    let solutions = rows.len();
    // What is taken off the compliance, and what comes to the deflection of the loaded tooth.
    let own = tooth == at_tooth;
    let submodel = (own && local == LocalContact::WeberBanaschek)
        .then(|| {
            let (model, mesh) = (&body.model, &body.mesh);
            ToothSubmodel::of_tooth(model, mesh, (tooth, side), &lines, Deformation::of(gear))
        })
        .transpose()?;
    let taken = submodel.map(|submodel| submodel.products(&rows));
    let local_m = match local {
        LocalContact::Calibrated if own => calibrated(model, gear, &body, (loads, &rolls))?,
        _ => by_grid.iter().map(|grid| grid.local_m[0]).collect(),
    };
    let slices = model.grid.slices;
    let deflections = loads
        .iter()
        .zip(local_m)
        .enumerate()
        .map(|(number, (load, local_m))| {
            let force_n = load.line_load_n_per_m * model.slice_width_m();
            let of_load = number * slices..(number + 1) * slices;
            let at = |response: usize| {
                let each = of_load.clone().map(|k| {
                    let local = taken.as_ref().map_or(0.0, |w| w[response * solutions + k]);
                    read[k][at_tooth * solutions + response] - local
                });
                force_n * each.sum::<f64>()
            };
            FlankDeflection {
                global_m: of_load.clone().map(at).collect(),
                local_m: vec![local_m; slices],
            }
        });
    Ok(ProjectedDeflections {
        deflections: deflections.collect(),
        solutions,
        factor_s,
        projection_s,
        solutions_s: clock.elapsed().as_secs_f64(),
    })
}

/// Refuses a gear whose compliance is not that of the factor that is made here.
fn demand_own_factor(gear: &GearDefinition, file: &str) -> Result<()> {
    for (is_so, what) in [
        (gear.crack.is_some(), "has a crack"),
        (
            gear.blank.cut_into_shaft().is_some(),
            "is cut into its shaft",
        ),
        (
            gear.blank.meshed().is_some(),
            "was meshed by another program",
        ),
    ] {
        if is_so {
            return Err(Failure::input(format!(
                "--project: the gear of {file} {what}; forces are projected on gears that are meshed here and held at their bores"
            )));
        }
    }
    Ok(())
}

/// The calibrated local term of each load with the near field of a line on single elements in place of that of hats:
/// q \[c₀ − w_p − k ln(a/a₀)\].
fn calibrated(
    model: &ReducedGear,
    gear: &GearDefinition,
    body: &GearBody,
    (loads, rolls_rad): (&[FlankLoad], &[f64]),
) -> Result<Vec<f64>> {
    let field = model.calibration().map_err(Failure::input)?;
    let contact = field.contact_curve(model.signed_base_radius_m());
    let plane = PlaneTooth::new(gear, &body.mesh, &body.model, &model.grid)?;
    let side = loads.first().map_or(Flank::Right, |load| load.flank);
    let lines = line_near_field(gear, &plane, side, rolls_rad)?;
    let k = 2.0 * (1.0 - model.poisson * model.poisson) / (PI * model.young_pa);
    let each = loads.iter().zip(rolls_rad).zip(lines);
    Ok(each
        .map(|((load, &roll), line)| {
            let wider = (load.half_width_m / field.half_width_m).ln();
            load.line_load_n_per_m * (contact.at(roll).0 - line - k * wider)
        })
        .collect())
}
