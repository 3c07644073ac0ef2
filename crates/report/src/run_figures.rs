//! The figures of runs as JSON: what `gearmesh run --json` prints, and the studio shows.

use gearmesh_contact::mesh_stiffness::mesh_harmonics;
use gearmesh_model::Named;
use gearmesh_scene::SceneResult;
use gearmesh_scene::pair::figure_table::FIGURE_ERRORS;
use gearmesh_scene::rating::RatingResult;
use serde_json::{Map, Value, json};

/// The figures of each torque of a pair, in SI units, and what to say about all of them; `columns`: what people read of
/// them, in which unit.
#[must_use]
pub fn pair_figures(result: &SceneResult) -> Value {
    let row = |k: usize| {
        let f = result.figures(k);
        let figures = result
            .stated_figures()
            .map(|row| (row.name_in_files(), json!((row.of)(&f))));
        let mut row: Map<String, Value> = figures.collect();
        let curve = result.averaged(&result.tangent_n_per_m, k);
        let pitches = result.contact_coverage.averaged_pitches();
        let (_, harmonics) = mesh_harmonics(curve, pitches, 5);
        let line = |(a, p): &(f64, f64)| json!({"amplitude_N_per_m": a, "phase_rad": p});
        row.insert(
            "stiffness_tangent_fourier".to_owned(),
            harmonics.iter().map(line).collect(),
        );
        row.insert(
            "complete".to_owned(),
            json!(result.contact_coverage.is_whole()),
        );
        row.insert("mean_over_pitches".to_owned(), json!(pitches));
        let errors = FIGURE_ERRORS
            .iter()
            .map(|(name, of)| ((*name).to_owned(), json!(of(&f.errors))));
        row.insert("errors".to_owned(), Value::Object(errors.collect()));
        Value::Object(row)
    };
    let rows: Value = (0..result.torque_nm.len()).map(row).collect();
    let over = result.overlap_width_m().ok();
    let shown = result
        .stated_figures()
        .filter(|figure| result.shows(figure));
    let columns: Value = shown
        .map(|figure| {
            let unit = figure.kind.read_unit(over);
            json!({"name": figure.name_in_files(), "words": figure.words, "unit": unit.name, "factor": unit.factor})
        })
        .collect();
    json!({
        "title": result.source.title, "rows": rows, "columns": columns, "means": result.means_over(), "errors": result.errors_in_words(),
        "stage": result.stage().ok().flatten(),
        "coverage": coverage(result), "ratings": ratings(&result.ratings), "warnings": result.warnings, "seconds": result.solution.seconds,
    })
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
