//! `gearmesh export` into series of moving gears, read back by meshio and PyVista, and into STEP, read back by gmsh.

use crate::bevel::shipped;
use crate::common::{Desk, SOLID, argument, changed, gearmesh, refused, run_scene, succeeds};
use crate::hybrid_scene;
use gearmesh_mesh::python::PythonEnvironment;
use gearmesh_scene::SceneResult;
use gearmesh_scene::system_run::SystemResult;
use serde_json::Value;
use std::path::Path;

/// What a script prints as JSON.
fn python(script: &str, arguments: &[&str]) -> Value {
    let python = PythonEnvironment::find().unwrap();
    let told = python.run("reading", script, arguments, b"").unwrap();
    serde_json::from_slice(&told).unwrap()
}

/// Of each moment of a series: what PyVista says it is at, force on each gear (vector, sum of magnitudes), largest
/// distance of loaded quadrilaterals of the two gears, open edges and volume of each gear's surface; figures of the
/// first file by meshio.
const READ: &str = "
import json, sys
import meshio, numpy as np, pyvista
reader = pyvista.PVDReader(sys.argv[1])
moments = []
for at in reader.time_values:
    reader.set_active_time_value(at)
    mesh = reader.read()[0]
    force = mesh.cell_data['contact_force_N'].astype(float)
    gear, centre = mesh.cell_data['gear'], mesh.cell_centers().points
    loaded = [centre[(gear == g) & (mesh.cell_data['line_load_N_per_m'] > 0)] for g in (1, 2)]
    apart = max((np.linalg.norm(loaded[1] - p, axis=1).min() for p in loaded[0]), default=0.0)
    surfaces = [mesh.extract_cells(gear == g).extract_surface(algorithm='dataset_surface') for g in (1, 2)]
    moments.append({
        'at': at, 'apart_m': float(apart),
        'force': [force[gear == g].sum(axis=0).tolist() for g in (1, 2)],
        'size': [float(np.linalg.norm(force[gear == g], axis=1).sum()) for g in (1, 2)],
        'pressure': float(mesh.cell_data['hertz_pressure_Pa'].max()),
        'open': [s.n_open_edges for s in surfaces], 'volume': [s.triangulate().volume for s in surfaces],
    })
own = meshio.read(sys.argv[2])
cells = own.cells_dict['quad']
json.dump({'moments': moments, 'quads': len(cells), 'largest_node': int(cells.max()), 'points': len(own.points),
           'teeth': int(own.cell_data['tooth'][0].max()) + 1}, sys.stdout)
";

fn numbers(value: &Value) -> Vec<f64> {
    let all = value.as_array().unwrap().iter();
    all.map(|x| x.as_f64().unwrap()).collect()
}

/// Forces on both gears are opposite, of the size that is known, and their loaded flanks lie on each other.
fn demand_contact(moment: &Value, force_n: f64, relative: f64) {
    let [on_1, on_2] = [0, 1].map(|gear| numbers(&moment["force"][gear]));
    for (a, b) in on_1.iter().zip(&on_2) {
        assert!((a + b).abs() < 1e-3 * force_n.max(1.0), "{on_1:?} {on_2:?}");
    }
    for size in numbers(&moment["size"]) {
        assert!(
            (size - force_n).abs() <= relative * force_n,
            "{size} {force_n}"
        );
    }
    // Shorter than the diagonal of a quadrilateral of the flanks.
    assert!(moment["apart_m"].as_f64().unwrap() < 1e-3, "{moment}");
}

