//! The critical section of a spur tooth's root under a load at one point of the flank, and Lewis's form factor.
//!
//! The load F acts along the flank's normal at the roll angle ξ. It makes the angle φ = ξ − ψ_b with the normal of the
//! tooth's centre line and meets that line at the radius r_v = r_b/cos φ. A section at the distance x from the gear's
//! axis, s = 2|y| thick, carries
//!
//! ```text
//! σ_b = 6 F cos φ h/(b s²),     h = r_v − x          and the compression  F sin φ/(b s)
//! ```
//!
//! - [`RootConstruction::Parabola`] (W. Lewis 1892): the section where σ_b is largest. There a parabola with its vertex
//!   at r_v, a beam of equal strength, touches the profile: tan τ = |y|/(2h), with the profile's angle τ against the
//!   centre line.
//! - [`RootConstruction::Tangent30`] (ISO 6336-3, H. Hofer 1947): the section where the fillet's tangent makes 30° with
//!   the centre line.
//!
//! Lewis's factor is Y = s²/(6 h m), so that σ = F_t/(b m Y) for a tangential force F_t across the tooth.

use gearmesh_geometry::fillet::{Fillet, rack::Trochoid};
use gearmesh_geometry::{GearPair, GeometryError, ProfileCurve, ToothGeometry};
use std::f64::consts::{FRAC_PI_6, TAU};

/// Sections tried before the search is refined.
const SECTIONS: usize = 600;

/// How the critical section is found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RootConstruction {
    /// Lewis's inscribed parabola: the section of the largest bending stress.
    Parabola,
    /// The 30° tangent of ISO 6336-3, whatever the load.
    Tangent30,
}

/// Why a tooth has no such section.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum RootSectionError {
    /// The plane construction does not hold for helical teeth.
    #[error(
        "helix angle {helix_angle_deg:.4} deg: the root section is that of spur teeth; take the virtual spur gear of the normal \
         section (VirtualGear)"
    )]
    Helical {
        /// Helix angle found.
        helix_angle_deg: f64,
    },
    /// The section is that of external teeth.
    #[error(
        "internal teeth: the root section is that of external teeth; take the stress of a gauge or of the reduced ring"
    )]
    Internal,
    /// The load is not on the flank.
    #[error(
        "the load is at roll angle {found_rad:.6} rad; the flank goes from {low_rad:.6} to {high_rad:.6} rad"
    )]
    LoadOffFlank {
        /// Roll angle asked for.
        found_rad: f64,
        /// Start of the involute.
        low_rad: f64,
        /// End of the flank.
        high_rad: f64,
    },
    /// The fillet has no 30° tangent, or only above the load's vertex.
    #[error(
        "the fillet's tangent goes from {low_deg:.2} to {high_deg:.2} deg against the centre line and reaches 30 deg nowhere \
         below the load: use the parabola"
    )]
    NoTangent {
        /// Smallest angle, at the flank.
        low_deg: f64,
        /// Largest angle, at the root circle.
        high_deg: f64,
    },
    /// Two pairs carry everywhere.
    #[error(
        "contact ratio {contact_ratio:.4}: with 2 or more no point of the path has a single pair in contact; let the load act at the tip"
    )]
    NoSingleContact {
        /// Contact ratio, of helical teeth in the normal section.
        contact_ratio: f64,
    },
    /// The normal section of a helical tooth is that of no spur gear.
    #[error("no spur gear with {teeth} teeth has the tooth's normal section: {source}")]
    Virtual {
        /// Number of teeth of the spur gear.
        teeth: usize,
        /// Why it cannot be cut.
        source: GeometryError,
    },
}

/// The critical section of a tooth under one load.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RootSection {
    /// Distance x of the section from the gear's axis, along the tooth's centre line \[m\].
    pub distance_from_axis_m: f64,
    /// Thickness s of the tooth there \[m\].
    pub thickness_m: f64,
    /// Lever arm h from the section to where the load meets the centre line \[m\].
    pub lever_m: f64,
    /// Angle φ of the load against the normal of the centre line \[rad\].
    pub load_angle_rad: f64,
    /// Radius ρ_F of the fillet where its tangent makes 30° with the centre line \[m\]; the section's own by that
    /// construction.
    pub notch_radius_m: f64,
}

