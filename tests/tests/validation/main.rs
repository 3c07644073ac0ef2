//! Validation of whole gears and pairs against other programs, finer meshes and reference records. One binary, so that
//! it links once and long tests run beside each other.
#![allow(clippy::unwrap_used, clippy::print_stdout, missing_docs)]

mod analytic_tooth;
#[path = "../../support/computed.rs"]
mod computed;
mod end_effect;
mod friction_at_the_root;
mod gear_modes;
mod graded_tooth;
mod line_load;
mod mesh_convergence;
mod mesh_error_estimate;
mod pairs_a_and_b;
mod plane_strain_deflection;
mod planet;
mod ring_deflection;
mod slice_deflection;
mod solid_pair_transmission_error;
mod tetrahedra;
mod thin_rim_deflection;
