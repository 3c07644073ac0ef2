//! What a mesh reports of its load: the force on gear 1 by directions that a gear designer names, and the line load of each slice.
//!
//! With e_r from the axis of gear 1 to gear 2 across that axis (parallel axes: towards gear 2's origin; bevel gears: towards gear 2's axis), e_t = e_z × e_r and F the force on gear 2 (friction included),
//!
//! ```text
//! tangential F_t = −F·e_t     counter-clockwise about gear 1's z: positive on right flanks
//! radial     F_r =  F·e_r     positive apart
//! axial      F_a = −F·e_z     along gear 1's z
//! ```
//!
//! all of them on gear 1; gear 2 feels the opposite force.

use gearmesh_geometry::Flank;
use nalgebra::Vector3;

use crate::gear_mesh::GearMesh;
use crate::pose::Pose;

/// Names of the channels of the force on gear 1.
pub(crate) const FORCE_CHANNELS: [&str; 3] = [
    "tangential_force_1_N",
    "radial_force_1_N",
    "axial_force_1_N",
];

/// F_t, F_r and F_a \[N\] on gear 1 at the last pose, which is given.
pub(crate) fn force_on_gear_1(mesh: &GearMesh, pose: &Pose) -> [f64; 3] {
    let towards = mesh.kinematics().towards_gear_2(pose);
    let load = &mesh.load().load;
    let force = Vector3::new(load[0], load[1], load[2]);
    let Some(radial) = Vector3::new(towards[0], towards[1], 0.0).try_normalize(0.0) else {
        return [0.0; 3];
    };
    let tangential = Vector3::z().cross(&radial);
    [-force.dot(&tangential), force.dot(&radial), -force[2]]
}

/// Line loads of the slices at the last pose: of each the largest among the pairs of teeth that touch there, for the pressure is theirs.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SliceLineLoads {
    /// Width of a slice \[m\].
    pub width_m: f64,
}

impl SliceLineLoads {
    /// Channel names of so many slices, counted along gear 1's z.
    pub(crate) fn names(slices: usize) -> impl Iterator<Item = String> {
        (1..=slices).map(|slice| format!("line_load_slice_{slice}_N_per_m"))
    }

    /// Writes q \[N/m\] of each slice.
    pub(crate) fn write(&self, mesh: &GearMesh, out: &mut [f64]) {
        out.fill(0.0);
        for flank in [Flank::Right, Flank::Left] {
            let Some((found, forces)) = mesh.side(flank) else {
                continue;
            };
            for (contact, force) in found.contacts.iter().zip(forces) {
                let width_m = self.width_m * found.section(contact).share;
                let place = &mut out[contact.slice];
                *place = place.max(force / width_m);
            }
        }
    }
}
