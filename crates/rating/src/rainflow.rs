//! Rainflow counting of a load history by the three-point rule of ASTM E1049-85.
//!
//! Ranges between turning points are read in order. When the newest range X is at least its predecessor Y, Y is counted
//! and its two points are taken out: as one cycle (section 5.4.4), or, if Y holds the start of the history, as half a
//! cycle, with the start alone taken out. What is left at the end counts as half cycles. A history that repeats is
//! begun at its maximum, and every count is then a whole cycle (section 5.4.5).

/// Why a history cannot be counted.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum RainflowError {
    /// No values.
    #[error("an empty history has no cycles to count")]
    Empty,
    /// NaN or infinity.
    #[error("value {index} of the history is {value}; values must be finite numbers")]
    NotFinite {
        /// Index, from 0.
        index: usize,
        /// The value.
        value: f64,
    },
}

/// How often the history is passed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Passage {
    /// Once: its open ranges count as half cycles (section 5.4.4).
    Once,
    /// Again and again, end joined to start (section 5.4.5): one passage of the stationary repetition.
    Repeated,
}

/// A counted cycle, or half of one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cycle {
    /// Lower end.
    pub minimum: f64,
    /// Upper end.
    pub maximum: f64,
    /// 1 for a cycle, ½ for half a cycle.
    pub count: f64,
}

impl Cycle {
    fn between(a: f64, b: f64, count: f64) -> Self {
        Self {
            minimum: a.min(b),
            maximum: a.max(b),
            count,
        }
    }

    /// Upper minus lower end.
    pub fn range(&self) -> f64 {
        self.maximum - self.minimum
    }

    /// Half the range.
    pub fn amplitude(&self) -> f64 {
        0.5 * self.range()
    }

    /// Middle of both ends.
    pub fn mean(&self) -> f64 {
        0.5 * (self.maximum + self.minimum)
    }
}

/// The history's first and last values and the peaks and valleys between; a plateau is one point, a constant history
/// one point in all.
///
/// # Errors
/// [`RainflowError`].
pub fn turning_points(history: &[f64]) -> Result<Vec<f64>, RainflowError> {
    let mut points = TurningPoints::default();
    history.iter().try_for_each(|&value| points.push(value))?;
    points.finish()
}

/// [`turning_points`] of a history that comes value by value: what lies between two turns is not kept. Their
/// [`rainflow()`] is that of the history.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct TurningPoints {
    points: Vec<f64>,
    values: usize,
}

impl TurningPoints {
    /// Takes the next value.
    ///
    /// # Errors
    /// [`RainflowError::NotFinite`].
    pub fn push(&mut self, value: f64) -> Result<(), RainflowError> {
        let index = self.values;
        self.values += 1;
        if !value.is_finite() {
            return Err(RainflowError::NotFinite { index, value });
        }
        if let [.., last] = self.points[..] {
            if value == last {
                return Ok(());
            }
            // The last point is no turning point if the history goes on in the same direction.
            if let [.., before, last] = self.points[..]
                && (value > last) == (last > before)
            {
                self.points.pop();
            }
        }
        self.points.push(value);
        Ok(())
    }

    /// Values taken so far.
    pub fn values(&self) -> usize {
        self.values
    }

    /// The points.
    ///
    /// # Errors
    /// [`RainflowError::Empty`] if nothing was taken.
    pub fn finish(self) -> Result<Vec<f64>, RainflowError> {
        if self.points.is_empty() {
            return Err(RainflowError::Empty);
        }
        Ok(self.points)
    }
}

/// Counts the cycles of a history, in the order in which they close.
///
/// # Errors
/// [`RainflowError`].
pub fn rainflow(history: &[f64], passage: Passage) -> Result<Vec<Cycle>, RainflowError> {
    let mut points = turning_points(history)?;
    if passage == Passage::Repeated {
        points = turning_points(&from_maximum(&points))?;
    }
    let mut cycles = Vec::new();
    let mut open: Vec<f64> = Vec::new();
    for point in points {
        open.push(point);
        while let [.., a, b, c] = open[..] {
            if (c - b).abs() < (b - a).abs() {
                break;
            }
            if passage == Passage::Once && open.len() == 3 {
                cycles.push(Cycle::between(a, b, 0.5));
                open.remove(0);
            } else {
                cycles.push(Cycle::between(a, b, 1.0));
                open.truncate(open.len() - 3);
                open.push(c);
            }
        }
    }
    // Nothing is left of a repeated history: it ends on its maximum, where it began.
    cycles.extend(
        open.windows(2)
            .map(|pair| Cycle::between(pair[0], pair[1], 0.5)),
    );
    Ok(cycles)
}

/// The history from its (first) maximum round to the same maximum again.
fn from_maximum(history: &[f64]) -> Vec<f64> {
    let mut turned = history.to_vec();
    let maximum = (0..history.len()).fold(
        0,
        |best, i| {
            if history[i] > history[best] { i } else { best }
        },
    );
    turned.rotate_left(maximum);
    turned.extend(history.get(maximum));
    turned
}
