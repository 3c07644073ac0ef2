//! The result of a multibody scene as a file: written by the runs, read for reports. Layout: docs/results.md.

use std::path::Path;

use gearmesh_dynamics::NaturalMode;
use gearmesh_model::{
    Column, ColumnFile, DataTree, FileError, FileFormat, ListedField, RowLog, list_record,
    read_record, utc_now, write_columns, write_record,
};

use super::column_names::{unit_in_name, varying};
use super::column_statistics::Figures;
use super::job::{EigenPoint, RunHead};
use super::low_pass::{GROUP, LOW_PASS_BAND};
use super::result_kind::ResultKind;
use super::result_record::{Contents, STATED_UNITS};
use super::run_record::RunRecord;
use super::speed_plan::Window;
use super::stages::StageLoad;
use crate::rating::RatingResult;

/// Name and version of the result file.
pub const SYSTEM_RESULT_FORMAT: FileFormat = FileFormat {
    name: "gearmesh-system-result",
    // 2: units and descriptions of all channels
    version: 2,
};

/// Share of a column's deviation above which what is folded is reported.
pub const FOLDED_SHARE: f64 = 1e-3;

/// Natural modes at one operating point.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct EigenResult {
    /// The point.
    pub point: EigenPoint,
    /// The modes, by rising frequency.
    pub modes: Vec<NaturalMode>,
    /// Share of each body in the kinetic energy of each mode, `[mode][body]`.
    pub participation: Vec<Vec<f64>>,
    /// Share of each force element in the strain energy of each mode, `[mode][element]`; empty in files of older
    /// programs.
    pub strain: Vec<Vec<f64>>,
    /// Loads of gear meshes at the point, by the mesh's place in the head; of `kinematic` ones and in files of older
    /// programs none.
    pub loads: Vec<(usize, StageLoad)>,
}

/// A measured speed sweep.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SweepResult {
    /// Windows, in the order of time.
    pub windows: Vec<Window>,
    /// The columns.
    pub columns: Vec<Column>,
    /// Figures, `[window][column]`.
    pub figures: Vec<Vec<Figures>>,
}

/// A result, columns not read yet.
#[derive(Debug)]
pub struct SystemResult {
    /// Where it comes from.
    pub head: RunHead,
    /// What it holds.
    pub kind: ResultKind,
    /// Program version.
    pub version: String,
    /// When, UTC.
    pub created_utc: String,
    /// Effort and accuracy, of runs in time.
    pub record: Option<RunRecord>,
    /// Rows, column by column; none for a sweep and for natural frequencies.
    pub rows: ColumnFile,
    /// Figures of the columns of a transient run, in their order, those that are filtered left out.
    pub statistics: Vec<Figures>,
    /// Begin of these figures \[s\].
    pub statistics_from_s: f64,
    /// How often a transient run was looked at for each row: figures are those of all samples.
    pub samples_per_row: usize,
    /// RMS value of what vibrates faster than rows can tell, of each column that has statistics; empty where it is not
    /// known.
    pub folded: Vec<f64>,
    /// Sweep.
    pub sweep: Option<SweepResult>,
    /// What was judged after the run.
    pub ratings: Vec<RatingResult>,
    /// Natural frequencies.
    pub eigen: Vec<EigenResult>,
    /// Names of the bodies, in the order of the participations.
    pub bodies: Vec<String>,
    /// Names of the force elements, in the order of the strain shares.
    pub elements: Vec<String>,
}

impl SweepResult {
    /// From the four figures of each column, window by window.
    pub(super) fn of_run(windows: &[Window], columns: Vec<Column>, figures: &[f64]) -> Self {
        let of_column = |f: &[f64; 4]| Figures {
            mean: f[0],
            deviation: f[1],
            least: f[2],
            largest: f[3],
        };
        let figures: Vec<Figures> = figures.as_chunks().0.iter().map(of_column).collect();
        let figures = figures.chunks(columns.len().max(1)).map(<[_]>::to_vec);
        Self {
            windows: windows.to_vec(),
            figures: figures.collect(),
            columns,
        }
    }

    /// Which columns vary by more than rounding in some window.
    #[must_use]
    pub fn varying(&self) -> Vec<bool> {
        let of_window = |figures: &Vec<Figures>| {
            let columns = self.columns.iter().zip(figures);
            varying(columns.map(|(column, f)| (column.unit.as_str(), f.least, f.largest)))
        };
        let none = vec![false; self.columns.len()];
        self.figures
            .iter()
            .map(of_window)
            .fold(none, |mut all, window| {
                all.iter_mut()
                    .zip(window)
                    .for_each(|(all, here)| *all |= here);
                all
            })
    }
}

impl Contents {
    /// Those of a run that has just ended.
    pub(super) fn of_run(kind: ResultKind, head: RunHead) -> Self {
        Self {
            kind,
            head,
            version: env!("CARGO_PKG_VERSION").to_owned(),
            created_utc: utc_now(),
            ..Self::default()
        }
    }

