//! A reference record: a folder with `record.toml` (what it is) and `data.csv` (the columns). For users:
//! docs/records.md.
//!
//! `record.toml` needs `title`, `kind` ("computed" or "measured"), `source` and `angle_origin`; it may have `method`,
//! `command`, `date`, `shaft` ("gear_1" or "gear_2": of which shaft the angle is), `revolutions`, `[columns]` (column
//! of `data.csv` = column of a multibody result) and a table `[uncertainty]` with `te_mean_um`, `te_peak_to_peak_um`
//! and `strain_range_ustrain`. Further keys describe the record for people and are not read. `data.csv` is described at
//! [`crate::record::ReferenceRecord`].

use crate::pair_orders::Shaft;
use crate::quantity::{Quantity, Unit};
use crate::record_data::{DataError, parse_data};
use gearmesh_geometry::input::{MOST_TEXT_BYTES, UnreadableFile, read_bytes};
use gearmesh_signal::{AngleSeries, AngleSeriesError, ShaftPeriod};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use toml::Spanned;

pub use crate::record_data::RecordColumn;

/// Most revolutions of a record: the rig's 5000 pulses a turn fill the memory beyond.
const MOST_REVOLUTIONS: usize = 1000;

/// Why a reference record cannot be read.
#[derive(Debug, thiserror::Error)]
pub enum RecordError {
    /// The file could not be opened or read.
    #[error("{}: {source}; a record is a folder with record.toml and data.csv", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// Why.
        source: UnreadableFile,
    },
    /// `record.toml` is no TOML, lacks a key, or has a value of the wrong kind.
    #[error("{}:{line}:{column}: {message}", path.display())]
    Toml {
        /// The file.
        path: PathBuf,
        /// Line, from 1.
        line: usize,
        /// Character of the line, from 1.
        column: usize,
        /// What was found and what is allowed.
        message: String,
    },
    /// `data.csv` is no table of the stated columns.
    #[error("{}:{source}", path.display())]
    Data {
        /// The file.
        path: PathBuf,
        /// Line, column and what is wrong there.
        source: DataError,
    },
}

/// Where the numbers of a record come from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum RecordKind {
    /// By another program or method; never called a measurement.
    Computed,
    /// On a test rig.
    Measured,
}

impl std::fmt::Display for RecordKind {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Computed => "computed",
            Self::Measured => "measured",
        })
    }
}

/// Stated uncertainties of a record, SI units; `None` where the record states none.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize)]
pub struct RecordUncertainty {
    /// Of the mean transmission error, m.
    pub te_mean_m: Option<f64>,
    /// Of the peak-to-peak transmission error, m.
    pub te_peak_to_peak_m: Option<f64>,
    /// Of the strain range (largest minus smallest strain), dimensionless.
    pub strain_range: Option<f64>,
}

impl RecordUncertainty {
    /// Uncertainty of the mean of a quantity, SI units.
    pub fn mean(&self, quantity: &Quantity) -> Option<f64> {
        match quantity {
            Quantity::TransmissionError => self.te_mean_m,
            Quantity::Strain { .. } => None,
        }
    }

    /// Uncertainty of the peak-to-peak value of a quantity, SI units.
    pub fn peak_to_peak(&self, quantity: &Quantity) -> Option<f64> {
        match quantity {
            Quantity::TransmissionError => self.te_peak_to_peak_m,
            Quantity::Strain { .. } => self.strain_range,
        }
    }
}

