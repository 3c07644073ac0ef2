//! Eccentricity: the gear's own axis stands beside, or tilted to, the axis about which its body turns. Not a deviation
//! of the flanks but a place of the gear on its body: runout and wobble follow from the kinematics.

use gearmesh_dynamics::{BodyId, Marker};
use nalgebra::{UnitQuaternion, Vector3};

use crate::error::DrivetrainError;

/// Place of a gear on its body.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Eccentricity {
    /// Distance of the gear's axis from the body's z axis \[m\].
    pub offset_m: f64,
    /// Direction of that offset from the body's x axis \[rad\].
    pub direction_rad: f64,
    /// Tilt of the gear's axis \[rad\], about the axis that `tilt_direction_rad` gives: wobble of the face.
    pub tilt_rad: f64,
    /// Direction of the axis of the tilt from the body's x axis \[rad\].
    pub tilt_direction_rad: f64,
}

impl Eccentricity {
    /// The gear's frame on a body, its mid-face at `z_m` of the body and tooth 0 at the polar angle `phase_rad`.
    ///
    /// # Errors
    /// [`DrivetrainError::Value`] if a number is not finite.
    pub fn marker(
        &self,
        body: BodyId,
        z_m: f64,
        phase_rad: f64,
    ) -> Result<Marker, DrivetrainError> {
        for (what, found) in [
            ("the offset in m", self.offset_m),
            ("the direction in rad", self.direction_rad),
            ("the tilt in rad", self.tilt_rad),
            ("the tilt's direction in rad", self.tilt_direction_rad),
            ("the mid-face position in m", z_m),
            ("the phase in rad", phase_rad),
        ] {
            DrivetrainError::require("eccentricity", (what, found), found.is_finite(), "finite")?;
        }
        let (sin, cos) = self.direction_rad.sin_cos();
        let (tilt_sin, tilt_cos) = self.tilt_direction_rad.sin_cos();
        let tilt = self.tilt_rad * Vector3::new(tilt_cos, tilt_sin, 0.0);
        let phase = Vector3::new(0.0, 0.0, phase_rad);
        let orientation =
            UnitQuaternion::from_scaled_axis(tilt) * UnitQuaternion::from_scaled_axis(phase);
        Ok(Marker::at(body, [self.offset_m * cos, self.offset_m * sin, z_m]).oriented(orientation))
    }
}
