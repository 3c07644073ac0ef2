//! Measured profile and lead deviations: two tables, added.

use crate::error::DrivetrainError;
use crate::flank_error::{FlankError, FlankPoint, Removed, most_added_m};

/// Depth over a coordinate, linear between rows, held beyond the ends.
#[derive(Debug, Clone, PartialEq)]
struct Line {
    at: Vec<f64>,
    depth_m: Vec<f64>,
}

impl Line {
    fn new(what: &'static str, rows: &[[f64; 2]]) -> Result<Self, DrivetrainError> {
        let owner = "deviation table";
        for found in rows.as_flattened() {
            DrivetrainError::require(owner, (what, *found), found.is_finite(), "finite")?;
        }
        for pair in rows.windows(2) {
            let [before, found] = [pair[0][0], pair[1][0]];
            let allowed = "increasing from row to row";
            DrivetrainError::require(owner, (what, found), found > before, allowed)?;
        }
        Ok(Self {
            at: rows.iter().map(|row| row[0]).collect(),
            depth_m: rows.iter().map(|row| row[1]).collect(),
        })
    }

    /// Depth and slope.
    fn value(&self, x: f64) -> (f64, f64) {
        let above = self.at.partition_point(|at| *at <= x);
        match (above, self.at.len()) {
            (_, 0) => (0.0, 0.0),
            (0, _) => (self.depth_m[0], 0.0),
            (k, rows) if k == rows => (self.depth_m[rows - 1], 0.0),
            (k, _) => {
                let slope = (self.depth_m[k] - self.depth_m[k - 1]) / (self.at[k] - self.at[k - 1]);
                (self.depth_m[k - 1] + slope * (x - self.at[k - 1]), slope)
            }
        }
    }
}

/// Profile and lead deviation of all flanks of a gear, or of one tooth.
#[derive(Debug, Clone, PartialEq)]
pub struct DeviationTable {
    tooth: Option<usize>,
    profile: Line,
    lead: Line,
}

impl DeviationTable {
    /// Rows (roll angle \[rad\], material removed \[m\]) and (z \[m\], material removed \[m\]); either may be empty.
    ///
    /// # Errors
    /// [`DrivetrainError::Value`] if a number is not finite or the first column does not increase.
    pub fn new(profile: &[[f64; 2]], lead: &[[f64; 2]]) -> Result<Self, DrivetrainError> {
        Ok(Self {
            tooth: None,
            profile: Line::new("the roll angle or depth of the profile", profile)?,
            lead: Line::new("the position or depth of the lead", lead)?,
        })
    }

    /// The same on one tooth only.
    #[must_use]
    pub fn on_tooth(mut self, tooth: usize) -> Self {
        self.tooth = Some(tooth);
        self
    }
}

impl FlankError for DeviationTable {
    fn removed(&self, at: FlankPoint) -> Removed {
        if self.tooth.is_some_and(|tooth| tooth != at.tooth) {
            return Removed::default();
        }
        let (profile, slope_m_per_rad) = self.profile.value(at.roll_rad);
        let (lead, slope_along_axis) = self.lead.value(at.z_m);
        Removed {
            depth_m: profile + lead,
            slope_m_per_rad,
            slope_along_axis,
        }
    }

    fn most_added_m(&self) -> f64 {
        most_added_m(&self.profile.depth_m) + most_added_m(&self.lead.depth_m)
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use gearmesh_geometry::Flank;

    #[test]
    fn rows_are_met_and_lines_between() {
        let table = DeviationTable::new(&[[0.2, 0.0], [0.4, 8e-6]], &[[0.0, 1e-6]]).unwrap();
        let at = |roll_rad| {
            let (tooth, side, z_m) = (3, Flank::Right, 0.0);
            table.removed(FlankPoint {
                tooth,
                side,
                roll_rad,
                z_m,
            })
        };
        for (roll, depth) in [(0.1, 1e-6), (0.3, 5e-6), (0.5, 9e-6)] {
            assert!((at(roll).depth_m - depth).abs() < 1e-18);
        }
        assert!((at(0.3).slope_m_per_rad - 4e-5).abs() < 1e-15);
        assert!(DeviationTable::new(&[[0.2, 0.0], [0.2, 1.0]], &[]).is_err());
        assert!(DeviationTable::new(&[], &[[0.2, f64::NAN]]).is_err());
    }
}
