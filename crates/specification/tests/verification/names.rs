//! Names of parts: what a name may be, and what is offered for an unknown one.

use gearmesh_geometry::input::InputDocument;
use gearmesh_specification::names::{LONGEST, check_names, unknown};

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
