//! Quadrature on the reference shapes: the cube [−1, 1]³, the unit tetrahedron and the wedge, unit triangle × [−1, 1].

/// A natural point and its weight; the weights of a rule sum to the volume of the reference shape: 8, 1/6 or 1.
pub type WeightedPoint = ([f64; 3], f64);

/// 1/√3, the abscissa of the two-point rule; both weights are 1.
const ABSCISSA_2: f64 = 0.577_350_269_189_625_8;

/// √(3/5), the outer abscissa of the three-point rule.
const ABSCISSA_3: f64 = 0.774_596_669_241_483_4;

/// Gauss's rules on [−1, 1].
const LINE_2: [(f64, f64); 2] = [(-ABSCISSA_2, 1.0), (ABSCISSA_2, 1.0)];
const LINE_3: [(f64, f64); 3] = [
    (-ABSCISSA_3, 5.0 / 9.0),
    (0.0, 8.0 / 9.0),
    (ABSCISSA_3, 5.0 / 9.0),
];

/// 2×2×2 points: exact for every polynomial of degree 3 in each variable.
pub(crate) const GAUSS_2: [WeightedPoint; 8] = product_rule(LINE_2);

/// 3×3×3 points: exact for every polynomial of degree 5 in each variable.
pub(crate) const GAUSS_3: [WeightedPoint; 27] = product_rule(LINE_3);

/// Three points in the triangle, exact for degree 2: one area coordinate is 2/3, the others 1/6.
const TRIANGLE_3: [([f64; 2], f64); 3] = [
    ([1.0 / 6.0, 1.0 / 6.0], 1.0 / 6.0),
    ([2.0 / 3.0, 1.0 / 6.0], 1.0 / 6.0),
    ([1.0 / 6.0, 2.0 / 3.0], 1.0 / 6.0),
];

/// Six points in the triangle, exact for degree 4. Source: G. Strang, G. J. Fix, *An Analysis of the Finite Element
/// Method*, 1973, table 4.1; digits from D. A. Dunavant, Int. J. Numer. Meth. Eng. 21 (1985) 1129-1148.
const TRIANGLE_6: [([f64; 2], f64); 6] = {
    const A: f64 = 0.445_948_490_915_964_9;
    const B: f64 = 0.091_576_213_509_770_74;
    const WEIGHT_A: f64 = 0.5 * 0.223_381_589_678_011_47;
    const WEIGHT_B: f64 = 0.5 * 0.109_951_743_655_321_87;
    [
        ([A, A], WEIGHT_A),
        ([1.0 - 2.0 * A, A], WEIGHT_A),
        ([A, 1.0 - 2.0 * A], WEIGHT_A),
        ([B, B], WEIGHT_B),
        ([1.0 - 2.0 * B, B], WEIGHT_B),
        ([B, 1.0 - 2.0 * B], WEIGHT_B),
    ]
};

/// 3×2 points in the wedge: degree 2 in the triangle, 3 along ζ.
pub(crate) const WEDGE_6: [WeightedPoint; 6] = prism_rule(TRIANGLE_3, LINE_2);

/// 6×3 points in the wedge: degree 4 in the triangle, 5 along ζ.
pub(crate) const WEDGE_18: [WeightedPoint; 18] = prism_rule(TRIANGLE_6, LINE_3);

/// Eight points in the tetrahedron, exact for degree 3, all weights positive. Source: P. Keast, Comput. Meth. Appl.
/// Mech. Eng. 55 (1986) 339-348; J. Yu, ibid. 43 (1984) 349-353.
pub(crate) const TET_8: [WeightedPoint; 8] = {
    const A: f64 = 0.328_163_302_516_381_7;
    const B: f64 = 0.108_047_249_898_428_6;
    const WEIGHT_A: f64 = 0.136_217_842_537_087_4 / 6.0;
    const WEIGHT_B: f64 = 0.113_782_157_462_912_6 / 6.0;
    [
        ([A, A, A], WEIGHT_A),
        ([1.0 - 3.0 * A, A, A], WEIGHT_A),
        ([A, 1.0 - 3.0 * A, A], WEIGHT_A),
        ([A, A, 1.0 - 3.0 * A], WEIGHT_A),
        ([B, B, B], WEIGHT_B),
        ([1.0 - 3.0 * B, B, B], WEIGHT_B),
        ([B, 1.0 - 3.0 * B, B], WEIGHT_B),
        ([B, B, 1.0 - 3.0 * B], WEIGHT_B),
    ]
};

