//! Rotations: exponential, logarithm and their derivatives; Cardan angles for output.
//!
//! With θ = |ψ| and ψ̃ the matrix of ψ×,
//!
//! ```text
//! exp(ψ)  = cos(θ/2) + sin(θ/2) ψ/θ                     as a unit quaternion
//! T(ψ)    = I − (1−cos θ)/θ² ψ̃ + (θ−sin θ)/θ³ ψ̃²        exp(ψ + dψ) = exp(ψ) exp(T(ψ) dψ)
//! T⁻¹(ψ)  = I + ½ ψ̃ + k ψ̃²,   k = (1 − (θ/2) cot(θ/2))/θ²
//! ```
//!
//! T acts on increments in the turned (body) frame; the one for increments in the fixed frame is T(−ψ) = Tᵀ(ψ).
//!
//! Source: O. Brüls, A. Cardona, M. Arnold, Mech. Mach. Theory 48 (2012) 121-137, eq. 61 and appendix.

use nalgebra::{Matrix3, Quaternion, UnitQuaternion, Vector3};

/// θ² below which the series are used: their next terms are smaller than the rounding of the closed forms there.
const SMALL: f64 = 1e-3;

/// The matrix of `a ×`.
#[must_use]
pub fn skew(a: &Vector3<f64>) -> Matrix3<f64> {
    a.cross_matrix()
}

/// exp(ψ): the rotation by |ψ| \[rad\] about ψ.
#[must_use]
pub fn exp(psi: &Vector3<f64>) -> UnitQuaternion<f64> {
    let half = 0.5 * psi;
    let square = half.norm_squared();
    let (cosine, sine_over) = if square < 0.25 * SMALL {
        let c = 1.0 - square / 2.0 * (1.0 - square / 12.0 * (1.0 - square / 30.0));
        let s = 1.0 - square / 6.0 * (1.0 - square / 20.0 * (1.0 - square / 42.0));
        (c, s)
    } else {
        let angle = square.sqrt();
        (angle.cos(), angle.sin() / angle)
    };
    UnitQuaternion::from_quaternion(Quaternion::from_parts(cosine, sine_over * half))
}

/// The rotation vector \[rad\] of a rotation, |ψ| ≤ π.
#[must_use]
pub fn log(rotation: &UnitQuaternion<f64>) -> Vector3<f64> {
    let sign = if rotation.w < 0.0 { -1.0 } else { 1.0 };
    let (w, v) = (sign * rotation.w, sign * rotation.imag());
    let sine = v.norm();
    if sine < 1e-4 {
        let ratio = sine / w;
        v * (2.0 / w * (1.0 - ratio * ratio / 3.0))
    } else {
        v * (2.0 * sine.atan2(w) / sine)
    }
}

/// T(ψ), shape 3×3: increment of the rotation, in the turned frame, by an increment of ψ.
#[must_use]
pub fn tangent(psi: &Vector3<f64>) -> Matrix3<f64> {
    let x = psi.norm_squared();
    let (b, c) = if x < SMALL {
        (
            0.5 - x / 24.0 * (1.0 - x / 30.0 * (1.0 - x / 56.0)),
            1.0 / 6.0 - x / 120.0 * (1.0 - x / 42.0 * (1.0 - x / 72.0)),
        )
    } else {
        let angle = x.sqrt();
        ((1.0 - angle.cos()) / x, (angle - angle.sin()) / (x * angle))
    };
    let matrix = skew(psi);
    Matrix3::identity() - b * matrix + c * matrix * matrix
}

/// k(θ²) of the module page and its derivative by θ².
fn inverse_coefficient(x: f64) -> (f64, f64) {
    if x < SMALL {
        let value = 1.0 / 12.0 + x / 720.0 + x * x / 30_240.0;
        let slope = 1.0 / 720.0 + x / 15_120.0 + x * x / 403_200.0;
        return (value, slope);
    }
    let half = 0.5 * x.sqrt();
    let cot = half.cos() / half.sin();
    let value = (1.0 - half * cot) / x;
    // d(θ/2 cot θ/2)/dθ² = (cot − half/sin²)/(8 half), with θ = 2 half.
    let slope_of_product = (cot - half / half.sin().powi(2)) / (8.0 * half);
    (value, (-slope_of_product - value) / x)
}

