//! Size and place of a row's balls or rollers without load: what a picture of the bearing needs.

use crate::row::Row;

/// A ball or roller of a row, and the circle that its middle goes round on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ElementOutline {
    /// Diameter, of a roller the mean or largest one \[m\].
    pub diameter_m: f64,
    /// Length of a roller; none for balls \[m\].
    pub length_m: Option<f64>,
    /// From the bearing's axis to a roller's axis, positive where the end at +z leans outwards \[rad\].
    pub tilt_rad: f64,
    /// Radius of the circle \[m\].
    pub pitch_radius_m: f64,
    /// Height of the circle along the bearing's axis \[m\].
    pub middle_z_m: f64,
    /// Angle of the first ball or roller \[rad\].
    pub first_angle_rad: f64,
    /// Share of the inner ring's turn against the outer one by which the cage turns by pure rolling: (1 − γ)/2 with
    /// γ = D cos α/d_m.
    pub cage_share: f64,
}

impl Row {
    /// Its balls or rollers without load.
    #[must_use]
    pub fn outline(&self) -> ElementOutline {
        let ball = |diameter_m, middle_z_m, first_rad, free_rad: f64| {
            (diameter_m, None, 0.0, middle_z_m, first_rad, free_rad.cos())
        };
        let (diameter_m, length_m, tilt_rad, middle_z_m, first_angle_rad, cosine) = match self {
            Self::Ball(row) => ball(
                row.ball_diameter_m,
                row.middle_z_m,
                row.first_angle_rad,
                row.free_angle_rad,
            ),
            Self::FourPoint(row) => ball(
                row.ball_diameter_m,
                row.middle_z_m,
                row.first_angle_rad,
                row.free_angle_rad,
            ),
            Self::Roller(row) => (
                row.diameter_m,
                Some(row.laminae.iter().map(|lamina| lamina.length_m).sum()),
                (row.axis.0 / row.axis.1).atan(),
                row.middle_z_m,
                row.first_angle_rad,
                row.axis.1.abs(),
            ),
            Self::Barrel(row) => (
                row.diameter_m,
                Some(row.lamina_length_m * row.laminae.len() as f64),
                -(row.across.1 / row.across.0).atan(),
                row.middle_m.1,
                row.first_angle_rad,
                row.across.0,
            ),
        };
        let pitch_radius_m = self.pitch_radius_m();
        ElementOutline {
            diameter_m,
            length_m,
            tilt_rad,
            pitch_radius_m,
            middle_z_m,
            first_angle_rad,
            cage_share: 0.5 - 0.25 * diameter_m * cosine / pitch_radius_m,
        }
    }
}
