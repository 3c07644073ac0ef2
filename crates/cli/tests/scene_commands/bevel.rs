//! `gearmesh bevel` and `gearmesh tca`.

use gearmesh_bevel::PairFile;
use gearmesh_scene::SceneResult;

use crate::common::doors::one_table_at_all_doors;
use crate::common::{Desk, argument, changed, gearmesh, points_of_flank, refused, succeeds};

pub fn shipped(name: &str) -> String {
    format!("{}/../../fe_models/{name}", env!("CARGO_MANIFEST_DIR"))
}

/// Settings printed for the pairs of seeds 000 and 001 are settings: read back they make the same pair.
#[test]
fn printed_settings_are_read_back() {
    let desk = Desk::new();
    for name in [
        "bevel_20_20.toml",
        "bevel_13_35.toml",
        "bevel_31_36.toml",
        "bevel_38_51.toml",
        "bevel_8_48.toml",
    ] {
        let file = shipped(name);
        succeeds(&["check", &file]);
        let printed = succeeds(&["bevel", &file]).stdout;
        let text = std::fs::read_to_string(&file).unwrap();
        let head = text.split("[gear]").next().unwrap();
        let again = format!("{head}\n{printed}");
        let [first, second] = [text.as_str(), &again].map(|pair| {
            let pair = format!("{pair}\n[tca]\npositions_per_pitch = 8\n");
            let file = desk.file(name, pair);
            let json = succeeds(&["tca", argument(&file), "--json"]).json();
            ["peak_to_peak_urad", "contact_ratio"].map(|key| json[key].as_f64().unwrap())
        });
        for (a, b) in first.into_iter().zip(second) {
            assert!((a - b).abs() < 1e-6 * a, "{name}: {a} {b}");
        }
        assert!(first[1] > 0.9 && first[0] < 300.0, "{name}: {first:?}");
    }
}

#[test]
fn blank_and_contact_of_seed_001() {
    let file = shipped("bevel_20_20.toml");
    let text = succeeds(&["bevel", &file]).stdout;
    for part in [
        "outer_cone_distance_mm          49.4975",
        "root_angle_deg                  40.8021      40.8021",
        "[pinion.concave]",
    ] {
        assert!(text.contains(part), "`{part}` is not in {text}");
    }
    let text = succeeds(&["tca", &file]).stdout;
    for part in [
        "pinion concave on gear convex",
        "flanks",
        "gear tip",
        "pinion axial, mm per mm",
    ] {
        assert!(text.contains(part), "`{part}` is not in {text}");
    }
}

