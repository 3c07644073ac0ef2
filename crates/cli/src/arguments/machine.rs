//! Arguments of the commands about the program itself and the machine.

use clap::{Args, ValueEnum};
use clap_complete::Shell;
use std::path::PathBuf;

/// `gearmesh init`.
#[derive(Debug, Args)]
pub struct InitArguments {
    /// What to write
    pub kind: InitKind,
    /// Folder; files that are there are left as they are
    #[arg(short, long, default_value = ".")]
    pub output: PathBuf,
    /// Print the names of the files as JSON
    #[arg(long)]
    pub json: bool,
}

/// What `gearmesh init` writes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum InitKind {
    /// One gear
    Gear,
    /// Two gears, at rest and running
    Pair,
    /// Two gears on shafts in bearings
    Gearbox,
    /// Sun, planets and ring on a carrier
    Planetary,
    /// A bevel pair, its members as bodies, the pair running
    Bevel,
}

/// `gearmesh doctor`.
#[derive(Debug, Args)]
pub struct DoctorArguments {
    /// Print what was found as JSON
    #[arg(long)]
    pub json: bool,
}

/// `gearmesh completions`.
#[derive(Debug, Args)]
pub struct CompletionsArguments {
    /// Shell
    pub shell: Shell,
}

/// `gearmesh man`.
#[derive(Debug, Args)]
pub struct ManArguments {
    /// Folder for gearmesh.1 and a page for each command
    #[arg(short, long)]
    pub output: PathBuf,
}