#[test]
fn a_pair_turns_under_load() {
    let desk = Desk::new();
    let (file, _) = run_scene(&desk, "");
    let result = SceneResult::read(&file).unwrap();
    let output = desk.path("pair.pvd");
    let words = [
        "export",
        argument(&file),
        "-o",
        argument(&output),
        "--moments",
        "5",
        "--json",
    ];
    let told = succeeds(&words).json();
    let first = desk.path("").join(told["files"][0].as_str().unwrap());
    let read = python(READ, &[argument(&output), argument(&first)]);
    let moments = read["moments"].as_array().unwrap();
    assert_eq!(moments.len(), 5);
    assert_eq!(
        (read["teeth"].as_u64(), told["unit"].as_str()),
        (Some(18), Some("deg"))
    );
    assert!(read["largest_node"].as_u64() < read["points"].as_u64());
    let forces = result.normal_force_n(1);
    for (k, moment) in moments.iter().enumerate() {
        let angle = k * result.angles() / 5;
        let at = moment["at"].as_f64().unwrap();
        assert!((at - result.angle_rad[angle].to_degrees()).abs() < 1e-9);
        demand_contact(moment, forces[angle], 1e-5);
        let size = result.lines.slots * result.lines.slices;
        let here = &result.lines.pressure_pa[(result.angles() + angle) * size..][..size];
        let largest = here.iter().copied().fold(0.0, f64::max);
        assert!((moment["pressure"].as_f64().unwrap() / largest - 1.0).abs() < 1e-6);
        // Closed surfaces, seen from outside, between those of root and tip cylinders.
        assert_eq!(numbers(&moment["open"]), [0.0, 0.0]);
        let teeth = result.source.gears[0].definition_in("the result").unwrap();
        let (root, tip) = (teeth.profile.root_radius_m, teeth.profile.tip_radius_m);
        let disc = |r: f64| std::f64::consts::PI * (r * r - 7e-3_f64.powi(2)) * 12e-3;
        for volume in numbers(&moment["volume"]) {
            assert!(disc(root) < volume && volume < disc(tip), "{volume}");
        }
    }
    // Again, into the same folder; not into one that holds something else, and not with options of others.
    succeeds(&words);
    let folder = desk.path("pair_moments");
    std::fs::write(folder.join("notes.txt"), "mine").unwrap();
    refused(
        &gearmesh(&words[..4]),
        2,
        &["notes.txt", "choose another name"],
    );
    assert!(folder.join("00000.vtu").exists());
    let unused = [&words[..4], &["--from-s", "1"]].concat();
    refused(
        &gearmesh(&unused),
        2,
        &["--from-s is for results of multibody scenes"],
    );
    let table = desk.path("x.csv");
    let unused = [
        "export",
        argument(&file),
        "-o",
        argument(&table),
        "--moments",
        "3",
    ];
    refused(
        &gearmesh(&unused),
        2,
        &["--moments has no use for a .csv file"],
    );
}

/// Of the first moment of a series with stress: largest stress and the tooth it is on, of each gear; of a whole field
/// the largest stress.
const STRESS: &str = "
import json, sys
import meshio, numpy as np
moment, field = meshio.read(sys.argv[1]), meshio.read(sys.argv[2])
data = {name: np.concatenate(parts) for name, parts in moment.cell_data.items()}
told = []
for g in (1, 2):
    own = data['gear'] == g
    stress, tooth = data['von_mises_Pa'][own], data['tooth'][own]
    loaded = set(tooth[data['line_load_N_per_m'][own] > 0].tolist())
    told.append([float(stress.max()), int(tooth[stress.argmax()]) in loaded, float(np.median(stress))])
json.dump({'gears': told, 'field': float(field.cell_data['von_mises_Pa'][0].max())}, sys.stdout)
";

#[test]
fn a_pair_turns_with_the_stress_of_its_bodies() {
    let desk = Desk::new();
    let (file, _) = run_scene(&desk, "");
    let output = desk.path("pair.pvd");
    let words = [
        "export",
        argument(&file),
        "-o",
        argument(&output),
        "--stress",
        "--moments",
        "2",
        "--json",
    ];
    let told = succeeds(&words).json();
    let first = desk.path("").join(told["files"][0].as_str().unwrap());
    let (strain, field) = (desk.path("strain.h5"), desk.path("field.vtu"));
    let angle = told["moments"][0].as_f64().unwrap().to_string();
    succeeds(&[
        "recover",
        argument(&file),
        "-o",
        argument(&strain),
        "--field-gear",
        "1",
        "--field-angle-deg",
        &angle,
        "--field-output",
        argument(&field),
    ]);
    let read = python(STRESS, &[argument(&first), argument(&field)]);
    for gear in read["gears"].as_array().unwrap() {
        assert_eq!(gear[1].as_bool(), Some(true), "{read}");
        let (largest, median) = (gear[0].as_f64().unwrap(), gear[2].as_f64().unwrap());
        assert!(0.0 < median && median < 0.5 * largest, "{read}");
    }
    // On the surface and at centres of the same elements.
    let ratio = read["gears"][0][0].as_f64().unwrap() / read["field"].as_f64().unwrap();
    assert!((0.8..2.0).contains(&ratio), "{read}");
    let table = desk.path("x.csv");
    let unused = [
        "export",
        argument(&file),
        "-o",
        argument(&table),
        "--stress",
    ];
    refused(
        &gearmesh(&unused),
        2,
        &["--stress has no use for a .csv file"],
    );
}

