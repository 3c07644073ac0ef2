//! Contact of flanks at rest against closed forms, other solvers and identities.
#![allow(
    clippy::needless_range_loop,
    clippy::print_stdout,
    clippy::unwrap_used,
    missing_docs
)]

mod extended_path;
mod hard_cases;
mod helical;
mod helical_edges;
#[path = "../nlcp_common/mod.rs"]
mod nlcp_common;
mod nlcp_effort;
mod nlcp_local_law;
mod nlcp_properties;
#[path = "../pair_common/mod.rs"]
mod pair_common;
mod sliced_hertz;
mod tip_contact;
