//! How the axes of two gears in mesh stand to each other in a result, as bending shafts and bearings leave them.

use gearmesh_geometry::{BaseCircles, Flank, Misalignment};
use gearmesh_model::FileError;
use nalgebra::{Rotation3, Vector3};

use super::job::MeshRecord;
use super::result::SystemResult;

/// Axes of a mesh at a row of a result.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeshAxes {
    /// Distance of the gears' origins across gear 1's axis \[m\].
    pub centre_distance_m: f64,
    /// Slopes of gear 2's axis against gear 1's, per length of z: along the line of centres from gear 1 to gear 2, and
    /// across it (z of gear 1 × that line) \[rad\].
    pub slopes_rad: [f64; 2],
    /// Base circles of both, over those of one tooth.
    circles: BaseCircles,
}

impl MeshAxes {
    /// Axes of gears at these places: origins \[m\] and unit vectors of their z.
    fn new(origins_m: [Vector3<f64>; 2], axes: [Vector3<f64>; 2], circles: BaseCircles) -> Self {
        let [z, other] = axes;
        let apart = origins_m[1] - origins_m[0];
        let centres = apart - z * apart.dot(&z);
        let along = centres.normalize();
        let across = z.cross(&along);
        let slope = other / other.dot(&z) - z;
        Self {
            centre_distance_m: centres.norm(),
            slopes_rad: [slope.dot(&along), slope.dot(&across)],
            circles,
        }
    }

    /// Inclination and deviation of a pair in contact on these flanks of gear 1: they open where gear 2's axis moves
    /// across the line of centres as the normal force pushes it.
    #[must_use]
    pub fn misalignment(&self, flank: Flank) -> Misalignment {
        Misalignment {
            inclination_rad: self.slopes_rad[0],
            deviation_rad: self.circles.action(0.0, flank)[1] * self.slopes_rad[1],
        }
    }
}

impl SystemResult {
    /// The axes of a mesh's gears at a row; `swapped` takes gear 2 of the mesh for gear 1. None where the result does
    /// not have the places of both bodies at that row.
    ///
    /// # Errors
    /// [`FileError`] when the file cannot be read.
    pub fn mesh_axes(
        &self,
        mesh: &MeshRecord,
        row: usize,
        swapped: bool,
    ) -> Result<Option<MeshAxes>, FileError> {
        let mut bodies = [&mesh.bodies[0], &mesh.bodies[1]];
        let mut circles = mesh.circles();
        if swapped {
            bodies.swap(0, 1);
            circles.radii_m.swap(0, 1);
        }
        let mut places = [(Vector3::zeros(), Vector3::zeros()); 2];
        for (body, place) in bodies.into_iter().zip(&mut places) {
            let read = |names: [&str; 3]| -> Result<Option<Vector3<f64>>, FileError> {
                let mut found = Vector3::zeros();
                for (k, name) in names.into_iter().enumerate() {
                    let column = format!("bodies/{body}/{name}");
                    if !self.rows.columns().iter().any(|c| c.name == column) {
                        return Ok(None);
                    }
                    let Some(value) = self.rows.read(&column)?.get(row).copied() else {
                        return Ok(None);
                    };
                    found[k] = value;
                }
                Ok(Some(found))
            };
            let origin = read(["x_m", "y_m", "z_m"])?;
            let angles = read(["cardan_x_rad", "cardan_y_rad", "cardan_z_rad"])?;
            let (Some(origin), Some(angles)) = (origin, angles) else {
                return Ok(None);
            };
            // R = Rx Ry Rz; the turn about z leaves the axis where it is.
            let turn = Rotation3::from_axis_angle(&Vector3::x_axis(), angles[0])
                * Rotation3::from_axis_angle(&Vector3::y_axis(), angles[1]);
            *place = (origin, turn * Vector3::z());
        }
        let [(origin_1, axis_1), (origin_2, axis_2)] = places;
        Ok(Some(MeshAxes::new(
            [origin_1, origin_2],
            [axis_1, axis_2],
            circles,
        )))
    }

    /// The flanks that carry more of a mesh at a row; none where nothing is known or nothing is carried.
    ///
    /// # Errors
    /// [`FileError`] when the file cannot be read.
    pub fn loaded_flank(&self, mesh: &str, row: usize) -> Result<Option<Flank>, FileError> {
        let [right, left] = self.normal_forces_n(mesh, row)?;
        Ok(match right.total_cmp(&left) {
            std::cmp::Ordering::Greater => Some(Flank::Right),
            std::cmp::Ordering::Less => Some(Flank::Left),
            std::cmp::Ordering::Equal => None,
        })
    }

    /// Normal force \[N\] on the flanks that carry more of a mesh at a row; none where nothing is known or nothing is
    /// carried.
    ///
    /// # Errors
    /// [`FileError`] when the file cannot be read.
    pub fn loaded_force_n(&self, mesh: &str, row: usize) -> Result<Option<f64>, FileError> {
        let [right, left] = self.normal_forces_n(mesh, row)?;
        let force = right.max(left);
        Ok((force > 0.0).then_some(force))
    }

    /// On right and left flanks \[N\]; zero where the result does not have them.
    fn normal_forces_n(&self, mesh: &str, row: usize) -> Result<[f64; 2], FileError> {
        let force = |side: &str| -> Result<f64, FileError> {
            let column = format!("elements/{mesh}/normal_force_{side}_N");
            if !self.rows.columns().iter().any(|c| c.name == column) {
                return Ok(0.0);
            }
            Ok(self.rows.read(&column)?.get(row).copied().unwrap_or(0.0))
        };
        Ok([force("right")?, force("left")?])
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    /// Whatever frame the gears are seen in, the pair's own directions give the slopes.
    #[test]
    fn slopes_are_those_along_and_across_the_line_of_centres() {
        let frame = Rotation3::from_euler_angles(0.7, -0.3, 2.1);
        let origin_2 = Vector3::new(0.15, 0.0, 3e-3);
        let lean = Vector3::new(2e-4, -5e-4, 1.0).normalize();
        let with_teeth = |radii_m: [f64; 2]| {
            MeshAxes::new(
                [Vector3::zeros(), frame * origin_2],
                [frame * Vector3::z(), frame * lean],
                BaseCircles { radii_m },
            )
        };
        let found = with_teeth([20.0, 30.0]);
        assert!((found.centre_distance_m - 0.15).abs() < 1e-15);
        assert!((found.slopes_rad[0] - 2e-4).abs() < 1e-15);
        assert!((found.slopes_rad[1] + 5e-4).abs() < 1e-15);
        // Gear 2 leans to −y: right flanks, on which gear 1 drives clockwise and pushes gear 2 to −y, are opened.
        let right = found.misalignment(Flank::Right);
        assert!((right.deviation_rad - 5e-4).abs() < 1e-15);
        let left = found.misalignment(Flank::Left);
        assert!((left.deviation_rad + 5e-4).abs() < 1e-15);
        assert_eq!(right.inclination_rad, left.inclination_rad);
        // The gear inside a ring pushes it on the far side, to +y where it drives; a ring that drives pushes the gear
        // inside as one outside would.
        for (teeth, sign) in [([20.0, -30.0], -1.0), ([-30.0, 20.0], 1.0)] {
            let right = with_teeth(teeth).misalignment(Flank::Right);
            assert!((right.deviation_rad - sign * 5e-4).abs() < 1e-15);
        }
    }
}
