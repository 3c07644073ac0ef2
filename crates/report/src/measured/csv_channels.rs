//! Channels of a CSV file as measuring programs write them: units in the heads or in a line of their own; comma, semicolon or tab between the
//! fields; a decimal comma where no comma separates them.

use super::unit::is_known;
use super::{Channel, MeasuredError};
use gearmesh_geometry::input::shown_field;

/// The channels over the first column, or over the one called `axis`.
///
/// # Errors
/// [`MeasuredError::Table`] with the line; [`MeasuredError::NoChannel`] for an `axis` that is not there.
pub fn csv_channels(text: &str, axis: Option<&str>) -> Result<Vec<Channel>, MeasuredError> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let delimiter = delimiter_of(text);
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .delimiter(delimiter)
        .comment(Some(b'#'))
        .trim(csv::Trim::All)
        .from_reader(text.as_bytes());
    let wrong = |line: u64, problem: String| MeasuredError::Table { line, problem };
    let mut heads: Vec<(String, String)> = Vec::new();
    let mut columns: Vec<Vec<f64>> = Vec::new();
    for row in reader.records() {
        let row = row.map_err(|error| wrong(0, error.to_string()))?;
        let line = row.position().map_or(0, csv::Position::line);
        if heads.is_empty() {
            heads = row.iter().map(head_and_unit).collect();
            if heads.len() < 2 {
                return Err(wrong(
                    line,
                    "one column; an axis and a channel are needed".into(),
                ));
            }
            continue;
        }
        if row.len() != heads.len() {
            let problem = format!("{} fields; the heads are {}", row.len(), heads.len());
            return Err(wrong(line, problem));
        }
        if columns.is_empty() && row.iter().all(|field| number(field, delimiter).is_none()) {
            for ((_, unit), field) in heads.iter_mut().zip(&row) {
                *unit = unbracketed(field).to_owned();
            }
            columns = vec![Vec::new(); heads.len()];
            continue;
        }
        columns.resize_with(heads.len(), Vec::new);
        for ((field, column), (head, _)) in row.iter().zip(&mut columns).zip(&heads) {
            let value = number(field, delimiter).ok_or_else(|| {
                let problem = format!("`{}` under `{head}` is no number", shown_field(field));
                wrong(line, problem)
            })?;
            column.push(value);
        }
    }
    if columns.first().is_none_or(Vec::is_empty) {
        return Err(wrong(1, "no line of numbers".into()));
    }
    let place = match axis {
        None => 0,
        Some(wanted) => {
            let found = heads.iter().position(|(name, _)| name == wanted);
            found.ok_or_else(|| {
                let names: Vec<&str> = heads.iter().map(|(name, _)| &**name).collect();
                MeasuredError::NoChannel {
                    wanted: wanted.to_owned(),
                    known: names.join("; "),
                }
            })?
        }
    };
    let x = columns[place].clone();
    let (axis, axis_unit) = heads[place].clone();
    let all = heads.into_iter().zip(columns).enumerate();
    let others = all.filter(|(column, _)| *column != place);
    let channels = others.map(|(_, ((name, unit), y))| Channel {
        name,
        unit,
        axis: axis.clone(),
        axis_unit: axis_unit.clone(),
        x: x.clone(),
        y,
    });
    Ok(channels.collect())
}

/// The most frequent separator of the first line that is no comment.
fn delimiter_of(text: &str) -> u8 {
    let mut lines = text.lines();
    let heads = lines.find(|line| !line.starts_with('#') && !line.trim().is_empty());
    let count = |delimiter: &u8| {
        let bytes = heads.unwrap_or("").bytes();
        bytes.filter(|byte| byte == delimiter).count()
    };
    // Of equals the last wins: a comma.
    *[b'\t', b';', b',']
        .iter()
        .max_by_key(|d| count(d))
        .unwrap_or(&b',')
}

fn number(field: &str, delimiter: u8) -> Option<f64> {
    let parsed = if delimiter == b',' {
        field.parse()
    } else {
        field.replace(',', ".").parse()
    };
    parsed.ok().filter(|value: &f64| value.is_finite())
}

/// `TE [µm]`, `TE (µm)`, `TE / µm` or `te_um`.
fn head_and_unit(head: &str) -> (String, String) {
    for (open, close) in [('[', ']'), ('(', ')')] {
        if let Some((name, unit)) = head.strip_suffix(close).and_then(|h| h.rsplit_once(open)) {
            return (name.trim().to_owned(), unit.trim().to_owned());
        }
    }
    let split = head.rsplit_once(" / ").or_else(|| head.rsplit_once('_'));
    match split {
        Some((name, unit)) if is_known(unit) => (name.to_owned(), unit.to_owned()),
        _ => (head.to_owned(), String::new()),
    }
}

fn unbracketed(field: &str) -> &str {
    field.trim_matches(['[', ']', '(', ')']).trim()
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn units_stand_in_heads_or_below_them() {
        let same = [
            "phi [deg],TE [µm],root (µm/m)\n0,1.5,2\n1,2.5,3\n",
            "phi;TE;root\ndeg;µm;µm/m\n0;1,5;2\n1;2,5;3\n",
            "# rig\nphi\tTE\troot\n[deg]\t[µm]\t[µm/m]\n0\t1.5\t2\n1\t2.5\t3\n",
            "\u{feff}phi / deg,TE / µm,root [µm/m]\r\n0,1.5,2\r\n1,2.5,3\r\n",
        ];
        for text in same {
            let found = csv_channels(text, None).unwrap();
            let units: Vec<_> = found.iter().map(|c| (&*c.name, &*c.unit)).collect();
            assert_eq!(units, [("TE", "µm"), ("root", "µm/m")], "{text}");
            assert_eq!((&*found[0].axis, &*found[0].axis_unit), ("phi", "deg"));
            assert_eq!(
                (&found[0].x[..], &found[0].y[..]),
                (&[0.0, 1.0][..], &[1.5, 2.5][..])
            );
        }
        let found = csv_channels("angle_deg,te_um,note_x\n0,1,2\n", None).unwrap();
        let heads: Vec<_> = found.iter().map(|c| (&*c.name, &*c.unit)).collect();
        assert_eq!(heads, [("te", "um"), ("note_x", "")]);
    }

    #[test]
    fn the_axis_may_be_another_column() {
        let text = "t [s],phi [rad],TE [mm]\n0,0,1\n1,0.5,2\n";
        let found = csv_channels(text, Some("phi")).unwrap();
        assert_eq!(found[1].x, [0.0, 0.5]);
        assert_eq!((&*found[0].name, &*found[1].axis_unit), ("t", "rad"));
        let message = csv_channels(text, Some("ph")).unwrap_err().to_string();
        assert!(message.contains("did you mean `phi`"), "{message}");
    }

    #[test]
    fn what_is_no_table_is_told_with_its_line() {
        let refused = |text: &str| csv_channels(text, None).unwrap_err().to_string();
        assert!(refused("a,b\n1,2\n1\n").starts_with("3: 1 fields"));
        assert!(refused("a,b\n1,2\n1,x\n").starts_with("3: `x` under `b`"));
        assert!(refused("a,b\ndeg,um\n").contains("no line of numbers"));
        assert!(refused("").contains("no line"));
        assert!(refused("a\n1\n").starts_with("1: one column"));
    }
}
