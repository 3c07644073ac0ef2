//! Meshes of a set that feel each other through its gears: what that changes, what it takes, what is refused.

use super::*;
use crate::made_up_gears;

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

/// Gauges on a bore that slides feel its motions: one that feels nothing else reads nothing on a bonded bore. On
/// rollers, whose push it does not know, it is refused.
#[test]
fn gauges_feel_a_bore_that_slides() {
    let folder = tempfile::tempdir().unwrap();
    made_up_gears::write_set(folder.path());
    give_the_planet_a_bore(folder.path());
    let path = folder.path().join("planet.h5");
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
    bore.flank.fill(0.05);
    bore.gauges = vec![20.0; bore.count()];
    gearmesh_model::write_reduced_gear(&path, &gear).unwrap();
    let gauge = "[[gauge]]\nbody = \"set planet 1\"\nnames = [\"rim\"]\n";
    let with = |planets: &str| format!("{}{gauge}", set(["", "", planets]));
    let strain = |bore: &str| {
        let result = run(&with(&format!("bore = \"{bore}\"")), folder.path());
        let mut columns = result.rows.columns().iter().map(|column| &column.name);
        let name = columns.find(|name| name.contains("rim_method2")).unwrap();
        result.rows.read(name).unwrap()
    };
    assert!(strain("bonded").iter().all(|strain| *strain == 0.0));
    // 23 motions with one tangential and one axial left out; forces of both meshes, some 1e4 N.
    let found = strain("sliding");
    assert!(
        found
            .iter()
            .all(|strain| (0.01..10.0).contains(&strain.abs())),
        "{found:?}"
    );
    let refused = build_in(&with(ON_ROLLERS), folder.path());
    let message = refused.map(|_| ()).unwrap_err().to_string();
    assert!(
        message.contains("bore = \"rollers\", under which no gauge"),
        "{message}"
    );
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
