//! Meshes of a set that feel each other through its gears: what that changes, what it takes, what is refused.

use std::f64::consts::PI;

use super::*;
use crate::made_up_gears;
use gearmesh_scene::system::{GearState, SliceLoad};
use gearmesh_scene::system_run::{RunJob, RunKind, StaticPoint};

/// A set of three planets with hybrid meshes; keys of sun, ring and planets.
fn set([sun, ring, planets]: [&str; 3]) -> String {
    let angles: Vec<f64> = (0..6).map(|k| -3.0 * f64::from(k)).collect();
    let model = "{ model = { kind = \"hybrid\", local = \"weber-banaschek\" } }";
    format!(
        "title = \"set\"\n[run]\nkind = \"static\"\nmotion = \"set sun speed\"\nangles_deg = {angles:?}\n\
         [[planetary]]\nname = \"set\"\ncentre_distance_mm = 76.5\nsun_torque = \"negative\"\nsun_mesh = {model}\nring_mesh = {model}\n\
         carrier = {{ mass_kg = 3.0, inertia_kg_m2 = [6e-3, 6e-3, 9e-3], torque_Nm = 900.0 }}\n\
         [planetary.sun]\ngear = \"sun.h5\"\nspeed_rpm = 0.0\n{sun}\n[planetary.ring]\ngear = \"ring.h5\"\nsupport = \"held\"\n{ring}\n\
         [planetary.planets]\ngear = \"planet.h5\"\ncount = 3\ndeviation = [{{ planet = 1, tangential_um = 10.0 }}]\n{planets}\n"
    )
}

/// Mean normal force of the first planet's sun mesh \[N\], and corrections of all equilibria.
fn carried(keys: [&str; 3], folder: &Path) -> (f64, f64) {
    let result = run(&set(keys), folder);
    let read = |column: &str| result.rows.read(column).unwrap();
    let forces = read("elements/set sun-planet 1/normal_force_right_N");
    let mean = forces.iter().sum::<f64>() / forces.len() as f64;
    (mean, read("iterations").iter().sum())
}

/// The forces of a set with soft rims change when each mesh feels its own alone (the rims of these made-up gears bend
/// by a tenth of what teeth do), and equilibria take no more corrections with the coupling than without, but for one
/// each: tangents hold it. Nothing else changes: gears that are all left to their own meshes carry as two that share
/// none.
#[test]
fn meshes_of_a_set_feel_each_other() {
    let folder = tempfile::tempdir().unwrap();
    made_up_gears::write_set(folder.path());
    let own = "coupling = \"own-mesh\"";
    let (together, corrections) = carried([""; 3], folder.path());
    let (apart, fewer) = carried([own; 3], folder.path());
    assert!((together / apart - 1.0).abs() > 1e-3, "{together} {apart}");
    assert!(corrections <= fewer + 6.0, "{corrections} {fewer}");
    // Each body's part of it by itself.
    for keys in [["", own, own], [own, "", own], [own, own, ""]] {
        let (one, _) = carried(keys, folder.path());
        assert!((one / apart - 1.0).abs() > 1e-6, "{keys:?}: {one} {apart}");
    }
}

