//! What may be wrong with a bearing: damage of races and balls, waves, a ball of another size, one that is missing, a
//! ring that stands askew.
//!
//! | fault | type | file |
//! | --- | --- | --- |
//! | spall on a race | [`RaceSpall`] | `race_spall.rs` |
//! | spall on a ball | [`BallSpall`] | `ball_spall.rs` |
//! | waves of a race, across and along the axis | [`Waviness`] | `waviness.rs` |
//! | ball of another size | [`OffSizeBall`] | `off_size_ball.rs` |
//! | ball or roller that is missing | | [`missing_element`] |
//! | ring that stands askew or aside | [`MisalignedRing`] | `misaligned_ring.rs` |
//! | all those of one row, and what they do to a groove | [`RowFaults`] | `row_faults.rs` |
//!
//! A fault without depth is none: it is dropped when the bearing is built, so that the bearing is the sound one to the
//! last bit. Unbalance belongs to the body that carries the ring: give the shaft's body a centre of mass beside the
//! axis. Formulas (17) to (20) of docs/theory/rolling_bearings.md.

pub mod ball_spall;
pub mod misaligned_ring;
pub mod missing_element;
pub mod off_size_ball;
pub mod race_spall;
pub mod row_faults;
mod smooth_edge;
pub mod waviness;

pub use ball_spall::BallSpall;
pub use misaligned_ring::MisalignedRing;
pub use off_size_ball::OffSizeBall;
pub use race_spall::RaceSpall;
pub use row_faults::{RaceFaults, RowFaults};
pub use waviness::Waviness;

/// One of the two rings.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// The inner ring.
    Inner,
    /// The outer ring.
    Outer,
}

/// A fault of a bearing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Fault {
    /// Material lost from a race of a row.
    RaceSpall {
        /// The race.
        side: Side,
        /// The row, from 0.
        row: usize,
        /// What is lost.
        spall: RaceSpall,
    },
    /// Material lost from a ball of a row; both counted from 0.
    BallSpall {
        /// The row.
        row: usize,
        /// The ball.
        ball: usize,
        /// What is lost.
        spall: BallSpall,
    },
    /// A race that is not round.
    Waviness {
        /// The race.
        side: Side,
        /// The row, from 0.
        row: usize,
        /// Its waves.
        waves: Waviness,
    },
    /// A ball of another size; row and ball from 0.
    OffSizeBall {
        /// The row.
        row: usize,
        /// The ball.
        ball: usize,
        /// By how much.
        size: OffSizeBall,
    },
    /// A ball or roller that is not there; row and element from 0.
    Missing {
        /// The row.
        row: usize,
        /// The ball or roller.
        element: usize,
    },
    /// A ring that stands askew or aside.
    MisalignedRing {
        /// The ring.
        side: Side,
        /// How.
        place: MisalignedRing,
    },
}
