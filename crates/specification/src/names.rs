//! Names of a scene's parts: what a name may be, and what to say of names that the scene does not know.

use gearmesh_geometry::InputError;
use gearmesh_geometry::input::{InputDocument, nearest};

/// Longest name, in characters.
const LONGEST: usize = 100;

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

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn names_that_are_no_part_of_a_path_are_refused() {
        let judge = |name: &str| {
            let text = format!(
                "[[body]]\nname = \"a\"\n[[joint]]\nname = {}\n",
                toml::Value::from(name)
            );
            check_names(&InputDocument::new("s.toml", text)).map_err(|error| error.to_string())
        };
        for name in [
            "shaft 1",
            "Ritzel, vorn",
            "a.b",
            "...",
            &"é".repeat(LONGEST),
        ] {
            assert_eq!(judge(name), Ok(()), "{name}");
        }
        for (name, found) in [
            ("..", "found `..`;"),
            (".", "found `.`;"),
            ("", "an empty name"),
            ("a/b", "found `a/b`;"),
            ("a\nb", "a line break"),
            (&"x".repeat(65_535), "a name of 65535 characters"),
        ] {
            let complaint = judge(name).unwrap_err();
            let begins = "s.toml:4: joint.0.name: found";
            assert!(
                complaint.starts_with(begins) && complaint.contains(found),
                "{complaint}"
            );
        }
    }

    #[test]
    fn the_nearest_name_is_offered() {
        for found in ["pair/rng", "pear/ring", "pair_ring", "ring", "PAIR/Ring"] {
            let text = unknown("body", found, &["ground", "shaft", "pair/ring"]);
            assert!(
                text.contains("did you mean `pair/ring`?"),
                "{found}: {text}"
            );
        }
        let text = unknown("body", "pinoin", &["ground", "pinion", "wheel"]);
        assert_eq!(
            text,
            "there is no body `pinoin`; did you mean `pinion`? the scene has `ground`, `pinion`, `wheel`"
        );
        assert_eq!(
            unknown::<&str>("motion", "a", &[]),
            "there is no motion `a`; the scene has none"
        );
    }
}
