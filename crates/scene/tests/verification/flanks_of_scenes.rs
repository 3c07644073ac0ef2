//! Microgeometry and slices belong to the scene: one reduced model, many flanks. Against the closed form of rigid gears
//! and against the same keys in the gear file.

use std::path::Path;

use gearmesh_geometry::input::InputDocument;
use gearmesh_model::write_reduced_gear;
use gearmesh_scene::system_run::RunJob;
use gearmesh_scene::{Scene, SceneResult, load as load_pair, run};

use crate::common::{build_in, changed, load};
use crate::made_up_gears::mesh_common::pair_common::made_up_gear;
use crate::made_up_gears::{gear_file, pair, write_models};
use crate::system_runs::Desk;

const PITCHES: usize = 2;
const POINTS: usize = 24;
const FACE_MM: f64 = 20.0;
const SLICES: usize = 5;

/// A pair at rest; `mesh` stands in `[mesh]`, `flanks` after it.
fn scene_text(torque_nm: f64, mesh: &str, flanks: &str) -> String {
    format!(
        "title = \"flanks\"\n[pair]\ngear_1 = \"gear_30.h5\"\ngear_2 = \"gear_41.h5\"\ncentre_distance_mm = 106.8\n\
         [run]\ntorques_Nm = [{torque_nm:?}]\npitches = {PITCHES}\npoints_per_pitch = {POINTS}\n\
         [mesh]\nmodel.kind = \"hybrid\"\nmodel.local = \"weber-banaschek\"\nteeth.path = \"line-of-action\"\n{mesh}\n{flanks}\n"
    )
}

fn result_of(text: &str, folder: &Path) -> Result<SceneResult, String> {
    let document = InputDocument::new("pair.toml", text);
    let scene = Scene::from_document(document, folder).map_err(|e| e.to_string())?;
    let loaded = load_pair(scene).map_err(|e| e.to_string())?;
    run(&loaded, &|_, _| ()).map_err(|e| e.to_string())
}

fn at_rest(torque_nm: f64, flanks: &str, folder: &Path) -> SceneResult {
    result_of(&scene_text(torque_nm, "", flanks), folder).unwrap()
}

/// Transmission error of rigid gears at a driver angle: the pair whose flanks stand farthest out touches, in the slice
/// where they do. `removed_m` of each gear at its roll angle and z, written out here.
fn rigid_te_m(theta: f64, removed_m: &dyn Fn(usize, f64, f64) -> f64) -> f64 {
    let (cos, a) = (20f64.to_radians().cos(), 0.1068);
    let base = [30.0, 41.0].map(|z| 0.5 * 3e-3 * z * cos);
    let alpha = ((base[0] + base[1]) / a).acos();
    let tips = [pair().gear_1.tip_radius_m, pair().gear_2.tip_radius_m];
    let mut least = f64::INFINITY;
    for p in -5..5 {
        let roll_1 = alpha.tan() + theta - f64::from(p) * std::f64::consts::TAU / 30.0;
        let roll_2 = (a * alpha.sin() - base[0] * roll_1) / base[1];
        let on_flank = |gear: usize, roll: f64| {
            roll > 0.0 && base[gear] * (1.0 + roll * roll).sqrt() <= tips[gear]
        };
        if !on_flank(0, roll_1) || !on_flank(1, roll_2) {
            continue;
        }
        for slice in 0..SLICES {
            let z = FACE_MM * 1e-3 * ((slice as f64 + 0.5) / SLICES as f64 - 0.5);
            least = least.min(removed_m(0, roll_1, z) + removed_m(1, roll_2, z));
        }
    }
    -least
}

/// Roll angle at a diameter in millimetres; the tip circle's where none is given.
fn roll(gear: usize, diameter_mm: Option<f64>) -> f64 {
    let pair = pair();
    let profile = [&pair.gear_1, &pair.gear_2][gear];
    let radius = diameter_mm.map_or(profile.tip_radius_m, |d| 0.5e-3 * d);
    ((radius / profile.base_radius_m).powi(2) - 1.0).sqrt()
}