/// A reference record.
///
/// `data.csv`: comma separated, `.` as the decimal sign, first line the heads; lines that begin with `#` and blank
/// lines are skipped. First column `angle_deg`, the angle of the record's shaft, increasing, over its revolutions. The
/// others are `te_um_<T>Nm` and `strain_<gauge>_ustrain_<T>Nm` in any order, T the torque on the driven gear as a
/// decimal number.
#[derive(Debug, Clone, PartialEq)]
pub struct ReferenceRecord {
    /// The folder it was read from.
    pub folder: PathBuf,
    /// Title.
    pub title: String,
    /// Computed or measured.
    pub kind: RecordKind,
    /// Where the numbers come from.
    pub source: String,
    /// What angle 0 is.
    pub angle_origin: String,
    /// Shaft whose angle stands in `data.csv`, positive in its own sense of turning.
    pub shaft: Shaft,
    /// Revolutions of that shaft after which the record repeats.
    pub revolutions: usize,
    /// Columns of a multibody result by the names of this record's columns.
    pub multibody_columns: BTreeMap<String, String>,
    /// How the numbers were made, if stated.
    pub method: Option<String>,
    /// The command that makes them, if stated.
    pub command: Option<String>,
    /// When, as written, if stated.
    pub date: Option<String>,
    /// Stated uncertainties.
    pub uncertainty: RecordUncertainty,
    /// Angle of the shaft, rad, strictly increasing, spanning less than its revolutions or closing them.
    pub angle_rad: Vec<f64>,
    /// The columns in the order of the file.
    pub columns: Vec<RecordColumn>,
}

impl ReferenceRecord {
    /// Reads the record in a folder.
    ///
    /// # Errors
    /// [`RecordError`]: the file, the line and column in it, what was found and what is allowed.
    pub fn read(folder: &Path) -> Result<Self, RecordError> {
        let toml_path = folder.join("record.toml");
        let data_path = folder.join("data.csv");
        let description = parse_description(&read_text(&toml_path)?);
        let description = description.map_err(|problem| problem.in_file(&toml_path))?;
        let revolutions = description.revolutions();
        let data = parse_data(&record_bytes(&data_path)?, revolutions);
        let path = data_path;
        let data = data.map_err(|source| RecordError::Data { path, source })?;
        Ok(Self {
            folder: folder.to_path_buf(),
            title: description.title,
            kind: description.kind,
            source: description.source,
            angle_origin: description.angle_origin,
            shaft: description.shaft,
            revolutions,
            multibody_columns: description.columns,
            method: description.method,
            command: description.command,
            date: description.date.map(|date| match date {
                toml::Value::String(text) => text,
                date => date.to_string(),
            }),
            uncertainty: description.uncertainty.in_si(),
            angle_rad: data.angle_rad,
            columns: data.columns,
        })
    }

    /// The column of a quantity at a torque (met to 1e-9 relative).
    pub fn column(&self, quantity: &Quantity, torque_nm: f64) -> Option<&RecordColumn> {
        self.columns.iter().find(|c| {
            c.quantity == *quantity && (c.torque_nm - torque_nm).abs() <= 1e-9 * torque_nm.abs()
        })
    }

    /// A column as a periodic series over the revolutions of its shaft.
    ///
    /// # Errors
    /// [`AngleSeriesError`], where the angles do not cover the revolutions.
    pub fn series(&self, column: &RecordColumn) -> Result<AngleSeries, AngleSeriesError> {
        AngleSeries::new(&self.angle_rad, &column.values, self.period())
    }

    /// What the record repeats after.
    pub fn period(&self) -> ShaftPeriod {
        ShaftPeriod::revolutions(self.revolutions)
    }
}

fn record_bytes(path: &Path) -> Result<Vec<u8>, RecordError> {
    read_bytes(path, MOST_TEXT_BYTES).map_err(|source| RecordError::Io {
        path: path.to_path_buf(),
        source,
    })
}

fn read_text(path: &Path) -> Result<String, RecordError> {
    String::from_utf8(record_bytes(path)?).map_err(|e| {
        let before = &e.as_bytes()[..e.utf8_error().valid_up_to()];
        let message = "the file is not UTF-8 text; save it as UTF-8".to_owned();
        TomlProblem::at(&String::from_utf8_lossy(before), before.len(), message).in_file(path)
    })
}

