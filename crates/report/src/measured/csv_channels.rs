//! Channels of a CSV file as measuring programs write them: units in the heads or in a line of their own; comma,
//! semicolon or tab between the fields; a decimal comma where no comma separates them.

use super::unit::is_known;
use super::{Channel, MeasuredError};
use gearmesh_geometry::input::shown_field;

/// Text of a measuring program's file: UTF-8, UTF-16 with a byte order mark, or else Latin-1; the latter two are named.
pub fn decoded(bytes: Vec<u8>) -> (String, Option<&'static str>) {
    let utf16 = |read: fn([u8; 2]) -> u16| {
        let pairs = bytes[2..].chunks_exact(2);
        let units = pairs.map(|pair| read([pair[0], pair[1]]));
        String::from_utf16_lossy(&units.collect::<Vec<_>>())
    };
    match bytes[..] {
        [0xff, 0xfe, ..] => (utf16(u16::from_le_bytes), Some("UTF-16")),
        [0xfe, 0xff, ..] => (utf16(u16::from_be_bytes), Some("UTF-16")),
        _ => match String::from_utf8(bytes) {
            Ok(text) => (text, None),
            Err(error) => {
                let bytes = error.as_bytes().iter();
                (
                    bytes.map(|&byte| char::from(byte)).collect(),
                    Some("Latin-1"),
                )
            }
        },
    }
}

