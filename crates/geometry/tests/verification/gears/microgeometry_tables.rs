//! `[microgeometry]` in gear files: every key, one side other than the other, tables over the flank, and what is
//! refused.

use crate::gears::model;
use gearmesh_geometry::gear_file::MicrogeometryTable;
use gearmesh_geometry::input::InputDocument;
use gearmesh_geometry::involute::roll_angle_rad;
use gearmesh_geometry::{Flank, GearDefinition, GearMicrogeometry};
use std::path::Path;

/// Pair A's first gear (57 teeth, module 2.6 mm, face width 23 mm) with other microgeometry.
fn gear(keys: &str) -> Result<GearDefinition, String> {
    let text = model("gear1.toml").source;
    let (body, _) = text.split_once("[microgeometry]").unwrap();
    let rest = text.split_once("[microgeometry]").unwrap().1;
    let next = rest.find("\n[").map_or("", |at| &rest[at..]);
    let document = InputDocument::new("gear.toml", format!("{body}[microgeometry]\n{keys}{next}"));
    GearDefinition::from_document(&document).map_err(|e| e.to_string())
}

fn refusal(keys: &str) -> String {
    gear(keys).unwrap_err()
}

#[test]
fn every_law_stands_where_its_keys_say() {
    let gear = gear(
        "tip_relief_um = 20.0\ntip_relief_start_diameter_mm = 150.0\ntip_relief_shape = \"parabolic\"\n\
         root_relief_um = 8.0\nroot_relief_start_diameter_mm = 146.0\nprofile_angle_um = 4.0\nlead_crowning_um = 6.0\n\
         flank_angle_um = 3.0\nend_relief_um = 10.0\nend_relief_length_mm = 2.0\nend_relief_end = \"+z\"\ntwist_um = 5.0\n",
    )
    .unwrap();
    let flank = gear.microgeometry.of(Flank::Left);
    assert_eq!(flank, gear.microgeometry.of(Flank::Right));
    let (form, tip) = (gear.profile.form_roll_rad, gear.profile.tip_roll_rad);
    let (half, um) = (0.5 * gear.tooth.face_width_m, 1e-6);
    let start = |diameter_mm: f64| roll_angle_rad(0.5e-3 * diameter_mm, gear.profile.base_radius_m);
    for (roll, z, expected_um) in [
        // Tip at mid-face: relief and half of the profile slope.
        (tip, 0.0, 20.0 + 2.0),
        // Form circle at mid-face: root relief, half of the slope added.
        (form, 0.0, 8.0 - 2.0),
        // Tip at the face towards +z: crowning, half the flank angle, end relief, a quarter of the twist.
        (tip, half, 22.0 + 6.0 + 1.5 + 10.0 + 1.25),
        (tip, -half, 22.0 + 6.0 - 1.5 - 1.25),
        (form, -half, 6.0 + 6.0 - 1.5 + 1.25),
        // Half-way through the reliefs in roll length.
        (
            0.5 * (start(150.0) + tip),
            0.0,
            5.0 + 4.0 * ((0.5 * (start(150.0) + tip) - form) / (tip - form) - 0.5),
        ),
        (
            0.5 * (start(146.0) + form),
            0.0,
            4.0 + 4.0 * ((0.5 * (start(146.0) + form) - form) / (tip - form) - 0.5),
        ),
    ] {
        let found = flank.removed_m(roll, z);
        assert!(
            (found - expected_um * um).abs() < 1e-15,
            "{roll} {z} {found:e} {expected_um}"
        );
    }
}

