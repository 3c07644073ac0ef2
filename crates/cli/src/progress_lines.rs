//! Progress for programs that start this one: with `GEARMESH_PROGRESS=lines`, lines of JSON on standard error.

use std::io::Write;
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use serde_json::json;

/// Wall time between two lines.
const EVERY: Duration = Duration::from_millis(100);

/// Writes how far the work is, where somebody has asked for it.
#[derive(Debug)]
pub struct ProgressLines {
    /// When the last line was written; None where nobody has asked.
    told: Option<Mutex<Option<Instant>>>,
}

impl ProgressLines {
    /// As the environment asks.
    pub fn from_environment() -> Self {
        let asked = std::env::var("GEARMESH_PROGRESS").is_ok_and(|form| form == "lines");
        Self {
            told: asked.then(Mutex::default),
        }
    }

    /// Whether lines are written, in place of bars and remarks.
    pub fn are_asked_for(&self) -> bool {
        self.told.is_some()
    }

    /// Says that so much of a stage is done; a total of 0 is not known. The first line and the last one are always
    /// written.
    pub fn tell(&self, stage: &str, done: f64, total: f64) {
        let Some(told) = &self.told else {
            return;
        };
        let mut told = told.lock().unwrap_or_else(PoisonError::into_inner);
        let is_due = told.is_none_or(|last| last.elapsed() >= EVERY);
        if is_due || done >= total {
            *told = Some(Instant::now());
            let line = json!({"progress": {"stage": stage, "done": done, "total": total}});
            // Nobody can be told that standard error is closed.
            let _ = writeln!(std::io::stderr(), "{line}");
        }
    }
}
