//! Force between two bevel gears at the middle of the face, on their shafts.
//!
//! At the mean point P of the common line of the pitch cones, l points from the apex to the heel, a along a gear's axis
//! away from the apex, r from the axis to P, t = a × r is the way of P when the gear turns about a, m = a sin δ − r cos
//! δ points across the cone into the gear. Teeth of a right hand run along cos β l + sin β t. The normal force of teeth
//! without friction is across them, and so on that gear
//!
//! F = F_t t − s F_t tan β l + |F_t| tan α/cos β m,  F_t = T/(R_m sin δ),
//!
//! s = 1 for a right hand, −1 for a left one, T the torque about a that the mate puts on it, R_m the mean cone
//! distance, α the normal pressure angle (Niemann, Winter: Maschinenelemente, volume 3, forces of bevel gears; ISO
//! 10300-1 has the same shares). The mate feels the opposite at the same point.

use crate::bevel::BevelStage;
use crate::vectors::{add, cross, dot, unit};

/// A straight line in space.
#[derive(Debug, Clone, Copy)]
pub struct Line {
    /// A point on it \[mm\].
    pub point_mm: [f64; 3],
    /// Its direction, of length one.
    pub direction: [f64; 3],
}

/// Force on a gear and where it acts.
#[derive(Debug, Clone, Copy)]
pub struct MeanForce {
    /// Force on the pinion \[N\]; the gear feels the opposite.
    pub on_pinion_n: [f64; 3],
    /// Mean point \[mm\].
    pub point_mm: [f64; 3],
}

/// Axes further apart than this share of the mean cone distance do not cross.
const MOST_APART: f64 = 5e-3;
/// Largest difference between the angle of the axes and the shaft angle \[rad\].
const MOST_OFF_RAD: f64 = 0.02;

/// Force on the pinion: `axes` of pinion and gear, each with a point on the side of its teeth, `torque_nm` on the
/// pinion about the direction of its axis. None where the axes do not cross at the shaft angle.
pub fn mean_force(pair: &BevelStage, axes: [Line; 2], torque_nm: f64) -> Option<MeanForce> {
    let cone_mm = pair.mean_cone_distance_mm();
    let apex = crossing(axes, MOST_APART * cone_mm)?;
    let away = axes.map(|line| {
        let along = dot(add(line.point_mm, apex, -1.0), line.direction);
        line.direction.map(|x| x * along.signum())
    });
    let angle = dot(away[0], away[1]).clamp(-1.0, 1.0).acos();
    if (angle - pair.shaft_angle_deg.to_radians()).abs() > MOST_OFF_RAD {
        return None;
    }
    let a = away[0];
    let r = unit(add(away[1], a, -dot(away[1], a)))?;
    let t = cross(a, r);
    let [cone, _] = pair.pitch_angles_rad();
    let (sin, cos) = cone.sin_cos();
    let l = add(a.map(|x| cos * x), r, sin);
    let m = add(a.map(|x| sin * x), r, -cos);
    let spiral = pair.spiral_angle_deg.to_radians();
    let hand = if pair.is_right_hand { 1.0 } else { -1.0 };
    let about_a = torque_nm * dot(axes[0].direction, a);
    let tangential = about_a / (1e-3 * cone_mm * sin);
    let across = tangential.abs() * pair.pressure_angle_deg.to_radians().tan() / spiral.cos();
    let in_cone = add(
        t.map(|x| tangential * x),
        l,
        -hand * tangential * spiral.tan(),
    );
    Some(MeanForce {
        on_pinion_n: add(in_cone, m, across),
        point_mm: add(apex, l, cone_mm),
    })
}

/// Where two lines cross; none where they pass each other by more than `most_mm` or run along each other.
fn crossing([a, b]: [Line; 2], most_mm: f64) -> Option<[f64; 3]> {
    let normal = cross(a.direction, b.direction);
    let square = dot(normal, normal);
    if square < 1e-6 {
        return None;
    }
    let between = add(b.point_mm, a.point_mm, -1.0);
    let on_a = dot(cross(between, b.direction), normal) / square;
    let on_b = dot(cross(between, a.direction), normal) / square;
    let points = [(a, on_a), (b, on_b)].map(|(line, s)| add(line.point_mm, line.direction, s));
    let gap = add(points[1], points[0], -1.0);
    (dot(gap, gap).sqrt() <= most_mm).then(|| add(points[0], gap, 0.5))
}
