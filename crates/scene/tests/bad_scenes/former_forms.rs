//! Scenes in the forms of earlier versions: read as what they are now, with a note that says how they are written now.

use crate::common::*;

/// A complaint about a key in its former place has that place's line and the present key; the note has the text to
/// write.
#[test]
fn bearings_without_a_table_for_their_model_are_read() {
    let pendulum = text("scene_pendulum.toml");
    let first = pendulum.lines().count() + 1;
    let former = |stiffness: &str| {
        format!(
            "{pendulum}[[bearing]]\nname = \"b\"\nkind = \"linear\"\nbody_2 = \"rod\"\nradial_stiffness_N_per_mm = {stiffness}\n\
             axial_stiffness_N_per_mm = 2_000.0 # a remark\n"
        )
    };
    let notes = load(&former("1e5"), &fe_models()).unwrap().scene.notes;
    assert_eq!(
        notes,
        [format!(
            "scene.toml:{}: bearing.0.model: lines {}, {}, {} are in a form of earlier versions, which is still read; now it is written\n    \
             model = {{ kind = \"linear\", radial_stiffness_N_per_mm = 1e5, axial_stiffness_N_per_mm = 2_000.0 }}",
            first + 2,
            first + 2,
            first + 4,
            first + 5
        )]
    );
    for (stiffness, problem) in [
        ("1e14", "radial_stiffness_N_per_mm: found 1e14,"),
        (
            "true",
            "radial_stiffness_N_per_mm: found true, allowed is a number",
        ),
        ("inf", "radial_stiffness_N_per_mm: found inf"),
    ] {
        let complaint = build(&former(stiffness)).err().unwrap().to_string();
        let place = format!("scene.toml:{}: bearing.0.model.{problem}", first + 4);
        assert!(complaint.starts_with(&place), "{complaint}");
    }
}
