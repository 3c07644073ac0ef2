//! Functions of the calling program that a scene names: `python = "NAME"` in place of a function of time, and
//! `[[python_element]]`. The program `gearmesh` has none; the Python package registers those of its caller.

use std::collections::BTreeMap;
use std::fmt;
use std::sync::Arc;

use gearmesh_dynamics::HostFunction;
// What a caller needs to make such functions.
pub use gearmesh_dynamics::elements::{HostLaw, HostMotion};
pub use gearmesh_dynamics::{Derivatives, ElementFailure, TimeCall};

use crate::names::unknown;

/// The functions by name.
#[derive(Clone, Default)]
pub struct HostFunctions {
    /// Functions of time: value, rate and acceleration, in the unit of the key that names them.
    pub of_time: BTreeMap<String, Arc<TimeCall>>,
    /// Laws of elements, in SI units.
    pub laws: BTreeMap<String, Arc<HostLaw>>,
    /// What tells these functions from others: a run that was begun with others is not resumed.
    pub identity: String,
}

impl HostFunctions {
    /// Whether there is none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.of_time.is_empty() && self.laws.is_empty()
    }

    /// A function of time.
    ///
    /// # Errors
    /// What to say where it is not there.
    pub fn of_time(&self, name: &str) -> Result<HostFunction, String> {
        let call = self.of_time.get(name);
        let call = call.ok_or_else(|| missing(name, self.of_time.keys()))?;
        Ok(HostFunction::new(name, Arc::clone(call)))
    }

    /// A law.
    ///
    /// # Errors
    /// What to say where it is not there.
    pub fn law(&self, name: &str) -> Result<Arc<HostLaw>, String> {
        let law = self.laws.get(name);
        let law = law.ok_or_else(|| missing(name, self.laws.keys()))?;
        Ok(Arc::clone(law))
    }
}

fn missing<'a>(name: &str, known: impl Iterator<Item = &'a String>) -> String {
    let known: Vec<&String> = known.collect();
    if known.is_empty() {
        return format!(
            "names the Python function `{name}`, which only a run from Python can call: gearmesh.Scene(FILE, functions={{\"{name}\": ...}}).run(). \
             Here give a number, linear, step, sine or table"
        );
    }
    unknown("Python function", name, &known)
}

impl fmt::Debug for HostFunctions {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let names = self.of_time.keys().chain(self.laws.keys());
        formatter.debug_set().entries(names).finish()
    }
}
