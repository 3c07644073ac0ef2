//! Where a ball stands against a groove that has faults: waves, spalls, or a spall of the ball.
//!
//! With ϱ, ψ, ζ the cylinder coordinates of the ball's centre in the ring's own axes, R(ψ) and z(ψ) the displaced
//! circle of the groove's centres and θ the angle of (ϱ − R, ζ − z),
//!
//! ```text
//! δ = |(ϱ − R, ζ − z)| − (r − D/2) − h(ψ, θ),
//! ∇δ = δ_ϱ e + (δ_ψ/ϱ) t + δ_ζ a
//! ∇∇δ: ee δ_ϱϱ, aa δ_ζζ, ea δ_ϱζ, tt δ_ψψ/ϱ² + δ_ϱ/ϱ, et δ_ϱψ/ϱ − δ_ψ/ϱ², at δ_ζψ/ϱ
//! ```
//!
//! The force is that of a potential of these coordinates alone: ball and ring feel equal and opposite forces, and no
//! energy is made.

use nalgebra::{Matrix3, Vector3};

use super::surface_contact::{ByTurn, Touch};
use crate::ball_row::Groove;
use crate::faults::RaceFaults;
use crate::faults::ball_spall::PlacedPatch;
use crate::faults::race_spall::Depth;
use crate::faults::waviness::Displaced;

/// The spall of a ball: against this race, and where its middle is, world axes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Patch<'a> {
    pub shape: &'a PlacedPatch,
    pub direction: Vector3<f64>,
}

/// θ of a ball's centre from the groove's centre, with its derivatives by (out, up).
struct Angle {
    cosine: f64,
    sine: f64,
    length: f64,
}

impl Angle {
    /// ∂θ/∂out, ∂θ/∂up.
    fn by(&self) -> [f64; 2] {
        [-self.sine / self.length, self.cosine / self.length]
    }

    /// ∂²θ/∂out², ∂²θ/∂out∂up, ∂²θ/∂up².
    fn by_two(&self) -> [f64; 3] {
        let (c, s, square) = (self.cosine, self.sine, self.length * self.length);
        let twice = 2.0 * s * c / square;
        [twice, (s * s - c * c) / square, -twice]
    }
}

/// The touch of a ball at w from the ring's middle; `axes` are the ring's x, y and z in the axes of w. None where
/// [`super::groove_touch`] has none.
pub(crate) fn uneven_touch(
    groove: &Groove,
    faults: Option<&RaceFaults>,
    patch: Option<Patch<'_>>,
    w: &Vector3<f64>,
    axes: &Matrix3<f64>,
) -> Option<Touch> {
    let [x, y, a] = [0, 1, 2].map(|axis| axes.column(axis).into_owned());
    let height = w.dot(&a);
    let radial = w - a * height;
    let radius = radial.norm();
    if radius < 1e-3 * groove.centre_radius_m {
        return None;
    }
    let e = radial / radius;
    let t = a.cross(&e);
    let psi = e.dot(&y).atan2(e.dot(&x));
    let waves = faults.map_or_else(Displaced::default, |faults| faults.displaced(psi));
    let out = radius - groove.centre_radius_m - waves.radial[0];
    let up = height - groove.centre_z_m - waves.axial[0];
    let length = out.hypot(up);
    if length < 1e-6 * groove.arm_m {
        return None;
    }
    let angle = Angle {
        cosine: out / length,
        sine: up / length,
        length,
    };
    let inwards = out < 0.0;
    let mut depth = faults.map_or_else(Depth::default, |faults| {
        let alpha = if inwards {
            (-up).atan2(-out)
        } else {
            up.atan2(out)
        };
        faults.depth(psi, alpha)
    });
    let along_patch = patch.and_then(|patch| PatchDepth::at(&patch, &angle, (&e, &t, &a)));
    if let Some(patch) = &along_patch {
        depth.add(&patch.depth);
    }
    let (normal, turning) = gradients(&angle, &depth, &waves, radius, (&e, &t, &a));
    let by_turn = along_patch.map(|patch| {
        // How θ and ψ follow the ball's place.
        let [by_out, by_up] = angle.by();
        let theta = e * by_out + a * by_up
            - t * ((by_out * waves.radial[1] + by_up * waves.axial[1]) / radius);
        let place =
            theta * patch.theta_turn.transpose() + t * (patch.psi_turn / radius).transpose();
        ByTurn {
            first: -patch.turn,
            place: -place,
            turn: -patch.turn_turn,
        }
    });
    Some(Touch {
        approach_m: length - groove.arm_m - depth.depth_m,
        normal,
        turning,
        by_turn,
    })
}

