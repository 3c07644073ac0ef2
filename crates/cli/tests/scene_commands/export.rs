//! `gearmesh export`: every kind of result in every format, read back by the `csv` and `parquet` crates and by SciPy.

use crate::common::{
    Desk, argument, changed, gearmesh, largest_difference, refused, run_scene, succeeds,
};
use gearmesh_mesh::python::PythonEnvironment;
use gearmesh_scene::SceneResult;
use gearmesh_scene::system_run::SystemResult;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::RowAccessor;
use std::collections::BTreeMap;
use std::path::Path;

/// A wheel that a torque turns for a second.
const WHEEL: &str = include_str!("../../../../tests/support/wheel.toml");

/// Columns of numbers by name.
type Columns = BTreeMap<String, Vec<f64>>;

fn exported(desk: &Desk, result: &Path, name: &str, table: Option<&str>) -> std::path::PathBuf {
    let output = desk.path(name);
    let mut words = vec!["export", argument(result), "-o", argument(&output)];
    words.extend(table.iter().flat_map(|table| ["--table", table]));
    succeeds(&words);
    output
}

fn read_csv(path: &Path) -> Columns {
    let mut reader = csv::Reader::from_path(path).unwrap();
    let names: Vec<String> = reader
        .headers()
        .unwrap()
        .iter()
        .map(str::to_owned)
        .collect();
    let mut columns: Vec<Vec<f64>> = vec![Vec::new(); names.len()];
    for record in reader.records() {
        for (column, cell) in columns.iter_mut().zip(&record.unwrap()) {
            column.push(cell.parse().unwrap_or(f64::NAN));
        }
    }
    names.into_iter().zip(columns).collect()
}

fn read_parquet(path: &Path) -> Columns {
    let reader = SerializedFileReader::new(std::fs::File::open(path).unwrap()).unwrap();
    let mut columns = Columns::new();
    for row in reader.get_row_iter(None).unwrap() {
        let row = row.unwrap();
        for (place, (name, _)) in row.get_column_iter().enumerate() {
            let value = row.get_double(place).unwrap_or(f64::NAN);
            columns.entry(name.clone()).or_default().push(value);
        }
    }
    columns
}

/// SciPy's reading of one table of a .mat file: a line with the name, then one with the numbers, of each column.
fn read_mat(path: &Path, table: &str) -> Columns {
    let script = "
import sys
from scipy.io import loadmat
table = loadmat(sys.argv[1], simplify_cells=True)[sys.argv[2]]
data = table['data'].reshape(-1, len(table['columns']))
for name, column in zip(table['columns'], data.T):
    print(name)
    print(*map(repr, map(float, column)))
";
    let python = PythonEnvironment::find().unwrap();
    let told = python
        .run("reading", script, &[argument(path), table], b"")
        .unwrap();
    let told = String::from_utf8(told).unwrap();
    let lines: Vec<&str> = told.lines().collect();
    let numbers = |line: &str| line.split(' ').map(|x| x.parse().unwrap()).collect();
    let pairs = lines.chunks(2);
    pairs.map(|p| (p[0].to_owned(), numbers(p[1]))).collect()
}

/// The same numbers in all three formats.
fn in_every_format(desk: &Desk, result: &Path, table: &str) -> Columns {
    let csv = read_csv(&exported(desk, result, "x.csv", Some(table)));
    let parquet = read_parquet(&exported(desk, result, "x.parquet", Some(table)));
    let mat = read_mat(&exported(desk, result, "x.mat", None), table);
    for other in [&parquet, &mat] {
        assert!(
            csv.keys().eq(other.keys()),
            "{:?} {:?}",
            csv.keys(),
            other.keys()
        );
        for (name, values) in &csv {
            let same = values.iter().zip(&other[name]);
            let same = same.filter(|(a, b)| a == b || (a.is_nan() && b.is_nan()));
            assert_eq!(same.count(), values.len(), "{name}");
        }
    }
    csv
}

#[test]
fn curves_and_contact_of_a_pair() {
    let desk = Desk::new();
    let (file, _) = run_scene(&desk, "");
    let result = SceneResult::read(&file).unwrap();
    let curves = in_every_format(&desk, &file, "curves");
    assert_eq!(curves["te_m"], result.te_m);
    assert_eq!(curves["stiffness_secant_N_per_m"], result.secant_n_per_m);
    assert_eq!(
        curves["strain_gear2_tension_method2"],
        result.strain[0].method_2
    );
    assert_eq!(curves["torque_Nm"][result.angles()], result.torque_nm[1]);
    assert_eq!(
        curves["angle_rad"][result.angles() + 3],
        result.angle_rad[3]
    );

    let contact = in_every_format(&desk, &file, "contact");
    let rows = contact["force_N"].len();
    let sum = |columns: &Columns, name: &str| columns[name].iter().sum::<f64>();
    assert!((sum(&contact, "force_N") / sum(&curves, "normal_force_N") - 1.0).abs() < 1e-12);
    // Line load times width is the force, and shares of the pairs make one.
    let width_m = 12e-3 / result.lines.slices as f64;
    let forces: Vec<f64> = contact["line_load_N_per_m"]
        .iter()
        .map(|q| q * width_m)
        .collect();
    assert!(largest_difference(&forces, &contact["force_N"]) < 1e-9 * sum(&contact, "force_N"));
    let shares: f64 = sum(&contact, "load_share_of_pair") / result.lines.slices as f64;
    assert!((shares / (curves["te_m"].len() as f64) - 1.0).abs() < 1e-12);
    // Pressure where there is force, and there only; contact between base circle and tip over the face.
    for (force, pressure) in contact["force_N"].iter().zip(&contact["pressure_Pa"]) {
        assert_eq!(*force > 0.0, *pressure > 0.0);
    }
    let within = |head: &str, range: std::ops::Range<f64>| {
        assert_eq!(contact[head].len(), rows);
        assert!(contact[head].iter().all(|x| range.contains(x)), "{head}");
    };
    within("roll_1_rad", 0.0..1.0);
    within("z_m", -6e-3..6e-3);
    // Without --table the curves, and a note about the rest.
    let output = desk.path("y.csv");
    let answer = succeeds(&["export", argument(&file), "-o", argument(&output)]);
    assert!(
        answer
            .stderr
            .contains("--table takes another: contact torques"),
        "{answer:#?}"
    );
    assert_eq!(read_csv(&output)["te_m"], result.te_m);
    let told = succeeds(&["export", argument(&file), "-o", argument(&output), "--json"]).json();
    let table = &told["tables"][0];
    assert_eq!(
        (table["name"].as_str(), table["rows"].as_u64()),
        (Some("curves"), Some(result.te_m.len() as u64))
    );
    assert!(
        table["columns"]
            .as_array()
            .unwrap()
            .contains(&"te_m".into())
    );
    let wrong = [
        "export",
        argument(&file),
        "-o",
        argument(&output),
        "--table",
        "rows",
    ];
    refused(
        &gearmesh(&wrong),
        2,
        &["no table `rows`; allowed are curves contact torques"],
    );
}

