//! A coordinate that a force element owns.

/// Which equation a coordinate u has. Q is what the element writes in its place of the force.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum UnknownKind {
    /// m ü = Q: a mass inside the element, moving along u only. Q is a force in the unit that goes with u (N for m, N·m
    /// for rad); forces of inertia of a frame that moves are part of Q.
    Inertial {
        /// m, in kg for a u in metres, kg·m² for one in radians.
        mass: f64,
    },
    /// u̇ = Q: a film, wear, a spring in series with a damper.
    Rate,
    /// 0 = Q: an inner equilibrium without mass. Q must change with u. Its rate follows from the steps and is not
    /// exact.
    Equilibrium,
}

/// A coordinate that a force element owns, solved together with the motion of the bodies.
#[derive(Debug, Clone, PartialEq)]
pub struct Unknown {
    /// Name with unit, used in messages.
    pub name: String,
    /// Its equation.
    pub kind: UnknownKind,
    /// Change of it that matters about as much as a turn by one radian: tolerances of rotations hold for u over this
    /// scale. Positive.
    pub scale: f64,
}

impl Unknown {
    /// A mass, m ü = Q.
    #[must_use]
    pub fn inertial(name: &str, mass: f64, scale: f64) -> Self {
        Self::new(name, UnknownKind::Inertial { mass }, scale)
    }

    /// A coordinate with a given rate, u̇ = Q.
    #[must_use]
    pub fn rate(name: &str, scale: f64) -> Self {
        Self::new(name, UnknownKind::Rate, scale)
    }

    /// A coordinate in equilibrium, 0 = Q.
    #[must_use]
    pub fn equilibrium(name: &str, scale: f64) -> Self {
        Self::new(name, UnknownKind::Equilibrium, scale)
    }

    fn new(name: &str, kind: UnknownKind, scale: f64) -> Self {
        Self {
            name: name.to_owned(),
            kind,
            scale,
        }
    }

    /// m, zero where the equation has none.
    pub(crate) fn mass(&self) -> f64 {
        match self.kind {
            UnknownKind::Inertial { mass } => mass,
            UnknownKind::Rate | UnknownKind::Equilibrium => 0.0,
        }
    }
}
