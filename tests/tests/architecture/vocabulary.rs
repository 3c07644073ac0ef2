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

/// Modules of a crate use each other in one direction: whoever reads a file needs those that it names, and those do not
/// need it.
#[test]
fn modules_form_no_circle() {
    let crates = std::fs::read_dir(root().join("crates")).unwrap();
    let names = crates.map(|entry| entry.unwrap().file_name().into_string().unwrap());
    let circles: Vec<_> = names.map(|name| (circle(&name), name)).collect();
    assert!(circles.len() > 18, "{}", circles.len());
    let found: Vec<_> = circles.iter().filter(|(c, _)| !c.is_empty()).collect();
    assert!(
        found.is_empty(),
        "these modules use each other in a circle (or wait for one): {found:?}"
    );
}

/// Modules of a crate, and those that they use, as far as they wait for each other.
fn circle(name: &str) -> BTreeMap<String, BTreeSet<String>> {
    let folder = format!("crates/{name}/src");
    let source = root().join(&folder);
    let mut uses: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for file in rust_files(&folder) {
        let inside = file.strip_prefix(&source).unwrap();
        let first = inside.iter().next().unwrap().to_string_lossy().into_owned();
        let module = first.trim_end_matches(".rs").to_owned();
        if ["lib", "main"].contains(&&*module) || module.ends_with("_tests") {
            continue;
        }
        let text = read(&file);
        let code = text.split("#[cfg(test)]").next().unwrap_or_default();
        let code: Vec<&str> = code.lines().map(before_comment).collect();
        let own = uses.entry(module.clone()).or_default();
        own.extend(used_modules(&code.join("\n")));
        own.remove(&module);
    }
    assert!(uses.len() > 1, "{folder}: {uses:?}");
    let modules: BTreeSet<String> = uses.keys().cloned().collect();
    // Items of the crate's root are no modules.
    for used in uses.values_mut() {
        used.retain(|other| modules.contains(other));
    }
    // Modules that use nothing any more go, until none is left or all that are left wait for each other.
    loop {
        let free: Vec<String> = uses
            .iter()
            .filter(|(_, used)| used.is_empty())
            .map(|(module, _)| module.clone())
            .collect();
        if free.is_empty() {
            return uses;
        }
        for module in &free {
            uses.remove(module);
        }
        for used in uses.values_mut() {
            used.retain(|module| !free.contains(module));
        }
    }
}

/// Names behind `crate::`, one or several in braces.
fn used_modules(code: &str) -> Vec<String> {
    let name = |text: &str| -> String {
        let is_part = |c: &char| c.is_ascii_lowercase() || c.is_ascii_digit() || *c == '_';
        text.trim_start().chars().take_while(is_part).collect()
    };
    let mut found = Vec::new();
    for part in code.split("crate::").skip(1) {
        let Some(list) = part.strip_prefix('{') else {
            found.push(name(part));
            continue;
        };
        let mut depth = 0;
        let mut item = String::new();
        for c in list.chars() {
            match c {
                '{' => depth += 1,
                '}' if depth == 0 => break,
                '}' => depth -= 1,
                ',' if depth == 0 => found.push(name(&std::mem::take(&mut item))),
                c => item.push(c),
            }
        }
        found.push(name(&item));
    }
    found.retain(|name| !name.is_empty());
    found
}

#[test]
fn used_modules_are_read_from_braces() {
    let code =
        "use crate::a;\nuse crate::{b, c::{D, e}, f_1::g};\nfn x() { crate::h::i(crate::J) }";
    assert_eq!(used_modules(code), ["a", "b", "c", "f_1", "h"]);
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
