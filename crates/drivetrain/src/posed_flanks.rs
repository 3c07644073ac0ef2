//! Flanks of any family at rest: those of a gear mesh at the pose of the driver angle.
//!
//! The pose at which the transmission error is zero is given for each driver angle θ₁. From there gear 2 deflects
//! about its own axis e₂; with u its place and g the gradient of a gap by the increments of the pose, R₂ the radius
//! along which the transmission error is counted and σ = ±1 for right and left flanks, a normal force of one newton
//! makes the torques
//!
//! ```text
//! b₁ = −σ g·(e_z × u, e_z),     b₂ = σ g·(0, e₂)          and the approach closes the gap at the rate b₂/R₂
//! ```
//!
//! On involute flanks b₁ = r_b1 cos β_b and b₂ = r_b2 cos β_b. Without friction.

use gearmesh_contact::{ContactError, ContactPatch, FlanksAtRest, PatchBalance, TipGear};
use gearmesh_geometry::Flank;
use nalgebra::Vector3;

use crate::flank_contacts::FlankContacts;
use crate::flank_kinematics::FlankKinematics;
use crate::pose::{Pose, on_turn, stacked};

/// Flanks of a mesh and the poses at which they stand.
pub struct PosedFlanks<K, P> {
    kinematics: K,
    side: Flank,
    radius_2_m: f64,
    pose_at: P,
    found: FlankContacts,
}

impl<K: FlankKinematics, P: Fn(f64) -> Pose> PosedFlanks<K, P> {
    /// The flanks of one side; `pose_at`: where gear 2 stands at a driver angle \[rad\] with zero transmission error,
    /// which is counted at the radius `radius_2_m`.
    pub fn new(kinematics: K, side: Flank, radius_2_m: f64, pose_at: P) -> Self {
        Self {
            found: FlankContacts::with_capacity(kinematics.capacity()),
            kinematics,
            side,
            radius_2_m,
            pose_at,
        }
    }
}

impl<K: FlankKinematics, P: Fn(f64) -> Pose> FlanksAtRest for PosedFlanks<K, P> {
    fn patches_at(
        &mut self,
        driver_angle_rad: f64,
        patches: &mut Vec<ContactPatch>,
    ) -> Result<(), ContactError> {
        let pose = (self.pose_at)(driver_angle_rad);
        let located = self.kinematics.locate(&pose);
        located.map_err(|cause| ContactError::Flanks(Box::new(cause)))?;
        (self.kinematics).contacts(&pose, self.side, &mut self.found);
        let sigma = self.side.mirror();
        let turn_1 = -sigma * stacked(Vector3::z().cross(&pose.displacement_m), Vector3::z());
        let turn_2 = sigma * on_turn(pose.axis_2());
        for (number, line) in self.found.lines.iter().enumerate() {
            let (first, count) = line.contacts;
            for contact in first..first + count {
                let gradient = &self.found.contacts[contact].gradient;
                let levers_m = [gradient.dot(&turn_1), gradient.dot(&turn_2)];
                patches.push(ContactPatch {
                    balance: PatchBalance {
                        closing: levers_m[1] / self.radius_2_m,
                        levers_m,
                        friction: 0.0,
                    },
                    ..self.found.patch((number, line), contact)
                });
            }
        }
        if patches.is_empty() {
            return Err(ContactError::NothingFaces);
        }
        Ok(())
    }

    fn lines(&self) -> usize {
        self.found.lines.len()
    }

    /// The tooth of gear 1; edges are places on the flanks.
    fn pair_and_tip(&self, line: usize) -> (i64, Option<TipGear>) {
        (self.found.lines[line].teeth[0] as i64, None)
    }

    fn reaches(&mut self, approach_m: f64) -> Result<bool, ContactError> {
        let reached = self.kinematics.reaches(approach_m);
        reached.map_err(|cause| ContactError::Flanks(Box::new(cause)))
    }

    fn radius_2_m(&self) -> f64 {
        self.radius_2_m
    }
}
