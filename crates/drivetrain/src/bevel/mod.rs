//! Bevel gears as a mesh sees them: flanks as smooth patches with edges, at any pose of two gears whose axes meet.
//!
//! | what | file |
//! | --- | --- |
//! | kinematics of the pair | `bevel_mesh.rs` |
//! | flanks of one side of the teeth | `tooth_side.rs` |
//! | guess of where flanks touch: from the pair as designed | `nominal_contacts.rs` |
//! | the same for teeth that do not face each other there | `bounding_spheres.rs` |
//! | where two patches are nearest, edges and corners with them | `nearest_points.rs` |
//! | how that changes with the pose | `pose_derivatives.rs` |
//! | stiffness from the curvatures there | `hertz_stiffness.rs` |
//! | place and ellipse of a contact, for channels | `touch.rs` |
//!
//! The theory is in docs/theory/bevel_gears.md, "Contact in motion".

mod bevel_mesh;
mod bounding_spheres;
mod hertz_stiffness;
mod nearest_points;
mod nominal_contacts;
mod pose_derivatives;
mod tooth_side;
mod touch;

pub use bevel_mesh::BevelMesh;
