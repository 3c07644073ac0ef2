//! Files that are broken, hostile or incomplete are refused with where and what, and nothing panics.

use crate::containers::zipped;
use crate::{GEARBOX, changed, message, read, small};
use gearmesh_rexs::{Meshes, import};

fn refused(text: &str, words: &[&str]) {
    let found = message(text.as_bytes().to_vec());
    for word in words {
        assert!(found.contains(word), "`{word}` is not in: {found}");
    }
}

#[test]
fn what_is_no_rexs_file() {
    refused("", &["no REXS file", "nothing"]);
    refused("title = 1", &["text that begins with `t`"]);
    refused(
        "<model version=\"1.4\"><components>",
        &["line 1", "broken XML"],
    );
    refused("<html/>", &["line 1", "<model>"]);
    refused("{\"model\": {\"version\":", &["line 1", "broken JSON"]);
    refused("{\"a\": 1}", &["key `model`"]);
    refused(
        "{\"model\": {\"version\": \"1.4\", \"components\": 3}}",
        &["`components` is no list"],
    );
    // Cut in the middle: the line at which it ends.
    let half = &GEARBOX[..GEARBOX.len() / 2];
    let line = format!("line {}:", half.lines().count());
    refused(half, &[&line, "the text ends here, before </model>"]);
    let found = message(vec![b'<', 0xff, b'>']);
    assert!(found.contains("from byte 1 on"), "{found}");
    let found = message(b"PK\x03\x04 broken".to_vec());
    assert!(found.contains("zip file that cannot be read"), "{found}");
    let found = message(zipped(&[("readme.txt", b"hello")]));
    assert!(
        found.contains("without a member that ends in .rexs"),
        "{found}"
    );
    for name in ["../x.rexs", "/etc/x.rexs", "a/../../x.rexs", "..\\x.rexs"] {
        let found = message(zipped(&[(name, b"<model/>")]));
        assert!(
            found.contains(name) && found.contains("outside of the archive"),
            "{found}"
        );
    }
    let found = message(zipped(&[("a.rexs", b"<model/>"), ("b.rexs", b"<model/>")]));
    assert!(found.contains("a zip file of 2 models"), "{found}");
    refused("<model version=\"1.4\"/>", &["nothing to import"]);
}

#[test]
fn entities_and_depth() {
    let bomb = "<?xml version=\"1.0\"?><!DOCTYPE m [<!ENTITY a \"aaaaaaaaaa\"><!ENTITY b \"&a;&a;&a;&a;&a;&a;&a;&a;\">]><model version=\"1.4\">&b;</model>";
    refused(bomb, &["line 1", "document type", "<!DOCTYPE m"]);
    let named = changed(
        GEARBOX,
        "<model ",
        "<!DOCTYPE model SYSTEM \"rexs.dtd\">\n<model ",
    );
    refused(
        &named,
        &[
            "line 3:",
            "`<!DOCTYPE model SYSTEM \"rexs.dtd\"`",
            "Take it out",
        ],
    );
    let deep = format!("<model version=\"1.4\">{}", "<relations>\n".repeat(100_000));
    refused(&deep, &["line 6", "deep in each other"]);
    let deep = format!("{{\"model\":{}", "[".repeat(100_000));
    refused(&deep, &["broken JSON"]);
}

#[test]
fn versions_that_are_not_known() {
    for version in ["0.9", "1.8", "3.0", "x", "1.x"] {
        let text = changed(
            GEARBOX,
            "version=\"1.7\"",
            &format!("version=\"{version}\""),
        );
        refused(&text, &[version, "1.0 to 1.7 and 2.x"]);
    }
    let newer = changed(GEARBOX, "version=\"1.7\"", "version=\"2.3.0\"");
    assert!(
        read(&newer)
            .ledger
            .assumed
            .iter()
            .any(|e| e.text.contains("2.3.0 is newer"))
    );
}

