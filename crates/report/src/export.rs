//! Results as tables of other programs: `gearmesh export`. Layouts: docs/results.md.
//!
//! | what | file |
//! | --- | --- |
//! | a table, and which tables a result has | this one |
//! | tables of a static pair | `pair_tables.rs` |
//! | tables of a multibody result | `system_tables.rs` |
//! | tables as functions over an axis | `functions.rs` |
//! | CSV, and reading a study's | `csv_text.rs` |
//! | Parquet | `parquet_bytes.rs` |
//! | MATLAB, level 5 | `mat_bytes.rs` |
//! | universal file | `universal_text.rs` |

mod csv_text;
mod functions;
mod mat_bytes;
mod pair_tables;
mod parquet_bytes;
mod system_tables;
mod universal_text;

pub use csv_text::{study_table, write_csv};
pub use functions::{Function, for_each_function};
pub use mat_bytes::write_mat;
pub use pair_tables::{pair_tables, torque_table};
pub use parquet_bytes::write_parquet;
pub use system_tables::system_tables;
pub use universal_text::write_universal;

use std::borrow::Cow;
use std::io;
use std::ops::Range;

use gearmesh_model::{ColumnFile, FileError};
use gearmesh_scene::rating::RatingResult;
use thiserror::Error;

/// Why a table is not made.
#[derive(Debug, Error)]
pub enum ExportError {
    /// The result cannot be read.
    #[error(transparent)]
    File(#[from] FileError),
    /// A CSV file is damaged, or a text cannot be written into one.
    #[error("CSV: {0}")]
    Csv(#[from] csv::Error),
    /// The table cannot be written.
    #[error("{0}")]
    Write(#[from] io::Error),
    /// The Parquet library refuses.
    #[error("Parquet: {0}")]
    Parquet(#[from] parquet::errors::ParquetError),
    /// Nothing of the table is a function.
    #[error(
        "table `{table}` holds no functions over an axis; a universal file takes the curves of a pair, the rows of a run in time and the windows of a sweep"
    )]
    NoFunctions {
        /// The table.
        table: String,
    },
    /// A MATLAB file of level 5 counts bytes in 32 bits.
    #[error(
        "table `{table}` has {bytes} bytes; a MATLAB file holds less than 2 GB of a table: export to .parquet, or give --table"
    )]
    TooLarge {
        /// The table.
        table: String,
        /// Its size.
        bytes: usize,
    },
}

/// A column: numbers, or texts.
#[derive(Debug)]
pub enum Cells<'a> {
    /// Numbers; what is not there is NaN.
    Numbers(Vec<f64>),
    /// Texts.
    Texts(Vec<String>),
    /// Numbers of a column of a file, read when they are needed.
    Column(&'a ColumnFile, String),
}

impl Cells<'_> {
    /// Number of rows.
    #[must_use]
    pub fn rows(&self) -> usize {
        match self {
            Self::Numbers(values) => values.len(),
            Self::Texts(values) => values.len(),
            Self::Column(file, _) => file.rows(),
        }
    }

    /// The numbers of some rows; none of texts.
    ///
    /// # Errors
    /// [`FileError`] if the column of a file cannot be read.
    pub fn numbers(&self, rows: Range<usize>) -> Result<Option<Cow<'_, [f64]>>, FileError> {
        Ok(match self {
            Self::Numbers(values) => Some(Cow::Borrowed(&values[rows])),
            Self::Texts(_) => None,
            Self::Column(file, name) => Some(Cow::Owned(file.read_rows(name, rows)?)),
        })
    }
}

/// Numbers of a table that are in memory at once where it is written row by row: 32 MB.
const BLOCK_NUMBERS: usize = 1 << 22;

/// Columns of one length with a name each, unit in the name.
#[derive(Debug, Default)]
pub struct Table<'a> {
    /// What it is called behind `--table`.
    pub name: String,
    /// Columns in order.
    pub columns: Vec<(String, Cells<'a>)>,
}

impl Table<'_> {
    /// A table without columns.
    #[must_use]
    pub fn new(name: &str) -> Self {
        Self {
            name: name.to_owned(),
            columns: Vec::new(),
        }
    }

    /// Adds numbers.
    pub fn numbers(&mut self, name: impl Into<String>, values: Vec<f64>) {
        self.columns.push((name.into(), Cells::Numbers(values)));
    }

    /// Adds texts.
    pub fn texts(&mut self, name: impl Into<String>, values: Vec<String>) {
        self.columns.push((name.into(), Cells::Texts(values)));
    }

    /// Number of rows.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.columns.first().map_or(0, |(_, cells)| cells.rows())
    }

    /// Its rows in blocks, none of them empty, that go into memory.
    fn blocks(&self) -> impl Iterator<Item = Range<usize>> + use<> {
        let block = (BLOCK_NUMBERS / self.columns.len().max(1)).max(1);
        let rows = self.rows();
        (0..rows)
            .step_by(block)
            .map(move |first| first..rows.min(first + block))
    }
}

/// Ratings, a row a figure; none where nothing was rated.
fn ratings_table(ratings: &[RatingResult]) -> Option<Table<'static>> {
    let figures = || {
        let of = |rating| {
            let rating: &RatingResult = rating;
            rating.figures.iter().map(move |figure| (rating, figure))
        };
        ratings.iter().flat_map(of)
    };
    figures().next()?;
    let mut table = Table::new("ratings");
    table.texts("rating", figures().map(|(r, _)| r.name.clone()).collect());
    table.texts("method", figures().map(|(r, _)| r.method.clone()).collect());
    table.texts(
        "figure",
        figures().map(|(_, f)| f.name.to_owned()).collect(),
    );
    table.numbers("value", figures().map(|(_, f)| f.value).collect());
    Some(table)
}