/// Under load the first screen has transmission error, sharing and pressure of every torque; the page draws them;
/// wrong loads are refused.
#[test]
fn a_pair_file_with_loads_is_analysed_under_them() {
    let desk = Desk::new();
    let text = std::fs::read_to_string(shipped("bevel_20_20_loaded.toml")).unwrap();
    let quick = text
        .replace("slices = 31", "slices = 15")
        .replace("positions_per_pitch = 16", "positions_per_pitch = 6");
    assert!(quick != text);
    let file = desk.file("pair.toml", &quick);
    let (result, page) = (desk.path("pair.h5"), desk.path("page.html"));
    let run = succeeds(&["run", argument(&file), "-o", argument(&result)]).stdout;
    assert!(run.contains("TE pk-pk urad"), "{run}");
    succeeds(&["report", argument(&result), "-o", argument(&page)]);
    let html = std::fs::read_to_string(&page).unwrap();
    for title in ["Mesh stiffness", "Largest Hertz pressure at 200 N·m"] {
        assert!(html.contains(title), "{title}");
    }
    // Both gears stand in space, and the page stays small.
    assert!(html.contains("data-kind=\"space\"") && html.contains("\"pitch_point_mm\""));
    assert!(html.len() < 600_000, "{}", html.len());
    // The contact without load names what goes on from it.
    let free = succeeds(&["tca", argument(&file)]);
    assert!(!free.stdout.contains("TE pk-pk urad"), "{}", free.stdout);
    assert!(free.stderr.contains("gearmesh run"), "{}", free.stderr);
    let json = succeeds(&["run", argument(&file), "-o", argument(&result), "--json"]).json();
    let rows = json["rows"].as_array().unwrap();
    let number = |row: usize, name: &str| rows[row][name].as_f64().unwrap();
    assert_eq!(
        (number(0, "torque_Nm"), number(2, "torque_Nm")),
        (50.0, 200.0)
    );
    let [light, heavy] = [0, 2].map(|row| number(row, "loaded_te_mean_rad"));
    assert!(heavy < light && light < -300e-6, "{light} {heavy}");
    let found = SceneResult::read(&result).unwrap();
    let force = found.normal_force_n(2)[0];
    assert!((7000.0..10000.0).contains(&force), "{force}");
    one_table_at_all_doors(&desk, ("pair.toml", "load"), &result, &json);
    // Its bodies are rigid: they have neither strain nor stress.
    let strain = desk.path("strain.h5");
    let no_bodies = ["recover", argument(&result), "-o", argument(&strain)];
    refused(&gearmesh(&no_bodies), 2, &["rigid", "models"]);
    for (from, to, parts) in [
        (
            "torques_Nm = [50.0, 100.0, 200.0]",
            "torques_Nm = []",
            ["found 0 torques", "1 to 20"],
        ),
        (
            "torques_Nm = [50.0, 100.0, 200.0]",
            "torques_Nm = [-5.0]",
            ["torques_Nm.0", "more than 0"],
        ),
        ("slices = 15", "slices = 2", ["slices", "3 to 100"]),
        ("slices = 15", "models = [\"a.h5\", \"b.h5\"]", ["a.h5", ""]),
        (
            "slices = 15",
            "models = [\"a.h5\", \"b.h5\"]\npoisson = 0.2",
            ["poisson", "is not used with `models`"],
        ),
    ] {
        let wrong = desk.file("wrong.toml", quick.replace(from, to));
        let run = ["run", argument(&wrong), "-o", argument(&result)];
        refused(&gearmesh(&run), 2, &parts);
    }
}

/// Contact analysis of a flank from points says how well it fits and what that is beside the transmission error: in
/// print, in the page, in JSON. Tables with other separators are told apart.
#[test]
fn contact_of_points_says_what_they_are_worth() {
    let desk = Desk::new();
    let shipped = shipped("bevel_13_35.toml");
    let design = PairFile::read(shipped.as_ref()).unwrap().design().unwrap();
    for flank in &design.teeth[1].flanks {
        desk.file(
            &format!("{}.csv", flank.side.word()),
            points_of_flank(flank, [9, 5]),
        );
    }
    let text = std::fs::read_to_string(&shipped).unwrap();
    let settings =
        "settings = \"points\"\nconcave_points = \"concave.csv\"\nconvex_points = \"convex.csv\"";
    let text = changed(
        &text,
        "settings = \"basic\"\nedge_radius_mm = 0.5",
        settings,
    );
    let file = desk.file("pair.toml", text);
    let page = desk.path("page.html");
    let report = ["tca", argument(&file), "--report", argument(&page)];
    let printed = succeeds(&report).stdout;
    let line = printed.lines().nth(1).unwrap();
    assert!(
        line.starts_with("gear's convex: 9 x 5 points") && line.contains("turn the gear by"),
        "{line}"
    );
    // Each table has its own mean point on +x: both together have no thickness.
    let thickness = printed.lines().nth(2).unwrap();
    assert!(
        thickness.starts_with("warning: gear: ") && thickness.contains("points_origin_mm"),
        "{thickness}"
    );
    // The page has units as in print.
    let words = line.split(':').nth(1).unwrap();
    let words = words.replace(" um", " µm").replace("urad", "µrad");
    assert!(std::fs::read_to_string(&page).unwrap().contains(&words));
    let json = succeeds(&["tca", argument(&file), "--json"]).json();
    let [pinion, gear] = [0, 1].map(|i: usize| &json["fit_of_points"][i]);
    assert!(
        pinion.is_null() && gear["points"] == serde_json::json!([9, 5]),
        "{json}"
    );
    // The arm of the normal about the gear's axis: 83 mm of mean radius, by both angles' cosines.
    let numbers = line.rsplit("; ").next().unwrap().split(' ');
    let numbers: Vec<f64> = numbers.filter_map(|word| word.parse().ok()).collect();
    let arm_mm = 1e3 * numbers[0] / numbers[1];
    assert!(
        (arm_mm / (83.12 * 0.8192 * 0.9397) - 1.0).abs() < 0.02,
        "{arm_mm}"
    );
    let table = std::fs::read_to_string(desk.path("convex.csv")).unwrap();
    for (from, to, told) in [
        (
            ",",
            ";",
            "names none of the wanted columns; this line has semicolons",
        ),
        (
            ",",
            "\t",
            "names none of the wanted columns; this line has tabs",
        ),
    ] {
        desk.file("convex.csv", table.replace(from, to));
        refused(
            &gearmesh(&["tca", argument(&file)]),
            2,
            &["convex.csv:1", told],
        );
    }
}

