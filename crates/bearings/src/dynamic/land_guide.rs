//! The land of a ring that guides a cage: a short bearing with a film, and solid contact where the film is gone.
//!
//! Seen from the land, with the cage's displacement e across the axis, C the radial clearance, ε = e/C, R the land's
//! radius, L its width, ω the cage's speed and ϕ̇ the speed of e's direction, all against the land, the film of the π
//! type has (F. W. Ocvirk, NACA TN 2808, 1952; with squeeze: D. Childs, *Turbomachinery Rotordynamics*, Wiley 1993)
//!
//! ```text
//! against e:   (ηRL³/2C²) [2ε²|ω − 2ϕ̇|/(1 − ε²)² + π(1 + 2ε²) ε̇/(1 − ε²)^2.5]
//! across it:   (ηRL³/2C²) [πε(ω − 2ϕ̇)/(2(1 − ε²)^1.5) + 4εε̇/(1 − ε²)²]
//! moment on the cage:   −2πηωR³L/(C√(1 − ε²)) − ½ e × F
//! ```
//!
//! Without whirl and squeeze these are η U L³ ε²/(C²(1 − ε²)²), πηUL³ε/(4C²(1 − ε²)^1.5) and 2πηUR²L/(C√(1 − ε²)) with
//! U = Rω. Where less than the roughness h₀ is left of the gap, the solids carry K (e − C + h₀)^1.5, and the film stays
//! as it is there. ω − 2ϕ̇ is the same in every frame, so that land and cage may both turn. A tilt of the cage is not
//! seen: two lands side by side resist it.

use std::f64::consts::PI;

use gearmesh_dynamics::elements::{Law, LawTangent, MarkerElement, PairLoad};
use gearmesh_dynamics::{MarkerPair, Power, RelativeMotion};
use nalgebra::{SMatrix, Vector3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::rebound::Rebound;
use crate::dual::Dual;
use crate::error::BearingError;

/// Which ring has the land.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum LandSide {
    /// The outer ring, round the cage.
    Outer,
    /// The inner ring, inside the cage.
    Inner,
}

/// The film.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LandFilm {
    /// η \[Pa·s\].
    pub viscosity_pa_s: f64,
    /// L \[m\].
    pub width_m: f64,
}

/// Solid contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LandContact {
    /// K \[N/m^1.5\].
    pub stiffness_n_per_m15: f64,
    /// h₀ \[m\]: gap below which the solids touch.
    pub roughness_m: f64,
    /// Damping.
    pub rebound: Rebound,
    /// Coefficient of friction, and the slip at which it has come to 71 % \[m/s\].
    pub friction: Option<(f64, f64)>,
}

/// A land: marker A on its ring, marker B in the middle of the cage, z along the axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LandGuide {
    /// Which ring.
    pub side: LandSide,
    /// R \[m\].
    pub radius_m: f64,
    /// C \[m\].
    pub clearance_m: f64,
    /// Film; none: dry.
    pub film: Option<LandFilm>,
    /// Solid contact.
    pub contact: LandContact,
}

/// Displacement (2), velocity (2) and speed about the axis.
type Number = Dual<5>;
type Pair = [Number; 2];

fn dot(a: Pair, b: Pair) -> Number {
    a[0] * b[0] + a[1] * b[1]
}

fn scaled(a: Pair, s: Number) -> Pair {
    a.map(|x| x * s)
}

fn sum(a: Pair, b: Pair) -> Pair {
    [a[0] + b[0], a[1] + b[1]]
}

/// z × a.
fn turned(a: Pair) -> Pair {
    [-a[1], a[0]]
}

/// Where the cage stands and how it moves, as numbers with derivatives.
struct At {
    u: Pair,
    v: Pair,
    omega: Number,
    /// |u| and u/|u|, smooth in the middle.
    distance: Number,
    direction: Pair,
}

