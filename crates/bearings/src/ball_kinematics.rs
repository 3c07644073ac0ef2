//! How fast a ball orbits and spins, and what that does: centrifugal force and gyroscopic moment.
//!
//! The ball rolls without gross slip at the middle of both contacts. With γ' = D/d_m and the pitch angle β of its spin
//! axis,
//!
//! ```text
//! X_o = cos(α_o − β)/(1 + γ' cos α_o),  X_i = cos(α_i − β)/(1 − γ' cos α_i)
//! ω_R = (ω_i − ω_o)/(γ' (X_o + X_i)),   ω_m = ω_o + ω_R γ' X_o
//! outer race control: tan β = sin α_o/(cos α_o + γ')      inner: tan β = sin α_i/(cos α_i − γ')
//! F_c = ½ m d_m ω_m²,   M_g = J ω_m ω_R sin β
//! ```
//!
//! Source: A. B. Jones, *A general theory for elastically constrained ball and radial roller bearings under arbitrary
//! load and speed conditions*, J. Basic Eng. 82 (1960); derived anew in docs/theory/rolling_bearings.md.

use crate::dual::Dual;

/// A number with its derivatives by α_i and α_o.
type ByAngles = Dual<2>;

/// Race on which balls roll without spin.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RaceControl {
    /// No spin at the outer race, which carries the whole gyroscopic moment.
    Outer,
    /// No spin at the inner race, which carries the whole gyroscopic moment.
    Inner,
}

/// Sizes of a ball that its motion needs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct BallInMotion {
    /// γ' = D/d_m.
    pub diameter_ratio: f64,
    pub mass_kg: f64,
    pub pitch_radius_m: f64,
    pub ball_radius_m: f64,
}

/// What the motion of one ball does.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct BallMotion {
    pub orbit_rad_per_s: f64,
    pub spin_rad_per_s: f64,
    /// Rate of spin between ball and inner, outer race about the contacts' normals.
    pub contact_spin_rad_per_s: [f64; 2],
    pub centrifugal_n: ByAngles,
    /// 2 M_g/D, the friction that carries the gyroscopic moment at the controlling race.
    pub friction_n: ByAngles,
}

impl BallMotion {
    /// Where α_i is taken to be α_o: derivatives by α_i count as those by α_o.
    pub fn by_outer_alone(mut self) -> Self {
        for value in [&mut self.centrifugal_n, &mut self.friction_n] {
            value.by = [0.0, value.by[0] + value.by[1]];
        }
        self
    }
}

/// Cosine and sine of the contact angles at the inner and outer race.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct ContactAngles {
    pub inner: (f64, f64),
    pub outer: (f64, f64),
}

impl BallInMotion {
    /// At the speeds of the inner and outer ring \[rad/s\].
    pub fn at(
        &self,
        angles: &ContactAngles,
        (inner, outer): (f64, f64),
        control: RaceControl,
    ) -> BallMotion {
        let number = ByAngles::constant;
        let variable = |(c, s): (f64, f64), place: usize| {
            let mut cosine = number(c);
            let mut sine = number(s);
            cosine.by[place] = -s;
            sine.by[place] = c;
            (cosine, sine)
        };
        let (c_i, s_i) = variable(angles.inner, 0);
        let (c_o, s_o) = variable(angles.outer, 1);
        let ratio = number(self.diameter_ratio);
        let one = number(1.0);
        // Direction (sin β, cos β), not yet of unit length.
        let (across, along) = match control {
            RaceControl::Outer => (s_o, c_o + ratio),
            RaceControl::Inner => (s_i, c_i - ratio),
        };
        let length = (across * across + along * along).sqrt();
        let (sine, cosine) = (across / length, along / length);
        let x_o = (c_o * cosine + s_o * sine) / (one + ratio * c_o);
        let x_i = (c_i * cosine + s_i * sine) / (one - ratio * c_i);
        let spin = number(inner - outer) / (ratio * (x_o + x_i));
        let orbit = number(outer) + spin * ratio * x_o;
        let inertia = 0.4 * self.mass_kg * self.ball_radius_m.powi(2);
        let contact_spin = [
            spin.value * (sine.value * c_i.value - cosine.value * s_i.value)
                - (inner - orbit.value) * s_i.value,
            spin.value * (sine.value * c_o.value - cosine.value * s_o.value)
                + (orbit.value - outer) * s_o.value,
        ];
        BallMotion {
            orbit_rad_per_s: orbit.value,
            spin_rad_per_s: spin.value,
            contact_spin_rad_per_s: contact_spin,
            centrifugal_n: number(self.mass_kg * self.pitch_radius_m) * orbit * orbit,
            friction_n: number(inertia / self.ball_radius_m) * orbit * spin * sine,
        }
    }
}
