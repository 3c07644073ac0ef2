//! Digital flanks of the families: bevel gears and involute gears.

use gearmesh_geometry::flank_error::FlankPoint;
use gearmesh_geometry::{Flank, GearPair, ToothGeometry};
use nalgebra::{Rotation3, Vector3};

use super::digital_flank::{DigitalFlank, PatchSize};
use super::node_contacts::NodeSurfaces;
use super::reference_area::{line_contact_area_m2, point_contact_area_m2};
use crate::bevel::BevelMesh;
use crate::error::DrivetrainError;
use crate::flank_contacts::FlankErrors;
use crate::involute_mesh::InvoluteMesh;
use crate::mesh_kinematics::MeshKinematics;

/// Approach δ_ref \[m\] and exponent of the law at which the whole contact gives the stated force; see
/// `reference_area.rs`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ReferenceApproach {
    /// δ_ref = (F_nominal/K)^(1/e).
    pub approach_m: f64,
    /// e.
    pub exponent: f64,
}

impl NodeSurfaces {
    /// Both sides of a bevel pair, in so many slices for channels and modes; `reference`: none gives every node the
    /// whole law.
    ///
    /// # Errors
    /// As [`DigitalFlank::new`].
    pub fn of_bevel(
        flanks: BevelMesh,
        size: PatchSize,
        slices: usize,
        reference: Option<ReferenceApproach>,
    ) -> Result<Self, DrivetrainError> {
        let flank = |side: Flank, gear: usize| {
            DigitalFlank::new(side, (size, slices), [0.0, 1.0], |s, v| {
                flanks.flank_point_m(side, gear, [s, v])
            })
        };
        let of_side = |side| Ok::<_, DrivetrainError>([flank(side, 0)?, flank(side, 1)?]);
        let sides = [of_side(Flank::Right)?, of_side(Flank::Left)?];
        let area = reference.map(|reference| {
            let radii_m = (flanks.mean_curvature(Flank::Right).principal_per_m).map(|k| 1.0 / k);
            point_contact_area_m2(radii_m, reference.approach_m, reference.exponent)
        });
        let (teeth, widths_m) = (flanks.teeth(), flanks.face_widths_m());
        let made = Self::new(Box::new(flanks), (teeth, widths_m), slices, sides, area);
        Ok(made.sliding_along())
    }

    /// Both sides of involute gears with what is removed from all their teeth alike; `kinematics`: of the same gears.
    ///
    /// # Errors
    /// As [`DigitalFlank::new`].
    pub fn of_involutes(
        kinematics: MeshKinematics,
        (pair, widths_m, removed): (&GearPair, [f64; 2], &[FlankErrors; 2]),
        size: PatchSize,
        slices: usize,
        reference: Option<ReferenceApproach>,
    ) -> Result<Self, DrivetrainError> {
        let gears = [&pair.gear_1, &pair.gear_2];
        let flank = |side: Flank, gear: usize| {
            let tooth = gears[gear];
            let ends = [tooth.form_roll_rad, tooth.flank_end_roll_rad];
            DigitalFlank::new(side, (size, slices), ends, |s, roll| {
                involute_point_m(
                    tooth,
                    side,
                    (s - 0.5) * widths_m[gear],
                    roll,
                    &removed[gear],
                )
            })
        };
        let of_side = |side| Ok::<_, DrivetrainError>([flank(side, 0)?, flank(side, 1)?]);
        let sides = [of_side(Flank::Right)?, of_side(Flank::Left)?];
        let area = reference.map(|reference| {
            // Across the line of contact at the pitch point, in the normal section.
            let angle = pair.working_pressure_angle_rad;
            let radii = gears.map(|gear| gear.base_radius_m * angle.tan());
            let helix_cos = pair.gear_1.base_helix_angle_rad().cos();
            let radius_m = radii[0] * radii[1] / (radii[0] + radii[1]) / helix_cos;
            let length_m = widths_m[0].min(widths_m[1]) / helix_cos;
            line_contact_area_m2(length_m, radius_m, reference.approach_m, reference.exponent)
        });
        let teeth = gears.map(|gear| gear.teeth);
        let smooth = Box::new(InvoluteMesh::new(kinematics));
        Ok(Self::new(smooth, (teeth, widths_m), slices, sides, area))
    }
}

/// Point \[m\] of tooth 0 at a height above mid-face and a roll angle, with what is removed along the inward normal.
fn involute_point_m(
    tooth: &ToothGeometry,
    side: Flank,
    z_m: f64,
    roll_rad: f64,
    removed: &FlankErrors,
) -> Vector3<f64> {
    let [x, y] = tooth.flank_point_m(side, roll_rad);
    let at = FlankPoint {
        tooth: 0,
        side,
        roll_rad,
        z_m,
    };
    let depth_m: f64 = removed.iter().map(|error| error.removed(at).depth_m).sum();
    let inwards = Vector3::from(tooth.flank_normal(side, roll_rad));
    let screw_rad = z_m * tooth.helix_angle_rad.tan() / tooth.reference_radius_m;
    let turned = Rotation3::from_axis_angle(&Vector3::z_axis(), screw_rad);
    turned * (Vector3::new(x, y, 0.0) + depth_m * inwards) + z_m * Vector3::z()
}
