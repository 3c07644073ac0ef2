//! Universal files, written and read, and `gearmesh record`: measured curves become records that `compare` takes.

use crate::common::{
    Desk, argument, changed, gearmesh, names_in, refused, run_scene, succeeds, workshop,
};
use gearmesh_mesh::python::PythonEnvironment;
use gearmesh_report::ReferenceRecord;
use gearmesh_scene::SceneResult;
use gearmesh_scene::system_run::SystemResult;
use serde_json::Value;
use std::path::Path;

/// A wheel that a torque turns for a second.
const WHEEL: &str = include_str!("../../../../tests/support/wheel.toml");

/// What pyuff reads of the data sets 58.
fn functions(path: &Path) -> Vec<Value> {
    let script = "
import json, sys, pyuff
sets = [s for s in pyuff.UFF(sys.argv[1]).read_sets() if s['type'] == 58]
json.dump([{k: v.tolist() if hasattr(v, 'tolist') else v for k, v in s.items()} for s in sets], sys.stdout)
";
    let python = PythonEnvironment::find().unwrap();
    let told = python.run("reading", script, &[argument(path)], b"");
    serde_json::from_slice(&told.unwrap()).unwrap()
}

fn numbers(value: &Value) -> Vec<f64> {
    let all = value.as_array().unwrap().iter();
    all.map(|x| x.as_f64().unwrap()).collect()
}

fn close(found: &[f64], expected: &[f64], relative: f64) {
    assert_eq!(found.len(), expected.len());
    let scale = expected.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    for (a, b) in found.iter().zip(expected) {
        assert!((a - b).abs() <= relative * scale, "{a} {b}");
    }
}

