//! Second derivative of gaps of involute flanks by the increments of the pose (docs/theory/gear_meshes.md).

use gearmesh_geometry::Flank;

use crate::mesh_kinematics::MeshKinematics;
use crate::pose_geometry::PoseGeometry;
use crate::slice_plane::{Matrix6, SidePlanes};

impl MeshKinematics {
    /// Second derivative of the gap in a slice plane by the increments, microgeometry left out: that is of the order of
    /// the load times its curvature, 1e-6 of the stiffness. `roll_rad`: of the contact, or the means of several ones
    /// weighted by their forces; unused on spur teeth.
    ///
    /// # Panics
    /// If nothing was found or there is no such slice.
    #[must_use]
    pub fn gap_curvature(
        &self,
        (at, placed): (&PoseGeometry, &SidePlanes),
        slice: usize,
        side: Flank,
        roll_rad: [f64; 2],
    ) -> Matrix6 {
        let (plane, zero) = (&placed.planes[slice], &placed.zeros[slice]);
        let Some(frame) = &at.frame else {
            return Matrix6::zeros();
        };
        let sigma = self.circles.hand(side);
        let transverse = plane.transverse_curvature(frame, sigma);
        let Some(helix) = &self.helix else {
            return transverse;
        };
        helix.curvature((frame, plane), zero, (roll_rad, sigma), transverse)
    }
}
