//! All faults of a row of balls, and what they do to its grooves.

use super::ball_spall::PlacedPatch;
use super::missing_element::missing;
use super::race_spall::{Depth, PlacedSpall};
use super::waviness::Displaced;
use super::{BallSpall, Fault, OffSizeBall, Side, Waviness};
use crate::ball_row::{BallRow, Groove};
use crate::error::BearingError;

/// Faults of a race.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct RaceFaults {
    waves: Vec<Waviness>,
    spalls: Vec<PlacedSpall>,
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
    outer: PlacedPatch,
    inner: PlacedPatch,
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
    inner: RaceFaults,
    outer: RaceFaults,
    sizes: Vec<(usize, OffSizeBall)>,
    spalled: Vec<SpalledBall>,
    /// Balls that are not there, in rising order.
    missing: Vec<usize>,
}

impl RowFaults {
    /// Those of a row among the faults of a bearing; none where all of them are without depth.
    ///
    /// # Errors
    /// [`BearingError::Parameter`] for a ball that the row does not have, [`BearingError::NotCarried`] where too few
    /// are left.
    pub(crate) fn of(
        faults: &[Fault],
        number: usize,
        row: &BallRow,
    ) -> Result<Option<Box<Self>>, BearingError> {
        let mut found = Self {
            missing: missing(faults, number, row.balls)?,
            ..Self::default()
        };
        let exists = |ball: usize| {
            let what = "the number of a ball that has a fault, from 1,";
            let allowed = "at most the number of balls of the row";
            BearingError::require(what, (ball + 1) as f64, ball < row.balls, allowed)
        };
        for fault in faults {
            match *fault {
                Fault::RaceSpall {
                    side,
                    row: at,
                    spall,
                } if at == number => {
                    let placed = spall.on(row, row.groove(side));
                    if placed.reached_m > 0.0 {
                        found.race_mut(side).spalls.push(placed);
                    }
                }
                Fault::BallSpall {
                    row: at,
                    ball,
                    spall,
                } if at == number => {
                    exists(ball)?;
                    let [outer, inner] = [Side::Outer, Side::Inner].map(|s| row.groove(s));
                    if spall.depth_m > 0.0 {
                        found.spalled.push(SpalledBall {
                            ball,
                            spall,
                            outer: spall.on(row, outer),
                            inner: spall.on(row, inner),
                        });
                    }
                }
                Fault::Waviness {
                    side,
                    row: at,
                    waves,
                } if at == number && (waves.radial_m != 0.0 || waves.axial_m != 0.0) => {
                    found.race_mut(side).waves.push(waves);
                }
                Fault::OffSizeBall {
                    row: at,
                    ball,
                    size,
                } if at == number => {
                    exists(ball)?;
                    if size.oversize_m != 0.0 {
                        found.sizes.push((ball, size));
                    }
                }
                _ => {}
            }
        }
        let none = found.inner.is_empty()
            && found.outer.is_empty()
            && found.sizes.is_empty()
            && found.spalled.is_empty()
            && found.missing.is_empty();
        Ok((!none).then(|| Box::new(found)))
    }

    fn race_mut(&mut self, side: Side) -> &mut RaceFaults {
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

    /// The grooves under a ball that keeps to its axial plane, at its angles in the axes of the outer and of the inner ring.
    pub(crate) fn grooves_under(
        &self,
        row: &BallRow,
        ball: usize,
        (psi_outer, psi_inner): (f64, f64),
    ) -> [Groove; 2] {
        let mut grooves = [&row.outer, &row.inner].map(|groove| self.groove_for(ball, groove));
        self.outer.apply(psi_outer, &mut grooves[0]);
        self.inner.apply(psi_inner, &mut grooves[1]);
        grooves
    }
}
