//! Ring gears: against an envelope of the cutter that is found by force, the external gear with the same space, the
//! formulas of ISO 21771, and pairs with a gear inside, driven from either side.
#![allow(clippy::unwrap_used, missing_docs)]

use gearmesh_geometry::definition::{Gearing, InternalRoot, PinionCutter, ToothDefinition};
use gearmesh_geometry::input::InputDocument;
use gearmesh_geometry::involute;
use gearmesh_geometry::{
    Flank, GearDefinition, GearPair, Misalignment, PairError, ProfileCurve, RootPosition,
    ToothGeometry,
};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

const M: f64 = 2e-3;

fn alpha() -> f64 {
    20f64.to_radians()
}

fn external(teeth: usize, profile_shift: f64) -> ToothDefinition {
    ToothDefinition {
        teeth,
        module_m: M,
        pressure_angle_rad: alpha(),
        profile_shift,
        addendum: 1.0,
        dedendum: 1.25,
        rack_tip_radius: 0.38,
        face_width_m: 20e-3,
        ..ToothDefinition::default()
    }
}

fn cut(teeth: usize, profile_shift: f64, cutter: PinionCutter) -> ToothDefinition {
    ToothDefinition {
        gearing: Gearing::Internal(InternalRoot::Cutter(cutter)),
        ..external(teeth, profile_shift)
    }
}

const CUTTER: PinionCutter = PinionCutter {
    teeth: 33,
    profile_shift: 0.1,
    addendum: 1.25,
    tip_radius: 0.25,
};

fn broached(teeth: usize, profile_shift: f64) -> ToothDefinition {
    ToothDefinition {
        gearing: Gearing::Internal(InternalRoot::FullRound),
        ..external(teeth, profile_shift)
    }
}

fn geometry(d: &ToothDefinition) -> ToothGeometry {
    ToothGeometry::new(d).unwrap_or_else(|e| panic!("{e}"))
}

fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// The cutter's tooth by distances alone. It shares no formula with the ring's fillet: the distance to an involute is
/// that along its thread, and the centre of the rounding is found by halving.
struct Cutter {
    base_m: f64,
    base_half_angle_rad: f64,
    rounding_m: f64,
    centre_m: f64,
    centre_rad: f64,
}

impl Cutter {
    fn new(cutter: &PinionCutter) -> Self {
        let reference_m = 0.5 * M * cutter.teeth as f64;
        let thickness = M * (FRAC_PI_2 + 2.0 * cutter.profile_shift * alpha().tan());
        let rounding_m = cutter.tip_radius * M;
        let mut tooth = Self {
            base_m: reference_m * alpha().cos(),
            base_half_angle_rad: 0.5 * thickness / reference_m + alpha().tan() - alpha(),
            rounding_m,
            centre_m: reference_m + M * (cutter.addendum + cutter.profile_shift) - rounding_m,
            centre_rad: 0.0,
        };
        tooth.centre_rad = halved(-0.1, 0.1, |angle| {
            tooth.involute_distance(tooth.centre_m, angle)[0] + rounding_m
        });
        tooth
    }

    /// Distance \[m\] of a point, by radius and polar angle, from the left involute of the tooth centred on +x, positive
    /// outside, and the roll angle of the involute's nearest point.
    fn involute_distance(&self, radius_m: f64, polar_rad: f64) -> [f64; 2] {
        let touch = polar_rad - (self.base_m / radius_m).acos();
        let roll = self.base_half_angle_rad - touch;
        let along = (radius_m * radius_m - self.base_m * self.base_m).sqrt();
        [along - self.base_m * roll, roll]
    }

