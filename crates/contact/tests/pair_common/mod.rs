//! Gear pairs and made-up reduced gears for the tests of contact.
#![allow(clippy::unwrap_used, dead_code, missing_docs)]

#[path = "../../../../tests/support/made_up_models.rs"]
pub mod made_up_models;

use gearmesh_contact::{ContactLines, ContactOptions, LocalContact, PathExtension, StaticContact};
use gearmesh_geometry::definition::ToothDefinition;
use gearmesh_geometry::{Flank, GearPair, Microgeometry, Misalignment, ToothGeometry};
use gearmesh_model::{FlankGrid, ReducedGear};
use made_up_models::small_reduced_gear;

/// A tooth of the standard rack.
pub fn tooth(teeth: usize, profile_shift: f64, tip_chamfer_m: f64) -> ToothDefinition {
    ToothDefinition {
        teeth,
        gearing: Default::default(),
        module_m: 3e-3,
        pressure_angle_rad: 20f64.to_radians(),
        profile_shift,
        addendum: 1.0,
        dedendum: 1.25,
        rack_tip_radius: 0.25,
        tip_diameter_m: None,
        thickness_allowance_m: 0.1e-3,
        tip_chamfer_m,
        face_width_m: 20e-3,
        helix_angle_rad: 0.0,
    }
}

/// A pair at the centre distance of its profile shifts, to first order.
pub fn pair(tooth_1: &ToothDefinition, tooth_2: &ToothDefinition) -> GearPair {
    let module = tooth_1.module_m;
    let shifts = tooth_1.profile_shift + tooth_2.profile_shift;
    let centre = module * (0.5 * (tooth_1.teeth + tooth_2.teeth) as f64 + shifts);
    GearPair::new(
        ToothGeometry::new(tooth_1).unwrap(),
        ToothGeometry::new(tooth_2).unwrap(),
        centre,
        Misalignment::default(),
    )
    .unwrap()
}

/// 24 teeth in a ring of 75, module 3 mm, both hands right where the angle is positive; the planet is gear 1, or the
/// ring.
pub fn ring_pair(helix_deg: f64, ring_drives: bool) -> GearPair {
    use gearmesh_geometry::definition::{Gearing, InternalRoot, PinionCutter};
    let external = |teeth, profile_shift| ToothDefinition {
        helix_angle_rad: helix_deg.to_radians(),
        ..tooth(teeth, profile_shift, 0.0)
    };
    let cutter = PinionCutter {
        teeth: 27,
        profile_shift: 0.1,
        addendum: 1.25,
        tip_radius: 0.25,
    };
    let ring = ToothDefinition {
        addendum: 0.75,
        gearing: Gearing::Internal(InternalRoot::Cutter(cutter)),
        ..external(75, -0.2)
    };
    let [planet, ring] = [external(24, 0.2), ring].map(|d| ToothGeometry::new(&d).unwrap());
    let centre = ring.reference_radius_m - planet.reference_radius_m;
    let [gear_1, gear_2] = if ring_drives {
        [ring, planet]
    } else {
        [planet, ring]
    };
    GearPair::new(gear_1, gear_2, centre, Misalignment::default()).unwrap()
}

/// A pair with its extended path, unmodified flanks.
pub fn extended(pair: GearPair, edge_radius_m: f64) -> ContactLines {
    let extension = Some(PathExtension::new(&pair, edge_radius_m));
    ContactLines {
        pair,
        microgeometry_1: Microgeometry::default(),
        microgeometry_2: Microgeometry::default(),
        extension,
        zone: gearmesh_contact::ContactZone::of_equal_faces(20e-3),
    }
}

/// A body with the compliance of a cantilever tooth on a soft rim: 10 µm per 5 kN near the tip, slices and neighbouring
/// teeth coupled, symmetric and positive definite by construction.
pub fn made_up_gear(tooth: &ToothGeometry, face_width_m: f64, slices: usize) -> ReducedGear {
    // A ring's flank ends at its smallest roll angle.
    let (root, tip) = (tooth.form_roll_rad, tooth.flank_end_roll_rad);
    let (low, high) = (root.min(tip), root.max(tip));
    let stations = 7;
    let axial = 2 * slices + 1;
    let grid = FlankGrid {
        roll_angles_rad: (0..stations)
            .map(|k| low + (high - low) * k as f64 / (stations - 1) as f64)
            .collect(),
        z_m: (0..axial)
            .map(|k| face_width_m * (k as f64 / (axial - 1) as f64 - 0.5))
            .collect(),
        slices,
    };
    let height = |load: usize| {
        let s = (grid.roll_angles_rad[load / axial] - root) / (tip - root);
        0.3 + 0.7 * s * s
    };
    let loads = grid.len();
    let mut c_hub = Vec::with_capacity(tooth.teeth * loads * loads);
    for response in 0..tooth.teeth {
        let apart = response.min(tooth.teeth - response) as f64;
        for l in 0..loads {
            for m in 0..loads {
                let axial_distance = (grid.z_m[l % axial] - grid.z_m[m % axial]).abs();
                let own = if response == 0 {
                    1.5e-9 * height(l) * height(m) * (-axial_distance / 8e-3).exp()
                } else {
                    0.0
                };
                c_hub.push(own + 3e-10 * (-apart).exp());
            }
        }
    }
    ReducedGear {
        teeth: tooth.teeth,
        sectors: tooth.teeth,
        base_radius_m: tooth.base_radius_m,
        face_width_m,
        grid,
        flanks: vec![Flank::Right],
        c_hub,
        c_tooth: vec![0.0; loads * loads],
        opposite_distance_m: (0..stations).map(|k| 5e-3 - 4e-4 * k as f64).collect(),
        gauges: Vec::new(),
        reference_point: None,
        modes: None,
        ..small_reduced_gear()
    }
}

/// 31/40 teeth with this helix angle (degrees, positive right on gear 1), at the centre distance of equal clearance for
/// every angle.
pub fn helical(helix_deg: f64, flank: Flank) -> ContactLines {
    let gear = |teeth: usize, helix_deg: f64| {
        let mut d = tooth(teeth, 0.0, 0.0);
        d.helix_angle_rad = helix_deg.to_radians();
        ToothGeometry::new(&d).unwrap()
    };
    let (g1, g2) = (gear(31, helix_deg), gear(40, -helix_deg));
    let centre = g1.reference_radius_m + g2.reference_radius_m;
    let pair = GearPair::new(g1, g2, centre, Misalignment::default())
        .unwrap()
        .on_flanks(flank);
    ContactLines {
        pair,
        microgeometry_1: Microgeometry::default(),
        microgeometry_2: Microgeometry::default(),
        extension: None,
        zone: gearmesh_contact::ContactZone::of_equal_faces(20e-3),
    }
}

/// The contact of two made-up gears.
pub fn contact(lines: &ContactLines, options: ContactOptions, slices: usize) -> StaticContact {
    let models =
        [&lines.pair.gear_1, &lines.pair.gear_2].map(|gear| made_up_gear(gear, 20e-3, slices));
    StaticContact::new(lines.clone(), &models[0], &models[1], options).unwrap()
}

/// Frictionless, with the local term.
pub const FRICTIONLESS: ContactOptions = ContactOptions {
    local: LocalContact::WeberBanaschek,
    friction: None,
};
