#![doc = include_str!("../README.md")]
//! # Where things are
//!
//! Bevel gears: blank, flanks from machine settings, local synthesis, tooth contact analysis.
//!
//! | step | type | file |
//! | --- | --- | --- |
//! | read a pair file (TOML, units in the keys) | [`PairFile`] | `pair_file.rs` |
//! | cones, depths and thicknesses of a pair | [`PairBlank`] | `blank.rs` |
//! | settings of the machine | [`MachineSettings`], [`basic_settings()`] | `settings.rs`, `basic_settings.rs` |
//! | the surface that the tool leaves, exact to second derivatives | [`CutSurface`] | `cut_surface.rs`, `jet.rs` |
//! | a flank on its blank, a tooth and its checks | [`Flank`], [`Tooth`] | `flank.rs`, `tooth.rs` |
//! | how thick a tooth its settings leave | [`ToothThickness`] | `cut_thickness.rs` |
//! | a flank through measured or published points | [`GridSurface`] | `point_grid.rs`, `grid_surface.rs` |
//! | a flank as a smooth patch, for contact in motion | [`FlankPatch`] | `flank_patch.rs`, `azimuth_surface.rs`, `chebyshev.rs`, `piecewise.rs` |
//! | both members in space, with errors | [`Assembly`] | `assembly.rs` |
//! | contact of flanks and edges | [`Mesh`] | `contact_point.rs`, `ease_off.rs` |
//! | path of contact, transmission error, ellipses | [`tooth_contact`] | `tca.rs`, `contact_path.rs`, `contact_search.rs`, `contact_ellipse.rs` |
//! | points and normals for a measuring machine | [`Tooth::nominal_grid_csv`] | `nominal_grid.rs` |
//! | both sides in an assembly, and the backlash between them | [`AssembledPair`] | `assembled_pair.rs`, `pair_meeting.rs` |
//! | what brings the contact to toe and heel | [`VhCheck`] | `vh_check.rs` |
//! | the mate by local synthesis or an ease-off | [`Synthesis`] | `local_synthesis.rs`, `settings_search.rs` |
//! | all of it for a file | [`PairDesign`] | `pair_design.rs` |
//! | a member's solid for CAD | [`SolidOutline`] | `solid_outline.rs` |
//! | a member as a body: blank, material, mesh, gauges | [`BevelGear`] | `bevel_gear.rs`, `gear_file.rs` |
//!
//! SI units. Frames, signs and formulas stand in docs/theory/bevel_gears.md and nowhere else. In short: z is a
//! member's axis, from the pitch apex to the
//! heel; the mean point of a flank under study lies on +x; member 1 is the pinion, member 2 the gear.

pub mod assembled_pair;
pub mod assembly;
mod azimuth_surface;
pub mod basic_settings;
mod between_positions;
pub mod bevel_gear;
pub mod blank;
mod chebyshev;
pub mod contact_ellipse;
pub mod contact_path;
pub mod contact_point;
mod contact_search;
pub mod cut_surface;
pub mod cut_thickness;
pub mod ease_off;
mod error;
pub mod flank;
pub mod flank_patch;
pub mod gear_file;
mod grid_samples;
pub mod grid_surface;
pub mod hand;
pub mod jet;
pub mod local_synthesis;
mod nominal_grid;
pub mod pair_design;
pub mod pair_file;
mod pair_meeting;
mod piecewise;
mod point_grid;
pub mod settings;
pub mod settings_search;
pub mod solid_outline;
pub mod table_thickness;
pub mod tca;
pub mod tooth;
pub mod vh_check;

pub use assembled_pair::AssembledPair;
pub use assembly::{Assembly, AssemblyError, Placement};
pub use basic_settings::{Process, basic_settings, crown_settings};
pub use bevel_gear::{BevelBlank, BevelContourPoint, BevelGauge, BevelGear};
pub use blank::{MemberBlank, PairBlank, PairData, Taper, ToothForm};
pub use contact_ellipse::ContactEllipse;
pub use contact_point::{ContactKind, EdgeKind, EdgeLine, Mesh, Touch};
pub use cut_surface::{CutSurface, SurfacePoint};
pub use cut_thickness::{ThicknessFrom, ToothThickness};
pub use ease_off::EaseOff;
pub use error::BevelError;
pub use flank::{Flank, Located};
pub use flank_patch::{FlankPatch, PatchPoint};
pub use grid_surface::{GridFit, GridSurface};
pub use hand::{FlankSide, Hand};
pub use local_synthesis::{Synthesis, SynthesisTarget};
pub use pair_design::{Cutting, PairDesign};
pub use pair_file::PairFile;
pub use settings::{FaceMill, MachineSettings, Roll, Tool};
pub use solid_outline::{SlotSection, SolidOutline};
pub use table_thickness::TableThickness;
pub use tca::{Sensitivity, TcaRequest, ToothContact, sensitivity, tooth_contact};
pub use tooth::{Tooth, ToothCheck};
pub use vh_check::{VhCause, VhCheck, VhSetting, VhStop};