    /// Distance \[m\] of a point from the half of the tooth with the left flank.
    fn tooth_distance(&self, p: [f64; 2]) -> f64 {
        let [distance, roll] = self.involute_distance(p[0].hypot(p[1]), p[1].atan2(p[0]));
        let (s, c) = self.centre_rad.sin_cos();
        let across = [p[0] - self.centre_m * c, p[1] - self.centre_m * s];
        let touched =
            involute::roll_angle_rad(self.centre_m, self.base_m) + self.rounding_m / self.base_m;
        if roll <= touched {
            distance
        } else if across[0] * -s + across[1] * c >= 0.0 {
            across[0].hypot(across[1]) - self.rounding_m
        } else {
            p[0].hypot(p[1]) - self.centre_m - self.rounding_m
        }
    }
}

/// Where a function that grows from negative to positive vanishes.
fn halved(mut low: f64, mut high: f64, f: impl Fn(f64) -> f64) -> f64 {
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if f(middle) < 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

/// Smallest distance of a point of the ring from the rolling cutter.
fn nearest(ring: &ToothGeometry, cutter: &PinionCutter, shift: f64, point: [f64; 2]) -> f64 {
    let tooth = Cutter::new(cutter);
    let (z, z_0) = (ring.teeth as f64, cutter.teeth as f64);
    let inv = |a: f64| a.tan() - a;
    // inv α_w0 = inv α + 2 tan α (x_2 − x_0)/(z_2 − z_0) in magnitudes; the ring's x_2 there is −x of ISO 21771.
    let working = inv(alpha()) + 2.0 * alpha().tan() * (-shift - cutter.profile_shift) / (z - z_0);
    let alpha_w = halved(0.0, 1.5, |a| inv(a) - working);
    let a = 0.5 * M * (z - z_0) * alpha().cos() / alpha_w.cos();
    let space = -PI / z;
    let at = |line: f64| {
        // The cutter's axis at the angle `line` from the space; its tooth has turned the other way.
        let (s, c) = (space + line).sin_cos();
        let p = [point[0] - a * c, point[1] - a * s];
        let (s, c) = (space + line * (1.0 - z / z_0)).sin_cos();
        tooth.tooth_distance([c * p[0] + s * p[1], c * p[1] - s * p[0]])
    };
    let steps = 2000;
    let reach = 0.6 * z_0 / z;
    let line = |k: f64| reach * (2.0 * k / f64::from(steps) - 1.0);
    let best = (0..=steps)
        .min_by(|i, j| at(line(f64::from(*i))).total_cmp(&at(line(f64::from(*j)))))
        .unwrap();
    let (mut low, mut high) = (line(f64::from(best) - 1.0), line(f64::from(best) + 1.0));
    for _ in 0..80 {
        let third = (high - low) / 3.0;
        if at(low + third) < at(high - third) {
            high -= third;
        } else {
            low += third;
        }
    }
    at(0.5 * (low + high))
}

/// Every point of the ring's outline, from the root circle to the end of the flank, is touched by the cutter and not cut
/// by it: to 1e-9 m, the tolerance of the points; golden sections find a minimum to the square root of rounding.
#[test]
fn the_outline_is_the_envelope_of_the_cutter() {
    for (teeth, shift, cutter) in [
        (99, 0.0, CUTTER),
        (
            99,
            -0.4,
            PinionCutter {
                profile_shift: -0.2,
                ..CUTTER
            },
        ),
        (
            75,
            0.3,
            PinionCutter {
                teeth: 30,
                tip_radius: 0.1,
                ..CUTTER
            },
        ),
        (
            160,
            -0.8,
            PinionCutter {
                teeth: 60,
                tip_radius: 0.0,
                ..CUTTER
            },
        ),
    ] {
        let mut d = cut(teeth, shift, cutter);
        d.addendum = 0.8;
        let ring = geometry(&d);
        let curve = ProfileCurve::new(&ring);
        let end = curve.flank_end_m();
        let mut worst = 0.0f64;
        for k in 0..=60 {
            let point = curve.point_at(end * f64::from(k) / 60.0);
            worst = worst.max(nearest(&ring, &cutter, shift, point).abs());
        }
        assert!(worst < 1e-9, "{teeth} {shift}: {worst:e}");
        // It touches the root circle and hands over to the involute without a corner.
        let deepest = ring.fillet.point_m(0.0);
        assert!((deepest[0].hypot(deepest[1]) - ring.root_radius_m).abs() < 1e-12);
        check_hand_over(&ring);
    }
}

fn check_hand_over(ring: &ToothGeometry) {
    let flank = ring.flank_point_m(Flank::Right, ring.form_roll_rad);
    assert!(distance(ring.fillet.point_m(ring.fillet_end), flank) < 1e-12);
    let (normal, tangent) = ring.flank_frame(Flank::Right, ring.form_roll_rad);
    let (s, c) = ring.fillet.tangent_angle_rad(ring.fillet_end).sin_cos();
    assert!(distance([-c, s], tangent) < 1e-9, "{tangent:?}");
    assert!((normal[0] * tangent[0] + normal[1] * tangent[1]).abs() < 1e-15);
    // Towards the tip, and a load on the right flank turns the ring counter-clockwise with the lever of its base radius.
    assert!(tangent[0] < 0.0);
    assert!((flank[0] * normal[1] - flank[1] * normal[0] - ring.base_radius_m).abs() < 1e-12);
}

/// The space of the ring is its counterpart's tooth: an external gear with −x.
#[test]
fn the_space_is_the_tooth_of_the_counterpart() {
    for shift in [-0.5, 0.0, 0.4] {
        let mut d = broached(99, shift);
        d.addendum = 0.8;
        let ring = geometry(&d);
        let counterpart = geometry(&external(99, -shift));
        assert_eq!(ring.base_radius_m, counterpart.base_radius_m);
        for k in 0..=20 {
            let roll = ring.flank_end_roll_rad
                + (ring.form_roll_rad - ring.flank_end_roll_rad) * f64::from(k) / 20.0;
            let both = ring.half_angle_rad(roll) + counterpart.half_angle_rad(roll);
            assert!((both - PI / 99.0).abs() < 1e-15);
            let turned = -PI / 99.0;
            let [x, y] = counterpart.flank_point_m(Flank::Left, roll);
            let (s, c) = turned.sin_cos();
            let same = [c * x - s * y, s * x + c * y];
            assert!(distance(ring.flank_point_m(Flank::Right, roll), same) < 1e-15);
        }
        check_hand_over(&ring);
        // The full round touches the root circle on the middle of the space and has one radius.
        let deepest = ring.fillet.point_m(0.0);
        let root = ring.root_radius_m;
        let (s, c) = (-PI / 99.0).sin_cos();
        assert!(distance(deepest, [root * c, root * s]) < 1e-12);
        let expected = 99.0 * M / 2.0 + M * (1.25 - shift);
        assert!((root - expected).abs() < 1e-12);
    }
}

/// d_a = d + 2 m (x + h_a), s = m (π/2 + 2 x tan α), d_f of a cutter: with z and all diameters negative (ISO 21771).
#[test]
fn diameters_and_thickness_are_those_of_the_standard() {
    let shift = -0.3;
    let ring = geometry(&cut(99, shift, CUTTER));
    let z = -99.0;
    let d = z * M;
    assert!((-2.0 * ring.tip_radius_m - (d + 2.0 * M * (shift + 1.0))).abs() < 1e-15);
    let thickness = M * (FRAC_PI_2 + 2.0 * shift * alpha().tan());
    let roll = involute::roll_angle_rad(ring.reference_radius_m, ring.base_radius_m);
    let found = 2.0 * ring.reference_radius_m * ring.half_angle_rad(roll);
    assert!((found - thickness).abs() < 1e-15);
    // d_f = 2 a_0 − d_a0 with a_0 negative.
    let inv = |a: f64| a.tan() - a;
    let working = inv(alpha()) + 2.0 * alpha().tan() * (shift + 0.1) / (z + 33.0);
    let alpha_w = halved(0.0, 1.5, |a| inv(a) - working);
    let a_0 = 0.5 * M * (z + 33.0) * alpha().cos() / alpha_w.cos();
    let d_a0 = 33.0 * M + 2.0 * M * (1.25 + 0.1);
    assert!((-2.0 * ring.root_radius_m - (2.0 * a_0 - d_a0)).abs() < 1e-12);
}

fn planet_and_ring(helix_deg: f64) -> [ToothGeometry; 2] {
    let helix_angle_rad = helix_deg.to_radians();
    let planet = ToothDefinition {
        helix_angle_rad,
        thickness_allowance_m: 40e-6,
        ..external(24, 0.2)
    };
    let ring = ToothDefinition {
        addendum: 0.75,
        helix_angle_rad,
        thickness_allowance_m: 60e-6,
        ..cut(
            75,
            -0.2,
            PinionCutter {
                teeth: 27,
                ..CUTTER
            },
        )
    };
    [geometry(&planet), geometry(&ring)]
}

/// Planet in a ring and ring round a planet: rolls, radii of curvature, contact ratio by hand; both flanks are at the same
/// place with opposite normals at every place of the path.
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

/// Cutters that cannot cut a ring, each with the number that helps.
#[test]
fn cutters_that_do_not_suit_are_refused() {
    let of = |d: &ToothDefinition| ToothGeometry::new(d).unwrap_err().to_string();
    let small = of(&cut(
        99,
        0.0,
        PinionCutter {
            teeth: 14,
            profile_shift: 0.0,
            tip_radius: 0.1,
            ..CUTTER
        },
    ));
    assert!(
        small.contains("makes no involute at the ring's tip"),
        "{small}"
    );
    let large = of(&cut(
        99,
        0.0,
        PinionCutter {
            teeth: 93,
            ..CUTTER
        },
    ));
    assert!(
        large.contains("tips of the ring") && large.contains("fewer teeth"),
        "{large}"
    );
    let equal = of(&cut(
        99,
        0.0,
        PinionCutter {
            teeth: 98,
            ..CUTTER
        },
    ));
    assert!(equal.contains("at most 96"), "{equal}");
    let round = of(&cut(
        99,
        0.0,
        PinionCutter {
            tip_radius: 0.6,
            ..CUTTER
        },
    ));
    assert!(
        round.contains("does not fit on the cutter's tooth"),
        "{round}"
    );
    let inside = of(&ToothDefinition {
        addendum: 1.3,
        ..broached(30, 0.5)
    });
    assert!(
        inside.contains("must lie outside its base circle"),
        "{inside}"
    );
    let full = of(&ToothDefinition {
        dedendum: 3.0,
        ..broached(99, 0.0)
    });
    assert!(full.contains("no full root radius"), "{full}");
    // The default suits rings of any common size.
    for teeth in 30..200 {
        let mut d = external(teeth, 0.0);
        d.addendum = 0.8;
        let cutter = PinionCutter::suited(&d, None, 0.0, None, None);
        d.gearing = Gearing::Internal(InternalRoot::Cutter(cutter));
        geometry(&d);
    }
}

/// Arc lengths, places and radii along the outline of a ring, which runs inwards from root to tip.
#[test]
fn places_on_the_outline_are_found_again() {
    let ring = geometry(&ToothDefinition {
        tip_chamfer_m: 0.1e-3,
        ..cut(99, 0.1, CUTTER)
    });
    let curve = ProfileCurve::new(&ring);
    let mut last = f64::INFINITY;
    for k in 0..=200 {
        let s = curve.tip_start_m() * f64::from(k) / 200.0;
        let p = curve.point_at(s);
        let r = p[0].hypot(p[1]);
        assert!(r <= last + 1e-12 && r <= ring.root_radius_m + 1e-12);
        last = r;
        let (found, off) = curve.place_of(p);
        assert!(
            (found - s).abs() < 1e-8 && off.abs() < 1e-10,
            "{k} {found} {s} {off:e}"
        );
    }
    for roll in [ring.form_roll_rad, 0.4, ring.flank_end_roll_rad] {
        let p = curve.point_at(curve.arc_length_at_roll_m(roll));
        assert!(distance(p, ring.flank_point_m(Flank::Right, roll)) < 1e-8);
    }
    let at = curve
        .arc_length_at(RootPosition::TangentAngle(PI / 6.0))
        .unwrap();
    assert!((curve.tangent_angle_at_rad(at) - PI / 6.0).abs() < 1e-4);
    let radius = 0.5 * (ring.root_radius_m + ring.tip_radius_m);
    let p = curve.point_at(curve.arc_length_at(RootPosition::Radius(radius)).unwrap());
    assert!((p[0].hypot(p[1]) - radius).abs() < 1e-8);
    let wrong = curve
        .arc_length_at(RootPosition::Radius(ring.tip_radius_m))
        .unwrap_err();
    assert!(wrong.to_string().contains("allowed is"), "{wrong}");
}

const FILE: &str = "name = \"ring\"\n[tooth]\nteeth = -99\nmodule_mm = 2.0\naddendum = 0.8\nface_width_mm = 20.0\n[blank]\nkind = \"ring\"\n\
    outer_diameter_mm = 220.0\n[material]\nyoung_GPa = 206.0\npoisson = 0.3\n";

fn read(find: &str, replace: &str) -> Result<GearDefinition, String> {
    assert!(FILE.contains(find), "{find}");
    let text = FILE.replacen(find, replace, 1);
    GearDefinition::from_document(&InputDocument::new("ring.toml", text)).map_err(|e| e.to_string())
}

/// A ring's file: defaults, and what is refused by its key.
#[test]
fn the_file_of_a_ring_is_read_and_checked() {
    let ring = read("", "").unwrap();
    assert_eq!((ring.tooth.teeth, ring.tooth.signed_teeth()), (99, -99));
    let Gearing::Internal(InternalRoot::Cutter(cutter)) = ring.tooth.gearing else {
        panic!("{:?}", ring.tooth.gearing)
    };
    assert_eq!(
        (cutter.teeth, cutter.addendum, cutter.tip_radius),
        (33, 1.25, 0.25)
    );
    assert_eq!(ring.blank.edge_radius_m(), 0.11);
    let band = read(
        "outer_diameter_mm",
        "held_band_mm = [-10.0, 4.0]\nouter_diameter_mm",
    )
    .unwrap();
    assert_eq!(band.blank.rim().unwrap().held_z_m, Some([-0.01, 0.004]));
    let round = read(
        "face_width_mm",
        "root = \"full-round\"\ndedendum = 1.2\nface_width_mm",
    )
    .unwrap();
    assert!((round.profile.root_radius_m - 0.1014).abs() < 1e-12);
    for (find, replace, needed) in [
        (
            "kind = \"ring\"\nouter",
            "kind = \"solid\"\nbore",
            "blank.kind: internal teeth stand inside a ring",
        ),
        (
            "teeth = -99",
            "teeth = 99",
            "\"ring\" is the body of internal teeth",
        ),
        (
            "teeth = -99",
            "teeth = -11",
            "-1000 to -12 for internal teeth",
        ),
        (
            "face_width_mm",
            "dedendum = 1.2\nface_width_mm",
            "tooth.dedendum: is not used by internal teeth whose root a pinion cutter makes",
        ),
        (
            "face_width_mm",
            "rack_tip_radius = 0.3\nface_width_mm",
            "tooth.rack_tip_radius: is not used by internal teeth",
        ),
        (
            "[blank]",
            "[tooth.cutter]\nteeth = 98\n[blank]",
            "tooth.cutter.teeth: found 98, allowed is 5 to 96",
        ),
        (
            "[blank]",
            "[tooth.cutter]\nteeth = 12\n[blank]",
            "makes no involute at the ring's tip",
        ),
        (
            "face_width_mm = 20.0\n",
            "root = \"full-round\"\nface_width_mm = 20.0\n[tooth.cutter]\nteeth = 30\n",
            "tooth.cutter: is not used by root",
        ),
        (
            "220.0",
            "204.0",
            "blank.outer_diameter_mm: found 204, allowed is",
        ),
        (
            "outer_diameter_mm",
            "held_band_mm = [-10.0, 12.0]\nouter_diameter_mm",
            "blank.held_band_mm.1: found 12",
        ),
        (
            "outer_diameter_mm",
            "held_band_mm = [2.0, 2.0]\nouter_diameter_mm",
            "above the back, 2",
        ),
        (
            "[material]",
            "[mesh]\nelement = \"tet10\"\n[material]",
            "mesh.element: a ring is meshed in hexahedra",
        ),
        (
            "[material]",
            "[hub]\nsupport = \"reference-point\"\n[material]",
            "hub.support: a ring is fixed where it is held",
        ),
        (
            "[material]",
            "[crack]\ntooth = 0\nside = \"right\"\ndepth_mm = 0.5\ntangent_deg = 45.0\n[material]",
            "cracks are made in external teeth only",
        ),
        (
            "outer_diameter_mm = 220.0",
            "outer_diameter_mm = 220.0\nheld_band_mm = [0.0, 5.0]\n[mesh]\nplane_strain = true",
            "mesh.plane_strain: plane strain knows no band",
        ),
    ] {
        let text = read(find, replace).unwrap_err();
        assert!(text.contains(needed), "{replace}: {text}");
    }
    // External gears know nothing of cutters.
    let wheel = "teeth = 40\nroot = \"cutter\"";
    let text = read("teeth = -99", wheel).unwrap_err();
    assert!(
        text.contains("tooth.root: is used by internal teeth only"),
        "{text}"
    );
}

/// Reliefs and crowning of a ring's flank stand where they are stated: from the start diameter towards the tip, which is
/// the smaller one.
#[test]
fn microgeometry_of_a_ring_stands_where_it_is_stated() {
    let given = "[microgeometry]\ntip_relief_um = 20.0\ntip_relief_start_diameter_mm = 197.0\nroot_relief_um = 10.0\n\
        root_relief_start_diameter_mm = 200.5\nprofile_angle_um = 6.0\n[material]";
    let ring = read("[material]", given).unwrap();
    let flank = ring.microgeometry.right;
    let at = |diameter_mm: f64| {
        let roll = involute::roll_angle_rad(0.5e-3 * diameter_mm, ring.profile.base_radius_m);
        1e6 * flank.removed_m(roll, 0.0)
    };
    let tip_mm = 2e3 * ring.profile.tip_radius_m;
    let form_mm = 2e3 * involute::radius_m(ring.profile.form_roll_rad, ring.profile.base_radius_m);
    assert!((at(tip_mm) - 23.0).abs() < 1e-6, "{}", at(tip_mm));
    assert!((at(form_mm) - (10.0 - 3.0)).abs() < 1e-6, "{}", at(form_mm));
    assert!(at(199.0).abs() < 3.0 && at(197.0) > 0.0 && at(200.5) < 0.0);
    // Half the slope is added at the form circle, and no more anywhere on the flank.
    assert!(
        (1e6 * flank.most_added_m() - 3.0).abs() < 1e-9,
        "{}",
        flank.most_added_m()
    );
    for (key, diameter) in [("tip_relief", 194.0), ("tip_relief", 204.0)] {
        let text = format!(
            "[microgeometry]\n{key}_um = 20.0\n{key}_start_diameter_mm = {diameter}\n[material]"
        );
        let error = read("[material]", &text).unwrap_err();
        assert!(error.contains("the involute part of the flank"), "{error}");
    }
}
