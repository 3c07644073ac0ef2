//! Laws along the profile: reliefs at tip and root, profile crowning.

/// How a relief grows from its start, s = 0, to the place where its amount is stated, s = 1.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum ReliefShape {
    /// s.
    #[default]
    Linear,
    /// s².
    Parabolic,
    /// A circle that touches the unmodified flank at the start.
    Arc {
        /// Length from the start to the place of the amount \[m\]: roll length along the profile, or along the axis.
        length_m: f64,
    },
}

impl ReliefShape {
    /// `amount_m` g(s) \[m\] and its derivative by s; zero before the start.
    ///
    /// Of the arc, with R = (L² + C²)/(2C) its radius and l = sL: C g = R − √(R² − l²).
    #[must_use]
    pub fn removed_m(self, amount_m: f64, s: f64) -> (f64, f64) {
        if s <= 0.0 {
            return (0.0, 0.0);
        }
        match self {
            Self::Linear => (amount_m * s, amount_m),
            Self::Parabolic => (amount_m * s * s, 2.0 * amount_m * s),
            Self::Arc { .. } if amount_m == 0.0 => (0.0, 0.0),
            Self::Arc { length_m } => {
                let depth = amount_m.abs();
                let radius = 0.5 * (length_m * length_m + depth * depth) / depth;
                // No farther than where the circle has turned by a quarter.
                let along = (s * length_m).min(radius);
                let across = (radius * radius - along * along).sqrt();
                // R − √(R² − l²) without the loss of digits.
                let removed = along * along / (radius + across);
                let slope = length_m * along / across.max(f64::EPSILON * radius);
                (removed.copysign(amount_m), slope.copysign(amount_m))
            }
        }
    }

    /// Name in files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Linear => "linear",
            Self::Parabolic => "parabolic",
            Self::Arc { .. } => "arc",
        }
    }
}

/// Profile crowning: a parabola in roll length, zero at `centre_roll_rad`, `amount_m` at the tip circle.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ProfileCrowning {
    /// Material removed at the tip circle \[m\].
    pub amount_m: f64,
    /// Roll angle at the diameter where nothing is removed \[rad\].
    pub centre_roll_rad: f64,
}

/// Relief of the profile at the tip or at the root.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ProfileRelief {
    /// Material removed at the tip circle, or at the form circle \[m\].
    pub amount_m: f64,
    /// Roll angle at which the relief starts \[rad\].
    pub start_roll_rad: f64,
    /// How it grows with the roll length.
    pub shape: ReliefShape,
}

/// Tip relief: zero up to its start, its amount at the tip circle.
pub type TipRelief = ProfileRelief;

/// Root relief: zero down to its start, its amount at the form circle, where the involute ends, and below it.
pub type RootRelief = ProfileRelief;
