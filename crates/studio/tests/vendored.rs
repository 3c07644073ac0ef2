//! The libraries of the page stand as their makers published them.
#![allow(clippy::unwrap_used, missing_docs)]

use sha2::{Digest, Sha256};

/// SHA-256 of the files in the npm packages three 0.184.0 and uplot 1.6.32.
const PUBLISHED: [(&str, &str); 4] = [
    (
        "three.module.min.js",
        "36a60b0120335f89a80a0dab70292292b0ec414b3d05e83cd09a3ea428c6712a",
    ),
    (
        "three.core.min.js",
        "6486aa0d719cfa87ec88dc47223b59b1fb8417a1a407fc0e52467c943e2f8cc9",
    ),
    (
        "uplot.js",
        "19c8d4c6ad88929a79f4ae49d6f7161566dfd0ba3d15cc495e974f787eb78f1f",
    ),
    (
        "uplot.css",
        "df630c6a8d6f8eeaff264b50f73ce5b114f646ffd9a0bb74f049b0a00135fa04",
    ),
];

#[test]
fn libraries_are_as_published() {
    for (name, published) in PUBLISHED {
        let asset = gearmesh_studio::assets().find(|asset| asset.name == name);
        let digest = Sha256::digest(asset.unwrap().text.as_bytes());
        let found: String = digest.iter().map(|byte| format!("{byte:02x}")).collect();
        assert_eq!(found, published, "{name}");
    }
    let licence = include_str!("../../report/assets/three-LICENSE.txt");
    assert!(licence.contains("The MIT License"));
}

/// Nothing is loaded from elsewhere, and what is named is there.
#[test]
fn pages_name_only_their_own_files() {
    let names: Vec<&str> = gearmesh_studio::assets().map(|asset| asset.name).collect();
    for asset in gearmesh_studio::assets() {
        if asset.name.starts_with("three") || asset.name.starts_with("uplot") {
            continue;
        }
        for (before, after) in [("href=\"", '"'), ("src=\"", '"'), ("from \"./", '"')] {
            for part in asset.text.split(before).skip(1) {
                let named = part.split(after).next().unwrap();
                if named.starts_with('#') || named.starts_with('/') && named == "/" {
                    continue;
                }
                let name = named
                    .trim_start_matches("/assets/")
                    .trim_start_matches("assets/");
                assert!(
                    names.contains(&name),
                    "{}: {named} is not among {names:?}",
                    asset.name
                );
            }
        }
        assert!(
            !asset.text.contains("https://"),
            "{} names another server",
            asset.name
        );
    }
}
