//! Python functions that a multibody run calls: loads and motions over time, laws of elements.

use gearmesh_specification::host_functions::{
    Derivatives, ElementFailure, HostFunctions, HostLaw, HostMotion, TimeCall,
};
use std::collections::BTreeMap;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Instant;

use pyo3::exceptions::{PyException, PyTypeError};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::errors::WorkError;

/// What a failed function of time gives: the step that asked cannot go on.
const FAILED: Derivatives = Derivatives {
    value: f64::NAN,
    rate: f64::NAN,
    acceleration: f64::NAN,
};

/// The first exception of all functions, after which none is called any more.
#[derive(Default)]
struct FirstFailure {
    is_there: AtomicBool,
    raised: Mutex<Option<(String, PyErr)>>,
}

/// A function, how often it was called and for how long.
struct Called {
    name: String,
    function: Py<PyAny>,
    calls: AtomicU64,
    nanoseconds: AtomicU64,
    failure: Arc<FirstFailure>,
}

impl Called {
    /// What the function gives; none where it, or another one before, has raised.
    fn call<T>(
        &self,
        time_s: f64,
        ask: impl FnOnce(&Bound<'_, PyAny>) -> PyResult<T>,
    ) -> Option<T> {
        if self.failure.is_there.load(Ordering::Relaxed) {
            return None;
        }
        let begun = Instant::now();
        let found = Python::attach(|py| ask(self.function.bind(py)));
        let took = u64::try_from(begun.elapsed().as_nanos()).unwrap_or(u64::MAX);
        self.calls.fetch_add(1, Ordering::Relaxed);
        self.nanoseconds.fetch_add(took, Ordering::Relaxed);
        found
            .map_err(|error| {
                self.failure.is_there.store(true, Ordering::Relaxed);
                let mut raised = lock(&self.failure.raised);
                let what = format!("Python function `{}` at t = {time_s} s", self.name);
                raised.get_or_insert((what, error));
            })
            .ok()
    }

    fn at(&self, time_s: f64) -> Derivatives {
        let found = self.call(time_s, |function| derivatives(&function.call1((time_s,))?));
        found.unwrap_or(FAILED)
    }

    fn load(&self, motion: &HostMotion) -> Result<[f64; 6], ElementFailure> {
        let found = self.call(motion.time_s, |function| {
            let told = (
                motion.time_s,
                motion.displacement_m,
                motion.rotation_rad,
                motion.velocity_m_per_s,
                motion.angular_velocity_rad_per_s,
            );
            load(&function.call1(told)?)
        });
        found.ok_or_else(|| format!("Python function `{}` has failed", self.name).into())
    }
}

/// A number, or value, rate and acceleration.
fn derivatives(found: &Bound<'_, PyAny>) -> PyResult<Derivatives> {
    if let Ok(value) = found.extract::<f64>() {
        // Loads need no more; a motion that is given no more is refused before it begins.
        return Ok(Derivatives { value, ..FAILED });
    }
    match found.extract::<[f64; 3]>() {
        Ok([value, rate, acceleration]) => Ok(Derivatives {
            value,
            rate,
            acceleration,
        }),
        Err(_) => Err(PyTypeError::new_err(format!(
            "it returned {}; a load's function returns a number, a motion's (value, rate, acceleration)",
            found.repr()?
        ))),
    }
}

/// Force and moment, three numbers each.
fn load(found: &Bound<'_, PyAny>) -> PyResult<[f64; 6]> {
    match found.extract::<([f64; 3], [f64; 3])>() {
        Ok((f, m)) => Ok([f[0], f[1], f[2], m[0], m[1], m[2]]),
        Err(_) => Err(PyTypeError::new_err(format!(
            "it returned {}; an element's function returns (force_N, moment_Nm), three numbers each",
            found.repr()?
        ))),
    }
}

/// The functions of a run.
#[derive(Default, Clone)]
pub(crate) struct Functions(Vec<Arc<Called>>);

impl Functions {
    /// The functions of a dict, by name.
    pub(crate) fn of(functions: Option<&Bound<'_, PyDict>>) -> PyResult<Self> {
        let failure = Arc::new(FirstFailure::default());
        let called = functions.into_iter().flatten().map(|(name, function)| {
            Ok(Arc::new(Called {
                name: name.extract()?,
                function: function.unbind(),
                calls: AtomicU64::new(0),
                nanoseconds: AtomicU64::new(0),
                failure: Arc::clone(&failure),
            }))
        });
        Ok(Self(called.collect::<PyResult<_>>()?))
    }

    /// As a scene takes them. Which is a function of time and which a law is for the scene to say.
    pub(crate) fn for_scene(&self, identity: String) -> HostFunctions {
        let mut host = HostFunctions {
            identity,
            ..HostFunctions::default()
        };
        for called in &self.0 {
            let (of_time, law) = (Arc::clone(called), Arc::clone(called));
            let of_time: Arc<TimeCall> = Arc::new(move |time_s| of_time.at(time_s));
            let law: Arc<HostLaw> = Arc::new(move |motion: &HostMotion| law.load(motion));
            host.of_time.insert(called.name.clone(), of_time);
            host.laws.insert(called.name.clone(), law);
        }
        host
    }

    /// The outcome of what has called them: where one has raised, `WorkError` with that exception as its cause, or the
    /// exception itself where it is none of the usual ones (Ctrl-C).
    pub(crate) fn judge<T>(&self, outcome: PyResult<T>) -> PyResult<T> {
        let Some((what, error)) = self.0.first().and_then(|called| {
            let mut raised = lock(&called.failure.raised);
            raised.take()
        }) else {
            return outcome;
        };
        Err(Python::attach(|py| {
            if !error.is_instance_of::<PyException>(py) {
                return error;
            }
            let kind = error.get_type(py).name().map(|name| name.to_string());
            let kind = kind.unwrap_or_default();
            let failed = WorkError::new_err(format!("{what} raised {kind}: {}", error.value(py)));
            failed.set_cause(py, Some(error));
            failed
        }))
    }

    /// Calls and seconds of each.
    pub(crate) fn cost(&self) -> BTreeMap<String, (u64, f64)> {
        let cost = |called: &Arc<Called>| {
            let calls = called.calls.load(Ordering::Relaxed);
            let seconds = 1e-9 * called.nanoseconds.load(Ordering::Relaxed) as f64;
            (called.name.clone(), (calls, seconds))
        };
        self.0.iter().map(cost).collect()
    }
}

fn lock<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