#[test]
fn couplings_and_bores_that_nothing_follows_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    made_up_gears::write_set(folder.path());
    let own = "coupling = \"own-mesh\"";
    let modal = "flexibility = \"modal\"";
    let (sliding, bonded) = ("bore = \"sliding\"", "bore = \"bonded\"");
    let without_meshes = |text: String| {
        let impact = "kind = \"impact\", stiffness_N_per_mm_e = 1e6, exponent = 1.5, damping_N_s_per_mm = 100.0, full_damping_depth_um = 5.0";
        text.replace("kind = \"hybrid\", local = \"weber-banaschek\"", impact)
    };
    for (text, expected) in [
        // Of one planet the sun is in one mesh.
        (
            set([own, "", ""]).replace("count = 3", "angles_deg = [0.0]"),
            &["coupling of [[body]]", "`set sun` is in 1"][..],
        ),
        (
            set([own, "", ""]).replace(
                "[planetary.sun]",
                "[planetary.sun]\nflexibility = \"modal\"",
            ),
            &[
                "coupling of [[body]]",
                "no vibration modes",
                "`set sun` is in 0",
            ],
        ),
        (
            without_meshes(set(["", own, ""])),
            &["coupling of [[body]]", "`set ring` is in 0"],
        ),
        (
            set(["", "", sliding]),
            &[
                "gear \"made up 24\" carries no motions of its bore",
                "[reduction.bore]",
            ],
        ),
        (
            without_meshes(set(["", "", bonded])),
            &[
                "bore of [[body]]",
                "is not used: the body is in no hybrid mesh",
            ],
        ),
        (
            set(["", "", &format!("{sliding}\n{modal}")]),
            &["is not used with flexibility = \"modal\""],
        ),
    ] {
        let refused = build_in(&text, folder.path());
        let message = refused.map(|_| ()).unwrap_err().to_string();
        for words in expected {
            assert!(message.contains(words), "{words}: {message}");
        }
    }
}

/// A planet whose bore has motions, stiff enough to stay nearly round; their sizes alone matter here.
fn give_the_planet_a_bore(folder: &Path) {
    let path = folder.join("planet.h5");
    let gear = gearmesh_model::read_reduced_gear(&path).unwrap();
    let gear = made_up_gears::with_bore(gear, 1e10, 0.0);
    gearmesh_model::write_reduced_gear(&path, &gear).unwrap();
    let rollers = "name = \"rollers\"\nkind = \"cylindrical-roller\"\nrollers = 13\nroller_diameter_mm = 5.0\n\
                   roller_length_mm = 12.0\npitch_diameter_mm = 25.0\nradial_clearance_um = 5.0\n";
    std::fs::write(folder.join("rollers.toml"), rollers).unwrap();
}

/// A gauge on the planet that feels nothing but motions of the bore, 20 of each; those that are constant around it move
/// every load by 0.05.
fn give_the_planet_a_gauge_at_its_bore(folder: &Path) {
    let path = folder.join("planet.h5");
    let mut gear = gearmesh_model::read_reduced_gear(&path).unwrap();
    let loads = gear.flanks.len() * gear.grid.len();
    gear.modes = None;
    gear.gauges = vec![gearmesh_model::GaugeRows {
        name: "rim".to_owned(),
        tooth: 0,
        side: gear.flanks[0],
        description: "made up".to_owned(),
        error_estimate_relative: 0.0,
        adjoint: vec![0.0; 3 * gear.teeth * loads],
        own_tooth: vec![0.0; loads],
    }];
    let bore = gear.bore.as_mut().unwrap();
    let (count, along, waves) = (bore.count(), bore.along, bore.waves());
    for (k, moved) in bore.flank.iter_mut().enumerate() {
        let wave = k % count / along % waves;
        *moved = if wave == 0 { 0.05 } else { 0.0 };
    }
    bore.gauges = vec![20.0; bore.count()];
    gearmesh_model::write_reduced_gear(&path, &gear).unwrap();
}

const GAUGE: &str = "[[gauge]]\nbody = \"set planet 1\"\nnames = [\"rim\"]\n";

/// Both meshes of the first planet.
const MESHES: [&str; 2] = ["set sun-planet 1", "set planet 1-ring"];

