//! `gearmesh plan`: what it says before a run, and what it refuses.

use crate::common::{
    Desk, SOLID, argument, begin, changed, gearmesh, refused, run_scene, succeeds, workshop,
};
use crate::hybrid_scene;
use gearmesh_scene::SceneResult;

#[test]
fn plan_counts_what_run_computes() {
    let desk = Desk::new();
    let scene = desk.file("scene.toml", workshop().scene(""));
    let plan = succeeds(&["plan", argument(&scene), "--json"]).json();
    // 3 pitches x 8 points; two pairs of two slices.
    assert_eq!(
        (&plan["positions"], &plan["unknowns"]),
        (&48.into(), &4.into())
    );
    let text = succeeds(&["plan", argument(&scene)]).stdout;
    for part in [
        "small pair",
        "2 torques x 24 positions",
        "friction   not computed",
        "gauges     1, methods 1 and 2, 96 readings",
    ] {
        assert!(text.contains(part), "`{part}` is not in {text}");
    }
    assert_eq!(desk.names(), ["scene.toml"]);
    let (result, _) = run_scene(&desk, "");
    let result = SceneResult::read(&result).unwrap();
    assert_eq!(result.angles() * result.torque_nm.len(), 48);
    assert_eq!(result.lines.slots * result.lines.slices, 4);
    assert_eq!(result.strain.len(), 1);
}

/// Planned with its gauges; a flank that one model does not carry, a gauge that it does not have and a body that cannot
/// be rigid are refused.
#[test]
fn plan_of_a_hybrid_mesh_in_a_multibody_scene() {
    let scene = hybrid_scene();
    let desk = Desk::new();
    let file = desk.file("scene.toml", &scene);
    let plan = succeeds(&["plan", argument(&file)]).stdout;
    for part in [
        "force      mesh: hybrid mesh, on solid and thin",
        "mesh       mesh: `hybrid`, solid z 18 with thin z 18",
        "mesh frequency at the start 18.000 Hz",
        "gauge      tension of thin",
        "effect     mesh `mesh`: friction: not computed",
        "the right flanks of mesh `mesh` touch",
        "1000 steps of ",
    ] {
        assert!(plan.contains(part), "`{part}` is not in {plan}");
    }
    let figures = succeeds(&["plan", argument(&file), "--json"]).json();
    assert_eq!(figures["degrees_of_freedom"], 12);
    for ((from, to), parts) in [
        (
            ("teeth.flanks = \"right\"\n", ""),
            &["left", "flanks = \"right\" or \"left\""][..],
        ),
        (
            ("\"tension\"", "\"tensoin\""),
            &["there is no gauge `tensoin`; did you mean `tension`?"],
        ),
        (
            (
                "name = \"thin\"\n",
                "name = \"thin\"\nflexibility = \"rigid\"\n",
            ),
            &["body.1.flexibility", "is a hybrid mesh"],
        ),
    ] {
        let file = desk.file("scene.toml", changed(&scene, from, to));
        refused(&gearmesh(&["plan", argument(&file)]), 2, parts);
    }
}

/// Gears that do not run together are refused while they are gear files: before minutes go into reducing them.
#[test]
fn gears_of_one_hand_are_refused_before_they_are_reduced() {
    let desk = Desk::new();
    let helical = |hand: &str| {
        let helix = format!("face_width_mm = 12.0\nhelix_angle_deg = 15.0\nhand = \"{hand}\"");
        changed(SOLID, "face_width_mm = 12.0", &helix)
    };
    let pair = "title = \"pair\"\n[pair]\ngear_1 = \"a.h5\"\ngear_2 = \"b.h5\"\ncentre_distance_mm = 56.6\n[mesh]\nmodel = { kind = \"hybrid\" }\n\
        [run]\ntorques_Nm = [50.0]\npitches = 1\npoints_per_pitch = 8\n";
    let scene = desk.file("pair.toml", pair);
    desk.file("a.toml", helical("right"));
    desk.file("b.toml", helical("right"));
    let output = desk.path("o.h5");
    for words in [
        &["check", argument(&scene)][..],
        &["plan", argument(&scene)],
        &["run", argument(&scene), "-o", argument(&output)],
    ] {
        let told = ["pair: the helices do not fit", "opposite hand"];
        refused(&gearmesh(words), 2, &told);
    }
    desk.file("b.toml", helical("left"));
    let told = ["a.h5 does not exist; make it with `gearmesh reduce"];
    refused(&gearmesh(&["check", argument(&scene)]), 2, &told);
}

/// `gearmesh plan ... | head -0`: who reads may stop reading.
#[test]
fn a_reader_that_stops_reading_is_no_error() {
    let desk = Desk::new();
    let scene = desk.file("scene.toml", workshop().scene(""));
    let mut child = begin(&["plan", argument(&scene)]);
    drop(child.stdout.take());
    let output = child.wait_with_output().unwrap();
    assert!(output.status.success(), "{output:?}");
    assert_eq!(String::from_utf8_lossy(&output.stderr), "");
}
