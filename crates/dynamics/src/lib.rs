#![doc = include_str!("../README.md")]
//! # Where things are
//!
//! Multibody dynamics: bodies, joints and force elements in space, integrated by the Lie-group generalized-alpha
//! scheme.
//!
//! | question | answer | file |
//! | --- | --- | --- |
//! | how is a system put together | [`SystemBuilder`] | `builder.rs` |
//! | what is a body, rigid or with modes | [`Body`], [`Modes`] | `body.rs`, `inertia.rs` |
//! | which motions do joints leave, prescribe or couple | [`Joint`], [`JointKind`], [`Motion`] | `joint.rs` |
//! | which joint equations are redundant, which contradict each other | [`Redundancy`] | `constraints.rs`, `metric.rs` |
//! | which forces are there, and how is one added from another crate | [`elements`], [`ForceElement`] | `elements.rs` |
//! | how do two markers move against each other, with all derivatives | [`MarkerPair`], [`RelativeMotion`] | `relative_motion.rs`, `relative_angle.rs`, `polar_angle.rs` |
//! | which coordinates may an element have of its own | [`Unknown`] | `unknown.rs`, `unknown_start.rs` |
//! | functions of time | [`TimeFunction`], [`Table`] | `time_function.rs`, `table.rs` |
//! | a transient run, output on a grid, what it took | [`Simulation`], [`OutputGrid`], [`RunInfo`] | `simulation.rs`, `integrator.rs`, `convergence.rs`, `scheme.rs` |
//! | how is a run stopped and resumed with the same bits | [`Checkpoint`] | `checkpoint.rs` |
//! | does the energy balance | [`EnergyBalance`] | `energy.rs` |
//! | where does the system stand still, and why not | [`equilibrium`] | `statics.rs`, `static_correction.rs`, `unbalanced.rs` |
//! | natural frequencies, damping and shapes about a motion | [`natural_modes`] | `eigen.rs`, `krylov.rs` |
//! | which matrices do small motions have, for other programs | [`Linearised`] | `linearised.rs` |
//!
//! Everything is in absolute coordinates: place and unit quaternion of each body. Joints are equations, not reduced
//! coordinates, so every reaction is at hand. Matrices hold what bodies, joints and elements connect, and are
//! factorised as dense or sparse ones, whichever is faster (`structure.rs`, `saddle.rs`): a step of two bodies on
//! bearings takes some microseconds, one of a thousand bodies some milliseconds, and neither allocates. The theory is
//! in docs/theory/multibody.md.

pub mod body;
pub mod builder;
pub mod checkpoint;
mod constraints;
mod convergence;
mod damped_newton;
mod dense_lu;
mod derivatives;
pub mod eigen;
pub mod elements;
pub mod energy;
mod equations;
pub mod error;
mod host_function;
mod inertia;
pub mod initial;
mod integrator;
pub mod joint;
mod kept_iterate;
mod krylov;
mod linearised;
mod matrix;
mod metric;
mod pattern;
mod polar_angle;
mod probe;
mod redundancy;
pub mod relative_angle;
pub mod relative_motion;
mod relaxation;
pub mod rotation;
mod saddle;
pub mod scheme;
mod secants;
pub mod simulation;
mod sparse_lu;
pub mod state;
mod static_correction;
mod static_steps;
pub mod statics;
mod step_failure;
mod structure;
pub mod system;
pub mod table;
#[cfg(test)]
mod tangent_tests;
pub mod time_function;
mod unbalanced;
mod unknown;
mod unknown_start;

pub use body::{Body, BodyId, GROUND, Modes};
pub use builder::SystemBuilder;
pub use checkpoint::Checkpoint;
pub use derivatives::Derivatives;
pub use eigen::{NaturalMode, natural_modes, natural_modes_up_to, strain_shares};
pub use elements::{Channel, ForceElement, Iterate, Loads, Power, View};
pub use energy::{Energy, EnergyBalance};
pub use error::{DynamicsError, ElementFailure};
pub use host_function::{HostFunction, TimeCall};
pub use initial::Accelerations;
pub use joint::{Joint, JointKind, Motion};
pub use linearised::Linearised;
pub use probe::Probe;
pub use redundancy::Redundancy;
pub use relative_motion::{Marker, MarkerPair, RelativeMotion};
pub use scheme::{AdaptiveStep, LinearSolver, Params, StepControl};
pub use simulation::{Accepted, OutputGrid, RunInfo, Simulation};
pub use state::{BodyMotion, Layout, State};
pub use statics::{Equilibrium, FreeMotions, StaticParams, equilibrium, next_equilibrium};
pub use system::{Calls, System};
pub use table::{Interpolation, Table};
pub use time_function::TimeFunction;
pub use unknown::{Unknown, UnknownKind};
