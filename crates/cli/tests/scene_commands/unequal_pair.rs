//! 23 teeth drive 47 with six holes, through the whole program: what is proposed, marked, compared and drawn.

use crate::common::{Desk, argument, gearmesh, number, refused, succeeds};
use crate::drilled_pair::{scene, scene_in_time, write_models};
use gearmesh_scene::SceneResult;
use std::path::{Path, PathBuf};

const GAUGES: &str = "[gauges]\ngear_1 = [\"g0\"]\ngear_2 = [\"g0\"]\n";

struct Bench {
    desk: Desk,
}

impl Bench {
    fn new() -> Self {
        let desk = Desk::new();
        write_models(desk.path("x").parent().unwrap());
        Self { desk }
    }

    fn scene(&self, wheel: &str, pitches: usize) -> PathBuf {
        let text = scene(
            wheel,
            &format!("pitches = {pitches}\npoints_per_pitch = 12"),
            GAUGES,
        );
        self.desk.file("scene.toml", text)
    }

    fn result(&self, wheel: &str, pitches: usize) -> PathBuf {
        let (scene, result) = (self.scene(wheel, pitches), self.desk.path("result.h5"));
        succeeds(&["run", argument(&scene), "-o", argument(&result), "--json"]);
        result
    }

    /// The transmission error of a result as a record of one revolution of the wheel: its folder and its record.toml.
    fn record(&self, result: &Path) -> (PathBuf, String) {
        let read = SceneResult::read(result).unwrap();
        let mut csv = "angle_deg,te_um_200Nm\n".to_owned();
        for (angle, te) in read.angle_rad.iter().zip(read.curve(&read.te_m, 0)) {
            csv += &format!("{},{}\n", angle.to_degrees() * 23.0 / 47.0, 1e6 * te);
        }
        let folder = self.desk.path("record");
        std::fs::create_dir(&folder).unwrap();
        std::fs::write(folder.join("data.csv"), csv).unwrap();
        let toml = "title = \"at rest\"\nkind = \"computed\"\nsource = \"this program\"\nangle_origin = \"pitch point\"\nshaft = \"gear_2\"\n";
        std::fs::write(folder.join("record.toml"), toml).unwrap();
        (folder, toml.to_owned())
    }
}

#[test]
fn plan_and_run_say_what_is_covered() {
    let bench = Bench::new();
    let scene = bench.scene("drilled", 3);
    let plan = succeeds(&["plan", argument(&scene)]).stdout;
    for part in [
        "periods    in pitches: mesh 1, gear 1 23 (body 1), gear 2 47 (body 47), common 1081",
        "covered    transmission error, stiffness, forces and pressure: incomplete: 3 of 47 pitches",
        "covered    strain at gauge g0 of gear 1: incomplete: 3 of 1081 pitches",
        "proposal   run.pitches = 1081 covers everything",
    ] {
        assert!(plan.contains(part), "`{part}` is not in {plan}");
    }
    let result = bench.desk.path("result.h5");
    let words = ["run", argument(&scene), "-o", argument(&result)];
    let table = succeeds(&words).stdout;
    let of_torque = table
        .lines()
        .find(|line| line.trim_start().starts_with("200"))
        .unwrap();
    assert!(of_torque.ends_with("  incomplete"), "{table}");
    assert!(
        table.contains("to cover it: run.pitches = 1081 covers everything"),
        "{table}"
    );
    let json = succeeds(&[words.as_slice(), &["--json"]].concat()).json();
    assert_eq!(json["rows"][0]["complete"], false);
    let quantities = json["coverage"]["quantities"].as_array().unwrap();
    let extents: Vec<&str> = quantities
        .iter()
        .map(|q| q["extent"].as_str().unwrap())
        .collect();
    assert_eq!(extents, ["part", "part", "part"]);
    assert_eq!(quantities[1]["period_pitches"], 1081);
    let strain = bench.desk.path("strain.h5");
    let recovered = succeeds(&["recover", argument(&result), "-o", argument(&strain)]).stdout;
    assert_eq!(
        recovered.matches("  incomplete\n").count(),
        4,
        "{recovered}"
    );
    // The solid wheel: the start is what is missing for peak and range.
    let solid = succeeds(&["plan", argument(&bench.scene("wheel", 3)), "--json"]).json();
    let proposal = solid["proposal"].as_str().unwrap();
    assert!(
        proposal.contains("run.start_deg = ") && proposal.contains("covers peak and range"),
        "{proposal}"
    );
}

