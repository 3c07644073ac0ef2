//! The corners of a pinion inside a ring, and how deep they run into its teeth: trochoidal interference.
//!
//! Away from the line of action tips of both gears pass each other; where the numbers of teeth are close, they collide.
//! The path of a corner in the ring's frame is a hypotrochoid; it is followed in steps and compared with the ring's
//! flanks. So are the straight paths on which it comes into the ring radially.

use crate::involute;
use crate::tooth::ToothGeometry;
use std::f64::consts::TAU;

/// Places of a corner on its way through the ring.
const PLACES: u32 = 1000;

/// A pinion or cutter that rolls inside a ring.
pub(crate) struct RollingPinion {
    /// Its number of teeth.
    pub teeth: usize,
    /// Its corners: radius \[m\] and angle from the middle of the tooth \[rad\], of one side; the other is their image.
    pub corners: Vec<(f64, f64)>,
    /// Distance of the axes \[m\].
    pub centre_distance_m: f64,
    /// Angle by which the pinion is turned from where its tooth stands in the middle of the space \[rad\].
    pub turned_rad: f64,
}

/// The worst place of all corners.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Overlap {
    /// Depth along the normal of the ring's flank \[m\]; zero where all is clear.
    pub depth_m: f64,
    /// Tip radius \[m\] from which on the ring is clear; zero where all is clear.
    pub clear_tip_radius_m: f64,
}

/// How deep the corners of a pinion run into the flanks of a ring, between its tip and form circles.
pub(crate) fn deepest(ring: &ToothGeometry, pinion: &RollingPinion) -> Overlap {
    let a = pinion.centre_distance_m;
    let pitch = TAU / ring.teeth as f64;
    let ratio = pinion.teeth as f64 / ring.teeth as f64;
    let form_radius = involute::radius_m(ring.form_roll_rad, ring.base_radius_m);
    let mut worst = Overlap::default();
    for &(radius, offset) in &pinion.corners {
        // As far from the line of centres as the corner lies outside the ring's tip circle.
        let cos = (ring.tip_radius_m.powi(2) - a * a - radius * radius) / (2.0 * a * radius);
        if cos >= 1.0 {
            continue;
        }
        let reach = cos.max(-1.0).acos();
        for side in [1.0, -1.0] {
            for k in 0..=PLACES {
                let zeta = reach * (2.0 * f64::from(k) / f64::from(PLACES) - 1.0);
                let (sin, cos) = zeta.sin_cos();
                let (along, across) = (a + radius * cos, radius * sin);
                let at = along.hypot(across);
                if at <= ring.tip_radius_m || at > form_radius {
                    continue;
                }
                // From the middle of the space; the ring's teeth stand half a pitch from it.
                let line = (side * offset + pinion.turned_rad - zeta) * ratio;
                let polar = line + across.atan2(along) + 0.5 * pitch;
                let from_tooth = polar - pitch * (polar / pitch).round();
                let roll = involute::roll_angle_rad(at, ring.base_radius_m);
                let inside = ring.half_angle_rad(roll) - from_tooth.abs();
                // Along the circle by the radius, along the normal by the cosine of the pressure angle, r_b/r.
                let depth = inside * ring.base_radius_m;
                if depth > 0.0 {
                    worst.depth_m = worst.depth_m.max(depth);
                    if depth > 1e-9 {
                        worst.clear_tip_radius_m = worst.clear_tip_radius_m.max(at);
                    }
                }
            }
        }
    }
    worst
}

/// Least room \[m\] between a corner of a gear inside a ring and the ring's corner beside which it comes in along the
/// line of centres, on the ring's tip circle; negative where they collide, so that the gear comes in along its axis
/// only. Whichever teeth stand on the line of centres.
///
/// A tooth at φ from that line has its far corner at θ₁ = φ + ψ₁, and all along the way at the height y = r_a1 sin θ₁.
/// The ring's corner on that side of the space at φ z₁/z₂ must stand farther out, asin(y/r_a2) ≤ φ z₁/z₂ + σ₂, with ψ₁
/// and σ₂ half angles of tooth and space at the tips. Derived; where it is least, both corners turn alike, which gives
/// the condition for trimming that handbooks print.
pub(crate) fn radial_room_m(inside: &ToothGeometry, ring: &ToothGeometry, distance_m: f64) -> f64 {
    let (r, a) = (inside.tip_radius_m, distance_m);
    // Beyond this angle the corner is inside the ring's tip circle where it runs.
    let cos = (ring.tip_radius_m.powi(2) - a * a - r * r) / (2.0 * a * r);
    let reach = cos.clamp(-1.0, 1.0).acos();
    let ratio = inside.teeth as f64 / ring.teeth as f64;
    let space = 0.5 * TAU / ring.teeth as f64 - ring.tip_half_angle_rad();
    let corner = inside.tip_half_angle_rad();
    let room = |k: u32| {
        let theta = reach * f64::from(k) / f64::from(PLACES);
        let height = (r * theta.sin() / ring.tip_radius_m).min(1.0);
        (theta - corner) * ratio + space - height.asin()
    };
    ring.tip_radius_m * (0..=PLACES).map(room).fold(f64::INFINITY, f64::min)
}
