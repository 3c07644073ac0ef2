//! `kinematic`: an ideal ratio. A joint, not a force: see `gear_mesh.rs` for the meshes that push.
