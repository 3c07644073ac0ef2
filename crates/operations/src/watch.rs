//! What an operation reports while it works, and how it is stopped.

use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

use gearmesh_geometry::InputError;
use gearmesh_mesh::python::PythonEnvironment;
use gearmesh_reduction::Progress;
use gearmesh_scene::pair::warnings::{ColumnPressure, yielding_in_words};

use crate::failure::{Failure, NOTHING_WRITTEN, Result};

/// Hears what an operation says. A door prints it, draws it, or keeps it for later.
pub trait Listener: Sync {
    /// A task begins. What is returned hears how far it is; when that is dropped, the task has ended.
    fn begin(&self, title: &str) -> Box<dyn Task + '_>;

    /// What a user may like to know.
    fn note(&self, text: &str);

    /// What a user should know before using the result.
    fn warning(&self, text: &str);
}

/// Hears how far one task is.
pub trait Task: Sync {
    /// A stage of the task begins. A task of one stage has no name for it.
    fn stage(&self, name: &str);

    /// So much of the stage is done.
    fn advance(&self, done: f64, total: f64);

    /// The stage cannot count its pieces and takes about so many seconds from now.
    fn expect(&self, seconds: f64);
}

/// Hears nothing.
#[derive(Debug, Clone, Copy)]
pub struct Silent;

impl Listener for Silent {
    fn begin(&self, _: &str) -> Box<dyn Task + '_> {
        Box::new(Self)
    }

    fn note(&self, _: &str) {}

    fn warning(&self, _: &str) {}
}

impl Task for Silent {
    fn stage(&self, _: &str) {}

    fn advance(&self, _: f64, _: f64) {}

    fn expect(&self, _: f64) {}
}

/// Who listens to an operation, what stops it, and which Python it starts for meshes.
#[derive(Clone, Copy)]
pub struct Watch<'a> {
    /// Hears what the operation says.
    pub listener: &'a dyn Listener,
    /// Once true, the operation ends soon with [`Fault::Stopped`](crate::Fault::Stopped); what it has written is whole.
    pub stop: &'a AtomicBool,
    /// A Python with gmsh and meshio; none to look for it.
    pub python: Option<&'a Path>,
}

impl Watch<'_> {
    /// Nobody listens, nothing stops.
    #[must_use]
    pub fn unattended() -> Watch<'static> {
        static NEVER: AtomicBool = AtomicBool::new(false);
        Watch {
            listener: &Silent,
            stop: &NEVER,
            python: None,
        }
    }

    /// Says what a user may like to know.
    pub fn note(&self, text: impl std::fmt::Display) {
        self.listener.note(&text.to_string());
    }

    /// Says what a user should know.
    pub fn warning(&self, text: impl std::fmt::Display) {
        self.listener.warning(&text.to_string());
    }

    /// The column with the largest pressure, where steel yields under it.
    pub fn yielding(&self, column: Option<&ColumnPressure>) {
        let column = column.into_iter();
        column.for_each(|one| self.warning(yielding_in_words(one)));
    }

    /// Numbers that look like those of another unit.
    pub fn unit_slips(&self, slips: Vec<InputError>) {
        slips.into_iter().for_each(|slip| self.warning(slip));
    }

    /// Whether the operation shall stop.
    #[must_use]
    pub fn is_stopped(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }

    /// To be asked in loops, and before a file is written.
    ///
    /// # Errors
    /// [`Failure::stopped`] once the operation shall stop.
    pub fn go_on(&self) -> Result<()> {
        match self.is_stopped() {
            true => Err(Failure::stopped(NOTHING_WRITTEN)),
            false => Ok(()),
        }
    }

    /// The Python that has gmsh and meshio.
    ///
    /// # Errors
    /// [`Failure`] where none is found.
    pub fn python(&self) -> Result<PythonEnvironment> {
        match self.python {
            Some(interpreter) => Ok(PythonEnvironment::at(interpreter.to_owned())),
            None => PythonEnvironment::find().map_err(Failure::work),
        }
    }

    /// Does offline work, which says how far it is and stops where it says so: reductions tell their progress after
    /// each block of solutions, and have no other place to stop. There the stack is unwound, so that no function below
    /// needs a way out for this one case.
    ///
    /// # Errors
    /// Those of the work; [`Failure::stopped`].
    pub fn offline<T, E>(
        &self,
        title: &str,
        work: impl FnOnce(&dyn Progress) -> Result<T, E>,
    ) -> Result<T>
    where
        Failure: From<E>,
    {
        self.go_on()?;
        let steps = Steps {
            task: self.listener.begin(title),
            stop: self.stop,
        };
        // Nothing that the work has changed is looked at again after it was stopped.
        match catch_unwind(AssertUnwindSafe(|| work(&steps))) {
            Ok(outcome) => Ok(outcome?),
            Err(payload) if payload.is::<Stopped>() => Err(Failure::stopped(NOTHING_WRITTEN)),
            Err(payload) => resume_unwind(payload),
        }
    }
}

/// What unwinds the stack of work that is stopped.
struct Stopped;

/// A task as the offline stage knows it.
struct Steps<'a> {
    task: Box<dyn Task + 'a>,
    stop: &'a AtomicBool,
}

impl Steps<'_> {
    fn look(&self) {
        if self.stop.load(Ordering::Relaxed) {
            // Not a panic: no message is printed.
            resume_unwind(Box::new(Stopped));
        }
    }
}

impl Progress for Steps<'_> {
    fn stage(&self, name: &str) {
        self.look();
        self.task.stage(name);
    }

    fn advance(&self, done: usize, total: usize) {
        self.look();
        self.task.advance(done as f64, total as f64);
    }

    fn expect(&self, seconds: f64) {
        self.look();
        self.task.expect(seconds);
    }
}
