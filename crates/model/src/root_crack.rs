//! A crack in one tooth's root: what it adds to the compliance of the sound body.
//!
//! ```text
//! C_c(a, b) = C(a, b) + Σ_k φ_k(a) φ_k(b)        a, b: unit loads on the flanks of the crack's side, any teeth
//! ```
//!
//! Loads on the other side of the teeth press the crack shut: for them the gear is sound.

use gearmesh_geometry::Flank;

/// A crack and its rows φ.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct RootCrack {
    /// Cracked tooth.
    pub tooth: usize,
    /// Side of the tooth on which it opens.
    pub side: Flank,
    /// Radius of its mouth (m).
    pub mouth_radius_m: f64,
    /// Depth (m).
    pub depth_m: f64,
    /// Angle to the tooth's centre line (rad): 0 runs towards the centre of the gear, π/2 straight across.
    pub angle_rad: f64,
    /// φ for normal loads on the flanks of the crack's side (√(m/N)), `[row][tooth][load]`.
    pub rows: Vec<f64>,
    /// Bound of what the rows left out add to any compliance, relative to the largest compliance that the crack adds.
    pub left_out: f64,
}

impl RootCrack {
    /// Number of rows for so many teeth and loads a flank.
    pub fn count(&self, teeth: usize, loads: usize) -> usize {
        self.rows.len() / (teeth * loads).max(1)
    }

    /// One line for people: where it is and how deep.
    pub fn description(&self) -> String {
        format!(
            "crack in tooth {}, {} side: from radius {:.4} mm, {:.4} mm deep, {:.2} deg to the tooth's centre line",
            self.tooth,
            self.side,
            self.mouth_radius_m * 1e3,
            self.depth_m * 1e3,
            self.angle_rad.to_degrees()
        )
    }
}
