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

/// Pressure angle \[rad\] whose involute function is `inv_rad`, more than zero; none where there is no such angle.
pub fn pressure_angle_rad(inv_rad: f64) -> Option<f64> {
    if !(inv_rad > 0.0 && inv_rad.is_finite()) {
        return None;
    }
    // From inv α ≈ α³/3 on. inv is convex and grows; d(inv α)/dα = tan²α. Halving keeps Newton's steps inside.
    let (mut low, mut high) = (0.0, std::f64::consts::FRAC_PI_2);
    let mut angle = (3.0 * inv_rad).cbrt().min(1.4);
    for _ in 0..100 {
        let excess = involute_function(angle) - inv_rad;
        if excess > 0.0 {
            high = angle;
        } else {
            low = angle;
        }
        let newton = angle - excess / angle.tan().powi(2);
        let next = if newton > low && newton < high {
            newton
        } else {
            0.5 * (low + high)
        };
        if (next - angle).abs() <= f64::EPSILON * angle {
            break;
        }
        angle = next;
    }
    Some(angle)
}
