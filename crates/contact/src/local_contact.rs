//! The local contact compliance that completes a model's: which part of the model goes with it, and the depth that its
//! logarithm reaches.
//!
//! Both completions have one form per slice and body, q the line load and a its half width:
//!
//! ```text
//! δ = k q [ ln(2h/a) − ν/(2(1 − ν)) ],     k = 2(1 − ν²)/(πE)
//! ```
//!
//! Weber and Banaschek: h is the distance to the opposite side of the tooth. Calibrated: δ = q [c₀ − w_h − k ln(a/a₀)],
//! so that h is the effective depth
//!
//! ```text
//! h = (a₀/2) exp[ (c₀ − w_h)/k + ν/(2(1 − ν)) ]
//! ```
//!
//! It is about half the width of the hats, because below that the model's own near field takes over.

use crate::nlcp::{LineContact, LocalLaw, LocalLawError};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// Local contact compliance added to the model's; its words in files and on the command line are those of
/// [`LocalContact::name`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum LocalContact {
    /// None: C_hub as the mesh gives it, near field of the hats included. Cheapest, and mesh dependent.
    None,
    /// C_g and the Weber-Banaschek term, as in seed 004.
    WeberBanaschek,
    /// C_hub, each slice's own term corrected by the model's plane-strain calibration. The default.
    #[default]
    Calibrated,
}

/// Which part of the compliance is taken from the model.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CompliancePart {
    /// C_g = C_hub − C_tooth: free of the mesh's near field, to be completed by a local term.
    Patterns,
    /// C_hub with the near field of the hats.
    Hub,
}

impl LocalContact {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::None, Self::WeberBanaschek, Self::Calibrated];

    /// The word for it in scene files and on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::WeberBanaschek => "weber-banaschek",
            Self::Calibrated => "calibrated",
        }
    }

    /// The part of the model's compliance that it completes.
    pub fn part(self) -> CompliancePart {
        match self {
            Self::WeberBanaschek => CompliancePart::Patterns,
            Self::None | Self::Calibrated => CompliancePart::Hub,
        }
    }

    /// The law of one slice on a contact line.
    ///
    /// # Errors
    /// [`LocalLawError`] for a length that is not positive or a floor above the cap.
    pub fn law(self, contact: &LineContact, floor_force_n: f64) -> Result<LocalLaw, LocalLawError> {
        match self {
            Self::None => Ok(LocalLaw::none()),
            Self::WeberBanaschek => LocalLaw::weber_banaschek(contact, floor_force_n),
            Self::Calibrated => LocalLaw::calibrated(contact, floor_force_n),
        }
    }
}

/// How the law of a slice changes as its contact walks, per radian of roll, or as its width grows, per unit of the
/// share of the slice.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct LawRate {
    /// α′ \[m/(N·rad)\].
    pub alpha: f64,
    /// β′ \[m/(N·rad)\]: only a changing width or length changes β.
    pub beta: f64,
    /// Derivative of the cap \[N/rad\].
    pub cap: f64,
}

impl LawRate {
    /// This and so many times another.
    #[must_use]
    pub fn plus(self, times: f64, other: Self) -> Self {
        Self {
            alpha: self.alpha + times * other.alpha,
            beta: self.beta + times * other.beta,
            cap: self.cap + times * other.cap,
        }
    }
}

impl LocalContact {
    /// Change of a law where the depth in one body grows by the share `depth_growth` and the relative radius by
    /// `radius_growth`, per radian.
    pub fn law_rate(
        self,
        (contact, law): (&LineContact, &LocalLaw),
        body: usize,
        [depth_growth, radius_growth]: [f64; 2],
    ) -> LawRate {
        let alpha = contact.alpha_rate(body, depth_growth, radius_growth);
        match self {
            Self::None => LawRate::default(),
            // The cap is (½ h/c)² with the smaller h, c² in proportion to the relative radius.
            Self::WeberBanaschek => {
                let [own, other] = [body, 1 - body].map(|i| contact.bodies[i].depth_m);
                let depth = if own <= other { depth_growth } else { 0.0 };
                let cap = law.cap_n() * (2.0 * depth - radius_growth);
                LawRate {
                    alpha,
                    beta: 0.0,
                    cap,
                }
            }
            // Where the slope has fallen to a share of β: ln F_c = α/β − …
            Self::Calibrated => LawRate {
                alpha,
                beta: 0.0,
                cap: law.cap_n() * alpha / law.beta(),
            },
        }
    }

    /// Change of a law with the share s of the slice's width that touches, where the depths grow by these shares of
    /// themselves: α s and β s are those of a line load, α s with the logarithm of the load's own width.
    pub fn law_rate_by_share(
        self,
        (contact, law): (&LineContact, &LocalLaw),
        depth_growths: [f64; 2],
        share: f64,
    ) -> LawRate {
        let (alpha, beta) = (law.alpha(), law.beta());
        let deeper: f64 = (0..2)
            .map(|body| contact.alpha_rate(body, depth_growths[body], 0.0))
            .sum();
        let rate = LawRate {
            alpha: (beta - alpha) / share + deeper,
            beta: -beta / share,
            cap: 0.0,
        };
        let cap = match self {
            Self::None => return LawRate::default(),
            // (½ h/c)² with the smaller h, 1/c² in proportion to the width.
            Self::WeberBanaschek => {
                let [own, other] = [0, 1].map(|i: usize| contact.bodies[i].depth_m);
                let depth = depth_growths[usize::from(own > other)];
                law.cap_n() * (1.0 / share + 2.0 * depth)
            }
            Self::Calibrated => {
                law.cap_n() * (rate.alpha * beta - alpha * rate.beta) / (beta * beta)
            }
        };
        LawRate { cap, ..rate }
    }
}

/// Effective depth h \[m\] of the calibrated term, from c₀ − w_h \[m²/N\] at a₀ \[m\] and the material.
pub fn effective_depth_m(
    missing_m2_per_n: f64,
    half_width_m: f64,
    (young_pa, poisson): (f64, f64),
) -> f64 {
    let k = 2.0 * (1.0 - poisson * poisson) / (PI * young_pa);
    0.5 * half_width_m * (missing_m2_per_n / k + poisson / (2.0 * (1.0 - poisson))).exp()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::nlcp::ContactBody;

    /// The logarithm with the effective depth is the calibrated correction, word for word.
    #[test]
    fn the_effective_depth_says_the_same_as_the_correction() {
        let (young, nu, a0) = (206e9, 0.3, 9e-5);
        let k = 2.0 * (1.0 - nu * nu) / (PI * young);
        for missing in [-1e-12, 2e-12, 9e-12] {
            let body = ContactBody {
                youngs_modulus_pa: young,
                poisson_ratio: nu,
                depth_m: effective_depth_m(missing, a0, (young, nu)),
            };
            for a in [3e-5, 9e-5, 2e-4] {
                let expected = 1e5 * (missing - k * f64::ln(a / a0));
                let found = body.weber_banaschek_m(1e5, a);
                assert!(
                    (found - expected).abs() < 1e-12 * 1e5 * k,
                    "{found} {expected}"
                );
            }
        }
    }
}
