//! Compliance of one tooth by the energy method: bending, shear, axial compression, and the fillet foundation.
//!
//! The tooth is a cantilever of variable section on its real outline, fillet included, held where the fillet leaves the
//! root circle. A unit force along the inward normal at roll angle ξ makes the angle α_F = ξ − ψ_b with the
//! perpendicular to the centre line; at the section x, half thickness y, load point (x_F, y_F):
//!
//! ```text
//! bending   ∫ [(x_F − x) cos α_F − y_F sin α_F]²/(E I) dx,   I = ⅔ y³ b
//! shear     ∫ 1.2 cos²α_F/(G A) dx,   compression  ∫ sin²α_F/(E A) dx,   A = 2 y b
//! ```
//!
//! and the foundation, an elastic ring between root circle and bore (ring_foundation.rs). A root crack takes the part
//! of the section behind it out of I and A.
//!
//! Sources: D. C. H. Yang, J. Y. Lin, J. Mech. Trans. Autom. 109 (1987) 189-196; X. Tian, thesis, University of Alberta
//! (2004), for shear; S. Wu, M. Zuo, A. Parey, J. Sound Vib. 317 (2008) 308-324 for the crack.

use gearmesh_geometry::{Flank, Material, ToothGeometry};

use crate::error::{DrivetrainError, positive};
use crate::ring_foundation::RingFoundation;

/// Sections along the fillet and along the flank: the trapezoidal rule is then right to 1e-4.
const SECTIONS: usize = 200;

/// Roll angles in the table; cubic interpolation between them.
const STATIONS: usize = 61;

/// A crack from the surface of the root fillet into the tooth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RootCrack {
    /// Side of the tooth on which it opens.
    pub side: Flank,
    /// Radius at which it starts \[m\].
    pub start_radius_m: f64,
    /// Its depth \[m\].
    pub depth_m: f64,
    /// Angle to the tooth's centre line \[rad\]: 0 runs towards the centre of the gear, π/2 straight across.
    pub angle_rad: f64,
}

impl RootCrack {
    /// Distance of the crack's tip from the tooth's centre line, given the half thickness at its mouth \[m\].
    fn tip_half_m(&self, mouth_half_m: f64) -> f64 {
        mouth_half_m - self.depth_m * self.angle_rad.sin()
    }

    /// Refuses cracks that do not start on the fillet or that reach the tooth's centre line.
    ///
    /// # Errors
    /// [`DrivetrainError::Value`].
    pub fn check(&self, tooth: &ToothGeometry) -> Result<(), DrivetrainError> {
        let owner = "root crack";
        positive(owner, "the depth in m", self.depth_m)?;
        let end = tooth.fillet.point_m(tooth.fillet_end);
        let fillet = tooth.root_radius_m..=end[0].hypot(end[1]);
        DrivetrainError::require(
            owner,
            ("the radius where it starts in m", self.start_radius_m),
            fillet.contains(&self.start_radius_m),
            "on the root fillet",
        )?;
        DrivetrainError::require(
            owner,
            ("the angle to the centre line in rad", self.angle_rad),
            (0.0..=std::f64::consts::FRAC_PI_2).contains(&self.angle_rad),
            "between 0 and pi/2",
        )?;
        DrivetrainError::require(
            owner,
            ("the depth in m", self.depth_m),
            self.tip_half_m(-end[1]) > 0.0,
            "less than to the centre line of the tooth",
        )?;
        Ok(())
    }
}

/// What a tooth deflects by, over the face width, as a table in roll angle.
#[derive(Debug, Clone)]
pub struct ToothCompliance {
    start_rad: f64,
    spacing_rad: f64,
    m_per_n: Vec<f64>,
}

/// A section of the tooth: distance from the gear's centre along the tooth's centre line, half thickness on each side
/// \[m\].
#[derive(Debug, Clone, Copy)]
struct Section {
    x: f64,
    half: [f64; 2],
}

/// Parts of the compliance of one tooth \[m/N\].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ComplianceParts {
    /// Bending.
    pub bending: f64,
    /// Shear.
    pub shear: f64,
    /// Axial compression.
    pub compression: f64,
    /// Fillet foundation.
    pub foundation: f64,
}

impl ComplianceParts {
    /// Sum.
    #[must_use]
    pub fn total(&self) -> f64 {
        self.bending + self.shear + self.compression + self.foundation
    }
}

/// A gear body as the energy method sees it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BeamTooth<'a> {
    /// Gear 1 or 2, for messages.
    pub gear: usize,
    /// The tooth.
    pub tooth: &'a ToothGeometry,
    /// Material.
    pub material: Material,
    /// Face width \[m\].
    pub face_width_m: f64,
    /// Bore radius \[m\], where the body is held.
    pub bore_radius_m: f64,
}

