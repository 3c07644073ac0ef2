//! Mass and inertia of gear bodies against closed forms.

use crate::mesh_common;

use std::f64::consts::PI;

use gearmesh_drivetrain::GearInertia;
use gearmesh_geometry::blank::{Blank, Holes, Openings, Slots, Web};
use mesh_common::*;

const STEEL_DENSITY: f64 = 7850.0;

/// Between discs of root and tip radius, near that of the reference radius; a web and openings take away what rings and
/// circles hold.
#[test]
fn bodies_have_the_mass_of_their_parts() {
    let pair = spur_pair();
    let gear = &pair.gear_1;
    let solid = Blank::solid(8e-3);
    let of = |blank: &Blank| GearInertia::new(gear, blank, WIDTH, STEEL_DENSITY).unwrap();
    let disc = |r: f64| STEEL_DENSITY * PI * r * r * WIDTH;
    let whole = of(&solid);
    let bore = disc(8e-3);
    assert!(
        whole.mass_kg > disc(gear.root_radius_m) - bore
            && whole.mass_kg < disc(gear.tip_radius_m) - bore
    );
    let polar = |r: f64| 0.5 * disc(r) * r * r;
    assert!(whole.polar_kg_m2 > polar(gear.root_radius_m) - polar(8e-3));
    assert!(whole.polar_kg_m2 < polar(gear.tip_radius_m) - polar(8e-3));
    let thin = whole.mass_kg * WIDTH * WIDTH / 12.0;
    assert!((whole.across_kg_m2 - 0.5 * whole.polar_kg_m2 - thin).abs() < 1e-15);

    let web = Web {
        hub_radius_m: 15e-3,
        rim_inner_radius_m: 35e-3,
        thickness_m: 5e-3,
        offset_m: 2e-3,
    };
    let with_web = |openings| Blank::Webbed {
        bore_radius_m: 8e-3,
        web,
        contour: None,
        openings,
    };
    let webbed = of(&with_web(None));
    let ring = PI * (35e-3f64.powi(2) - 15e-3f64.powi(2));
    let lost = STEEL_DENSITY * ring * (WIDTH - 5e-3);
    assert!((whole.mass_kg - webbed.mass_kg - lost).abs() < 1e-12);
    let moment = STEEL_DENSITY * ring * 5e-3 * 2e-3;
    assert!((webbed.centre_z_m * webbed.mass_kg - moment).abs() < 1e-14);

    let holes = Holes {
        count: 4,
        radius_m: 5e-3,
        pitch_radius_m: 25e-3,
        phase_rad: 0.3,
    };
    let holed = of(&with_web(Some(Openings::Holes(holes))));
    let one = STEEL_DENSITY * PI * 25e-6 * 5e-3;
    assert!((webbed.mass_kg - holed.mass_kg - 4.0 * one).abs() < 1e-12);
    let spin = 4.0 * one * (25e-3f64.powi(2) + 0.5 * 25e-6);
    assert!((webbed.polar_kg_m2 - holed.polar_kg_m2 - spin).abs() < 1e-14);
    assert_eq!(holed.centre_xy_m, [0.0; 2]);

    let single = Slots {
        count: 1,
        inner_radius_m: 20e-3,
        outer_radius_m: 30e-3,
        width_rad: 1.0,
        phase_rad: 0.0,
        corner_radius_m: 1e-3,
    };
    let slotted = of(&with_web(Some(Openings::Slots(single))));
    assert!(slotted.centre_xy_m[0] < 0.0 && slotted.centre_xy_m[1].abs() < 1e-15);
}

/// From a model file: inertia brought from the reference point to the centre of mass, whose own Steiner part brings it
/// back.
#[test]
fn bodies_come_from_the_model_file() {
    let mut gear = crate::mesh_common::pair_common::made_up_models::small_reduced_gear();
    let rigid = gear.rigid_body.as_mut().unwrap();
    rigid.reference_m = [0.0, 1e-3, -2e-3];
    rigid.centre_m = [2e-3, 0.0, 1e-3];
    let rigid = rigid.clone();
    let body = gearmesh_drivetrain::gear_body(&gear).unwrap();
    body.validate().unwrap();
    assert_eq!(body.center_of_mass_m.as_slice(), rigid.centre_m);
    let c = body.center_of_mass_m - nalgebra::Vector3::from(rigid.reference_m);
    for i in 0..3 {
        for j in 0..3 {
            let own = if i == j { c.norm_squared() } else { 0.0 };
            let back = body.inertia_kg_m2[(i, j)] + body.mass_kg * (own - c[i] * c[j]);
            assert!((back - rigid.inertia_kg_m2[i][j]).abs() < 1e-15);
        }
    }
    gear.rigid_body = None;
    let refused = gearmesh_drivetrain::gear_body(&gear)
        .unwrap_err()
        .to_string();
    assert!(refused.contains("density"), "{refused}");
}
