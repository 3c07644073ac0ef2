//! Long work beside Python: the lock is released, Ctrl-C is heard, progress is passed on.

use std::panic::AssertUnwindSafe;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use gearmesh_operations::{Failure, Listener, Task, Watch};
use pyo3::prelude::*;

use crate::errors::{WorkError, raised};

/// Wall time between two looks at Ctrl-C and at the progress.
const LOOKS: Duration = Duration::from_millis(50);

/// Longest wait for work that was asked to stop.
const PATIENCE: Duration = Duration::from_millis(500);

/// Where the work stands: name of the stage, done, of how much (zero: not known).
#[derive(Debug, Clone, PartialEq, Default)]
struct Stand {
    stage: String,
    done: f64,
    total: f64,
}

/// What the work and the thread that waits for it share.
#[derive(Debug, Default)]
struct Shared {
    /// Set by Ctrl-C.
    stop: AtomicBool,
    stand: Mutex<Stand>,
}

impl Shared {
    fn with(&self, act: impl FnOnce(&mut Stand)) {
        act(&mut self.stand.lock().unwrap_or_else(PoisonError::into_inner));
    }
}

/// Notes and warnings are kept by results, where a user finds them.
impl Listener for Shared {
    fn begin(&self, title: &str) -> Box<dyn Task + '_> {
        Box::new(Told {
            shared: self,
            stage: Mutex::new(title.to_owned()),
        })
    }

    fn note(&self, _: &str) {}

    fn warning(&self, _: &str) {}
}

/// A task, and the stage that it is at.
struct Told<'a> {
    shared: &'a Shared,
    stage: Mutex<String>,
}

impl Task for Told<'_> {
    fn stage(&self, name: &str) {
        name.clone_into(&mut self.stage.lock().unwrap_or_else(PoisonError::into_inner));
        self.advance(0.0, 0.0);
    }

    fn advance(&self, done: f64, total: f64) {
        let stage = self.stage.lock().unwrap_or_else(PoisonError::into_inner);
        self.shared.with(|stand| {
            stand.stage.clone_from(&stage);
            (stand.done, stand.total) = (done, total);
        });
    }

    fn expect(&self, _seconds: f64) {}
}

/// What becomes of the work on Ctrl-C.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum OnInterrupt {
    /// It ends by itself; what it stores, a checkpoint or the cases at hand, is whole then.
    Wait,
    /// It may be where it cannot stop, in a factorisation or a mesher. After a moment it ends in the background: it
    /// looks at the flag before it writes anything.
    Leave,
}

/// Runs `work` on a thread of its own. `progress(stage, done, total)` is called about every 50 ms where something has
/// changed, and at the end, on the thread that called. `python` makes meshes.
///
/// # Errors
/// What `work` returns; `KeyboardInterrupt`, or what `progress` has raised; `WorkError` where the work panicked.
pub(crate) fn watched<T: Send + 'static>(
    py: Python<'_>,
    progress: Option<&Bound<'_, PyAny>>,
    on_interrupt: OnInterrupt,
    python: Option<PathBuf>,
    work: impl FnOnce(&Watch<'_>) -> Result<T, Failure> + Send + 'static,
) -> PyResult<T> {
    let shared = Arc::new(Shared::default());
    let (sender, mut receiver) = channel();
    let theirs = Arc::clone(&shared);
    let thread = std::thread::spawn(move || {
        let watch = Watch {
            listener: &*theirs,
            stop: &theirs.stop,
            python: python.as_deref(),
        };
        let outcome = std::panic::catch_unwind(AssertUnwindSafe(|| work(&watch)));
        // Nobody listens any more where the work was left to itself.
        let _ = sender.send(outcome);
    });
    let mut told = Stand::default();
    let mut interrupted: Option<(PyErr, Instant)> = None;
    let outcome = loop {
        let queue = &mut receiver;
        let found = py.detach(move || queue.recv_timeout(LOOKS));
        match found {
            Ok(outcome) => break Some(outcome),
            Err(RecvTimeoutError::Disconnected) => break None,
            Err(RecvTimeoutError::Timeout) => {}
        }
        if let Some((error, when)) = interrupted.take() {
            if on_interrupt == OnInterrupt::Leave && when.elapsed() > PATIENCE {
                return Err(error);
            }
            interrupted = Some((error, when));
            continue;
        }
        let mut now = Stand::default();
        shared.with(|stand| now.clone_from(stand));
        let mut heard = py.check_signals();
        if let (Ok(()), Some(progress), true) = (&heard, progress, now != told) {
            heard = progress
                .call1((&now.stage, now.done, now.total))
                .map(|_| ());
            told = now;
        }
        if let Err(error) = heard {
            shared.stop.store(true, Ordering::Relaxed);
            interrupted = Some((error, Instant::now()));
        }
    };
    let _ = py.detach(|| thread.join());
    if let Some((error, _)) = interrupted {
        return Err(error);
    }
    // Where it came to, also of work that took less than a look.
    let mut last = Stand::default();
    shared.with(|stand| last.clone_from(stand));
    if let (Some(Ok(Ok(_))), Some(progress), true) = (&outcome, progress, last != told) {
        progress.call1((&last.stage, last.done, last.total))?;
    }
    match outcome {
        Some(Ok(outcome)) => outcome.map_err(raised),
        _ => Err(WorkError::new_err(
            "the computation ended by a fault of the program; the message above says where",
        )),
    }
}