/// The gears of a scene at the rows of its result: of each row the radial motions of the first planet's bore, and the
/// sums of the normal forces of its meshes.
fn in_motion(text: &str, folder: &Path, result: &SystemResult) -> Vec<(Vec<f64>, [f64; 2])> {
    let loaded = load(text, folder).unwrap();
    let mut gears = loaded.gears_in_motion().unwrap();
    let RunKind::Static(job) = RunJob::from_scene(loaded).unwrap().kind else {
        panic!("no series");
    };
    let number = |name: &str| {
        gears
            .gears
            .iter()
            .position(|gear| gear.body == name)
            .unwrap()
    };
    let (planet, sun, ring) = (
        number("set planet 1"),
        number("set sun"),
        number("set ring"),
    );
    let bodies = gears.gears.iter().map(|gear| gear.body.clone());
    let bodies: Vec<String> = bodies.chain(gears.further.clone()).collect();
    let read = |body: &String| {
        let columns = GearState::columns(body);
        let of = |column: &String| result.rows.read(column).unwrap();
        columns[..6].iter().map(of).collect::<Vec<_>>()
    };
    let states: Vec<Vec<Vec<f64>>> = bodies.iter().map(read).collect();
    let at = |(row, point): (usize, &StaticPoint)| {
        let of_body = |columns: &Vec<Vec<f64>>| {
            let values: Vec<f64> = columns.iter().map(|column| column[row]).collect();
            GearState::from_values(&values)
        };
        let states: Vec<GearState> = states.iter().map(of_body).collect();
        let loads = gears.loads(&states, point.time_s).unwrap();
        let meshes = [sun, ring].map(|other| {
            let on_other = |load: &SliceLoad| {
                let mut all = loads.iter();
                all.any(|second| second.gear == other && second.mesh == load.mesh)
            };
            let own = loads
                .iter()
                .filter(|load| load.gear == planet && on_other(load));
            own.map(|load| load.force_n.iter().map(|x| x * x).sum::<f64>().sqrt())
                .sum()
        });
        (gears.bore_motions_m(planet), meshes)
    };
    job.points.iter().enumerate().map(at).collect()
}

/// Forces on the teeth of gears that a result puts where they were are those of the run, however their meshes feel each
/// other. Most to 1e-9; 1e-4 where a run keeps the compliance of contacts that walk from the first iterate of a step,
/// with meshes by themselves, too. What meshes make of each other is ten times the bound and more.
#[test]
fn forces_on_the_teeth_of_a_result_are_those_of_its_run() {
    let folder = tempfile::tempdir().unwrap();
    made_up_gears::write_set(folder.path());
    give_the_planet_a_bore(folder.path());
    for planets in ["", "bore = \"sliding\"", ON_ROLLERS] {
        let text = set(["", "", planets]);
        let result = run(&text, folder.path());
        let found = in_motion(&text, folder.path(), &result);
        for (k, mesh) in MESHES.iter().enumerate() {
            let sides = ["right", "left"].map(|side| {
                let column = format!("elements/{mesh}/normal_force_{side}_N");
                result.rows.read(&column).unwrap()
            });
            for (row, (motions, forces)) in found.iter().enumerate() {
                let expected = sides[0][row] + sides[1][row];
                let off = (forces[k] / expected - 1.0).abs();
                assert!(
                    off < 3e-4,
                    "{planets} {mesh} {row}: {} {expected}",
                    forces[k]
                );
                assert_eq!(motions.is_empty(), planets != ON_ROLLERS);
            }
        }
    }
}

/// Gauges feel the motions of a bore that is not glued: one that feels nothing else reads nothing on a bonded bore. By
/// hand, two of the free motions are constant around the bore, 0.05 F/S each, and strain by 20 of it; rollers add 20 of
/// each radial motion, which only the mesh reads that is the planet's first.
#[test]
fn gauges_feel_a_bore_that_slides_or_that_rollers_press() {
    let folder = tempfile::tempdir().unwrap();
    made_up_gears::write_set(folder.path());
    give_the_planet_a_bore(folder.path());
    give_the_planet_a_gauge_at_its_bore(folder.path());
    let read = |result: &SystemResult, mesh: &str, quantity: &str| {
        let columns = result.rows.columns().iter().map(|column| &column.name);
        let mut own = columns.filter(|name| name.contains(mesh));
        let name = own.find(|name| name.contains(quantity)).unwrap();
        result.rows.read(name).unwrap()
    };
    for (planets, free) in [
        ("bore = \"bonded\"", 0.0),
        ("bore = \"sliding\"", 2.0),
        (ON_ROLLERS, 2.0),
    ] {
        let text = format!("{}{GAUGE}", set(["", "", planets]));
        let result = run(&text, folder.path());
        let rows = in_motion(&text, folder.path(), &result);
        for (k, mesh) in MESHES.iter().enumerate() {
            for method in ["rim_method1", "rim_method2"] {
                for (strain, (motions, forces)) in read(&result, mesh, method).iter().zip(&rows) {
                    let by_teeth = 1e6 * free * 20.0 * 0.05 * forces[k] / 1e10;
                    let by_rollers = match k {
                        0 => 1e6 * 20.0 * motions.iter().sum::<f64>(),
                        _ => 0.0,
                    };
                    let expected = by_teeth + by_rollers;
                    let off = (strain - expected).abs();
                    let size = by_teeth.abs().max(by_rollers.abs());
                    assert!(off <= 3e-4 * size, "{planets} {mesh}: {strain} {expected}");
                    assert_eq!(by_rollers != 0.0, k == 0 && planets == ON_ROLLERS);
                }
            }
        }
    }
}