/// Share of the way from one roll angle to another, not below 0.
fn way(x: f64, from: f64, to: f64) -> f64 {
    ((x - from) / (to - from)).max(0.0)
}

/// One model file, every law: first touch of the flanks, and the transmission error under a load that bends nothing,
/// are those of rigid gears; the model is not written again.
#[test]
fn unloaded_curves_are_those_of_rigid_gears_whatever_the_flanks() {
    let folder = tempfile::tempdir().unwrap();
    write_models(folder.path());
    let files = ["gear_30.h5", "gear_41.h5"].map(|name| folder.path().join(name));
    let before = files.each_ref().map(|file| std::fs::read(file).unwrap());
    let form_1 = pair().gear_1.form_roll_rad;
    let (tip_1, tip_2, half) = (roll(0, None), roll(1, None), 10e-3);
    let mid_1 = 0.5 * (form_1 + tip_1);
    let um = 1e-6;
    type Law = Box<dyn Fn(usize, f64, f64) -> f64>;
    let on_1 = |law: fn(f64, f64, [f64; 3]) -> f64, places: [f64; 3]| -> Law {
        Box::new(move |gear, roll, z| if gear == 0 { law(roll, z, places) } else { 0.0 })
    };
    let cases: [(&str, Law); 10] = [
        ("", Box::new(|_, _, _| 0.0)),
        (
            "[gear_1.microgeometry]\ntip_relief_um = 20.0\ntip_relief_start_diameter_mm = 92.0\n\
             [gear_2.microgeometry]\ntip_relief_um = 12.0\ntip_relief_start_diameter_mm = 125.0\ntip_relief_shape = \"parabolic\"\n",
            Box::new(move |gear, x, _| match gear {
                0 => 20.0 * um * way(x, roll(0, Some(92.0)), tip_1),
                _ => 12.0 * um * way(x, roll(1, Some(125.0)), tip_2).powi(2),
            }),
        ),
        (
            // Along the whole path, so that no position is without it: 2 mm of roll length for 600 um turn the arc by a
            // third of a radian.
            "[gear_1.microgeometry]\ntip_relief_um = 600.0\ntip_relief_start_diameter_mm = 86.0\ntip_relief_shape = \"arc\"\n",
            on_1(
                |x, _, [start, tip, base]| {
                    let (length, along) = (base * (tip - start), base * (x - start).max(0.0));
                    let radius = (length * length + 600e-6 * 600e-6) / (2.0 * 600e-6);
                    radius - (radius * radius - along * along).sqrt()
                },
                [roll(0, Some(86.0)), tip_1, pair().gear_1.base_radius_m],
            ),
        ),
        (
            "[gear_1.microgeometry]\nroot_relief_um = 30.0\nroot_relief_start_diameter_mm = 96.0\n",
            on_1(
                |x, _, [form, start, _]| 30e-6 * way(x, start, form).min(1.0),
                [form_1, roll(0, Some(96.0)), 0.0],
            ),
        ),
        (
            "[gear_1.microgeometry]\nprofile_crowning_um = 15.0\nprofile_crowning_diameter_mm = 90.0\n",
            on_1(
                |x, _, [centre, tip, _]| 15e-6 * ((x - centre) / (tip - centre)).powi(2),
                [roll(0, Some(90.0)), tip_1, 0.0],
            ),
        ),
        (
            "[gear_1.microgeometry]\nprofile_angle_um = 9.0\n",
            on_1(
                |x, _, [form, tip, mid]| 9e-6 * (x - mid) / (tip - form),
                [form_1, tip_1, mid_1],
            ),
        ),
        (
            "[gear_1.microgeometry]\nlead_crowning_um = 10.0\nflank_angle_um = 12.0\n",
            on_1(
                |_, z, [half, _, _]| 10e-6 * (z / half).powi(2) + 6e-6 * z / half,
                [half, 0.0, 0.0],
            ),
        ),
        (
            // Over more than half of the face, and negative: the ends stand out.
            "[gear_1.microgeometry]\nend_relief_um = -7.0\nend_relief_length_mm = 15.0\nend_relief_end = \"-z\"\nend_relief_shape = \"parabolic\"\n",
            on_1(
                |_, z, [half, _, _]| -7e-6 * ((-z - half) / 15e-3 + 1.0).max(0.0).powi(2),
                [half, 0.0, 0.0],
            ),
        ),
        (
            "[gear_1.microgeometry]\ntwist_um = 16.0\n",
            on_1(
                |x, z, [form, tip, half]| {
                    16e-6 * 0.5 * z / half * ((x - form) / (tip - form) - 0.5)
                },
                [form_1, tip_1, half],
            ),
        ),
        (
            "[gear_1.microgeometry.topography]\ndiameter_mm = [85.0, 110.0]\nz_mm = [-10.0, 10.0]\nremoved_um = [[0.0, 6.0], [9.0, 21.0]]\n",
            on_1(
                |x, z, [low, high, half]| {
                    let (u, v) = (way(x, low, high), 0.5 * (z / half + 1.0));
                    1e-6 * ((1.0 - u) * 6.0 * v + u * (9.0 + 12.0 * v))
                },
                [roll(0, Some(85.0)), roll(0, Some(110.0)), half],
            ),
        ),
    ];
    let mut curves: Vec<Vec<f64>> = Vec::new();
    for (flanks, law) in &cases {
        let flanks: &str = flanks;
        let result = at_rest(1e-4, flanks, folder.path());
        for (k, angle) in result.angle_rad.iter().enumerate() {
            let expected = rigid_te_m(*angle, law);
            let (unloaded, light) = (result.unloaded_m[k], result.te_m[k]);
            assert!(
                (unloaded - expected).abs() < 1e-15,
                "{flanks} {k}: {unloaded:e} {expected:e}"
            );
            assert!(
                (light - expected).abs() < 1e-10,
                "{flanks} {k}: {light:e} {expected:e}"
            );
        }
        assert!(
            curves.iter().all(|other| other != &result.unloaded_m),
            "{flanks} is not felt"
        );
        curves.push(result.unloaded_m);
    }
    let after = files.each_ref().map(|file| std::fs::read(file).unwrap());
    assert!(before == after, "a model was written again");
}

