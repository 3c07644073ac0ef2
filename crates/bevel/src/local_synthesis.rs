//! Local synthesis: what the pinion's flank must be at the mean contact so that the contact is as asked. Derived in
//! docs/theory/bevel_gears.md, "Local synthesis".

use nalgebra::{Matrix3, Vector3};

use crate::assembly::{Assembly, AssemblyError};
use crate::blank::PairBlank;
use crate::cut_surface::SurfacePoint;
use crate::error::BevelError;
use crate::flank::Flank;

/// What is asked of the contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Synthesis {
    /// Mean contact point on the gear: L less the mean cone distance, and h \[m\].
    pub mean_point_m: [f64; 2],
    /// Direction of the path on the gear's flank: from along the tooth towards the heel to up the profile \[rad\].
    pub path_angle_rad: f64,
    /// Half length of the contact ellipse along its long axis \[m\].
    pub ellipse_half_length_m: f64,
    /// Marking thickness of that ellipse \[m\].
    pub marking_m: f64,
    /// Second derivative of the gear's lead by the pinion's turn; negative where the gear stays behind to both sides.
    pub transmission_curvature: f64,
}

/// Place, normal and curvature that the pinion's flank must have, in the pinion's frame turned about its axis until
/// the place is in the x-z plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SynthesisTarget {
    /// L and h \[m\].
    pub place_m: [f64; 2],
    /// Normal into the material.
    pub normal: Vector3<f64>,
    /// Curvature tensor \[1/m\].
    pub curvature: Matrix3<f64>,
    /// Least and largest relative curvature \[1/m\].
    pub relative_per_m: [f64; 2],
}

fn refuse(problem: String) -> BevelError {
    BevelError::Synthesis { problem }
}

/// Turn of the pinion at which a point of the gear's flank meets the equation of meshing at constant ratio, by the
/// secant method from the common generator.
fn meshing_turn(assembly: &Assembly, point: &SurfacePoint) -> Option<(f64, SurfacePoint)> {
    let [m1, m2] = &assembly.members;
    let at = |turn: f64| {
        let p = m2.placed(point, -assembly.ratio * turn);
        let v = m1.axis().cross(&p.r) + m2.axis().cross(&p.r) * assembly.ratio;
        (p.n.dot(&v) / p.r.norm(), p)
    };
    let (mut a, mut b) = (0.0, 1e-4);
    let mut fa = at(a).0;
    if fa.abs() < 1e-15 {
        return Some((a, at(a).1));
    }
    for _ in 0..60 {
        let (fb, p) = at(b);
        if fb.abs() < 1e-15 || (b - a).abs() < 1e-14 {
            return Some((b, p));
        }
        let next = b - (fb * (b - a) / (fb - fa)).clamp(-0.1, 0.1);
        (a, fa) = (b, fb);
        b = next;
    }
    None
}

impl SynthesisTarget {
    /// The pinion's flank at the mean contact with the gear's flank.
    ///
    /// # Errors
    /// [`BevelError::Synthesis`] where no flank gives such a contact.
    pub fn new(blank: &PairBlank, gear: &Flank, asked: &Synthesis) -> Result<Self, BevelError> {
        let assembly = Assembly::new(blank, &AssemblyError::default());
        let [m1, m2] = &assembly.members;
        let own = gear.locate(
            gear.blank.mean_cone_m + asked.mean_point_m[0],
            asked.mean_point_m[1],
        )?;
        let (turn, p) = meshing_turn(&assembly, &own.point).ok_or_else(|| {
            refuse(
                "the mean point does not come into contact; move it towards the pitch cone"
                    .to_owned(),
            )
        })?;
        let n = -p.n;
        let facing = gear.side.mate().facing(blank.members[0].hand);
        // Speeds with the pinion at 1 rad/s; θ₂″ = −facing · d²(lead)/dθ₁².
        let w1 = m1.axis();
        let w2 = m2.axis() * -assembly.ratio;
        let w2_rate = m2.axis() * (-facing * asked.transmission_curvature);
        let w12 = w1 - w2;
        let v12 = w12.cross(&p.r);
        let k2 = -p.curvature();
        let w = k2 * v12 + w12.cross(&n);
        let b = -w.dot(&v12) + w1.cross(&n).dot(&v12) + n.dot(&w12.cross(&w1.cross(&p.r)))
            - n.dot(&w2_rate.cross(&p.r));

        // The path on the gear has the asked direction.
        let [along, up] = gear
            .directions(&own.point)
            .map(|t| m2.axes * turned(&t, -assembly.ratio * turn));
        let t2 = along * asked.path_angle_rad.cos() + up * asked.path_angle_rad.sin();
        let across = t2.dot(&w);
        if across.abs() < 1e-9 * w.norm() {
            return Err(refuse(
                "the path would lie along the line of contact; ask for another path angle"
                    .to_owned(),
            ));
        }
        let v1 = t2 * ((b + v12.dot(&w)) / across) - v12;
        let speed = v1.norm();
        let e1 = v1 / speed;
        let e2 = n.cross(&e1);
        let (along_path, twist) = (w.dot(&e1) / speed, w.dot(&e2) / speed);
        let least =
            2.0 * asked.marking_m / (asked.ellipse_half_length_m * asked.ellipse_half_length_m);
        if along_path <= least * (1.0 + 1e-9) {
            return Err(refuse(format!(
                "the relative curvature along the path is {along_path:.4} per m, that along the ellipse's long axis would be {least:.4} per m and must be less; \
                 ask for a longer ellipse, a path nearer to the profile or a larger transmission_curvature"
            )));
        }
        // Δ e1 = (p, q); the least eigenvalue κ of [[p, q], [q, s]] gives s = κ + q²/(p − κ).
        let s = least + twist * twist / (along_path - least);
        let relative = e1 * e1.transpose() * along_path
            + (e1 * e2.transpose() + e2 * e1.transpose()) * twist
            + e2 * e2.transpose() * s;
        // Relative curvature is the sum of both bodies'.
        let curvature = relative + k2;

        // Into the pinion's frame, then about its axis into the x-z plane.
        let r = turned(&(m1.axes.transpose() * p.r), -turn);
        let azimuth = r.y.atan2(r.x);
        let (sin, cos) = (-turn - azimuth).sin_cos();
        let back = Matrix3::new(cos, -sin, 0.0, sin, cos, 0.0, 0.0, 0.0, 1.0) * m1.axes.transpose();
        Ok(Self {
            place_m: blank.members[0].cone_place(r.z, r.x.hypot(r.y)),
            normal: back * n,
            curvature: back * curvature * back.transpose(),
            relative_per_m: [least, along_path + s - least],
        })
    }
}

fn turned(v: &Vector3<f64>, turn: f64) -> Vector3<f64> {
    let (s, c) = turn.sin_cos();
    Vector3::new(v.x * c - v.y * s, v.x * s + v.y * c, v.z)
}