impl At {
    fn new(motion: &RelativeMotion, clearance_m: f64) -> Self {
        let [p, q] = [&motion.displacement_m, &motion.velocity_m_per_s];
        let u = [Number::variable(p.x, 0), Number::variable(p.y, 1)];
        let v = [Number::variable(q.x, 2), Number::variable(q.y, 3)];
        let omega = Number::variable(motion.angular_velocity_rad_per_s.z, 4);
        let least = Number::constant((1e-9 * clearance_m).powi(2));
        let distance = (dot(u, u) + least).sqrt();
        Self {
            u,
            v,
            omega,
            distance,
            direction: u.map(|x| x / distance),
        }
    }
}

impl LandGuide {
    /// The guide as a force element.
    ///
    /// # Errors
    /// [`BearingError::Parameter`] where a number makes no sense.
    pub fn between(
        self,
        name: &str,
        pair: MarkerPair,
    ) -> Result<MarkerElement<Self>, BearingError> {
        BearingError::positive("the land's radius in m", self.radius_m)?;
        BearingError::positive("the land's clearance in m", self.clearance_m)?;
        if let Some(film) = self.film {
            BearingError::positive("the viscosity at the land in Pa s", film.viscosity_pa_s)?;
            BearingError::positive("the land's width in m", film.width_m)?;
        }
        let (stiffness, roughness) = (self.contact.stiffness_n_per_m15, self.contact.roughness_m);
        BearingError::positive("the land's stiffness in N/m^1.5", stiffness)?;
        BearingError::require(
            "the roughness at the land in m",
            roughness,
            (0.0..self.clearance_m).contains(&roughness)
                && !(self.film.is_some() && roughness == 0.0),
            "below the clearance, and above 0 with a film",
        )?;
        if let Some((coefficient, speed)) = self.contact.friction {
            let is_allowed = coefficient >= 0.0 && coefficient.is_finite() && speed > 0.0;
            let allowed = "zero or positive, with a positive transition speed";
            let what = "the coefficient of friction at the land";
            BearingError::require(what, coefficient, is_allowed, allowed)?;
        }
        Ok(MarkerElement::new(name, pair, self))
    }

    /// Force across the axis and moment about it, on the cage; energy of the solid contact.
    fn forces(&self, motion: &RelativeMotion) -> (Pair, Number, f64) {
        let at = At::new(motion, self.clearance_m);
        let zero = Number::constant(0.0);
        let (mut force, mut moment, mut stored) = ([zero; 2], zero, 0.0);
        if let Some(film) = &self.film {
            let (f, m) = self.film_forces(film, &at);
            (force, moment) = (sum(force, f), moment + m);
        }
        let depth = at.distance + Number::constant(self.contact.roughness_m - self.clearance_m);
        if depth.value > 0.0 {
            let (f, m) = self.contact_forces(depth, &at);
            (force, moment) = (sum(force, f), moment + m);
            stored = 0.4 * self.contact.stiffness_n_per_m15 * depth.value.powf(2.5);
        }
        (force, moment, stored)
    }