/// Rows in time, equilibria, windows, modes and a study, of a wheel.
#[test]
fn every_kind_of_multibody_result() {
    let desk = Desk::new();
    let run = |name: &str, text: &str| {
        let scene = desk.file(&format!("{name}.toml"), text);
        let result = desk.path(&format!("{name}.h5"));
        succeeds(&["run", argument(&scene), "-o", argument(&result)]);
        result
    };
    let transient = run("transient", WHEEL);
    let rows = in_every_format(&desk, &transient, "rows");
    let result = SystemResult::open(&transient).unwrap();
    assert_eq!(rows.len(), result.rows.columns().len());
    for column in result.rows.columns() {
        assert_eq!(rows[&column.name], result.rows.read(&column.name).unwrap());
    }

    let sprung = |kind: &str| {
        let start = WHEEL.find("[[body]]").unwrap();
        let spring = |name: &str, stiffness: f64| {
            format!(
                "[[torsion_spring]]\nname = \"{name}\"\nbody_2 = \"wheel\"\nstiffness_Nm_per_rad = {stiffness:?}\n"
            )
        };
        let springs = spring("hard", 150.0) + &spring("soft", 50.0);
        format!(
            "title = \"wheel\"\n[run]\n{kind}\n{}\n{springs}",
            &WHEEL[start..]
        )
    };
    let modes = in_every_format(&desk, &run("eigen", &sprung("kind = \"eigen\"")), "modes");
    // ω² = k/J.
    let hz = (200.0_f64 / 0.5).sqrt() / std::f64::consts::TAU;
    assert!(
        (modes["frequency_Hz"][0] / hz - 1.0).abs() < 1e-9,
        "{modes:?}"
    );
    assert!((modes["participation wheel"][0] - 1.0).abs() < 1e-9);
    assert!((modes["strain energy hard"][0] - 0.75).abs() < 1e-9);
    assert!((modes["strain energy soft"][0] - 0.25).abs() < 1e-9);
    let told = succeeds(&[
        "run",
        argument(&desk.path("eigen.toml")),
        "-o",
        argument(&desk.path("eigen.h5")),
    ]);
    assert!(
        told.stdout.contains("wheel 100.0 %") && told.stdout.contains("hard 75.0 %, soft 25.0 %"),
        "{told:#?}"
    );
    let shapes = in_every_format(&desk, &desk.path("eigen.h5"), "shapes");
    assert_eq!(shapes["real"].len(), 6);
    let rest = run("static", &sprung("kind = \"static\""));
    assert_eq!(
        in_every_format(&desk, &rest, "rows")["load_factor"].len(),
        1
    );
}

/// Study and sweep, where the tables are wide or have texts.
#[test]
fn a_study_is_exported_from_its_folder() {
    let desk = Desk::new();
    desk.file("scene.toml", WHEEL);
    let study = "title = \"Torque\"\nscene = \"scene.toml\"\ncolumns = [\"bodies/wheel/angular_velocity_z_rad_per_s\"]\n\
                 [[parameter]]\nname = \"torque\"\nkeys = [\"load.0.torque_Nm\"]\nvalues = [4.0]\n";
    let study = desk.file("study.toml", study);
    let out = desk.path("out");
    succeeds(&["study", argument(&study), "-o", argument(&out)]);
    let csv = read_csv(&exported(&desk, &out, "x.csv", None));
    let parquet = read_parquet(&exported(&desk, &out, "x.parquet", None));
    // ω(1 s) = T/J.
    assert_eq!(csv["largest"].len(), 2);
    assert!((csv["largest"][1] - 8.0).abs() < 1e-6 && parquet["largest"] == csv["largest"]);
    let missing = desk.path("none");
    let output = desk.path("z.mat");
    let words = ["export", argument(&missing), "-o", argument(&output)];
    refused(&gearmesh(&words), 2, &["none"]);
    let broken = changed(
        &std::fs::read_to_string(out.join("study.csv")).unwrap(),
        "\n",
        ",more\n",
    );
    let broken = desk.file("study.csv", broken);
    let words = ["export", argument(&broken), "-o", argument(&output)];
    refused(&gearmesh(&words), 2, &["CSV", "study.csv"]);
}