/// A zerol pair under a light load touches inside its flanks: of a load on tips nothing is said but 0. Straight teeth
/// have no body, and the refusal asks for no key that they refuse.
#[test]
fn zerol_and_straight_pairs() {
    let desk = Desk::new();
    let pair = |form: &str, cut: &str| {
        format!(
            "title = \"20/31\"\n[bevel]\nteeth = [20, 31]\nouter_module_mm = 4.0\nface_width_mm = [18.0, 18.0]\n{form}\n[gear]\n{cut}\n[pinion]\n"
        )
    };
    let zerol = pair(
        "form = \"zerol\"\npinion_hand = \"left\"\ncutter_radius_mm = 76.2",
        "settings = \"basic\"\nedge_radius_mm = 0.3",
    );
    let asked = "settings = \"local-synthesis\"\nedge_radius_mm = 0.3\npath_angle_deg = [90.0, 90.0]\nellipse_half_length_mm = [5.0, 5.0]\n\
        transmission_curvature = [-0.003, -0.003]\n[load]\ntorques_Nm = [20.0]\nslices = 15\npositions_per_pitch = 8\n";
    let file = desk.file("zerol.toml", zerol + asked);
    let result = desk.path("zerol.h5");
    let found = succeeds(&["run", argument(&file), "-o", argument(&result), "--json"]).json();
    let share = &found["rows"][0]["load_on_tips_share"];
    assert_eq!(share.to_string(), "0.0", "{found}");
    let straight = pair("form = \"straight\"", "settings = \"crown\"");
    desk.file("straight.toml", straight + "settings = \"crown\"\n");
    let body = "name = \"gear\"\n[bevel_gear]\npair = \"straight.toml\"\nmember = \"gear\"\n[blank]\nbore_diameter_mm = 24.0\n\
        [material]\nyoung_GPa = 206.0\npoisson = 0.3\n";
    let body = desk.file("gear.toml", body);
    let told = ["gear.toml:4: bevel_gear.member", "bodies are made of"];
    refused(&gearmesh(&["check", argument(&body)]), 2, &told);
}

/// The page draws both flanks with an ellipse for each position that leads, and takes no other name.
#[test]
fn the_page_of_a_contact_analysis_has_its_pattern() {
    let desk = Desk::new();
    let file = desk.file(
        "pair.toml",
        std::fs::read_to_string(shipped("bevel_20_20.toml")).unwrap(),
    );
    let page = desk.file("page.html", "");
    let asked = [
        "tca",
        argument(&file),
        "--json",
        "--report",
        argument(&page),
    ];
    let json = succeeds(&asked).json();
    let html = std::fs::read_to_string(&page).unwrap();
    for part in [
        "Contact pattern",
        "Flank: convex of the gear",
        "Flank: concave of the pinion",
        "Flank: convex of the pinion",
        "V/H check",
        ">toe</text>",
        "Ease-off",
        "pinion axial, mm per mm",
    ] {
        assert!(html.contains(part), "`{part}` is not in the page");
    }
    // Both sides of the teeth, at equal steps.
    let ellipses = |side: &serde_json::Value| {
        let path = side["path"].as_array().unwrap();
        let drawn = path.iter().filter(|p| {
            let lengths = p["ellipse_half_lengths_mm"].as_array();
            p["first"] == true
                && p["between_steps"] == false
                && lengths.is_some_and(|l| l.iter().all(|x| x.is_number()))
        });
        drawn.count()
    };
    let drawn = html.matches("fill-opacity=\"0.13\"").count();
    let expected = ellipses(&json) + ellipses(&json["other_side"]);
    assert_eq!(drawn, 2 * expected);
    assert!(drawn > 20, "{drawn}");
    let other = desk.file("page.pdf", "");
    let wrong = ["tca", argument(&file), "--report", argument(&other)];
    refused(
        &gearmesh(&wrong),
        2,
        &["--report", ".pdf: this writes", ".html"],
    );
    let same = ["tca", argument(&file), "--report", argument(&file)];
    refused(&gearmesh(&same), 2, &[]);
}

