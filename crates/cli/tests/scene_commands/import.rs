//! `gearmesh import`: the shipped REXS gearbox becomes files that the program accepts, and its bearings carry what
//! hand statics say.

use super::random_gearboxes::centre_mm;
use super::shipped_gearboxes::coarse;
use crate::common::{Desk, argument, changed, gearmesh, names_in, refused, succeeds};
use gearmesh_scene::system_run::SystemResult;
use std::path::Path;

/// Forces of the bearings on the shafts \[N\]: tools/reference/gearbox_statics.py.
const BY_HAND: &str = include_str!("../../../../reference/gearbox_three_stage/data.csv");

#[test]
fn a_gearbox_of_three_stages_is_imported_and_runs() {
    let desk = Desk::new();
    let model =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fe_models/gearbox_three_stage.rexs");
    let folder = desk.path("imported");
    let answer = succeeds(&[
        "import",
        argument(&model),
        "-o",
        argument(&folder),
        "--json",
    ]);
    let told = answer.json();
    assert_eq!(told["scenes"].as_array().unwrap().len(), 2);
    let files = names_in(&folder);
    for file in files.iter().filter(|name| name.ends_with(".toml")) {
        succeeds(&["check", argument(&folder.join(file))]);
    }
    let list = std::fs::read_to_string(folder.join("import.md")).unwrap();
    for words in [
        "## Not represented",
        "viscosity_at_40_degree_celsius 220",
        "stands for rigid",
        "number_of_teeth 17",
    ] {
        assert!(list.contains(words), "{words} is not in {list}");
    }
    let (scene, output) = (
        folder.join("gearbox_three_stage.toml"),
        desk.path("result.h5"),
    );
    succeeds(&["run", argument(&scene), "-o", argument(&output)]);
    let result = SystemResult::open(&output).unwrap();
    bearings_carry_what_statics_say(&result);
    let input = result
        .rows
        .read("elements/held at motor/moment_z_Nm")
        .unwrap()[0]
        .abs();
    assert!((input / 28.2068 - 1.0).abs() < 1e-4, "{input}");
}

/// Imported to run in time it begins where it stands at rest and stays there, for no mesh excites it: bearings carry
/// what statics say, the drive puts in what the load takes, and energy balances.
#[test]
fn a_gearbox_is_imported_to_run_in_time() {
    let desk = Desk::new();
    let model =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fe_models/gearbox_three_stage.rexs");
    let folder = desk.path("imported");
    let words = [
        "import",
        argument(&model),
        "-o",
        argument(&folder),
        "--transient",
    ];
    succeeds(&words);
    let scene = folder.join("gearbox_three_stage.toml");
    let text = std::fs::read_to_string(&scene).unwrap();
    // 42.9 and 425 Hz are the slowest and the fastest mesh.
    for words in ["kind = \"transient\"", "damping_s", "[[motion]]"] {
        assert!(text.contains(words), "{words} is not in {text}");
    }
    let output = desk.path("result.h5");
    succeeds(&["run", argument(&scene), "-o", argument(&output)]);
    let result = SystemResult::open(&output).unwrap();
    bearings_carry_what_statics_say(&result);
    let torque = (result.rows)
        .read("elements/driven at motor/moment_z_Nm")
        .unwrap();
    for torque in torque {
        assert!((torque.abs() / 28.2068 - 1.0).abs() < 1e-3, "{torque}");
    }
    assert!(result.relative_energy_error().unwrap() < 1e-6);
}

