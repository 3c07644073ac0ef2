//! Involute gears on parallel axes as a mesh sees them: their kinematics at the last pose.

use gearmesh_contact::SliceLayout;
use gearmesh_geometry::Flank;

use crate::error::DrivetrainError;
use crate::flank_contacts::FlankContacts;
use crate::flank_kinematics::{FlankKinematics, Tangent};
use crate::friction::SlidingAt;
use crate::mesh_kinematics::MeshKinematics;
use crate::pose::Pose;
use crate::pose_geometry::PoseGeometry;
use crate::slice_plane::{Matrix6, SidePlanes};

/// Involute kinematics, the last pose and the slice planes of both sides there.
pub(crate) struct InvoluteMesh {
    kinematics: MeshKinematics,
    at: PoseGeometry,
    sides: [SidePlanes; 2],
}

impl InvoluteMesh {
    pub(crate) fn new(kinematics: MeshKinematics) -> Self {
        Self {
            kinematics,
            at: PoseGeometry::default(),
            sides: Default::default(),
        }
    }

    /// Slice planes of a side.
    fn planes(&self, side: Flank) -> &SidePlanes {
        &self.sides[side as usize]
    }
}

impl FlankKinematics for InvoluteMesh {
    fn layout(&self) -> &SliceLayout {
        self.kinematics.layout()
    }

    fn capacity(&self) -> usize {
        self.kinematics.capacity()
    }

    fn side_of(&self, gear: usize, side: Flank) -> Flank {
        self.kinematics.circles.side_of(gear, side)
    }

    fn hand(&self, side: Flank) -> f64 {
        self.kinematics.circles.hand(side)
    }

    /// Base pitch, in the transverse plane.
    fn pitch_m(&self) -> f64 {
        self.kinematics.base_pitch_m()
    }

    fn has_errors(&self) -> bool {
        self.kinematics.has_errors()
    }

    fn most_added_m(&self) -> f64 {
        self.kinematics.most_added_m
    }

    fn share_one_gap(&mut self) -> Result<(), DrivetrainError> {
        self.kinematics.share_one_gap();
        Ok(())
    }

    fn locate(&mut self, pose: &Pose) -> Result<(), DrivetrainError> {
        self.kinematics.locate(pose, &mut self.at)
    }

    fn open_gap_m(&self, side: Flank) -> Option<f64> {
        self.kinematics.open_gap_m(&self.at, side)
    }

    fn contacts(&mut self, pose: &Pose, side: Flank, found: &mut FlankContacts) {
        let planes = &mut self.sides[side as usize];
        (self.kinematics).contacts_at((pose, &self.at), side, planes, found);
    }

    fn contacts_at(
        &self,
        pose: &Pose,
        side: Flank,
        found: &mut FlankContacts,
    ) -> Result<(), DrivetrainError> {
        self.kinematics.contacts(pose, side, found).map(|_| ())
    }

    fn gap_curvature(&self, found: &FlankContacts, contact: usize, side: Flank) -> Matrix6 {
        let contact = &found.contacts[contact];
        // Roll angles in the middle of a slice: those of the section but for a slice that is partly on the path.
        let roll_rad = found.section(contact).roll_rad;
        let placed = (&self.at, self.planes(side));
        (self.kinematics).gap_curvature(placed, contact.slice, side, roll_rad)
    }

    /// Plane by plane: there it changes with the roll angles in proportion, so that their mean by the forces stands for
    /// all contacts.
    fn load_curvature(&self, found: &FlankContacts, forces_n: &[f64], side: Flank) -> Matrix6 {
        let mut sum = Matrix6::zeros();
        let placed = (&self.at, self.planes(side));
        for slice in 0..placed.1.planes.len() {
            let (mut of_plane, mut rolled) = (0.0, [0.0; 2]);
            let in_plane = found.contacts.iter().zip(forces_n);
            for (contact, force) in in_plane.filter(|(contact, _)| contact.slice == slice) {
                of_plane += force;
                let roll_rad = found.section(contact).roll_rad;
                (0..2).for_each(|gear| rolled[gear] += force * roll_rad[gear]);
            }
            if of_plane > 0.0 {
                let mean_rad = rolled.map(|sum| sum / of_plane);
                sum += of_plane * (self.kinematics).gap_curvature(placed, slice, side, mean_rad);
            }
        }
        sum
    }

    fn sliding(
        &self,
        found: &FlankContacts,
        contact: usize,
        side: Flank,
        derivatives: bool,
    ) -> [Option<Tangent>; 2] {
        let Some(frame) = &self.at.frame else {
            return [None; 2];
        };
        let contact = &found.contacts[contact];
        let at = SlidingAt {
            frame,
            plane: &self.planes(side).planes[contact.slice],
            sigma: self.hand(side),
            roll_rad: found.section(contact).touching_roll_rad[0],
        };
        let profile = Tangent {
            direction: at.direction(),
            change: derivatives.then(|| at.direction_gradient()),
        };
        [Some(profile), None]
    }

    /// Transverse.
    fn nearest_gap_m(&self, side: Flank) -> Option<f64> {
        self.kinematics.nearest_gap_m(&self.at, side)
    }

    fn is_apart(&self) -> bool {
        self.kinematics.is_apart(&self.at)
    }
}
