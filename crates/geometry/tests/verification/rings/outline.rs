//! The outline of a ring: against an envelope of the cutter that is found by force, the external gear with the same
//! space, the formulas of ISO 21771.

use std::f64::consts::{FRAC_PI_2, PI};

use gearmesh_geometry::definition::PinionCutter;
use gearmesh_geometry::{Flank, ProfileCurve, RootPosition, ToothGeometry, involute};

use crate::rings::*;

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

    /// Distance \[m\] of a point, by radius and polar angle, from the left involute of the tooth centred on +x,
    /// positive outside, and the roll angle of the involute's nearest point.
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

/// Every point of the ring's outline, from the root circle to the end of the flank, is touched by the cutter and not
/// cut by it: to 1e-9 m; golden sections find a minimum to the square root of rounding.
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
    // Towards the tip, and a load on the right flank turns the ring counter-clockwise with the lever of its base
    // radius.
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
