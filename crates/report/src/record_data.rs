//! `data.csv` of a reference record: heads, numbers, and errors that name the place.

use crate::quantity::Quantity;
use gearmesh_geometry::input::{CsvRows, shown_field};

/// The heads that are understood, for error messages.
const ALLOWED_HEADS: &str = "te_um_<T>Nm or strain_<gauge>_ustrain_<T>Nm, for example te_um_50Nm or strain_t0_tension_ustrain_50Nm";

/// Why `data.csv` is refused. Lines and columns count from 1; a column is a field between commas.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum DataError {
    /// Bytes that are no UTF-8.
    #[error("{line}: bytes that are no UTF-8 text; save the file as UTF-8")]
    NotUtf8 {
        /// Line of the first bad byte.
        line: usize,
    },
    /// No head line.
    #[error("1: the file has no head line; the first line is angle_deg,{ALLOWED_HEADS}")]
    NoHead,
    /// The first column is not the angle.
    #[error(
        "{line}: column 1 is not angle_deg, the angle of the record's shaft; is it another file?"
    )]
    FirstColumn {
        /// Line of the heads.
        line: usize,
    },
    /// A head that is not understood.
    #[error("{line}: column {column} is '{found}'; allowed is {ALLOWED_HEADS}")]
    Head {
        /// Line of the heads.
        line: usize,
        /// Column.
        column: usize,
        /// Head found.
        found: String,
    },
    /// The same quantity and torque twice.
    #[error(
        "{line}: column {column} '{found}' repeats column {earlier}; every quantity may occur once at each torque"
    )]
    RepeatedHead {
        /// Line of the heads.
        line: usize,
        /// Column.
        column: usize,
        /// Head found.
        found: String,
        /// The column that it repeats.
        earlier: usize,
    },
    /// Only the angle.
    #[error("{line}: no column beside angle_deg; allowed is {ALLOWED_HEADS}")]
    NoColumns {
        /// Line of the heads.
        line: usize,
    },
    /// A line with too few or too many fields.
    #[error("{line}: {found} fields; the head has {expected}")]
    FieldCount {
        /// Line.
        line: usize,
        /// Fields found.
        found: usize,
        /// Fields of the head.
        expected: usize,
    },
    /// A field that is no finite number.
    #[error(
        "{line}: column {column} ({head}) is '{found}'; allowed is a finite decimal number such as -12.5 or 3e-2"
    )]
    Number {
        /// Line.
        line: usize,
        /// Column.
        column: usize,
        /// Head of the column.
        head: String,
        /// The field.
        found: String,
    },
    /// Angles that do not increase.
    #[error("{line}: angle {found_deg} deg after {before_deg} deg; the angles must increase")]
    AngleOrder {
        /// Line.
        line: usize,
        /// Angle found, degrees.
        found_deg: f64,
        /// Angle of the line before, degrees.
        before_deg: f64,
    },
    /// More revolutions than stated.
    #[error(
        "{line}: angle {found_deg} deg is more than {} deg after the first, {first_deg} deg; record.toml says revolutions = {revolutions} (1 where not given)",
        360.0 * *.revolutions as f64
    )]
    MoreRevolutions {
        /// Line.
        line: usize,
        /// Angle found, degrees.
        found_deg: f64,
        /// First angle, degrees.
        first_deg: f64,
        /// Revolutions stated.
        revolutions: usize,
    },
    /// A head without numbers.
    #[error("{line}: no line of numbers follows the head")]
    NoRows {
        /// Line of the heads.
        line: usize,
    },
}

/// One quantity at one torque.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordColumn {
    /// Name in the head of `data.csv`.
    pub name: String,
    /// What it holds.
    pub quantity: Quantity,
    /// Torque on the driven gear, N·m.
    pub torque_nm: f64,
    /// Values in SI units (m; strain dimensionless), one for each angle.
    pub values: Vec<f64>,
}

/// The parsed table, SI units.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Data {
    pub(crate) angle_rad: Vec<f64>,
    pub(crate) columns: Vec<RecordColumn>,
}

