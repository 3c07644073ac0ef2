//! A flank error: waves along the profile of all teeth of a gear, as grinding leaves them.

use gearmesh_drivetrain::{FlankError, FlankPoint, Removed};

pub struct Waviness {
    pub amplitude_m: f64,
    /// Waves in a radian of roll angle.
    pub waves_per_rad: f64,
}

impl FlankError for Waviness {
    fn removed(&self, at: FlankPoint) -> Removed {
        let per_rad = std::f64::consts::TAU * self.waves_per_rad;
        let (sin, cos) = (per_rad * at.roll_rad).sin_cos();
        Removed {
            depth_m: self.amplitude_m * sin,
            slope_m_per_rad: self.amplitude_m * per_rad * cos,
            slope_along_axis: 0.0,
        }
    }

    // The crests stand out by this: flanks farther apart are not looked at.
    fn most_added_m(&self) -> f64 {
        self.amplitude_m.abs()
    }
}
