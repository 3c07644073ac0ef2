//! Gear files.

use crate::common::{Desk, SOLID, THIN, argument, changed, gearmesh, line_of, refused, succeeds};

/// `gearmesh check` refuses a gear file in which `from` became `to`, at the line of `at`.
pub fn gear_refused(text: &str, (from, to): (&str, &str), at: &str, parts: &[&str]) {
    let desk = Desk::new();
    let text = changed(text, from, to);
    let file = desk.file("gear.toml", &text);
    let answer = gearmesh(&["check", argument(&file)]);
    refused(&answer, 2, parts);
    let place = format!("{}:{}: ", file.display(), line_of(&text, at));
    assert!(
        answer.stderr.contains(&place),
        "`{place}` is not in {answer:#?}"
    );
    // The commands that work with a gear refuse it before anything is written.
    for (command, output) in [("mesh", "output.vtu"), ("reduce", "output.h5")] {
        let output = desk.path(output);
        let same = gearmesh(&[command, argument(&file), "-o", argument(&output)]);
        refused(&same, 2, &[&place]);
        assert_eq!(desk.names(), ["gear.toml"]);
    }
}

#[test]
fn an_unknown_key_is_answered_with_the_known_ones() {
    gear_refused(
        SOLID,
        ("poisson = 0.3", "poisson = 0.3\ndensity = 7850"),
        "density",
        &["unknown field `density`", "young_GPa", "poisson"],
    );
}

#[test]
fn a_wrong_unit_is_answered_with_the_right_key() {
    gear_refused(
        THIN,
        ("web_thickness_mm = 4.0", "web_thickness_m = 0.004"),
        "web_thickness_m ",
        &[
            "`web_thickness_m`",
            "did you mean `web_thickness_mm`? The unit is part of the key",
        ],
    );
}

#[test]
fn a_web_of_negative_thickness_is_refused() {
    gear_refused(
        THIN,
        ("web_thickness_mm = 4.0", "web_thickness_mm = -4.0"),
        "web_thickness_mm",
        &[
            "blank.web_thickness_mm",
            "found -4",
            "a thousandth of a module, and at most the face width, 12",
        ],
    );
}

/// Root diameter 3 (18 + 0.2 − 2.5) = 47.1 mm; one module less is allowed.
#[test]
fn a_rim_without_material_below_the_root_is_refused() {
    gear_refused(
        THIN,
        (
            "rim_inner_diameter_mm = 38.0",
            "rim_inner_diameter_mm = 46.0",
        ),
        "rim_inner_diameter_mm",
        &[
            "blank.rim_inner_diameter_mm",
            "found 46",
            "less than 44.1",
            "root diameter 47.1",
        ],
    );
}

#[test]
fn a_bore_larger_than_the_root_is_refused() {
    gear_refused(
        SOLID,
        ("bore_diameter_mm = 14.0", "bore_diameter_mm = 50.0"),
        "bore_diameter_mm",
        &[
            "blank.bore_diameter_mm",
            "found 50",
            "less than 44.1",
            "root diameter 47.1",
        ],
    );
}

fn slotted(count: usize, width_deg: f64) -> String {
    format!(
        "web_thickness_mm = 4.0\n[blank.slots]\ncount = {count}\ninner_radius_mm = 12.0\nouter_radius_mm = 17.0\n\
         width_deg = {width_deg}\nphase_deg = 10.0\ncorner_radius_mm = 0.8"
    )
}

#[test]
fn slots_that_meet_are_refused() {
    gear_refused(
        THIN,
        ("web_thickness_mm = 4.0", &slotted(3, 119.0)),
        "[blank.slots]",
        &[
            "blank.slots",
            "3 openings of 119.000 deg meet",
            "1.000 deg are left",
            "at least 14.324 deg",
        ],
    );
}

#[test]
fn slots_that_do_not_divide_the_teeth_work_with_a_warning() {
    let desk = Desk::new();
    let file = desk.file(
        "gear.toml",
        changed(THIN, "web_thickness_mm = 4.0", &slotted(5, 30.0)),
    );
    let answer = succeeds(&["check", argument(&file)]);
    assert!(answer.stdout.contains("sound"), "{answer:#?}");
    assert!(
        answer.stderr.contains("warning: ") && answer.stderr.contains("do not divide the teeth"),
        "{answer:#?}"
    );
    // Three slots repeat with the teeth: no warning.
    let file = desk.file(
        "gear.toml",
        changed(THIN, "web_thickness_mm = 4.0", &slotted(3, 30.0)),
    );
    assert_eq!(succeeds(&["check", argument(&file)]).stderr, "");
}

