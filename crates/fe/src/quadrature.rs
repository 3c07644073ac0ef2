//! Gauss rules on the cube [−1, 1]³: natural point and weight.

/// A natural point and its weight; the weights of a rule sum to 8.
pub type WeightedPoint = ([f64; 3], f64);

/// 1/√3, the abscissa of the two-point rule; both weights are 1.
const ABSCISSA_2: f64 = 0.577_350_269_189_625_8;

/// √(3/5), the outer abscissa of the three-point rule.
const ABSCISSA_3: f64 = 0.774_596_669_241_483_4;

/// 2×2×2 points: exact for every polynomial of degree 3 in each variable.
pub(crate) const GAUSS_2: [WeightedPoint; 8] =
    product_rule([(-ABSCISSA_2, 1.0), (ABSCISSA_2, 1.0)]);

/// 3×3×3 points: exact for every polynomial of degree 5 in each variable.
pub(crate) const GAUSS_3: [WeightedPoint; 27] = product_rule([
    (-ABSCISSA_3, 5.0 / 9.0),
    (0.0, 8.0 / 9.0),
    (ABSCISSA_3, 5.0 / 9.0),
]);

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

#[cfg(test)]
mod tests {
    use super::*;

    /// ∫ ξ^i η^j ζ^k over the cube is the product of 2/(p + 1) for even p, 0 for odd; the next even degree fails.
    #[test]
    fn degrees_are_three_and_five_in_each_variable() {
        let integral = |rule: &[WeightedPoint], power: [i32; 3]| -> f64 {
            rule.iter()
                .map(|(x, w)| w * (0..3).map(|k| x[k].powi(power[k])).product::<f64>())
                .sum()
        };
        let exact = |power: [i32; 3]| -> f64 {
            power
                .iter()
                .map(|p| {
                    if p % 2 == 0 {
                        2.0 / f64::from(p + 1)
                    } else {
                        0.0
                    }
                })
                .product()
        };
        for (rule, degree) in [(&GAUSS_2[..], 3), (&GAUSS_3[..], 5)] {
            for i in 0..=degree {
                for j in 0..=degree {
                    for k in 0..=degree {
                        let power = [i, j, k];
                        assert!((integral(rule, power) - exact(power)).abs() < 1e-14);
                    }
                }
            }
            let beyond = [degree + 1, 0, 0];
            assert!((integral(rule, beyond) - exact(beyond)).abs() > 1e-2);
        }
    }
}
