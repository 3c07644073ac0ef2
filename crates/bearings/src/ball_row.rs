//! A row of balls between two grooves, and what is wrong with it.

use crate::error::BearingError;
use crate::faults::missing_element::missing;
use crate::faults::row_faults::SpalledBall;
use crate::faults::{Fault, RowFaults, Side};
use crate::operation::Operation;

pub use crate::groove::Groove;

/// A row of balls.
#[derive(Debug, Clone, PartialEq)]
pub struct BallRow {
    /// Number of balls.
    pub balls: usize,
    /// D \[m\].
    pub ball_diameter_m: f64,
    /// d_m/2 \[m\].
    pub pitch_radius_m: f64,
    /// Mass of a ball \[kg\].
    pub ball_mass_kg: f64,
    /// Plane of the balls' centres without load \[m\].
    pub middle_z_m: f64,
    /// Groove of the inner ring, in its frame.
    pub inner: Groove,
    /// Groove of the outer ring.
    pub outer: Groove,
    /// Contact angle without load, with the sign of the axial force that the inner ring can take \[rad\].
    pub free_angle_rad: f64,
    /// Angle of the first ball \[rad\].
    pub first_angle_rad: f64,
    /// What is wrong with it; none for a sound row.
    pub faults: Option<Box<RowFaults>>,
}

impl BallRow {
    /// Angle of a ball \[rad\].
    #[must_use]
    pub fn angle_rad(&self, ball: usize, operation: &Operation) -> f64 {
        operation.element_angle_rad(self.first_angle_rad, ball, self.balls)
    }

    /// The groove of a ring.
    #[must_use]
    pub fn groove(&self, side: Side) -> &Groove {
        match side {
            Side::Inner => &self.inner,
            Side::Outer => &self.outer,
        }
    }

    /// Whether a ball is there.
    #[must_use]
    pub fn has(&self, ball: usize) -> bool {
        !(self.faults.as_ref()).is_some_and(|faults| faults.is_missing(ball))
    }

    /// Diameter \[m\] and mass \[kg\] of a ball, which may be of another size than the others.
    #[must_use]
    pub fn ball_size(&self, ball: usize) -> (f64, f64) {
        let (diameter_m, mass_kg) = (self.ball_diameter_m, self.ball_mass_kg);
        match self.faults.as_ref().and_then(|faults| faults.size(ball)) {
            None => (diameter_m, mass_kg),
            Some(size) => (
                diameter_m + size.oversize_m,
                mass_kg * size.mass_ratio(diameter_m),
            ),
        }
    }
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
                    let angle_and_pitch = (row.free_angle_rad, row.pitch_radius_m);
                    let placed = spall.on(row.groove(side), row.ball_diameter_m, angle_and_pitch);
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
                            outer: spall.on(outer, row.ball_diameter_m),
                            inner: spall.on(inner, row.ball_diameter_m),
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
        Ok((!found.is_empty()).then(|| Box::new(found)))
    }
}
