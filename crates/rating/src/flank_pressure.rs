//! Hertz pressure of a tooth pair at a point of its path of contact. The formula is the contact crate's own.

use gearmesh_contact::hertz;
use gearmesh_geometry::{GearPair, Material};

/// Why a pair has no such pressure.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum FlankPressureError {
    /// The point is not on the path of contact, or at a base circle, where the radius of curvature is zero.
    #[error(
        "roll angle {found_rad:.6} rad on gear 1; the path of contact goes from {low_rad:.6} to {high_rad:.6} rad, and both radii \
         of curvature must be above zero"
    )]
    OffPath {
        /// Roll angle asked for.
        found_rad: f64,
        /// Start of contact.
        low_rad: f64,
        /// End of contact.
        high_rad: f64,
    },
    /// A load or elastic constant that is none.
    #[error("{what} = {found}; allowed is {allowed}")]
    Value {
        /// Name with its unit.
        what: &'static str,
        /// Its value.
        found: f64,
        /// The range in words.
        allowed: &'static str,
    },
}

/// Hertz contact of a pair at one point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlankPressure {
    /// Relative radius of curvature \[m\].
    pub relative_radius_m: f64,
    /// Half width of the contact \[m\].
    pub half_width_m: f64,
    /// Peak pressure \[Pa\].
    pub peak_pressure_pa: f64,
}

/// Half width and peak pressure under the line load `line_load_n_per_m` (normal force over the length of the contact
/// line) at the roll angle ξ₁ of gear 1.
///
/// # Errors
/// [`FlankPressureError`], see its variants.
pub fn flank_pressure(
    pair: &GearPair,
    roll_1_rad: f64,
    line_load_n_per_m: f64,
    materials: [Material; 2],
) -> Result<FlankPressure, FlankPressureError> {
    let check = |what, found: f64, ok: bool, allowed| {
        if found.is_finite() && ok {
            Ok(())
        } else {
            Err(FlankPressureError::Value {
                what,
                found,
                allowed,
            })
        }
    };
    check(
        "line load [N/m]",
        line_load_n_per_m,
        line_load_n_per_m >= 0.0,
        "0 or more",
    )?;
    for m in materials {
        check(
            "Young's modulus [Pa]",
            m.young_pa,
            m.young_pa > 0.0,
            "above 0",
        )?;
        check(
            "Poisson's ratio",
            m.poisson,
            (0.0..=0.5).contains(&m.poisson),
            "0 to 0.5",
        )?;
    }
    let (low_rad, high_rad) = (pair.roll_start_1_rad, pair.roll_end_1_rad);
    let roll_2_rad = pair.roll_2_rad(roll_1_rad);
    let slack = 1e-9;
    let on_path = roll_1_rad >= low_rad - slack && roll_1_rad <= high_rad + slack;
    if !(on_path && roll_1_rad > 0.0 && roll_2_rad > 0.0) {
        return Err(FlankPressureError::OffPath {
            found_rad: roll_1_rad,
            low_rad,
            high_rad,
        });
    }
    let relative_radius_m = pair.relative_radius_m(roll_1_rad, roll_2_rad);
    let compliance_per_pa: f64 = materials
        .iter()
        .map(|m| (1.0 - m.poisson * m.poisson) / m.young_pa)
        .sum();
    let half_width_m = hertz::half_width_m(line_load_n_per_m, relative_radius_m, compliance_per_pa);
    Ok(FlankPressure {
        relative_radius_m,
        half_width_m,
        peak_pressure_pa: hertz::peak_pressure_pa(line_load_n_per_m, half_width_m),
    })
}
