//! Whether scenes run in time, and how they are damped then.

/// Whether scenes stand at rest under their loads or run in time.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Running {
    /// Equilibria.
    #[default]
    AtRest,
    /// Driven at the speeds of the file.
    InTime,
}

/// Damping over stiffness of shafts, bearings, meshes and drives \[s\], of which files say nothing: 0.3 % of the
/// critical one at 1 kHz.
pub const DAMPING_S: f64 = 1e-6;
