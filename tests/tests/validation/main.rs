//! Validation of whole gears and pairs against other programs, finer meshes and reference records. One binary, so that
//! it links once and long tests run beside each other.
#![allow(clippy::print_stdout, clippy::unwrap_used, missing_docs)]

mod analytic_tooth;
#[path = "../../support/computed.rs"]
mod computed;
mod cracked_tooth;
mod end_effect;
mod friction_at_the_root;
mod gear_modes;
mod gear_pairs_in_time;
mod graded_tooth;
mod line_load;
#[path = "../../../crates/drivetrain/tests/mesh_common/mod.rs"]
mod mesh_common;
mod mesh_convergence;
mod mesh_error_estimate;
mod modal_gear_body;
mod pairs_a_and_b;
#[path = "../../support/pinion_with_stubs.rs"]
mod pinion_with_stubs;
mod plane_strain_deflection;
mod planet;
mod projected_flank;
mod ring_deflection;
mod slice_deflection;
mod solid_pair_transmission_error;
mod tetrahedra;
mod thin_rim_deflection;
mod two_faced_pinion;
#[path = "../../support/whole_compliance.rs"]
mod whole_compliance;
