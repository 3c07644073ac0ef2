//! Each crate has a page of its own, with an example that runs.

use crate::assert_no_faults;
use crate::files::{read, root};

/// The doors: what they do is a program's or a module's.
const DOORS: [&str; 2] = ["cli", "python"];

#[test]
fn every_library_has_a_page_with_an_example() {
    let crates = root().join("crates");
    let mut faults = Vec::new();
    for entry in std::fs::read_dir(&crates).expect("crates/ is there") {
        let name = entry.expect("an entry").file_name();
        let name = name.to_string_lossy();
        let page = crates.join(&*name).join("README.md");
        if !page.is_file() {
            faults.push(format!(
                "crates/{name} has no README.md: say what it is, with an example"
            ));
            continue;
        }
        if DOORS.contains(&&*name) {
            continue;
        }
        let text = read(&page);
        if !text.contains("```rust") || !text.contains(&format!("gearmesh_{name}::")) {
            faults.push(format!(
                "crates/{name}/README.md has no example that uses the crate"
            ));
        }
        let library = read(&crates.join(&*name).join("src/lib.rs"));
        if !library.starts_with("#![doc = include_str!(\"../README.md\")]") {
            faults.push(format!(
                "crates/{name}/src/lib.rs does not begin with its README.md: the example would not be compiled"
            ));
        }
    }
    assert_no_faults(&faults);
}
