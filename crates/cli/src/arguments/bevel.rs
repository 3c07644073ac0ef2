//! Arguments of `bevel` and `tca`.

use std::path::PathBuf;

use clap::Args;

/// `gearmesh bevel`.
#[derive(Debug, Args)]
pub struct BevelArguments {
    /// Bevel pair file
    pub pair: PathBuf,
    /// Print figures as JSON
    #[arg(long)]
    pub json: bool,
}

/// `gearmesh tca`.
#[derive(Debug, Args)]
pub struct TcaArguments {
    /// Bevel pair file
    pub pair: PathBuf,
    /// Page with pictures: contact pattern, transmission error, ease-off
    #[arg(long, value_name = "PAGE.html")]
    pub report: Option<PathBuf>,
    /// Print figures as JSON
    #[arg(long)]
    pub json: bool,
}