    fn film_forces(&self, film: &LandFilm, at: &At) -> (Pair, Number) {
        let c = self.clearance_m;
        let number = Number::constant;
        let most = 1.0 - self.contact.roughness_m / c;
        // ε², held where the solids touch.
        let mut square = (at.distance * at.distance).scaled(1.0 / (c * c));
        if square.value > most * most {
            square = number(most * most);
        }
        let gap = number(1.0) - square;
        let size = 0.5 * film.viscosity_pa_s * self.radius_m * film.width_m.powi(3) / (c * c);
        // ε²ϕ̇ = (u × u̇)/C² and εε̇ = u·u̇/C².
        let whirl = dot(turned(at.u), at.v).scaled(1.0 / (c * c));
        let squeeze = dot(at.u, at.v).scaled(1.0 / (c * c));
        let radial = (at.omega * square - whirl.scaled(2.0)).abs() / (gap * gap);
        let root = gap.powf(1.5);
        let across = at.omega.scaled(0.5 * PI / c) / root;
        // π(1 + 2ε²)ε̇ along e and πεϕ̇ across it, put together so that nothing divides by e.
        let along_u = squeeze.scaled(3.0 * PI / c) / (gap * root);
        let along_v = number(PI / c) / root;
        let swirl = squeeze.scaled(4.0) / (gap * gap);
        let parts = [
            scaled(at.direction, -radial.scaled(2.0)),
            scaled(turned(at.u), across),
            scaled(at.u, -along_u),
            scaled(at.v, -along_v),
            scaled(turned(at.direction), swirl),
        ];
        let force = parts
            .into_iter()
            .fold([number(0.0); 2], sum)
            .map(|x| x.scaled(size));
        let drag = 2.0 * PI * film.viscosity_pa_s * self.radius_m.powi(3) * film.width_m / c;
        let shear = (at.omega / gap.sqrt()).scaled(-drag);
        let moment = shear - dot(turned(at.u), force).scaled(0.5);
        (force, moment)
    }

    fn contact_forces(&self, depth: Number, at: &At) -> (Pair, Number) {
        let number = Number::constant;
        let contact = &self.contact;
        let rate = dot(at.direction, at.v);
        let (factor, chi) = contact.rebound.factor(rate.value);
        let load = depth.powf(1.5).scaled(contact.stiffness_n_per_m15) * rate.map(factor, chi);
        let force = scaled(at.direction, -load);
        let Some((coefficient, transition)) = contact.friction else {
            return (force, number(0.0));
        };
        // The cage touches with its outside on the side of e, or with its bore on the other one.
        let lever = match self.side {
            LandSide::Outer => self.radius_m,
            LandSide::Inner => -self.radius_m,
        };
        let tangent = turned(at.direction);
        let slip = dot(tangent, at.v) + at.omega.scaled(lever);
        let speed = (slip * slip + number(transition * transition)).sqrt();
        let drag = -(load * slip / speed).scaled(coefficient);
        (sum(force, scaled(tangent, drag)), drag.scaled(lever))
    }
}

impl Law for LandGuide {
    fn load(&self, motion: &RelativeMotion) -> (PairLoad, Power) {
        let (force, moment, stored_j) = self.forces(motion);
        let (f, m) = (force.map(|x| x.value), moment.value);
        let mut load = PairLoad::zeros();
        load[0] = f[0];
        load[1] = f[1];
        load[5] = m;
        let v = &motion.velocity_m_per_s;
        let work = f[0] * v.x + f[1] * v.y + m * motion.angular_velocity_rad_per_s.z;
        // What the solid contact stores is given back.
        let depth = motion.displacement_m.xy().norm() + self.contact.roughness_m - self.clearance_m;
        let storing = if depth > 0.0 {
            let u: Vector3<f64> = motion.displacement_m;
            let rate = (u.x * v.x + u.y * v.y) / u.xy().norm();
            self.contact.stiffness_n_per_m15 * depth.powf(1.5) * rate
        } else {
            0.0
        };
        let power = Power {
            stored_j,
            dissipated_w: -work - storing,
            supplied_w: 0.0,
        };
        (load, power)
    }

    fn tangent(&self, motion: &RelativeMotion) -> LawTangent {
        let (force, moment, _) = self.forces(motion);
        let mut tangent = LawTangent {
            by_position: SMatrix::zeros(),
            by_velocity: SMatrix::zeros(),
        };
        for (row, number) in [(0, force[0]), (1, force[1]), (5, moment)] {
            for axis in 0..2 {
                tangent.by_position[(row, axis)] = number.by[axis];
                tangent.by_velocity[(row, axis)] = number.by[2 + axis];
            }
            tangent.by_velocity[(row, 5)] = number.by[4];
        }
        tangent
    }

    fn axes(&self) -> &'static str {
        "cage_"
    }
}
