//! A gear with a root crack through the whole program: check, reduce, compliance, plan, run; and where it has no place.

use crate::common;

use common::{Desk, SOLID, argument, changed, gearmesh, number, refused, succeeds};
use gearmesh_scene::SceneResult;
use serde_json::Value;
use std::path::Path;

const CRACK: &str = "[crack]\ntooth = 3\nside = \"right\"\ndepth_mm = 1.8\n";
const POINTS: usize = 8;

fn scene(gear_1: &str) -> String {
    format!(
        "title = \"cracked\"
[pair]
gear_1 = \"{gear_1}\"
gear_2 = \"sound.h5\"
centre_distance_mm = 54.7
[run]
torques_Nm = [40.0]
pitches = 6
points_per_pitch = {POINTS}
[mesh]
model.kind = \"hybrid\"
teeth.path = \"line-of-action\"
"
    )
}

fn deflection(model: &Path, tooth: &str, flank: &str) -> f64 {
    let words = [
        "compliance",
        argument(model),
        "--tooth",
        tooth,
        "--flank",
        flank,
        "--radius-mm",
        "29",
        "--line-load-N-per-mm",
        "100",
        "--half-width-mm",
        "0.1",
        "--json",
    ];
    number(&succeeds(&words).json()["rows"][0]["total_m"])
}

#[test]
fn a_crack_goes_through_the_whole_chain() {
    let desk = Desk::new();
    let both = changed(
        SOLID,
        "flanks = [\"right\"]",
        "flanks = [\"right\", \"left\"]",
    );
    let mut figures = Vec::new();
    for (name, text) in [
        ("sound", both.clone()),
        ("cracked", format!("{both}{CRACK}")),
    ] {
        let file = desk.file(&format!("{name}.toml"), text);
        let model = desk.path(&format!("{name}.h5"));
        let words = [
            "reduce",
            argument(&file),
            "-o",
            argument(&model),
            "--no-error-estimate",
            "--json",
        ];
        figures.push(succeeds(&words).json());
    }
    assert_eq!(figures[0]["crack"], Value::Null);
    let crack = &figures[1]["crack"];
    assert!((number(&crack["depth_mm"]) - 1.8).abs() < 1e-9 && crack["tooth"] == 3);
    // Perpendicular to the fillet at the 30 degree tangent.
    assert!((number(&crack["angle_deg"]) - 60.0).abs() < 0.1, "{crack}");
    assert!(number(&figures[1]["further"]["symmetry of the crack's stiffness"]) < 1e-9);

    let (sound, cracked) = (desk.path("sound.h5"), desk.path("cracked.h5"));
    let check = succeeds(&["check", argument(&cracked)]).stdout;
    assert!(
        check.contains("crack in tooth 3, right side") && check.contains("1.8000 mm deep"),
        "{check}"
    );
    let words = "--tooth 0 --radius-mm 29 --line-load-N-per-mm 100 --half-width-mm 0.1 --project";
    let words: Vec<&str> = words.split(' ').collect();
    let projected = gearmesh(&[&["compliance", argument(&cracked)], &words[..]].concat());
    refused(&projected, 2, &["cracked.h5 has a crack", "--project"]);
    // The section of all teeth has the crack's line, so that sound teeth differ a little from those of the other model.
    let ratio =
        |tooth, flank| deflection(&cracked, tooth, flank) / deflection(&sound, tooth, flank);
    let [open, shut, neighbour] = [ratio("3", "right"), ratio("3", "left"), ratio("4", "right")];
    assert!(open > 1.03, "{open} {shut} {neighbour}");
    assert!(
        (shut - 1.0).abs() < 0.005 && (neighbour - 1.0).abs() < 0.005,
        "{open} {shut} {neighbour}"
    );
    assert_eq!(
        deflection(&cracked, "3", "left").to_bits(),
        deflection(&cracked, "9", "left").to_bits()
    );

    let file = desk.file("cracked_scene.toml", scene("cracked.h5"));
    let plan = succeeds(&["plan", argument(&file)]).stdout;
    assert!(plan.contains("gear 1: crack in tooth 3"), "{plan}");
    let result = desk.path("result.h5");
    succeeds(&["run", argument(&file), "-o", argument(&result)]);
    let te = SceneResult::read(&result).unwrap().te_m;
    let te: Vec<f64> = te[..6 * POINTS].to_vec();
    // Pair p is at the pitch point at p pitches: how much deeper than a pitch that is sound?
    let deeper = |pitch: usize| -> f64 {
        (0..POINTS)
            .map(|k| te[k] - te[pitch * POINTS + k])
            .fold(0.0, f64::max)
    };
    let by_pitch: Vec<f64> = (0..6).map(deeper).collect();
    let swing =
        te.iter().fold(f64::MIN, |m, v| m.max(*v)) - te.iter().fold(f64::MAX, |m, v| m.min(*v));
    assert!(by_pitch[3] > 0.05 * swing, "{by_pitch:?} {swing:e}");
    // Its neighbours feel it by a hundredth, as the foot of the tooth is theirs too.
    let away = by_pitch[1].max(by_pitch[5]);
    assert!(away < 0.02 * by_pitch[3], "{by_pitch:?}");
}

#[test]
fn a_crack_without_a_place_is_refused() {
    let desk = Desk::new();
    let model = desk.path("never.h5");
    for (text, parts) in [
        (
            changed(
                &format!("{SOLID}{CRACK}"),
                "side = \"right\"",
                "side = \"left\"",
            ),
            vec!["crack.side", "reduction.flanks"],
        ),
        (
            changed(
                &format!("{SOLID}{CRACK}"),
                "[mesh]",
                "[mesh]\nelement = \"tet10\"",
            ),
            vec!["crack", "hexahedra"],
        ),
        (
            format!("{SOLID}{CRACK}colour = 1\n"),
            vec!["unknown field `colour`", "depth_mm"],
        ),
    ] {
        let file = desk.file("gear.toml", text);
        let answer = gearmesh(&["reduce", argument(&file), "-o", argument(&model)]);
        refused(&answer, 2, &parts);
    }
    let schema = succeeds(&["schema", "gear"]).stdout;
    assert!(schema.contains("\"crack\"") && schema.contains("depth_mm"));
}