/// Parses the bytes of a `data.csv` that goes over so many revolutions.
pub(crate) fn parse_data(bytes: &[u8], revolutions: usize) -> Result<Data, DataError> {
    let text = std::str::from_utf8(bytes).map_err(|e| DataError::NotUtf8 {
        line: bytes[..e.valid_up_to()]
            .iter()
            .filter(|b| **b == b'\n')
            .count()
            + 1,
    })?;
    let mut rows = CsvRows::new(text);
    let (head_line, heads) = rows.next().ok_or(DataError::NoHead)?;
    let heads: Vec<&str> = heads.iter().collect();
    let mut columns = parse_heads(head_line, &heads)?;

    let mut angle_deg: Vec<f64> = Vec::new();
    for (line, fields) in rows {
        if fields.len() != heads.len() {
            return Err(DataError::FieldCount {
                line,
                found: fields.len(),
                expected: heads.len(),
            });
        }
        let angle = number(line, 0, &heads, &fields[0])?;
        check_angle(line, angle, &angle_deg, revolutions)?;
        angle_deg.push(angle);
        for (i, column) in columns.iter_mut().enumerate() {
            column
                .values
                .push(number(line, i + 1, &heads, &fields[i + 1])? / column.quantity.unit().per_si);
        }
    }
    if angle_deg.is_empty() {
        return Err(DataError::NoRows { line: head_line });
    }
    Ok(Data {
        angle_rad: angle_deg.into_iter().map(f64::to_radians).collect(),
        columns,
    })
}

fn parse_heads(line: usize, heads: &[&str]) -> Result<Vec<RecordColumn>, DataError> {
    if heads[0] != "angle_deg" {
        return Err(DataError::FirstColumn { line });
    }
    let mut columns: Vec<RecordColumn> = Vec::new();
    for (i, head) in heads.iter().enumerate().skip(1) {
        let (column, found) = (i + 1, shown_field(head));
        let Some((quantity, torque_nm)) = parse_head(head) else {
            return Err(DataError::Head {
                line,
                column,
                found,
            });
        };
        let repeats =
            |c: &RecordColumn| c.quantity == quantity && c.torque_nm.total_cmp(&torque_nm).is_eq();
        if let Some(earlier) = columns.iter().position(repeats) {
            return Err(DataError::RepeatedHead {
                line,
                column,
                found,
                earlier: earlier + 2,
            });
        }
        columns.push(RecordColumn {
            name: (*head).to_string(),
            quantity,
            torque_nm,
            values: Vec::new(),
        });
    }
    if columns.is_empty() {
        Err(DataError::NoColumns { line })
    } else {
        Ok(columns)
    }
}

/// `te_um_<T>Nm` or `strain_<gauge>_ustrain_<T>Nm`.
pub(crate) fn parse_head(head: &str) -> Option<(Quantity, f64)> {
    let (name, torque) = head.strip_suffix("Nm")?.rsplit_once('_')?;
    let plain = torque.bytes().all(|b| b.is_ascii_digit() || b == b'.');
    let torque_nm = torque
        .parse::<f64>()
        .ok()
        .filter(|t| plain && t.is_finite())?;
    if name == "te_um" {
        return Some((Quantity::TransmissionError, torque_nm));
    }
    let gauge = name.strip_prefix("strain_")?.strip_suffix("_ustrain")?;
    let valid = !gauge.is_empty()
        && gauge
            .bytes()
            .all(|b| b.is_ascii_alphanumeric() || b == b'_' || b == b'-');
    valid.then(|| {
        (
            Quantity::Strain {
                gauge: gauge.to_string(),
            },
            torque_nm,
        )
    })
}

fn number(line: usize, index: usize, heads: &[&str], field: &str) -> Result<f64, DataError> {
    field
        .parse::<f64>()
        .ok()
        .filter(|v| v.is_finite())
        .ok_or_else(|| DataError::Number {
            line,
            column: index + 1,
            head: heads[index].to_string(),
            found: shown_field(field),
        })
}