const FLANKS: &str = "tip_relief_um = 20.0\ntip_relief_start_diameter_mm = 92.0\nlead_crowning_um = 5.0\nprofile_crowning_um = 3.0\n\
                      profile_crowning_diameter_mm = 90.0\nflank_angle_um = 2.0\n";

/// A model of gear 1 whose gear file states the microgeometry.
fn write_modified_model(folder: &Path) {
    let model = gearmesh_model::read_reduced_gear(&folder.join("gear_30.h5")).unwrap();
    let input_toml = format!("{}[microgeometry]\n{FLANKS}", gear_file(30, 0.2));
    let model = gearmesh_model::ReducedGear {
        input: gearmesh_model::StoredGear::of_older_file(input_toml),
        ..model
    };
    write_reduced_gear(&folder.join("modified.h5"), &model).unwrap();
}

/// The same keys in the gear file and in the scene; an empty table leaves those of the file out.
#[test]
fn keys_of_the_scene_act_as_those_of_the_gear_file() {
    let folder = tempfile::tempdir().unwrap();
    write_models(folder.path());
    write_modified_model(folder.path());
    let by_file = |flanks: &str| {
        let text = scene_text(200.0, "", flanks);
        result_of(&changed(&text, "gear_30.h5", "modified.h5"), folder.path()).unwrap()
    };
    let by_scene = at_rest(
        200.0,
        &format!("[gear_1.microgeometry]\n{FLANKS}"),
        folder.path(),
    );
    let file = by_file("");
    assert_eq!(file.te_m, by_scene.te_m);
    assert_eq!(file.lines.force_n, by_scene.lines.force_n);
    let unmodified = at_rest(200.0, "", folder.path());
    assert_eq!(by_file("[gear_1.microgeometry]\n").te_m, unmodified.te_m);
    assert!(
        by_scene
            .te_m
            .iter()
            .zip(&unmodified.te_m)
            .all(|(a, b)| a < b)
    );
    let words = "tip relief 20 um linear from 92 mm, profile crowning 3 um about 90 mm, lead crowning 5 um, flank angle 2 um";
    assert_eq!(
        file.source.microgeometry,
        [format!("{words} (gear file)"), "unmodified".to_owned()]
    );
    assert_eq!(by_scene.source.microgeometry[0], format!("{words} (scene)"));
    let path = folder.path().join("result.h5");
    by_scene.write(&path).unwrap();
    assert_eq!(SceneResult::read(&path).unwrap(), by_scene);
    // In time, too: the body's table, and left flanks that do not touch.
    let body = |gear: &str, table: &str| {
        let text = crate::made_up_gears::scene(
            "[run]\nkind = \"static\"",
            -0.0,
            "",
            "teeth.flanks = \"right\"",
        );
        let text = changed(
            &text,
            "gear = \"gear_30.h5\"",
            &format!("gear = \"{gear}\"\n{table}"),
        );
        let result =
            Desk::new().run(RunJob::from_scene(load(&text, folder.path()).unwrap()).unwrap());
        result
            .rows
            .read("elements/mesh/transmission_error_m")
            .unwrap()
    };
    let of_file = body("modified.h5", "");
    assert_eq!(
        of_file,
        body("gear_30.h5", &format!("[body.microgeometry]\n{FLANKS}"))
    );
    assert_eq!(
        of_file,
        body(
            "gear_30.h5",
            &format!("[body.microgeometry.right]\n{FLANKS}")
        )
    );
    let of_left = body(
        "gear_30.h5",
        &format!("[body.microgeometry.left]\n{FLANKS}"),
    );
    assert_eq!(of_left, body("gear_30.h5", ""));
    assert!(of_left[0] > of_file[0] + 1e-7, "{of_left:?} {of_file:?}");
}

