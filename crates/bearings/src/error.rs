//! What can go wrong.

/// A bearing without an answer.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum BearingError {
    /// A ball finds no equilibrium.
    #[error(
        "ball {ball} at {angle_deg:.1} deg finds no equilibrium ({unbalanced_n:.3e} N unbalanced): the inner ring is displaced too far, \
         or the speed is beyond what the bearing can do"
    )]
    NoBallEquilibrium {
        /// Number of the ball, from one.
        ball: usize,
        /// Its place.
        angle_deg: f64,
        /// What remains.
        unbalanced_n: f64,
    },
    /// A roller finds no equilibrium.
    #[error(
        "roller {roller} at {angle_deg:.1} deg finds no equilibrium ({unbalanced_n:.3e} N unbalanced): the inner ring is displaced too far"
    )]
    NoRollerEquilibrium {
        /// Number of the roller, from one.
        roller: usize,
        /// Its place.
        angle_deg: f64,
        /// What remains.
        unbalanced_n: f64,
    },
    /// The ring finds no equilibrium.
    #[error(
        "the bearing finds no equilibrium under this load: {unbalanced_n:.3e} N remain after {iterations} steps. {hint}"
    )]
    NoEquilibrium {
        /// What remains.
        unbalanced_n: f64,
        /// Steps taken.
        iterations: usize,
        /// What to do.
        hint: &'static str,
    },
    /// A tilted ring finds no equilibrium.
    #[error(
        "the bearing finds no equilibrium under this load with its inner ring held at {asked_mrad:.3} mrad; one was found up to {found_mrad:.3} mrad: hold it straighter, or give another load"
    )]
    NoEquilibriumAtTilt {
        /// The tilt that is held.
        asked_mrad: f64,
        /// The largest one with an equilibrium.
        found_mrad: f64,
    },
    /// A tilted ring presses balls of an angular-contact bearing against the side that has no shoulder.
    #[error(
        "an inner ring held at {asked_mrad:.3} mrad presses balls against the side of the groove where an angular-contact bearing has no shoulder: beyond \
         {found_mrad:.3} mrad one touches at more than {end_deg:.1} deg against the direction of its load: hold the ring straighter, or give more thrust"
    )]
    TiltedBeyondGroove {
        /// The tilt that is held.
        asked_mrad: f64,
        /// The largest one with an equilibrium.
        found_mrad: f64,
        /// Contact angle on the side without shoulder at which the groove ends.
        end_deg: f64,
    },
    /// Balls of an angular-contact bearing on the side where it has no groove.
    #[error(
        "the load pulls the rings of an angular-contact bearing apart: a single row carries axial loads along +z only; give it a preload, a second row, or turn the load round"
    )]
    PulledOut,
    /// A number that makes no sense.
    #[error("{what} is {found}: it must be {allowed}")]
    Parameter {
        /// Which number.
        what: &'static str,
        /// What was given.
        found: f64,
        /// What is allowed.
        allowed: &'static str,
    },
    /// A load that the bearing cannot carry by its kind.
    #[error("{0}")]
    NotCarried(&'static str),
}

impl BearingError {
    /// Refuses a number that is not as allowed.
    pub(crate) fn require(
        what: &'static str,
        found: f64,
        is_allowed: bool,
        allowed: &'static str,
    ) -> Result<(), Self> {
        if is_allowed {
            return Ok(());
        }
        Err(Self::Parameter {
            what,
            found,
            allowed,
        })
    }

    /// A number must be positive and finite.
    pub(crate) fn positive(what: &'static str, found: f64) -> Result<(), Self> {
        let is_allowed = found > 0.0 && found.is_finite();
        Self::require(what, found, is_allowed, "positive and finite")
    }

    /// A number must be zero or positive, and finite.
    pub(crate) fn not_negative(what: &'static str, found: f64) -> Result<(), Self> {
        let is_allowed = found >= 0.0 && found.is_finite();
        Self::require(what, found, is_allowed, "zero or positive, and finite")
    }
}
