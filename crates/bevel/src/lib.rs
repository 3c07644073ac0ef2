//! Bevel gears: blank, flanks from machine settings, local synthesis, tooth contact analysis.
//!
//! | step | type | file |
//! | --- | --- | --- |
//! | read a pair file (TOML, units in the keys) | [`PairFile`] | `pair_file.rs` |
//! | cones, depths and thicknesses of a pair | [`PairBlank`] | `blank.rs` |
//! | settings of the machine | [`MachineSettings`], [`basic_settings()`] | `settings.rs`, `basic_settings.rs` |
//! | the surface that the tool leaves, exact to second derivatives | [`CutSurface`] | `cut_surface.rs`, `jet.rs` |
//! | a flank on its blank, a tooth and its checks | [`Flank`], [`Tooth`] | `flank.rs`, `tooth.rs` |
//!
//! SI units. Frames, signs and formulas stand in docs/theory/bevel_gears.md and nowhere else. In short: z is a member's axis, from the pitch apex to the
//! heel; the mean point of a flank under study lies on +x; member 1 is the pinion, member 2 the gear.

pub mod basic_settings;
pub mod blank;
pub mod cut_surface;
mod error;
pub mod flank;
pub mod hand;
pub mod jet;
pub mod pair_file;
pub mod settings;
pub mod tooth;

pub use basic_settings::{Process, basic_settings, crown_settings};
pub use blank::{MemberBlank, PairBlank, PairData, Taper, ToothForm};
pub use cut_surface::{CutSurface, SurfacePoint};
pub use error::BevelError;
pub use flank::{Flank, Located};
pub use hand::{FlankSide, Hand};
pub use pair_file::PairFile;
pub use settings::{FaceMill, MachineSettings, Roll, Tool};
pub use tooth::{Tooth, ToothCheck};
