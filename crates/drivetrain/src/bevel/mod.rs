//! Bevel gears as a mesh sees them: flanks as smooth patches with edges, at any pose of two gears whose axes meet.
//!
//! | what | file |
//! | --- | --- |
//! | kinematics of the pair | `bevel_mesh.rs` |
//! | which teeth face each other | `tooth_pairing.rs` |
//! | flanks of one side of the teeth | `tooth_side.rs` |
//! | guess of where flanks touch: from the pair as designed | `nominal_contacts.rs` |
//! | the same for teeth that do not face each other there | `bounding_spheres.rs` |
//! | where two patches are nearest, edges and corners with them | `nearest_points.rs` |
//! | which of these hold a contact | `contact_limits.rs` |
//! | how that changes with the pose | `pose_derivatives.rs` |
//! | stiffness from the curvatures there | `hertz_stiffness.rs` |
//! | flanks divided into triangles or quadrilaterals | `facets.rs` |
//! | the pair in slices along the teeth | `sliced_mesh.rs`, a side of it `sliced_side.rs` |
//! | its sections once more at a pose nearby | `nearby_sections.rs` |
//! | what deflects in it | `bevel_teeth.rs` |
//! | where a section across the tooth is nearest | `section_points.rs` |
//! | the pair at rest under a torque | `at_rest.rs` |
//! | length and radius of the line of contact | `line_geometry.rs` |
//! | place and ellipse of a contact, for channels | `touch.rs` |
//!
//! The theory is in docs/theory/bevel_gears.md, "Contact in motion".

mod at_rest;
mod bevel_mesh;
mod bevel_teeth;
mod bounding_spheres;
mod contact_limits;
mod facets;
mod hertz_stiffness;
mod line_geometry;
mod nearby_sections;
mod nearest_points;
mod nominal_contacts;
mod pose_derivatives;
mod section_points;
mod sliced_mesh;
mod sliced_side;
mod tooth_pairing;
mod tooth_side;
mod touch;

pub use at_rest::{BevelAtRest, PlaceAtRest};
pub use bevel_mesh::BevelMesh;
pub use facets::{FacetKind, FacetSize};
pub use sliced_mesh::BevelSlices;
