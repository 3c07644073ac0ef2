//! A period as an exact fraction of a shaft's revolutions.

use std::f64::consts::TAU;

/// `turns`/`parts` revolutions of a shaft, in lowest terms: one pitch of 57 teeth is 1/57, one revolution of a wheel of
/// 47 teeth is 47/23 revolutions of the pinion of 23 that drives it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ShaftPeriod {
    turns: usize,
    parts: usize,
}

impl ShaftPeriod {
    /// One revolution.
    pub const REVOLUTION: Self = Self { turns: 1, parts: 1 };

    /// `turns`/`parts` revolutions; none where one of them is zero.
    pub fn new(turns: usize, parts: usize) -> Option<Self> {
        if turns == 0 || parts == 0 {
            return None;
        }
        let divisor = greatest_common_divisor(turns, parts);
        Some(Self {
            turns: turns / divisor,
            parts: parts / divisor,
        })
    }

    /// So many revolutions; one for zero.
    pub fn revolutions(turns: usize) -> Self {
        Self {
            turns: turns.max(1),
            parts: 1,
        }
    }

    /// The period as an angle \[rad\].
    pub fn rad(&self) -> f64 {
        TAU * self.turns as f64 / self.parts as f64
    }

    /// Revolutions after which both the shaft and what has this period are where they were: the fewest that hold whole
    /// periods.
    pub fn whole_revolutions(&self) -> usize {
        self.turns
    }

    /// Whether what has the period `other` has this one, too: whether this holds `other` a whole number of times.
    pub fn is_multiple_of(&self, other: &Self) -> bool {
        // (t/p) / (u/q) = t q / (p u)
        (self.turns * other.parts).is_multiple_of(self.parts * other.turns)
    }
}

/// Least common multiple of numbers above zero.
pub(crate) fn least_common_multiple(a: usize, b: usize) -> usize {
    a / greatest_common_divisor(a, b) * b
}

fn greatest_common_divisor(a: usize, b: usize) -> usize {
    if b == 0 {
        a
    } else {
        greatest_common_divisor(b, a % b)
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn fractions_are_in_lowest_terms() {
        let period = |turns, parts| ShaftPeriod::new(turns, parts).unwrap();
        assert_eq!(period(57, 57), ShaftPeriod::REVOLUTION);
        assert_eq!(period(47, 23).whole_revolutions(), 47);
        assert_eq!(period(8, 48).whole_revolutions(), 1);
        assert!((period(8, 48).rad() - TAU / 6.0).abs() < 1e-15);
        assert_eq!(ShaftPeriod::new(0, 3), None);
        assert_eq!(ShaftPeriod::new(3, 0), None);
    }

    #[test]
    fn a_pitch_divides_a_turn_and_a_turn_no_pitch() {
        let (pitch, wheel) = (
            ShaftPeriod::new(1, 23).unwrap(),
            ShaftPeriod::new(47, 23).unwrap(),
        );
        let turn = ShaftPeriod::REVOLUTION;
        assert!(turn.is_multiple_of(&pitch) && wheel.is_multiple_of(&pitch));
        assert!(!pitch.is_multiple_of(&turn) && !turn.is_multiple_of(&wheel));
        assert!(!wheel.is_multiple_of(&turn));
        assert!(ShaftPeriod::revolutions(47).is_multiple_of(&wheel));
    }
}
