//! What a mesh reports of its load: the force on gear 1 by directions that a gear designer names, and the line load of
//! each slice.
//!
//! With e_r from the axis of gear 1 to gear 2 across that axis (parallel axes: towards gear 2's origin; bevel gears:
//! towards gear 2's axis), e_t = e_z × e_r and F the force on gear 2 (friction included),
//!
//! ```text
//! tangential F_t = −F·e_t     counter-clockwise about gear 1's z: positive on right flanks
//! radial     F_r =  F·e_r     positive apart
//! axial      F_a = −F·e_z     along gear 1's z
//! ```
//!
//! all of them on gear 1; gear 2 feels the opposite force. Moments are those on the bodies, about their own z.

use gearmesh_dynamics::elements::Channel;
use gearmesh_geometry::Flank;
use nalgebra::Vector3;

use crate::gear_mesh::GearMesh;
use crate::pose::Pose;

/// Sum of the normal forces on the flanks of a side.
pub(crate) fn normal_force(flank: Flank) -> Channel {
    let side = flank.name();
    let what = format!("sum of the normal forces on the {side} flanks");
    Channel::new(format!("normal_force_{side}_N"), "N", what)
}

/// Number of [`powers`].
pub(crate) const POWERS: usize = 2;

/// Of meshes whose teeth rub: what friction takes, and what gear 1 puts in.
pub(crate) fn powers() -> [Channel; POWERS] {
    let watts = |name, what| Channel::new(name, "W", what);
    [
        watts("friction_power_W", "power that friction of the teeth takes"),
        watts(
            "power_W",
            "power that the body of gear 1 puts into the mesh; negative where it takes it out",
        ),
    ]
}

/// Transmission error, pairs of teeth that carry, and whether the gears are apart.
pub(crate) fn state() -> [Channel; 3] {
    let te = "transmission error of the flanks in contact about the bodies' axes, zero at first touch, negative under load; where none touch that of the \
              nearest";
    [
        Channel::new("transmission_error_m", "m", te),
        Channel::new("loaded_pairs", "1", "pairs of teeth that carry"),
        Channel::new("apart", "1", "1 where no tooth reaches the mate, else 0"),
    ]
}

/// Root strain at a gauge of gear 1 or 2 by method 1 or 2.
pub(crate) fn strain(gear: usize, gauge: &str, method: usize) -> Channel {
    let what = format!(
        "root strain at gauge {gauge} of gear {gear} by method {method}, positive in tension"
    );
    Channel::new(
        format!("strain_gear{gear}_{gauge}_method{method}_ustrain"),
        "µε",
        what,
    )
}

/// Number of the channels of the force on gear 1.
pub(crate) const FORCES: usize = 3;

/// The force on gear 1.
pub(crate) fn forces() -> [Channel; FORCES] {
    let channel = |name, what| Channel::new(name, "N", what);
    [
        channel(
            "tangential_force_1_N",
            "tangential force on gear 1, counter-clockwise about its z",
        ),
        channel("radial_force_1_N", "radial force on gear 1, positive apart"),
        channel("axial_force_1_N", "axial force on gear 1 along its z"),
    ]
}

/// Number of [`moments`].
pub(crate) const MOMENTS: usize = 2;

/// Moments of the mesh on both gears: M₁ and M₂ with M₁ ω₁ + M₂ ω₂ = −P of the teeth's friction where nothing
/// accelerates.
pub(crate) fn moments() -> [Channel; MOMENTS] {
    [1, 2].map(|gear| {
        let what = format!(
            "moment of the mesh on the body of gear {gear} about its own z, counter-clockwise positive"
        );
        Channel::new(format!("moment_{gear}_Nm"), "N·m", what)
    })
}

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

/// Line loads of the slices at the last pose: of each the largest among the pairs of teeth that touch there, for the
/// pressure is theirs.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SliceLineLoads {
    /// Width of a slice \[m\].
    pub width_m: f64,
}

impl SliceLineLoads {
    /// Channels of so many slices, counted along gear 1's z.
    pub(crate) fn channels(slices: usize) -> impl Iterator<Item = Channel> {
        let what = "line load of the slice, counted along gear 1's z: the largest among the pairs of teeth that touch there";
        (1..=slices)
            .map(move |slice| Channel::new(format!("line_load_slice_{slice}_N_per_m"), "N/m", what))
    }

    /// Writes q \[N/m\] of each slice.
    pub(crate) fn write(&self, mesh: &GearMesh, out: &mut [f64]) {
        out.fill(0.0);
        for flank in [Flank::Right, Flank::Left] {
            let Some((found, forces)) = mesh.side(flank) else {
                continue;
            };
            // Nodes of one slice of a pair share its width.
            let of_slice = |n: usize| (found.contacts[n].line, found.contacts[n].slice);
            for (first, contact) in found.contacts.iter().enumerate() {
                let same = |n: &usize| of_slice(*n) == of_slice(first);
                if (0..first).any(|n| same(&n)) {
                    continue;
                }
                let sum: f64 = (first..forces.len()).filter(same).map(|n| forces[n]).sum();
                let width_m = self.width_m * found.section(contact).share;
                let place = &mut out[contact.slice];
                *place = place.max(sum / width_m);
            }
        }
    }
}
