//! Numbers that a dear second method of ours comes to, kept in `reference/computed`: what is compared with them runs in
//! seconds.
//!
//! A file says what it was computed from, and one that was computed from something else is not taken. One that is not
//! there is computed and written: to make a record again, delete it and run its test.

use std::path::Path;

/// The numbers recorded as `name`, computed from what `from` says.
pub fn numbers(name: &str, from: &str, compute: impl FnOnce() -> Vec<f64>) -> Vec<f64> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../reference/computed");
    let path = folder.join(format!("{name}.csv"));
    let head = format!(
        "# computed by gearmesh itself, not measured; test {name} in tests/tests/validation\n# from {}\n",
        from.replace('\n', "; ")
    );
    if !path.exists() {
        let lines: String = compute()
            .iter()
            .map(|value| format!("{value:e}\n"))
            .collect();
        std::fs::create_dir_all(folder).unwrap();
        std::fs::write(&path, head.clone() + &lines).unwrap();
    }
    let text = std::fs::read_to_string(&path).unwrap();
    let Some(lines) = text.strip_prefix(&head) else {
        panic!(
            "{} was computed from something else: delete it and run this test again",
            path.display()
        );
    };
    lines.lines().map(|line| line.parse().unwrap()).collect()
}
