//! The rules of the layout, checked: which crate may use which, what a crate must not know, what a file must not
//! contain. The reasons are in docs/decisions/0001-layout.md; a message here says what to do.

#![allow(clippy::unwrap_used, clippy::expect_used)]

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;

#[path = "architecture/one_feature_set.rs"]
mod one_feature_set;

/// The crates of the offline side: meshing, finite elements, reduction.
const OFFLINE: [&str; 3] = ["mesh", "fe", "reduction"];

/// The crates of the online side, which read a reduced model and never make one.
const ONLINE: [&str; 9] = [
    "contact",
    "bearings",
    "dynamics",
    "drivetrain",
    "recovery",
    "signal",
    "rating",
    "scene",
    "report",
];

/// What each crate may use, `gearmesh-` left out. Data walks one way, so a crate stands below all that it uses.
const ALLOWED: [(&str, &[&str]); 17] = [
    ("geometry", &[]),
    ("mesh", &["geometry"]),
    ("fe", &[]),
    ("model", &["geometry"]),
    ("reduction", &["geometry", "mesh", "fe", "model"]),
    ("contact", &["geometry", "model"]),
    ("dynamics", &[]),
    ("bearings", &["geometry", "dynamics"]),
    ("recovery", &["model", "contact"]),
    (
        "drivetrain",
        &["geometry", "model", "contact", "dynamics", "recovery"],
    ),
    ("signal", &[]),
    ("rating", &["geometry", "contact"]),
    (
        "scene",
        &[
            "geometry",
            "model",
            "contact",
            "dynamics",
            "drivetrain",
            "rating",
            "recovery",
            "signal",
        ],
    ),
    ("report", &["geometry", "model", "scene", "signal"]),
    (
        "cli",
        &[
            "bearings",
            "geometry",
            "mesh",
            "fe",
            "reduction",
            "model",
            "contact",
            "recovery",
            "signal",
            "scene",
            "report",
        ],
    ),
    (
        "python",
        &[
            "geometry",
            "mesh",
            "fe",
            "reduction",
            "model",
            "contact",
            "recovery",
            "signal",
            "scene",
            "report",
        ],
    ),
    (
        "tests",
        &[
            "geometry",
            "mesh",
            "fe",
            "reduction",
            "model",
            "contact",
            "dynamics",
            "drivetrain",
            "recovery",
            "signal",
            "scene",
            "report",
        ],
    ),
];

/// No source file is longer than this; most are far shorter.
const MOST_LINES: usize = 800;

/// The only files with code that the compiler cannot check; each with its reason.
const UNCHECKED: [&str; 2] = [
    "crates/fe/src/ordering.rs",           // the C interface of METIS
    "tests/support/counting_allocator.rs", // the trait's methods are unsafe
];

#[test]
fn crates_use_only_what_stands_below_them() {
    let allowed: BTreeMap<&str, &[&str]> = ALLOWED.into_iter().collect();
    let mut faults = Vec::new();
    for (name, uses) in gearmesh_edges(Kinds::All) {
        let Some(may_use) = allowed.get(name.as_str()) else {
            faults.push(format!("gearmesh-{name} has no row in the table ALLOWED of this test: decide what it may use"));
            continue;
        };
        for used in uses.iter().filter(|used| !may_use.contains(&used.as_str())) {
            faults.push(format!(
                "gearmesh-{name} depends on gearmesh-{used}, which the layout does not allow: move the shared part \
                 to a crate below both, or a test that needs both to tests/"
            ));
        }
    }
    assert_no_faults(&faults);
}

#[test]
fn the_online_side_never_reaches_the_offline_side() {
    let edges = gearmesh_edges(Kinds::WithoutTests);
    let mut faults = Vec::new();
    for online in ONLINE {
        assert!(
            edges.contains_key(online),
            "the crate gearmesh-{online} is gone: correct ONLINE in this test"
        );
        let reached = reachable(&edges, online);
        for offline in OFFLINE
            .into_iter()
            .filter(|&offline| reached.contains(offline))
        {
            faults.push(format!(
                "gearmesh-{online} reaches gearmesh-{offline}: the reduced model (gearmesh-model) is the only bridge; \
                 put what is needed online into it"
            ));
        }
    }
    assert_no_faults(&faults);
}

#[test]
fn hdf5_is_used_by_the_model_crate_only() {
    let users: Vec<String> = packages()
        .iter()
        .filter(|package| {
            dependencies(package, Kinds::All)
                .iter()
                .any(|name| name.starts_with("hdf5"))
        })
        .map(|package| text(package, "name").to_owned())
        .collect();
    assert_eq!(
        users,
        ["gearmesh-model"],
        "HDF5 belongs to gearmesh-model alone: call its reading and writing helpers, or add one there"
    );
}

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

/// Which dependencies of a package count.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Kinds {
    All,
    WithoutTests,
}

/// What README's tutorial prints of a file is the file.
#[test]
fn the_tutorial_shows_the_files_that_are_shipped() {
    let readme = read(&root().join("README.md"));
    for name in ["pinion.toml", "pair.toml"] {
        let file = read(&root().join("fe_models/first_pair").join(name));
        assert!(
            readme.contains(&format!("```toml\n{file}```")),
            "{name} is not what README.md shows"
        );
    }
}

