//! Names that a scene does not know.

/// Similarity (Jaro-Winkler, 0 to 1) from which a known name is offered as the one that was meant.
const SIMILAR: f64 = 0.8;

/// What to say of a name that is not among the known ones: the nearest, and all of them.
pub(crate) fn unknown<S: AsRef<str>>(what: &str, found: &str, known: &[S]) -> String {
    let nearest = known
        .iter()
        .map(|name| (strsim::jaro_winkler(found, name.as_ref()), name.as_ref()))
        .filter(|(similarity, _)| *similarity >= SIMILAR)
        .max_by(|a, b| a.0.total_cmp(&b.0));
    let hint = nearest
        .map(|(_, name)| format!("did you mean `{name}`? "))
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
mod tests {
    use super::*;

    #[test]
    fn the_nearest_name_is_offered() {
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
