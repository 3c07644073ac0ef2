//! The line on which two bevel flanks nearly touch: how long it is in a slice, and how curved the flanks are across it.
//!
//! Both are those of the pair as designed, over the place (s, v) on gear 1's flank: ln of the relative radius across the line
//! and of the line's length per unit of s, as polynomials of s and v that are fitted to samples. At a pose off the design the
//! same place of gear 1 meets a place of gear 2 nearby, whose curvature differs little.

use nalgebra::{DMatrix, DVector};

/// Degree of the polynomials.
const DEGREE: usize = 4;
/// Their terms.
const TERMS: usize = (DEGREE + 1) * (DEGREE + 2) / 2;

/// What is known at a place of gear 1's flank.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sample {
    /// s and v.
    pub at: [f64; 2],
    /// Relative radius of curvature across the line \[m\].
    pub radius_m: f64,
    /// Length of the line per unit of s \[m\].
    pub length_m: f64,
}

/// A number above zero and the derivative of its logarithm by v.
#[derive(Debug, Clone, Copy)]
pub(super) struct Grown {
    pub value: f64,
    pub growth: f64,
}

/// Radius across the line and length along it over gear 1's flank.
#[derive(Debug, Clone)]
pub(super) struct LineGeometry {
    radius: [f64; TERMS],
    length: [f64; TERMS],
    /// Largest error of either at the samples, relative.
    pub misfit: f64,
}

/// The products of powers of s and v, and their derivatives by v; both from −½ to ½.
fn terms([s, v]: [f64; 2]) -> ([f64; TERMS], [f64; TERMS]) {
    let powers = |x: f64| {
        let mut powers = [1.0; DEGREE + 1];
        for k in 1..=DEGREE {
            powers[k] = powers[k - 1] * x;
        }
        powers
    };
    let (of_s, of_v) = (powers(s - 0.5), powers(v - 0.5));
    let (mut values, mut slopes) = ([0.0; TERMS], [0.0; TERMS]);
    let mut number = 0;
    for total in 0..=DEGREE {
        values[number] = of_s[total];
        number += 1;
        for k in 1..=total {
            values[number] = of_s[total - k] * of_v[k];
            slopes[number] = k as f64 * of_s[total - k] * of_v[k - 1];
            number += 1;
        }
    }
    (values, slopes)
}

impl LineGeometry {
    /// Fitted to samples; none where they are too few or do not spread over the flank.
    pub fn fitted(samples: &[Sample]) -> Option<Self> {
        if samples.len() < 2 * TERMS {
            return None;
        }
        let rows = DMatrix::from_fn(samples.len(), TERMS, |i, k| terms(samples[i].at).0[k]);
        let svd = rows.svd(true, true);
        let fit = |of: &dyn Fn(&Sample) -> f64| -> Option<[f64; TERMS]> {
            let values = DVector::from_iterator(samples.len(), samples.iter().map(|x| of(x).ln()));
            let found = svd.solve(&values, 1e-9).ok()?;
            Some(std::array::from_fn(|k| found[k]))
        };
        let mut fitted = Self {
            radius: fit(&|sample| sample.radius_m)?,
            length: fit(&|sample| sample.length_m)?,
            misfit: 0.0,
        };
        for sample in samples {
            let [radius, length] = fitted.at(sample.at);
            for off in [
                radius.value / sample.radius_m,
                length.value / sample.length_m,
            ] {
                fitted.misfit = fitted.misfit.max((off - 1.0).abs());
            }
        }
        Some(fitted)
    }

    /// Radius across the line \[m\] and its length per unit of s \[m\].
    pub fn at(&self, at: [f64; 2]) -> [Grown; 2] {
        let (values, slopes) = terms(at);
        let sum = |of: &[f64; TERMS], by: &[f64; TERMS]| -> f64 {
            of.iter().zip(by).map(|(a, b)| a * b).sum()
        };
        [&self.radius, &self.length].map(|of| Grown {
            value: sum(of, &values).exp(),
            growth: sum(of, &slopes),
        })
    }
}
