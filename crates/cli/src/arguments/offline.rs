//! Arguments of the reduction.

use clap::Args;
use std::path::PathBuf;

/// `gearmesh reduce`.
#[derive(Debug, Args)]
pub struct ReduceArguments {
    /// Gear file
    pub gear: PathBuf,
    /// Model file
    #[arg(short, long)]
    pub output: PathBuf,
    /// Do not reduce a coarser mesh to estimate the discretisation error
    #[arg(long)]
    pub no_error_estimate: bool,
    /// Begin even if the memory estimate exceeds what is free
    #[arg(long)]
    pub even_if_memory_is_short: bool,
    /// Print figures as JSON
    #[arg(long)]
    pub json: bool,
}
