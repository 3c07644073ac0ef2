//! The involute of a circle by its roll angle.
//!
//! The roll angle ξ = tan α_r is the angle through which the base tangent has turned since the involute left the
//! base circle: r = r_b √(1 + ξ²), radius of curvature ρ = r_b ξ. Source: Litvin and Fuentes, *Gear Geometry and
//! Applied Theory*; derivation in docs/theory/geometry.md.

/// inv α = tan α − α \[rad\].
pub fn involute_function(pressure_angle_rad: f64) -> f64 {
    pressure_angle_rad.tan() - pressure_angle_rad
}

/// Roll angle ξ = √((r/r_b)² − 1) \[rad\] of the involute at radius `radius_m` ≥ `base_radius_m`; zero below.
pub fn roll_angle_rad(radius_m: f64, base_radius_m: f64) -> f64 {
    ((radius_m / base_radius_m).powi(2) - 1.0).max(0.0).sqrt()
}

/// Radius r = r_b √(1 + ξ²) \[m\].
pub fn radius_m(roll_angle_rad: f64, base_radius_m: f64) -> f64 {
    base_radius_m * roll_angle_rad.hypot(1.0)
}

/// Polar angle swept since the base circle: inv α_r = ξ − atan ξ \[rad\].
pub fn polar_angle_rad(roll_angle_rad: f64) -> f64 {
    roll_angle_rad - roll_angle_rad.atan()
}
