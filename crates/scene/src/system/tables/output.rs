//! `[output]`: what is written, and how often.

use gearmesh_geometry::InputError;
use gearmesh_geometry::input::{InputDocument, TableKeys};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::run::Run;

/// Rows of a result: 2³², 34 GB for each column.
pub const MOST_ROWS: f64 = 4_294_967_296.0;

/// `[output]` as written in the file.
#[derive(Debug, Clone, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct OutputTable {
    /// Distance of the output times, for runs that step through time.
    pub interval_s: Option<f64>,
    /// Begin of mean, deviation and extremes of a `transient` run; the middle of the run where not given.
    pub statistics_from_s: Option<f64>,
    /// Names of the bodies whose motion is written; all where not given.
    pub bodies: Option<Vec<String>>,
    /// Names of the joints and motions whose reactions and angles are written; all where not given.
    pub joints: Option<Vec<String>>,
    /// Names of the force elements and gear meshes whose channels are written; all where not given.
    pub elements: Option<Vec<String>>,
}

/// What is written, checked; names are checked when the system is built.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Output {
    /// Distance of the output times \[s\]; none for runs that do not step through time.
    pub interval_s: Option<f64>,
    /// Begin of the statistics of a `transient` run \[s\].
    pub statistics_from_s: Option<f64>,
    /// Bodies; all where not given.
    pub bodies: Option<Vec<String>>,
    /// Joints and motions; all where not given.
    pub joints: Option<Vec<String>>,
    /// Force elements and gear meshes; all where not given.
    pub elements: Option<Vec<String>>,
}

impl Output {
    /// Begin of the statistics of a run of this length \[s\]: as stated, else its middle.
    pub fn statistics_begin_s(&self, end_s: f64) -> f64 {
        self.statistics_from_s.unwrap_or(0.5 * end_s)
    }
}

impl OutputTable {
    /// Checks the table for a run.
    ///
    /// # Errors
    /// [`InputError`] naming the key.
    pub fn check(&self, document: &InputDocument, run: &Run) -> Result<Output, InputError> {
        let keys = TableKeys::new(document, "output");
        let kind = run.kind().name();
        let interval_s = match (run.simulated_s(), self.interval_s) {
            (None, None) => None,
            (None, Some(_)) => {
                return Err(keys.error("interval_s", format!("is not used by run.kind = \"{kind}\", which does not step through time; remove it")));
            }
            (Some(simulated), given) => {
                let interval =
                    keys.needed("interval_s", given, &format!("run.kind = \"{kind}\""))?;
                let allowed = format!("more than 0, at most the {simulated} s of the run");
                keys.require(
                    "interval_s",
                    interval,
                    interval > 0.0 && interval <= simulated,
                    &allowed,
                )?;
                let least = simulated / MOST_ROWS;
                let many = format!("at least {least:.3e}, which gives {MOST_ROWS} rows");
                keys.require("interval_s", interval, interval >= least, &many)?;
                if let Run::SpeedSweep(sweep) = run {
                    sweep.schedule.refuse_empty_windows(document, interval)?;
                }
                Some(interval)
            }
        };
        if let Some(from_s) = self.statistics_from_s {
            let Run::Transient { end_s } = run else {
                return Err(keys.error(
                    "statistics_from_s",
                    format!("is not used by run.kind = \"{kind}\"; remove it"),
                ));
            };
            let allowed = format!("0 or more, below the end of the run at {end_s}");
            let is_inside = (0.0..*end_s).contains(&from_s);
            keys.require("statistics_from_s", from_s, is_inside, &allowed)?;
        }
        Ok(Output {
            interval_s,
            statistics_from_s: self.statistics_from_s,
            bodies: self.bodies.clone(),
            joints: self.joints.clone(),
            elements: self.elements.clone(),
        })
    }
}