#[test]
fn numbers_and_units() {
    let line = GEARBOX
        .lines()
        .position(|l| l.contains("id=\"normal_module\""))
        .unwrap()
        + 1;
    let at = format!("line {line}:");
    let change = |to: &str| GEARBOX.replacen("id=\"normal_module\" unit=\"mm\">2<", to, 1);
    refused(
        &change("id=\"normal_module\" unit=\"furlong\">2<"),
        &[&at, "pinion 17", "`furlong`", "allowed are mm, m"],
    );
    refused(
        &change("id=\"normal_module\" unit=\"m\">1e300<"),
        &[&at, "pinion 17", "1e303 mm", "allowed is up to 1e7 mm"],
    );
    refused(
        &change("id=\"normal_module\" unit=\"kg\">2<"),
        &["normal_module", "`kg`"],
    );
    refused(
        &change("id=\"normal_module\" unit=\"mm\">two<"),
        &[&at, "`two` is no number"],
    );
    refused(
        &change("id=\"normal_module\" unit=\"mm\">NaN<"),
        &["normal_module is missing"],
    );
    refused(
        &change("id=\"normal_module\" unit=\"mm\">-2<"),
        &["module is -2 mm"],
    );
    refused(
        &change("id=\"no_module\" unit=\"mm\">2<"),
        &["normal_module is missing"],
    );
    let teeth = GEARBOX.replacen(
        "number_of_teeth\" unit=\"none\">17<",
        "number_of_teeth\" unit=\"none\">17.5<",
        1,
    );
    refused(&teeth, &["`17.5`", "whole number"]);
    let mates = GEARBOX.replacen(
        "number_of_teeth\" unit=\"none\">17<",
        "number_of_teeth\" unit=\"none\">-17<",
        1,
    );
    refused(&mates, &["-17", "3 to 2000"]);
    refused(
        &change("id=\"normal_module\" unit=\"mm\">3<"),
        &["first stage", "modules of pinion 17 and wheel 59"],
    );
}

#[test]
fn what_is_no_place() {
    let vector = "<attribute id=\"support_vector\" unit=\"mm\"><array><c>0</c><c>0</c><c>0</c></array></attribute>";
    let text = small().replacen(
        vector,
        "<attribute id=\"support_vector\" unit=\"mm\">false</attribute>",
        1,
    );
    refused(
        &text,
        &[
            "support_vector",
            "`false` is no number",
            "allowed are three numbers",
        ],
    );
}

#[test]
fn ids() {
    refused(
        &changed(&small(), "<component id=\"4\"", "<component id=\"x\""),
        &["`id` is `x`"],
    );
    refused(
        &changed(&small(), "<component id=\"4\"", "<component"),
        &["`id` is missing"],
    );
    refused(
        &changed(&small(), "<component id=\"5\"", "<component id=\"4\""),
        &["the id 4", "pinion", "wheel"],
    );
    // A relation that names what is not there is left out and listed; the stage then misses its gear.
    let text = changed(
        &small(),
        "<ref id=\"5\" role=\"gear_2\"/>",
        "<ref id=\"99\" role=\"gear_2\"/>",
    );
    let made = read(&text);
    assert!(
        made.ledger
            .not_represented
            .iter()
            .any(|e| e.text.contains("names component 99"))
    );
    assert!(!made.files[0].text.contains("[[gear_mesh]]"));
}

#[test]
fn circles() {
    let text = changed(
        &small(),
        "</relations>",
        "<relation id=\"20\" type=\"assembly\"><ref id=\"4\" role=\"assembly\"/><ref id=\"2\" role=\"part\"/></relation></relations>",
    );
    refused(&text, &["contain each other", "one", "pinion"]);
    let by = |id: u32| {
        format!(
            "name=\"{}\"><attribute id=\"reference_component_for_position\">{id}</attribute>",
            if id == 3 { "one" } else { "two" }
        )
    };
    let text = changed(&small(), "name=\"one\">", &by(3));
    let text = changed(&text, "name=\"two\">", &by(2));
    refused(&text, &["place is given from each other", "one", "two"]);
    // From itself, too.
    let text = changed(
        &small(),
        "name=\"two\">",
        &by(3).replace("\"one\"", "\"two\""),
    );
    refused(
        &text,
        &[
            "place is given from each other",
            "shaft 3 `two` > shaft 3 `two`",
        ],
    );
}

/// Cut anywhere, and with any byte of the head changed: an error or an import, no panic.
#[test]
fn mutilated_files_do_not_panic() {
    let text = small();
    for end in (0..text.len()).step_by(7) {
        let _ = import(text.as_bytes()[..end].to_vec(), "box", Meshes::Iso6336);
    }
    for at in (0..text.len()).step_by(5) {
        for byte in [b'<', b'"', b'0', b'-'] {
            let mut bytes = text.clone().into_bytes();
            bytes[at] = byte;
            let _ = import(bytes, "box", Meshes::Iso6336);
        }
    }
}
