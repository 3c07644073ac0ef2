//! A gear in a ring: driven from either side, refusals, tips that collide, how it comes in.

use std::f64::consts::TAU;

use gearmesh_geometry::definition::ToothDefinition;
use gearmesh_geometry::{Flank, GearPair, Misalignment, PairError, ToothGeometry};

use crate::rings::*;

/// Planet in a ring and ring round a planet: rolls, radii of curvature, contact ratio by hand; both flanks are at the
/// same place with opposite normals at every place of the path.
#[test]
fn a_planet_in_a_ring_runs_from_either_side() {
    for helix_deg in [0.0, 15.0] {
        let [planet, ring] = planet_and_ring(helix_deg);
        let centre = ring.reference_radius_m - planet.reference_radius_m;
        let none = Misalignment::default();
        for ring_drives in [false, true] {
            let [one, two] = if ring_drives {
                [&ring, &planet]
            } else {
                [&planet, &ring]
            };
            let pair = GearPair::new(one.clone(), two.clone(), centre, none)
                .unwrap_or_else(|e| panic!("{e}"));
            let tip = |g: &ToothGeometry| {
                (g.tip_radius_m * g.tip_radius_m - g.base_radius_m * g.base_radius_m).sqrt()
            };
            let line = centre * pair.working_pressure_angle_rad.sin();
            let ratio = (tip(&planet) - tip(&ring) + line)
                / (TAU * planet.base_radius_m / planet.teeth as f64);
            assert!((pair.contact_ratio() - ratio).abs() < 1e-12, "{ratio}");
            // x sums to zero at the reference distance: the backlash is what both teeth are thinner.
            assert!(
                (pair.backlash_m() - 100e-6).abs() < 1e-12,
                "{}",
                pair.backlash_m()
            );
            assert!(
                (pair.circles().signed_distance_m(pair.centre_distance_m) + centre).abs() < 1e-15
            );
            let place = if ring_drives { centre } else { -centre };
            let (roll_start, roll_end) = (pair.roll_start_1_rad, pair.roll_end_1_rad);
            for k in 0..=10 {
                let roll_1 = roll_start + (roll_end - roll_start) * f64::from(k) / 10.0;
                let turned = one.tip_direction() * (roll_1 - pair.working_pressure_angle_rad.tan());
                assert!((pair.roll_1_rad(turned, 0) - roll_1).abs() < 1e-14);
                assert!(k == 0 || k == 10 || pair.pairs_in_contact(turned).contains(&0));
                let roll_2 = pair.roll_2_rad(roll_1);
                let at_pitch = pair.working_pressure_angle_rad.tan();
                let put = |gear: &ToothGeometry, side: Flank, roll: f64, turn: f64, x: f64| {
                    let start = side.mirror() * gear.half_angle_rad(at_pitch);
                    let (s, c) = (start - turn).sin_cos();
                    let [px, py] = gear.flank_point_m(side, roll);
                    let ([nx, ny], _) = gear.flank_frame(side, roll);
                    (
                        [c * px - s * py + x, s * px + c * py],
                        [c * nx - s * ny, s * nx + c * ny],
                    )
                };
                let by_ratio = turned * one.teeth as f64 / two.teeth as f64;
                let (p, n) = put(one, pair.flank_of(0), roll_1, turned, 0.0);
                let (q, o) = put(two, pair.flank_of(1), roll_2, by_ratio, place);
                assert!(distance(p, q) < 1e-13, "{k} {p:?} {q:?}");
                assert!(distance(n, [-o[0], -o[1]]) < 1e-12);
                let rho = [planet.base_radius_m, ring.base_radius_m];
                let rolls = if ring_drives {
                    [roll_2, roll_1]
                } else {
                    [roll_1, roll_2]
                };
                let expected = 1.0
                    / (1.0 / (rho[0] * rolls[0]) - 1.0 / (rho[1] * rolls[1]))
                    / pair.base_helix_angle_rad().cos();
                let found = pair.relative_radius_m(roll_1, roll_2);
                assert!((found / expected - 1.0).abs() < 1e-12);
                // Sliding: difference of the speeds along the common tangent, towards the root of gear 1.
                let own = one.base_radius_m * roll_1;
                let other = one.teeth as f64 / two.teeth as f64 * two.base_radius_m * roll_2;
                let sliding = pair.sliding_velocity_m_per_s(roll_1, 7.0);
                assert!((sliding - 7.0 * (own - other)).abs() < 1e-12);
            }
            // Teeth of one pair turn together.
            assert_eq!(pair.teeth_of(2), [2, 2]);
            assert_eq!(
                pair.clone().on_flanks(Flank::Left).teeth_of(2),
                [one.teeth - 2, two.teeth - 2]
            );
        }
    }
}