/// The same gearbox imported, its six gears reduced (on coarse meshes), and run: with its first pinion on a bore, and
/// cut into its shaft, which goes on at both faces, with three pairs of diameters: half to eight tenths of the root.
#[test]
fn an_imported_gearbox_of_reduced_gears_runs() {
    let desk = Desk::new();
    let shipped =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fe_models/gearbox_three_stage.rexs");
    let shipped = std::fs::read_to_string(shipped).unwrap();
    let folder = desk.path("imported");
    for (number, diameters) in [None, Some([16, 18]), Some([23, 21]), Some([25, 20])]
        .into_iter()
        .enumerate()
    {
        let text = diameters.map_or(shipped.clone(), |of| with_sections(&shipped, of));
        let model = desk.file("gearbox_three_stage.rexs", text);
        let words = [
            "import",
            argument(&model),
            "-o",
            argument(&folder),
            "--reduced",
            "--transient",
            "--json",
        ];
        let told = succeeds(&words).json();
        let gears = told["gears"].as_array().unwrap();
        assert_eq!(gears.len(), 6);
        for gear in gears {
            let gear = folder.join(gear.as_str().unwrap());
            let text = std::fs::read_to_string(&gear).unwrap();
            let changes = text.contains("teeth = 17\n");
            assert_eq!(changes && number > 0, text.contains("shaft_diameter_mm"));
            let model = gear.with_extension("h5");
            if model.exists() && !changes {
                continue;
            }
            // The intermediate shafts' second pinion drives on the other side.
            let text =
                coarse(&text).replace("flanks = [\"right\"]", "flanks = [\"right\", \"left\"]");
            std::fs::write(&gear, text).unwrap();
            let words = [
                "reduce",
                "--no-error-estimate",
                argument(&gear),
                "-o",
                argument(&model),
            ];
            succeeds(&words);
        }
        let scene = folder.join("gearbox_three_stage.toml");
        let text = std::fs::read_to_string(&scene).unwrap();
        assert!(text.contains("kind = \"hybrid\""));
        std::fs::write(&scene, over_a_pitch(&text)).unwrap();
        let output = desk.path("result.h5");
        succeeds(&["run", argument(&scene), "-o", argument(&output)]);
        bearings_carry_what_line_loads_say(&SystemResult::open(&output).unwrap());
    }
}

/// The imported scene at rest at 60 angles of the motor, over a pitch of the last stage, which is some ten of the
/// first.
fn over_a_pitch(scene: &str) -> String {
    let (start, bodies) = (
        scene.find("[run]").unwrap(),
        scene.find("[[body]]").unwrap(),
    );
    let pitch_deg = 360.0 / 21.0 * (59.0 / 17.0) * (67.0 / 19.0);
    let angles: Vec<f64> = (0..60).map(|k| -pitch_deg * f64::from(k) / 60.0).collect();
    let run = format!(
        "[run]\nkind = \"static\"\nmotion = \"motion of axis of motor\"\nangles_deg = {angles:?}\n\n"
    );
    let scene = format!("{}{run}{}", &scene[..start], &scene[bodies..]);
    // Damping is for runs in time.
    let mut parts = scene.split(", damping_s = ");
    let first = parts.next().unwrap().to_owned();
    first
        + &parts
            .map(|part| &part[part.find(" }").unwrap()..])
            .collect::<String>()
}

/// Widths that the faces of each stage share, and distances between the bearings of each shaft (mm):
/// tools/reference/gearbox_statics.py.
const SHARED_MM: [f64; 3] = [19.0, 30.0, 45.0];
const BETWEEN_MM: [f64; 4] = [60.0, 110.0, 140.0, 100.0];

/// Each bearing, in the mean over a pitch, within 2 % of hand statics beyond what the force of each mesh moves it by
/// where it acts in the centre of its line load, F e over the distance of the bearings. The file's helix corrections
/// are made for thin webs, and its wheels are solid; its first shaft bends.
fn bearings_carry_what_line_loads_say(result: &SystemResult) {
    let by_hand = by_hand();
    let stages = result.stages().unwrap().unwrap();
    // On gear 1 of each mesh: what the bearings of its shaft take, less what the mesh before gives.
    let mut force = [0.0; 2];
    let mut moved_n = [0.0; 4];
    for (mesh, stage) in stages.rows.iter().enumerate() {
        let both = [2 * mesh, 2 * mesh + 1].map(|k| by_hand[k].1);
        force = [0, 1].map(|i| force[i] - both[0][i] - both[1][i]);
        let k_h_beta = stage.load.and_then(|load| load.k_h_beta).unwrap();
        let centre_mm = centre_mm(k_h_beta, SHARED_MM[mesh]);
        for shaft in [mesh, mesh + 1] {
            moved_n[shaft] += force[0].hypot(force[1]) * centre_mm / BETWEEN_MM[shaft];
        }
    }
    let mean = |column: String| {
        let values = result.rows.read(&column).unwrap();
        values.iter().sum::<f64>() / values.len() as f64
    };
    for (place, (off, expected)) in differences(&by_hand, mean).into_iter().enumerate() {
        let beyond = (off - moved_n[place / 2]).max(0.0) / expected;
        assert!(beyond < 0.02, "{}: {off} {beyond}", by_hand[place].0);
    }
}

