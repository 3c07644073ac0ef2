//! One calculation at a time, and always the newest: who drags a slider wants the last place, not all of them.

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use gearmesh_scene::pair::PairWatch;

use crate::problem::Problem;

/// The calculations of a server. Threads share it.
#[derive(Debug, Default)]
pub struct Latest {
    newest: AtomicU64,
    turn: Arc<tokio::sync::Mutex<()>>,
    running: Mutex<Arc<PairWatch>>,
}

impl Latest {
    /// Runs `work` on a thread of its own as soon as no other does. An older one is told to stop; of those that wait
    /// only the newest gets its turn.
    ///
    /// # Errors
    /// Those of the work; [`Problem::Overtaken`] where a newer one came, [`Problem::Work`] where it panicked.
    pub async fn run<T: Send + 'static>(
        &self,
        work: impl FnOnce(&PairWatch) -> Result<T, Problem> + Send + 'static,
    ) -> Result<T, Problem> {
        let own = self.newest.fetch_add(1, Ordering::SeqCst) + 1;
        self.stop();
        let turn = Arc::clone(&self.turn).lock_owned().await;
        let watch = Arc::new(PairWatch::default());
        *self.running() = Arc::clone(&watch);
        // One that came since then has stopped this watch, or the one before it.
        let is_newest = || self.newest.load(Ordering::SeqCst) == own;
        if !is_newest() {
            return Err(Problem::Overtaken);
        }
        let done = tokio::task::spawn_blocking(move || {
            // Until the work has ended, even where nobody waits for it any more.
            let _turn = turn;
            work(&watch)
        });
        match done.await {
            Ok(Err(Problem::Stopped)) if !is_newest() => Err(Problem::Overtaken),
            Ok(outcome) => outcome,
            Err(error) => Err(Problem::Work(format!(
                "the calculation has failed: {error}"
            ))),
        }
    }

    /// Tells what runs to stop.
    pub fn stop(&self) {
        self.running().stop.store(true, Ordering::SeqCst);
    }

    /// Positions that the one that runs, or ran last, has solved.
    pub fn solved(&self) -> usize {
        self.running().solved.load(Ordering::Relaxed)
    }

    fn running(&self) -> std::sync::MutexGuard<'_, Arc<PairWatch>> {
        self.running.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
