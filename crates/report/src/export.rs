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

mod csv_text;
mod functions;
mod mat_bytes;
mod pair_tables;
mod parquet_bytes;
mod system_tables;

pub use csv_text::{csv_text, study_table};
pub use functions::{Function, functions};
pub use mat_bytes::mat_bytes;
pub use pair_tables::{pair_tables, torque_table};
pub use parquet_bytes::parquet_bytes;
pub use system_tables::system_tables;

use gearmesh_model::FileError;
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
    /// The Parquet library refuses.
    #[error("Parquet: {0}")]
    Parquet(#[from] parquet::errors::ParquetError),
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
#[derive(Debug, Clone, PartialEq)]
pub enum Cells {
    /// Numbers; what is not there is NaN.
    Numbers(Vec<f64>),
    /// Texts.
    Texts(Vec<String>),
}

/// Columns of one length with a name each, unit in the name.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Table {
    /// What it is called behind `--table`.
    pub name: String,
    /// Columns in order.
    pub columns: Vec<(String, Cells)>,
}

impl Table {
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
        match self.columns.first() {
            None => 0,
            Some((_, Cells::Numbers(values))) => values.len(),
            Some((_, Cells::Texts(values))) => values.len(),
        }
    }
}

/// Ratings, a row a figure; none where nothing was rated.
fn ratings_table(ratings: &[RatingResult]) -> Option<Table> {
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
