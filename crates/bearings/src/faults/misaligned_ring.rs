//! A ring that stands askew or aside on its seat: its marker is turned and moved, exactly.

use gearmesh_dynamics::{Marker, rotation};
use nalgebra::{UnitQuaternion, Vector3};

/// How a ring stands on its seat.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MisalignedRing {
    /// Rotation vector of the ring's axis about x and y of the seat \[rad\].
    pub tilt_rad: [f64; 2],
    /// Displacement of its middle along the axes of the seat \[m\].
    pub offset_m: [f64; 3],
}

impl MisalignedRing {
    /// The ring's own marker on the marker of its seat.
    #[must_use]
    pub fn on(&self, seat: &Marker) -> Marker {
        let axes = seat.orientation();
        let [x, y] = self.tilt_rad;
        let turn = rotation::exp(&Vector3::new(x, y, 0.0));
        let mut ring = *seat;
        ring.position_m += axes * Vector3::from(self.offset_m);
        ring.oriented(UnitQuaternion::from_rotation_matrix(&axes) * turn)
    }
}
