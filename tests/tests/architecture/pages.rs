//! The pages of the documentation: their links lead somewhere, and the map knows them all.

use std::collections::BTreeSet;
use std::path::{Component, Path, PathBuf};

use crate::assert_no_faults;
use crate::files::{all_files, read, relative, root};

/// The map of the documentation.
const MAP: &str = "docs/README.md";

/// Folders whose pages the map links as a whole.
const LINKED_AS_A_WHOLE: [&str; 1] = ["docs/decisions"];

#[test]
fn links_between_pages_lead_to_files_and_headings() {
    let mut faults = Vec::new();
    for page in pages() {
        for link in links(&page) {
            let (file, heading) = target(&page, &link);
            if !file.exists() {
                faults.push(format!("{}: {link} is not there", relative(&page)));
            } else if let Some(heading) = heading
                && !headings(&file).contains(&heading)
            {
                faults.push(format!(
                    "{}: {link}: {} has no heading #{heading}",
                    relative(&page),
                    relative(&file)
                ));
            }
        }
    }
    assert_no_faults(&faults);
}

#[test]
fn the_map_of_the_documentation_knows_every_page() {
    let map = root().join(MAP);
    let linked: BTreeSet<PathBuf> = links(&map)
        .iter()
        .map(|link| target(&map, link).0)
        .collect();
    let faults: Vec<String> = pages()
        .into_iter()
        .filter(|page| page.starts_with(root().join("docs")) && *page != map)
        .filter(|page| !linked.contains(page))
        .filter(|page| {
            !LINKED_AS_A_WHOLE
                .iter()
                .any(|folder| page.starts_with(root().join(folder)))
        })
        .map(|page| format!("{} is not linked in {MAP}: add it there", relative(&page)))
        .collect();
    assert_no_faults(&faults);
}

/// Every page in Markdown.
fn pages() -> Vec<PathBuf> {
    let mut pages = all_files();
    pages.retain(|file| file.extension().is_some_and(|end| end == "md"));
    pages
}

/// What a page links, without addresses of the web.
fn links(page: &Path) -> Vec<String> {
    let text = read(page);
    let mut in_code = false;
    let mut found = Vec::new();
    for line in text.lines() {
        if line.trim_start().starts_with("```") {
            in_code = !in_code;
        }
        if in_code {
            continue;
        }
        for after in line.split("](").skip(1) {
            let link = after.split(')').next().unwrap_or_default();
            if !link.is_empty() && !link.contains(':') {
                found.push(link.to_owned());
            }
        }
    }
    found
}

/// The file and the heading that a link of a page names.
fn target(page: &Path, link: &str) -> (PathBuf, Option<String>) {
    let (path, heading) = link
        .split_once('#')
        .map_or((link, None), |(path, heading)| {
            (path, Some(heading.to_owned()))
        });
    if path.is_empty() {
        return (page.to_owned(), heading);
    }
    let folder = page.parent().unwrap_or(Path::new(""));
    let mut file = PathBuf::new();
    for part in folder.join(path).components() {
        match part {
            Component::ParentDir => drop(file.pop()),
            Component::CurDir => {}
            other => file.push(other),
        }
    }
    (file, heading)
}

/// The anchors of a page as GitHub makes them: lower case, blanks to hyphens, punctuation gone.
fn headings(page: &Path) -> BTreeSet<String> {
    let text = read(page);
    let mut in_code = false;
    let mut found = BTreeSet::new();
    for line in text.lines() {
        if line.starts_with("```") {
            in_code = !in_code;
        }
        let Some(title) = line.strip_prefix('#').filter(|_| !in_code) else {
            continue;
        };
        let anchor: String = title
            .trim_start_matches('#')
            .trim()
            .to_lowercase()
            .chars()
            .filter(|&c| c.is_alphanumeric() || c == ' ' || c == '-' || c == '_')
            .map(|c| if c == ' ' { '-' } else { c })
            .collect();
        found.insert(anchor);
    }
    found
}
