//! Functions of the program that calls this library, for loads and prescribed motion: what no closed form or table
//! gives.

use std::fmt;
use std::sync::Arc;

use crate::derivatives::Derivatives;

/// What the calling program computes: value, rate and acceleration at a time \[s\]. Must depend on the time alone.
/// Numbers that are not finite say that it has failed; the step, and with it the run, then ends.
pub type TimeCall = dyn Fn(f64) -> Derivatives + Send + Sync;

/// A function of time under its name.
#[derive(Clone)]
pub struct HostFunction {
    /// Name, for messages.
    pub name: String,
    call: Arc<TimeCall>,
}

impl HostFunction {
    /// Gives a function its name.
    #[must_use]
    pub fn new(name: &str, call: Arc<TimeCall>) -> Self {
        Self {
            name: name.to_owned(),
            call,
        }
    }

    /// Value and derivatives at a time.
    #[must_use]
    pub fn at(&self, time_s: f64) -> Derivatives {
        (self.call)(time_s)
    }
}

impl fmt::Debug for HostFunction {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "HostFunction({:?})", self.name)
    }
}

/// The same if they are one function, not two that happen to be alike.
impl PartialEq for HostFunction {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name && Arc::ptr_eq(&self.call, &other.call)
    }
}
