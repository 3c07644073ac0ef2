//! Ratings of a run as lines and JSON.

use gearmesh_report::{short, usual_unit};
use gearmesh_scene::rating::RatingResult;
use gearmesh_scene::system_run::stem;
use serde_json::{Value, json};

/// The figures for people.
pub fn lines(ratings: &[RatingResult]) -> Vec<String> {
    let mut lines = Vec::new();
    for rated in ratings {
        lines.push(format!("rating of {}: {}", rated.name, rated.method));
        let problem = rated.problem.iter();
        lines.extend(problem.map(|problem| format!("  not rated: {problem}")));
        let missing = rated.incomplete.iter();
        lines.extend(missing.map(|missing| format!("  {missing}")));
        lines.extend(rated.figures.iter().map(|figure| {
            let (factor, unit) = usual_unit(figure.unit, figure.value.abs());
            let unit = if unit == "1" { "" } else { unit };
            let value = match figure.value {
                f64::INFINITY => "no damage".to_owned(),
                value => short(factor * value),
            };
            let stem = stem(figure.name, figure.unit);
            format!("  {stem:<28} {value:>10} {unit:<4} {}", figure.description)
        }));
    }
    lines
}

/// The figures as JSON; an infinite life is null.
pub fn json(ratings: &[RatingResult]) -> Value {
    let all = ratings.iter().map(|rated| {
        let figures = rated.figures.iter();
        json!({
            "name": rated.name, "method": rated.method, "problem": rated.problem,
            "incomplete": rated.incomplete, "warnings": rated.warnings,
            "figures": figures.map(|f| (f.name.to_owned(), json!(f.value))).collect::<serde_json::Map<_, _>>(),
        })
    });
    all.collect()
}