impl RootSection {
    /// Finds the section for a load at roll angle `load_roll_rad` of the flank (`tooth.flank_end_roll_rad`: the tip).
    ///
    /// # Errors
    /// [`RootSectionError`], see its variants.
    pub fn new(
        tooth: &ToothGeometry,
        load_roll_rad: f64,
        construction: RootConstruction,
    ) -> Result<Self, RootSectionError> {
        let trochoid = rack_trochoid(tooth)?;
        refuse_helical(tooth)?;
        let (low_rad, high_rad) = (tooth.form_roll_rad, tooth.flank_end_roll_rad);
        // Rolls computed from a pair's path meet the ends to rounding only.
        let slack = 1e-9;
        if !(load_roll_rad >= low_rad - slack && load_roll_rad <= high_rad + slack) {
            return Err(RootSectionError::LoadOffFlank {
                found_rad: load_roll_rad,
                low_rad,
                high_rad,
            });
        }
        let load_angle_rad = load_roll_rad - tooth.base_half_angle_rad;
        let vertex_m = tooth.base_radius_m / load_angle_rad.cos();
        let tangent = (tooth.fillet).parameter_at_tangent(FRAC_PI_6, tooth.fillet_end);
        let point = match construction {
            RootConstruction::Parabola => weakest_section(tooth, load_roll_rad, vertex_m),
            RootConstruction::Tangent30 => tangent
                .map(|t| trochoid.point_m(t))
                .filter(|p| p[0] < vertex_m)
                .ok_or_else(|| RootSectionError::NoTangent {
                    low_deg: trochoid.tangent_angle_rad(tooth.fillet_end).to_degrees(),
                    high_deg: trochoid.tangent_angle_rad(0.0).to_degrees(),
                })?,
        };
        Ok(Self {
            distance_from_axis_m: point[0],
            thickness_m: 2.0 * point[1].abs(),
            lever_m: vertex_m - point[0],
            load_angle_rad,
            notch_radius_m: tangent.map_or(0.0, |t| fillet_radius_m(trochoid, t)),
        })
    }

    /// Stress correction factor Y_S = (1.2 + 0.13 L) q_s^(1/(1.21 + 2.3/L)) of ISO 6336-3:2006, 7.2, with L = s/h and
    /// the notch parameter q_s = s/(2 ρ_F); the standard gives it for 1 ≤ q_s < 8. Of the section with the 30° tangent.
    pub fn stress_correction_factor(&self) -> f64 {
        let slenderness = self.thickness_m / self.lever_m;
        let notch = 0.5 * self.thickness_m / self.notch_radius_m;
        (1.2 + 0.13 * slenderness) * notch.powf(1.0 / (1.21 + 2.3 / slenderness))
    }

    /// Lewis's form factor Y = s²/(6 h m), in modules.
    pub fn lewis_factor(&self, module_m: f64) -> f64 {
        self.thickness_m * self.thickness_m / (6.0 * self.lever_m * module_m)
    }

    /// Form factor of ISO 6336-3, Y_F = 6 (h/m) cos φ/((s/m)² cos α): σ_F0 = F_t Y_F/(b m) without its notch factor
    /// Y_S.
    pub fn iso_form_factor(&self, module_m: f64, pressure_angle_rad: f64) -> f64 {
        self.load_angle_rad.cos() / (self.lewis_factor(module_m) * pressure_angle_rad.cos())
    }

    /// Nominal bending stress 6 F cos φ h/(b s²) \[Pa\] under the normal force F \[N\] over the face width b \[m\]:
    /// tension on the loaded side, positive. Only the part of F across the tooth bends it; Lewis's own formula takes
    /// the tangential force at the pitch circle for it ([`lewis_stress_pa`]).
    pub fn bending_stress_pa(&self, normal_force_n: f64, face_width_m: f64) -> f64 {
        6.0 * normal_force_n * self.load_angle_rad.cos() * self.lever_m
            / (face_width_m * self.thickness_m * self.thickness_m)
    }

    /// Compression F sin φ/(b s) \[Pa\] by the radial part of the load, positive: the loaded side carries σ_b minus
    /// this.
    pub fn compressive_stress_pa(&self, normal_force_n: f64, face_width_m: f64) -> f64 {
        normal_force_n * self.load_angle_rad.sin() / (face_width_m * self.thickness_m)
    }
}

/// Lewis's bending stress σ = F_t/(b m Y) \[Pa\]: tangential force F_t \[N\] at the pitch circle, face width b and
/// module m \[m\]. Against [`RootSection::bending_stress_pa`] it is higher by cos α/cos φ, some per cent for a load at
/// the tip.
pub fn lewis_stress_pa(
    tangential_force_n: f64,
    face_width_m: f64,
    module_m: f64,
    lewis_factor: f64,
) -> f64 {
    tangential_force_n / (face_width_m * module_m * lewis_factor)
}