const ON_ROLLERS: &str = "bore = \"rollers\"\nsupport = \"floating\"\n\
    bearings = [{ model = { kind = \"quasi-static\", file = \"rollers.toml\", element_loads = true } }]";

/// Planets on rollers: the pin carries what both meshes push the planet with, by rollers that add up to it.
#[test]
fn rollers_in_the_bores_of_planets_carry_what_the_teeth_push() {
    let folder = tempfile::tempdir().unwrap();
    made_up_gears::write_set(folder.path());
    give_the_planet_a_bore(folder.path());
    let result = run(&set(["", "", ON_ROLLERS]), folder.path());
    let read = |column: &str| result.rows.read(column).unwrap();
    let pin = read("elements/set planet 1 bearing 1/force_radial_N");
    let of_mesh = |axis: &str| {
        ["sun-planet 1", "planet 1-ring"]
            .map(|mesh| read(&format!("elements/set {mesh}/{axis}_force_1_N")))
    };
    let (along, apart) = (of_mesh("tangential"), of_mesh("radial"));
    let mut rollers = vec![0.0; pin.len()];
    for element in 1..=13 {
        let column = format!("elements/set planet 1 bearing 1/element_{element}_outer_N");
        let pairs = rollers.iter_mut().zip(read(&column));
        pairs.for_each(|(sum, force)| *sum += force);
    }
    for (row, pin) in pin.iter().enumerate() {
        // Both push it on round, the one outwards, the other inwards; the planet moves by some 1e-4 of its radius.
        let sizes = |of: &[Vec<f64>; 2]| [of[0][row].abs(), of[1][row].abs()];
        let (t, r) = (sizes(&along), sizes(&apart));
        let teeth = (t[0] + t[1]).hypot(r[0] - r[1]);
        assert!(
            *pin > 1000.0 && (pin / teeth - 1.0).abs() < 1e-3,
            "{pin} {teeth}"
        );
        assert!(
            rollers[row] > *pin && rollers[row] < 2.0 * pin,
            "{rollers:?} {pin}"
        );
    }
}

#[test]
fn bores_on_rollers_that_nothing_holds_or_follows_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    made_up_gears::write_set(folder.path());
    give_the_planet_a_bore(folder.path());
    let balls = "name = \"balls\"\nkind = \"deep-groove\"\nballs = 8\nball_diameter_mm = 5.0\npitch_diameter_mm = 25.0\n\
                 inner_conformity = 0.52\nouter_conformity = 0.53\n";
    std::fs::write(folder.path().join("balls.toml"), balls).unwrap();
    // Rollers on 30 mm in a bore of 30 mm.
    let rollers = std::fs::read_to_string(folder.path().join("rollers.toml")).unwrap();
    let large = changed(
        &rollers,
        "pitch_diameter_mm = 25.0",
        "pitch_diameter_mm = 30.0",
    );
    std::fs::write(folder.path().join("large.toml"), large).unwrap();
    let in_large = ON_ROLLERS.replace("rollers.toml", "large.toml");
    let alone = ON_ROLLERS.split("bearings").next().unwrap().to_owned();
    let own = format!("{ON_ROLLERS}\ncoupling = \"own-mesh\"");
    let in_balls = ON_ROLLERS.replace("rollers.toml", "balls.toml");
    let out = ON_ROLLERS.replace("{ model", "{ z_mm = 20.0, model");
    for (planets, expected) in [
        (&alone[..], "one bearing of kind \"quasi-static\""),
        (&own, "is not used with bore = \"rollers\""),
        (&in_balls, "cylindrical roller bearing only"),
        (&out, "stick out of the bore by"),
        (
            &in_large,
            "is 35.0000 mm wide, the bore in which it stands 30.0000 mm",
        ),
    ] {
        let refused = build_in(&set(["", "", planets]), folder.path());
        let message = refused.map(|_| ()).unwrap_err().to_string();
        assert!(message.contains(expected), "{expected}: {message}");
    }
}

