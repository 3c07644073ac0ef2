//! Flanks that are no involutes run through the same models and must do what follows: two crowned cylinders whose axes
//! cross at 60°.

use std::f64::consts::FRAC_PI_3;
use std::sync::Arc;

use gearmesh_contact::slice_contact::SliceContact;
use gearmesh_contact::{AxialSpread, LocalContact, ProfileHats, SliceCompliance, SliceLayout};
use gearmesh_drivetrain::*;
use gearmesh_geometry::Flank;
use gearmesh_model::ReducedGear;
use nalgebra::Vector3;

use crate::conformance::crowned_cylinders::{CrownedCylinder, CrownedCylinders};
use crate::conformance::energy::{check_energy, check_power};
use crate::conformance::two_bodies::{check_reaction, check_tangents, check_turned};
use crate::conformance::{DAMPINGS, friction};
use crate::mesh_common::*;

/// Length over which slices are laid \[m\].
const LENGTH: f64 = 4e-3;
/// Distance of the gears' axes \[m\].
pub const DISTANCE: f64 = 0.1;

/// Cylinders of these radii, their axes bent to circles, just touching halfway between the gears; gear 1's lies along
/// its axis.
pub fn crossed([r1, r2]: [f64; 2], axis_radius_m: f64, layout: SliceLayout) -> CrownedCylinders {
    let halfway = Vector3::new(0.5 * DISTANCE, 0.0, 0.0);
    let cylinder = |end: Vector3<f64>, outwards: Vector3<f64>, along, radius_m| CrownedCylinder {
        centre_m: end - axis_radius_m * outwards,
        outwards,
        along,
        axis_radius_m,
        radius_m,
    };
    let (sin, cos) = FRAC_PI_3.sin_cos();
    let crossed = Vector3::new(sin, 0.0, cos);
    let first = cylinder(halfway, Vector3::y(), Vector3::z(), r1);
    let second = cylinder(
        (r1 + r2) * Vector3::y() - halfway,
        -Vector3::y(),
        crossed,
        r2,
    );
    CrownedCylinders::new([first, second], layout)
}

pub fn cylinders() -> CrownedCylinders {
    crossed(
        [20e-3, 30e-3],
        1.0,
        SliceLayout::new([LENGTH; 2], 0.0, SLICES),
    )
}

/// Two bodies of the made-up compliance, which depends on the place along the profile.
fn bodies() -> [ReducedGear; 2] {
    let pair = spur_pair();
    [&pair.gear_1, &pair.gear_2].map(|tooth| {
        let mut body = pair_common::made_up_gear(tooth, LENGTH, SLICES);
        let stations = body.grid.roll_angles_rad.len();
        body.grid.roll_angles_rad = (0..stations).map(|k| 0.9 + 0.03 * k as f64).collect();
        body
    })
}

pub fn reduced_slices() -> SliceContact {
    let local = LocalContact::WeberBanaschek;
    let compliance = bodies().map(|body| {
        // As far along a cylinder, as much area.
        let hats = ProfileHats::new(&body.grid.roll_angles_rad, |_| 1.0);
        let grid = (hats, &AxialSpread::own(&body));
        Arc::new(SliceCompliance::on_grid(&body, Flank::Right, local, grid).unwrap())
    });
    SliceContact::new(cylinders().layout, compliance, local, 1)
}

fn reduced() -> ReducedTeeth {
    ReducedTeeth::of_flanks(reduced_slices(), 2000.0).unwrap()
}

fn mesh_of(teeth: impl TeethModel + 'static) -> GearMesh {
    GearMesh::of_flanks(Box::new(cylinders()), Flank::Right, teeth).unwrap()
}

fn damped_mesh(name: &str, damping: Damping) -> GearMesh {
    match name {
        "impact" => mesh_of(impact()),
        _ => mesh_of(Damped::new(reduced(), damping, SLICES).unwrap()),
    }
}

/// Pressed together by some micrometres, displaced and tilted.
fn poses() -> Vec<Pose> {
    let poses = [
        (12e-6, [0.0; 3], [0.0; 3]),
        (9e-6, [20e-6, 0.0, -30e-6], [1e-3, -2e-3, 1e-4]),
        (20e-6, [-1e-4, 0.0, 2e-4], [-3e-3, 1e-3, 0.0]),
    ];
    let at = |(depth_m, shift, turn): (f64, [f64; 3], [f64; 3])| {
        let rotation = about(Vector3::from(turn), 1.0);
        let place = Vector3::new(DISTANCE, 0.0, 0.0) + Vector3::from(shift);
        let touching = Pose::at_rest(place, rotation);
        let gap_m = |pose: &Pose| {
            let mut found = FlankContacts::default();
            let side = Flank::Right;
            cylinders().contacts_at(pose, side, &mut found).unwrap();
            found.lines[0].ideal_gap_m
        };
        // The gap grows with a displacement along y nearly as fast.
        let mut pose = touching;
        for _ in 0..20 {
            pose.displacement_m.y -= gap_m(&pose) + depth_m;
        }
        pose
    };
    poses.map(at).to_vec()
}

#[test]
fn flanks_of_another_family_conform() {
    let poses = poses();
    let name = "crossed cylinders, hybrid";
    let mut undamped = mesh_of(reduced());
    check_energy(name, &mut undamped, &poses);
    let (found, forces) = undamped.side(Flank::Right).unwrap();
    assert_eq!(found.contacts.len(), SLICES);
    assert!(forces[SLICES / 2] > forces[0], "{forces:?}");
    for name in ["impact", "hybrid"] {
        for damping in DAMPINGS {
            for (rubs, tolerance) in [(false, 2e-3), (true, 5e-3)] {
                let mut mesh = damped_mesh(name, damping);
                if rubs {
                    mesh = mesh.with_friction(friction());
                }
                let what = format!("crossed cylinders, {name} {damping:?} {rubs}");
                check_power((name, damping), &mut mesh, &poses);
                check_reaction(&what, &mut mesh, &poses);
                check_tangents((&what, tolerance), &mut mesh, &poses);
                check_turned(&what, &mut mesh, &poses);
            }
        }
    }
}
