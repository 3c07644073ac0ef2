//! The figures of a pair at rest at all doors of the program.

use super::{Desk, argument, number, succeeds};
use gearmesh_scene::SceneResult;
use gearmesh_scene::pair::figure_table::RestFigure;
use serde_json::Value;
use std::collections::HashMap;
use std::path::Path;

/// Figures of the first torque by `--json`, the table `torques`, a study, the page and the console: equal to the last
/// digit that each has. `table`: that of the scene's torques.
pub fn one_table_at_all_doors(
    desk: &Desk,
    (scene, table): (&str, &str),
    result: &Path,
    figures: &Value,
) {
    let row = figures["rows"][0].as_object().unwrap();
    let words = ["export", argument(result), "--table", "torques", "-o"];
    let (csv, html) = (
        desk.path(&format!("{scene}.csv")),
        desk.path(&format!("{scene}.html")),
    );
    succeeds(&[&words[..], &[argument(&csv)]].concat());
    let csv = std::fs::read_to_string(csv).unwrap();
    let mut lines = csv.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let (heads, values) = (lines.next().unwrap(), lines.next().unwrap());
    let exported: HashMap<_, f64> = heads
        .into_iter()
        .zip(values.iter().map(|v| v.parse().unwrap_or(f64::NAN)))
        .collect();
    let of_result = SceneResult::read(result).unwrap();
    let (bevel, over) = (of_result.bevel, of_result.overlap_width_m().ok());
    let stated: Vec<&RestFigure> = of_result.stated_figures().collect();
    let studied_ones = stated
        .iter()
        .filter(|figure| figure.is_studied(bevel.as_ref()));
    let columns: Vec<String> = studied_ones
        .map(|figure| figure.name_in_studies())
        .collect();
    let torque = of_result.torque_nm[0];
    let study = format!(
        "title = \"one\"\nscene = \"{scene}\"\ncolumns = {columns:?}\n[[parameter]]\nname = \"T\"\nkeys = [\"{table}.torques_Nm.0\"]\nvalues = [{torque:?}]\n"
    );
    let (study, out) = (
        desk.file(&format!("one-{scene}"), study),
        desk.path(&format!("one-{scene}-results")),
    );
    let studied = succeeds(&["study", argument(&study), "-o", argument(&out), "--json"])
        .json()
        .to_string();
    succeeds(&["report", argument(result), "-o", argument(&html)]);
    let page = std::fs::read_to_string(html).unwrap();
    let (file, again) = (desk.path(scene), desk.path(&format!("{scene}.h5")));
    let console = succeeds(&["run", argument(&file), "-o", argument(&again)]).stdout;
    for figure in stated {
        let name = figure.name_in_files();
        let value = (figure.of)(&of_result.figures(0));
        assert_eq!(number(&row[&name]), value, "{name}");
        assert_eq!(exported[name.as_str()], value, "{name}");
        let text = figure.text(&of_result.figures(0), over);
        if of_result.shows(figure) {
            assert!(
                page.contains(&text.replace('-', "−")) || page.contains(&text),
                "{name} {text}"
            );
            assert!(console.contains(&text), "{name} {text}");
        }
        if figure.is_studied(bevel.as_ref()) {
            let read = figure.studied(&of_result.figures(0), over);
            assert!(
                studied.contains(&Value::from(read).to_string()),
                "{name} {read} {studied}"
            );
        }
    }
}