/// Fourteen points in the tetrahedron, exact for degree 5, all weights positive. Source: N. J. Walkington, *Quadrature
/// on simplices of arbitrary dimension*, Carnegie Mellon University, 2000.
pub(crate) const TET_14: [WeightedPoint; 14] = {
    const A: f64 = 0.310_885_919_263_300_6;
    const B: f64 = 0.092_735_250_310_891_23;
    const C: f64 = 0.045_503_704_125_649_65;
    const D: f64 = 0.5 - C;
    const WEIGHT_A: f64 = 0.112_687_925_718_015_85 / 6.0;
    const WEIGHT_B: f64 = 0.073_493_043_116_361_95 / 6.0;
    const WEIGHT_C: f64 = 0.042_546_020_777_081_47 / 6.0;
    [
        ([A, A, A], WEIGHT_A),
        ([1.0 - 3.0 * A, A, A], WEIGHT_A),
        ([A, 1.0 - 3.0 * A, A], WEIGHT_A),
        ([A, A, 1.0 - 3.0 * A], WEIGHT_A),
        ([B, B, B], WEIGHT_B),
        ([1.0 - 3.0 * B, B, B], WEIGHT_B),
        ([B, 1.0 - 3.0 * B, B], WEIGHT_B),
        ([B, B, 1.0 - 3.0 * B], WEIGHT_B),
        ([C, C, D], WEIGHT_C),
        ([C, D, C], WEIGHT_C),
        ([D, C, C], WEIGHT_C),
        ([D, D, C], WEIGHT_C),
        ([D, C, D], WEIGHT_C),
        ([C, D, D], WEIGHT_C),
    ]
};

/// The N³ = M products of a rule on [−1, 1], ξ running fastest.
const fn product_rule<const N: usize, const M: usize>(line: [(f64, f64); N]) -> [WeightedPoint; M] {
    let mut points = [([0.0; 3], 0.0); M];
    let mut i = 0;
    while i < M {
        let (x, y, z) = (line[i % N], line[i / N % N], line[i / (N * N)]);
        points[i] = ([x.0, y.0, z.0], x.1 * y.1 * z.1);
        i += 1;
    }
    points
}

/// The T N = M products of a rule in the triangle and one on [−1, 1], the triangle running fastest.
const fn prism_rule<const T: usize, const N: usize, const M: usize>(
    triangle: [([f64; 2], f64); T],
    line: [(f64, f64); N],
) -> [WeightedPoint; M] {
    let mut points = [([0.0; 3], 0.0); M];
    let mut i = 0;
    while i < M {
        let (p, z) = (triangle[i % T], line[i / T]);
        points[i] = ([p.0[0], p.0[1], z.0], p.1 * z.1);
        i += 1;
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;

    fn integral(rule: &[WeightedPoint], power: [i32; 3]) -> f64 {
        rule.iter()
            .map(|(x, w)| w * (0..3).map(|k| x[k].powi(power[k])).product::<f64>())
            .sum()
    }

    /// ∫ t^p over [−1, 1]: 2/(p + 1) for even p, 0 for odd.
    fn on_line(p: i32) -> f64 {
        if p % 2 == 0 {
            2.0 / f64::from(p + 1)
        } else {
            0.0
        }
    }

    fn factorial(n: i32) -> f64 {
        (1..=n).map(f64::from).product()
    }

    fn powers(up_to: i32) -> impl Iterator<Item = [i32; 3]> {
        (0..=up_to)
            .flat_map(move |i| (0..=up_to).flat_map(move |j| (0..=up_to).map(move |k| [i, j, k])))
    }

    /// ∫ ξ^i η^j ζ^k over the cube is the product of the integrals; the next even degree fails.
    #[test]
    fn degrees_in_the_cube_are_three_and_five_in_each_variable() {
        let exact = |power: [i32; 3]| -> f64 { power.into_iter().map(on_line).product() };
        for (rule, degree) in [(&GAUSS_2[..], 3), (&GAUSS_3[..], 5)] {
            for power in powers(degree) {
                assert!((integral(rule, power) - exact(power)).abs() < 1e-14);
            }
            let beyond = [degree + 1, 0, 0];
            assert!((integral(rule, beyond) - exact(beyond)).abs() > 1e-2);
        }
    }

    /// ∫ ξ^i η^j over the triangle is i! j!/(i + j + 2)!.
    #[test]
    fn degrees_in_the_wedge_are_two_by_three_and_four_by_five() {
        let exact =
            |[i, j, k]: [i32; 3]| factorial(i) * factorial(j) / factorial(i + j + 2) * on_line(k);
        for (rule, plane, line) in [(&WEDGE_6[..], 2, 3), (&WEDGE_18[..], 4, 5)] {
            for power in powers(5).filter(|p| p[0] + p[1] <= plane && p[2] <= line) {
                assert!((integral(rule, power) - exact(power)).abs() < 1e-15);
            }
            for beyond in [[plane + 1, 0, 0], [0, 0, line + 1]] {
                assert!((integral(rule, beyond) - exact(beyond)).abs() > 1e-5);
            }
        }
    }

    /// ∫ ξ^i η^j ζ^k over the tetrahedron is i! j! k!/(i + j + k + 3)!.
    #[test]
    fn degrees_in_the_tetrahedron_are_three_and_five() {
        let exact = |[i, j, k]: [i32; 3]| {
            factorial(i) * factorial(j) * factorial(k) / factorial(i + j + k + 3)
        };
        for (rule, degree) in [(&TET_8[..], 3), (&TET_14[..], 5)] {
            for power in powers(degree).filter(|p| p.iter().sum::<i32>() <= degree) {
                assert!(
                    (integral(rule, power) - exact(power)).abs() < 1e-16,
                    "{power:?}"
                );
            }
            let beyond = [degree + 1, 0, 0];
            assert!((integral(rule, beyond) - exact(beyond)).abs() > 1e-6);
        }
    }
}
