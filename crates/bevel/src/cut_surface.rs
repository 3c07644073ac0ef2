//! The surface that a tool leaves on the work, by the equation of meshing, with all derivatives to the second order.

use nalgebra::{Matrix3, Vector3};

use crate::hand::FlankSide;
use crate::jet::{Jet, JetVector};
use crate::settings::{MachineSettings, Tool};

/// A point of a surface with parameters a, b in the member's frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfacePoint {
    /// Place \[m\].
    pub r: Vector3<f64>,
    /// ∂r/∂a, ∂r/∂b.
    pub dr: [Vector3<f64>; 2],
    /// ∂²r/∂a², ∂²r/∂a∂b, ∂²r/∂b².
    pub ddr: [Vector3<f64>; 3],
    /// Unit normal into the material.
    pub n: Vector3<f64>,
    /// ∂n/∂a, ∂n/∂b.
    pub dn: [Vector3<f64>; 2],
    /// Flank: how far up the straight side of the blade the point was cut, from where the blade's edge radius begins
    /// \[m\].
    /// Fillet: angle left on the edge from there to the blade's tip \[rad\]. 0 is where the next surface begins.
    pub above_end: f64,
    /// ∂/∂a, ∂/∂b of it.
    pub above_end_slopes: [f64; 2],
}

impl SurfacePoint {
    /// (∂r/∂a × ∂r/∂b)·n \[m²\]: vanishes where the envelope is singular.
    pub fn area(&self) -> f64 {
        self.dr[0].cross(&self.dr[1]).dot(&self.n)
    }

    /// Two orthonormal tangents: the first nearest to `along`, the second n × first.
    pub fn tangents(&self, along: &Vector3<f64>) -> [Vector3<f64>; 2] {
        let first = (along - self.n * along.dot(&self.n)).normalize();
        [first, self.n.cross(&first)]
    }

    /// Curvature tensor of the surface in the member's frame \[1/m\]: dn = −curvature · dr for steps dr in the tangent
    /// plane. As n points into the
    /// material, convex bodies have positive curvatures.
    pub fn curvature(&self) -> Matrix3<f64> {
        curvature_tensor(&self.dr, &self.dn)
    }

    fn from_jets(r: JetVector, n: JetVector, above: Jet) -> Self {
        Self {
            r: r.value(),
            dr: r.first(),
            ddr: r.second(),
            n: n.value(),
            dn: n.first(),
            above_end: above.v,
            above_end_slopes: above.d,
        }
    }
}

/// −(n_a ⊗ e^a + n_b ⊗ e^b) with the dual tangents e^a, e^b of the tangents r_a, r_b.
pub(crate) fn curvature_tensor(dr: &[Vector3<f64>; 2], dn: &[Vector3<f64>; 2]) -> Matrix3<f64> {
    // Dual basis of the tangent plane: e^a·r_a = 1, e^a·r_b = 0.
    let [ra, rb] = dr;
    let (e, f, g) = (ra.dot(ra), ra.dot(rb), rb.dot(rb));
    let det = e * g - f * f;
    let dual_a = (ra * g - rb * f) / det;
    let dual_b = (rb * e - ra * f) / det;
    -(dn[0] * dual_a.transpose() + dn[1] * dual_b.transpose())
}

/// What one tool side leaves on the work.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CutSurface {
    /// Settings.
    pub settings: MachineSettings,
    /// Side of the blades.
    pub side: FlankSide,
}

/// Motion of the work against the tool at a cradle turn.
struct Motion {
    psi: Jet,
    /// ψ′ as a jet.
    rate: Jet,
    /// Unit vector of the work's axis in the machine.
    axis: JetVector,
    origin: JetVector,
}

const Z: [f64; 3] = [0.0, 0.0, 1.0];

