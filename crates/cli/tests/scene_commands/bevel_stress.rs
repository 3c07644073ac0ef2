//! Stress of bevel bodies: pictures and fields of a pair at rest, series of a run in time, read back by meshio and
//! PyVista.

use crate::common::{Desk, argument, gearmesh, refused, succeeds};
use gearmesh_mesh::python::PythonEnvironment;
use gearmesh_scene::SceneResult;
use serde_json::Value;
use std::path::Path;

fn shipped(name: &str) -> String {
    let path = format!("{}/../../fe_models/{name}", env!("CARGO_MANIFEST_DIR"));
    std::fs::read_to_string(path).unwrap()
}

fn python(script: &str, arguments: &[&str]) -> Value {
    let python = PythonEnvironment::find().unwrap();
    let told = python.run("reading", script, arguments, b"").unwrap();
    serde_json::from_slice(&told).unwrap()
}

/// Rim, thin web with steep walls and hub: too much for rows of hexahedra.
const WEB: &str = "bore_diameter_mm = 20.0\nrim_mm = 4.0\nhub_z_mm = [26.0, 42.0]\nweb = [{ diameter_mm = 26.0, z_mm = [26.0, 42.0] }, { diameter_mm = 27.0, z_mm = [32.0, 37.0] }, { diameter_mm = 37.0, z_mm = [32.0, 37.0] }]";

/// Pair, scene and both members reduced on coarse meshes; the pinion's body is meshed freely, which is said.
fn reduced_pair() -> Desk {
    let desk = Desk::new();
    let pair = desk.file("bevel_20_20.toml", shipped("bevel_20_20.toml"));
    assert!(pair.exists());
    for (member, blank) in [("pinion", WEB), ("gear", "bore_diameter_mm = 34.0")] {
        let text = format!(
            "name = \"{member}\"\n[bevel_gear]\npair = \"bevel_20_20.toml\"\nmember = \"{member}\"\n[blank]\n{blank}\n\
             [material]\nyoung_GPa = 206.0\npoisson = 0.3\ndensity_kg_per_m3 = 7850.0\n\
             [mesh]\nflank_mm = 1.5\nfillet_mm = 0.4\nbody_mm = 6.0\nalong_mm = 3.75\n[reduction]\nprofile_stations = 4\nslices = 3\n\
             [[gauge]]\nname = \"root\"\ntooth = 0\nside = \"left\"\ntangent_deg = 30.0\nlength_mm = 0.3\nwidth_mm = 3.0\n"
        );
        let file = desk.file(&format!("{member}.toml"), &text);
        let model = desk.path(&format!("{member}.h5"));
        let words = [
            "reduce",
            argument(&file),
            "-o",
            argument(&model),
            "--no-error-estimate",
        ];
        let answer = succeeds(&words);
        let said = answer.stderr.contains("meshed freely in its meridian");
        assert_eq!(said, member == "pinion", "{answer:#?}");
    }
    desk
}

/// Of a field's file: largest stress and where (node sets of the element's corners), displacement at the bore and the
/// largest elsewhere.
const FIELD: &str = "
import json, sys
import meshio, numpy as np
mesh = meshio.read(sys.argv[1])
stress = mesh.cell_data['von_mises_Pa'][0]
moved = np.linalg.norm(mesh.point_data['displacement_m'], axis=1)
r = np.hypot(mesh.points[:, 0], mesh.points[:, 1])
worst = mesh.points[mesh.cells[0].data[stress.argmax()]].mean(axis=0)
json.dump({'largest': float(stress.max()), 'at': worst.tolist(), 'bore': float(moved[r < r.min() * 1.0001].max()),
           'moved': float(moved.max()), 'cells': len(stress)}, sys.stdout)
";