#[test]
fn what_cannot_be_cut_is_refused() {
    let desk = Desk::new();
    let text = std::fs::read_to_string(shipped("bevel_13_35.toml")).unwrap();
    for (from, to, expected) in [
        (
            "settings = \"basic\"",
            "settings = \"ease-off\"\nlengthwise_um = [1.0, 1.0]\nprofile_um = [1.0, 1.0]",
            "gear.settings: is for the pinion",
        ),
        (
            "path_angle_deg = [100.0, 80.0]\n",
            "",
            "pinion.path_angle_deg: missing",
        ),
        (
            "[8.0, 8.0]",
            "[0.1, 8.0]",
            "bad.toml:17: pinion: local synthesis: ",
        ),
        (
            "edge_radius_mm = 0.5\n\n",
            "edge_radius_mm = 0.5\nbias_um = [1.0, 1.0]\n\n",
            "gear: `bias_um` belongs to settings \"ease-off\", not to \"basic\"",
        ),
        (
            "edge_radius_mm = 0.5\n\n",
            "edge_radius_mm = 0.5\npoint_width_mm = 9.0\n\n",
            "bad.toml:13: gear: the gear's blade does not fit",
        ),
        (
            "teeth = [13, 35]",
            "teeth = [6, 35]",
            "bad.toml:17: pinion: the pinion's",
        ),
        (
            "teeth = [13, 35]",
            "teeth = [13, 35]\noffset_mm = 20.0",
            "bad.toml:7: bevel.offset_mm: hypoid pairs",
        ),
    ] {
        let changed = text.replacen(from, to, 1);
        assert_ne!(changed, text, "{from}");
        let bad = desk.file("bad.toml", &changed);
        refused(&gearmesh(&["tca", argument(&bad)]), 2, &[expected]);
    }
    // Of a body and of a scene the complaint names their own key and the place in the pair file.
    desk.file("pair.toml", text.replace("[13, 35]", "[6, 35]"));
    let at_fault = "pair.toml:17: pinion: the pinion's";
    let body = std::fs::read_to_string(shipped("bevel_pinion_13_35.toml")).unwrap();
    let body = desk.file("body.toml", changed(&body, "bevel_13_35.toml", "pair.toml"));
    let mesh = desk.path("mesh.vtu");
    for command in ["mesh", "reduce"] {
        let answer = gearmesh(&[
            command,
            argument(&body),
            "-o",
            argument(&mesh.with_extension(match command {
                "mesh" => "vtu",
                _ => "h5",
            })),
        ]);
        refused(&answer, 2, &["body.toml:", "bevel_gear.pair: ", at_fault]);
    }
    let scene = std::fs::read_to_string(shipped("dynamics_bevel_20_20.toml")).unwrap();
    let scene = desk.file("scene.toml", scene.replace("bevel_20_20.toml", "pair.toml"));
    let answer = gearmesh(&["run", argument(&scene), "-o", argument(&desk.path("o.h5"))]);
    refused(
        &answer,
        2,
        &["scene.toml:", "gear_mesh.0.bevel_pair: ", at_fault],
    );
}

