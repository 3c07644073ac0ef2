//! A gear that was meshed elsewhere, on the command line: our own mesh written and read back, and what is refused.

use crate::common;

use common::{Desk, SOLID, argument, changed, gearmesh, line_of, number, refused, succeeds};

/// [`SOLID`] with its mesh in a file; the element sizes are the file's.
fn elsewhere(extra: &str) -> String {
    let (head, _) = SOLID.split_once("[mesh]").unwrap();
    let blank = format!("kind = \"mesh\"\nfile = \"body.vtu\"\n{extra}");
    changed(head, "kind = \"solid\"", &blank)
}

#[test]
fn our_own_mesh_written_and_read_back_is_the_same_gear() {
    let desk = Desk::new();
    let made = desk.file("made.toml", SOLID);
    succeeds(&[
        "mesh",
        argument(&made),
        "-o",
        argument(&desk.path("body.vtu")),
    ]);
    let read = desk.file("read.toml", elsewhere(""));
    let models = [(&made, "made.h5"), (&read, "read.h5")].map(|(gear, model)| {
        let model = desk.path(model);
        let json = succeeds(&[
            "reduce",
            argument(gear),
            "-o",
            argument(&model),
            "--no-error-estimate",
            "--json",
        ])
        .json();
        (model, json)
    });
    assert_eq!(number(&models[0].1["nodes"]), number(&models[1].1["nodes"]));
    assert_eq!(number(&models[1].1["sectors"]), 1.0);
    // Other teeth see C_hub only, which is the same. At the load the near field is calibrated above a cut that need not
    // run along the mesh: a staircase.
    for (at_tooth, allowed) in [("1", 1e-9), ("9", 1e-9), ("0", 5e-3)] {
        let [a, b] = [0, 1].map(|k| {
            let answer = succeeds(&[
                "compliance",
                argument(&models[k].0),
                "--tooth",
                "0",
                "--flank",
                "right",
                "--radius-mm",
                "27.5",
                "--line-load-N-per-mm",
                "100",
                "--half-width-mm",
                "0.1",
                "--at-tooth",
                at_tooth,
                "--json",
            ])
            .json();
            let row = &answer["rows"][0];
            number(&row["total_m"])
        });
        assert!((a / b - 1.0).abs() < allowed, "{at_tooth}: {a} {b}");
    }
}

#[test]
fn what_a_mesh_from_elsewhere_does_not_use_is_refused() {
    for (text, at, parts) in [
        (
            elsewhere("web_thickness_mm = 3.0"),
            "web_thickness_mm",
            &["`web_thickness_mm` belongs to kind \"thin-rim\", not to \"mesh\""][..],
        ),
        (
            elsewhere("") + "[mesh]\nflank_mm = 1.0\n",
            "flank_mm",
            &["has its elements in the mesh file"],
        ),
        (
            elsewhere("flank_sets = \"flank_{tooth}\""),
            "flank_sets",
            &["{side} must stand in it", "tooth{tooth}_{side}_flank"],
        ),
        (
            elsewhere("") + "[hub]\nsupport = \"reference-point\"\n",
            "support = ",
            &["reduced at rest with its bore fixed"],
        ),
        (
            elsewhere("length_unit = \"inch\""),
            "length_unit",
            &["`inch`", "`m`", "`mm`"],
        ),
        (
            changed(&elsewhere(""), "file = \"body.vtu\"\n", ""),
            "[blank]",
            &["blank.file: missing"],
        ),
        (
            changed(
                SOLID,
                "kind = \"solid\"",
                "kind = \"solid\"\nfile = \"body.vtu\"",
            ),
            "file = ",
            &["blank: `file` belongs to kind \"mesh\", not to \"solid\""],
        ),
        (
            changed(
                &elsewhere(""),
                "face_width_mm",
                "helix_angle_deg = 15.0\nhand = \"right\"\nface_width_mm",
            ),
            "kind = ",
            &["spur gears only"],
        ),
    ] {
        let desk = Desk::new();
        let file = desk.file("gear.toml", &text);
        let answer = gearmesh(&["check", argument(&file)]);
        refused(&answer, 2, parts);
        let place = format!("{}:{}: ", file.display(), line_of(&text, at));
        assert!(
            answer.stderr.contains(&place),
            "`{place}` is not in {answer:#?}"
        );
    }
}

#[test]
fn a_mesh_that_is_not_the_gear_is_wrong_input() {
    let desk = Desk::new();
    let file = desk.file("gear.toml", elsewhere(""));
    let reduce = |gear: &std::path::Path| {
        gearmesh(&[
            "reduce",
            argument(gear),
            "-o",
            argument(&desk.path("model.h5")),
        ])
    };
    refused(&reduce(&file), 2, &["body.vtu", "does not exist"]);
    let made = desk.file("made.toml", SOLID);
    succeeds(&[
        "mesh",
        argument(&made),
        "-o",
        argument(&desk.path("body.vtu")),
    ]);
    // Read in another unit; under other names; another mesh asked for.
    let unit = desk.file("unit.toml", elsewhere("length_unit = \"mm\""));
    refused(
        &reduce(&unit),
        2,
        &["radius 0.0070 mm", "7.0000 mm", "blank.length_unit"],
    );
    let names = desk.file(
        "names.toml",
        elsewhere("flank_sets = \"flank_{side}_{tooth}\""),
    );
    refused(
        &reduce(&names),
        2,
        &[
            "no node or element set \"flank_right_0\" (and 17 more",
            "\"bore\", \"tooth0_left_flank\"",
        ],
    );
    let again = gearmesh(&[
        "mesh",
        argument(&file),
        "-o",
        argument(&desk.path("again.vtu")),
    ]);
    refused(&again, 2, &["is the mesh of this gear"]);
    assert!(!desk.path("model.h5").exists() && !desk.path("again.vtu").exists());
}
