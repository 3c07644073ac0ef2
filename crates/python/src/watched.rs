//! Long work beside Python: the lock is released, Ctrl-C is heard, progress is passed on.

use std::panic::AssertUnwindSafe;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use gearmesh_reduction::Progress;
use pyo3::prelude::*;

use crate::errors::WorkError;

/// Wall time between two looks at Ctrl-C and at the progress.
const LOOKS: Duration = Duration::from_millis(50);

/// Where the work stands: name of the stage, done, of how much (zero: not known).
#[derive(Debug, Clone, PartialEq, Default)]
struct Stand {
    stage: String,
    done: f64,
    total: f64,
}

/// What the work and the thread that waits for it share.
#[derive(Debug, Default)]
pub(crate) struct Watch {
    /// Set by Ctrl-C.
    pub(crate) stop: AtomicBool,
    stand: Mutex<Stand>,
}

impl Watch {
    /// Says how far the work is.
    pub(crate) fn advance(&self, stage: &str, done: f64, total: f64) {
        let mut stand = self.stand.lock().unwrap_or_else(PoisonError::into_inner);
        stand.stage.clear();
        stand.stage.push_str(stage);
        (stand.done, stand.total) = (done, total);
    }

    fn now(&self) -> Stand {
        let stand = self.stand.lock().unwrap_or_else(PoisonError::into_inner);
        stand.clone()
    }
}

impl Progress for Watch {
    fn stage(&self, name: &str) {
        self.advance(name, 0.0, 0.0);
    }

    fn advance(&self, done: usize, total: usize) {
        let mut stand = self.stand.lock().unwrap_or_else(PoisonError::into_inner);
        (stand.done, stand.total) = (done as f64, total as f64);
    }

    fn expect(&self, _seconds: f64) {}
}

/// What becomes of the work on Ctrl-C.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum OnInterrupt {
    /// It looks at [`Watch::stop`] and ends by itself, soon; what it has stored is whole.
    Wait,
    /// It has no place to stop: it ends in the background, and what it makes is dropped.
    Leave,
}

/// Runs `work` on a thread of its own. `progress(stage, done, total)` is called about every 50 ms where something has
/// changed, on the thread that called.
///
/// # Errors
/// What `work` returns; `KeyboardInterrupt`, or what `progress` has raised; `WorkError` where the work panicked.
pub(crate) fn watched<T: Send + 'static>(
    py: Python<'_>,
    progress: Option<&Bound<'_, PyAny>>,
    on_interrupt: OnInterrupt,
    work: impl FnOnce(&Watch) -> PyResult<T> + Send + 'static,
) -> PyResult<T> {
    let watch = Arc::new(Watch::default());
    let (sender, mut receiver) = channel();
    let theirs = Arc::clone(&watch);
    let thread = std::thread::spawn(move || {
        let outcome = std::panic::catch_unwind(AssertUnwindSafe(|| work(&theirs)));
        // Nobody listens any more where the work was left to itself.
        let _ = sender.send(outcome);
    });
    let mut told = Stand::default();
    let mut raised = None;
    let outcome = loop {
        let queue = &mut receiver;
        let found = py.detach(move || queue.recv_timeout(LOOKS));
        match found {
            Ok(outcome) => break Some(outcome),
            Err(RecvTimeoutError::Disconnected) => break None,
            Err(RecvTimeoutError::Timeout) => {}
        }
        if raised.is_some() {
            continue;
        }
        let now = watch.now();
        let mut heard = py.check_signals();
        if let (Ok(()), Some(progress), true) = (&heard, progress, now != told) {
            heard = progress
                .call1((&now.stage, now.done, now.total))
                .map(|_| ());
            told = now;
        }
        if let Err(error) = heard {
            watch.stop.store(true, Ordering::Relaxed);
            if on_interrupt == OnInterrupt::Leave {
                return Err(error);
            }
            raised = Some(error);
        }
    };
    let _ = py.detach(|| thread.join());
    if let Some(error) = raised {
        return Err(error);
    }
    match outcome {
        Some(Ok(outcome)) => outcome,
        _ => Err(WorkError::new_err(
            "the computation ended by a fault of the program; the message above says where",
        )),
    }
}
