//! Bevel gears as a mesh sees them: flanks as smooth patches with edges, at any pose of two gears whose axes meet.
//!
//! | what | file |
//! | --- | --- |
//! | kinematics of the pair | `bevel_mesh.rs` |
//! | first guess of where flanks touch | `bounding_spheres.rs` |
//! | where two patches are nearest, edges and corners with them | `nearest_points.rs` |
//! | how that changes with the pose | `pose_derivatives.rs` |
//!
//! The theory is in docs/theory/bevel_gears.md, "Contact in motion".

mod bevel_mesh;
mod bounding_spheres;
mod nearest_points;
mod pose_derivatives;

pub use bevel_mesh::BevelMesh;
