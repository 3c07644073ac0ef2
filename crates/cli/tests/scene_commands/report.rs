//! `gearmesh report`.

use crate::common::{Desk, argument, run_scene, succeeds};

/// The page works without a network: nothing in it asks for another file.
#[test]
fn report_loads_nothing() {
    let desk = Desk::new();
    let (result, _) = run_scene(&desk, "");
    let strain = desk.path("strain.h5");
    succeeds(&["recover", argument(&result), "-o", argument(&strain)]);
    let report = desk.path("report.html");
    let answer = succeeds(&["report", argument(&strain), "-o", argument(&report)]);
    assert_eq!(answer.stdout, "");
    let page = std::fs::read_to_string(&report).unwrap();
    assert!(page.starts_with("<!DOCTYPE html>") && page.trim_end().ends_with("</html>"));
    for part in [
        "small pair",
        "small solid",
        "small thin rim",
        "tension",
        "compression",
    ] {
        assert!(page.contains(part), "`{part}` is not in the report");
    }
    let tight: String = page
        .to_lowercase()
        .chars()
        .filter(|c| !c.is_whitespace() && *c != '"' && *c != '\'')
        .collect();
    for load in [
        "src=http",
        "href=http",
        "src=//",
        "href=//",
        "url(http",
        "url(//",
        "<link",
        "@import",
        "import(",
        "fetch(",
        "xmlhttprequest",
    ] {
        assert!(!tight.contains(load), "the report loads by `{load}`");
    }
}