/// What cannot run is refused, each with its number.
#[test]
fn pairs_with_a_ring_that_cannot_run_are_refused() {
    let [planet, ring] = planet_and_ring(0.0);
    let none = Misalignment::default();
    let centre = ring.reference_radius_m - planet.reference_radius_m;
    let of = |one: &ToothGeometry, two: &ToothGeometry, a: f64| {
        GearPair::new(one.clone(), two.clone(), a, none).unwrap_err()
    };
    assert!(matches!(of(&ring, &ring, centre), PairError::TwoRings));
    assert!(matches!(
        of(&planet, &ring, 0.9 * centre),
        PairError::CentreDistance { .. }
    ));
    // Nearer to the ring's teeth the backlash is used up: 0.1 mm/(2 tan α).
    assert!(matches!(
        of(&planet, &ring, centre + 0.2e-3),
        PairError::NoBacklash { .. }
    ));
    let opposite = planet_and_ring(-15.0);
    assert!(matches!(
        of(&planet_and_ring(15.0)[0], &opposite[1], centre),
        PairError::Helix { .. }
    ));
    // A ring tip that reaches beyond the planet's base circle, and one that only reaches its fillet.
    let tipped = |addendum: f64| {
        geometry(&ToothDefinition {
            addendum,
            thickness_allowance_m: 60e-6,
            ..cut(
                75,
                -0.2,
                PinionCutter {
                    teeth: 45,
                    addendum: 1.25,
                    ..CUTTER
                },
            )
        })
    };
    let slim = ToothDefinition {
        dedendum: 1.6,
        rack_tip_radius: 0.1,
        ..external(24, 0.2)
    };
    let long = of(&geometry(&slim), &tipped(1.55), centre);
    let PairError::InvoluteInterference { gear: 1, least_mm } = long else {
        panic!("{long}")
    };
    let line = centre * alpha().sin();
    assert!((least_mm - 2e3 * ring.base_radius_m.hypot(line)).abs() < 1e-9);
    let fillet = of(&planet, &tipped(1.05), centre);
    assert!(
        matches!(fillet, PairError::FilletInterference { gear: 2, .. }),
        "{fillet}"
    );
    let deep = geometry(&ToothDefinition {
        addendum: 1.4,
        ..external(24, 0.2)
    });
    assert!(matches!(
        of(&deep, &ring, centre),
        PairError::TipClearance { gear: 1, .. }
    ));
}

/// Trochoidal interference over the difference of the numbers of teeth, against the closed condition
/// θ_1 z_1/z_2 + inv α_w − inv α_a2 ≥ θ_2, with θ_1 = acos((r_a2² − r_a1² − a²)/(2 a r_a1)) + inv α_a1 − inv α_w and
/// θ_2 = acos((a² + r_a2² − r_a1²)/(2 a r_a2)): where a tip of the gear inside crosses the ring's tip circle.
#[test]
fn tips_collide_where_the_closed_condition_says() {
    let ring = geometry(&ToothDefinition {
        addendum: 0.8,
        ..broached(60, 0.0)
    });
    let inv = |a: f64| a.tan() - a;
    let mut seen = [0, 0];
    for teeth in 36..58 {
        let inside = geometry(&ToothDefinition {
            addendum: 0.9,
            ..external(teeth, 0.0)
        });
        let a = ring.reference_radius_m - inside.reference_radius_m;
        let (r_1, r_2) = (inside.tip_radius_m, ring.tip_radius_m);
        let at_tip = |g: &ToothGeometry| inv((g.base_radius_m / g.tip_radius_m).acos());
        let one = ((r_2 * r_2 - r_1 * r_1 - a * a) / (2.0 * a * r_1)).acos() + at_tip(&inside)
            - inv(alpha());
        let two = ((a * a + r_2 * r_2 - r_1 * r_1) / (2.0 * a * r_2)).acos();
        let clear = one * teeth as f64 / 60.0 + inv(alpha()) - at_tip(&ring) >= two;
        let found = GearPair::new(inside, ring.clone(), a, Misalignment::default());
        match found {
            Ok(_) => assert!(clear, "{teeth}"),
            Err(PairError::TipsCollide {
                depth_um,
                clear_tip_diameter_mm,
                ..
            }) => {
                assert!(!clear, "{teeth}");
                assert!(depth_um > 0.0 && clear_tip_diameter_mm > 2e3 * r_2);
            }
            Err(other) => panic!("{teeth}: {other}"),
        }
        seen[usize::from(clear)] += 1;
    }
    assert!(seen[0] > 3 && seen[1] > 3, "{seen:?}");
}

/// The condition for trimming that handbooks print (KHK, Gear technical reference, internal gears), from memory: it
/// decides as the least room does, which is found over all places, and the room is zero where its two sides are equal.
#[test]
fn gears_come_into_their_ring_radially_where_the_closed_condition_says() {
    let (mut free, mut trimmed) = (0, 0);
    for difference in 8..30 {
        let [planet, ring] = [external(30, 0.0), broached(30 + difference, 0.0)];
        let ring = ToothDefinition {
            addendum: 0.8,
            ..ring
        };
        let planet = ToothDefinition {
            addendum: 0.8,
            ..planet
        };
        let [planet, ring] = [geometry(&planet), geometry(&ring)];
        let a = ring.reference_radius_m - planet.reference_radius_m;
        let Ok(pair) = GearPair::new(planet.clone(), ring.clone(), a, Misalignment::default())
        else {
            continue;
        };
        let tips = [&planet, &ring].map(|gear| (gear.base_radius_m / gear.tip_radius_m).acos());
        let inv = |angle: f64| angle.tan() - angle;
        let (k, c) = (
            30.0 / (30 + difference) as f64,
            tips[0].cos() / tips[1].cos(),
        );
        let theta_1 = ((1.0 - c * c) / (1.0 - k * k)).sqrt().asin();
        let theta_2 = ((c.powi(-2) - 1.0) / (k.powi(-2) - 1.0)).sqrt().asin();
        let working = inv(pair.working_pressure_angle_rad);
        let room = (theta_1 + inv(tips[0]) - working) * k - (theta_2 + inv(tips[1]) - working);
        let found = pair.radial_room_m().unwrap();
        // Found in steps of the angle about a flat least.
        assert!(
            (found - room * ring.tip_radius_m).abs() < 1e-8,
            "{difference}: {found:e} {:e}",
            room * ring.tip_radius_m
        );
        free += usize::from(found > 0.0);
        trimmed += usize::from(found < 0.0);
    }
    assert!(free > 3 && trimmed > 2, "{free} {trimmed}");
}