/// Of each moment: force on each gear (vector, sum of magnitudes), largest stress of each gear and of the two gears'
/// cells that carry load, open edges.
const SERIES: &str = "
import json, sys
import numpy as np, pyvista
reader = pyvista.PVDReader(sys.argv[1])
moments = []
for at in reader.time_values:
    reader.set_active_time_value(at)
    mesh = reader.read()[0]
    force = mesh.cell_data['contact_force_N'].astype(float)
    gear, stress, tooth = mesh.cell_data['gear'], mesh.cell_data['von_mises_Pa'].astype(float), mesh.cell_data['tooth']
    loaded = mesh.cell_data['line_load_N_per_m'] > 0
    centre = mesh.cell_centers().points
    apart = [np.linalg.norm(centre[(gear == 2) & loaded] - p, axis=1).min() for p in centre[(gear == 1) & loaded]]
    surfaces = [mesh.extract_cells(gear == g).extract_surface(algorithm='dataset_surface') for g in (1, 2)]
    moments.append({
        'at': at, 'apart_m': float(max(apart, default=0.0)),
        'force': [force[gear == g].sum(axis=0).tolist() for g in (1, 2)],
        'size': [float(np.linalg.norm(force[gear == g], axis=1).sum()) for g in (1, 2)],
        'stress': [float(stress[gear == g].max()) for g in (1, 2)],
        'worst': [int(tooth[gear == g][stress[gear == g].argmax()]) for g in (1, 2)],
        'teeth': [sorted(set(tooth[(gear == g) & loaded].tolist())) for g in (1, 2)],
        'open': [s.n_open_edges for s in surfaces],
    })
json.dump(moments, sys.stdout)
";

/// Values of each picture of a page by its title, as drawn, with its marks.
const PICTURES: &str = "
import base64, html, json, re, sys
import numpy as np
told = {}
for title, data in re.findall(r'<figcaption>([^<]*)</figcaption>.*?<script type=\"application/json\">(.*?)</script>', open(sys.argv[1]).read(), re.S):
    data = json.loads(data)
    if data.get('shades'):
        values = np.frombuffer(base64.b64decode(data['values']), np.float32).astype(float)
        told[html.unescape(title)] = {'largest': values.max(), 'values': len(values), 'shades': len(base64.b64decode(data['shades'])) // 4, 'high': data['high'],
            'marks': [[m['sign'], m['words']] for m in data['marks']], 'bytes': len(json.dumps(data))}
json.dump(told, sys.stdout)
";

/// Pictures of a page as its figures say: four of each gear, colours up to the largest root stress, which is one of
/// the values drawn.
fn demand_pictures(page: &Path, stress: &Value) {
    let drawn = python(PICTURES, &[argument(page)]);
    let drawn = drawn.as_object().unwrap();
    let gears = stress.as_array().unwrap();
    assert_eq!(drawn.len(), 4 * gears.len(), "{:?}", drawn.keys());
    for gear in gears {
        let [name, tooth, side, when] = ["gear", "tooth", "side", "when"].map(|key| &gear[key]);
        let (name, side) = (name.as_str().unwrap(), side.as_str().unwrap());
        for (quantity, key) in [
            ("von Mises stress", "root_von_Mises_MPa"),
            ("first principal stress", "root_first_principal_MPa"),
        ] {
            // Titles are set as in print.
            let when = when.as_str().unwrap();
            let when = when.replace("N m", "N·m").replace(" -", " −");
            let picture =
                &drawn[&format!("{name}, tooth {tooth}, {side} side: {quantity}, {when}")];
            let root = gear[key].as_f64().unwrap();
            assert!((picture["high"].as_f64().unwrap() / root - 1.0).abs() < 1e-6);
            assert!(picture["largest"].as_f64().unwrap() > (1.0 - 1e-6) * root);
            assert_eq!(picture["values"], picture["shades"]);
            assert!(picture["bytes"].as_u64().unwrap() < 1_000_000);
            let marks = picture["marks"].as_array().unwrap().iter();
            let signs: Vec<&str> = marks.map(|m| m[0].as_str().unwrap()).collect();
            assert_eq!(signs, ["words", "words", "square", "ring"], "{picture}");
        }
    }
}

fn numbers(value: &Value) -> Vec<f64> {
    let all = value.as_array().unwrap().iter();
    all.map(|x| x.as_f64().unwrap()).collect()
}

#[test]
fn bevel_bodies_have_stress_at_rest_and_in_motion() {
    let desk = reduced_pair();
    at_rest(&desk);
    in_motion(&desk);
}

