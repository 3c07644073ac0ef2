//! Local (Hertzian) deflection of one slice: Weber-Banaschek's logarithm as two numbers.
//!
//! # Derivation
//! A line load `q = F/b_s` over the slice width `b_s` presses two cylinders of relative radius `ρ` together. The
//! Hertz half width and the deflection of each body between the contact centre and a point at depth `h_m` are
//!
//! ```text
//! a² = (4 q ρ/π) Σ_m (1 − ν_m²)/E_m
//! δ  = Σ_m k_m q [ ln(2 h_m/a) − ν_m/(2(1 − ν_m)) ],      k_m = 2(1 − ν_m²)/(π E_m)
//! ```
//!
//! With `a = c √F`, `c² = (4ρ/(π b_s)) Σ (1 − ν_m²)/E_m` and `ln(2h/a) = ln(2h/c) − ½ ln F` it collapses to
//!
//! ```text
//! δ(F) = F (α − β ln F),   β = Σ_m k_m/(2 b_s),   α = Σ_m (k_m/b_s) [ ln(2 h_m/c) − ν_m/(2(1 − ν_m)) ]
//! δ'(F) = α − β − β ln F                                                  (F in newton inside the logarithm)
//! ```
//!
//! # Ends of the logarithm
//! `δ' → ∞` for `F → 0`, and `δ' < 0` for loads whose half width nears the depth. Both ends are continued:
//!
//! - **floor**, `F < F_f`: the logarithm is replaced by its tangent at the floor,
//!   `ln F → ln F_f + (F − F_f)/F_f`. Then `δ(0) = 0` exactly (a linear continuation with the same slope would leave
//!   a finite gap at zero force), `δ` is continuous with its slope (a logarithm frozen at `F_f` gives a straight line
//!   but a step of `β` in the slope, hence in the tangent that an integrator sees), and it stays increasing and
//!   concave. The slope at zero is `α + β − β ln F_f`.
//! - **cap**, `F > F_c`: a straight line with the slope at the cap, continuous with its slope. The cap is the load at
//!   which the half width reaches [`HALF_WIDTH_LIMIT`] times the smaller depth; for a calibrated law, whose depth is
//!   not that of the body, the load at which the slope has all but fallen to zero.
//!
//! # Sources
//! C. Weber, K. Banaschek, Formänderung und Profilrücknahme bei gerad- und schrägverzahnten Rädern (1953); seed 004
//! eq. 12; K. L. Johnson, Contact Mechanics (1985), section 5.6 for the depth form.

use super::edge_contact::EdgeContact;
use super::line_contact::LineContact;
use super::local_law_error::{LocalLawError, require_positive};

/// Recommended floor of the logarithm as a fraction of the mean slice force of the nominal load.
///
/// No unit, sensible range 1e-9 to 1e-3. At 1e-6 the slices it touches carry a millionth of the mean force, so that the
/// load sharing is unaffected, while the slope at zero stays within a small factor of that at the mean load. Take
/// the *nominal* load, not the current one: a law that moves with the load stores no energy consistently.
pub const FLOOR_FRACTION: f64 = 1e-6;

/// Half width over depth, `a/h`, up to which the logarithm is used.
///
/// The law is right to `O((a/h)²)`, and `δ'` is proportional to `Σ k_m [ln(2h_m/a) − ν_m/(2(1−ν_m)) − ½]`. At
/// `a/h = 0.5` each bracket is at least `ln 4 − 1 = 0.386` for every Poisson ratio up to 0.5, so the slope is positive
/// at the cap and therefore everywhere.
pub const HALF_WIDTH_LIMIT: f64 = 0.5;

/// Slope at the cap of a calibrated law in units of `β`, the slope's fall per e-fold of the force: positive, and small
/// enough that the cap stays within 1 % of the force at which the slope would reach zero.
pub const LEAST_SLOPE: f64 = 0.01;

/// Local deflection of one slice, `δ(F) = F (α − β ln F)` with both ends continued (module documentation), and what an
/// edge adds to it ([`EdgeContact`]).
///
/// `δ` \[m\] closes the gap's way: positive under a positive force `F` \[N\], zero at zero.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LocalLaw {
    alpha: f64,
    beta: f64,
    floor_n: f64,
    cap_n: f64,
    /// `δ'(0)`.
    slope_at_zero: f64,
    /// `β/F_f`: half the drop of the slope per newton below the floor.
    floor_curvature: f64,
    slope_at_cap: f64,
    deflection_at_cap: f64,
    /// What a tilted edge adds.
    edge: Option<EdgeContact>,
}

impl LocalLaw {
    /// No local deflection, `δ = 0`.
    pub const fn none() -> Self {
        LocalLaw {
            alpha: 0.0,
            beta: 0.0,
            floor_n: 0.0,
            cap_n: f64::INFINITY,
            slope_at_zero: 0.0,
            floor_curvature: 0.0,
            slope_at_cap: 0.0,
            deflection_at_cap: 0.0,
            edge: None,
        }
    }

