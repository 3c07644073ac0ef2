//! `gearmesh studio`.

use clap::Args;
use std::path::PathBuf;

/// `gearmesh studio`.
#[derive(Debug, Args)]
pub struct StudioArguments {
    /// Scene (.toml), result (.h5), or a folder with some; something new where not given
    pub file: Option<PathBuf>,
    /// Another result of a multibody scene, whose curves are drawn beside those of the first one
    #[arg(long, value_name = "RESULT", requires = "file")]
    pub beside: Option<PathBuf>,
    /// Print the address only; open it yourself
    #[arg(long)]
    pub no_open: bool,
    /// Port on this machine; a free one where not given
    #[arg(long, default_value_t = 0, hide_default_value = true)]
    pub port: u16,
}
