#![doc = include_str!("../README.md")]
//! # Where things are
//!
//! Rolling bearings: geometry, Hertz contact, equilibrium of every ball and roller, rating life.
//!
//! | step | type | file |
//! | --- | --- | --- |
//! | what a bearing is | [`BearingDefinition`] | `definition.rs`, read by `bearing_file.rs` |
//! | ball in a groove, roller on a race | [`PointContact`], [`LineContact`] | `point_contact.rs`, `line_contact.rs` |
//! | one row of balls or rollers | [`BallRow`], [`FourPointRow`], [`RollerRow`], [`BarrelRow`] | `ball_row.rs`, `four_point_row.rs`, `roller_row.rs`, `barrel_row.rs` |
//! | how balls orbit and spin | | `ball_kinematics.rs` |
//! | all rows: load on the inner ring and its tangent | [`QuasiStaticBearing`] | `quasi_static.rs` |
//! | the same between two bodies of a system | [`QuasiStaticElement`] | `quasi_static_element.rs` |
//! | balls that move | [`DynamicBearing`] | `dynamic/` |
//! | fits and heat: the clearance in operation | [`OperatingClearance`] | `fit.rs` |
//! | what may be wrong with it | [`faults::Fault`] | `faults/` |
//! | friction torque | [`friction::Friction`] | `friction.rs` |
//! | static safety, and what is beyond its limit | [`StaticSafety`], [`warnings::Judged`] | `static_safety.rs`, `warnings.rs`, `shoulder.rs` |
//! | ratings and life | [`Ratings`], [`Life`] | `ratings.rs`, `life.rs` |
//! | what the ends of rollers suffer | [`stress_riser::stress_riser`] | `stress_riser.rs` |
//! | life over the loads of a run | [`LoadHistory`] | `load_history.rs` |
//! | from a catalogue's line to a definition | [`CatalogueLine`] | `catalogue.rs`, `designations.rs`, `element_room.rs`, `estimate.rs` |
//! | frequencies of rolling | [`BearingFrequencies`] | `frequencies.rs` |
//!
//! SI units. Frame: that of the outer ring, z its axis; the pose of the inner ring is seen in it, loads act on the
//! inner ring. Formulas are derived in docs/theory/rolling_bearings.md.

mod axial_plane;
mod ball_equilibrium;
mod ball_kinematics;
pub mod ball_row;
mod barrel_equilibrium;
pub mod barrel_row;
pub mod bearing_file;
pub mod bent_race;
mod build_rows;
pub mod catalogue;
pub mod definition;
pub mod designations;
mod double_row_load;
mod dual;
pub mod dynamic;
pub mod element_load;
pub mod element_outline;
pub mod element_place;
pub mod element_room;
mod element_search;
mod error;
pub mod estimate;
pub mod faults;
pub mod fit;
mod four_point_ball;
pub mod four_point_row;
pub mod frequencies;
pub mod friction;
mod groove;
pub mod life;
pub mod line_contact;
pub mod load_history;
pub mod operation;
pub mod quasi_static;
pub mod quasi_static_element;
pub mod ratings;
mod ring_channels;
pub mod ring_equilibrium;
pub mod ring_load;
pub mod ring_pose;
mod roller_equilibrium;
mod roller_forces;
pub mod roller_row;
mod row;
mod shoulder;
mod speed_up;
pub mod static_safety;
pub mod stress_riser;
pub mod thrust_ratings;
mod tilted_equilibrium;
pub mod warnings;

pub use ball_kinematics::RaceControl;
pub use ball_row::BallRow;
pub use barrel_row::BarrelRow;
pub use bent_race::BentRace;
pub use catalogue::CatalogueLine;
pub use definition::BearingDefinition;
pub use dynamic::{DynamicBearing, DynamicEffects};
pub use element_load::ElementLoad;
pub use element_outline::ElementOutline;
pub use element_place::ElementPlaces;
pub use error::BearingError;
pub use fit::OperatingClearance;
pub use four_point_row::FourPointRow;
pub use frequencies::BearingFrequencies;
pub use friction::{Friction, FrictionTorque};
pub use gearmesh_geometry::point_contact::PointContact;
pub use gearmesh_geometry::{elliptic, point_contact};
pub use life::Life;
pub use line_contact::LineContact;
pub use load_history::{HistoryLife, HistorySample, LoadHistory};
pub use operation::{Control, Operation};
pub use quasi_static::QuasiStaticBearing;
pub use quasi_static_element::{QuasiStaticElement, RingDamping};
pub use ratings::Ratings;
pub use ring_equilibrium::{AppliedBearingLoad, TiltCondition};
pub use ring_load::RingLoad;
pub use ring_pose::RingPose;
pub use roller_row::RollerRow;
pub use static_safety::StaticSafety;
pub use warnings::BearingWarning;
