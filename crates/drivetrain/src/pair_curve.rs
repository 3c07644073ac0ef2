//! A pair's own static curve at one torque, as the simple mesh models take it.
//!
//! Transmission error and mesh stiffness of the pair at rest, position by position over whole pitches at the force F₀ =
//! T₂/r_b2 along the transverse line of action, become mean and harmonics over the roll angle ξ on gear 1. What pitches
//! differ in is averaged out.
//!
//! ```text
//! iso6336   F = F₀ + k(ξ) (δ − δ₀(ξ)),    k: tangent stiffness,  δ₀ = −TE
//! impact    F = K δ^e a pair of teeth,    e = mean of tangent over secant stiffness,  K (mean δ/s)^e = F₀,  s = mean of n(ξ)^(−1/e)
//! ```
//!
//! The first is the pair's tangent at that torque: it has the pair's transmission error there, and vibrations that are
//! small against the deflection see its stiffness. δ is the approach of ideal flanks, so that what microgeometry takes
//! away is in δ₀. The second has the pair's mean deflection since first touch and its mean tangent; n: pairs of teeth
//! on the path of contact, over the width.

use gearmesh_contact::mesh_stiffness::mesh_harmonics;
use gearmesh_geometry::GearPair;

use crate::error::{DrivetrainError, positive};
use crate::roll_harmonics::RollHarmonics;

/// Positions of the pair at rest, at equal steps over whole pitches, the end not repeated.
#[derive(Debug, Clone, Copy)]
pub struct PairSamples<'a> {
    /// Roll angle on gear 1 of the pair that touches at the pitch point at driver angle zero, at the first position
    /// \[rad\].
    pub start_roll_rad: f64,
    /// Pitches that the positions run through.
    pub pitches: usize,
    /// Teeth of gear 1.
    pub teeth_1: usize,
    /// F₀ = T₂/r_b2 \[N\].
    pub force_n: f64,
    /// Transmission error under load \[m\].
    pub te_m: &'a [f64],
    /// Transmission error at first touch \[m\].
    pub unloaded_m: &'a [f64],
    /// Tangent mesh stiffness \[N/m\].
    pub tangent_n_per_m: &'a [f64],
}

/// The static curve of a pair at one torque, in the transverse plane.
#[derive(Debug, Clone, PartialEq)]
pub struct PairCurve {
    force_n: f64,
    tangent: RollHarmonics,
    deflection: RollHarmonics,
    mean_deflection_m: f64,
    tangent_over_secant: f64,
    remainder_m: f64,
}

impl PairCurve {
    /// Takes mean and the first `harmonics` harmonics of the positions, at most as many as they resolve.
    ///
    /// # Errors
    /// [`DrivetrainError::Value`] for a force, deflection or stiffness that is not positive, and if so few harmonics
    /// make the stiffness fall to zero; [`DrivetrainError::Length`].
    pub fn new(samples: PairSamples<'_>, harmonics: usize) -> Result<Self, DrivetrainError> {
        let owner = "static curve of the pair";
        let count = samples.te_m.len();
        for (what, values) in [
            ("the transmission error at first touch", samples.unloaded_m),
            ("the tangent stiffness", samples.tangent_n_per_m),
        ] {
            DrivetrainError::check_length(owner, what, values.len(), count)?;
        }
        let force_n = positive(owner, "the force of its torque in N", samples.force_n)?;
        let curve = |values: &[f64]| {
            let (mean, found) = mesh_harmonics(values, samples.pitches, harmonics);
            RollHarmonics::new(mean, &found, samples.teeth_1, samples.start_roll_rad)
        };
        let deflection: Vec<f64> = samples.te_m.iter().map(|te| -te).collect();
        let (tangent, deflection) = (curve(samples.tangent_n_per_m), curve(&deflection));
        let pitch = std::f64::consts::TAU / samples.teeth_1 as f64;
        let step = pitch * samples.pitches as f64 / count as f64;
        let (mut given_way, mut ratio, mut remainder_m) = (0.0, 0.0, 0.0_f64);
        for (i, te) in samples.te_m.iter().enumerate() {
            let since_touch = samples.unloaded_m[i] - te;
            given_way += since_touch / count as f64;
            ratio += samples.tangent_n_per_m[i] * since_touch / force_n / count as f64;
            let roll = samples.start_roll_rad + i as f64 * step;
            remainder_m = remainder_m.max((deflection.at(roll).0 + te).abs());
            let what = "the least tangent stiffness of its harmonics in N/m";
            positive(owner, what, tangent.at(roll).0)?;
        }
        Ok(Self {
            force_n,
            tangent,
            deflection,
            mean_deflection_m: positive(owner, "its mean deflection in m", given_way)?,
            tangent_over_secant: positive(owner, "tangent over secant stiffness", ratio)?,
            remainder_m,
        })
    }

    /// F₀ \[N\].
    #[must_use]
    pub fn force_n(&self) -> f64 {
        self.force_n
    }

    /// Tangent stiffness \[N/m\]: a force over an arc of the base circle.
    #[must_use]
    pub fn tangent_n_per_m(&self) -> &RollHarmonics {
        &self.tangent
    }

    /// δ₀ = −TE \[m\].
    #[must_use]
    pub fn deflection_m(&self) -> &RollHarmonics {
        &self.deflection
    }

    /// F₀ over the mean deflection since first touch \[N/m\].
    #[must_use]
    pub fn mean_secant_n_per_m(&self) -> f64 {
        self.force_n / self.mean_deflection_m
    }

    /// Largest distance of the positions' transmission error from its mean and harmonics \[m\].
    #[must_use]
    pub fn remainder_m(&self) -> f64 {
        self.remainder_m
    }

    /// K \[N/mm^e\] and e of a pair of teeth along the normal, at least 1; e is that of the curve where none is given.
    #[must_use]
    pub fn pair_law(
        &self,
        pair: &GearPair,
        face_width_m: f64,
        exponent: Option<f64>,
    ) -> (f64, f64) {
        /// Places over the width and over the pitch at which pairs are counted.
        const PLACES: usize = 200;
        let e = exponent.unwrap_or(self.tangent_over_secant.max(1.0));
        let pitch = pair.pitch_1_rad();
        let turn = pair.roll_slope_1_rad_per_m() * face_width_m;
        let share = |k: usize| (k as f64 + 0.5) / PLACES as f64;
        let pairs_at = |roll: f64| {
            let place = |k: usize| roll + turn * share(k);
            let pairs = |roll: f64| {
                ((pair.roll_end_1_rad - roll) / pitch).floor()
                    - ((pair.roll_start_1_rad - roll) / pitch).ceil()
                    + 1.0
            };
            (0..PLACES).map(|k| pairs(place(k))).sum::<f64>() / PLACES as f64
        };
        let spread: f64 = (0..PLACES)
            .map(|k| pairs_at(pitch * share(k)).powf(-1.0 / e) / PLACES as f64)
            .sum();
        // Along the normal the force is larger by 1/cos β_b and the deflection smaller by cos β_b.
        let cos = pair.base_helix_angle_rad().cos();
        let depth_mm = 1e3 * self.mean_deflection_m * cos;
        (self.force_n / cos * (spread / depth_mm).powf(e), e)
    }
}