/// The channels over the first column, or over the one called `axis`. Lines before the heads, as measuring programs
/// write them, are passed over.
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
    let mut rows: Vec<(u64, Vec<String>)> = Vec::new();
    for row in reader.records() {
        let row = row.map_err(|error| wrong(0, error.to_string()))?;
        let line = row.position().map_or(0, csv::Position::line);
        rows.push((line, row.iter().map(str::to_owned).collect()));
    }
    let (mut heads, first) = heads_of(&rows, delimiter)?;
    // Spreadsheets leave columns of nothing at the end.
    let is_bare = |at: usize| {
        let below = rows[first..].iter().map(|(_, row)| row.get(at));
        below.flatten().all(String::is_empty)
    };
    while heads.len() > 1
        && heads.last().is_some_and(|(name, _)| name.is_empty())
        && is_bare(heads.len() - 1)
    {
        heads.pop();
    }
    let mut columns: Vec<Vec<f64>> = vec![Vec::new(); heads.len()];
    for (line, row) in &rows[first..] {
        let beyond = row.get(heads.len()..).unwrap_or_default();
        if row.len() < heads.len() || beyond.iter().any(|field| !field.is_empty()) {
            let problem = format!("{} fields; the heads are {}", row.len(), heads.len());
            return Err(wrong(*line, problem));
        }
        for ((field, column), (head, _)) in row.iter().zip(&mut columns).zip(&heads) {
            let value = number(field, delimiter).ok_or_else(|| {
                let problem = format!("`{}` under `{head}` is no number", shown_field(field));
                wrong(*line, problem)
            })?;
            column.push(value);
        }
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

/// Heads with their units, and the first row of numbers: the first one with an axis and a channel. The heads are the
/// row before it, or the one before that where units stand between; where there is none, columns have numbers for
/// names.
fn heads_of(
    rows: &[(u64, Vec<String>)],
    delimiter: u8,
) -> Result<(Vec<(String, String)>, usize), MeasuredError> {
    let wrong = |line: u64, problem: &str| MeasuredError::Table {
        line,
        problem: problem.to_owned(),
    };
    let is_number = |field: &String| parsed(field, delimiter).is_some();
    let of_numbers = |row: &[String]| {
        let mut filled = row.iter().filter(|field| !field.is_empty()).peekable();
        filled.peek().is_some() && filled.all(is_number)
    };
    let counts = |row: &[String]| row.iter().filter(|field| !field.is_empty()).count();
    let found = rows.iter().position(|(_, row)| of_numbers(row));
    let Some(first) = found else {
        return Err(no_numbers(rows, delimiter));
    };
    let (line, row) = &rows[first];
    if counts(row) < 2 {
        let one = rows.first().map_or(*line, |(line, _)| *line);
        return Err(wrong(one, "one column; an axis and a channel are needed"));
    }
    let alike = |back: usize| -> Option<&Vec<String>> {
        let (_, above) = rows.get(first.checked_sub(back)?)?;
        (above.len() == row.len()).then_some(above)
    };
    let units = |above: &[String]| above.iter().any(|field| is_known(unbracketed(field)));
    let heads = match (alike(1), alike(2)) {
        (Some(below), Some(above)) if units(below) => {
            let pairs = above.iter().zip(below);
            pairs
                .map(|(head, unit)| (head.clone(), unbracketed(unit).to_owned()))
                .collect()
        }
        (Some(above), _) => above.iter().map(|head| head_and_unit(head)).collect(),
        (None, _) if first > 0 => {
            let above = rows[first - 1].1.len();
            let problem = format!("{} fields; the heads are {above}", row.len());
            return Err(wrong(*line, &problem));
        }
        (None, _) => (1..=row.len())
            .map(|i| (format!("column {i}"), String::new()))
            .collect(),
    };
    Ok((heads, first))
}

/// Why no row is one of numbers, by the first row that begins with one.
fn no_numbers(rows: &[(u64, Vec<String>)], delimiter: u8) -> MeasuredError {
    let wrong = |line: u64, problem: String| MeasuredError::Table { line, problem };
    let begins = |field: &&String| field.starts_with(|c: char| c.is_ascii_digit());
    let found = rows
        .iter()
        .find(|(_, row)| row.iter().take(1).any(|f| begins(&f)));
    let Some((line, row)) = found else {
        return wrong(1, "no line of numbers".to_owned());
    };
    let sign = match delimiter {
        b'\t' => "tabs",
        b';' => "semicolons",
        _ => "commas",
    };
    let bad = row
        .iter()
        .find(|f| !f.is_empty() && parsed(f, delimiter).is_none());
    let bad = shown_field(bad.map_or("", String::as_str));
    let hint = if bad.contains(char::is_whitespace) {
        "; put commas, semicolons or tabs in place of blanks"
    } else if bad.contains(['.', ',']) {
        "; thousands are not separated, the decimal sign is a point or a comma, and a comma separates no fields where it is the decimal sign"
    } else {
        ""
    };
    wrong(
        *line,
        format!("no line of numbers: with fields between {sign} `{bad}` is no number{hint}"),
    )
}

/// What separates the numbers: tabs, else semicolons, else commas; as in the first line that begins with a number, or
/// the last line.
fn delimiter_of(text: &str) -> u8 {
    let begins = |line: &&str| {
        let line = line.trim_start_matches(['"', ' ', '+', '-']);
        line.starts_with(|c: char| c.is_ascii_digit() || c == '.')
    };
    let lines = || text.lines().filter(|line| !line.starts_with('#'));
    let numbers = lines().find(begins).or_else(|| lines().next_back());
    let line = numbers.unwrap_or("");
    let all = [b'\t', b';', b','];
    let found = all.into_iter().find(|&d| line.contains(char::from(d)));
    found.unwrap_or(b',')
}

/// A number, finite or not.
fn parsed(field: &str, delimiter: u8) -> Option<f64> {
    let parsed = if delimiter == b',' {
        field.parse()
    } else {
        field.replace(',', ".").parse()
    };
    parsed.ok()
}

fn number(field: &str, delimiter: u8) -> Option<f64> {
    parsed(field, delimiter).filter(|value| value.is_finite())
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
    fn lines_of_the_measuring_program_are_passed_over() {
        let same = [
            "sep=;\nphi [deg];TE [µm]\n0;1,5\n1;2,5\n",
            "Rig 3;12.05.2026\nOperator;M. Muster;night\n\nphi [deg];TE [µm]\n0;1,5\n1;2,5\n",
            "phi [deg];TE [µm];;\n0;1,5;;\n1;2,5;;\n",
            "Rig 3, drilled wheel\nphi\tTE\ndeg\tµm\n0\t1,5\n1\t2,5\n",
        ];
        for text in same {
            let found = csv_channels(text, None).unwrap();
            assert_eq!(found.len(), 1, "{text}");
            assert_eq!((&*found[0].name, &*found[0].unit), ("TE", "µm"), "{text}");
            assert_eq!((&*found[0].axis, &*found[0].axis_unit), ("phi", "deg"));
            assert_eq!(found[0].y, [1.5, 2.5], "{text}");
        }
        let bare = csv_channels("0,1.5\n1,2.5\n", None).unwrap();
        assert_eq!((&*bare[0].name, &*bare[0].axis), ("column 2", "column 1"));
        assert_eq!(bare[0].y, [1.5, 2.5]);
    }

    #[test]
    fn text_of_windows_programs_is_read() {
        let text = "phi [°];TE [µm]\n0;1,5\n";
        let latin: Vec<u8> = text.chars().map(|c| c as u8).collect();
        let wide = text.encode_utf16().flat_map(u16::to_le_bytes);
        let wide: Vec<u8> = [0xff, 0xfe].into_iter().chain(wide).collect();
        assert_eq!(decoded(text.into()), (text.to_owned(), None));
        assert_eq!(decoded(latin), (text.to_owned(), Some("Latin-1")));
        assert_eq!(decoded(wide), (text.to_owned(), Some("UTF-16")));
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
        let thousands = refused("phi;te\n0;1.234,5\n");
        assert!(
            thousands.starts_with("2: ") && thousands.contains("`1.234,5`"),
            "{thousands}"
        );
        assert!(refused("phi te\n0 1.5\n1 2.5\n").contains("blanks"));
        assert!(refused("phi,te\n0,\"1,5\"\n").contains("decimal"));
        assert!(refused("a\n1\n").starts_with("1: one column"));
    }
}
