//! `gearmesh report`.

use crate::common::{Desk, argument, gearmesh, refused, run_scene, succeeds};

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
    // The picture in space unpacks its scripts from the page itself, into blobs.
    let unpacked = "import((awaitaddresses)(name))";
    assert!(tight.contains("url.createobjecturl(") && tight.matches(unpacked).count() == 1);
    let tight = tight.replace(unpacked, "");
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

/// Two results by the names of their files, with what each felt over the flank, and the stress of both gears.
#[test]
fn results_stand_side_by_side() {
    let desk = Desk::new();
    let (result, _) = run_scene(&desk, "");
    let other = desk.path("other.h5");
    std::fs::copy(&result, &other).unwrap();
    let page = desk.path("page.html");
    let words = [
        "report",
        argument(&result),
        argument(&other),
        "-o",
        argument(&page),
    ];
    let told = succeeds(&[&words[..], &["--stress", "--json"]].concat()).json();
    let html = std::fs::read_to_string(&page).unwrap();
    for part in [
        "Gear pairs side by side",
        "\"name\":\"result.h5, 60 N·m\"",
        "\"name\":\"other.h5, 60 N·m\"",
        "contact pattern</h2>",
        "Largest Hertz pressure at 60 N·m",
        "Largest line load at 60 N·m",
        "largest von Mises stress over the width",
    ] {
        assert!(html.contains(part), "{part}");
    }
    assert!(html.find("side by side") < html.find("small pair: transmission error"));
    // Both gears of both results.
    assert_eq!(
        html.matches("von Mises stress over the width</figcaption>")
            .count(),
        4
    );
    let seen = |words: &str| html.matches(words).count();
    assert_eq!(
        seen("cut in the middle of the face, seen from the +z: first principal"),
        4
    );
    assert_eq!(
        seen("right side: von Mises stress, 60 N·m, driver angle"),
        4
    );
    // Where the root stress is largest, not where it is at another angle.
    let root = |told: &serde_json::Value, gear: usize| {
        told["stress"][gear]["root_von_Mises_MPa"].as_f64().unwrap()
    };
    let alone = [&words[..2], &words[3..], &["--stress", "--json"]].concat();
    let at = |angle: &str| succeeds(&[&alone[..], &["--stress-angle-deg", angle]].concat()).json();
    let other = at("12.0");
    for gear in 0..2 {
        assert_eq!(root(&told, gear), root(&told, gear + 2));
        assert!(root(&told, gear) > root(&other, gear), "{told} {other}");
    }
    let unused = [&alone[..], &["--stress-at-s", "1"]].concat();
    refused(
        &gearmesh(&unused),
        2,
        &["--stress-at-s", "--stress-angle-deg"],
    );
}