/// The plan names what acts and where it is stated.
#[test]
fn plans_tell_the_flanks() {
    let folder = tempfile::tempdir().unwrap();
    write_models(folder.path());
    let flanks = "[gear_2.microgeometry]\nlead_crowning_um = 4.0\n";
    let document = InputDocument::new("pair.toml", scene_text(100.0, "model.slices = 7", flanks));
    let loaded = load_pair(Scene::from_document(document, folder.path()).unwrap()).unwrap();
    let lines = loaded.plan().lines.join("\n");
    assert!(lines.contains("flanks     gear 1: unmodified\n"), "{lines}");
    assert!(
        lines.contains("flanks     gear 2: lead crowning 4 um (scene)"),
        "{lines}"
    );
    assert!(lines.contains("7 slices"), "{lines}");
    let text = crate::made_up_gears::scene(
        "[run]\nkind = \"static\"",
        -10.0,
        "[body.microgeometry]\ntwist_um = 4.0\n",
        "model.slices = 4",
    );
    let built = build_in(&text, folder.path()).unwrap();
    let effect = built
        .effects
        .iter()
        .find(|e| e.name.contains("microgeometry"))
        .unwrap();
    assert_eq!(
        effect.computed.as_deref(),
        Some("gear 1 unmodified; gear 2 twist 4 um (scene)")
    );
}