#[test]
fn one_side_takes_its_own_keys_and_the_rest_of_both() {
    let found = gear(
        "tip_relief_um = 20.0\ntip_relief_start_diameter_mm = 150.0\nlead_crowning_um = 6.0\n\
         [microgeometry.left]\ntip_relief_um = 5.0\n[microgeometry.right]\nlead_crowning_um = 0.0\n",
    )
    .unwrap();
    let GearMicrogeometry { right, left } = &found.microgeometry;
    let amounts = |flank: &gearmesh_geometry::Microgeometry| {
        (flank.tip_relief.unwrap().amount_m, flank.lead_crowning_m)
    };
    assert_eq!(amounts(left), (5.0 * 1e-6, 6.0 * 1e-6));
    assert_eq!(amounts(right), (20.0 * 1e-6, 0.0));
    assert_eq!(
        left.tip_relief.unwrap().start_roll_rad,
        right.tip_relief.unwrap().start_roll_rad
    );
    let words = found
        .microgeometry
        .description(found.profile.base_radius_m)
        .unwrap();
    assert_eq!(
        words,
        "right flanks tip relief 20 um linear from 150 mm; left flanks tip relief 5 um linear from 150 mm, lead crowning 6 um"
    );
}

/// A table in the file and one in a file of its own are the same, by roll angles or by diameters.
#[test]
fn a_topography_is_read_from_the_file_itself_or_from_another() {
    let gear = gear("topography = { diameter_mm = [142.0, 150.0], z_mm = [-10.0, 0.0, 10.0], removed_um = [[1.0, 0.0, 2.0], [4.0, 3.0, 5.0]] }\n")
        .unwrap();
    let flank = gear.microgeometry.of(Flank::Right);
    let roll = |diameter_mm: f64| roll_angle_rad(0.5e-3 * diameter_mm, gear.profile.base_radius_m);
    assert!((flank.removed_m(roll(142.0), 0.01) - 2e-6).abs() < 1e-18);
    assert!((flank.removed_m(0.5 * (roll(142.0) + roll(150.0)), -5e-3) - 2e-6).abs() < 1e-18);
    assert!((flank.removed_m(roll(152.0), -5e-3) - 3.5e-6).abs() < 1e-18);
    let folder = tempfile::tempdir().unwrap();
    // Any order of the rows.
    let of_diameters =
        "diameter_mm,z_mm,removed_um\n150,10,5\n150,-10,4\n142,-10,1\n142,0,0\n142,10,2\n150,0,3\n";
    let (low, high) = (roll(142.0).to_degrees(), roll(150.0).to_degrees());
    let of_rolls = format!(
        "# measured\nz_mm,removed_um,roll_deg\n-10,1,{low:?}\n0,0,{low:?}\n10,2,{low:?}\n-10,4,{high:?}\n0,3,{high:?}\n10,5,{high:?}\n"
    );
    for text in [of_diameters, &of_rolls] {
        std::fs::write(folder.path().join("flank.csv"), text).unwrap();
        let other = stated(
            "topography = { file = \"flank.csv\" }",
            Some(folder.path()),
            &gear,
        )
        .unwrap();
        for (roll, z) in [(roll(143.0), 2e-3), (roll(151.0), -7e-3)] {
            let expected = flank.removed_m(roll, z);
            assert!((other.right.removed_m(roll, z) - expected).abs() < 1e-17);
        }
    }
    for (text, told) in [
        (
            "roll_deg,z_mm,removed_um\n10,0,1\n10,5,1\n20,0,1\n",
            "the point at roll_deg 20, z_mm 5 is missing; the table needs every place",
        ),
        (
            "roll_deg,z_mm,removed_um\n10,0,1\n10,0,1\n",
            "the point at roll_deg 10, z_mm 0 is there twice",
        ),
        (
            "roll_deg,z_mm,removed_um\n10,0,1\n20,0,1001\n",
            "removed_um: found 1001, allowed is -1000 to 1000",
        ),
        (
            "diameter_mm,z_mm,removed_um\n10,0,1\n20,0,1\n",
            "diameter_mm: found 10, allowed is 139",
        ),
        (
            "roll_deg,z,removed_um\n10,0,1\n20,0,1\n",
            "z_mm: there is no such column",
        ),
    ] {
        std::fs::write(folder.path().join("flank.csv"), text).unwrap();
        let problem = stated(
            "topography = { file = \"flank.csv\" }",
            Some(folder.path()),
            &gear,
        )
        .unwrap_err();
        assert!(
            problem.contains("flank.csv") && problem.contains(told),
            "{problem}"
        );
    }
}