/// The keys of record.toml that are read; others are for people.
#[derive(Deserialize)]
struct Description {
    title: String,
    kind: RecordKind,
    source: String,
    angle_origin: String,
    method: Option<String>,
    command: Option<String>,
    /// A TOML date or a string.
    date: Option<toml::Value>,
    #[serde(default)]
    shaft: Shaft,
    revolutions: Option<Spanned<usize>>,
    #[serde(default)]
    columns: BTreeMap<String, String>,
    #[serde(default)]
    uncertainty: UncertaintyTable,
}

impl Description {
    fn revolutions(&self) -> usize {
        self.revolutions.as_ref().map_or(1, |r| *r.get_ref())
    }
}

#[derive(Deserialize, Default)]
struct UncertaintyTable {
    te_mean_um: Option<Spanned<f64>>,
    te_peak_to_peak_um: Option<Spanned<f64>>,
    strain_range_ustrain: Option<Spanned<f64>>,
}

impl UncertaintyTable {
    fn in_si(&self) -> RecordUncertainty {
        let si = |value: &Option<Spanned<f64>>, unit: Unit| {
            value.as_ref().map(|v| v.get_ref() / unit.per_si)
        };
        RecordUncertainty {
            te_mean_m: si(&self.te_mean_um, Unit::MICROMETRE),
            te_peak_to_peak_m: si(&self.te_peak_to_peak_um, Unit::MICROMETRE),
            strain_range: si(&self.strain_range_ustrain, Unit::MICROSTRAIN),
        }
    }
}

struct TomlProblem {
    line: usize,
    column: usize,
    message: String,
}

impl TomlProblem {
    /// At a byte of a text.
    fn at(text: &str, byte: usize, message: String) -> Self {
        let (line, column) = line_and_column(text, byte);
        Self {
            line,
            column,
            message,
        }
    }

    fn in_file(self, path: &Path) -> RecordError {
        RecordError::Toml {
            path: path.to_path_buf(),
            line: self.line,
            column: self.column,
            message: self.message,
        }
    }
}

fn parse_description(text: &str) -> Result<Description, TomlProblem> {
    let description: Description = toml::from_str(text).map_err(|e| {
        let message = e.message().trim().replace('\n', "; ");
        TomlProblem::at(text, e.span().map_or(0, |span| span.start), message)
    })?;
    if let Some(revolutions) = &description.revolutions
        && !(1..=MOST_REVOLUTIONS).contains(revolutions.get_ref())
    {
        let message = format!(
            "revolutions = {}; allowed is 1 to {MOST_REVOLUTIONS}",
            revolutions.get_ref()
        );
        return Err(TomlProblem::at(text, revolutions.span().start, message));
    }
    let u = &description.uncertainty;
    let named = [
        ("te_mean_um", &u.te_mean_um),
        ("te_peak_to_peak_um", &u.te_peak_to_peak_um),
        ("strain_range_ustrain", &u.strain_range_ustrain),
    ];
    for (key, value) in named {
        let Some(value) = value else { continue };
        if !(value.get_ref().is_finite() && *value.get_ref() >= 0.0) {
            let message = format!(
                "uncertainty.{key} = {}; it must be a finite number, 0 or more",
                value.get_ref()
            );
            return Err(TomlProblem::at(text, value.span().start, message));
        }
    }
    Ok(description)
}

