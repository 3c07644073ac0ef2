//! Commands but those on scenes.
#![allow(clippy::expect_used, clippy::unwrap_used, missing_docs)]

mod bad_input;
#[path = "../common/mod.rs"]
mod common;
mod cracked_gear;
mod failed_writes;
mod gear_commands;
mod helical;
mod hostile;
mod imported_gear;
mod signal;
mod study;
mod system_runs;
