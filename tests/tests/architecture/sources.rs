//! What a file of the project must not contain, and what it must.

use std::fs;
use std::path::PathBuf;

use crate::assert_no_faults;
use crate::files::{all_files, read, relative, root, rust_files};
use crate::packages::{packages, text};

/// No source file is longer than this; most are far shorter.
const MOST_LINES: usize = 800;

/// The only files with code that the compiler cannot check; each with its reason.
const UNCHECKED: [&str; 2] = [
    "crates/fe/src/ordering.rs",           // the C interface of METIS
    "tests/support/counting_allocator.rs", // the trait's methods are unsafe
];

/// The only files that open files to write; each with its reason.
const OPENS_FILES: [&str; 4] = [
    "crates/model/src/atomic_file.rs",   // the one place for outputs
    "crates/model/src/staged_folder.rs", // into a temporary folder
    "crates/operations/src/export/series.rs", // into a temporary folder
    "crates/python/src/meshio_exchange.rs", // into a temporary folder
];

/// Width of comments, as rustfmt.toml states it; tables, formulas and examples may be wider.
const WIDTH: usize = 120;

#[test]
fn comments_stay_within_their_width() {
    let mut faults = Vec::new();
    for file in rust_files("") {
        let mut is_fenced = false;
        for (number, line) in read(&file).lines().enumerate() {
            let Some(comment) = line.trim_start().strip_prefix("//") else {
                is_fenced = false;
                continue;
            };
            let text = comment.trim_start_matches(['/', '!']);
            if text.trim_start().starts_with("```") {
                is_fenced = !is_fenced;
            }
            let may_be_wide = is_fenced || text.starts_with("    ") || text.contains('|');
            if !may_be_wide && line.chars().count() > WIDTH {
                faults.push(format!(
                    "{}:{}: a comment wider than {WIDTH} columns",
                    relative(&file),
                    number + 1
                ));
            }
        }
    }
    assert_no_faults(&faults);
}

#[test]
fn source_files_stay_short() {
    let faults: Vec<String> = rust_files("")
        .iter()
        .map(|file| (relative(file), read(file).lines().count()))
        .filter(|(_, lines)| *lines > MOST_LINES)
        .map(|(file, lines)| {
            format!(
                "{file} has {lines} lines, more than {MOST_LINES}: split it, one concept a file"
            )
        })
        .collect();
    assert_no_faults(&faults);
}

/// A target with `test = false` is not compiled for tests; those in it would never run.
#[test]
fn targets_without_tests_have_none() {
    let mut faults = Vec::new();
    for package in packages() {
        let targets = package["targets"].as_array().expect("a list of targets");
        for target in targets.iter().filter(|target| target["test"] == false) {
            let main = PathBuf::from(text(target, "src_path"));
            let folder = relative(main.parent().expect("a source file is in a folder"));
            if !folder.ends_with("src") {
                continue;
            }
            let attribute = concat!("#[", "test]");
            let with_tests = rust_files(&folder).into_iter();
            faults.extend(
                with_tests
                    .filter(|file| read(file).contains(attribute))
                    .map(|file| format!("{}: its target has test = false", relative(&file))),
            );
        }
    }
    assert_no_faults(&faults);
}

#[test]
fn unchecked_code_stays_where_it_is_listed() {
    let keyword = concat!("un", "safe");
    let users: Vec<String> = rust_files("")
        .iter()
        .filter(|file| {
            read(file)
                .lines()
                .any(|line| words(before_comment(line)).any(|word| word == keyword))
        })
        .map(|file| relative(file))
        .collect();
    let expected: Vec<String> = UNCHECKED.iter().map(|file| (*file).to_owned()).collect();
    assert_eq!(
        users, expected,
        "only the files on the right may contain code that the compiler cannot check: write the others without it, or \
         list the file in UNCHECKED with its reason"
    );
}

/// What writes elsewhere follows links, and leaves half a file where it is killed.
#[test]
fn outputs_are_opened_in_one_place() {
    let calls = [
        concat!("File::", "create"),
        concat!("Open", "Options"),
        concat!("fs::", "write"),
    ];
    let mut faults = Vec::new();
    for file in rust_files("crates") {
        let name = relative(&file);
        if !name.contains("/src/") || OPENS_FILES.contains(&&name[..]) {
            continue;
        }
        let content = read(&file);
        let code = content.split("#[cfg(test)]").next().unwrap_or_default();
        for (index, line) in code.lines().enumerate() {
            if calls.iter().any(|call| before_comment(line).contains(call)) {
                faults.push(format!(
                    "{name}:{} opens a file to write: use write_text, write_bytes or write_by of gearmesh-model",
                    index + 1
                ));
            }
        }
    }
    assert_no_faults(&faults);
}

/// A Python that is started without isolation runs modules that lie in the working folder.
#[test]
fn children_are_started_where_they_are_isolated() {
    let call = concat!("Command::", "new(");
    let files = rust_files("crates").into_iter();
    let starters: Vec<String> = files
        .filter(|file| relative(file).contains("/src/") && read(file).contains(call))
        .map(|file| relative(&file))
        .collect();
    assert_eq!(
        starters,
        [
            "crates/cli/src/commands/doctor.rs",
            "crates/cli/src/commands/studio.rs",
            "crates/mesh/src/python.rs"
        ],
        "only these start programs: ask PythonEnvironment::command for a Python"
    );
}

