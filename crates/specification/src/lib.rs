#![doc = include_str!("../README.md")]
//!
//! # Where things are
//!
//! | file | its tables | module |
//! | --- | --- | --- |
//! | scene of a gear pair at rest (`[pair]`) | [`PairTables`](pair::PairTables) | [`pair`] |
//! | scene of a multibody system (`[[body]]`) | [`SystemTables`](system::SystemTables) | [`system`] |
//! | tables of both: errors, friction, seats of gears | | [`gear_tables`] |
//! | `[[rating]]` of both | [`RatingTable`](rating::RatingTable) | [`rating`] |
//! | study | [`StudyTables`](study::StudyTables) | [`study`] |
//! | optimisation | [`OptimiseTables`](optimise::OptimiseTables) | [`optimise`] |
//!
//! Gears, bevel pairs and bearings are described where they are computed: `gearmesh_geometry::gear_file`,
//! `gearmesh_bevel::pair_file`, `gearmesh_bearings::bearing_file`. [`schema`] writes down what may be in a file.

pub mod former_forms;
pub mod gear_tables;
pub mod host_functions;
pub mod names;
pub mod optimise;
pub mod pair;
pub mod rating;
pub mod schema;
pub mod study;
pub mod system;

/// Largest results that are written where nobody allows more \[bytes\].
pub const MOST_RESULT_BYTES: f64 = 1e9;
