//! Deviations of the flanks from the ideal involute: material removed, tooth by tooth. The kinds other than the
//! microgeometry are in the drivetrain crate, `errors/`.

use crate::flank::Flank;

/// A point of a flank.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlankPoint {
    /// Tooth.
    pub tooth: usize,
    /// Side of the tooth.
    pub side: Flank,
    /// Roll angle \[rad\].
    pub roll_rad: f64,
    /// Axial position from mid-face \[m\].
    pub z_m: f64,
}

/// Material removed at a point.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Removed {
    /// Depth along the inward normal \[m\]; infinite where there is no flank.
    pub depth_m: f64,
    /// Its derivative by the roll angle \[m/rad\].
    pub slope_m_per_rad: f64,
    /// Its derivative along the axis. No unit.
    pub slope_along_axis: f64,
}

impl Removed {
    /// No flank at all.
    pub const EVERYTHING: Self = Self {
        depth_m: f64::INFINITY,
        slope_m_per_rad: 0.0,
        slope_along_axis: 0.0,
    };
}

/// A kind of gear error. The depth opens the gap of every slice it meets, and its slope turns the contact normal, so
/// that a depth without steps keeps an undamped mesh conservative.
pub trait FlankError: Send + Sync {
    /// Material removed at a point.
    fn removed(&self, at: FlankPoint) -> Removed;

    /// Bound of the material added anywhere \[m\], zero or positive, infinite where none is known: flanks that stay
    /// farther apart are not looked at.
    fn most_added_m(&self) -> f64;
}

/// The most that a list of depths adds.
#[must_use]
pub fn most_added_m(removed_m: &[f64]) -> f64 {
    removed_m
        .iter()
        .fold(0.0, |most, removed| most.max(-removed))
}