#[test]
fn curves_of_a_pair_go_out_as_a_universal_file_and_come_back_as_a_record() {
    let desk = Desk::new();
    // A whole revolution, as a record has.
    let scene = changed(&workshop().scene(""), "pitches = 3", "pitches = 18");
    let (scene, file) = (desk.file("scene.toml", scene), desk.path("result.h5"));
    succeeds(&["run", argument(&scene), "-o", argument(&file)]);
    let result = SceneResult::read(&file).unwrap();
    let output = desk.path("curves.uff");
    succeeds(&["export", argument(&file), "-o", argument(&output)]);
    // Columns as the format states them: number of data set, kind of data and count, units of the axes.
    let text = std::fs::read_to_string(&output).unwrap();
    assert!(text.starts_with("    -1\n   164") && text.ends_with("    -1\n"));
    let lines: Vec<&str> = text.lines().collect();
    let begin = 1 + lines.iter().position(|l| l.starts_with("    58")).unwrap();
    assert_eq!(lines[begin].trim_end(), "te_m");
    let count = format!("{:>10}{:>10}{:>10}", 4, result.angles(), 1);
    assert!(lines[begin + 6].starts_with(&count), "{}", lines[begin + 6]);
    assert_eq!(&lines[begin + 7][26..49], "angle_rad            ra");
    assert_eq!(&lines[begin + 8][..10], "         8");
    let found = functions(&output);
    for (torque, nm) in result.torque_nm.iter().enumerate() {
        let of = |name: &str| {
            let wanted = |f: &&Value| f["id1"] == name && f["id3"] == format!("torque_Nm = {nm}");
            found.iter().find(wanted).unwrap()
        };
        let te = of("te_m");
        assert_eq!(te["ordinate_axis_units_lab"], "m");
        close(
            &numbers(&te["data"]),
            result.curve(&result.te_m, torque),
            1e-11,
        );
        // Places on the axis have six digits in this format.
        close(&numbers(&te["x"]), &result.angle_rad, 1e-5);
        let stiffness = of("stiffness_secant_N_per_m");
        let secant = result.curve(&result.secant_n_per_m, torque);
        close(&numbers(&stiffness["data"]), secant, 1e-11);
        let strain = of("strain_gear2_tension_method2");
        let strain_2 = result.curve(&result.strain[0].method_2, torque);
        close(&numbers(&strain["data"]), strain_2, 1e-11);
    }

    // Back again: channels listed, and a record that shows no difference.
    let listed = succeeds(&["record", argument(&output), "--json"]).json();
    assert_eq!(listed["channels"].as_array().unwrap().len(), found.len());
    // Exponents as Fortran programs write them; functions that are all complex are told by name.
    let fortran = text.replace("E-", "D-").replace("E+", "D+");
    let fortran = desk.file("fortran.uff", fortran);
    let again = succeeds(&["record", argument(&fortran), "--json"]).json();
    assert_eq!(again["channels"], listed["channels"]);
    let pairs = format!("{:>10}{:>10}{:>10}", 6, result.angles() / 2, 1);
    let complex = desk.file("complex.uff", text.replace(&count, &pairs));
    let words = ["record", argument(&complex)];
    refused(
        &gearmesh(&words),
        2,
        &["all its functions are complex (te_m"],
    );
    // Binary sets of either byte order, ended on a line of their own or straight behind the data; one that is cut.
    let head: Vec<&str> = lines[begin..begin + 11].to_vec();
    for (order, end) in [
        (1, "\n    -1\n"),
        (2, "\n    -1\n"),
        (1, "    -1\n"),
        (2, "\r\n    -1\r\n"),
    ] {
        let values = result.curve(&result.te_m, 0);
        let bytes: Vec<u8> = (values.iter())
            .flat_map(|v| {
                if order == 1 {
                    v.to_le_bytes()
                } else {
                    v.to_be_bytes()
                }
            })
            .collect();
        let size = bytes.len();
        let head = head.join("\n");
        let kind = format!(
            "    58b{order:6}{:6}{:12}{size:12}{:6}{:6}{:12}{:12}",
            2, 11, 0, 0, 0, 0
        );
        let begin = format!("    -1\n{kind}\n{head}\n");
        let whole = [begin.as_bytes(), &bytes, end.as_bytes()].concat();
        let listed = succeeds(&[
            "record",
            argument(&desk.file("binary.uff", whole)),
            "--json",
        ])
        .json();
        let range = numbers(&listed["channels"][0]["range"]);
        let extreme = |pick: fn(f64, f64) -> f64| values.iter().copied().reduce(pick).unwrap();
        assert_eq!(range, [extreme(f64::min), extreme(f64::max)]);
        let short = [begin.as_bytes(), &bytes[..size - 9], end.as_bytes()].concat();
        let words = ["record", argument(&desk.file("short.uff", short))].map(str::to_owned);
        refused(&gearmesh(&words), 2, &["short.uff"]);
    }
    let nm = result.torque_nm[0];
    let record = desk.path("record");
    let words = |te: &str| {
        [
            "record".to_owned(),
            argument(&output).to_owned(),
            "-o".to_owned(),
            argument(&record).to_owned(),
            "--title=own".to_owned(),
            "--source=this test".to_owned(),
            "--angle-origin=pitch point".to_owned(),
            format!("--column=te_um_{nm}Nm={te}"),
            format!(
                "--column=strain_tension_ustrain_{nm}Nm=strain_gear2_tension_method2 (torque_Nm = {nm})"
            ),
        ]
    };
    let wrong = gearmesh(&words(&format!("te (torque_Nm = {nm})")));
    refused(
        &wrong,
        2,
        &["no channel", "did you mean `te_m (torque_Nm ="],
    );
    assert!(!record.exists());
    succeeds(&words(&format!("te_m (torque_Nm = {nm})")));
    let read = ReferenceRecord::read(&record).unwrap();
    let first: Vec<f64> = result.curve(&result.te_m, 0).to_vec();
    close(&read.columns[0].values, &first, 1e-10);
    assert_eq!(
        read.columns[1].name,
        format!("strain_tension_ustrain_{nm}Nm")
    );
}

