//! What may not be varied twice.

use std::collections::BTreeMap;

use gearmesh_geometry::InputError;
use gearmesh_geometry::input::InputDocument;

/// Refuses two of the tables called `list` that have one name, for results could not distinguish them, and two that
/// set one key, of which one would be without effect, unless only one of them varies `at_a_time`. `varied`: of each
/// table its name and its keys.
///
/// # Errors
/// [`InputError`] at the second one.
pub fn demand_each_once<'t>(
    document: &InputDocument,
    list: &str,
    varied: impl Iterator<Item = (&'t str, &'t [String])>,
    at_a_time: bool,
) -> Result<(), InputError> {
    let (mut names, mut all_keys) = (BTreeMap::new(), BTreeMap::new());
    for (i, (name, keys)) in varied.enumerate() {
        if let Some(first) = names.insert(name, i) {
            let problem = format!("`{name}` is the name of {list}.{first}, too; names must differ");
            return Err(document.error(&format!("{list}.{i}.name"), problem));
        }
        for key in keys.iter().filter(|_| !at_a_time) {
            if let Some(first) = all_keys.insert(key, i) {
                let problem = format!(
                    "`{key}` is set by {list}.{first} already; a key belongs to one {list}"
                );
                return Err(document.error(&format!("{list}.{i}.keys"), problem));
            }
        }
    }
    Ok(())
}
