//! `gearmesh schema`.

use crate::common::succeeds;

/// What editors ask for.
#[test]
fn schemas_are_json() {
    for (kind, keys) in [
        ("scene", ["gear_mesh", "centre_distance_mm"]),
        ("gear", ["module_mm", "bore_diameter_mm"]),
        ("bearing", ["ball_diameter_mm", "roller_length_mm"]),
        ("bevel", ["outer_module_mm", "ratio_of_roll"]),
        ("bevel-gear", ["member", "rim_mm"]),
    ] {
        let answer = succeeds(&["schema", kind]);
        assert!(
            answer.json()["$schema"]
                .as_str()
                .unwrap()
                .contains("json-schema.org")
        );
        assert!(
            keys.iter().all(|key| answer.stdout.contains(key)),
            "{answer:#?}"
        );
    }
}

/// The pages in docs/reference are what the program makes.
#[test]
fn reference_pages_are_up_to_date() {
    for kind in [
        "gear",
        "scene",
        "study",
        "bearing",
        "bevel",
        "bevel-gear",
        "model",
        "pair-result",
        "system-result",
    ] {
        let made = succeeds(&["schema", kind, "--markdown"]).stdout;
        let place = format!("docs/reference/{kind}.md");
        let file = std::path::Path::new(env!("CARGO_MANIFEST_DIR"))
            .join("../..")
            .join(&place);
        let kept = std::fs::read_to_string(file).unwrap_or_default();
        assert!(
            kept == made,
            "{place} is stale; make it again: gearmesh schema {kind} --markdown > {place}"
        );
        // A key without a word about it is no help.
        let empty: Vec<&str> = made
            .lines()
            .filter(|line| line.starts_with("| ") && line.ends_with("|  |"))
            .collect();
        assert!(empty.is_empty(), "{empty:#?}");
    }
}
