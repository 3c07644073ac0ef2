//! Work that takes longer than a slider's move: reducing a body, seeking an optimum. One at a time, beside the
//! calculations; the page asks how far it is.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Instant;

use gearmesh_operations::{Listener, Task, Watch};
use serde_json::{Value, json};

use crate::problem::Problem;

/// The work of a server. Threads share it.
#[derive(Debug, Default)]
pub struct Job {
    state: Arc<Mutex<State>>,
    /// Held while one works.
    turn: Arc<Mutex<()>>,
}

#[derive(Debug, Default)]
struct State {
    number: u64,
    /// What it works at: the same is not begun twice.
    name: String,
    stop: Arc<AtomicBool>,
    running: bool,
    title: String,
    stage: String,
    done: Option<[f64; 2]>,
    notes: Vec<String>,
    outcome: Option<Result<Value, Problem>>,
    begun: Option<Instant>,
}

/// What a job hears of its work.
struct Told {
    state: Arc<Mutex<State>>,
    number: u64,
}

impl Job {
    /// Begins work on a thread of its own, unless the same runs already; what runs is stopped first.
    pub fn begin(
        &self,
        name: String,
        work: impl FnOnce(&Watch<'_>) -> Result<Value, Problem> + Send + 'static,
    ) {
        let told = {
            let mut state = locked(&self.state);
            if state.running && state.name == name {
                return;
            }
            state.stop.store(true, Ordering::SeqCst);
            *state = State {
                number: state.number + 1,
                name,
                running: true,
                begun: Some(Instant::now()),
                ..State::default()
            };
            Told {
                state: Arc::clone(&self.state),
                number: state.number,
            }
        };
        let stop = Arc::clone(&locked(&self.state).stop);
        let turn = Arc::clone(&self.turn);
        std::thread::spawn(move || {
            let _turn = turn.lock().unwrap_or_else(PoisonError::into_inner);
            let watch = Watch {
                listener: &told,
                stop: &stop,
                python: None,
            };
            let outcome = match stop.load(Ordering::SeqCst) {
                true => Err(Problem::Stopped),
                false => catch_unwind(AssertUnwindSafe(|| work(&watch)))
                    .unwrap_or_else(|_| Err(Problem::Work("the work has failed".to_owned()))),
            };
            told.with(|state| {
                state.running = false;
                state.outcome = Some(outcome);
            });
        });
    }

    /// Tells what runs to stop.
    pub fn stop(&self) {
        locked(&self.state).stop.store(true, Ordering::SeqCst);
    }

    /// How far it is, and what it came to.
    pub fn progress(&self) -> Value {
        let state = locked(&self.state);
        let (result, problem) = match &state.outcome {
            None => (None, None),
            Some(Ok(result)) => (Some(result), None),
            Some(Err(problem)) => (None, Some(problem.body())),
        };
        json!({
            "number": state.number,
            "running": state.running,
            "title": state.title,
            "stage": state.stage,
            "done": state.done,
            "seconds": state.begun.map(|begun| begun.elapsed().as_secs_f64()),
            "notes": state.notes,
            "result": result,
            "problem": problem,
        })
    }
}

fn locked(state: &Mutex<State>) -> MutexGuard<'_, State> {
    state.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Told {
    /// Changes the state, unless newer work has taken its place.
    fn with(&self, change: impl FnOnce(&mut State)) {
        let mut state = locked(&self.state);
        if state.number == self.number {
            change(&mut state);
        }
    }
}

impl Listener for Told {
    fn begin(&self, title: &str) -> Box<dyn Task + '_> {
        self.with(|state| {
            title.clone_into(&mut state.title);
            state.stage.clear();
            state.done = None;
        });
        Box::new(Stage(self))
    }

    fn note(&self, text: &str) {
        self.with(|state| state.notes.push(text.to_owned()));
    }

    fn warning(&self, text: &str) {
        self.note(text);
    }
}

struct Stage<'a>(&'a Told);

impl Task for Stage<'_> {
    fn stage(&self, name: &str) {
        self.0.with(|state| {
            name.clone_into(&mut state.stage);
            state.done = None;
        });
    }

    fn advance(&self, done: f64, total: f64) {
        self.0.with(|state| state.done = Some([done, total]));
    }

    fn expect(&self, _: f64) {}
}
