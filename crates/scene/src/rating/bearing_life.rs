//! From the loads of a bearing in a run to its rating life.

use gearmesh_bearings::life::Lubrication;
use gearmesh_bearings::{
    BearingDefinition, BearingError, HistorySample, LoadHistory, QuasiStaticBearing,
};

use super::result::{RatingFigure, figures};

/// A bearing to be rated.
#[derive(Debug, Clone, PartialEq)]
pub struct BearingLifeJob {
    /// What it is.
    pub definition: BearingDefinition,
    /// The same, ready to be evaluated.
    pub bearing: QuasiStaticBearing,
    /// Lubricant, for L10mr.
    pub lubrication: Option<Lubrication>,
    /// Speeds of the inner and outer ring where the run has no rows of them \[rad/s\].
    pub speeds_rad_per_s: [f64; 2],
    /// 1 or −1 where the shaft's own z axis is along or against the bearing's, then the same of the housing's; none
    /// where speeds have no rows.
    pub senses: Option<[f64; 2]>,
}

impl BearingLifeJob {
    /// One moment of the history: columns are force and moments that the bearing exerts on the shaft, then the speeds
    /// of the shaft and, where it turns, of the housing.
    #[must_use]
    pub fn sample(&self, weight: f64, values: &[f64]) -> HistorySample {
        let [inner, outer] = match self.senses {
            None => self.speeds_rad_per_s,
            Some([inner, outer]) => [
                inner * values[5],
                values.get(6).map_or(0.0, |speed| outer * speed),
            ],
        };
        HistorySample {
            weight,
            // What the shaft exerts on its ring.
            force_n: [-values[0], -values[1], -values[2]],
            moment_nm: [-values[3], -values[4]],
            inner_rad_per_s: inner,
            outer_rad_per_s: outer,
        }
    }

    /// Lives over a history, and what of its loads is beyond a limit.
    ///
    /// # Errors
    /// [`BearingError`] where a load has no equilibrium.
    pub fn figures(
        &self,
        history: &LoadHistory,
    ) -> Result<(Vec<RatingFigure>, Vec<String>), BearingError> {
        let life = history.life(&self.definition, &self.bearing, self.lubrication.as_ref())?;
        let turns = life.mean_speed_rad_per_s > 0.0;
        let mut values = vec![("bearing_l10r_mrev", life.reference_mrev)];
        values.extend(life.equivalent_n.map(|p| ("bearing_equivalent_load_N", p)));
        values.extend(life.basic_mrev.map(|l| ("bearing_l10_mrev", l)));
        values.extend(life.modified_mrev.map(|l| ("bearing_l10mr_mrev", l)));
        if turns {
            values.push(("bearing_mean_speed_rad_per_s", life.mean_speed_rad_per_s));
            values.push(("bearing_l10r_h", life.hours(life.reference_mrev)));
            values.extend(life.basic_mrev.map(|l| ("bearing_l10_h", life.hours(l))));
            values.extend(
                life.modified_mrev
                    .map(|l| ("bearing_l10mr_h", life.hours(l))),
            );
        }
        let warnings = life.warnings.iter().map(ToString::to_string);
        Ok((figures(&values), warnings.collect()))
    }

    /// How it is judged, in words.
    #[must_use]
    pub fn method(&self) -> String {
        let modified = if self.lubrication.is_some() {
            ", L10mr with its lubricant"
        } else {
            ""
        };
        format!(
            "L10 by ISO 281 and L10r by ISO/TS 16281{modified}, damages of all loads added by Palmgren and Miner"
        )
    }
}