fn at_rest(desk: &Desk) {
    let text = shipped("bevel_20_20.toml");
    let load = "\n[load]\ntorques_Nm = [20.0, 100.0]\nmodels = [\"pinion.h5\", \"gear.h5\"]\npositions_per_pitch = 4\n";
    let pair = desk.file("loaded.toml", format!("{text}{load}"));
    let result = desk.path("loaded.h5");
    succeeds(&["run", argument(&pair), "-o", argument(&result)]);
    let page = desk.path("page.html");
    let words = ["report", argument(&result), "-o", argument(&page)];
    let told = succeeds(&[&words[..], &["--stress", "--json"]].concat());
    let html = std::fs::read_to_string(&page).unwrap();
    for title in ["Stress in the bodies", "pinion along its axis, 100 N·m"] {
        assert!(html.contains(title), "{title}");
    }
    demand_pictures(&page, &told.json()["stress"]);
    // Strain is recovered as it was read; the field is where a pair of teeth carries most.
    let passing = SceneResult::read(&result).unwrap();
    let (strain, field) = (desk.path("strain.h5"), desk.path("field.vtu"));
    let words = [
        "recover",
        argument(&result),
        "-o",
        argument(&strain),
        "--field-gear",
        "2",
        "--field-output",
        argument(&field),
    ];
    let recovered = succeeds(&words);
    assert!(
        recovered
            .stderr
            .contains("field of the gear, 100 N m, driver angle"),
        "{}",
        recovered.stderr
    );
    assert_eq!(SceneResult::read(&strain).unwrap().strain, passing.strain);
    // A gauge in the picture reads of the field what it read in passing, by the reduced model's row.
    for gear in told.json()["stress"].as_array().unwrap() {
        let read = gear["gauges_ustrain"][0]["strain"].as_f64().unwrap();
        let number = if gear["gear"] == "gear" { 2 } else { 1 };
        let of = passing.strain.iter().find(|series| series.gear == number);
        let series = passing.curve(&of.unwrap().method_2, 1);
        let off = series.iter().map(|x| (1e6 * x / read - 1.0).abs());
        let off = off.fold(f64::INFINITY, f64::min);
        // Rows of the gear read slices where they were laid, up to 0.1 mm beside where the picture's forces touch it.
        let most = if gear["gear"] == "gear" { 1e-3 } else { 1e-8 };
        assert!(read > 100.0 && off < most, "{gear} {series:?}");
    }
    let first = python(FIELD, &[argument(&field)]);
    let figure = |value: &Value, name: &str| value[name].as_f64().unwrap();
    // Held at the bore; some hundred MPa at 3.4 kN on teeth of 3.5 mm.
    assert_eq!(figure(&first, "bore"), 0.0);
    assert!(figure(&first, "moved") > 1e-6);
    let largest = figure(&first, "largest");
    assert!((1e8..2e9).contains(&largest), "{largest}");
    // A tooth carries it, not the body.
    let [x, y, _] = numbers(&first["at"])[..] else {
        panic!("{first}");
    };
    assert!(x.hypot(y) > 0.022, "{first}");
    // Less torque, less stress; by another torque and position.
    let other = ["--field-torque-Nm", "20", "--field-angle-deg", "0"];
    succeeds(&[&words[..], &other].concat());
    let second = python(FIELD, &[argument(&field)]);
    assert!(figure(&second, "largest") < 0.5 * largest);
    let unknown = [&words[..], &["--field-torque-Nm", "21"]].concat();
    refused(&gearmesh(&unknown), 2, &["--field-torque-Nm", "21"]);
    // Rigid gears have no bodies.
    let rigid = desk.file(
        "rigid.toml",
        format!("{text}\n[load]\ntorques_Nm = [100.0]\npositions_per_pitch = 4\n"),
    );
    let result = desk.path("rigid.h5");
    succeeds(&["run", argument(&rigid), "-o", argument(&result)]);
    let words = ["report", argument(&result), "-o", argument(&page)];
    let wrong = gearmesh(&[&words[..], &["--stress"]].concat());
    refused(&wrong, 2, &["--stress", "rigid", "models"]);
}

