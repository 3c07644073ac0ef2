//! How fast stress without resultant dies away along a round bar with a free surface: exp(−γ z/R), γ the roots of the
//! end problem of the solid cylinder. They set how long the stubs of a gear cut into its shaft are
//! (docs/theory/reduction.md, "Two faces").
//!
//! A displacement that goes with cos nθ e^(−γz) (R = 1, 2μ = 1) is a sum of three of Navier's equations: ∇H, ∇×(H̃
//! e_z), and Galerkin's 2(1−ν)∇²F e_z − ∇∂F/∂z with F = r ∂H/∂r, which is biharmonic because (r∂_r + z∂_z)H is
//! harmonic; H = J_n(γr) cos nθ e^(−γz), H̃ alike with the sine. Three tractions of the surface r = 1 vanish:
//! det(γ) = 0.

use nalgebra::{Complex, Matrix3};

type C = Complex<f64>;

const POISSON: f64 = 0.3;

/// J_n by its power series: for |x| up to 10 its terms stay below 3000, so that 1e-12 is left of 16 digits.
fn bessel(n: usize, x: C) -> C {
    let half = x * 0.5;
    let mut term = (1..=n).fold(C::new(1.0, 0.0), |t, k| t * half / k as f64);
    let mut sum = term;
    for k in 1..60 {
        term *= -half * half / (k * (k + n)) as f64;
        sum += term;
    }
    sum
}

/// J_n'.
fn slope(n: usize, x: C) -> C {
    match n {
        0 => -bessel(1, x),
        _ => (bessel(n - 1, x) - bessel(n + 1, x)) * 0.5,
    }
}

/// Tractions rr, rθ, rz of the three displacements on the surface.
fn tractions(n: usize, g: C) -> Matrix3<C> {
    let lobes = n as f64;
    let squares = lobes * lobes;
    // f = J_n(γr) and its derivatives by r, from Bessel's equation.
    let f = bessel(n, g);
    let f1 = g * slope(n, g);
    let rest = g * g - squares;
    let f2 = -f1 - rest * f;
    let f3 = -f2 + f1 - rest * f1 - f * (2.0 * squares);
    // F = r f'.
    let (big, big1, big2) = (f1, f1 + f2, f2 * 2.0 + f3);
    let dilation = POISSON / (1.0 - 2.0 * POISSON) * 2.0 * (1.0 - 2.0 * POISSON);
    let zero = C::new(0.0, 0.0);
    let radial = [f1, f * lobes, g * big1];
    let around = [f * -lobes, -f1, g * big * -lobes];
    let around1 = [(f1 - f) * -lobes, -f2, g * (big1 - big) * -lobes];
    let along1 = [
        -g * f1,
        zero,
        -g * g * big1 - g * g * f1 * (4.0 * (1.0 - POISSON)),
    ];
    let rr = [f2, (f1 - f) * lobes, g * g * g * f * dilation + g * big2];
    let of = |i: usize| {
        let rt = (radial[i] * -lobes + around1[i] - around[i]) * 0.5;
        let rz = (-g * radial[i] + along1[i]) * 0.5;
        [rr[i], rt, rz]
    };
    Matrix3::from_fn(|row, column| of(column)[row])
}

/// Zero at the roots; without lobes twisting is apart (its own roots are those of J₂, from 5.136 on).
fn determinant(n: usize, g: C) -> C {
    let m = tractions(n, g);
    if n == 0 {
        m[(0, 0)] * m[(2, 2)] - m[(0, 2)] * m[(2, 0)]
    } else {
        m.determinant()
    }
}

fn root(start: C, of: impl Fn(C) -> C) -> C {
    let mut g = start;
    for _ in 0..80 {
        let h = C::new(1e-6, 0.0);
        let step = of(g) / ((of(g + h) - of(g - h)) / 2e-6);
        g -= step;
        if step.norm() < 1e-13 {
            break;
        }
    }
    g
}

/// The least real part of a root from starts all over the quarter plane up to 5.
fn least(n: usize) -> f64 {
    let starts =
        (1..=12).flat_map(|a| (0..=4).map(move |b| (0.4 * f64::from(a), 0.5 * f64::from(b))));
    let mut least = f64::INFINITY;
    for (a, b) in starts {
        let g = root(C::new(a, b + 0.01), |g| determinant(n, g));
        let scale = determinant(n, C::new(a + 1.0, b)).norm();
        // γ = 0 are the bar's own stretching, bending and twisting, which have a resultant.
        if determinant(n, g).norm() < 1e-9 * scale && g.re > 0.3 && g.re < 6.0 {
            least = least.min(g.re);
        }
    }
    least
}

/// Without lobes the root is that of γ²(J₀² + J₁²) = 2(1 − ν) J₁², the equation of R. W. Little and S. B. Childs
/// (1967).
#[test]
fn stress_without_lobes_dies_away_as_little_and_childs_say() {
    let equation = |g: C| {
        let [j0, j1] = [bessel(0, g), bessel(1, g)];
        g * g * (j0 * j0 + j1 * j1) - j1 * j1 * (2.0 * (1.0 - POISSON))
    };
    let theirs = root(C::new(2.7, 1.4), equation);
    let ours = root(C::new(2.5, 1.2), |g| determinant(0, g));
    assert!((theirs - ours).norm() < 1e-9, "{theirs} {ours}");
    assert!((theirs.re - 2.722).abs() < 5e-4 && (theirs.im - 1.362).abs() < 5e-4);
}

/// The figures of docs/theory/reduction.md: stress with two lobes goes farthest.
#[test]
fn stress_with_two_lobes_dies_away_slowest() {
    let decay: Vec<f64> = (0..5).map(least).collect();
    for (found, stated) in decay.iter().zip([2.72, 2.82, 2.09, 3.27, 4.38]) {
        // Two decimals are stated.
        assert!((found - stated).abs() < 0.005, "{decay:?}");
    }
}