/// Line and character of the line, both from 1, of a byte of the text.
fn line_and_column(text: &str, byte: usize) -> (usize, usize) {
    let before: String = text
        .char_indices()
        .take_while(|(at, _)| *at < byte)
        .map(|(_, c)| c)
        .collect();
    let line = before.matches('\n').count() + 1;
    let column = before
        .rsplit('\n')
        .next()
        .map_or(0, |last| last.chars().count())
        + 1;
    (line, column)
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const TOML: &str = "title = \"T\"\nkind = \"computed\"\nsource = \"another program\"\nangle_origin = \"pitch point\"\n\
                        date = 2026-01-02\nperiodicity = \"whole\"\n[uncertainty]\nte_mean_um = 0.05\nhow = \"two meshes\"\n";

    fn record(toml: &str, csv: &[u8]) -> Result<ReferenceRecord, RecordError> {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("record.toml"), toml).unwrap();
        std::fs::write(folder.path().join("data.csv"), csv).unwrap();
        ReferenceRecord::read(folder.path())
    }

    fn csv() -> String {
        let mut text = String::from("angle_deg,te_um_50Nm,strain_t0_tension_ustrain_12.5Nm\n");
        for i in 0..36 {
            text += &format!("{},{},{}\n", 10 * i, -20 - i % 2, i);
        }
        text
    }

    #[test]
    fn a_record_is_read_into_si_units() {
        let record = record(TOML, csv().as_bytes()).unwrap();
        assert_eq!(
            (record.title.as_str(), record.kind),
            ("T", RecordKind::Computed)
        );
        assert_eq!(record.date.as_deref(), Some("2026-01-02"));
        assert!((record.uncertainty.te_mean_m.unwrap() - 5e-8).abs() < 1e-20);
        assert_eq!(record.uncertainty.strain_range, None);
        let te = record.column(&Quantity::TransmissionError, 50.0).unwrap();
        assert!((te.values[1] + 21e-6).abs() < 1e-18);
        let strain = record
            .column(
                &Quantity::Strain {
                    gauge: "t0_tension".into(),
                },
                12.5,
            )
            .unwrap();
        assert!((strain.values[35] - 35e-6).abs() < 1e-18);
        assert!((record.angle_rad[18] - std::f64::consts::PI).abs() < 1e-12);
        assert!(record.series(te).is_ok());
        assert!(record.column(&Quantity::TransmissionError, 60.0).is_none());
    }

    #[test]
    fn toml_errors_name_line_column_and_what_is_allowed() {
        let message = |toml: &str| record(toml, csv().as_bytes()).unwrap_err().to_string();
        let kind = message(&TOML.replace("computed", "guessed"));
        assert!(
            kind.contains("record.toml:2:8")
                && kind.contains("guessed")
                && kind.contains("measured"),
            "{kind}"
        );
        let missing = message(&TOML.replace("source", "sauce"));
        assert!(missing.contains("missing field `source`"), "{missing}");
        let negative = message(&TOML.replace("0.05", "-0.05"));
        assert!(
            negative.contains("record.toml:8:14") && negative.contains("0 or more"),
            "{negative}"
        );
        let broken = message("title = ");
        assert!(broken.contains("record.toml:1:"), "{broken}");
    }

    #[test]
    fn a_folder_without_files_is_an_io_error_that_names_the_file() {
        let folder = tempfile::tempdir().unwrap();
        let message = ReferenceRecord::read(folder.path())
            .unwrap_err()
            .to_string();
        assert!(message.contains("record.toml"), "{message}");
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]

        #[test]
        fn garbage_never_panics(toml in any::<Vec<u8>>(), csv in any::<Vec<u8>>()) {
            let folder = tempfile::tempdir().unwrap();
            std::fs::write(folder.path().join("record.toml"), toml).unwrap();
            std::fs::write(folder.path().join("data.csv"), csv).unwrap();
            prop_assert!(ReferenceRecord::read(folder.path()).is_err());
        }

        #[test]
        fn a_damaged_description_is_read_or_refused(at in 0usize..200, byte in any::<char>()) {
            let mut text: Vec<char> = TOML.chars().collect();
            let at = at % text.len();
            text[at] = byte;
            let text: String = text.into_iter().collect();
            if let Err(error) = record(&text, csv().as_bytes()) {
                let in_toml = matches!(error, RecordError::Toml { .. });
                prop_assert!(in_toml, "{}", error);
            }
        }
    }
}