/// Stated settings make the tooth, and every command says by how much it is not the blank's; the nominal grid goes into
/// a folder.
#[test]
fn the_thickness_that_settings_cut_is_said_everywhere() {
    let desk = Desk::new();
    let file = shipped("bevel_38_51.toml");
    let page = desk.path("page.html");
    let words = "4.656 mm thick on the mean circle (3.813 mm normal) as its settings cut both flanks, 4.893 mm";
    for asked in [
        vec!["check", &file],
        vec!["bevel", &file],
        vec!["tca", &file, "--report", argument(&page)],
    ] {
        let printed = succeeds(&asked).stdout;
        assert!(printed.contains(words), "{printed}");
        assert!(printed.contains(
            "backlash at the mean point by these thicknesses 0.183 mm, by the file 0.000 mm"
        ));
    }
    assert!(std::fs::read_to_string(&page).unwrap().contains(words));
    for command in ["bevel", "tca", "check"] {
        let json = succeeds(&[command, &file, "--json"]).json();
        let thickness = match command {
            "bevel" => &json["gear"]["thickness"],
            "tca" => &json["thickness"][1],
            _ => &json["gear_thickness"],
        };
        assert_eq!(thickness["counts_from"], "settings", "{command}");
        let mm = ["counts_mm", "blank_mm"].map(|key| thickness[key].as_f64().unwrap());
        assert!(
            (mm[0] - 4.656).abs() < 1e-3 && (mm[1] - 4.893).abs() < 1e-3,
            "{mm:?}"
        );
    }
    let grids = desk.path("grids");
    succeeds(&[
        "bevel",
        &file,
        "--grid",
        argument(&grids),
        "--grid-size",
        "5",
        "4",
    ]);
    for name in [
        "pinion-concave",
        "pinion-convex",
        "gear-concave",
        "gear-convex",
    ] {
        let table = std::fs::read_to_string(grids.join(format!("{name}.csv"))).unwrap();
        assert_eq!(table.lines().count(), 21, "{name}");
    }
}

/// Assemblies that jam are refused, conjugate pairs show their ease-off, and pressures that no steel carries are warned
/// of.
#[test]
fn contact_analysis_says_what_is_wrong() {
    let desk = Desk::new();
    let text = std::fs::read_to_string(shipped("bevel_20_20.toml")).unwrap();
    let far = desk.file("far.toml", format!("{text}\n[tca]\noffset_um = -5000.0\n"));
    refused(
        &gearmesh(&["tca", argument(&far)]),
        1,
        &[
            "far.toml:",
            "teeth jam: while the pinion's concave flanks touch",
        ],
    );
    refused(
        &gearmesh(&["check", argument(&far)]),
        1,
        &["far.toml:", "teeth jam"],
    );
    let near = desk.file(
        "near.toml",
        format!("{text}\n[tca]\ngear_axial_um = -100.0\n"),
    );
    for command in ["tca", "check"] {
        let run = succeeds(&[command, argument(&near)]);
        assert!(run.stderr.contains("warning: teeth jam"), "{}", run.stderr);
    }
    // Both ways of the V/H check, found or not, have their rows.
    let run = succeeds(&["tca", &shipped("bevel_20_20.toml")]).stdout;
    for way in ["offset", "shaft angle"] {
        for end in ["toe", "heel"] {
            assert!(run.contains(&format!("{end} by {way}")), "{run}");
        }
    }
    let loaded = std::fs::read_to_string(shipped("bevel_20_20_loaded.toml")).unwrap();
    let heavy = changed(&loaded, "[50.0, 100.0, 200.0]", "[5000.0]")
        .replace("positions_per_pitch = 16", "positions_per_pitch = 4");
    let heavy = desk.file("heavy.toml", heavy);
    let result = desk.path("heavy.h5");
    let run = succeeds(&["run", argument(&heavy), "-o", argument(&result)]);
    assert!(
        run.stderr
            .contains("at 5000 N m: elastic material: the Hertz pressure reaches"),
        "{}",
        run.stderr
    );
    let head = text.split("[gear]").next().unwrap();
    let crown = "[gear]\nsettings = \"crown\"\nedge_radius_mm = 0.2\n[pinion]\nsettings = \"crown\"\nedge_radius_mm = 0.2\n";
    let conjugate = desk.file("crown.toml", format!("{head}{crown}"));
    let page = desk.path("crown.html");
    let run = succeeds(&["tca", argument(&conjugate), "--report", argument(&page)]).stdout;
    let first = run.lines().next().unwrap();
    assert!(
        first.contains("conjugate, the flanks touch along lines"),
        "{first}"
    );
    let ease_off = run.lines().skip_while(|line| !line.starts_with("ease-off"));
    let values = ease_off.skip(1).take(45).map(|line| {
        let cell = line.split_whitespace().nth(2).unwrap();
        cell.parse::<f64>().unwrap().abs()
    });
    assert!(values.fold(0.0, f64::max) < 1e-3, "{run}");
    let json = succeeds(&["tca", argument(&conjugate), "--json"]).json();
    assert!(json["conjugate"] == true && json["ease_off_mm_mm_um"].as_array().unwrap().len() == 45);
}
