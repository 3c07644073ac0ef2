//! `gearmesh schema`.

use crate::common::succeeds;

/// What editors ask for.
#[test]
fn schemas_are_json() {
    for (kind, keys) in [
        ("scene", ["gear_mesh", "centre_distance_mm"]),
        ("gear", ["module_mm", "bore_diameter_mm"]),
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