/// The exchange file with the first pinion cut into its shaft: a section of 28 mm under its face, others before and
/// behind it.
fn with_sections(shipped: &str, [before, behind]: [u32; 2]) -> String {
    let mut text = changed(
        shipped,
        "\"inner_diameter\" unit=\"mm\">18<",
        "\"inner_diameter\" unit=\"mm\">0<",
    );
    for end in ["begin", "end"] {
        let [old, first, second] =
            [26, before, behind].map(|d| format!("\"outer_diameter_{end}\" unit=\"mm\">{d}<"));
        assert_eq!(text.matches(&old).count(), 2);
        text = text.replacen(&old, &first, 1).replacen(&old, &second, 1);
    }
    // From u = 30 to 48 and from 72 to 90 mm, in place of 60 mm.
    let place = |u: u32, length: u32| {
        let [u, length] = [("u_coordinate_on_shaft", u), ("length", length)]
            .map(|(id, value)| format!("<attribute id=\"{id}\" unit=\"mm\">{value}</attribute>"));
        format!("{u}\n      {length}")
    };
    let text = changed(&text, &place(30, 30), &place(30, 18));
    let text = changed(&text, &place(60, 30), &place(72, 18));
    let section = format!(
        "<component id=\"103\" type=\"shaft_section\" name=\"\">{}<attribute id=\"outer_diameter_begin\" unit=\"mm\">28</attribute>\
         <attribute id=\"outer_diameter_end\" unit=\"mm\">28</attribute></component>\n    ",
        place(48, 24)
    );
    let next = "<component id=\"11\" type=\"shaft\"";
    let text = changed(&text, next, &format!("{section}{next}"));
    let relation = "<relation id=\"9007\" type=\"assembly\"><ref id=\"10\" role=\"assembly\"/><ref id=\"103\" role=\"part\"/></relation>\n  ";
    changed(&text, "</relations>", &format!("{relation}</relations>"))
}

/// Forces of the bearings on the shafts (N), in the order of the shafts.
fn by_hand() -> Vec<(String, [f64; 3])> {
    let of_row = |row: &str| {
        let (bearing, numbers) = row.split_once(',').unwrap();
        let mut numbers = numbers.split(',').map(|v| v.parse().unwrap());
        (
            bearing.to_owned(),
            [(); 3].map(|()| numbers.next().unwrap()),
        )
    };
    BY_HAND.lines().skip(1).map(of_row).collect()
}

/// Of each bearing how far its force is from the expected one, and the size of that (N). `read`: a figure of a column.
fn differences(expected: &[(String, [f64; 3])], read: impl Fn(String) -> f64) -> Vec<(f64, f64)> {
    let norm = |v: [f64; 3]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
    let of = |(bearing, expected): &(String, [f64; 3])| {
        // The exchange file has the shafts along x: its x, y, z are z, x, y of the figures by hand.
        let found =
            ["y", "z", "x"].map(|axis| read(format!("elements/{bearing}/force_world_{axis}_N")));
        (
            norm([0, 1, 2].map(|i| found[i] - expected[i])),
            norm(*expected),
        )
    };
    assert_eq!(expected.len(), 8);
    expected.iter().map(of).collect()
}

/// Each bearing within 2 % of hand statics, in the last row.
fn bearings_carry_what_statics_say(result: &SystemResult) {
    let by_hand = by_hand();
    let last = |column: String| *result.rows.read(&column).unwrap().last().unwrap();
    for ((bearing, _), (off, expected)) in by_hand.iter().zip(differences(&by_hand, last)) {
        assert!(off < 0.02 * expected, "{bearing}: {off} of {expected}");
    }
}

#[test]
fn what_cannot_be_imported_is_told_with_the_line() {
    let desk = Desk::new();
    let broken = desk.file(
        "broken.rexs",
        "<model version=\"1.4\">\n<components>\n</model>",
    );
    let answer = gearmesh(&[
        "import",
        argument(&broken),
        "-o",
        argument(&desk.path("out")),
    ]);
    refused(&answer, 2, &["broken.rexs", "line 3", "broken XML"]);
    let answer = gearmesh(&["import", "nothing.rexs", "-o", argument(&desk.path("out"))]);
    refused(&answer, 2, &["nothing.rexs"]);
}

/// A component of a REXS file with its attributes.
fn component(id: usize, kind: &str, name: &str, attributes: &[(&str, &str, &str)]) -> String {
    let attributes: String = (attributes.iter())
        .map(|(key, unit, value)| {
            format!("<attribute id=\"{key}\" unit=\"{unit}\">{value}</attribute>")
        })
        .collect();
    format!("<component id=\"{id}\" type=\"{kind}\" name=\"{name}\">{attributes}</component>\n")
}

