//! `[output]`: what is written, and how often.

use gearmesh_geometry::input::{InputDocument, TableKeys};
use gearmesh_geometry::{InputError, given};
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

impl OutputTable {
    /// Begin of the statistics of a run of this length \[s\]: as stated, else its middle.
    pub fn statistics_begin_s(&self, end_s: f64) -> f64 {
        self.statistics_from_s.unwrap_or(0.5 * end_s)
    }

    /// Checks the table for a run; names are checked when the system is built.
    ///
    /// # Errors
    /// [`InputError`] naming the key.
    pub fn check(&self, document: &InputDocument, run: &Run) -> Result<(), InputError> {
        let keys = TableKeys::new(document, "output");
        let kind = run.kind().name();
        if let Some(simulated) = run.simulated_s() {
            let needed_by = format!("run.kind = \"{kind}\"");
            let interval = keys.needed("interval_s", self.interval_s, &needed_by)?;
            let allowed = format!("more than 0, at most the {simulated} s of the run");
            let ok = interval > 0.0 && interval <= simulated;
            keys.require("interval_s", interval, ok, &allowed)?;
            let least = simulated / MOST_ROWS;
            let many = format!("at least {least:.3e}, which gives {MOST_ROWS} rows");
            keys.require("interval_s", interval, interval >= least, &many)?;
            if let Run::SpeedSweep(sweep) = run {
                sweep.schedule.refuse_empty_windows(document, interval)?;
            }
        } else {
            let problem = format!(
                "is not used by run.kind = \"{kind}\", which does not step through time; remove it"
            );
            keys.refuse(&given!(self; interval_s), problem)?;
        }
        if let Some(from_s) = self.statistics_from_s {
            let Run::Transient { end_s } = run else {
                let problem = format!("is not used by run.kind = \"{kind}\"; remove it");
                return Err(keys.error("statistics_from_s", problem));
            };
            let allowed = format!("0 or more, below the end of the run at {end_s}");
            let is_inside = (0.0..*end_s).contains(&from_s);
            keys.require("statistics_from_s", from_s, is_inside, &allowed)?;
        }
        Ok(())
    }
}
