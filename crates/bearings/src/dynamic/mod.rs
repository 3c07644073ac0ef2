//! Ball bearings whose balls are bodies: every ball moves, touches each race at one point, and rolls where friction
//! makes it.
//!
//! | effect | type | file |
//! | --- | --- | --- |
//! | force between a ball and a surface, with all derivatives | | `surface_contact.rs` |
//! | the same on a ball and a body of the system | | `ball_on_body.rs` |
//! | where a ball meets a groove, as a torus | | `groove_touch.rs` |
//! | the same on a groove of triangles | [`GrooveTriangles`] | `triangles.rs` |
//! | the same on a groove with faults, and on a ball with a spall | | `uneven_groove.rs` |
//! | how a ball with a spall stands | | `ball_orientation.rs` |
//! | load and damping of a contact, or a stated law for both | [`StatedContact`] | `contact_damping.rs` |
//! | energy lost in a blow | [`Rebound`] | `rebound.rs` |
//! | friction or film against slip | [`Traction`] | `traction.rs` |
//! | pockets of a cage | [`Pockets`] | `pockets.rs` |
//! | how a cage moves, for output | | `cage_motion.rs` |
//! | land that guides a cage | [`LandGuide`] | `land_guide.rs` |
//! | one ball at a motion: races, cage, faults | | `ball_contacts.rs` |
//! | where balls begin | | `ball_start.rs` |
//! | all of it between the bodies of a system | [`DynamicBearing`] | `dynamic_bearing.rs` |
//!
//! A ball has three coordinates, the place of its centre in the world. Where there is friction it has three more, whose
//! rates are its spin; a sphere's orientation has no effect, so that none is kept but for balls with spalls. What is
//! not asked for is not called ([`BearingEffort`] counts). Formulas (10) to (16) and (21) of
//! docs/theory/rolling_bearings.md.

mod ball_contacts;
mod ball_on_body;
mod ball_orientation;
mod ball_start;
mod cage_motion;
pub mod contact_damping;
pub mod dynamic_bearing;
pub mod effort;
mod groove_touch;
pub mod land_guide;
pub mod pockets;
pub mod rebound;
mod surface_contact;
pub mod traction;
pub mod triangles;
mod uneven_groove;

pub use contact_damping::StatedContact;
pub use dynamic_bearing::{DynamicBearing, DynamicEffects};
pub use effort::BearingEffort;
pub use land_guide::{LandContact, LandFilm, LandGuide, LandSide};
pub use pockets::{PocketShape, Pockets};
pub use rebound::Rebound;
pub use traction::{FluidTraction, Traction};
pub use triangles::{GrooveTriangles, TriangleSize};
