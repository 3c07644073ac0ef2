//! Nominal points and normals of a flank for a measuring machine, as a table that pair files read back (`settings =
//! "points"`).

use std::fmt::Write as _;

use crate::error::BevelError;
use crate::hand::FlankSide;
use crate::tooth::Tooth;

/// The grid ends so far inside toe, heel, tip and the lower end of the flank, as a share of the face and of the height
/// there: probes need room.
const MARGIN: f64 = 0.05;
/// Places along the face at which the lower end is looked at.
const LOOKS: usize = 17;

impl Tooth {
    /// Table of a flank: `size` sectors from toe to heel times heights from root to tip, coordinates in the member's
    /// frame (origin in the pitch apex, z towards the heel, the middle of the tooth on +x at the mean point, so that
    /// both flanks stand a tooth apart), normals out of the material.
    ///
    /// # Errors
    /// [`BevelError::NoFlankPoint`] where the surface does not reach over its blank.
    pub fn nominal_grid_csv(
        &self,
        side: FlankSide,
        [sectors, heights]: [usize; 2],
    ) -> Result<String, BevelError> {
        let flank = self.flank(side);
        let blank = &self.blank;
        let (sin, cos) = self.half_angle_rad(side).sin_cos();
        let inside = |i: usize, count: usize| {
            MARGIN + (1.0 - 2.0 * MARGIN) * i as f64 / (count.max(2) - 1) as f64
        };
        // Heights are shares of the way from one straight line, above the fillet all along the face, to the tip.
        let cone = |share: f64| blank.inner_cone_m() + share * blank.face_width_m;
        let depth = |cone: f64| blank.addendum_m(cone) + blank.dedendum_m(cone);
        let mut lowest = 0.0f64;
        for i in 0..LOOKS {
            let at = cone(i as f64 / (LOOKS - 1) as f64);
            let bottom = flank.bottom(at)?;
            let above_root = flank.place(&bottom.point.r)[1] + blank.dedendum_m(at);
            lowest = lowest.max(above_root / depth(at));
        }
        let mut text = "sector,height,x_mm,y_mm,z_mm,nx,ny,nz\n".to_owned();
        for i in 0..sectors {
            let at = cone(inside(i, sectors));
            for k in 0..heights {
                let share = lowest + (1.0 - lowest) * inside(k, heights);
                let height = share * depth(at) - blank.dedendum_m(at);
                let p = flank.locate(at, height)?.point;
                let turned = |v: &nalgebra::Vector3<f64>| {
                    [v.x * cos - v.y * sin, v.x * sin + v.y * cos, v.z]
                };
                let [x, y, z] = turned(&p.r).map(|x| 1e3 * x);
                let [nx, ny, nz] = turned(&-p.n);
                let _ = writeln!(
                    text,
                    "{},{},{x:.6},{y:.6},{z:.6},{nx:.9},{ny:.9},{nz:.9}",
                    i + 1,
                    k + 1
                );
            }
        }
        Ok(text)
    }
}
