//! A quantity that repeats with every pitch: its mean and its harmonics over the roll angle on gear 1.
//!
//! ```text
//! f(ξ) = f₀ + Σ_n a_n cos(n z₁ (ξ − ξ₀) + p_n)
//! ```

/// Mean and harmonics of the mesh cycle.
#[derive(Debug, Clone, PartialEq)]
pub struct RollHarmonics {
    mean: f64,
    teeth_1: f64,
    start_rad: f64,
    /// a cos p and −a sin p of each harmonic.
    parts: Vec<[f64; 2]>,
}

impl RollHarmonics {
    /// A constant.
    #[must_use]
    pub fn constant(value: f64) -> Self {
        Self::new(value, &[], 1, 0.0)
    }

    /// From amplitude and phase \[rad\] of the harmonics, counted from the roll angle `start_rad` on a gear 1 with
    /// `teeth_1` teeth.
    #[must_use]
    pub fn new(mean: f64, harmonics: &[(f64, f64)], teeth_1: usize, start_rad: f64) -> Self {
        let part = |&(amplitude, phase): &(f64, f64)| {
            let (sin, cos) = phase.sin_cos();
            [amplitude * cos, -amplitude * sin]
        };
        Self {
            mean,
            teeth_1: teeth_1 as f64,
            start_rad,
            parts: harmonics.iter().map(part).collect(),
        }
    }

    /// Mean.
    #[must_use]
    pub fn mean(&self) -> f64 {
        self.mean
    }

    /// Amplitudes of the harmonics.
    pub fn amplitudes(&self) -> impl Iterator<Item = f64> {
        self.parts.iter().map(|[c, s]| c.hypot(*s))
    }

    /// All of it times a factor.
    #[must_use]
    pub fn scaled(mut self, factor: f64) -> Self {
        self.mean *= factor;
        for part in self.parts.iter_mut().flatten() {
            *part *= factor;
        }
        self
    }

    /// Value and derivative by the roll angle on gear 1 \[1/rad\].
    #[must_use]
    pub fn at(&self, roll_1_rad: f64) -> (f64, f64) {
        if self.parts.is_empty() {
            return (self.mean, 0.0);
        }
        let (sin, cos) = (self.teeth_1 * (roll_1_rad - self.start_rad)).sin_cos();
        let (mut s, mut c) = (sin, cos);
        let (mut value, mut slope) = (self.mean, 0.0);
        for (k, [a, b]) in self.parts.iter().enumerate() {
            value += a * c + b * s;
            slope += (k + 1) as f64 * self.teeth_1 * (b * c - a * s);
            // The angle of the next harmonic.
            (s, c) = (s * cos + c * sin, c * cos - s * sin);
        }
        (value, slope)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn harmonics_add_up() {
        let given = [(2.0, 0.7), (0.0, 0.0), (0.5, -1.2)];
        let curve = RollHarmonics::new(3.0, &given, 17, 0.2);
        for k in 0..40 {
            let roll = 0.013 * f64::from(k);
            let (mut value, mut slope) = (3.0, 0.0);
            for (n, (a, p)) in (1..).zip(given) {
                let (sin, cos) = (f64::from(n) * 17.0 * (roll - 0.2) + p).sin_cos();
                value += a * cos;
                slope -= f64::from(n) * 17.0 * a * sin;
            }
            let found = curve.at(roll);
            assert!((found.0 - value).abs() < 1e-12 && (found.1 - slope).abs() < 1e-10);
        }
        let amplitudes: Vec<f64> = curve.amplitudes().collect();
        assert!((amplitudes[2] - 0.5).abs() < 1e-15 && amplitudes[1] == 0.0);
        assert_eq!(RollHarmonics::constant(4.0).at(0.3), (4.0, 0.0));
    }
}
