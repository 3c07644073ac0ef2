//! Ctrl-C: output files stay whole, scratch files go, exit code 130.

use crate::console;
use gearmesh_model::wait_for_writes;
use gearmesh_operations::{Failure, Scratch, Watch};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

/// What an interrupted program leaves behind in a shell's eyes: 128 + SIGINT.
pub const EXIT_CODE: u8 = 130;

/// Asked by the first Ctrl-C, while some work stops by itself.
static DEMAND: Mutex<Option<Arc<AtomicBool>>> = Mutex::new(None);

/// While this lives, the first Ctrl-C only asks; the second one ends the program.
#[derive(Debug)]
pub struct OnDemand {
    /// Whether it was asked.
    pub asked: Arc<AtomicBool>,
}

impl OnDemand {
    /// Operations are listened to, and stop where they were asked to.
    pub fn watch(&self) -> Watch<'_> {
        Watch {
            stop: &self.asked,
            ..console::watch()
        }
    }
}

/// For work that looks at a flag and stops where it can go on later.
pub fn on_demand() -> OnDemand {
    let asked = Arc::new(AtomicBool::new(false));
    *DEMAND.lock().unwrap_or_else(PoisonError::into_inner) = Some(Arc::clone(&asked));
    OnDemand { asked }
}

impl Drop for OnDemand {
    fn drop(&mut self) {
        *DEMAND.lock().unwrap_or_else(PoisonError::into_inner) = None;
    }
}

/// From now on Ctrl-C ends the program tidily.
///
/// # Errors
/// A [`Failure`] where the system takes no handler.
pub fn install() -> Result<(), Failure> {
    ctrlc::set_handler(|| {
        let demand = DEMAND.lock().unwrap_or_else(PoisonError::into_inner).take();
        if let Some(asked) = demand {
            asked.store(true, Ordering::Relaxed);
            return;
        }
        // A file that is being written is finished and renamed first; the next one cannot begin.
        let _held = wait_for_writes();
        Scratch::remove_all();
        console::error("interrupted; what had been written before is whole, the rest is not there");
        std::process::exit(i32::from(EXIT_CODE));
    })
    .map_err(Failure::work)
}
