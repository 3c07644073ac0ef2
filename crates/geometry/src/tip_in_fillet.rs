//! Whether the tip edges of a gear run clear of its mate's root fillet.
//!
//! The line of action says down to which radius the tip touches the mate's flank. Where that is on the involute the
//! edge may still cut into the fillet on its way through the tooth space, if the clearance is small and the fillet
//! large: its path in the mate's frame, an epitrochoid, goes deeper than the point where it leaves the flank.

use crate::involute;
use crate::tooth::ToothGeometry;
use std::f64::consts::{FRAC_PI_2, PI};

/// Places of the edge on its way through the tooth space.
const PLACES: u32 = 200;

/// Largest depth \[m\], along the normal of the mate's fillet, of the tip edge of `tip` in `mate` while their right
/// flanks touch (the edge is then as close to the fillet as it comes); zero where it stays clear.
pub(crate) fn depth_m(tip: &ToothGeometry, mate: &ToothGeometry, centre_distance_m: f64) -> f64 {
    let a = centre_distance_m;
    let working = ((tip.base_radius_m + mate.base_radius_m) / a).acos().tan();
    let (at_pitch, mate_at_pitch) = (tip.half_angle_rad(working), mate.half_angle_rad(working));
    let ratio = tip.teeth as f64 / mate.teeth as f64;
    let form_radius = involute::radius_m(mate.form_roll_rad, mate.base_radius_m);
    let land = (tip.tip_radius_m, tip.tip_half_angle_rad());
    let end = tip.flank_end_roll_rad;
    let flank_end = (
        involute::radius_m(end, tip.base_radius_m),
        tip.half_angle_rad(end),
    );
    let mut depth = 0.0f64;
    for (radius, half_angle) in [land, flank_end] {
        // As far from the line of centres as the edge lies inside the circle on which the mate's fillet ends.
        let cos = (radius * radius + a * a - form_radius * form_radius) / (2.0 * a * radius);
        if cos >= 1.0 {
            continue;
        }
        let reach = cos.max(-1.0).acos();
        for k in 0..=PLACES {
            let angle = reach * (2.0 * f64::from(k) / f64::from(PLACES) - 1.0);
            // At θ = 0 both right flanks touch in the pitch point; `tip` turns clockwise by θ, its mate the other way.
            let turned = at_pitch - half_angle - angle;
            let mate_turn = PI + mate_at_pitch + turned * ratio;
            let (x, y) = (radius * angle.cos() - a, radius * angle.sin());
            let (sin, cos) = mate_turn.sin_cos();
            let place = [cos * x + sin * y, cos * y - sin * x];
            // Between the middle of the space and the middle of the tooth; elsewhere another tooth is meant.
            let polar = place[1].atan2(place[0]);
            if (-PI / mate.teeth as f64..0.0).contains(&polar) {
                depth = depth.max(depth_in_fillet_m(mate, place[0].hypot(place[1]), polar));
            }
        }
    }
    depth
}

/// Depth \[m\] of a point, given by its radius and polar angle, behind the right fillet of the tooth centred on +x,
/// along the fillet's normal; negative in the tooth space, zero beyond the fillet's ends.
fn depth_in_fillet_m(tooth: &ToothGeometry, radius_m: f64, polar_rad: f64) -> f64 {
    let radius_at = |t: f64| {
        let [x, y] = tooth.trochoid.point_m(t);
        x.hypot(y)
    };
    // The radius grows from the root circle to the involute.
    let (mut low, mut high) = (0.0, tooth.fillet_end_m);
    if radius_m <= radius_at(low) || radius_m >= radius_at(high) {
        return 0.0;
    }
    for _ in 0..50 {
        let middle = 0.5 * (low + high);
        if radius_at(middle) < radius_m {
            low = middle;
        } else {
            high = middle;
        }
    }
    let [x, y] = tooth.trochoid.point_m(low);
    let inside = (polar_rad - y.atan2(x)) * radius_m;
    let slope = tooth.trochoid.tangent_angle_rad(low) - (polar_rad + FRAC_PI_2);
    inside * slope.sin().abs()
}