    /// The law of Weber and Banaschek for one slice; its slope is positive everywhere.
    ///
    /// `floor_force_n` \[N\]: [`FLOOR_FRACTION`] times the mean slice force of the nominal load.
    ///
    /// # Errors
    /// [`LocalLawError`] if a length, modulus or the floor is not positive and finite, a Poisson ratio lies outside
    /// 0..=0.5, or the floor is not below the cap.
    pub fn weber_banaschek(
        contact: &LineContact,
        floor_force_n: f64,
    ) -> Result<Self, LocalLawError> {
        let (alpha, beta) = contact.logarithm()?;
        let depth = contact.bodies[0].depth_m.min(contact.bodies[1].depth_m);
        let cap = (HALF_WIDTH_LIMIT * depth / contact.half_width_factor()).powi(2);
        Self::logarithmic(alpha, beta, floor_force_n, cap)
    }

    /// The same logarithm with the effective depths of a calibration, which make it a correction of the compliance
    /// matrix; capped where its own slope has fallen to [`LEAST_SLOPE`]` β`, so that it is positive everywhere.
    ///
    /// The correction could go on beyond that, because the matrix holds the near field that it takes away; but how much
    /// of it depends on the neighbouring slices, and a slope that is positive by itself keeps the problem convex.
    ///
    /// # Errors
    /// As [`LocalLaw::weber_banaschek`].
    pub fn calibrated(contact: &LineContact, floor_force_n: f64) -> Result<Self, LocalLawError> {
        let (alpha, beta) = contact.logarithm()?;
        let cap = (alpha / beta - 1.0 - LEAST_SLOPE).exp();
        Self::logarithmic(alpha, beta, floor_force_n, cap)
    }

    /// The general law `δ = F (α − β ln F)`, `alpha` and `beta` in m/N with F in newton, continued below
    /// `floor_force_n` and above `cap_force_n` \[N\] (may be infinite).
    ///
    /// For corrections of a discretised near field `alpha` may be negative, and the slope too where
    /// [`LocalLaw::is_monotone`] says so: the solver then needs `C + diag δ'` to be positive definite.
    ///
    /// # Errors
    /// [`LocalLawError`] if `alpha` is not finite, `beta` negative or not finite, the floor not positive, or the
    /// floor not below the cap.
    pub fn logarithmic(
        alpha: f64,
        beta: f64,
        floor_force_n: f64,
        cap_force_n: f64,
    ) -> Result<Self, LocalLawError> {
        if !alpha.is_finite() {
            return Err(LocalLawError::Coefficient {
                what: "alpha",
                found: alpha,
            });
        }
        if !(beta.is_finite() && beta >= 0.0) {
            return Err(LocalLawError::Coefficient {
                what: "beta",
                found: beta,
            });
        }
        require_positive("floor force [N]", floor_force_n)?;
        if cap_force_n.is_nan() || floor_force_n >= cap_force_n {
            return Err(LocalLawError::FloorAboveCap {
                floor_n: floor_force_n,
                cap_n: cap_force_n,
            });
        }
        Ok(Self::continued(alpha, beta, floor_force_n, cap_force_n))
    }

    /// The logarithm with its ends continued.
    fn continued(alpha: f64, beta: f64, floor_n: f64, cap_n: f64) -> Self {
        let (deflection_at_cap, slope_at_cap) = if cap_n.is_finite() {
            let logarithm = cap_n.ln();
            (
                cap_n * (alpha - beta * logarithm),
                alpha - beta - beta * logarithm,
            )
        } else {
            (0.0, 0.0)
        };
        LocalLaw {
            alpha,
            beta,
            floor_n,
            cap_n,
            slope_at_zero: alpha + beta - beta * floor_n.ln(),
            floor_curvature: beta / floor_n,
            slope_at_cap,
            deflection_at_cap,
            edge: None,
        }
    }

    /// The same law where an edge of one body presses on the other: `β F ln[(1 + u)/(e + u)]` is added, see
    /// [`EdgeContact`]. The law without logarithm stays as it is.
    pub fn with_edge(self, edge: Option<EdgeContact>) -> Self {
        Self { edge, ..self }
    }

    /// Deflection `δ` \[m\] and slope `δ'` \[m/N\] at the force `force_n` ≥ 0 \[N\].
    #[inline]
    pub fn evaluate(&self, force_n: f64) -> (f64, f64) {
        let (deflection, slope) = self.evaluate_smooth(force_n);
        match &self.edge {
            None => (deflection, slope),
            Some(edge) => {
                let (more, steeper) = edge.evaluate(force_n);
                (deflection + self.beta * more, slope + self.beta * steeper)
            }
        }
    }

