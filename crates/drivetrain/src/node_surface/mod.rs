//! Flanks as points on a grid, bilinear patches between them: nodes of gear 1's flanks against patches of gear 2's,
//! as programs with general contact
//! of surfaces have it (seed 001).
//!
//! | what | file |
//! | --- | --- |
//! | a flank as nodes, their areas, and patches with normals | `digital_flank.rs` |
//! | foot of a node on the patches: the local search | `patch_foot.rs` |
//! | area to which a stated K belongs | `reference_area.rs` |
//! | digital flanks of bevel and of involute gears | `families.rs` |
//! | pairs of teeth by bounding boxes, their nodes as contacts | `node_contacts.rs` |
//!
//! Each node that stands in a patch by δ is a contact of its own, K δ^e with damping. K belongs to a pair of teeth:
//! with one K at each node the force
//! grows with their number. With the area A_i of a node over a reference area A_ref the sum tends to (K/A_ref) ∫ δ^e
//! dA, whatever the
//! grid. The theory is in docs/theory/gear_meshes.md, "Node to surface".

mod digital_flank;
mod families;
mod node_contacts;
mod patch_foot;
mod reference_area;

pub use digital_flank::{DigitalFlank, PatchSize};
pub use families::ReferenceApproach;
pub use node_contacts::NodeSurfaces;
pub use reference_area::{line_contact_area_m2, point_contact_area_m2};
