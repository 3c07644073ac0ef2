//! The figures of a pair at rest for people.

use gearmesh_scene::SceneResult;

use crate::{periods, ratings};

/// The curves' figures for people.
pub fn table(result: &SceneResult) -> Vec<String> {
    let mut lines = vec![format!(
        "{}: {} positions per torque",
        result.source.title,
        result.angles()
    )];
    let mark = periods::mark(&result.contact_coverage);
    let table = result.figure_table(true).lines();
    lines.extend(table.iter().take(1).cloned());
    lines.extend(table.iter().skip(1).map(|line| format!("{line}{mark}")));
    lines.push(result.means_over());
    lines.push(format!("errors: {}", result.errors_in_words()));
    if let Ok(Some(stage)) = result.stage() {
        lines.push(format!("stage: {}", stage.words()));
    }
    lines.push(format!(
        "contact {:.3} s ({:.1} us a position), strain {:.3} s",
        result.solution.seconds[0],
        1e6 * result.solution.seconds[0] / (result.angles() * result.torque_nm.len()) as f64,
        result.solution.seconds[1]
    ));
    lines.extend(periods::lines(result));
    lines.extend(ratings::lines(&result.ratings));
    lines
}