/// Planets whose bores rollers press on pins that bend: the pin's station under the rollers moves as the beam in closed
/// form under what they press (a_pin_between_two_plates_deflects_as_a_beam), and the set runs in time with its energy.
#[test]
fn rollers_press_on_pins_that_bend() {
    let folder = tempfile::tempdir().unwrap();
    made_up_gears::write_set(folder.path());
    give_the_planet_a_bore(folder.path());
    let pin = "pin = { diameter_mm = 20.0, plates_mm = [-20.0, 20.0] }";
    let planets = format!("{ON_ROLLERS}\n{pin}");
    let result = run(&set(["", "", &planets]), folder.path());
    let read = |column: &str| result.rows.read(column).unwrap();
    let (d, length, young, nu) = (20e-3_f64, 40e-3_f64, 206e9, 0.3);
    let (area, inertia) = (PI * d * d / 4.0, PI * d.powi(4) / 64.0);
    let shear = young / (2.0 * (1.0 + nu)) * 6.0 * (1.0 + nu) / (7.0 + 6.0 * nu) * area;
    let compliance = length.powi(3) / (192.0 * young * inertia) + length / (4.0 * shear);
    let force = read("elements/set planet 1 bearing 1/force_radial_N");
    // Pins push the carrier round; planets stand beside their places by less than 1e-3 of 76.5 mm.
    let of_planet = |planet: usize| {
        read(&format!(
            "elements/set planet {planet} bearing 1/force_radial_N"
        ))
    };
    let pins = [1, 2, 3].map(of_planet);
    for row in 0..force.len() {
        let torque_nm = 76.5e-3 * pins.iter().map(|of_pin| of_pin[row]).sum::<f64>();
        assert!((torque_nm / 900.0 - 1.0).abs() < 1e-3, "{torque_nm}");
    }
    let place = |body: &str| ["x", "y"].map(|axis| read(&format!("bodies/{body}/{axis}_m")));
    let [middle, plate] = [1, 0].map(|k| place(&format!("set planet 1 pin beam_{k}")));
    for row in 0..force.len() {
        let apart = [0, 1].map(|axis| middle[axis][row] - plate[axis][row]);
        let off = apart[0].hypot(apart[1]) / (force[row] * compliance) - 1.0;
        assert!(force[row] > 1000.0 && off.abs() < 1e-3, "{off}");
    }
    let damping =
        "damping = { kind = \"stiffness-proportional\", time_s = 2e-6, full_depth_um = 1.0 }";
    let in_time = "kind = \"transient\"\nend_s = 0.002\n[solver]\nstep_s = 1e-5\nstart = \"equilibrium\"\n[output]\ninterval_s = 1e-4\n";
    let (_, tables) = set(["", "", &planets])
        .split_once("[[planetary]]")
        .map(|(a, b)| (a.to_owned(), b.to_owned()))
        .unwrap();
    let text = format!("title = \"set\"\n[run]\n{in_time}[[planetary]]{tables}")
        .replace("speed_rpm = 0.0", "speed_rpm = 600.0")
        .replace(
            "local = \"weber-banaschek\"",
            &format!("local = \"weber-banaschek\", {damping}"),
        );
    let result = run(&text, folder.path());
    let error = result.relative_energy_error().unwrap();
    assert!(error < 1e-3, "{error:e}");
}
