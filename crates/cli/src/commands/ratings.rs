//! Ratings of a run as warnings and lines.

use crate::console;
use gearmesh_report::{short, usual_unit};
use gearmesh_scene::rating::RatingResult;
use gearmesh_scene::system_run::stem;

/// Warns of what could not be judged, and of loads beyond a limit.
pub fn warn(ratings: &[RatingResult]) {
    let all = ratings.iter().flat_map(RatingResult::reported);
    all.for_each(console::warning);
}

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
