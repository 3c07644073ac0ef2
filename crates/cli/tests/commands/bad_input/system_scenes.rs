//! Multibody scenes.

use crate::common::{Desk, argument, changed, gearmesh, line_of, refused, succeeds};

/// A multibody scene that is wrong or that its first steps refuse: exit code 2 from `plan`, place and cause on standard
/// error. What else a scene can get wrong is in crates/scene/tests/bad_scenes.
#[test]
fn a_multibody_scene_that_cannot_be_is_explained() {
    const SWING: &str = r#"title = "swing"
[run]
kind = "transient"
end_s = 1.0
[solver]
step_s = 1e-3
[output]
interval_s = 0.1
[[body]]
name = "beam"
mass_kg = 1.0
inertia_kg_m2 = [0.1, 0.1, 0.1]
[[joint]]
name = "hinge"
kind = "revolute"
body_2 = "beam"
"#;
    let desk = Desk::new();
    let sound = desk.file("sound.toml", SWING);
    let answer = succeeds(&["check", argument(&sound)]);
    assert!(
        answer
            .stdout
            .contains("scene `swing`, sound: 1 bodies, 1 joints and motions, 0 force elements"),
        "{answer:#?}"
    );
    assert!(
        succeeds(&["plan", argument(&sound)])
            .stdout
            .contains("1 degrees of freedom left")
    );
    let further = |text: &str| format!("{SWING}{text}\n");
    for (scene, at, parts) in [
        (
            changed(SWING, "body_2 = \"beam\"", "body_2 = \"bean\""),
            "bean",
            &["there is no body `bean`; did you mean `beam`?"][..],
        ),
        (
            changed(SWING, "[0.1, 0.1, 0.1]", "[0.1, 0.1, -0.1]"),
            "inertia",
            &["a moment of inertia is zero or negative"],
        ),
        (
            changed(SWING, "mass_kg = 1.0", "gear = \"none.h5\""),
            "gear =",
            &["none.h5 does not exist", "gearmesh reduce"],
        ),
        (
            further(
                "[[joint]]\nname = \"weld\"\nkind = \"fixed\"\nbody_2 = \"beam\"\n[[motion]]\njoint = \"hinge\"\nspeed_rpm = 6.0",
            ),
            "",
            &["contradict each other", "motion of hinge"],
        ),
        (
            further(
                "[[load]]\nbody = \"beam\"\ntorque_Nm = { table = { file = \"t.csv\", column = \"y\" } }",
            ),
            "",
            &["t.csv:4: time_s: found 1 after 2"],
        ),
    ] {
        desk.file("t.csv", "time_s,y\n0,0\n2,1\n1,2\n");
        let file = desk.file("scene.toml", &scene);
        let answer = gearmesh(&["plan", argument(&file)]);
        refused(&answer, 2, parts);
        if !at.is_empty() {
            let place = format!("{}:{}: ", file.display(), line_of(&scene, at));
            assert!(
                answer.stderr.contains(&place),
                "`{place}` is not in {answer:#?}"
            );
        }
    }
}