fn check_angle(
    line: usize,
    found_deg: f64,
    before: &[f64],
    revolutions: usize,
) -> Result<(), DataError> {
    let (Some(&first_deg), Some(&before_deg)) = (before.first(), before.last()) else {
        return Ok(());
    };
    if found_deg <= before_deg {
        return Err(DataError::AngleOrder {
            line,
            found_deg,
            before_deg,
        });
    }
    // The angles are decimal numbers: 360 written with few digits still closes the revolution.
    if found_deg - first_deg > 360.0 * revolutions as f64 * (1.0 + 1e-6) {
        return Err(DataError::MoreRevolutions {
            line,
            found_deg,
            first_deg,
            revolutions,
        });
    }
    Ok(())
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn refused(text: &str) -> String {
        parse_data(text.as_bytes(), 1).unwrap_err().to_string()
    }

    #[test]
    fn comments_blank_lines_crlf_and_byte_order_mark_are_skipped() {
        let data = parse_data(
            "\u{feff}# made by\r\nangle_deg, te_um_50Nm\r\n\r\n0, 1\r\n1, 2\r\n".as_bytes(),
            1,
        )
        .unwrap();
        assert_eq!(data.angle_rad.len(), 2);
        assert_eq!(data.columns[0].values, [1e-6, 2e-6]);
    }

    #[test]
    fn errors_name_line_column_found_and_allowed() {
        assert!(refused("").contains("no head"));
        assert!(refused("angle,te_um_50Nm\n").starts_with("1: column 1 is not angle_deg"));
        assert!(
            refused("# x\nangle_deg,te_mm_50Nm\n")
                .starts_with("2: column 2 is 'te_mm_50Nm'; allowed")
        );
        assert!(refused("angle_deg,te_um_5e1Nm\n").contains("'te_um_5e1Nm'"));
        assert!(refused("angle_deg,strain__ustrain_5Nm\n").contains("allowed"));
        assert!(refused("angle_deg\n0\n").contains("no column beside"));
        assert!(
            refused("angle_deg,te_um_50Nm,te_um_50.0Nm\n")
                .contains("column 3 'te_um_50.0Nm' repeats column 2")
        );
        assert!(refused("angle_deg,te_um_50Nm\n").contains("no line of numbers"));
        assert!(
            refused("angle_deg,te_um_50Nm\n0,1\n1,2,3\n")
                .starts_with("3: 3 fields; the head has 2")
        );
        assert!(
            refused("angle_deg,te_um_50Nm\n0,1\n1,x\n")
                .starts_with("3: column 2 (te_um_50Nm) is 'x'")
        );
        assert!(refused("angle_deg,te_um_50Nm\n0,inf\n").contains("finite"));
        assert!(
            refused("angle_deg,te_um_50Nm\n0,1\n0,1\n").starts_with("3: angle 0 deg after 0 deg")
        );
        assert!(refused("angle_deg,te_um_50Nm\n0,1\n361,1\n").contains("more than 360"));
        assert!(
            parse_data(b"angle_deg,te_um_5Nm\n0,\xff\n", 1)
                .unwrap_err()
                .to_string()
                .starts_with("2: bytes")
        );
    }

    proptest! {
        #[test]
        fn text_like_garbage_never_panics(text in "[ae0-9.,#\\-\n_NmtuS]{0,200}") {
            let _ = parse_data(text.as_bytes(), 1);
            let _ = parse_data(format!("angle_deg,te_um_5Nm\n{text}").as_bytes(), 1);
        }

        #[test]
        fn numbers_survive_the_file(values in prop::collection::vec(-1e3..1e3f64, 1..50)) {
            let mut text = String::from("angle_deg,te_um_5Nm\n");
            for (i, v) in values.iter().enumerate() {
                text += &format!("{i},{v}\n");
            }
            let data = parse_data(text.as_bytes(), 1).unwrap();
            let expected: Vec<f64> = values.iter().map(|v| v / 1e6).collect();
            prop_assert_eq!(&data.columns[0].values, &expected);
        }
    }
}