/// The packages of the workspace as `cargo metadata` lists them.
fn packages() -> Vec<Value> {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let output = Command::new(cargo)
        .current_dir(root())
        .args(["metadata", "--no-deps", "--format-version", "1"])
        .output()
        .expect("cargo starts");
    assert!(
        output.status.success(),
        "cargo metadata failed: {}",
        String::from_utf8_lossy(&output.stderr)
    );
    let metadata: Value =
        serde_json::from_slice(&output.stdout).expect("cargo metadata prints JSON");
    metadata["packages"]
        .as_array()
        .expect("a list of packages")
        .clone()
}

fn text<'a>(value: &'a Value, key: &str) -> &'a str {
    value[key]
        .as_str()
        .unwrap_or_else(|| panic!("cargo metadata has no text `{key}`"))
}

fn dependencies(package: &Value, kinds: Kinds) -> BTreeSet<String> {
    let listed = package["dependencies"]
        .as_array()
        .expect("a list of dependencies");
    let counts =
        |dependency: &&Value| kinds == Kinds::All || dependency["kind"].as_str() != Some("dev");
    listed
        .iter()
        .filter(counts)
        .map(|dependency| text(dependency, "name").to_owned())
        .collect()
}

/// Crate to the gearmesh crates it names, both without the prefix.
fn gearmesh_edges(kinds: Kinds) -> BTreeMap<String, BTreeSet<String>> {
    let short = |name: &str| name.strip_prefix("gearmesh-").map(str::to_owned);
    let edges: BTreeMap<_, _> = packages()
        .iter()
        .filter_map(|package| {
            let uses = dependencies(package, kinds)
                .iter()
                .filter_map(|name| short(name))
                .collect();
            Some((short(text(package, "name"))?, uses))
        })
        .collect();
    assert!(
        edges.len() >= ALLOWED.len(),
        "cargo metadata lists too few crates: {:?}",
        edges.keys()
    );
    edges
}

fn reachable(edges: &BTreeMap<String, BTreeSet<String>>, from: &str) -> BTreeSet<String> {
    let mut reached = BTreeSet::new();
    let mut open = vec![from.to_owned()];
    while let Some(name) = open.pop() {
        for next in edges.get(&name).into_iter().flatten() {
            if reached.insert(next.clone()) {
                open.push(next.clone());
            }
        }
    }
    reached
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

fn assert_no_faults(faults: &[String]) {
    assert!(faults.is_empty(), "\n{}\n", faults.join("\n"));
}

/// A place like `/tmp/x` in prose or code, not the middle of `docs/tmp/x`.
fn names_absolute_path(line: &str, path: &str) -> bool {
    line.match_indices(path).any(|(at, _)| {
        let before = line[..at].chars().next_back();
        !before.is_some_and(|c| c.is_alphanumeric() || "._-*)}".contains(c))
    })
}

fn before_comment(line: &str) -> &str {
    line.split("//").next().unwrap_or_default()
}

/// The identifiers of a line. A hyphen joins, so that a word like `x-inline` in a string is not the identifier `x`.
fn words(line: &str) -> impl Iterator<Item = &str> {
    line.split(|c: char| !(c.is_alphanumeric() || c == '_' || c == '-'))
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .parent()
        .expect("tests/ is inside the project")
        .to_owned()
}

fn relative(file: &Path) -> String {
    file.strip_prefix(root())
        .unwrap_or(file)
        .to_string_lossy()
        .into_owned()
}

fn read(file: &Path) -> String {
    fs::read_to_string(file).unwrap_or_else(|error| panic!("{}: {error}", file.display()))
}

fn rust_files(below: &str) -> Vec<PathBuf> {
    let dir = root().join(below);
    let is_wanted =
        |file: &PathBuf| file.starts_with(&dir) && file.extension().is_some_and(|end| end == "rs");
    all_files().into_iter().filter(is_wanted).collect()
}

/// Every file that belongs to the project, sorted: what git lists, or, in an unpacked archive, what lies there
/// without the directories that are made.
fn all_files() -> Vec<PathBuf> {
    let listed = Command::new("git")
        .current_dir(root())
        .args([
            "ls-files",
            "-z",
            "--cached",
            "--others",
            "--exclude-standard",
        ])
        .output();
    let mut files = match listed {
        Ok(output) if output.status.success() => String::from_utf8_lossy(&output.stdout)
            .split_terminator('\0')
            .map(|name| root().join(name))
            .filter(|file| file.is_file())
            .collect(),
        _ => {
            let mut files = Vec::new();
            walk(&root(), &mut files);
            files
        }
    };
    files.sort();
    assert!(!files.is_empty(), "no files found in {}", root().display());
    files
}

fn walk(dir: &Path, files: &mut Vec<PathBuf>) {
    const MADE: [&str; 5] = [".git", ".venv", "target", "out", "__pycache__"];
    for entry in fs::read_dir(dir).expect("a readable directory") {
        let path = entry.expect("a readable entry").path();
        let is_made = path
            .file_name()
            .is_some_and(|name| MADE.iter().any(|made| name == *made));
        if is_made || path.is_symlink() {
            continue;
        }
        if path.is_dir() {
            walk(&path, files);
        } else {
            files.push(path);
        }
    }
}
