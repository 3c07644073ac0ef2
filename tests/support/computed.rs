//! Numbers that a dear second method of ours comes to, kept in `reference/computed`: what is compared with them runs in
//! seconds. A test program takes it in with `#[path = "…/tests/support/computed.rs"] mod computed;`.
//!
//! A file says what it was computed from, and one that was computed from something else is not taken. One that is not
//! there is computed and written: to make a record again, delete it and run its test. The line of version and day is
//! for readers and decides nothing.

use std::path::Path;
use std::process::Command;

/// The numbers recorded as `name`, computed from what `from` says.
pub fn numbers(name: &str, from: &str, compute: impl FnOnce() -> Vec<f64>) -> Vec<f64> {
    let mut folders = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors();
    let folder = folders.find_map(|at| {
        let folder = at.join("reference/computed");
        folder.is_dir().then_some(folder)
    });
    let path = folder.unwrap().join(format!("{name}.csv"));
    // Comments of a gear's file decide nothing.
    let lines = from
        .lines()
        .map(|line| line.split('#').next().unwrap().trim());
    let from: Vec<&str> = lines.filter(|line| !line.is_empty()).collect();
    let head = format!(
        "# computed by gearmesh itself, not measured; record {name} of {}\n# from {}\n",
        env!("CARGO_PKG_NAME"),
        from.join("; ")
    );
    if !path.exists() {
        let numbers: String = compute()
            .iter()
            .map(|value| format!("{value:e}\n"))
            .collect();
        let text = format!(
            "{head}# version {}, {}\n{numbers}",
            env!("CARGO_PKG_VERSION"),
            today()
        );
        std::fs::write(&path, text).unwrap();
    }
    let text = std::fs::read_to_string(&path).unwrap();
    let Some(rest) = text.strip_prefix(&head) else {
        panic!(
            "{} was computed from something else: delete it and run this test again",
            path.display()
        );
    };
    let lines = rest.lines().filter(|line| !line.starts_with('#'));
    lines.map(|line| line.parse().unwrap()).collect()
}

fn today() -> String {
    let date = Command::new("date").args(["-u", "+%F"]).output().unwrap();
    String::from_utf8(date.stdout).unwrap().trim().to_owned()
}