/// What a contour may not be.
#[test]
fn a_contour_that_cannot_be_is_explained() {
    const CONTOUR: &str = "kind = \"contour\"
hub_z_mm = [-8.0, 6.0]
web = [{ diameter_mm = 20.0, z_mm = [-2.0, 2.0] }, { diameter_mm = 38.0, z_mm = [-1.0, 3.0] }]";
    let (without_mesh, _) = SOLID.split_once("[mesh]").unwrap();
    let sound = changed(without_mesh, "kind = \"solid\"", CONTOUR);
    for (change, at, parts) in [
        (
            ("[-1.0, 3.0]", "[-1.0, 7.0]"),
            "web =",
            &["blank.web.1.z_mm", "found 7", "-6 to 6 at the rim"][..],
        ),
        (
            ("diameter_mm = 38.0", "diameter_mm = 18.0"),
            "web =",
            &[
                "blank.web.0.diameter_mm",
                "at least 14.0060 and less than 18.000",
            ],
        ),
        (
            ("[-2.0, 2.0]", "[2.0, -2.0]"),
            "web =",
            &["blank.web.0.z_mm", "back < front"],
        ),
        (
            ("[-8.0, 6.0]", "[-1.0, 6.0]"),
            "hub_z_mm",
            &["at or beyond the back of the web at the hub, -2"],
        ),
        (
            (
                "diameter_mm = 38.0, z_mm = [-1.0, 3.0]",
                "diameter_mm = 38.0, z_mm = [-1.0, 3.0], fillet_radius_mm = -1.0",
            ),
            "web =",
            &["blank.web.1.fillet_radius_mm", "found -1", "0 or more"],
        ),
        (
            // The front: 3 mm of the rim's inner surface, a corner of 90 + atan(1/9) degrees.
            (
                "diameter_mm = 38.0, z_mm = [-1.0, 3.0]",
                "diameter_mm = 38.0, z_mm = [-1.0, 3.0], fillet_radius_mm = 4.5",
            ),
            "web =",
            &[
                "blank.web.1.fillet_radius_mm",
                "found 4.5000",
                "does not fit the corner at diameter 38.000 mm, z 3.000 mm",
                "at most 3.3518",
            ],
        ),
        (
            // Back and front without a kink at the middle point.
            (
                "{ diameter_mm = 38.0",
                "{ diameter_mm = 29.0, z_mm = [-1.5, 2.5], fillet_radius_mm = 2.0 }, { diameter_mm = 38.0",
            ),
            "web =",
            &[
                "blank.web.1.fillet_radius_mm",
                "found 2.0000",
                "no corner there",
            ],
        ),
        (
            (
                "{ diameter_mm = 38.0",
                "{ diameter_mm = 20.0, z_mm = [2.5, 4.0] }, { diameter_mm = 38.0",
            ),
            "web =",
            &["blank.web.1.z_mm", "leaves the web in one piece"],
        ),
        (
            (
                "[-1.0, 3.0] }]\nbore_diameter_mm = 14.0",
                "[-1.0, 3.0], fillet_radius_mm = 1.0 }]\nbore_diameter_mm = 14.0\n[mesh]\nelement = \"hex20\"",
            ),
            "element =",
            &[
                "mesh.element",
                "the contour has fillets",
                "remove the key or set it to \"tet10\"",
            ],
        ),
        (
            (
                "[-1.0, 3.0] }]\nbore_diameter_mm = 14.0",
                "[-1.0, 6.0] }]\nbore_diameter_mm = 14.0\n[mesh]\nelement = \"hex8\"",
            ),
            "element =",
            &[
                "mesh.element",
                "the web is flush with only one of rim and hub",
            ],
        ),
        (
            ("hub_z_mm = [-8.0, 6.0]\n", ""),
            "[blank]",
            &["blank.hub_z_mm: missing"],
        ),
        (
            ("kind = \"contour\"", "kind = \"solid\""),
            "hub_z_mm",
            &["blank: `hub_z_mm` belongs to kind \"contour\", not to \"solid\""],
        ),
    ] {
        gear_refused(&sound, change, at, parts);
    }
    gear_refused(
        SOLID,
        ("axial_mm = 3.0", "element = \"tet10\"\nplane_strain = true"),
        "plane_strain",
        &["mesh.plane_strain", "meshed in quadrilaterals"],
    );
}

#[test]
fn numbers_that_are_none_are_refused() {
    let gauge = "tooth = 17\nside = \"right\"";
    gear_refused(
        THIN,
        (gauge, "tooth = 17\nz_mm = inf\nside = \"right\""),
        "z_mm",
        &["gauge.0.z_mm: found inf, allowed is a finite number from -1e6 to 1e6 mm"],
    );
    gear_refused(
        SOLID,
        (
            "[mesh]",
            "[crack]\ntooth = 0\nside = \"right\"\ndepth_mm = 1.0\ntangent_deg = nan\n[mesh]",
        ),
        "tangent_deg",
        &["crack.tangent_deg: found NaN, allowed is a finite number from -1e6 to 1e6 deg"],
    );
    gear_refused(
        SOLID,
        ("face_width_mm = 12.0", "face_width_mm = 1.8e19"),
        "face_width_mm",
        &["tooth.face_width_mm: found 18000000000000000000"],
    );
    gear_refused(
        SOLID,
        ("face_width_mm = 12.0", "face_width_mm = 2e4"),
        "face_width_mm",
        &["tooth.face_width_mm: found 20000, allowed is 0.01 to 10000"],
    );
}