#[test]
fn gears_of_a_run_in_time_turn_under_the_forces_of_the_run() {
    let desk = Desk::new();
    let scene = desk.file("hybrid.toml", hybrid_scene());
    let result = desk.path("hybrid.h5");
    succeeds(&["run", argument(&scene), "-o", argument(&result)]);
    let output = desk.path("hybrid.pvd");
    let words = [
        "export",
        argument(&result),
        "-o",
        argument(&output),
        "--from-s",
        "5e-4",
        "--json",
    ];
    let told = succeeds(&words).json();
    let first = desk.path("").join(told["files"][0].as_str().unwrap());
    let read = python(READ, &[argument(&output), argument(&first)]);
    let rows = SystemResult::open(&result).unwrap().rows;
    let times = rows.read("time_s").unwrap();
    let forces = rows.read("elements/mesh/normal_force_right_N").unwrap();
    let moments = read["moments"].as_array().unwrap();
    assert_eq!(moments.len(), times.iter().filter(|t| **t >= 5e-4).count());
    let mut most = 0.0_f64;
    for moment in moments {
        let at = moment["at"].as_f64().unwrap();
        let row = times.iter().position(|t| (t - at).abs() < 1e-12).unwrap();
        most = most.max(forces[row]);
        demand_contact(moment, forces[row], 1e-3);
    }
    assert!(most > 10.0, "{most}");
    // Somewhere else the scene's gears are not found; another gear under the same name is not taken.
    let folder = desk.path("elsewhere");
    std::fs::create_dir(&folder).unwrap();
    let moved = folder.join("hybrid.h5");
    std::fs::copy(&result, &moved).unwrap();
    succeeds(&[
        "export",
        argument(&moved),
        "-o",
        argument(&output),
        "--moments",
        "1",
    ]);
}

/// Points of the flanks of tooth 0 by the closed form of the involute, written down once more, and their distance to
/// the solid's faces.
const DISTANCE: &str = "
import json, math, os, sys
import gmsh
answer = os.fdopen(os.dup(1), 'w'); os.dup2(2, 1)
z, m, x, beta, b = (float(a) for a in sys.argv[2:])
alpha_t = math.atan(math.tan(math.radians(20)) / math.cos(beta))
r = z * m / math.cos(beta) / 2
base = r * math.cos(alpha_t)
half = math.pi / (2 * z) + 2 * x * math.tan(math.radians(20)) / z + math.tan(alpha_t) - alpha_t
gmsh.initialize(interruptible=False)
gmsh.option.setNumber('General.Terminal', 0)
gmsh.option.setString('Geometry.OCCTargetUnit', 'MM')
gmsh.model.occ.importShapes(sys.argv[1]); gmsh.model.occ.synchronize()
faces = [tag for _, tag in gmsh.model.getEntities(2)]
worst = 0.0
for side in (-1, 1):
    for share in (0.02, 0.3, 0.61, 0.97):
        low, high = r - 0.4 * m, r + 0.9 * m
        radius = low + share * (high - low)
        xi = math.sqrt((radius / base) ** 2 - 1)
        for height in (-0.49, 0.13, 0.5):
            angle = side * (half - xi + math.atan(xi)) + height * b * math.tan(beta) / r
            p = (radius * math.cos(angle), radius * math.sin(angle), height * b)
            worst = max(worst, min(math.dist(gmsh.model.getClosestPoint(2, tag, p)[0], p) for tag in faces))
volume = sum(gmsh.model.occ.getMass(*e) for e in gmsh.model.getEntities(3))
json.dump([worst, len(gmsh.model.getEntities(3)), volume], answer)
";

#[test]
fn the_flanks_of_a_step_file_are_the_exact_ones() {
    let desk = Desk::new();
    let helical = changed(
        SOLID,
        "face_width_mm",
        "helix_angle_deg = 15.0\nhand = \"left\"\nface_width_mm",
    );
    let mut volumes = Vec::new();
    for (name, text, beta) in [("spur", SOLID, 0.0_f64), ("helical", &helical, -15.0)] {
        let gear = desk.file(&format!("{name}.toml"), text);
        let output = desk.path(&format!("{name}.step"));
        let told = succeeds(&["export", argument(&gear), "-o", argument(&output), "--json"]).json();
        let stated = told["solid"]["largest_error_mm"].as_f64().unwrap();
        assert!(stated < 1e-4, "{stated}");
        let beta = beta.to_radians();
        let words = ["18", "3", "0.1", &beta.to_string(), "12"];
        let found = python(DISTANCE, &[&[argument(&output)][..], &words].concat());
        let found = numbers(&found);
        // A tenth of a micrometre, and what the program states to the same order.
        assert!(found[0] < 1e-4 && found[1] == 1.0, "{found:?}");
        volumes.push(found[2]);
        assert!((told["solid"]["volume_mm3"].as_f64().unwrap() / found[2] - 1.0).abs() < 1e-6);
    }
    assert!(volumes[1] > volumes[0], "{volumes:?}");
    let scene = desk.file("scene.toml", "[run]\nkind = \"static\"\n");
    let none = desk.path("none.step");
    let answer = gearmesh(&["export", argument(&scene), "-o", argument(&none)]);
    refused(&answer, 2, &["scene.toml"]);
    assert!(!Path::new(&none).exists());
}

