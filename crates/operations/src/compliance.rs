//! Deflection along a flank of a reduced gear under a line load.

use crate::failure::{Failure, Result};
use crate::projected_compliance::{ProjectedDeflections, projected_deflections};
use crate::watch::Watch;
use gearmesh_contact::LocalContact;
use gearmesh_contact::flank_deflection::{FlankDeflection, FlankLoad, flank_deflection};
use gearmesh_geometry::{Flank, involute};
use gearmesh_model::{ReductionChecks, read_reduced_gear};
use serde::Deserialize;
use serde_json::{Value, json};
use std::path::PathBuf;

/// Which load, and where the deflection is asked for.
#[derive(Debug, Clone, clap::Args, Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(non_snake_case)]
pub struct ComplianceRequest {
    /// Model file
    pub model: PathBuf,
    /// Loaded tooth
    #[arg(long)]
    pub tooth: usize,
    /// Loaded side
    #[arg(long, value_parser = crate::file_words::flank_words(), default_value = Flank::Right.name())]
    #[serde(default)]
    pub flank: Flank,
    /// Radius of the load; several, separated by commas, give a table
    #[arg(long, value_delimiter = ',', required = true)]
    #[serde(deserialize_with = "crate::one_or_many::read")]
    pub radius_mm: Vec<f64>,
    /// Line load, uniform over the face width
    #[arg(long = "line-load-N-per-mm")]
    pub line_load_N_per_mm: f64,
    /// Half width of the Hertz contact (for the local term)
    #[arg(long)]
    pub half_width_mm: f64,
    /// Tooth at which the deflection is read, same radius and side; the loaded one where not given
    #[arg(long)]
    pub at_tooth: Option<usize>,
    /// Local contact term
    #[arg(long, value_parser = crate::file_words::local_words(), default_value = LocalContact::default().name())]
    #[serde(default)]
    pub local: LocalContact,
    /// Beside it the deflection by forces on single element faces; the gear is meshed and factorised again
    #[arg(long)]
    #[serde(default)]
    pub project: bool,
}

/// Deflections that were found.
#[derive(Debug)]
pub struct FoundDeflections {
    /// Name of the gear.
    pub gear: String,
    /// Loaded tooth.
    pub tooth: usize,
    /// Tooth at which they are read.
    pub at_tooth: usize,
    /// Slices over the face.
    pub slices: usize,
    /// Estimated relative error of the mesh.
    pub mesh_error: Option<f64>,
    /// Radius of the load \[mm\], deflection.
    pub rows: Vec<(f64, FlankDeflection)>,
    /// The same by forces on single element faces, where asked for.
    pub projected: Option<ProjectedDeflections>,
}

impl FoundDeflections {
    /// For other programs.
    #[must_use]
    pub fn figures(&self) -> Value {
        let row = |radius_mm: f64, d: &FlankDeflection| {
            let (global, local) = d.means_m();
            json!({"radius_mm": radius_mm, "global_m": global, "local_m": local, "total_m": global + local,
                   "global_per_slice_m": d.global_m, "local_per_slice_m": d.local_m})
        };
        let rows: Vec<Value> = self
            .rows
            .iter()
            .map(|(radius, d)| row(*radius, d))
            .collect();
        let mut told = json!({"gear": self.gear, "tooth": self.tooth, "at_tooth": self.at_tooth,
                              "mesh_error_relative": self.mesh_error, "rows": rows});
        if let Some(projected) = &self.projected {
            let rows = self.rows.iter().zip(&projected.deflections);
            told["projected"] = json!({
                "rows": rows.map(|((radius, _), d)| row(*radius, d)).collect::<Vec<_>>(),
                "solutions": projected.solutions,
                "seconds": {"mesh and factor": projected.factor_s, "projection": projected.projection_s,
                            "solutions": projected.solutions_s}});
        }
        told
    }
}

/// Finds the deflection of a tooth along its flank's normal.
///
/// # Errors
/// [`Failure`] for a file that is no model of a cylindrical gear, and for a place or load that it does not allow.
pub fn compliance(a: &ComplianceRequest, watch: &Watch<'_>) -> Result<FoundDeflections> {
    let model = read_reduced_gear(&a.model).map_err(Failure::input)?;
    model.demand_cylindrical().map_err(Failure::input)?;
    let at_tooth = a.at_tooth.unwrap_or(a.tooth);
    for (name, tooth) in [("--tooth", a.tooth), ("--at-tooth", at_tooth)] {
        if tooth >= model.teeth {
            return Err(Failure::input(format!(
                "{name}: found {tooth}, allowed is 0 to {}",
                model.teeth - 1
            )));
        }
    }
    for (name, value) in [
        ("--line-load-N-per-mm", a.line_load_N_per_mm),
        ("--half-width-mm", a.half_width_mm),
    ] {
        if !(value > 0.0 && value.is_finite()) {
            return Err(Failure::input(format!(
                "{name}: found {value}, allowed is more than 0"
            )));
        }
    }
    let radius_mm = |xi: f64| 1e3 * involute::radius_m(xi, model.base_radius_m);
    let stations = &model.grid.roll_angles_rad;
    let (low, high) = (
        radius_mm(stations[0]),
        radius_mm(stations[stations.len() - 1]),
    );
    let (mut loads, mut found) = (Vec::new(), Vec::new());
    for &radius in &a.radius_mm {
        if !(radius >= low - 1e-6 && radius <= high + 1e-6) {
            return Err(Failure::input(format!(
                "--radius-mm: found {radius}, allowed is {low:.4} to {high:.4}, the involute part of the flank"
            )));
        }
        let load = FlankLoad {
            tooth: a.tooth,
            flank: a.flank,
            radius_m: radius * 1e-3,
            line_load_n_per_m: a.line_load_N_per_mm * 1e3,
            half_width_m: a.half_width_mm * 1e-3,
        };
        let by_grid = flank_deflection(&model, &load, at_tooth, a.local);
        found.push(by_grid.map_err(Failure::input)?);
        loads.push(load);
    }
    let projected = a.project.then(|| {
        let file = a.model.display().to_string();
        let asked = (&loads[..], &found[..]);
        projected_deflections((&model, &file), asked, (at_tooth, a.local), watch)
    });
    let projected = projected.transpose()?;
    // Made for a load on tooth 0; on others the body below may differ.
    let mesh_error = model.checks.further(if at_tooth == a.tooth {
        ReductionChecks::LOADED_TOOTH_ERROR
    } else {
        ReductionChecks::OTHER_TEETH_ERROR
    });
    Ok(FoundDeflections {
        gear: model.name,
        tooth: a.tooth,
        at_tooth,
        slices: model.grid.slices,
        mesh_error,
        rows: a.radius_mm.iter().copied().zip(found).collect(),
        projected,
    })
}