/// Allowed, but told: the numbers look like those of another unit.
#[test]
fn likely_slips_of_units_are_warned_of_by_name() {
    let desk = Desk::new();
    let text = changed(
        SOLID,
        "young_GPa = 210.0",
        "young_GPa = 210000.0\ndensity_kg_per_m3 = 7.8e-9",
    );
    let file = desk.file(
        "gear.toml",
        format!("{text}[microgeometry]\nlead_crowning_um = 0.012\n"),
    );
    let answer = succeeds(&["check", argument(&file)]);
    for (key, words) in [
        (
            "young_GPa",
            "material.young_GPa: 210000 is unusual, 0.1 to 1500 is usual; a slip of units? steel has 206 GPa",
        ),
        (
            "density",
            "material.density_kg_per_m3: 0.0000000078 is unusual",
        ),
        (
            "lead_crowning",
            "microgeometry.lead_crowning_um: 0.012 is unusual",
        ),
    ] {
        let line = line_of(&std::fs::read_to_string(&file).unwrap(), key);
        let warning = format!("warning: {}:{line}: {words}", file.display());
        assert!(
            answer.stderr.contains(&warning),
            "`{warning}` is not in {answer:#?}"
        );
    }
    assert_eq!(answer.stderr.lines().count(), 3, "{answer:#?}");
}

#[test]
fn a_missing_mesh_file_is_seen_by_check() {
    let (body, _) = SOLID.split_once("[mesh]").unwrap();
    gear_refused(
        body,
        (
            "kind = \"solid\"",
            "kind = \"mesh\"\nfile = \"nowhere.inp\"",
        ),
        "nowhere.inp",
        &["blank.file: the mesh file", "nowhere.inp does not exist"],
    );
}

/// Memory is estimated before it is taken: 0.03 mm on a 500 mm face took 60 GB before it aborted.
#[test]
fn a_mesh_that_no_machine_holds_is_refused_before_it_is_made() {
    let wide = changed(SOLID, "face_width_mm = 12.0", "face_width_mm = 500.0");
    let text = changed(&wide, "axial_mm = 3.0", "axial_mm = 0.03");
    let desk = Desk::new();
    let file = desk.file("gear.toml", &text);
    let place = format!("{}:{}: ", file.display(), line_of(&text, "axial_mm"));
    for (command, output) in [("mesh", "output.vtu"), ("reduce", "output.h5")] {
        let output = desk.path(output);
        let answer = gearmesh(&[command, argument(&file), "-o", argument(&output)]);
        let parts = [
            &place,
            "mesh.axial_mm",
            "nodes",
            "GB of memory",
            "GB are free",
            "times its default",
            "--even-if",
        ];
        refused(&answer, 2, &parts);
        assert_eq!(desk.names(), ["gear.toml"]);
    }
}

#[test]
fn more_modes_than_memory_holds_are_refused() {
    let text = changed(
        SOLID,
        "poisson = 0.3",
        "poisson = 0.3\ndensity_kg_per_m3 = 7850.0",
    );
    let desk = Desk::new();
    let file = desk.file("gear.toml", &text);
    let answer = gearmesh(&["modes", argument(&file), "--count", "100000000"]);
    refused(
        &answer,
        2,
        &[
            "modes",
            "the natural modes, about 100.0 million of them, take",
            "ask for fewer",
        ],
    );
    // How many there are up to a frequency is estimated.
    let answer = gearmesh(&["modes", argument(&file), "--up-to-Hz", "1e8"]);
    refused(&answer, 2, &["modes", "of them, take", "a lower frequency"]);
}

/// A relief of 12 nm is more likely one of 0.012 mm: said beside the answer, for people and for programs.
#[test]
fn a_relief_of_nanometres_is_a_warning() {
    let desk = Desk::new();
    let relief = "[microgeometry]\ntip_relief_um = 0.012\ntip_relief_start_diameter_mm = 56.0\n";
    let gear = desk.file("gear.toml", format!("{SOLID}{relief}"));
    let part = "microgeometry.tip_relief_um: 0.012 is unusual";
    let answer = succeeds(&["check", argument(&gear)]);
    assert!(
        answer.stderr.contains("warning: ") && answer.stderr.contains(part),
        "{answer:#?}"
    );
    let told = succeeds(&["check", argument(&gear), "--json"]).json();
    assert!(
        told["warnings"][0].as_str().unwrap().contains(part),
        "{told}"
    );
    let usual = desk.file("usual.toml", SOLID);
    let told = succeeds(&["check", argument(&usual), "--json"]).json();
    assert_eq!(told["warnings"], serde_json::json!([]));
}
