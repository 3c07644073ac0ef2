//! The line on which two bevel flanks nearly touch: how long it is in a slice, and how curved the flanks are across it.
//!
//! Both are those of the pair as designed, over the place (s, v) on gear 1's flank: ln of the relative radius across
//! the line and of the line's length per unit of s, as polynomials of s and v that are fitted to samples. At a pose off
//! the design the same place of gear 1 meets a place of gear 2 nearby, whose curvature differs little.

use nalgebra::{DMatrix, DVector};

/// Degree of the polynomials.
const DEGREE: usize = 4;
/// Largest relative misfit that is allowed.
pub(super) const MISFIT: f64 = 0.05;
/// Distance of the logarithm's end below the lower line, in v.
const BELOW: f64 = 0.02;
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

/// What counts as the height in the polynomials.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Height {
    /// v − ½.
    Even,
    /// ln(v + 0.02).
    Stretched,
}

impl Height {
    /// Its value, and its derivative by v.
    fn at(self, v: f64) -> [f64; 2] {
        match self {
            Self::Even => [v - 0.5, 1.0],
            Self::Stretched => {
                let from_end = v.max(0.0) + BELOW;
                [from_end.ln(), 1.0 / from_end]
            }
        }
    }
}

/// Radius across the line and length along it over gear 1's flank.
#[derive(Debug, Clone)]
pub(super) struct LineGeometry {
    height: Height,
    radius: [f64; TERMS],
    length: [f64; TERMS],
    /// Largest error of either at the samples, relative.
    pub misfit: f64,
}

/// The products of powers of s and the height, and their derivatives by v.
fn terms(height: Height, [s, v]: [f64; 2]) -> ([f64; TERMS], [f64; TERMS]) {
    let powers = |x: f64| {
        let mut powers = [1.0; DEGREE + 1];
        for k in 1..=DEGREE {
            powers[k] = powers[k - 1] * x;
        }
        powers
    };
    let [height, rise] = height.at(v);
    let (of_s, of_v) = (powers(s - 0.5), powers(height));
    let (mut values, mut slopes) = ([0.0; TERMS], [0.0; TERMS]);
    let mut number = 0;
    for total in 0..=DEGREE {
        values[number] = of_s[total];
        number += 1;
        for k in 1..=total {
            values[number] = of_s[total - k] * of_v[k];
            slopes[number] = k as f64 * of_s[total - k] * of_v[k - 1] * rise;
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
        let even = Self::fitted_over(Height::Even, samples)?;
        if even.misfit < MISFIT {
            return Some(even);
        }
        let stretched = Self::fitted_over(Height::Stretched, samples);
        Some(stretched.filter(|s| s.misfit < even.misfit).unwrap_or(even))
    }

    fn fitted_over(height: Height, samples: &[Sample]) -> Option<Self> {
        let rows = DMatrix::from_fn(samples.len(), TERMS, |i, k| {
            terms(height, samples[i].at).0[k]
        });
        let svd = rows.svd(true, true);
        let fit = |of: &dyn Fn(&Sample) -> f64| -> Option<[f64; TERMS]> {
            let values = DVector::from_iterator(samples.len(), samples.iter().map(|x| of(x).ln()));
            let found = svd.solve(&values, 1e-9).ok()?;
            Some(std::array::from_fn(|k| found[k]))
        };
        let mut fitted = Self {
            height,
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
        let (values, slopes) = terms(self.height, at);
        let sum = |of: &[f64; TERMS], by: &[f64; TERMS]| -> f64 {
            of.iter().zip(by).map(|(a, b)| a * b).sum()
        };
        [&self.radius, &self.length].map(|of| Grown {
            value: sum(of, &values).exp(),
            growth: sum(of, &slopes),
        })
    }
}