    /// Writes a result without rows.
    pub(super) fn write(&mut self, path: &Path) -> Result<(), FileError> {
        self.tree().write(path, &SYSTEM_RESULT_FORMAT)
    }

    /// Writes a result with rows; `axis` says what they go through.
    pub(super) fn write_with_rows(
        &mut self,
        path: &Path,
        (axis, columns, log): (&str, &[Column], &mut RowLog),
    ) -> Result<(), FileError> {
        let rows = (axis, columns);
        write_columns(path, &SYSTEM_RESULT_FORMAT, &self.tree(), rows, log)
    }

    fn tree(&mut self) -> DataTree {
        let mut tree = DataTree::default();
        write_record(self, &mut tree);
        tree
    }
}

impl SystemResult {
    /// What is in the file, for the documentation.
    #[must_use]
    pub fn data_sets() -> Vec<ListedField> {
        let rows = ListedField {
            name: "columns/NAME".to_owned(),
            form: "[row]".to_owned(),
            unit: "of the column".to_owned(),
            description: "a column, as docs/results.md lists them".to_owned(),
        };
        let mut list = list_record::<Contents>();
        list.push(rows);
        list
    }

    /// A column of a transient run as a spectrum needs it, without what vibrates faster than rows can tell; the column
    /// itself where it is not filtered.
    ///
    /// # Errors
    /// [`FileError`] when there is no such column, or it cannot be read.
    pub fn read_for_spectrum(&self, name: &str) -> Result<Vec<f64>, FileError> {
        match self.low_pass(name) {
            Some(filtered) => self.rows.read(&filtered.name),
            None => self.rows.read(name),
        }
    }

    /// Whether a column has a filtered one.
    #[must_use]
    pub fn has_low_pass(&self, name: &str) -> bool {
        self.low_pass(name).is_some()
    }

    /// The filtered column of another one.
    fn low_pass(&self, name: &str) -> Option<&Column> {
        let of = |column: &&Column| column.name.strip_prefix(GROUP) == Some(name);
        self.rows.beside().iter().find(of)
    }

    /// Share of half the rate of the rows up to which spectra of columns are right.
    #[must_use]
    pub fn spectrum_band(&self) -> f64 {
        if self.samples_per_row > 1 {
            LOW_PASS_BAND
        } else {
            1.0
        }
    }

    /// What of a column vibrates faster than its rows can tell, over its deviation, and stands at false places in a
    /// spectrum over them; none below [`FOLDED_SHARE`], and of columns that are filtered.
    #[must_use]
    pub fn folded_share(&self, name: &str) -> Option<f64> {
        if self.has_low_pass(name) {
            return None;
        }
        let mut columns = self.rows.columns().iter();
        let place = columns.position(|column| column.name == name)?;
        let share = self.folded.get(place)? / self.statistics.get(place)?.deviation;
        (share > FOLDED_SHARE && share.is_finite()).then_some(share)
    }

    /// What [`Self::folded_share`] means for spectra of a column, and what to do about it.
    #[must_use]
    pub fn folded_in_words(&self, name: &str) -> Option<String> {
        let share = self.folded_share(name)?;
        let interval_s = self.interval_s().ok()?;
        Some(format!(
            "`{name}` is written every {interval_s} s: {:.2} % of its RMS value vibrates faster than {} Hz and stands at false places in its \
             spectra; lower output.interval_s of the scene",
            100.0 * share,
            0.5 / interval_s
        ))
    }

    /// Opens a result.
    ///
    /// # Errors
    /// [`FileError`] when the file is missing, cut, altered, of another kind, or an array does not fit the others.
    pub fn open(path: &Path) -> Result<Self, FileError> {
        let (mut rows, mut tree) = ColumnFile::open(path, &SYSTEM_RESULT_FORMAT)?;
        if rows.version() < STATED_UNITS {
            rows = rows.with_units_of(unit_in_name);
        }
        let it: Contents = read_record(&mut tree, path, rows.version())?;
        let rows = rows.with_beside(GROUP);
        let columns = rows.columns().len();
        if it.kind == ResultKind::Transient && it.statistics.len() != columns {
            return Err(FileError::WrongShape {
                path: path.to_owned(),
                item: "array \"statistics/mean\"".to_owned(),
                found: vec![it.statistics.len()],
                expected: vec![columns],
            });
        }
        Ok(Self {
            head: it.head,
            kind: it.kind,
            version: it.version,
            created_utc: it.created_utc,
            record: it.record,
            rows,
            statistics: it.statistics,
            statistics_from_s: it.statistics_from_s.unwrap_or(0.0),
            folded: it.folded,
            samples_per_row: it
                .samples_per_row
                .map_or(1, |samples| samples.max(1.0) as usize),
            sweep: it.sweep,
            ratings: it.ratings,
            eigen: it.eigen,
            bodies: it.bodies,
            elements: it.elements,
        })
    }
}