/// A bevel gear's file as the OCC kernel reads it: largest distance of the points of a measuring machine's tables to
/// the nearest face, number of solids, volume; and the volume of a mesh of hexahedra.
const BEVEL_SOLID: &str = r"
import csv, json, math, os, sys
answer = os.fdopen(os.dup(1), 'w')
os.dup2(2, 1)
import gmsh, meshio, numpy
gmsh.initialize(interruptible=False)
gmsh.option.setNumber('General.Terminal', 0)
gmsh.option.setString('Geometry.OCCTargetUnit', 'MM')
gmsh.model.occ.importShapes(sys.argv[1]); gmsh.model.occ.synchronize()
faces = [(tag, gmsh.model.getBoundingBox(2, tag)) for _, tag in gmsh.model.getEntities(2)]
worst = 0.0
for table in sys.argv[3:]:
    for row in csv.DictReader(open(table)):
        p = [float(row[k]) for k in ('x_mm', 'y_mm', 'z_mm')]
        near = [tag for tag, box in faces if all(box[i] - 1e-3 <= p[i] <= box[3 + i] + 1e-3 for i in range(3))]
        near = near or [tag for tag, _ in faces]
        worst = max(worst, min(math.dist(gmsh.model.getClosestPoint(2, tag, p)[0], p) for tag in near))
volume = sum(gmsh.model.occ.getMass(*e) for e in gmsh.model.getEntities(3))
mesh = meshio.read(sys.argv[2])
corners = [[x, y, z] for z in (-1, 1) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
at = mesh.points[numpy.vstack([block.data for block in mesh.cells if block.data.shape[1] == 8])]
whole = 0.0
for k in range(8):
    xi = numpy.array(corners[k]) / 3.0 ** 0.5
    slopes = numpy.array([[c[q] * math.prod(1.0 + c[r] * xi[r] for r in range(3) if r != q) / 8.0 for q in range(3)] for c in corners])
    whole += numpy.abs(numpy.linalg.det(numpy.einsum('nax,aq->nxq', at, slopes))).sum()
json.dump([worst, len(gmsh.model.getEntities(3)), volume, 1e9 * whole], answer)
";

/// The flanks of a bevel gear's solid go through the points of its measuring machine's tables, and its volume is that
/// of its mesh, whose circles are polygons.
#[test]
fn a_bevel_gear_goes_out_as_step() {
    let desk = Desk::new();
    let (gear, pair) = (
        shipped("bevel_pinion_13_35.toml"),
        shipped("bevel_13_35.toml"),
    );
    let [solid, mesh, tables] = ["p.step", "p.vtu", "points"].map(|name| desk.path(name));
    let told = succeeds(&["export", &gear, "-o", argument(&solid), "--json"]).json();
    // A tenth of a micrometre, as of cylindrical gears.
    let stated = told["solid"]["largest_error_mm"].as_f64().unwrap();
    assert!(stated < 1e-4, "{stated}");
    succeeds(&["mesh", &gear, "-o", argument(&mesh)]);
    succeeds(&["bevel", &pair, "--grid", argument(&tables)]);
    let points = ["concave", "convex"].map(|side| tables.join(format!("pinion-{side}.csv")));
    let files = [&solid, &mesh, &points[0], &points[1]].map(|file| argument(file));
    let found = numbers(&python(BEVEL_SOLID, &files));
    let [off, solids, volume, of_mesh] = [found[0], found[1], found[2], found[3]];
    assert!(off < 1e-4 && solids == 1.0, "{off} {solids}");
    // Of 104 sides and more: (2 pi/104)^2/6 = 6e-4 of a disc's area; teeth have chords of their own.
    assert!((of_mesh / volume - 1.0).abs() < 1e-3, "{of_mesh} {volume}");
}