/// T⁻¹(ψ), shape 3×3.
#[must_use]
pub fn tangent_inverse(psi: &Vector3<f64>) -> Matrix3<f64> {
    let (k, _) = inverse_coefficient(psi.norm_squared());
    let matrix = skew(psi);
    Matrix3::identity() + 0.5 * matrix + k * matrix * matrix
}

/// ∂(T⁻¹(ψ) m)/∂ψ with m held, shape 3×3.
#[must_use]
pub fn tangent_inverse_slope(psi: &Vector3<f64>, m: &Vector3<f64>) -> Matrix3<f64> {
    let (k, k_slope) = inverse_coefficient(psi.norm_squared());
    let turned = psi.cross(m);
    let twice = psi.cross(&turned);
    -0.5 * skew(m) - k * (skew(&turned) + skew(psi) * skew(m))
        + 2.0 * k_slope * twice * psi.transpose()
}

/// Cardan angles (α, β, γ) \[rad\] with R = R_x(α) R_y(β) R_z(γ), for output only. At β = ±90°, where only α ± γ is
/// defined, γ = 0.
#[must_use]
pub fn cardan_xyz(rotation: &Matrix3<f64>) -> [f64; 3] {
    let r = rotation;
    let cosine = r[(0, 0)].hypot(r[(0, 1)]);
    let beta = r[(0, 2)].atan2(cosine);
    if cosine < 1e-12 {
        return [r[(2, 1)].atan2(r[(1, 1)]), beta, 0.0];
    }
    [
        (-r[(1, 2)]).atan2(r[(2, 2)]),
        beta,
        (-r[(0, 1)]).atan2(r[(0, 0)]),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    const VECTORS: [[f64; 3]; 4] = [
        [0.3, -1.1, 0.7],
        [1e-5, 2e-5, -3e-5],
        [0.0, 0.0, 0.0316],
        [-2.0, 0.5, 1.8],
    ];

    fn vectors() -> impl Iterator<Item = Vector3<f64>> {
        VECTORS.into_iter().map(Vector3::from)
    }

    #[test]
    fn logarithm_undoes_the_exponential() {
        for psi in vectors() {
            assert!((log(&exp(&psi)) - psi).norm() < 1e-14);
            let library = UnitQuaternion::from_scaled_axis(psi);
            assert!(exp(&psi).angle_to(&library) < 1e-15 + 1e-7 * psi.norm_squared());
            assert!((exp(&psi).norm() - 1.0).abs() < 1e-15);
        }
    }

    #[test]
    fn tangent_is_the_derivative_and_its_inverse_inverts() {
        for psi in vectors() {
            let t = tangent(&psi);
            assert!((t * tangent_inverse(&psi) - Matrix3::identity()).norm() < 1e-13);
            for axis in 0..3 {
                let mut d = Vector3::zeros();
                d[axis] = 1e-6;
                let turned = log(&(exp(&(psi - d)).inverse() * exp(&(psi + d)))) / 2e-6;
                assert!((turned - t.column(axis)).norm() < 1e-9);
            }
        }
    }

    #[test]
    fn slope_of_the_inverse_is_the_derivative() {
        let m = Vector3::new(0.4, -2.0, 1.3);
        for psi in vectors() {
            let slope = tangent_inverse_slope(&psi, &m);
            for axis in 0..3 {
                let mut d = Vector3::zeros();
                d[axis] = 1e-6;
                let difference =
                    (tangent_inverse(&(psi + d)) - tangent_inverse(&(psi - d))) * m / 2e-6;
                assert!((difference - slope.column(axis)).norm() < 1e-8);
            }
        }
    }

    #[test]
    fn cardan_angles_give_the_rotation_back() {
        let about =
            |axis: Vector3<f64>, angle: f64| *exp(&(angle * axis)).to_rotation_matrix().matrix();
        for [a, b, c] in [
            [0.3, -0.4, 2.5],
            [0.7, std::f64::consts::FRAC_PI_2, 0.2],
            [-3.0, 1.2, -1.0],
        ] {
            let r = |[a, b, c]: [f64; 3]| {
                about(Vector3::x(), a) * about(Vector3::y(), b) * about(Vector3::z(), c)
            };
            let given = r([a, b, c]);
            assert!((r(cardan_xyz(&given)) - given).norm() < 1e-12);
        }
    }
}
