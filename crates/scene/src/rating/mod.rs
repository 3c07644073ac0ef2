//! Ratings of scenes of both kinds: is a tooth strong enough, and for how long; judged after the run from what it has
//! given.
//!
//! | question | answer | file |
//! | --- | --- | --- |
//! | what is in an S-N table | [`sn_curve`] | `sn_table_file.rs` |
//! | what is made of a stress history | [`FatigueJob`] | `fatigue_job.rs` |
//! | what is made of the largest force | [`nominal_figures`] | `nominal_figures.rs` |
//! | what is made of a bearing's loads | [`BearingLifeJob`] | `bearing_life.rs` |
//! | what is made of columns of a run | `RatingRule` | `rule.rs` |
//! | what came out, in memory and in result files | [`RatingResult`] | `result.rs` |
//!
//! Where histories and forces come from is said by each kind of scene: `system/assembly/ratings.rs` and
//! `system_run/rating.rs` take columns of a run in time, `pair/rating.rs` the positions of a pair. Equations:
//! docs/theory/rating.md.

mod bearing_life;
mod fatigue_job;
mod nominal_figures;
mod result;
pub(crate) mod rule;
mod sn_table_file;

pub use bearing_life::BearingLifeJob;
pub use fatigue_job::{FatigueJob, PassageLength};
pub use nominal_figures::{nominal_error, nominal_figures, nominal_method, nominal_remark, rim_m};
pub(crate) use result::figure_names;
pub use result::{RatingFigure, RatingResult};
pub use sn_table_file::sn_curve;