/// Seed 001's pair on two shafts that cross, each overhung on two bearings, as a REXS file.
fn bevel_gearbox() -> String {
    let mut parts = component(1, "gear_unit", "unit", &[]);
    let mut relations = Vec::new();
    let mut relate = |kind: &str, refs: &[(usize, &str)]| {
        let refs: String = (refs.iter())
            .map(|(id, role)| format!("<ref id=\"{id}\" role=\"{role}\"/>"))
            .collect();
        let id = relations.len() + 1;
        relations.push(format!(
            "<relation id=\"{id}\" type=\"{kind}\">{refs}</relation>\n"
        ));
    };
    parts += &component(2, "gear_casing", "casing", &[]);
    relate("assembly", &[(1, "assembly"), (2, "part")]);
    let vector = |v: [i32; 3]| v.map(|x| format!("<c>{x}</c>")).concat();
    for (i, (name, u, hand)) in [("pinion", [1, 0, 0], "left"), ("gear", [0, 1, 0], "right")]
        .into_iter()
        .enumerate()
    {
        let [shaft, section, gear, load] = [10, 20, 30, 40].map(|k| k + i);
        let array = |v: [i32; 3]| format!("<array>{}</array>", vector(v));
        let place = [
            ("reference_component_for_position", "none", "1".to_owned()),
            ("support_vector", "mm", array([0, 0, 0])),
            ("u_axis_vector", "mm", array(u)),
            ("w_axis_vector", "mm", array([0, 0, 1])),
        ];
        let place: Vec<_> = place
            .iter()
            .map(|(k, unit, v)| (*k, *unit, &v[..]))
            .collect();
        parts += &component(shaft, "shaft", &format!("{name} shaft"), &place);
        let of_section = [
            ("length", "mm", "200"),
            ("outer_diameter_begin", "mm", "40"),
            ("outer_diameter_end", "mm", "40"),
            ("inner_diameter_begin", "mm", "0"),
            ("inner_diameter_end", "mm", "0"),
        ];
        parts += &component(section, "shaft_section", "", &of_section);
        // The mean point stands 42 mm off the apex, 29.6984 mm along the axis; the face is 15 mm wide.
        let of_gear = [
            ("number_of_teeth", "none", "20"),
            ("u_coordinate_on_shaft", "mm", "22.1985"),
            ("face_width", "mm", "15"),
            ("outer_pitch_diameter", "mm", "70"),
            ("mean_spiral_angle", "deg", "35"),
            ("spiral_angle_pitch_direction", "none", hand),
            ("bevel_cone_orientation", "none", "negative"),
        ];
        parts += &component(gear, "bevel_gear", name, &of_gear);
        let mut of_load = vec![
            ("u_coordinate_on_shaft", "mm", "200"),
            ("transmits_torque", "none", "true"),
        ];
        if i == 0 {
            of_load.push(("torque_around_u_axis", "N m", "100"));
        }
        parts += &component(load, "external_load", &format!("{name} torque"), &of_load);
        relate("assembly", &[(1, "assembly"), (shaft, "part")]);
        relate("assembly", &[(shaft, "assembly"), (section, "part")]);
        relate("assembly", &[(shaft, "assembly"), (gear, "part")]);
        relate("assembly", &[(shaft, "assembly"), (load, "part")]);
        for (k, (place, axial)) in [("70", "both_directions"), ("150", "no")]
            .into_iter()
            .enumerate()
        {
            let bearing = 50 + 10 * i + k;
            let of_bearing = [
                ("u_coordinate_on_shaft_inner_side", "mm", place),
                ("axial_force_absorption", "none", axial),
                ("radial_force_absorption", "none", "true"),
                ("radial_stiffness", "N / mm", "1e6"),
            ];
            parts += &component(
                bearing,
                "concept_bearing",
                &format!("{name} {place}"),
                &of_bearing,
            );
            relate(
                "side",
                &[
                    (bearing, "assembly"),
                    (shaft, "inner_part"),
                    (2, "outer_part"),
                ],
            );
        }
    }
    let of_stage = [
        ("shaft_angle", "deg", "90"),
        ("nominal_design_pressure_angle_on_drive_side", "deg", "20"),
    ];
    parts += &component(70, "bevel_stage", "stage", &of_stage);
    relate("assembly", &[(1, "assembly"), (70, "part")]);
    relate("stage", &[(70, "stage"), (30, "gear_1"), (31, "gear_2")]);
    format!(
        "<model version=\"1.7\" applicationId=\"test\" applicationVersion=\"1\" date=\"2026-11-22T12:00:00+00:00\">\n\
         <relations>\n{}</relations>\n<components>\n{parts}</components>\n</model>\n",
        relations.concat()
    )
}