impl BeamTooth<'_> {
    /// Half the angle that the tooth covers where its fillet leaves the root circle \[rad\].
    fn root_half_angle_rad(&self) -> f64 {
        let root = self.tooth.fillet.point_m(0.0);
        -root[1].atan2(root[0])
    }

    /// The ring below the tooth.
    fn foundation(&self) -> RingFoundation {
        let ratio = self.tooth.root_radius_m / self.bore_radius_m;
        RingFoundation::new(self.root_half_angle_rad(), ratio, self.material.poisson)
    }

    /// Sections from the root circle up to the flank at `roll_rad`.
    fn sections(&self, roll_rad: f64, crack: Option<RootCrack>) -> Vec<Section> {
        let t = self.tooth;
        let fillet = (0..=SECTIONS).map(|k| {
            let share = k as f64 / SECTIONS as f64;
            t.fillet.point_m(t.fillet_end * share)
        });
        let flank = (1..=SECTIONS).map(|k| {
            let share = k as f64 / SECTIONS as f64;
            let roll = t.form_roll_rad + (roll_rad - t.form_roll_rad) * share;
            t.flank_point_m(Flank::Right, roll)
        });
        let mut sections: Vec<Section> = (fillet.chain(flank))
            .map(|p| Section {
                x: p[0],
                half: [-p[1]; 2],
            })
            .collect();
        if let Some(crack) = crack {
            cut(&mut sections, crack);
        }
        sections
    }

    /// The parts of the compliance for a force at roll angle `roll_rad` on either flank.
    #[must_use]
    pub fn parts(&self, roll_rad: f64, crack: Option<RootCrack>) -> ComplianceParts {
        self.parts_on(&self.foundation(), roll_rad, crack)
    }

    fn parts_on(
        &self,
        ring: &RingFoundation,
        roll_rad: f64,
        crack: Option<RootCrack>,
    ) -> ComplianceParts {
        let t = self.tooth;
        let (sin, cos) = (roll_rad - t.base_half_angle_rad).sin_cos();
        let [x_f, minus_y_f] = t.flank_point_m(Flank::Right, roll_rad);
        let y_f = -minus_y_f;
        let (young, width) = (self.material.young_pa, self.face_width_m);
        let shear_modulus = young / (2.0 * (1.0 + self.material.poisson));
        let flexibility = |s: &Section| {
            let thickness = s.half[0] + s.half[1];
            let area = thickness * width;
            let inertia = width * thickness.powi(3) / 12.0;
            let moment = (x_f - s.x) * cos - y_f * sin;
            [
                moment * moment / (young * inertia),
                1.2 * cos * cos / (shear_modulus * area),
                sin * sin / (young * area),
            ]
        };
        let mut sums = [0.0; 3];
        let sections = self.sections(roll_rad, crack);
        for pair in sections.windows(2) {
            let length = pair[1].x - pair[0].x;
            let (a, b) = (flexibility(&pair[0]), flexibility(&pair[1]));
            for (sum, (a, b)) in sums.iter_mut().zip(a.into_iter().zip(b)) {
                *sum += 0.5 * (a + b) * length;
            }
        }
        // The line of the force crosses the centre line at this distance from the gear's centre.
        let crossing = x_f - y_f * sin / cos;
        let foundation = ring.compliance(crossing / t.root_radius_m, [sin, cos]) / (young * width);
        ComplianceParts {
            bending: sums[0],
            shear: sums[1],
            compression: sums[2],
            foundation,
        }
    }

    /// The table over the whole flank.
    #[must_use]
    pub fn table(&self, crack: Option<RootCrack>) -> ToothCompliance {
        let (start, end) = (self.tooth.form_roll_rad, self.tooth.flank_end_roll_rad);
        let spacing_rad = (end - start) / (STATIONS - 1) as f64;
        let ring = self.foundation();
        let total = |k: usize| {
            let roll = start + k as f64 * spacing_rad;
            self.parts_on(&ring, roll, crack).total()
        };
        ToothCompliance {
            start_rad: start,
            spacing_rad,
            m_per_n: (0..STATIONS).map(total).collect(),
        }
    }
}

/// Takes the part of each section behind the crack away: below the crack's tip the section ends at the crack, above it
/// at the tip's distance from the centre line.
fn cut(sections: &mut [Section], crack: RootCrack) {
    let near = (sections.iter())
        .min_by(|a, b| {
            let off = |s: &Section| (s.x.hypot(s.half[0]) - crack.start_radius_m).abs();
            off(a).total_cmp(&off(b))
        })
        .copied();
    let Some(mouth) = near else { return };
    let tip_half = crack.tip_half_m(mouth.half[0]);
    let tip_x = mouth.x - crack.depth_m * crack.angle_rad.cos();
    let side = match crack.side {
        Flank::Right => 0,
        Flank::Left => 1,
    };
    for section in sections.iter_mut() {
        if section.x >= tip_x && section.half[side] > tip_half {
            section.half[side] = tip_half;
        }
    }
}

impl ToothCompliance {
    /// Compliance \[m/N\] and its derivative by the roll angle; held at the ends of the flank.
    #[must_use]
    pub fn at(&self, roll_rad: f64) -> (f64, f64) {
        let place = (roll_rad - self.start_rad) / self.spacing_rad;
        let last = self.m_per_n.len() - 1;
        if place <= 0.0 {
            return (self.m_per_n[0], 0.0);
        }
        if place >= last as f64 {
            return (self.m_per_n[last], 0.0);
        }
        let k = place as usize;
        let s = place - k as f64;
        let slope = |i: usize| {
            let (low, high) = (i.saturating_sub(1), (i + 1).min(last));
            (self.m_per_n[high] - self.m_per_n[low]) / (high - low) as f64
        };
        let (y0, y1, m0, m1) = (self.m_per_n[k], self.m_per_n[k + 1], slope(k), slope(k + 1));
        let rise = y1 - y0;
        let (c2, c3) = (3.0 * rise - 2.0 * m0 - m1, m0 + m1 - 2.0 * rise);
        (
            y0 + s * (m0 + s * (c2 + s * c3)),
            (m0 + s * (2.0 * c2 + 3.0 * s * c3)) / self.spacing_rad,
        )
    }
}
