//! Deviations of the flanks from the ideal involute: material removed, tooth by tooth.
//!
//! | kind | file |
//! | --- | --- |
//! | microgeometry, the same on all teeth | `gearmesh_geometry::Microgeometry` |
//! | pitch errors | `errors/pitch.rs` |
//! | measured profile and lead | `errors/deviation_table.rs` |
//! | broken tooth | `errors/broken_tooth.rs` |
//! | tip chip | `errors/tip_chip.rs` |
//! | spall | `errors/spall.rs` |
//! | eccentricity, which is no deviation of the flank but a place of the gear | `errors/eccentricity.rs` |

pub use gearmesh_geometry::flank_error::{FlankError, FlankPoint, Removed, most_added_m};
