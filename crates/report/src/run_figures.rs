//! The figures of runs as JSON: what `gearmesh run --json` prints, and the studio shows.

use gearmesh_contact::mesh_stiffness::mesh_harmonics;
use gearmesh_model::Named;
use gearmesh_scene::SceneResult;
use gearmesh_scene::rating::RatingResult;
use serde_json::{Value, json};

/// The figures of each torque of a pair, and what to say about all of them.
#[must_use]
pub fn pair_figures(result: &SceneResult) -> Value {
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
    json!({"title": result.title, "rows": rows, "means": result.means_over(), "errors": result.errors_in_words(), "coverage": coverage(result), "ratings": ratings(&result.ratings), "warnings": result.warnings, "seconds": result.seconds})
}

/// Each quantity with its period; `extent` is "whole", "passage" (one passage of the gauged tooth: peak and range) or
/// "part".
#[must_use]
pub fn coverage(result: &SceneResult) -> Value {
    let quantities = result.coverages().into_iter().map(|(name, c)| {
        json!({"quantity": name, "period_pitches": c.period_pitches, "run_pitches": c.run_pitches, "extent": c.extent.name_in_files()})
    });
    let proposal = (!result.proposal.is_empty()).then_some(&result.proposal);
    json!({"quantities": quantities.collect::<Value>(), "proposal": proposal})
}

/// The figures as JSON; an infinite life is null.
#[must_use]
pub fn ratings(rated: &[RatingResult]) -> Value {
    let all = rated.iter().map(|rated| {
        let figures = rated.figures.iter();
        json!({
            "name": rated.name, "method": rated.method, "problem": rated.problem,
            "incomplete": rated.incomplete, "warnings": rated.warnings,
            "figures": figures.map(|f| (f.name.to_owned(), json!(f.value))).collect::<serde_json::Map<_, _>>(),
        })
    });
    all.collect()
}