    /// Without the edge.
    #[inline]
    fn evaluate_smooth(&self, force_n: f64) -> (f64, f64) {
        if self.beta == 0.0 {
            (self.alpha * force_n, self.alpha)
        } else if force_n < self.floor_n {
            let bend = self.floor_curvature * force_n;
            (
                force_n * (self.slope_at_zero - bend),
                self.slope_at_zero - 2.0 * bend,
            )
        } else if force_n <= self.cap_n {
            let secant = self.alpha - self.beta * force_n.ln();
            (force_n * secant, secant - self.beta)
        } else {
            let beyond = force_n - self.cap_n;
            (
                self.deflection_at_cap + self.slope_at_cap * beyond,
                self.slope_at_cap,
            )
        }
    }

    /// Deflection `δ` \[m\] at the force `force_n` ≥ 0 \[N\].
    pub fn deflection(&self, force_n: f64) -> f64 {
        self.evaluate(force_n).0
    }

    /// Slope `δ'` \[m/N\] at the force `force_n` ≥ 0 \[N\].
    pub fn slope(&self, force_n: f64) -> f64 {
        self.evaluate(force_n).1
    }

    /// Energy \[J\] stored in the local deflection, `∫ F dδ = F δ(F) − ∫₀^F δ dF`.
    pub fn stored_energy(&self, force_n: f64) -> f64 {
        force_n * self.deflection(force_n) - self.complementary_energy(force_n)
    }

    /// Complementary energy `∫₀^F δ dF` \[J\].
    pub fn complementary_energy(&self, force_n: f64) -> f64 {
        if self.beta == 0.0 {
            return 0.5 * self.alpha * force_n * force_n;
        }
        let low = force_n.min(self.floor_n);
        let mut energy = low * low * (0.5 * self.slope_at_zero - self.floor_curvature * low / 3.0);
        if force_n > self.floor_n {
            // The antiderivative of F (α − β ln F) is F² (α/2 + β/4 − β/2 ln F).
            let primitive =
                |f: f64| f * f * (0.5 * self.alpha + 0.25 * self.beta - 0.5 * self.beta * f.ln());
            energy += primitive(force_n.min(self.cap_n)) - primitive(self.floor_n);
        }
        if force_n > self.cap_n {
            let beyond = force_n - self.cap_n;
            energy += beyond * (self.deflection_at_cap + 0.5 * self.slope_at_cap * beyond);
        }
        if let Some(edge) = &self.edge {
            energy += self.beta * edge.complementary_energy(force_n);
        }
        energy
    }

    /// Derivative of the complementary energy at constant force where α changes by `alpha_rate` and the cap by
    /// `cap_rate`: ½ F² α′ − ½ (β/F_c) (F − F_c)² F_c′ beyond the cap. Exact below the floor as well; an edge is left
    /// out.
    pub fn complementary_energy_rate(&self, force_n: f64, alpha_rate: f64, cap_rate: f64) -> f64 {
        let below = 0.5 * force_n * force_n * alpha_rate;
        if !self.is_above_cap(force_n) {
            return below;
        }
        let beyond = force_n - self.cap_n;
        below - 0.5 * self.beta / self.cap_n * beyond * beyond * cap_rate
    }

    /// Derivative of the complementary energy by `β` at constant force, α and cap: the energy of the law with α = 0 and
    /// β = 1, because it is linear in both. An edge is left out.
    pub fn complementary_energy_by_beta(&self, force_n: f64) -> f64 {
        Self::continued(0.0, 1.0, self.floor_n, self.cap_n).complementary_energy(force_n)
    }

    /// `α` \[m/N\].
    pub fn alpha(&self) -> f64 {
        self.alpha
    }

    /// `β` \[m/N\].
    pub fn beta(&self) -> f64 {
        self.beta
    }

    /// Force \[N\] below which the logarithm is continued by its tangent.
    pub fn floor_n(&self) -> f64 {
        self.floor_n
    }

    /// Force \[N\] above which the slope is frozen.
    pub fn cap_n(&self) -> f64 {
        self.cap_n
    }

    /// Whether `force_n` \[N\] is positive and lies below the floor.
    pub fn is_below_floor(&self, force_n: f64) -> bool {
        self.beta > 0.0 && force_n > 0.0 && force_n < self.floor_n
    }

    /// Whether `force_n` \[N\] lies above the cap.
    pub fn is_above_cap(&self, force_n: f64) -> bool {
        self.beta > 0.0 && force_n > self.cap_n
    }

    /// Whether the deflection never falls with the force: the slope, which falls with it, is not negative at the cap.
    pub fn is_monotone(&self) -> bool {
        if self.beta == 0.0 {
            self.alpha >= 0.0
        } else {
            self.cap_n.is_finite() && self.slope_at_cap >= 0.0
        }
    }
}

impl Default for LocalLaw {
    fn default() -> Self {
        Self::none()
    }
}