/// A table as a scene would state it for a gear.
fn stated(
    keys: &str,
    folder: Option<&Path>,
    gear: &GearDefinition,
) -> Result<GearMicrogeometry, String> {
    #[derive(serde::Deserialize)]
    struct File {
        flank: MicrogeometryTable,
    }
    let document = InputDocument::new("scene.toml", format!("[flank]\n{keys}\n"));
    let file: File = document.parse().map_err(|e| e.to_string())?;
    let teeth = (&gear.profile, gear.tooth.face_width_m);
    let made = file.flank.check((&document, "flank"), teeth, folder);
    made.map_err(|e| e.to_string())
}

#[test]
fn keys_that_do_not_go_together_are_named() {
    for (keys, told) in [
        (
            "tip_relief_um = 20.0\n",
            "microgeometry.tip_relief_um: needs tip_relief_start_diameter_mm",
        ),
        (
            "tip_relief_shape = \"arc\"\n",
            "microgeometry.tip_relief_shape: is not used without tip_relief_um",
        ),
        (
            "root_relief_start_diameter_mm = 145.0\n",
            "root_relief_start_diameter_mm: is not used without root_relief_um",
        ),
        (
            "end_relief_end = \"+z\"\n",
            "end_relief_end: is not used without end_relief_um",
        ),
        (
            "twist_um = 1001.0\n",
            "microgeometry.twist_um: found 1001, allowed is -1000 to 1000",
        ),
        (
            "end_relief_um = 10.0\nend_relief_length_mm = 12.0\n",
            "end_relief_length_mm: found 12, allowed is more than 0 to 11.5000",
        ),
        (
            "root_relief_um = 5.0\nroot_relief_start_diameter_mm = 130.0\n",
            "root_relief_start_diameter_mm: found 130, allowed is above 14",
        ),
        (
            "end_relief_um = -900.0\nend_relief_length_mm = 0.5\nend_relief_shape = \"arc\"\n",
            "end_relief_um: found -900, allowed is less than 500.0 in magnitude",
        ),
        (
            "tip_relief_um = 1.0\n[microgeometry.left]\ntip_relief_start_diameter_mm = 150.0\n",
            "microgeometry.tip_relief_um: needs",
        ),
        (
            "[microgeometry.left]\ntwist_um = 2000.0\n",
            "microgeometry.left.twist_um: found 2000",
        ),
        (
            "[microgeometry.left.right]\ntwist_um = 2.0\n",
            "microgeometry.left.right: does not belong into the table of one side",
        ),
        (
            "topography = { file = \"flank.csv\" }\n",
            "topography.file: a gear file cannot name another file",
        ),
        (
            "topography = { roll_deg = [1.0], z_mm = [0.0] }\n",
            "topography.removed_um: missing",
        ),
        (
            "topography = { roll_deg = [2.0, 1.0], z_mm = [0.0], removed_um = [[1.0], [2.0]] }\n",
            "topography.roll_deg: allowed are one number or more, each larger",
        ),
        (
            "topography = { roll_deg = [1.0, 2.0], z_mm = [0.0], removed_um = [[1.0]] }\n",
            "topography.removed_um: found 1 lists, allowed are 2",
        ),
        (
            "topography = { roll_deg = [1.0], z_mm = [0.0], removed_um = [[1.0, 2.0]] }\n",
            "topography.removed_um.0: found 2 numbers, allowed are 1",
        ),
    ] {
        let problem = refusal(keys);
        assert!(
            problem.starts_with("gear.toml:") && problem.contains(told),
            "{keys}: {problem}"
        );
    }
}
