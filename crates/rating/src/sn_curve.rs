//! S-N curve: cycles to failure by stress amplitude, straight lines in log-log.

/// A point of an S-N curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SnPoint {
    /// Cycles to failure.
    pub cycles: f64,
    /// Stress amplitude at zero mean \[Pa\].
    pub amplitude_pa: f64,
}

/// What holds for amplitudes below the last point (the knee).
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum BelowTable {
    /// They do no damage (Miner's original rule).
    EnduranceLimit,
    /// The last slope k goes on (elementary rule, on the safe side).
    LastSlope,
    /// The slope 2k − 1 (E. Haibach 1970).
    Haibach,
    /// A slope of its own.
    Slope(f64),
}

/// What holds for amplitudes above the first point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AboveTable {
    /// They are refused: the table does not know them.
    Refuse,
    /// The first slope goes on.
    FirstSlope,
}

/// Why points are no S-N curve, or an amplitude has no life.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SnError {
    /// Too few points for a slope.
    #[error("an S-N table of {found} rows; at least 2 are needed")]
    TooFewRows {
        /// Rows found.
        found: usize,
    },
    /// A value that is no positive finite number.
    #[error("row {row} of the S-N table: {what} = {found}; it must be a finite number above 0")]
    NotPositive {
        /// Row, from 1.
        row: usize,
        /// Name of the value with its unit.
        what: &'static str,
        /// The value.
        found: f64,
    },
    /// Amplitudes must fall.
    #[error(
        "row {row} of the S-N table: amplitude {found_mpa} MPa is not below {before_mpa} MPa of the row before; amplitudes must \
         decrease"
    )]
    NotDecreasing {
        /// Row, from 1.
        row: usize,
        /// Its amplitude.
        found_mpa: f64,
        /// The one before.
        before_mpa: f64,
    },
    /// Cycles must grow.
    #[error(
        "row {row} of the S-N table: {found} cycles are not above {before} of the row before; cycles must increase"
    )]
    CyclesNotIncreasing {
        /// Row, from 1.
        row: usize,
        /// Its cycles.
        found: f64,
        /// Those before.
        before: f64,
    },
    /// A slope that is none.
    #[error(
        "slope {found}: a slope k of N ∝ σ^-k must be a finite number above 0 (Haibach's rule: k above 0.5)"
    )]
    Slope {
        /// The slope.
        found: f64,
    },
    /// An amplitude beyond the table.
    #[error(
        "a stress amplitude of {found_mpa:.3} MPa lies above the S-N table, which begins at {highest_mpa:.3} MPa: extend the table, or \
         let its first slope go on"
    )]
    AboveTable {
        /// The amplitude.
        found_mpa: f64,
        /// The table's first.
        highest_mpa: f64,
    },
}

/// Cycles to failure N(σ_a): N = N_i (σ_i/σ_a)^k between points, with the slope k = ln(N_{i+1}/N_i)/ln(σ_i/σ_{i+1}).
#[derive(Debug, Clone, PartialEq)]
pub struct SnCurve {
    points: Vec<SnPoint>,
    /// Slope above the first point; none refuses.
    slope_above: Option<f64>,
    /// Slope below the last point; none does no damage.
    slope_below: Option<f64>,
}

impl SnCurve {
    /// The points, cycles growing.
    pub fn points(&self) -> &[SnPoint] {
        &self.points
    }

