//! Where the numbers of a parameter come from, when they are not listed.

use schemars::JsonSchema;
use serde::Deserialize;
use statrs::distribution::{ContinuousCDF, Normal};

/// `uniform`: every number of a range is as likely.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct UniformTable {
    /// Least value.
    pub from: f64,
    /// Largest value.
    pub to: f64,
}

/// `normal`: a normal distribution.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct NormalTable {
    /// Mean.
    pub mean: f64,
    /// Standard deviation.
    pub deviation: f64,
}

/// `spaced`: numbers at equal steps.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SpacedTable {
    /// First value.
    pub from: f64,
    /// Last value.
    pub to: f64,
    /// How many, both ends included.
    pub count: usize,
}

impl UniformTable {
    /// The number below which this share of all lies.
    #[must_use]
    pub fn quantile(self, probability: f64) -> f64 {
        self.from + (self.to - self.from) * probability
    }

    /// What is wrong with it, if anything is.
    #[must_use]
    pub fn problem(self) -> Option<String> {
        let ordered = self.from.is_finite() && self.to.is_finite() && self.from < self.to;
        (!ordered).then(|| {
            format!(
                "found {} to {}, allowed is from below to",
                self.from, self.to
            )
        })
    }
}

impl NormalTable {
    /// The number below which this share of all lies.
    #[must_use]
    pub fn quantile(self, probability: f64) -> f64 {
        match Normal::new(self.mean, self.deviation) {
            Ok(normal) => normal.inverse_cdf(probability),
            // Refused when the file was read.
            Err(_) => f64::NAN,
        }
    }

    /// What is wrong with it, if anything is.
    #[must_use]
    pub fn problem(self) -> Option<String> {
        let fit = self.mean.is_finite() && self.deviation.is_finite() && self.deviation > 0.0;
        (!fit).then(|| {
            format!(
                "found a deviation of {}, allowed is more than 0",
                self.deviation
            )
        })
    }
}

impl SpacedTable {
    /// The numbers.
    #[must_use]
    pub fn values(self) -> Vec<f64> {
        let last = self.count.saturating_sub(1).max(1) as f64;
        // Each from its own end: both ends are exact.
        let at = |share: f64| self.from * (1.0 - share) + self.to * share;
        (0..self.count).map(|k| at(k as f64 / last)).collect()
    }

    /// What is wrong with it, if anything is.
    #[must_use]
    pub fn problem(self) -> Option<String> {
        let fit =
            self.from.is_finite() && self.to.is_finite() && (2..=10_000).contains(&self.count);
        (!fit).then(|| {
            format!(
                "found {} values, allowed are 2 to 10000 between finite ends",
                self.count
            )
        })
    }
}