#[test]
fn rows_in_time_have_an_even_axis_and_tables_without_an_axis_are_refused() {
    let desk = Desk::new();
    let scene = desk.file("wheel.toml", WHEEL);
    let result = desk.path("wheel.h5");
    succeeds(&["run", argument(&scene), "-o", argument(&result)]);
    let output = desk.path("wheel.uff");
    succeeds(&["export", argument(&result), "-o", argument(&output)]);
    let found = functions(&output);
    let speed = "bodies/wheel/angular_velocity_z_rad_per_s";
    let turned = found.iter().find(|f| f["id1"] == speed).unwrap();
    let read = SystemResult::open(&result).unwrap();
    close(
        &numbers(&turned["data"]),
        &read.rows.read(speed).unwrap(),
        1e-11,
    );
    close(
        &numbers(&turned["x"]),
        &read.rows.read("time_s").unwrap(),
        1e-5,
    );
    for (key, value) in [
        ("func_type", 1),
        ("abscissa_spec_data_type", 17),
        ("abscissa_spacing", 1),
    ] {
        assert_eq!(turned[key], value, "{key}");
    }
    assert_eq!(turned["ordinate_axis_units_lab"], "rad/s");

    // A folder that cannot be written leaves nothing; a wrong ending is answered with those that are known.
    let (file, _) = run_scene(&desk, "");
    let none = desk.path("none.uff");
    let words = [
        "export",
        argument(&file),
        "-o",
        argument(&none),
        "--table",
        "contact",
    ];
    refused(&gearmesh(&words), 2, &["no functions over an axis"]);
    let before = names_in(&desk.path(""));
    let words = ["export", argument(&file), "-o", "x.xlsx"];
    refused(&gearmesh(&words), 2, &[".csv .parquet .mat .uff"]);
    assert_eq!(names_in(&desk.path("")), before);
}

/// Two turns of gear 2 as a rig writes them: semicolons, decimal commas, a line of units; time, angle, an angular
/// transmission error and a strain in per mille.
fn rig_file(angle: impl Fn(f64) -> f64) -> String {
    let mut text = String::from("# rig 3\nt;phi;TE;root\ns;rad;arcsec;mm/m\n");
    for k in 0..1000 {
        let turns = 2.0 * f64::from(k) / 1000.0;
        let row = [
            0.1 * turns,
            angle(std::f64::consts::TAU * turns),
            -(20.0 + (std::f64::consts::TAU * turns * 31.0).cos()),
            1e-3 * turns,
        ];
        let row = row.map(|x| format!("{x:.9}").replace('.', ","));
        text += &(row.join(";") + "\n");
    }
    text
}