/// Where the whole force acts on a tooth for its root stress.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LoadPoint {
    /// The highest point of single contact.
    HighestSingleContact,
    /// The tip, or the end of the flank below a chamfer.
    Tip,
}

/// Roll angle \[rad\] of the highest point of single contact of a spur tooth: ε_α − 1 base pitches below the end of its
/// flank, that is one base pitch from the other end of the path.
///
/// # Errors
/// [`RootSectionError::NoSingleContact`] from a contact ratio of 2 on, [`RootSectionError::Helical`].
pub fn highest_single_contact_roll_rad(
    tooth: &ToothGeometry,
    contact_ratio: f64,
) -> Result<f64, RootSectionError> {
    refuse_helical(tooth)?;
    if contact_ratio >= 2.0 {
        return Err(RootSectionError::NoSingleContact { contact_ratio });
    }
    // Below a contact ratio of one only by rounding: the whole flank is in single contact.
    let pitch_rad = TAU / tooth.teeth as f64;
    Ok(tooth.flank_end_roll_rad - (contact_ratio - 1.0).max(0.0) * pitch_rad)
}

/// Roll angles \[rad\] of the highest points of single contact on gear 1 and gear 2 of a spur pair.
///
/// # Errors
/// As [`highest_single_contact_roll_rad`].
pub fn highest_single_contact_rolls_rad(pair: &GearPair) -> Result<[f64; 2], RootSectionError> {
    let of = |tooth| highest_single_contact_roll_rad(tooth, pair.contact_ratio());
    Ok([of(&pair.gear_1)?, of(&pair.gear_2)?])
}

/// Radius of curvature \[m\] of a spur tooth's fillet at a parameter: that of the path of the rounding's centre, (H² +
/// t²)^(3/2)/(H² + t² + r H), and the rounding's own. docs/theory/rating.md derives it; ISO 6336-3 has the same for the
/// 30° tangent.
fn fillet_radius_m(trochoid: &Trochoid, t_m: f64) -> f64 {
    let depth_m = trochoid.centre_depth_m;
    let squared = depth_m * depth_m + t_m * t_m;
    let of_path = squared.powf(1.5) / (squared + trochoid.reference_radius_m * depth_m);
    trochoid.tip_radius_m + of_path
}

/// The fillet of a tooth that a rack has cut.
fn rack_trochoid(tooth: &ToothGeometry) -> Result<&Trochoid, RootSectionError> {
    match &tooth.fillet {
        Fillet::Rack(trochoid) => Ok(trochoid),
        Fillet::Cutter(_) | Fillet::FullRound(_) => Err(RootSectionError::Internal),
    }
}

fn refuse_helical(tooth: &ToothGeometry) -> Result<(), RootSectionError> {
    if tooth.helix_angle_rad == 0.0 {
        return Ok(());
    }
    Err(RootSectionError::Helical {
        helix_angle_deg: tooth.helix_angle_rad.to_degrees(),
    })
}

/// The profile point below the load at which h/s² is largest.
fn weakest_section(tooth: &ToothGeometry, load_roll_rad: f64, vertex_m: f64) -> [f64; 2] {
    let curve = ProfileCurve::new(tooth);
    let end_m = curve.arc_length_at_roll_m(load_roll_rad);
    let weakness = |arc_m: f64| {
        let p = curve.point_at(arc_m);
        (vertex_m - p[0]) / (p[1] * p[1])
    };
    let step = end_m / SECTIONS as f64;
    let (mut best, mut most) = (0, f64::NEG_INFINITY);
    for k in 0..=SECTIONS {
        let found = weakness(k as f64 * step);
        if found > most {
            (best, most) = (k, found);
        }
    }
    // Golden section between the neighbours.
    let ratio = 0.5 * (5f64.sqrt() - 1.0);
    let (mut low, mut high) = (
        best.saturating_sub(1) as f64 * step,
        ((best + 1) as f64 * step).min(end_m),
    );
    for _ in 0..80 {
        let (a, b) = (high - ratio * (high - low), low + ratio * (high - low));
        if weakness(a) > weakness(b) {
            high = b;
        } else {
            low = a;
        }
    }
    curve.point_at(0.5 * (low + high))
}