/// ∇δ and ∇∇δ.
fn gradients(
    angle: &Angle,
    depth: &Depth,
    waves: &Displaced,
    radius: f64,
    (e, t, a): (&Vector3<f64>, &Vector3<f64>, &Vector3<f64>),
) -> (Vector3<f64>, Matrix3<f64>) {
    let (c, s, length) = (angle.cosine, angle.sine, angle.length);
    let [h_psi, h_theta] = depth.by;
    let [h_psi_psi, h_psi_theta, h_theta_theta] = depth.by_two;
    let [t_o, t_u] = angle.by();
    let [t_oo, t_ou, t_uu] = angle.by_two();
    // By (out, up) and ψ, the circle of the groove's centres held.
    let (f_o, f_u) = (c - h_theta * t_o, s - h_theta * t_u);
    let f_oo = s * s / length - h_theta_theta * t_o * t_o - h_theta * t_oo;
    let f_ou = -s * c / length - h_theta_theta * t_o * t_u - h_theta * t_ou;
    let f_uu = c * c / length - h_theta_theta * t_u * t_u - h_theta * t_uu;
    let (f_op, f_up) = (-h_psi_theta * t_o, -h_psi_theta * t_u);
    // The circle moves with ψ.
    let ([_, r1, r2], [_, z1, z2]) = (waves.radial, waves.axial);
    let g_p = -h_psi - f_o * r1 - f_u * z1;
    let g_rp = f_op - f_oo * r1 - f_ou * z1;
    let g_zp = f_up - f_ou * r1 - f_uu * z1;
    let g_pp = -h_psi_psi - 2.0 * (f_op * r1 + f_up * z1)
        + f_oo * r1 * r1
        + 2.0 * f_ou * r1 * z1
        + f_uu * z1 * z1
        - f_o * r2
        - f_u * z2;
    let normal = e * f_o + t * (g_p / radius) + a * f_u;
    let tt = g_pp / (radius * radius) + f_o / radius;
    let et = g_rp / radius - g_p / (radius * radius);
    let frame = Matrix3::from_columns(&[*e, *t, *a]);
    let at = g_zp / radius;
    let seen = Matrix3::new(f_oo, et, f_ou, et, tt, at, f_ou, at, f_uu);
    (normal, frame * seen * frame.transpose())
}

/// What a spall of the ball takes, with derivatives by θ, ψ and the ball's rotation φ (world axes).
struct PatchDepth {
    depth: Depth,
    /// ∂h/∂φ.
    turn: Vector3<f64>,
    /// ∂²h/∂θ∂φ, ∂²h/∂ψ∂φ.
    theta_turn: Vector3<f64>,
    psi_turn: Vector3<f64>,
    /// ∂(∂h/∂φ)/∂φ.
    turn_turn: Matrix3<f64>,
}

impl PatchDepth {
    /// u = cos θ (e·c) + sin θ (a·c); none beside the patch.
    fn at(
        patch: &Patch<'_>,
        angle: &Angle,
        (e, t, a): (&Vector3<f64>, &Vector3<f64>, &Vector3<f64>),
    ) -> Option<Self> {
        let middle = &patch.direction;
        let (c, s) = (angle.cosine, angle.sine);
        let to_race = e * c + a * s;
        let u = to_race.dot(middle);
        let [depth_m, first, second] = patch.shape.depth(u)?;
        let (p, q, r) = (e.dot(middle), a.dot(middle), t.dot(middle));
        let (u_theta, u_psi) = (c * q - s * p, c * r);
        let u_turn = middle.cross(&to_race);
        let theta_turn = middle.cross(&(a * c - e * s));
        let psi_turn = middle.cross(&(t * c));
        Some(Self {
            depth: Depth {
                depth_m,
                by: [first * u_psi, first * u_theta],
                by_two: [
                    second * u_psi * u_psi - first * c * p,
                    second * u_psi * u_theta - first * s * r,
                    second * u_theta * u_theta - first * u,
                ],
            },
            turn: u_turn * first,
            theta_turn: u_turn * (second * u_theta) + theta_turn * first,
            psi_turn: u_turn * (second * u_psi) + psi_turn * first,
            turn_turn: u_turn * (u_turn * second).transpose()
                + (middle * to_race.transpose() - Matrix3::from_diagonal_element(u)) * first,
        })
    }
}
