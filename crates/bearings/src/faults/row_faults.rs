//! All faults of a row of balls, and what they do to its grooves.

use super::ball_spall::PlacedPatch;
use super::race_spall::{Depth, PlacedSpall};
use super::waviness::Displaced;
use super::{BallSpall, OffSizeBall, Side, Waviness};
use crate::groove::Groove;

/// Faults of a race.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct RaceFaults {
    pub(crate) waves: Vec<Waviness>,
    pub(crate) spalls: Vec<PlacedSpall>,
}

impl RaceFaults {
    fn is_empty(&self) -> bool {
        self.waves.is_empty() && self.spalls.is_empty()
    }

    /// Where the groove's centre is displaced to at ψ.
    pub(crate) fn displaced(&self, psi: f64) -> Displaced {
        let mut found = Displaced::default();
        for waves in &self.waves {
            waves.add(psi, &mut found);
        }
        found
    }

    /// What is lost under a ball at ψ with the contact angle α.
    pub(crate) fn depth(&self, psi: f64, alpha: f64) -> Depth {
        let mut found = Depth::default();
        for depth in self.spalls.iter().filter_map(|s| s.depth(psi, alpha)) {
            found.add(&depth);
        }
        found
    }

    /// The groove under a ball at ψ that keeps to the middle of the spalls.
    fn apply(&self, psi: f64, groove: &mut Groove) {
        let displaced = self.displaced(psi);
        groove.centre_radius_m += displaced.radial[0];
        groove.centre_z_m += displaced.axial[0];
        let lost = self.spalls.iter().map(|spall| spall.middle_depth_m(psi));
        groove.arm_m += lost.sum::<f64>();
    }
}

/// A ball with a spall.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct SpalledBall {
    /// Number in its row, from 0.
    pub ball: usize,
    pub spall: BallSpall,
    pub outer: PlacedPatch,
    pub inner: PlacedPatch,
}

impl SpalledBall {
    /// The patch as it meets a race.
    pub fn against(&self, side: Side) -> &PlacedPatch {
        match side {
            Side::Inner => &self.inner,
            Side::Outer => &self.outer,
        }
    }
}

/// Faults of a row of balls.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct RowFaults {
    pub(crate) inner: RaceFaults,
    pub(crate) outer: RaceFaults,
    pub(crate) sizes: Vec<(usize, OffSizeBall)>,
    pub(crate) spalled: Vec<SpalledBall>,
    /// Balls that are not there, in rising order.
    pub(crate) missing: Vec<usize>,
}

impl RowFaults {
    pub(crate) fn is_empty(&self) -> bool {
        self.inner.is_empty()
            && self.outer.is_empty()
            && self.sizes.is_empty()
            && self.spalled.is_empty()
            && self.missing.is_empty()
    }

    pub(crate) fn race_mut(&mut self, side: Side) -> &mut RaceFaults {
        match side {
            Side::Inner => &mut self.inner,
            Side::Outer => &mut self.outer,
        }
    }

    /// Faults of a race; none where it is sound.
    pub(crate) fn race(&self, side: Side) -> Option<&RaceFaults> {
        let race = match side {
            Side::Inner => &self.inner,
            Side::Outer => &self.outer,
        };
        (!race.is_empty()).then_some(race)
    }

    /// How the size of a ball differs.
    pub(crate) fn size(&self, ball: usize) -> Option<OffSizeBall> {
        let mut sizes = self.sizes.iter().filter(|(at, _)| *at == ball);
        sizes.next().map(|(_, size)| *size)
    }

    /// Whether a ball is not there.
    pub(crate) fn is_missing(&self, ball: usize) -> bool {
        self.missing.contains(&ball)
    }

    /// Balls with spalls.
    pub(crate) fn spalled(&self) -> &[SpalledBall] {
        &self.spalled
    }

    /// The groove as it is for a ball of the row.
    pub(crate) fn groove_for(&self, ball: usize, groove: &Groove) -> Groove {
        let mut own = *groove;
        if let Some(size) = self.size(ball) {
            size.apply(&mut own);
        }
        own
    }

    /// The grooves, outer and inner, under a ball that keeps to its axial plane, at its angles in the axes of the outer
    /// and of the inner ring.
    pub(crate) fn grooves_under(
        &self,
        grooves: [&Groove; 2],
        ball: usize,
        (psi_outer, psi_inner): (f64, f64),
    ) -> [Groove; 2] {
        let mut grooves = grooves.map(|groove| self.groove_for(ball, groove));
        self.outer.apply(psi_outer, &mut grooves[0]);
        self.inner.apply(psi_inner, &mut grooves[1]);
        grooves
    }
}
