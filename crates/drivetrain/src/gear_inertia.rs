//! Mass and inertia of a gear body from its geometry, in closed form and by one integral over the tooth outline.
//!
//! ```text
//! teeth: A = ½ ∮ (x dy − y dx),   J_A = ¼ ∮ (x² + y²)(x dy − y dx)      over the outline of one tooth, z times
//! hub, web, rim: rings;   openings: sectors or circles taken out of the web
//! J_zz = ρ Σ J_A b,   J_xx = J_yy = ½ J_zz + ρ Σ A (b³/12 + b z²)
//! ```
//!
//! Left out: the corner radii of slots, chamfers on hub and bore. Spur and helical alike.

use std::f64::consts::{PI, TAU};

use gearmesh_geometry::blank::{Blank, Openings, Web};
use gearmesh_geometry::{ProfileCurve, ToothGeometry};

use crate::error::{DrivetrainError, positive};

/// Points on half a tooth's outline.
const OUTLINE_POINTS: usize = 2000;

/// Mass properties of a gear body about its axis at mid-face.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct GearInertia {
    /// Mass \[kg\].
    pub mass_kg: f64,
    /// Axial position of the centre of mass \[m\].
    pub centre_z_m: f64,
    /// Centre of mass in the plane of the gear, tooth 0 on x \[m\]: not zero with a single opening only.
    pub centre_xy_m: [f64; 2],
    /// About the gear's axis \[kg·m²\].
    pub polar_kg_m2: f64,
    /// About any axis across it through the origin \[kg·m²\]: mean of the two where they differ (one or two openings).
    pub across_kg_m2: f64,
}

/// A plane figure drawn out over a width.
#[derive(Debug, Clone, Copy)]
struct Prism {
    area_m2: f64,
    polar_m4: f64,
    width_m: f64,
    z_m: f64,
}

impl GearInertia {
    /// Integrates a gear body of density `density_kg_per_m3`.
    ///
    /// # Errors
    /// [`DrivetrainError::Value`] for a density or width that is not positive,
    /// [`DrivetrainError::BodyWithoutClosedForm`] for hub and web with a contour or a body meshed elsewhere: take those
    /// from the model file.
    pub fn new(
        tooth: &ToothGeometry,
        blank: &Blank,
        face_width_m: f64,
        density_kg_per_m3: f64,
    ) -> Result<Self, DrivetrainError> {
        if blank.contour().is_some() || blank.meshed().is_some() {
            return Err(DrivetrainError::BodyWithoutClosedForm);
        }
        positive("gear body", "the density in kg/m3", density_kg_per_m3)?;
        positive("gear body", "the face width in m", face_width_m)?;
        let (area, polar) = outline(tooth);
        let mut inertia = Self::default();
        let mut add = |prism: Prism, sign: f64| inertia.add(prism, sign * density_kg_per_m3);
        let (web_width, web_z) = match blank.web() {
            None => (face_width_m, 0.0),
            Some(Web {
                thickness_m,
                offset_m,
                ..
            }) => (thickness_m, offset_m),
        };
        let whole = Prism {
            area_m2: area,
            polar_m4: polar,
            width_m: face_width_m,
            z_m: 0.0,
        };
        match blank.rim() {
            // The outline bounds the hole.
            Some(rim) => {
                add(ring(0.0, rim.outer_radius_m, face_width_m, 0.0), 1.0);
                add(whole, -1.0);
            }
            None => {
                add(whole, 1.0);
                add(ring(0.0, blank.bore_radius_m(), face_width_m, 0.0), -1.0);
            }
        }
        if let Some(web) = blank.web() {
            let (low, high) = (web.hub_radius_m, web.rim_inner_radius_m);
            add(ring(low, high, face_width_m, 0.0), -1.0);
            add(ring(low, high, web.thickness_m, web.offset_m), 1.0);
        }
        if let Some(openings) = blank.openings() {
            let (one, distance) = opening(&openings);
            let count = openings.count() as f64;
            let prism = Prism {
                area_m2: count * one.0,
                polar_m4: count * one.1,
                width_m: web_width,
                z_m: web_z,
            };
            add(prism, -1.0);
            if openings.count() == 1 {
                let lost = density_kg_per_m3 * one.0 * web_width;
                let (sin, cos) = openings.phase_rad().sin_cos();
                inertia.centre_xy_m = [cos, sin].map(|c| -lost * distance * c / inertia.mass_kg);
            }
        }
        inertia.centre_z_m /= inertia.mass_kg;
        Ok(inertia)
    }

    /// Adds a prism; `centre_z_m` holds the first moment until the end.
    fn add(&mut self, prism: Prism, density: f64) {
        let mass = density * prism.area_m2 * prism.width_m;
        let polar = density * prism.polar_m4 * prism.width_m;
        self.mass_kg += mass;
        self.centre_z_m += mass * prism.z_m;
        self.polar_kg_m2 += polar;
        self.across_kg_m2 +=
            0.5 * polar + mass * (prism.width_m * prism.width_m / 12.0 + prism.z_m * prism.z_m);
    }
}

fn ring(inner_m: f64, outer_m: f64, width_m: f64, z_m: f64) -> Prism {
    Prism {
        area_m2: PI * (outer_m * outer_m - inner_m * inner_m),
        polar_m4: 0.5 * PI * (outer_m.powi(4) - inner_m.powi(4)),
        width_m,
        z_m,
    }
}

/// Area \[m²\] and polar moment \[m⁴\] of one opening, and the distance of its centroid from the axis \[m\].
fn opening(openings: &Openings) -> ((f64, f64), f64) {
    match openings {
        Openings::Slots(s) => {
            let whole = ring(s.inner_radius_m, s.outer_radius_m, 1.0, 0.0);
            let share = s.width_rad / TAU;
            let cubes = s.outer_radius_m.powi(3) - s.inner_radius_m.powi(3);
            let area = share * whole.area_m2;
            let distance = 2.0 / 3.0 * (0.5 * s.width_rad).sin() * cubes / area;
            ((area, share * whole.polar_m4), distance)
        }
        Openings::Holes(h) => {
            let area = PI * h.radius_m * h.radius_m;
            let squares = h.pitch_radius_m.powi(2) + 0.5 * h.radius_m.powi(2);
            ((area, area * squares), h.pitch_radius_m)
        }
    }
}

/// Area \[m²\] and polar moment \[m⁴\] of the toothed disc without bore.
fn outline(tooth: &ToothGeometry) -> (f64, f64) {
    let curve = ProfileCurve::new(tooth);
    let point = |k: usize| curve.point_at(curve.length_m() * k as f64 / OUTLINE_POINTS as f64);
    let (mut area, mut polar) = (0.0, 0.0);
    let mut last = point(0);
    for k in 1..=OUTLINE_POINTS {
        let next = point(k);
        let cross = last[0] * next[1] - last[1] * next[0];
        let squares = (last[0] * last[0] + last[1] * last[1])
            + (next[0] * next[0] + next[1] * next[1])
            + (last[0] * next[0] + last[1] * next[1]);
        area += 0.5 * cross;
        polar += cross * squares / 12.0;
        last = next;
    }
    let halves = 2.0 * tooth.teeth as f64;
    (halves * area, halves * polar)
}
