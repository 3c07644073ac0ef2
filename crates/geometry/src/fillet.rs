//! The root fillet of a tooth, by what makes it: one file a curve.
//!
//! | made by | curve | file |
//! | --- | --- | --- |
//! | the rounded tip of a rack | trochoid | `fillet/rack.rs` |
//! | the rounded tip of a pinion cutter, inside a ring | trochoid | `fillet/pinion_cutter.rs` |
//! | a tool of the space's form with a full root radius | arc | `fillet/full_round.rs` |

pub mod full_round;
pub mod pinion_cutter;
pub mod rack;

use crate::bisection::halved;
use full_round::FullRound;
use pinion_cutter::CutterTrochoid;
use rack::Trochoid;

/// The root fillet of the right flank of the tooth centred on +x. Its parameter is zero on the root circle; where the
/// involute begins it is `fillet_end` of the tooth, in metres for a rack and in radians for the others.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Fillet {
    /// Cut by a rack.
    Rack(Trochoid),
    /// Cut by a pinion cutter.
    Cutter(CutterTrochoid),
    /// An arc over the whole space.
    FullRound(FullRound),
}

impl Fillet {
    /// Point \[x, y\] \[m\].
    pub fn point_m(&self, parameter: f64) -> [f64; 2] {
        match self {
            Self::Rack(curve) => curve.point_m(parameter),
            Self::Cutter(curve) => curve.point_m(parameter),
            Self::FullRound(curve) => curve.point_m(parameter),
        }
    }

    /// Angle τ \[rad\] between the tangent (towards the tip) and the tooth's centre line (from root to tip): about π/2
    /// at the root circle, falling to about the pressure angle at the involute.
    pub fn tangent_angle_rad(&self, parameter: f64) -> f64 {
        match self {
            Self::Rack(curve) => curve.tangent_angle_rad(parameter),
            Self::Cutter(curve) => curve.tangent_angle_rad(parameter),
            Self::FullRound(curve) => curve.tangent_angle_rad(parameter),
        }
    }

    /// Parameter between 0 and `end` at which the tangent angle equals `tangent_rad`, if it is reached.
    pub fn parameter_at_tangent(&self, tangent_rad: f64, end: f64) -> Option<f64> {
        let (low, high) = (0.0, end);
        if self.tangent_angle_rad(low) < tangent_rad || self.tangent_angle_rad(high) > tangent_rad {
            return None;
        }
        let is_steeper = |at: f64| self.tangent_angle_rad(at) > tangent_rad;
        let [low, high] = halved([low, high], 100, is_steeper);
        Some(0.5 * (low + high))
    }

    /// Angle between the middle of the tooth space and the place where the fillet leaves the root circle \[rad\]: half
    /// of the arc of the root circle; zero where there is none.
    pub fn root_arc_rad(&self) -> f64 {
        match self {
            Self::Rack(curve) => curve.centre_offset_m / curve.reference_radius_m,
            Self::Cutter(curve) => curve.root_arc_rad(),
            Self::FullRound(_) => 0.0,
        }
    }
}
