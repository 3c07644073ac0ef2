//! Reduction of small helical gears: unit loads, mirror images, the spur limit, with and without cyclic symmetry.

use crate::small_gears::{
    self, COARSE, MESH, QUADRATIC, SOLID, body, difference, without_symmetry,
};
use gearmesh_geometry::{Flank, GearDefinition};
use gearmesh_model::ReducedGear;
use gearmesh_reduction::flank_loads::{flank_grid, flank_loads};

const DRILLED: &str = "[blank]
kind = \"solid\"
bore_diameter_mm = 10.0
[blank.holes]
count = 3
pitch_circle_diameter_mm = 23.0
diameter_mm = 6.0
phase_deg = 10.0
";

fn gear(helix_deg: f64, blank: &str) -> GearDefinition {
    small_gears::gear(MESH, blank, helix_deg)
}

fn reduced(gear: &GearDefinition) -> ReducedGear {
    small_gears::reduced(gear, false).0
}

#[test]
fn unit_loads_push_along_the_helicoids_normal() {
    for helix_deg in [24.0f64, -24.0] {
        let gear = gear(helix_deg, SOLID);
        let body = body(&gear);
        let grid = flank_grid(&gear);
        let base_helix = gear.profile.base_helix_angle_rad();
        for side in [Flank::Right, Flank::Left] {
            for (number, load) in flank_loads(&gear, &body.mesh, &grid, 5, side)
                .iter()
                .enumerate()
            {
                let (mut force, mut torque) = ([0.0; 3], 0.0);
                for &(dof, value) in &load.normal {
                    let p = body.mesh.nodes[dof / 3];
                    force[dof % 3] += value;
                    torque += match dof % 3 {
                        0 => -p[1] * value,
                        1 => p[0] * value,
                        _ => 0.0,
                    };
                }
                // A right-hand gear is pushed to −z by a load on its right flank.
                assert!((force[2] + side.mirror() * base_helix.sin()).abs() < 1e-13);
                // The transverse part turns over the hat, along the profile and with the twist; chords add a little.
                let size = force[0].hypot(force[1]) / base_helix.cos();
                let along = grid.roll_angles_rad[1] - grid.roll_angles_rad[0];
                let across = (grid.z_m[1] - grid.z_m[0]) * gear.profile.twist_rad_per_m();
                let lost = (along * along + across * across) / 12.0;
                assert!(size <= 1.0 && 1.0 - size < 1.1 * lost, "{size} {lost}");
                let lever =
                    side.mirror() * torque / (gear.profile.base_radius_m * base_helix.cos());
                assert!((lever - 1.0).abs() < 1e-3, "{lever}");
                let tangential: f64 = load
                    .tangential
                    .iter()
                    .filter(|(dof, _)| dof % 3 == 2)
                    .map(|(_, v)| v.abs())
                    .sum();
                assert!(
                    tangential == 0.0,
                    "the profile tangent stays in the section"
                );
                assert!(number < grid.len());
            }
        }
    }
}

#[test]
fn the_identities_hold_and_symmetry_changes_nothing() {
    for (helix_deg, blank, sectors, mesh) in [
        (24.0, SOLID, 18, COARSE),
        (-10.0, DRILLED, 3, COARSE),
        (-10.0, DRILLED, 3, QUADRATIC),
    ] {
        let definition = small_gears::gear(mesh, blank, helix_deg);
        let cyclic = reduced(&definition);
        let whole = reduced(&without_symmetry(&definition));
        assert_eq!(cyclic.sectors, sectors);
        for model in [&cyclic, &whole] {
            assert!(model.checks.symmetry < 1e-9, "{}", model.checks.symmetry);
            assert!(model.checks.pattern_identity < 1e-9);
        }
        assert!(difference(&cyclic.c_hub, &whole.c_hub) < 1e-9);
        assert!(difference(&cyclic.c_tooth, &whole.c_tooth) < 1e-9);
        let (a, b) = (&cyclic.gauges[0], &whole.gauges[0]);
        assert!(difference(&a.adjoint, &b.adjoint) < 1e-9);
        assert!(difference(&a.own_tooth, &b.own_tooth) < 1e-9);
    }
}

/// Turned over (z to −z) a right-hand gear is a left-hand one, flank for flank and tooth for tooth.
#[test]
fn a_left_hand_gear_is_a_right_hand_one_turned_over() {
    let (right, left) = (reduced(&gear(24.0, SOLID)), reduced(&gear(-24.0, SOLID)));
    let axial = right.grid.z_m.len();
    let over = |load: usize| load / axial * axial + axial - 1 - load % axial;
    let n = right.grid.len();
    for response in [0, 1, 17, 9] {
        for (from, to) in [
            (Flank::Right, Flank::Right),
            (Flank::Left, Flank::Left),
            (Flank::Right, Flank::Left),
        ] {
            let (a, b) = (
                right.c_hub_block(0, from, response, to),
                left.c_hub_block(0, from, response, to),
            );
            let turned: Vec<f64> = (0..n * n)
                .map(|k| b[over(k / n) * n + over(k % n)])
                .collect();
            assert!(difference(&a, &turned) < 1e-9);
            if response == 0 && from == to {
                // Not symmetric about mid-face by itself: the helix matters.
                let same: Vec<f64> = (0..n * n)
                    .map(|k| a[over(k / n) * n + over(k % n)])
                    .collect();
                assert!(difference(&a, &same) > 1e-3);
            }
        }
    }
}

#[test]
fn a_vanishing_helix_is_a_spur_gear() {
    let (spur, almost) = (reduced(&gear(0.0, SOLID)), reduced(&gear(1e-9, SOLID)));
    assert!(difference(&spur.c_hub, &almost.c_hub) < 1e-9);
    assert!(difference(&spur.c_tooth, &almost.c_tooth) < 1e-9);
    assert!(difference(&spur.opposite_distance_m, &almost.opposite_distance_m) < 1e-12);
    assert!(difference(&spur.gauges[0].adjoint, &almost.gauges[0].adjoint) < 1e-8);
    let (a, b) = (spur.near_field.unwrap(), almost.near_field.unwrap());
    assert!(difference(&a.mesh_m2_per_n, &b.mesh_m2_per_n) < 1e-9);
    assert!(difference(&a.contact_m2_per_n, &b.contact_m2_per_n) < 1e-9);
}