fn in_motion(desk: &Desk) {
    let mut scene = shipped("dynamics_bevel_20_20_hybrid.toml");
    for (from, to) in [
        ("../out/scenes/bevel_pinion_20_20.h5", "pinion.h5"),
        ("../out/scenes/bevel_gear_20_20.h5", "gear.h5"),
        ("end_s = 0.08", "end_s = 2e-4"),
        ("end_s = 0.01, to = 100.0", "end_s = 1e-6, to = 100.0"),
    ] {
        assert!(scene.contains(from), "{from}");
        scene = scene.replace(from, to);
    }
    let scene = desk.file("scene.toml", &scene);
    let result = desk.path("run.h5");
    succeeds(&["run", argument(&scene), "-o", argument(&result)]);
    let output = desk.path("run.pvd");
    let words = [
        "export",
        argument(&result),
        "-o",
        argument(&output),
        "--stress",
        "--moments",
        "4",
    ];
    succeeds(&words);
    let moments = python(SERIES, &[argument(&output)]);
    let moments = moments.as_array().unwrap();
    assert_eq!(moments.len(), 4);
    let mut most = 0.0_f64;
    for moment in moments {
        assert_eq!(numbers(&moment["open"]), [0.0, 0.0]);
        let [on_1, on_2] = [0, 1].map(|gear| numbers(&moment["force"][gear]));
        let sizes = numbers(&moment["size"]);
        for (a, b) in on_1.iter().zip(&on_2) {
            assert!((a + b).abs() < 1e-3 * sizes[0].max(1.0), "{moment}");
        }
        let stress = numbers(&moment["stress"]);
        if sizes[0] == 0.0 {
            assert_eq!(stress, [0.0, 0.0]);
            continue;
        }
        most = most.max(sizes[0]);
        // Loaded cells, 4.6 by 1.5 mm, lie on each other within a diagonal; the largest stress is on a tooth that
        // carries.
        assert!(moment["apart_m"].as_f64().unwrap() < 5e-3, "{moment}");
        for gear in 0..2 {
            let teeth = moment["teeth"][gear].as_array().unwrap();
            assert!(teeth.contains(&moment["worst"][gear]), "{moment}");
            // Of the order of the force on a tooth of 18 mm by 5 mm.
            let nominal = sizes[gear] / (18e-3 * 5e-3);
            assert!(
                stress[gear] > nominal && stress[gear] < 30.0 * nominal,
                "{moment}"
            );
        }
    }
    assert!(most > 10.0, "{most}");
    // The page's pictures at the last of these moments show the stress of the series: the largest of the tooth is on
    // the side that is seen.
    let at = moments[3]["at"].as_f64().unwrap();
    let page = desk.path("run.html");
    let words = [
        "report",
        argument(&result),
        "-o",
        argument(&page),
        "--stress",
        "--stress-at-s",
        &at.to_string(),
        "--json",
    ];
    let told = succeeds(&words).json();
    demand_pictures(&page, &told["stress"]);
    let drawn = python(PICTURES, &[argument(&page)]);
    for (gear, stress) in told["stress"]
        .as_array()
        .unwrap()
        .iter()
        .zip(numbers(&moments[3]["stress"]))
    {
        let start = format!(
            "{}, tooth {}, ",
            gear["gear"].as_str().unwrap(),
            gear["tooth"]
        );
        let titles = drawn.as_object().unwrap().iter();
        let mut of_gear = titles
            .filter(|(title, _)| title.starts_with(&start) && title.contains("side: von Mises"));
        let largest = of_gear.next().unwrap().1["largest"].as_f64().unwrap();
        assert!(
            (1e6 * largest / stress - 1.0).abs() < 1e-5,
            "{largest} {stress}"
        );
    }
    // Left to itself the program takes the row of the largest root stress: no smaller one than here.
    let [_, _, _, _, _, at_s, _, _] = words;
    let free: Vec<&str> = (words.iter().copied())
        .filter(|word| *word != at_s && *word != at.to_string())
        .collect();
    let free = succeeds(&free).json();
    for (worst, here) in free["stress"]
        .as_array()
        .unwrap()
        .iter()
        .zip(told["stress"].as_array().unwrap())
    {
        let root = |of: &Value| of["root_von_Mises_MPa"].as_f64().unwrap();
        assert!(root(worst) >= root(here), "{worst} {here}");
    }
    for (unused, words) in [
        (
            "--stress-angle-deg",
            &["--stress-angle-deg", "1", "--stress"][..],
        ),
        ("add --stress", &["--stress-at-s", "1"]),
    ] {
        let call = ["report", argument(&result), "-o", argument(&page)];
        refused(&gearmesh(&[&call[..], words].concat()), 2, &[unused]);
    }
}
