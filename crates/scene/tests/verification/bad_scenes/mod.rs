//! Wrong multibody scenes: the whole complaint that a person reads, with file, line and key.

use crate::common;
mod files;
mod former_forms;
mod joints;
mod keys;
mod parts;
mod random_scenes;

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
