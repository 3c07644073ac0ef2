//! A setting as lines of TOML: keys of lists stand under the head of their table.

use toml::Value;

use super::knobs::Knob;

/// Keys and values of a setting. Keys of the `[[list]]` tables are grouped behind a comment with the table's name,
/// which `name_of` tells; keys of gear files behind one that names the file's key.
pub(super) fn to_paste(
    knobs: &[Knob],
    rungs: &[usize],
    name_of: &dyn Fn(&str) -> String,
) -> Vec<String> {
    let settings = knobs
        .iter()
        .zip(rungs)
        .flat_map(|(knob, rung)| &knob.rungs[*rung].settings);
    // Head, keys and values, in the order in which heads come.
    let mut grouped: Vec<(String, Vec<(String, Value)>)> = vec![(String::new(), Vec::new())];
    for (key, value) in settings {
        let (head, inner) = match (key.split_once(':'), in_list(key)) {
            (Some((file, inner)), _) => (
                format!("# in the gear file of {file}, to be reduced again:"),
                inner,
            ),
            (None, Some((list, number, inner))) => {
                let name = name_of(&format!("{list}.{number}"));
                (format!("# in [[{list}]]{name}:"), inner)
            }
            (None, None) => (String::new(), &key[..]),
        };
        let lines = match grouped.iter().position(|(known, _)| *known == head) {
            Some(place) => &mut grouped[place].1,
            None => {
                grouped.push((head, Vec::new()));
                let last = grouped.len() - 1;
                &mut grouped[last].1
            }
        };
        add(lines, inner, value);
    }
    let of_group = |(head, lines): (String, Vec<(String, Value)>)| {
        let head = (!head.is_empty()).then_some(head);
        let lines = lines
            .into_iter()
            .map(|(key, value)| format!("{key} = {value}"));
        head.into_iter().chain(lines).collect::<Vec<_>>()
    };
    grouped.into_iter().flat_map(of_group).collect()
}

/// Puts a key into the table that stands there already, or behind the others: `model = { ... }` takes no `model.slices`
/// beside it.
fn add(lines: &mut Vec<(String, Value)>, key: &str, value: &Value) {
    if let Some((parent, last)) = key.split_once('.') {
        let table = lines.iter_mut().find(|(known, _)| known == parent);
        if let Some((_, Value::Table(table))) = table {
            table.insert(last.to_owned(), value.clone());
            return;
        }
    }
    lines.push((key.to_owned(), value.clone()));
}

/// List, number and the rest of a key of a list's table.
fn in_list(key: &str) -> Option<(&str, usize, &str)> {
    let (list, rest) = key.split_once('.')?;
    let (number, inner) = rest.split_once('.')?;
    Some((list, number.parse().ok()?, inner))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::accuracy::Rung;

    /// A table takes further keys of its own.
    #[test]
    fn a_key_of_a_table_that_is_there_goes_into_it() {
        let mut lines = Vec::new();
        let table = Value::Table(
            [("kind".to_owned(), Value::Integer(1))]
                .into_iter()
                .collect(),
        );
        add(&mut lines, "model", &table);
        add(&mut lines, "model.slices", &Value::Integer(3));
        assert_eq!(lines.len(), 1);
        assert_eq!(lines[0].1.to_string(), "{ kind = 1, slices = 3 }");
    }

    #[test]
    fn keys_of_lists_stand_under_their_tables() {
        let knob = |settings: &[&str]| Knob {
            further: Vec::new(),
            name: "k".to_owned(),
            rungs: vec![Rung {
                label: "l".to_owned(),
                settings: settings
                    .iter()
                    .map(|key| ((*key).to_owned(), Value::Integer(1)))
                    .collect(),
            }],
        };
        let knobs = [
            knob(&["gear_mesh.0.model.slices", "gear_mesh.1.model.slices"]),
            knob(&["solver.step_s"]),
            knob(&["gear_mesh.0.teeth.path", "pair.gear_1:mesh.flank_mm"]),
        ];
        let found = to_paste(&knobs, &[0, 0, 0], &|table| format!(" \"{table}\""));
        assert_eq!(
            found,
            [
                "solver.step_s = 1",
                "# in [[gear_mesh]] \"gear_mesh.0\":",
                "model.slices = 1",
                "teeth.path = 1",
                "# in [[gear_mesh]] \"gear_mesh.1\":",
                "model.slices = 1",
                "# in the gear file of pair.gear_1, to be reduced again:",
                "mesh.flank_mm = 1",
            ]
        );
    }
}
