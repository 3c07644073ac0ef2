#![doc = include_str!("../README.md")]
//!
//! # Where things are
//!
//! Comparison with reference records, tables and the HTML report.
//!
//! | you have | you want | use |
//! | --- | --- | --- |
//! | a folder with record.toml and data.csv | the reference as columns in SI units | [`ReferenceRecord::read`] |
//! | a computed series and a column of a record | how far they agree, as a rig would show it | [`compare`] |
//! | the surface of a body with values | a picture of it as seen from one direction | [`body_view`] |
//! | charts, tables and field pictures | one HTML file that opens without a network | [`page::Page`] |
//! | a curve of many points | fewer of them without losing a peak | [`min_max`] |
//! | measured curves, CSV or universal files | a record | [`measured`] |
//! | results | tables for other programs: CSV, Parquet, MATLAB | [`export`] |
//! | results of scenes | their comparison and their page | [`scene_comparison`], [`scene_page`] (`system_page.rs` for multibody scenes) |
//!
//! [`page`] knows nothing of gears: it draws what it is given.

pub mod accuracy_page;
pub mod body_view;
mod column_width;
mod column_words;
pub mod comparison;
mod comparison_table;
mod contact_pattern;
pub mod export;
pub mod measured;
pub mod min_max;
pub mod moving;
pub mod optimise_page;
pub mod overlay;
pub mod page;
pub mod pair_in_space;
pub mod pair_orders;
mod peak_view;
mod printable;
pub mod quantity;
mod ratings;
pub mod record;
mod record_data;
pub mod result_series;
pub mod run_figures;
pub mod scene_comparison;
pub mod scene_page;
mod short_number;
mod study_figures;
pub mod study_page;
pub mod system_comparison;
mod system_page;
mod torque_tables;
mod waterfall;

pub use column_width::column_width;
pub use column_words::words_and_unit;
pub use comparison::{
    ComparisonError, HarmonicComparison, RigView, SeriesComparison, compare, compare_with_column,
};
pub use comparison_table::comparison_table;
pub use pair_orders::{PairOrders, Shaft};
pub use printable::printable;
pub use quantity::{Quantity, Unit};
pub use record::{RecordColumn, RecordError, RecordKind, RecordUncertainty, ReferenceRecord};
pub use short_number::{short, short_beside, usual_unit};
pub use study_figures::study_figures;
pub use waterfall::waterfall;
