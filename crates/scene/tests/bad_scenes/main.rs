//! Wrong multibody scenes: the whole complaint that a person reads, with file, line and key.
#![allow(clippy::unwrap_used, clippy::expect_used, missing_docs)]

#[path = "../common/mod.rs"]
mod common;
mod files;
mod former_forms;
mod joints;
mod keys;
mod parts;
#[path = "../../../../tests/support/property_cases.rs"]
mod property_cases;
mod random_scenes;
#[path = "../system_runs/mod.rs"]
mod system_runs;

use common::*;

/// The scene of two wheels in which `from` became `to` is refused at the line of `at` with all `parts`.
#[track_caller]
pub fn refused((from, to): (&str, &str), at: &str, parts: &[&str]) {
    let scene = changed(&text("scene_two_wheels.toml"), from, to);
    let complaint = build(&scene)
        .err()
        .unwrap_or_else(|| panic!("accepted:\n{scene}"))
        .to_string();
    let place = format!("scene.toml:{}: ", line_of(&scene, at));
    for part in [place.as_str()].iter().chain(parts) {
        assert!(complaint.contains(part), "`{part}` is not in\n{complaint}");
    }
}
