//! The figures of a pair at rest, for people and for other programs.

use std::path::Path;

use gearmesh_contact::ContactZone;
use gearmesh_contact::mesh_stiffness::mesh_harmonics;
use gearmesh_geometry::input::InputDocument;
use gearmesh_scene::pair::PairFigures;
use gearmesh_scene::{Scene, SceneResult};
use serde_json::json;

use crate::failure::Failure;
use crate::{periods, ratings};

/// The curves' figures for people.
pub fn table(result: &SceneResult) -> Result<Vec<String>, Failure> {
    let mut lines = vec![
        format!("{}: {} positions per torque", result.title, result.angles()),
        format!(
            "{:>10} {:>12} {:>12} {:>14} {:>14} {:>8} {:>12} {:>12} {:>9}",
            "torque N m",
            "TE mean um",
            "TE pk-pk um",
            "secant N/mm/um",
            "tangent N/mm/um",
            "K_Hbeta",
            "p_H max MPa",
            "balance",
            "iter/pos"
        ),
    ];
    let mark = periods::mark(&result.contact_coverage);
    let width_mm = 1e3 * zone_width_m(result)?;
    let figures: Vec<PairFigures> = (0..result.torque_nm.len())
        .map(|k| result.figures(k))
        .collect();
    for (k, f) in figures.iter().enumerate() {
        let per_width = |stiffness: f64| stiffness / width_mm * 1e-6;
        lines.push(format!(
            "{:>10.1} {:>12.4} {:>12.4} {:>14.4} {:>15.4} {:>8.4} {:>12.1} {:>12.1e} {:>9.2}{mark}",
            f.torque_nm,
            f.te_mean_m * 1e6,
            f.te_peak_to_peak_m * 1e6,
            per_width(f.secant_mean_n_per_m),
            per_width(f.tangent_mean_n_per_m),
            f.k_h_beta,
            f.pressure_largest_pa * 1e-6,
            result.torque_balance[k],
            f64::from(result.iterations[k]) / result.angles() as f64
        ));
    }
    lines.push(result.means_over());
    lines.push(format!("errors: {}", result.errors_in_words()));
    if result.has_axial_force() {
        lines.push(format!(
            "{:>10} {:>22} {:>24}",
            "torque N m", "axial force gear 1 N", "axial over normal force"
        ));
        for f in &figures {
            lines.push(format!(
                "{:>10.1} {:>22.3} {:>24.6}{mark}",
                f.torque_nm,
                f.axial_force_1_mean_n,
                f.axial_force_1_mean_n / f.normal_force_mean_n
            ));
        }
    }
    lines.push(format!(
        "contact {:.3} s ({:.1} us a position), strain {:.3} s",
        result.seconds[0],
        1e6 * result.seconds[0] / (result.angles() * result.torque_nm.len()) as f64,
        result.seconds[1]
    ));
    lines.extend(periods::lines(result));
    lines.extend(ratings::lines(&result.ratings));
    Ok(lines)
}

/// Width over which the faces overlap \[m\].
fn zone_width_m(result: &SceneResult) -> Result<f64, Failure> {
    let width_m = |gear: usize| -> Result<f64, Failure> {
        let definition = result.gears[gear].definition_in("the result")?;
        Ok(definition.tooth.face_width_m)
    };
    let scene = InputDocument::new("scene in result", &result.scene_toml);
    let offset_m = Scene::from_document(scene, Path::new("."))?.axial_offset_m;
    Ok(ContactZone::new([width_m(0)?, width_m(1)?], offset_m).width_m)
}

/// For other programs.
#[must_use]
pub fn figures(result: &SceneResult) -> serde_json::Value {
    let rows = (0..result.torque_nm.len())
        .map(|k| {
            let f = result.figures(k);
            let curve = result.averaged(&result.tangent_n_per_m, k);
            let pitches = result.contact_coverage.averaged_pitches();
            let (_, harmonics) = mesh_harmonics(curve, pitches, 5);
            json!({
                "torque_Nm": f.torque_nm, "te_mean_m": f.te_mean_m, "te_peak_to_peak_m": f.te_peak_to_peak_m,
                "tangent_stiffness_mean_N_per_m": f.tangent_mean_n_per_m,
                "secant_stiffness_mean_N_per_m": f.secant_mean_n_per_m,
                "tangent_stiffness_fourier": harmonics.iter().map(|(a, p)| json!({"amplitude_N_per_m": a, "phase_rad": p})).collect::<Vec<_>>(),
                "axial_force_1_mean_N": f.axial_force_1_mean_n, "pressure_largest_Pa": f.pressure_largest_pa,
                "k_h_beta": f.k_h_beta, "torque_balance": result.torque_balance[k],
                "residual": result.residual[k], "iterations": result.iterations[k],
                "complete": result.contact_coverage.is_whole(), "mean_over_pitches": pitches,
                "errors": {
                    "positions_te_peak_to_peak": f.errors.te_positions, "positions_pressure": f.errors.pressure_positions,
                    "positions_k_h_beta": f.errors.k_h_beta_positions,
                    "slices_k_h_beta": f.errors.slices, "mesh_strain": f.errors.mesh_strain,
                },
            })
        })
        .collect::<Vec<_>>();
    json!({"title": result.title, "rows": rows, "means": result.means_over(), "errors": result.errors_in_words(), "coverage": periods::json(result), "ratings": ratings::json(&result.ratings), "warnings": result.warnings, "seconds": result.seconds})
}