impl CutSurface {
    fn motion(&self, phi: Jet) -> Motion {
        let s = &self.settings;
        let (sin, cos) = s.root_angle_rad.sin_cos();
        let axis = [cos, 0.0, sin];
        let origin = [
            s.work_offset_m * cos,
            s.offset_m,
            s.sliding_base_m + s.work_offset_m * sin,
        ];
        let (psi, rate) = match s.roll {
            None => (Jet::constant(0.0), Jet::constant(0.0)),
            Some(roll) => {
                let [p, p1, p2, p3] = roll.at(phi.v);
                (phi.chain([p, p1, p2]), phi.chain([p1, p2, p3]))
            }
        };
        Motion {
            psi,
            rate,
            axis: JetVector::constant(axis),
            origin: JetVector::constant(origin),
        }
    }

    /// From the machine into the member's frame; `direction` vectors have no place.
    fn in_member_frame(&self, motion: &Motion, p: JetVector, direction: bool) -> JetVector {
        let d = if direction { p } else { p - motion.origin };
        let (sin, cos) = self.settings.root_angle_rad.sin_cos();
        let x = JetVector::constant([sin, 0.0, -cos]).dot(d);
        let local = JetVector([x, d.0[1], motion.axis.dot(d)]);
        let (s, c) = motion.psi.sin_cos();
        local.turned((-s, c))
    }

    /// The part of the velocity of a point of the tool against the work that depends on its place, per unit of cradle
    /// turn.
    fn velocity(motion: &Motion, p: JetVector, direction: bool) -> JetVector {
        let d = if direction { p } else { p - motion.origin };
        JetVector::constant(Z).cross(p) - motion.axis.cross(d).times(motion.rate)
    }

    /// Point of the flank. Generated members: a is the azimuth of the blade about the cutter's axis (plane tool:
    /// distance from the machine centre
    /// \[m\]), b the turn of the cradle. Formate members: b is the distance up the blade \[m\]. None where the tool has
    /// no meshing point.
    pub fn flank(&self, a: f64, b: f64) -> Option<SurfacePoint> {
        let (ja, jb) = (Jet::parameter(a, 0), Jet::parameter(b, 1));
        let sign = self.side.sign();
        let (sin, cos) = self.settings.blade_angle_rad().sin_cos();
        let held = self.settings.roll.is_none();
        let turn = if held { Jet::constant(0.0) } else { jb };
        let motion = self.motion(turn);
        // A point on the line p₀ + s g along the blade, normal n.
        let (start, up, normal, edge) = match self.settings.tool {
            Tool::FaceMill(mill) => {
                let (st, ct) = ja.sin_cos();
                let (sq, cq) = (turn + mill.cradle_angle_rad).sin_cos();
                let (s, r) = (mill.radial_m, mill.point_radius_m);
                let zero = Jet::constant(0.0);
                (
                    JetVector([cq * s + ct * r, sq * s + st * r, zero]),
                    JetVector([ct * (sign * sin), st * (sign * sin), Jet::constant(-cos)]),
                    JetVector([ct * (sign * cos), st * (sign * cos), Jet::constant(sin)]),
                    Jet::constant(mill.edge_radius_m * (1.0 - sin) / cos),
                )
            }
            Tool::Plane {
                hand,
                end_angle_rad,
                ..
            } => {
                let (sq, cq) = jb.sin_cos();
                let zero = Jet::constant(0.0);
                let across =
                    JetVector([-sq, cq, zero]).times(Jet::constant(-self.side.facing(hand)));
                let k = |x: f64| Jet::constant(x);
                (
                    JetVector([cq * ja, sq * ja, zero]),
                    across.times(k(sin)) - JetVector::constant([0.0, 0.0, cos]),
                    across.times(k(cos)) + JetVector::constant([0.0, 0.0, sin]),
                    ja * (-end_angle_rad.tan() / cos),
                )
            }
        };
        let s = if held {
            jb
        } else {
            // n·v is linear in s.
            let slope = normal.dot(Self::velocity(&motion, up, true));
            if slope.v == 0.0 {
                return None;
            }
            -(normal.dot(Self::velocity(&motion, start, false)) * slope.reciprocal())
        };
        let p = start + up.times(s);
        let point = SurfacePoint::from_jets(
            self.in_member_frame(&motion, p, false),
            self.in_member_frame(&motion, normal, true),
            s - edge,
        );
        point.r.iter().all(|x| x.is_finite()).then_some(point)
    }

