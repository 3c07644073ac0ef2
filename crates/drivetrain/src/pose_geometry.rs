//! The axis halfway between the gears' axes at a pose, and the centre lines of the slices along it.

use std::f64::consts::TAU;

use gearmesh_contact::SliceLayout;
use gearmesh_contact::contact_zone::slice_place;
use gearmesh_geometry::BaseCircles;

use crate::error::DrivetrainError;
use crate::mesh_frame::MeshFrame;
use crate::pose::Pose;
use crate::slice_plane::CentreLine;

/// Slice planes at a pose, what both sides of the teeth share. Reused from call to call.
#[derive(Debug, Clone, Default)]
pub struct PoseGeometry {
    pub(crate) slices: Vec<CentreLine>,
    pub(crate) middle: Option<CentreLine>,
    pub(crate) frame: Option<MeshFrame>,
}

impl PoseGeometry {
    /// The slice that lies in the middle of the zone, where there is one.
    pub(crate) fn middle_slice(&self) -> Option<usize> {
        let slices = self.slices.len();
        (slices % 2 == 1).then_some(slices / 2)
    }

    /// Takes the slices of a layout at a pose; none where the faces no longer overlap.
    ///
    /// # Errors
    /// [`DrivetrainError::CentreDistance`].
    pub(crate) fn locate(
        &mut self,
        circles: BaseCircles,
        layout: &SliceLayout,
        pose: &Pose,
    ) -> Result<(), DrivetrainError> {
        self.slices.clear();
        self.middle = None;
        let frame = &*(self.frame).insert(MeshFrame::new(circles, layout.face_widths_m, pose));
        let middle = CentreLine::new(frame, frame.section(0.0))?;
        self.middle = Some(middle);
        if frame.zone.width_m
            <= layout.reference.width_m * gearmesh_contact::slice_part::LEAST_SHARE
        {
            return Ok(());
        }
        for slice in 0..layout.slices {
            let place = slice_place(slice, layout.slices);
            let mut line = if place == 0.0 {
                middle
            } else {
                CentreLine::new(frame, frame.section(place))?
            };
            // Where gear 1 has turned by half a turn, those of some slices would be π, of others −π, and teeth that are
            // counted in the middle would be a whole turn off.
            line.polar_rad += TAU * ((middle.polar_rad - line.polar_rad) / TAU).round();
            self.slices.push(line);
        }
        Ok(())
    }
}