    /// A curve through points with growing cycles and falling amplitudes.
    ///
    /// # Errors
    /// [`SnError`] with the row.
    pub fn new(points: &[SnPoint], above: AboveTable, below: BelowTable) -> Result<Self, SnError> {
        if points.len() < 2 {
            return Err(SnError::TooFewRows {
                found: points.len(),
            });
        }
        for (i, p) in points.iter().enumerate() {
            positive(i + 1, "cycles", p.cycles)?;
            positive(i + 1, "amplitude in Pa", p.amplitude_pa)?;
        }
        for (i, pair) in points.windows(2).enumerate() {
            let row = i + 2;
            if pair[1].cycles <= pair[0].cycles {
                return Err(SnError::CyclesNotIncreasing {
                    row,
                    found: pair[1].cycles,
                    before: pair[0].cycles,
                });
            }
            if pair[1].amplitude_pa >= pair[0].amplitude_pa {
                return Err(SnError::NotDecreasing {
                    row,
                    found_mpa: pair[1].amplitude_pa * 1e-6,
                    before_mpa: pair[0].amplitude_pa * 1e-6,
                });
            }
        }
        let last = points.len() - 1;
        Ok(Self {
            slope_above: match above {
                AboveTable::Refuse => None,
                AboveTable::FirstSlope => Some(slope(points[0], points[1])),
            },
            slope_below: slope_below(slope(points[last - 1], points[last]), below)?,
            points: points.to_vec(),
        })
    }

    /// One slope k above the knee, whatever the amplitude: N = N_D (σ_D/σ_a)^k (O. H. Basquin 1910).
    ///
    /// # Errors
    /// [`SnError::NotPositive`], [`SnError::Slope`].
    pub fn basquin(knee: SnPoint, slope: f64, below: BelowTable) -> Result<Self, SnError> {
        positive(1, "cycles", knee.cycles)?;
        positive(1, "amplitude in Pa", knee.amplitude_pa)?;
        Ok(Self {
            slope_above: Some(check_slope(slope)?),
            slope_below: slope_below(slope, below)?,
            points: vec![knee],
        })
    }

    /// Cycles to failure at an amplitude (its modulus) at zero mean \[Pa\]; infinite where it does no damage.
    ///
    /// # Errors
    /// [`SnError::AboveTable`]; also for an amplitude that is not a number.
    pub fn cycles_to_failure(&self, amplitude_pa: f64) -> Result<f64, SnError> {
        let amplitude = amplitude_pa.abs();
        let (first, last) = (self.points[0], self.points[self.points.len() - 1]);
        let along =
            |from: SnPoint, slope: f64| from.cycles * (from.amplitude_pa / amplitude).powf(slope);
        if amplitude > first.amplitude_pa || amplitude.is_nan() {
            return match self.slope_above {
                Some(slope) if !amplitude.is_nan() => Ok(along(first, slope)),
                _ => Err(SnError::AboveTable {
                    found_mpa: amplitude * 1e-6,
                    highest_mpa: first.amplitude_pa * 1e-6,
                }),
            };
        }
        if amplitude < last.amplitude_pa {
            return Ok(self.slope_below.map_or(f64::INFINITY, |k| along(last, k)));
        }
        // The segment whose lower end is not above the amplitude; there is one, or the amplitude is a lone knee's.
        Ok(self
            .points
            .windows(2)
            .find(|pair| amplitude >= pair[1].amplitude_pa)
            .map_or(last.cycles, |pair| along(pair[0], slope(pair[0], pair[1]))))
    }
}

fn positive(row: usize, what: &'static str, found: f64) -> Result<(), SnError> {
    if found.is_finite() && found > 0.0 {
        Ok(())
    } else {
        Err(SnError::NotPositive { row, what, found })
    }
}

fn check_slope(found: f64) -> Result<f64, SnError> {
    if found.is_finite() && found > 0.0 {
        Ok(found)
    } else {
        Err(SnError::Slope { found })
    }
}

fn slope(a: SnPoint, b: SnPoint) -> f64 {
    (b.cycles / a.cycles).ln() / (a.amplitude_pa / b.amplitude_pa).ln()
}

fn slope_below(last: f64, below: BelowTable) -> Result<Option<f64>, SnError> {
    match below {
        BelowTable::EnduranceLimit => Ok(None),
        BelowTable::LastSlope => check_slope(last).map(Some),
        BelowTable::Haibach => check_slope(2.0 * last - 1.0).map(Some),
        BelowTable::Slope(slope) => check_slope(slope).map(Some),
    }
}
