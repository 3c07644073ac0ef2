//! The rules of the layout, checked: which crate may use which, what a crate must not know, what a file must not
//! contain. The reasons are in docs/decisions/0001-layout.md; a message here says what to do.

#![allow(clippy::unwrap_used, clippy::expect_used)]

use std::collections::{BTreeMap, BTreeSet};

use packages::{Kinds, dependencies, packages, text};

#[path = "architecture/crate_pages.rs"]
mod crate_pages;
#[path = "architecture/files.rs"]
mod files;
#[path = "architecture/one_feature_set.rs"]
mod one_feature_set;
#[path = "architecture/packages.rs"]
mod packages;
#[path = "architecture/pages.rs"]
mod pages;
#[path = "architecture/sources.rs"]
mod sources;
#[path = "architecture/vocabulary.rs"]
mod vocabulary;

/// The crates of the offline side: meshing, finite elements, reduction.
const OFFLINE: [&str; 3] = ["mesh", "fe", "reduction"];

/// The crates of the online side, which read a reduced model and never make one.
const ONLINE: [&str; 10] = [
    "contact",
    "bearings",
    "dynamics",
    "drivetrain",
    "recovery",
    "signal",
    "rating",
    "specification",
    "scene",
    "report",
];

/// What each crate may use, `gearmesh-` left out. Data walks one way, so a crate stands below all that it uses.
const ALLOWED: [(&str, &[&str]); 23] = [
    ("elements", &[]),
    ("geometry", &["elements"]),
    ("mesh", &["bevel", "elements", "geometry"]),
    ("fe", &["elements"]),
    ("model", &["elements", "geometry"]),
    ("reduction", &["bevel", "geometry", "mesh", "fe", "model"]),
    ("contact", &["geometry", "model"]),
    ("dynamics", &[]),
    ("bearings", &["geometry", "dynamics"]),
    ("bevel", &["geometry"]),
    ("recovery", &["model", "contact"]),
    (
        "drivetrain",
        &[
            "bearings", "bevel", "geometry", "model", "contact", "dynamics", "recovery",
        ],
    ),
    ("signal", &[]),
    ("rexs", &[]),
    ("rating", &["geometry", "contact"]),
    (
        "specification",
        &[
            "bearings",
            "geometry",
            "contact",
            "dynamics",
            "drivetrain",
            "rating",
        ],
    ),
    (
        "scene",
        &[
            "bearings",
            "bevel",
            "geometry",
            "model",
            "contact",
            "dynamics",
            "drivetrain",
            "rating",
            "recovery",
            "signal",
            "specification",
        ],
    ),
    (
        "report",
        &[
            "geometry",
            "model",
            "contact",
            "scene",
            "signal",
            "specification",
        ],
    ),
    (
        "operations",
        &[
            "bearings",
            "bevel",
            "geometry",
            "mesh",
            "fe",
            "reduction",
            "model",
            "contact",
            "drivetrain",
            "recovery",
            "scene",
            "specification",
            "report",
            "rexs",
        ],
    ),
    (
        "studio",
        &[
            "geometry",
            "model",
            "operations",
            "scene",
            "specification",
            "signal",
            "report",
        ],
    ),
    (
        "cli",
        &[
            "bearings",
            "bevel",
            "geometry",
            "mesh",
            "fe",
            "reduction",
            "model",
            "contact",
            "operations",
            "signal",
            "scene",
            "specification",
            "report",
            "rexs",
            "studio",
        ],
    ),
    (
        "python",
        &[
            "geometry",
            "fe",
            "model",
            "operations",
            "scene",
            "specification",
            "report",
        ],
    ),
    (
        "tests",
        &[
            "bearings",
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

fn assert_no_faults(faults: &[String]) {
    assert!(faults.is_empty(), "\n{}\n", faults.join("\n"));
}