/// A record made of the result itself, of one revolution of the wheel: both sides agree, and the holes are among the
/// orders.
#[test]
fn compare_takes_a_record_of_the_wheels_revolution() {
    let bench = Bench::new();
    let result = bench.result("drilled", 47);
    let (folder, toml) = bench.record(&result);
    let json = succeeds(&["compare", argument(&result), argument(&folder), "--json"]).json();
    let comparison = &json["comparisons"][0];
    assert!(
        number(&comparison["correlation"]) > 1.0 - 1e-9,
        "{comparison}"
    );
    assert!(number(&comparison["best_offset_rad"]).abs() < 1e-6);
    let holes = &comparison["harmonics"][0];
    assert_eq!(number(&holes["order"]), 6.0);
    assert!(
        number(&holes["ours"]) > 0.01 * number(&comparison["peak_to_peak"]["ours"]),
        "{holes}"
    );
    let table = succeeds(&["compare", argument(&result), argument(&folder)]).stdout;
    assert!(table.contains("TE (µm)"), "{table}");
    // The report, beside the record, and from a run that is too short.
    let page = bench.desk.path("report.html");
    let words = [
        "report",
        argument(&result),
        "-o",
        argument(&page),
        "--reference",
        argument(&folder),
    ];
    succeeds(&words);
    let text = std::fs::read_to_string(&page).unwrap();
    assert!(
        text.contains("Order spectrum of the transmission error")
            && text.contains("slots or holes")
    );
    let short = bench.result("drilled", 23);
    refused(
        &gearmesh(&["compare", argument(&short), argument(&folder)]),
        2,
        &[
            "TE of the result: the run goes through 23 of the 47 pitches",
            "run.pitches = 1081 covers everything",
        ],
    );
    std::fs::write(folder.join("record.toml"), toml.replace("gear_2", "gear_3")).unwrap();
    refused(
        &gearmesh(&["compare", argument(&short), argument(&folder)]),
        2,
        &["record.toml:5:9", "gear_3", "gear_1"],
    );
}

/// A slow run in time of the same pair against its positions at rest: the angle between both is found, and with it the
/// transmission error is the same.
#[test]
fn a_run_in_time_is_compared_with_positions_at_rest() {
    let bench = Bench::new();
    let at_rest = bench.result("drilled", 47);
    let (folder, toml) = bench.record(&at_rest);
    let scene = bench.desk.file("time.toml", scene_in_time(0.95));
    let result = bench.desk.path("time.h5");
    succeeds(&["run", argument(&scene), "-o", argument(&result), "--json"]);
    let words = ["compare", argument(&result), argument(&folder)];
    let with = |further: &[&str]| gearmesh(&[words.as_slice(), further].concat());
    refused(
        &with(&[]),
        2,
        &[
            "nothing says which columns",
            "--column HEAD=COLUMN",
            "te_um_200Nm",
        ],
    );
    let column = "te_um_200Nm=elements/mesh/transmission_error_m";
    for (further, parts) in [
        (
            &["--column", "te_um_200Nm=elements/mesh/te_m"][..],
            &[
                "no column `elements/mesh/te_m`",
                "elements/mesh/transmission_error_m",
            ][..],
        ),
        (
            &["--column", "te_um_100Nm=elements/mesh/transmission_error_m"],
            &["data.csv of the record has no column `te_um_100Nm`"],
        ),
        (
            &["--column", "te_um_200Nm=bodies/wheel/x_m"],
            &[
                "`bodies/wheel/x_m` is no channel of a gear mesh",
                "the meshes are: mesh",
            ],
        ),
        (
            &["--column", "te_um_200Nm=elements/mesh/normal_force_right_N"],
            &["is in `N`; `te_um_200Nm` of the record needs m"],
        ),
        (
            &["--column", column, "--from-s", "0.7"],
            &["revolutions of `wheel`", "run.end_s"],
        ),
        (
            &["--column", column, "--from-s", "5"],
            &["--from-s: found 5, allowed is 0 to below 0.95"],
        ),
    ] {
        refused(&with(further), 2, parts);
    }
    refused(
        &gearmesh(&[
            "compare",
            argument(&at_rest),
            argument(&folder),
            "--column",
            column,
        ]),
        2,
        &["--column is for results of multibody scenes"],
    );
    let compared = |further: &[&str]| {
        let answer = with(&[further, &["--json"]].concat());
        assert_eq!(answer.code, Some(0), "{answer:#?}");
        answer.json()["comparisons"][0].clone()
    };
    let as_it_is = compared(&["--column", column]);
    let offset = number(&as_it_is["best_offset_rad"]);
    assert!(offset.abs() > 1e-3, "{as_it_is}");
    // The record names its column, the start is that which was reported.
    let named = format!("{toml}[columns]\nte_um_200Nm = \"elements/mesh/transmission_error_m\"\n");
    std::fs::write(folder.join("record.toml"), named).unwrap();
    let shifted = compared(&["--start-angle-deg", &offset.to_degrees().to_string()]);
    for (what, tolerance) in [("correlation", 0.02), ("best_offset_correlation", 0.02)] {
        assert!(number(&shifted[what]) > 1.0 - tolerance, "{shifted}");
    }
    assert!(
        number(&shifted["best_offset_rad"]).abs() < 1e-3,
        "{shifted}"
    );
    assert!(number(&as_it_is["correlation"]) < number(&shifted["correlation"]));
    let mean = &shifted["mean"];
    assert!(
        (number(&mean["ours"]) / number(&mean["reference"]) - 1.0).abs() < 0.01,
        "{mean}"
    );
    let mesh = &shifted["harmonics"][0];
    assert_eq!(number(&mesh["order"]), 47.0);
    assert!(
        (number(&mesh["ours"]) / number(&mesh["reference"]) - 1.0).abs() < 0.15,
        "{mesh}"
    );
}
