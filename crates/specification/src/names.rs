//! Names of a scene's parts: what a name may be, and what to say of names that the scene does not know.

use gearmesh_geometry::InputError;
use gearmesh_geometry::input::{InputDocument, nearest};

/// Longest name, in characters.
pub const LONGEST: usize = 100;

/// Demands that the names of all parts can stand in the names of columns, which are paths in a result file. Told before
/// the run, which would otherwise fail when it writes.
///
/// # Errors
/// [`InputError`] at the first name that cannot.
pub fn check_names(document: &InputDocument) -> Result<(), InputError> {
    let tables = document.table()?;
    for (kind, value) in &tables {
        let Some(items) = value.as_array() else {
            continue;
        };
        for (i, item) in items.iter().enumerate() {
            let name = item
                .get("name")
                .into_iter()
                .map(|name| ("name".to_owned(), name));
            let listed = item.get("names").and_then(toml::Value::as_array);
            let listed = listed.into_iter().flatten().enumerate();
            let listed = listed.map(|(k, name)| (format!("names.{k}"), name));
            for (key, name) in name.chain(listed) {
                if let Some(problem) = name.as_str().and_then(name_problem) {
                    return Err(document.error(&format!("{kind}.{i}.{key}"), problem));
                }
            }
        }
    }
    Ok(())
}

/// What is wrong with a name that stands in tables only, if anything is.
pub fn label_problem(name: &str) -> Option<String> {
    let length = name.chars().count();
    (length > LONGEST).then(|| {
        format!(
            "found a name of {length} characters, allowed are {LONGEST}; it is the head of a column"
        )
    })
}

fn name_problem(name: &str) -> Option<String> {
    let length = name.chars().count();
    let found = match name {
        "" => "an empty name".to_owned(),
        "." | ".." => format!("`{name}`"),
        _ if length > LONGEST => format!("a name of {length} characters"),
        _ if name.contains('/') => format!("`{name}`"),
        _ if name.chars().any(char::is_control) => "a line break or tab".to_owned(),
        _ => return None,
    };
    Some(format!(
        "found {found}; names become parts of columns: allowed are 1 to {LONGEST} characters without / and line breaks, but not . and .."
    ))
}

/// What to say of a name that is not among the known ones: the nearest, and all of them.
pub fn unknown<S: AsRef<str>>(what: &str, found: &str, known: &[S]) -> String {
    // Of `bearing/ring` the last part alone, or other cases of letters, are near, too.
    let same = |name: &&S| {
        let (name, found) = (name.as_ref().to_lowercase(), found.to_lowercase());
        name == found || name.ends_with(&format!("/{found}"))
    };
    let near = known.iter().find(same).map(AsRef::as_ref);
    let hint = near
        .or_else(|| nearest(found, known))
        .map(|name| format!("did you mean `{name}`? "))
        .unwrap_or_default();
    let list: Vec<String> = known
        .iter()
        .map(|name| format!("`{}`", name.as_ref()))
        .collect();
    let list = if list.is_empty() {
        "none".to_string()
    } else {
        list.join(", ")
    };
    format!("there is no {what} `{found}`; {hint}the scene has {list}")
}
