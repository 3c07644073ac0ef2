//! Whether the tip edges of a gear run clear of its mate's root fillet.
//!
//! The line of action says down to which radius the tip touches the mate's flank. Where that is on the involute the
//! edge may still cut into the fillet on its way through the tooth space, if the clearance is small and the fillet
//! large: its path in the mate's frame, an epitrochoid or, with a ring, a hypotrochoid, goes deeper than the point
//! where it leaves the flank.

use crate::bisection::crossing;
use crate::involute;
use crate::tooth::ToothGeometry;
use std::f64::consts::PI;

/// Places of the edge on its way through the tooth space.
const PLACES: u32 = 200;
/// To which a radius is found \[m\]: some times the rounding of one of a metre.
const ROUNDING_M: f64 = 1e-15;

/// Largest depth \[m\], along the normal of the mate's fillet, of the tip edge of `tip` in `mate` while right flanks of
/// `tip` are in contact (the edge is then as close to the fillet as it comes); zero where it stays clear.
///
/// The mate's axis lies at +a from the tip's; at −a where the mate is a ring, so that the pitch point lies at +x of
/// `tip` in all cases. In a pair with a ring right flanks touch left ones: the picture is taken in the mirror of the
/// mate, so that its right fillet is meant.
pub(crate) fn depth_m(tip: &ToothGeometry, mate: &ToothGeometry, centre_distance_m: f64) -> f64 {
    let a = centre_distance_m;
    let [outside, together] = [
        mate.tip_direction(),
        mate.tip_direction() * tip.tip_direction(),
    ];
    let sum = tip.base_radius_m + together * mate.base_radius_m;
    let working = (sum.abs() / a).acos().tan();
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
        // As far from the line of centres as the edge lies beyond the circle on which the mate's fillet ends.
        let cos =
            outside * (radius * radius + a * a - form_radius * form_radius) / (2.0 * a * radius);
        if cos >= 1.0 {
            continue;
        }
        let reach = cos.max(-1.0).acos();
        for k in 0..=PLACES {
            let angle = reach * (2.0 * f64::from(k) / f64::from(PLACES) - 1.0);
            // At θ = 0 the flanks touch in the pitch point; `tip` turns clockwise by θ.
            let turned = at_pitch - half_angle - angle;
            let mate_turn = mate_at_pitch + turned * ratio;
            let (x, y) = (radius * angle.cos() - outside * a, radius * angle.sin());
            let (x, y) = (-together * x, -y);
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
        let [x, y] = tooth.fillet.point_m(t);
        x.hypot(y)
    };
    // From the root circle to the involute the radius goes one way.
    let (low, high) = (0.0, tooth.fillet_end);
    if !(tooth.is_towards_tip(radius_m, radius_at(low))
        && tooth.is_towards_tip(radius_at(high), radius_m))
    {
        return 0.0;
    }
    let place = crossing([low, high], ROUNDING_M, |at| radius_at(at) - radius_m);
    let [x, y] = tooth.fillet.point_m(place);
    let inside = (polar_rad - y.atan2(x)) * radius_m;
    // Across the circle the fillet's tangent [± cos τ, sin τ] has this share along the radius.
    let (sin, cos) = tooth.fillet.tangent_angle_rad(place).sin_cos();
    let along_radius = tooth.tip_direction() * cos * polar_rad.cos() + sin * polar_rad.sin();
    inside * along_radius.abs()
}
