//! What a part must not know: words of the application, and modules that would make a circle.

use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

use crate::assert_no_faults;
use crate::files::{read, relative, root, rust_files};
use crate::sources::before_comment;

#[test]
fn the_finite_element_crate_knows_no_gear() {
    assert_knows_no_gear(&rust_files("crates/fe/src"));
}

#[test]
fn the_dynamics_crate_knows_no_gear() {
    assert_knows_no_gear(&rust_files("crates/dynamics/src"));
}

/// In the dynamics crate modules use each other in one direction: whoever reads a file needs those that it names, and
/// those do not need it.
#[test]
fn modules_of_the_dynamics_crate_form_no_circle() {
    let source = root().join("crates/dynamics/src");
    let mut uses: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for file in rust_files("crates/dynamics/src") {
        let inside = file.strip_prefix(&source).unwrap();
        let first = inside.iter().next().unwrap().to_string_lossy().into_owned();
        let module = first.trim_end_matches(".rs").to_owned();
        if module == "lib" || module.ends_with("_tests") {
            continue;
        }
        let text = read(&file);
        let code = text.split("#[cfg(test)]").next().unwrap_or_default();
        let own = uses.entry(module.clone()).or_default();
        for line in code.lines() {
            for part in before_comment(line).split("crate::").skip(1) {
                let name: String = part
                    .chars()
                    .take_while(|c| c.is_ascii_lowercase() || *c == '_')
                    .collect();
                if !name.is_empty() && name != module {
                    own.insert(name);
                }
            }
        }
    }
    assert!(uses.len() > 30, "{}", uses.len());
    // Modules that use nothing any more go, until none is left or all that are left wait for each other.
    loop {
        let free: Vec<String> = uses
            .iter()
            .filter(|(_, used)| used.is_empty())
            .map(|(module, _)| module.clone())
            .collect();
        if free.is_empty() {
            break;
        }
        for module in &free {
            uses.remove(module);
        }
        for used in uses.values_mut() {
            used.retain(|module| !free.contains(module));
        }
    }
    assert!(
        uses.is_empty(),
        "these modules of crates/dynamics use each other in a circle (or wait for one): {uses:?}"
    );
}

#[test]
fn the_complementarity_solver_knows_no_gear() {
    let files = rust_files("crates/contact/src");
    let solver: Vec<PathBuf> = files
        .into_iter()
        .filter(|file| relative(file).contains("nlcp"))
        .collect();
    assert_knows_no_gear(&solver);
}

fn assert_knows_no_gear(files: &[PathBuf]) {
    assert!(
        !files.is_empty(),
        "no source file found: correct the path in this test"
    );
    let mut faults = Vec::new();
    for file in files {
        for (index, line) in read(file).lines().enumerate() {
            if line.to_lowercase().replace("gearmesh", "").contains("gear") {
                faults.push(format!(
                    "{}:{} says \"gear\": this part knows bodies and contacts only; say it in general terms or move it \
                     up to the crate that knows the application",
                    relative(file),
                    index + 1
                ));
            }
        }
    }
    assert_no_faults(&faults);
}