    /// n·v of a flank point over |v|: residual of the equation of meshing; 0 for a formate member.
    pub fn envelope_residual(&self, a: f64, b: f64) -> Option<f64> {
        let point = self.flank(a, b)?;
        let Some(roll) = self.settings.roll else {
            return Some(0.0);
        };
        // Back into the machine, where the velocity is ẑ × p − ψ′ a × (p − o).
        let [psi, rate, ..] = roll.at(b);
        let (sm, cm) = self.settings.root_angle_rad.sin_cos();
        let to_machine = |v: &Vector3<f64>| {
            let (s, c) = psi.sin_cos();
            let (x, y) = (v.x * c - v.y * s, v.x * s + v.y * c);
            Vector3::new(x * sm + v.z * cm, y, -x * cm + v.z * sm)
        };
        let s = &self.settings;
        let axis = Vector3::new(cm, 0.0, sm);
        let origin = axis * s.work_offset_m + Vector3::new(0.0, s.offset_m, s.sliding_base_m);
        let arm = to_machine(&point.r);
        let v = Vector3::z().cross(&(arm + origin)) - axis.cross(&arm) * rate;
        Some(to_machine(&point.n).dot(&v) / v.norm())
    }

    /// Point of the fillet that the blade's edge radius cuts. Parameters as of [`Self::flank`]; formate members: b is
    /// the angle of the normal
    /// against the machine plane \[rad\]. None without a face mill. Places where
    /// `above_end` is not between 0 and 90° less the blade angle are not on the edge.
    pub fn fillet(&self, a: f64, b: f64) -> Option<SurfacePoint> {
        let mill = self.settings.face_mill()?;
        let sign = self.side.sign();
        let (sin, cos) = mill.blade_angle_rad.sin_cos();
        let (ja, jb) = (Jet::parameter(a, 0), Jet::parameter(b, 1));
        let held = self.settings.roll.is_none();
        let turn = if held { Jet::constant(0.0) } else { jb };
        let motion = self.motion(turn);
        let (st, ct) = ja.sin_cos();
        let (sq, cq) = (turn + mill.cradle_angle_rad).sin_cos();
        let rho = mill.edge_radius_m;
        let radius = mill.point_radius_m - sign * rho * (1.0 - sin) / cos;
        // Centre of the edge's circle, and the meshing equation n·v(centre) = 0 for the angle λ of the normal.
        let centre = JetVector([
            cq * mill.radial_m + ct * radius,
            sq * mill.radial_m + st * radius,
            Jet::constant(-rho),
        ]);
        let outward = JetVector([ct * sign, st * sign, Jet::constant(0.0)]);
        let (sl, cl) = if held {
            jb.sin_cos()
        } else {
            let v = Self::velocity(&motion, centre, false);
            let (x, y) = (v.0[2], -outward.dot(v));
            let size = (x * x + y * y).sqrt();
            if size.v == 0.0 {
                return None;
            }
            // tan λ = y/x with sin λ > 0.
            let scale = size.reciprocal() * if y.v < 0.0 { -1.0 } else { 1.0 };
            (y * scale, x * scale)
        };
        // λ with its derivatives: those of sin λ = y/size where cos λ is small would lose digits, so dλ = cos λ d(sin
        // λ) − sin λ d(cos λ).
        let lambda = sl.v.atan2(cl.v);
        let slope = |i: usize| cl.v * sl.d[i] - sl.v * cl.d[i];
        let left = Jet {
            v: std::f64::consts::FRAC_PI_2 - lambda,
            d: [-slope(0), -slope(1)],
            dd: [0.0; 3],
        };
        let normal = outward.times(cl) + JetVector([Jet::constant(0.0), Jet::constant(0.0), sl]);
        let p = centre + normal.times(Jet::constant(rho));
        Some(SurfacePoint::from_jets(
            self.in_member_frame(&motion, p, false),
            self.in_member_frame(&motion, normal, true),
            left,
        ))
    }
}
