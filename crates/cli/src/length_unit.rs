//! Unit of lengths in mesh files.

use clap::ValueEnum;

/// Unit of lengths in a mesh file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum LengthUnit {
    /// Metres.
    M,
    /// Millimetres.
    Mm,
}

impl LengthUnit {
    /// As the Python module calls it.
    pub const fn name(self) -> &'static str {
        match self {
            Self::M => "m",
            Self::Mm => "mm",
        }
    }
}