#[test]
fn no_file_names_a_private_path_or_a_registry_host() {
    // Written in two parts, so that this file does not contain them.
    let paths = [
        concat!("/ho", "me/"),
        concat!("/wo", "rk/"),
        concat!("/ro", "ot/"),
        concat!("/Us", "ers/"),
    ];
    let hosts = [
        concat!("pypi", ".org"),
        concat!("pythonhosted", ".org"),
        concat!("crates", ".io"),
        concat!("npmjs", ".org"),
        concat!("npmjs", ".com"),
        concat!("deb.debian", ".org"),
    ];
    let mut faults = Vec::new();
    // cargo itself writes the registry's name into its lock.
    for file in all_files()
        .iter()
        .filter(|file| relative(file) != "Cargo.lock")
    {
        // Pictures and HDF5 files are not text.
        let Ok(content) = fs::read_to_string(file) else {
            continue;
        };
        for (index, line) in content.lines().enumerate() {
            let place = format!("{}:{}", relative(file), index + 1);
            for path in paths.iter().filter(|path| names_absolute_path(line, path)) {
                faults.push(format!("{place} names a directory of one machine ({path}): use a path inside the project"));
            }
            for host in hosts.iter().filter(|host| line.contains(*host)) {
                faults.push(format!(
                    "{place} names the registry host {host}: name the package only"
                ));
            }
        }
    }
    assert_no_faults(&faults);
}

/// What the tutorial prints of a file is the file.
#[test]
fn the_tutorial_shows_the_files_that_are_shipped() {
    let tutorial = read(&root().join("docs/first-pair.md"));
    for name in ["pinion.toml", "pair.toml"] {
        let file = read(&root().join("fe_models/first_pair").join(name));
        assert!(
            tutorial.contains(&format!("```toml\n{file}```")),
            "{name} is not what docs/first-pair.md shows"
        );
    }
}

/// What docs/extending.md prints of a file is the file.
#[test]
fn the_page_on_extending_shows_its_examples() {
    let page = read(&root().join("docs/extending.md"));
    for name in [
        "crates/cli/src/commands/schema.rs",
        "crates/drivetrain/tests/verification/conformance/examples/spring_teeth.rs",
        "crates/drivetrain/tests/verification/conformance/examples/waviness.rs",
        "crates/dynamics/tests/problems/distance_sensor.rs",
        "crates/dynamics/tests/problems/maxwell.rs",
        "crates/specification/src/system/planet_pin.rs",
        "crates/scene/tests/verification/event_positions/own_figure.rs",
    ] {
        let file = read(&root().join(name));
        assert!(
            page.contains(&format!("`{name}`")) && page.contains(&format!("```rust\n{file}```")),
            "{name} is not what docs/extending.md shows"
        );
    }
}

/// A place like `/tmp/x` in prose or code, not the middle of `docs/tmp/x`.
fn names_absolute_path(line: &str, path: &str) -> bool {
    line.match_indices(path).any(|(at, _)| {
        let before = line[..at].chars().next_back();
        !before.is_some_and(|c| c.is_alphanumeric() || "._-*)}".contains(c))
    })
}

pub fn before_comment(line: &str) -> &str {
    line.split("//").next().unwrap_or_default()
}

/// The identifiers of a line. A hyphen joins, so that a word like `x-inline` in a string is not the identifier `x`.
fn words(line: &str) -> impl Iterator<Item = &str> {
    line.split(|c: char| !(c.is_alphanumeric() || c == '_' || c == '-'))
}

/// What docs/sources.md says that a scene takes is what the scene's file says.
#[test]
fn the_page_of_sources_says_what_the_scenes_take() {
    let folder = root().join("fe_models");
    let page = read(&root().join("docs/sources.md"));
    let row = |part: &str| {
        let mut lines = page.lines();
        lines
            .find(|line| line.contains(part))
            .unwrap_or_else(|| panic!("no row on {part}"))
    };
    let value = |file: &str, key: &str| -> f64 {
        let text = read(&folder.join(file));
        let (_, after) = text.split_once(&format!("\n{key} = ")).expect(key);
        let number: String = after
            .chars()
            .take_while(|c| !c.is_whitespace() && *c != ',')
            .collect();
        number.parse().expect(key)
    };
    let (scene, study) = (
        "dynamics_17_25.toml",
        read(&folder.join("study_17_25.toml")),
    );
    let damping = value(scene, "damping_N_s_per_mm");
    assert!(row("C of 0.1 to 1 % of K").contains(&format!("| {damping} N·s/mm at K 1e6")));
    assert_eq!(value(scene, "stiffness_N_per_mm_e"), 1e6);
    // The study's head says the middle one first, then the tenth and ten times the stiffness.
    assert!(row("the peak grows with K").contains("10.3, 6.0 and 6.6 kN for K 1e5, 1e6 and 1e7"));
    assert!(
        study.contains("it is 6.0 kN as it is")
            && study.contains("10.3 and\n# 6.6 kN with a tenth and ten times")
    );
    // Seed 001's gears, 20/20.
    for file in ["bevel_gear_20_20.toml", "bevel_pinion_20_20.toml"] {
        assert_eq!(value(file, "young_GPa"), 206.0);
    }
    assert!(row("E = 2.1e11 N/mm²").contains("206 GPa"));
}