/// Tables that nothing feels, and slices that the models do not resolve.
#[test]
fn what_would_be_ignored_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    write_models(folder.path());
    let error = result_of(&scene_text(100.0, "model.slices = 11", ""), folder.path()).unwrap_err();
    assert!(
        error.starts_with("pair.toml:")
            && error.contains("mesh.model.slices: found 11 slices, allowed are 1 to 10"),
        "{error}"
    );
    let error = result_of(
        &scene_text(100.0, "", "[gear_1]\nmicrogeometri = 1"),
        folder.path(),
    )
    .unwrap_err();
    assert!(error.contains("unknown field `microgeometri`"), "{error}");
    let error = result_of(
        &scene_text(100.0, "", "[gear_1.microgeometry]\ntip_relief_um = 3.0"),
        folder.path(),
    )
    .unwrap_err();
    assert!(
        error.contains("gear_1.microgeometry.tip_relief_um: needs"),
        "{error}"
    );
    let in_time = |of_wheel: &str, further: &str| {
        let text =
            crate::made_up_gears::scene("[run]\nkind = \"static\"", -10.0, of_wheel, further);
        build_in(&text, folder.path())
            .err()
            .map(|e| e.to_string())
            .unwrap()
    };
    let table = "[body.microgeometry]\ntwist_um = 4.0\n";
    for (of_wheel, further, told) in [
        (
            "",
            "model.slices = 0",
            "gear_mesh.0.model.slices: found 0 slices, allowed are 1 to 10",
        ),
        (
            table,
            "microgeometry = false",
            "body.1.microgeometry: is not used: microgeometry = false in all gear meshes",
        ),
        (
            table,
            "[[body]]\nname = \"idle\"\ngear = \"gear_30.h5\"\nposition_mm = [0.0, 500.0, 0.0]\n[body.microgeometry]\ntwist_um = 1.0\n",
            "body.2.microgeometry: is not used: the body is in no gear_mesh",
        ),
        (
            "",
            "[[body]]\nname = \"disc\"\nmass_kg = 1.0\ninertia_kg_m2 = [1.0, 1.0, 1.0]\n[body.microgeometry]\ntwist_um = 1.0\n",
            "body.2.microgeometry: is not used by a body without gear",
        ),
    ] {
        let error = in_time(of_wheel, further);
        assert!(error.contains(told), "{error}");
    }
}

/// A crowned, tilted pair on models with twelve slices of their own: twice as many slices come three times nearer to
/// those of the finest layout that the models resolve. Beyond the models' own, the edge of the contact, which lies in
/// one slice or the next, leaves less than 1 %.
#[test]
fn transmission_error_converges_with_the_slices() {
    let folder = tempfile::tempdir().unwrap();
    let pair = pair();
    for (teeth, shift, profile) in [(30, 0.2, &pair.gear_1), (41, -0.1, &pair.gear_2)] {
        let model = gearmesh_model::ReducedGear {
            input: gearmesh_model::StoredGear::of_older_file(gear_file(teeth, shift)),
            near_field: None,
            ..made_up_gear(profile, FACE_MM * 1e-3, 12)
        };
        write_reduced_gear(&folder.path().join(format!("gear_{teeth}.h5")), &model).unwrap();
    }
    let flanks = "[gear_1.microgeometry]\nlead_crowning_um = 15.0\nflank_angle_um = 10.0\n";
    let curve = |slices: &str| {
        let text = scene_text(200.0, slices, flanks);
        let points = format!("points_per_pitch = {POINTS}");
        let text = changed(&text, &points, "points_per_pitch = 8");
        result_of(&text, folder.path()).unwrap().te_m
    };
    let limit = curve("model.slices = 24");
    let off = [2, 4, 8, 12, 16].map(|slices| {
        let found = curve(&format!("model.slices = {slices}"));
        (found.iter().zip(&limit)).fold(0.0_f64, |most, (a, b)| most.max((a / b - 1.0).abs()))
    });
    assert!(off[1] < off[0] / 3.0 && off[2] < off[1] / 3.0, "{off:?}");
    assert!(off[3] < 1e-2 && off[4] < 1e-2, "{off:?}");
    assert_eq!(curve("model.slices = 12"), curve(""));
}
