//! Angles over any number of turns, for output: each is taken next to its value at the last accepted step, so a step
//! must turn by less than half a revolution. What [`RelativeAngle`](gearmesh_dynamics::relative_angle::RelativeAngle)
//! is for joints, for any angle.

use std::f64::consts::{PI, TAU};

use gearmesh_dynamics::rotation::cardan_xyz;
use nalgebra::{Matrix3, UnitQuaternion};

/// Angles of one thing, counted together.
#[derive(Debug, Clone, PartialEq)]
pub struct CountedAngles<const N: usize> {
    committed_rad: [f64; N],
}

impl<const N: usize> CountedAngles<N> {
    /// Begins with these angles.
    pub fn begin(angles_rad: [f64; N]) -> Self {
        Self {
            committed_rad: angles_rad,
        }
    }

    /// The angles with their turns, from angles that are known up to whole turns.
    pub fn value(&self, wrapped_rad: [f64; N]) -> [f64; N] {
        let mut angles = wrapped_rad;
        for (angle, committed) in angles.iter_mut().zip(self.committed_rad) {
            *angle += TAU * ((committed - *angle) / TAU).round();
        }
        angles
    }

    /// Keeps the angles of an accepted step.
    pub fn commit(&mut self, wrapped_rad: [f64; N]) {
        self.committed_rad = self.value(wrapped_rad);
    }

    /// For a checkpoint.
    pub fn save(&self, out: &mut Vec<f64>) {
        out.extend(self.committed_rad);
    }

    /// Takes the first N numbers, as [`Self::save`] wrote them, off a list; none are taken from one that is too short.
    pub fn restore(&mut self, numbers: &mut &[f64]) {
        if let Some((own, rest)) = numbers.split_first_chunk::<N>() {
            self.committed_rad = *own;
            *numbers = rest;
        }
    }
}

/// Cardan angles of a body, and how far it has turned about its own z axis since the start: twist of q₀⁻¹ q, whatever
/// the tilt of the axis in the world, where Cardan angles may be singular.
pub fn body_angles(
    start: &UnitQuaternion<f64>,
    orientation: &UnitQuaternion<f64>,
    rotation: &Matrix3<f64>,
) -> [f64; 4] {
    let [x, y, z] = cardan_xyz(rotation);
    let since = start.inverse() * orientation;
    let mut turn = 2.0 * since.k.atan2(since.w);
    if turn > PI {
        turn -= TAU;
    } else if turn <= -PI {
        turn += TAU;
    }
    [x, y, z, turn]
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector3;

    #[test]
    fn turns_are_counted_about_an_axis_in_any_direction() {
        for tilt in [0.0, 0.5, std::f64::consts::FRAC_PI_2, 3.0] {
            let start = UnitQuaternion::from_axis_angle(&Vector3::y_axis(), tilt);
            let at = |angle: f64| {
                let q = start * UnitQuaternion::from_axis_angle(&Vector3::z_axis(), angle);
                body_angles(&start, &q, q.to_rotation_matrix().matrix())
            };
            let mut counted = CountedAngles::begin(at(0.0));
            for step in 0..=40 {
                let angle = -0.7 * f64::from(step);
                let [_, _, _, turn] = counted.value(at(angle));
                assert!((turn - angle).abs() < 1e-12, "{turn} for {angle}");
                counted.commit(at(angle));
            }
        }
    }

    #[test]
    fn saved_angles_come_back() {
        let mut counted = CountedAngles::begin([0.0, 1.0]);
        counted.commit([3.0, -2.0]);
        counted.commit([-3.0, 2.0]);
        let mut saved = Vec::new();
        counted.save(&mut saved);
        saved.push(7.0);
        let mut other = CountedAngles::begin([0.0; 2]);
        let mut rest = &saved[..];
        other.restore(&mut rest);
        assert_eq!((other, rest), (counted, &[7.0][..]));
    }
}