/// Seed 001 at 100 N m: 3367 N along the circle, 2725 and -609 N along and across the axes. The left-hand pinion turns
/// counter-clockwise, seen from its back, and is pulled to the apex.
#[test]
fn bearings_of_a_bevel_stage_carry_its_forces() {
    let desk = Desk::new();
    let model = desk.file("bevel.rexs", bevel_gearbox());
    let folder = desk.path("imported");
    succeeds(&["import", argument(&model), "-o", argument(&folder)]);
    let list = std::fs::read_to_string(folder.join("import.md")).unwrap();
    assert!(
        list.contains("radial and axial forces act on the shaft"),
        "{list}"
    );
    let output = desk.path("result.h5");
    succeeds(&[
        "run",
        argument(&folder.join("bevel.toml")),
        "-o",
        argument(&output),
    ]);
    let result = SystemResult::open(&output).unwrap();
    let force = |bearing: &str| {
        ["x", "y", "z"].map(|axis| {
            let column = format!("elements/{bearing}/force_world_{axis}_N");
            *result.rows.read(&column).unwrap().last().unwrap()
        })
    };
    let half = 0.5f64.sqrt();
    let mean_m = 42e-3 * half;
    let tangential = 100.0 / mean_m;
    let (along, across) = (
        35f64.to_radians().tan(),
        20f64.to_radians().tan() / 35f64.to_radians().cos(),
    );
    // On the pinion: towards the apex, off the mate, against its turn.
    let [x, y, z] =
        [half * (across - along), -half * (across + along), -1.0].map(|share| share * tangential);
    assert!((x + 609.0).abs() < 3.0 && (y + 2725.0).abs() < 3.0 && (z + 3367.0).abs() < 1.0);
    // Moments about the near bearing, 70 mm from the apex; the other one is 80 mm further.
    let arm = mean_m - 70e-3;
    let far = [0.0, -(arm * y - mean_m * x) / 80e-3, -arm * z / 80e-3];
    let near = [-x, -y - far[1], -z - far[2]];
    // On the gear the opposite at the same point; its axis is y.
    let far_gear = [(arm * x - mean_m * y) / 80e-3, 0.0, arm * z / 80e-3];
    let near_gear = [x - far_gear[0], y, z - far_gear[2]];
    for (bearing, expected) in [
        ("pinion 70", near),
        ("pinion 150", far),
        ("gear 70", near_gear),
        ("gear 150", far_gear),
    ] {
        let found = force(bearing);
        let off: f64 = (found.iter().zip(expected))
            .map(|(f, e)| (f - e).powi(2))
            .sum::<f64>()
            .sqrt();
        assert!(off < 5.0, "{bearing}: {found:?} {expected:?}");
    }
}

/// An idler that turns on a needle bearing on its axle, between two gears of 20 teeth on either side: 30 N m at the
/// working pitch radius of 60.05 mm/3 push it the same way twice, and the axle's bearings carry what the needle bearing
/// hands on.
#[test]
fn an_idler_on_a_bearing_loads_its_axle() {
    let desk = Desk::new();
    let model = desk.path("idler.rexs");
    std::fs::write(&model, include_str!("idler_on_bearing.rexs")).unwrap();
    let (folder, output) = (desk.path("imported"), desk.path("result.h5"));
    succeeds(&["import", argument(&model), "-o", argument(&folder)]);
    let scene = folder.join("idler.toml");
    succeeds(&["run", argument(&scene), "-o", argument(&output)]);
    let result = SystemResult::open(&output).unwrap();
    let force = |bearing: &str, axis: &str| {
        let column = format!("elements/{bearing}/force_world_{axis}_N");
        result.rows.read(&column).unwrap()[0]
    };
    let by_hand = 2.0 * 30.0 / (60.05e-3 / 3.0);
    let needle = force("needle", "z");
    let axle = force("axle b0", "z") + force("axle b1", "z");
    assert!((needle / by_hand - 1.0).abs() < 1e-3, "{needle} {by_hand}");
    assert!((axle / by_hand + 1.0).abs() < 1e-3, "{axle} {by_hand}");
    assert!(force("needle", "y").abs() < 1e-3 * by_hand);
}
