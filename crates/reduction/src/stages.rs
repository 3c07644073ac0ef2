//! Wall time of a job, stage by stage.

use std::time::Instant;

/// Stages that have ended, and when the present one began.
pub(crate) struct Stages {
    seconds: Vec<(String, f64)>,
    since: Instant,
}

impl Stages {
    /// Goes on after stages that have ended (s).
    pub fn after(seconds: Vec<(String, f64)>) -> Self {
        Self {
            seconds,
            since: Instant::now(),
        }
    }

    /// Ends the present stage; the next one begins.
    pub fn lap(&mut self, name: &str) {
        let seconds = self.since.elapsed().as_secs_f64();
        self.seconds.push((name.to_string(), seconds));
        self.since = Instant::now();
    }

    /// Seconds of each stage, in the order they ran.
    pub fn into_seconds(self) -> Vec<(String, f64)> {
        self.seconds
    }
}
