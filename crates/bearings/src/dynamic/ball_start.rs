//! Where balls begin: in the equilibrium of the `quasi-static` bearing, rolling as they do there.

use nalgebra::Vector3;

use crate::ball_row::BallRow;
use crate::element_load::ElementLoad;
use crate::operation::Operation;
use crate::ring_load::RingLoad;
use crate::ring_pose::RingPose;

/// Place, velocity and spin of a ball in the axes of the outer ring's marker, which do not turn here.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct BallStart {
    pub place_m: Vector3<f64>,
    pub velocity_m_per_s: Vector3<f64>,
    pub spin_rad_per_s: Vector3<f64>,
}

/// The start of every ball of a row. Where the equilibrium fails, balls start on their pitch circle, at the speeds of
/// rolling.
pub(crate) fn start_of_row(
    row: &BallRow,
    pose: &RingPose,
    operation: &Operation,
) -> Vec<BallStart> {
    let mut found = Vec::with_capacity(row.balls);
    let mut ring = RingLoad::default();
    let each = |load: ElementLoad| found.push(load);
    let mut places = vec![None; row.balls];
    if row
        .add(pose, operation, &mut places, &mut ring, each)
        .is_err()
    {
        found.clear();
        found.extend((0..row.balls).map(|ball| ElementLoad {
            angle_rad: row.angle_rad(ball, operation),
            ..ElementLoad::default()
        }));
    }
    found
        .iter()
        .map(|load| start(row, load, operation))
        .collect()
}

fn start(row: &BallRow, load: &ElementLoad, operation: &Operation) -> BallStart {
    let (sine, cosine) = load.angle_rad.sin_cos();
    let e_r = Vector3::new(cosine, sine, 0.0);
    let radius = row.pitch_radius_m + load.radial_m;
    let ratio = 0.5 * row.ball_diameter_m / row.pitch_radius_m;
    let (orbit, spin) = if load.orbit_rad_per_s == 0.0 && operation.is_turning() {
        rolling(ratio, operation)
    } else {
        (load.orbit_rad_per_s, load.spin_rad_per_s)
    };
    // Axis of the spin by outer-race control, seen from the cage: ω_R (sin β, −cos β).
    let (s, c) = load.outer_contact_angle_rad.sin_cos();
    let length = s.hypot(c + ratio);
    let axis = e_r * (s / length) - Vector3::z() * ((c + ratio) / length);
    BallStart {
        place_m: e_r * radius + Vector3::z() * (row.middle_z_m + load.axial_m),
        velocity_m_per_s: Vector3::z().cross(&e_r) * (orbit * radius),
        spin_rad_per_s: axis * spin + Vector3::z() * orbit,
    }
}

/// Speeds of a ball that nothing presses: those at a contact angle of zero, γ' = D/d_m.
fn rolling(ratio: f64, operation: &Operation) -> (f64, f64) {
    let (inner, outer) = (operation.inner_rad_per_s, operation.outer_rad_per_s);
    let orbit = 0.5 * (inner * (1.0 - ratio) + outer * (1.0 + ratio));
    (orbit, 0.5 * (inner - outer) * (1.0 - ratio * ratio) / ratio)
}
