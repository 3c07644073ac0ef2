//! `gearmesh studio` without a browser: figures as those of `gearmesh run`, and what the server refuses or survives.

mod beginning;
mod columns;
mod figures;
mod refusals;
mod server;
mod work;

use serde_json::Value;

use crate::common::{Desk, argument, succeeds, workshop};
use server::Studio;

/// What does not depend on the clock.
fn timeless(mut figures: Value) -> Value {
    figures.as_object_mut().unwrap().remove("seconds");
    figures
}

fn pair_scene(desk: &Desk) -> std::path::PathBuf {
    desk.file("pair.toml", workshop().scene(""))
}

fn printed(desk: &Desk, text: &str) -> Value {
    let scene = desk.file("changed.toml", text);
    let output = desk.path("changed.h5");
    timeless(succeeds(&["run", argument(&scene), "-o", argument(&output), "--json"]).json())
}