#[test]
fn a_rigs_table_becomes_a_record_in_the_units_of_records() {
    let desk = Desk::new();
    let file = desk.file("rig.csv", rig_file(|angle| angle));
    let folder = desk.path("record");
    let made = |file: &Path, more: &[&str]| {
        let mut words = vec!["record", argument(file), "-o", argument(&folder)];
        words.extend(["--title", "t", "--source", "s", "--angle-origin", "a"]);
        words.extend([
            "--column",
            "te_um_200Nm=TE",
            "--column",
            "strain_root_ustrain_200Nm=root",
        ]);
        words.extend(more);
        gearmesh(&words)
    };
    let radius = ["--base-radius-mm", "100"];
    refused(
        &made(&file, &[]),
        2,
        &["rig.csv", "is a time", "--angle", "--speed-rpm"],
    );
    refused(
        &made(&file, &["--angle", "phi"]),
        2,
        &["arcsec", "--base-radius-mm"],
    );
    let three = [&radius[..], &["--angle", "phi", "--revolutions", "3"]].concat();
    refused(&made(&file, &three), 2, &["3 revolution(s) are 1080 deg"]);
    let unit = [&radius[..], &["--angle", "phi", "--unit", "root=N"]].concat();
    refused(
        &made(&file, &unit),
        2,
        &["`root` has the unit `N`", "ustrain"],
    );
    assert!(!folder.exists());

    let turn = [
        &radius[..],
        &[
            "--angle",
            "phi",
            "--from-deg",
            "90",
            "--angle-offset-deg",
            "-90",
        ],
    ]
    .concat();
    for more in [&["--shaft", "gear_2"][..], &["--negate", "te_um_200Nm"]] {
        let answer = made(&file, &[&turn, more].concat());
        assert_eq!(answer.code, Some(0), "{answer:#?}");
        let record = ReferenceRecord::read(&folder).unwrap();
        assert_eq!(record.angle_rad.len(), 500);
        let sign = if more[0] == "--negate" { -1.0 } else { 1.0 };
        for (k, angle) in record.angle_rad.iter().enumerate() {
            assert!((angle - std::f64::consts::TAU * k as f64 / 500.0).abs() < 1e-8);
            // Arc seconds on 100 mm.
            let turned = angle + std::f64::consts::FRAC_PI_2;
            let te_m = -(20.0 + (31.0 * turned).cos()) / 3600.0_f64 * 0.1_f64.to_radians();
            assert!((record.columns[0].values[k] - sign * te_m).abs() < 1e-13);
            let strain = 1e-6 * (0.25 + k as f64 / 500.0);
            assert!((record.columns[1].values[k] - strain).abs() < 1e-12);
        }
    }
    // At 600 rpm the time is the angle; a shaft that turns clockwise has a falling one; one that swings has none.
    let timed = [&radius[..], &["--speed-rpm", "600"]].concat();
    assert_eq!(made(&file, &timed).code, Some(0));
    let record = ReferenceRecord::read(&folder).unwrap();
    assert!((record.angle_rad[250] - std::f64::consts::PI).abs() < 1e-8);
    let clockwise = desk.file("clockwise.csv", rig_file(|angle| -angle));
    let by_angle = [&radius[..], &["--angle", "phi"]].concat();
    let answer = made(&clockwise, &by_angle);
    assert!(answer.stderr.contains("its sign is changed"), "{answer:#?}");
    // An angle that begins anew after a turn goes on, either way round; of several values at one angle the mean is
    // taken; strain that grows all the time does not repeat.
    let data = |name: &str, angle: &dyn Fn(f64) -> f64, note: &str| {
        let answer = made(&desk.file(name, rig_file(angle)), &turn);
        assert!(answer.stderr.contains(note), "{answer:#?}");
        let ramp = "strain_root_ustrain_200Nm: from its end to its begin is a jump of";
        assert!(answer.stderr.contains(ramp), "{answer:#?}");
        ReferenceRecord::read(&folder).unwrap()
    };
    let tau = std::f64::consts::TAU;
    let plain = data("plain.csv", &|a| a, "outside the revolutions");
    let anew = data("anew.csv", &|a| a % tau, "begins anew 1 times");
    for (a, b) in plain.angle_rad.iter().zip(&anew.angle_rad) {
        assert!((a - b).abs() < 1e-8, "{a} {b}");
    }
    assert_eq!(plain.columns, anew.columns);
    let falling = desk.file("falling.csv", rig_file(|a| tau - a % tau));
    let answer = made(&falling, &by_angle);
    assert!(
        answer.stderr.contains("begins anew 1 times") && answer.code == Some(0),
        "{answer:#?}"
    );
    let pulses = |a: f64| (a / tau * 250.0 + 1e-6).floor() / 250.0 * tau;
    let steps = data("pulses.csv", &pulses, "500 values stand at the angle");
    assert_eq!(steps.angle_rad.len(), 250);
    let two = &plain.columns[1].values[2..4];
    let mean = 0.5 * (two[0] + two[1]);
    assert!(
        (steps.columns[1].values[1] - mean).abs() < 2.1e-9,
        "{mean} {steps:?}"
    );
    let swinging = desk.file("swinging.csv", rig_file(f64::sin));
    refused(&made(&swinging, &by_angle), 2, &["goes to and fro"]);
}

#[test]
fn files_that_are_no_measurement_are_refused_with_the_place() {
    let desk = Desk::new();
    let wheel = desk.file("wheel.toml", WHEEL);
    refused(
        &gearmesh(&["record", argument(&wheel)]),
        2,
        &[".csv .txt .uff .unv .uf"],
    );
    let text = desk.file("text.uff", "no universal file");
    refused(
        &gearmesh(&["record", argument(&text)]),
        2,
        &["text.uff", "no data set 58"],
    );
    let table = desk.file("x.csv", changed(&rig_file(|a| a), "0,000200000", "oops"));
    refused(
        &gearmesh(&["record", argument(&table)]),
        2,
        &["x.csv:5: `oops` under `t`"],
    );
    let (file, _) = run_scene(&desk, "");
    let output = desk.path("curves.uff");
    succeeds(&["export", argument(&file), "-o", argument(&output)]);
    // Lines of numbers lost on the way.
    let text = std::fs::read_to_string(&output).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    let values = lines
        .iter()
        .position(|line| line.starts_with("  -"))
        .unwrap();
    let cut = [&lines[..values], &lines[values + 1..]].concat().join("\n") + "\n";
    let cut = desk.file("cut.uff", cut);
    refused(
        &gearmesh(&["record", argument(&cut)]),
        2,
        &["cut.uff", "the file is cut"],
    );
}
