//! The shipped gearboxes of reduced gears, on coarse meshes: `reduce` for each gear, `run`, and every bearing carries
//! what hand statics say.

use crate::common::{Desk, argument, changed, succeeds};
use gearmesh_scene::system_run::SystemResult;
use std::path::{Path, PathBuf};

/// Forces of the bearings on the shafts \[N\], world axes: tools/reference/gearbox_statics.py.
const THREE_STAGES: &str = include_str!("../../../../reference/gearbox_three_stage/data.csv");
const PAIR: &str = include_str!("../../../../reference/gearbox_23_47/data.csv");

fn shipped(name: &str) -> String {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fe_models");
    std::fs::read_to_string(folder.join(name)).unwrap()
}

/// Long elements (flank, fillet, body in modules, axis in face widths), few loads: where the teeth carry hardly depends
/// on them, and the bearings feel nothing else.
pub fn coarse(gear: &str) -> String {
    let value = |key: &str| -> f64 {
        let line = gear.lines().find(|line| line.starts_with(key)).unwrap();
        let number = line.split(['=', '#']).nth(1).unwrap();
        number.trim().parse().unwrap()
    };
    let (module, width) = (value("module_mm"), value("face_width_mm"));
    let (slices, [flank, fillet, body]) = if gear.contains("helix_angle_deg") {
        (5, [1.0, 0.4, 8.0])
    } else {
        (2, [0.5, 0.2, 4.0])
    };
    let end = gear.find("[reduction]").unwrap_or(gear.len());
    let sound = gear[..end].split("[mesh]").next().unwrap();
    let side = if gear.contains("flanks = [\"left\"]") {
        "left"
    } else {
        "right"
    };
    format!(
        "{sound}[reduction]\nslices = {slices}\nroll_stations = 4\nflanks = [\"{side}\"]\n\
         [mesh]\nflank_mm = {}\nfillet_mm = {}\nbody_mm = {}\naxial_mm = {}\n",
        flank * module,
        fillet * module,
        body * module,
        0.5 * width
    )
}

/// Reduces the gears that a scene names below `models`, runs it, and holds every bearing against statics by hand.
fn bearings_carry_what_statics_say(
    scene: &str,
    models: &str,
    by_hand: &str,
    within: f64,
) -> SystemResult {
    let desk = Desk::new();
    let text = shipped(scene);
    let mut reduced: Vec<PathBuf> = Vec::new();
    for line in text.lines().filter(|line| line.starts_with("gear = ")) {
        let name = line.split(models).nth(1).unwrap().trim_end_matches(".h5\"");
        let gear = desk.file(
            &format!("{name}.toml"),
            coarse(&shipped(&format!("{name}.toml"))),
        );
        let model = desk.path(&format!("{name}.h5"));
        succeeds(&[
            "reduce",
            "--no-error-estimate",
            argument(&gear),
            "-o",
            argument(&model),
        ]);
        reduced.push(model);
    }
    let folder = format!("\"{models}");
    let scene = reduced
        .iter()
        .fold(text, |text, _| changed(&text, &folder, "\""));
    let (scene, output) = (desk.file("scene.toml", scene), desk.path("result.h5"));
    succeeds(&["run", argument(&scene), "-o", argument(&output)]);
    let result = SystemResult::open(&output).unwrap();
    let last = |column: String| *result.rows.read(&column).unwrap().last().unwrap();
    let norm = |v: &[f64]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
    for row in by_hand.lines().skip(1) {
        let (bearing, numbers) = row.split_once(',').unwrap();
        let expected: Vec<f64> = numbers.split(',').map(|v| v.parse().unwrap()).collect();
        let found =
            ["x", "y", "z"].map(|axis| last(format!("elements/{bearing}/force_world_{axis}_N")));
        let off: Vec<f64> = expected.iter().zip(found).map(|(a, b)| b - a).collect();
        let off = norm(&off) / norm(&expected);
        assert!(off < within, "{bearing}: {found:?} {expected:?}");
    }
    result
}

/// Within 2 %: where the flanks carry, not the middle of the width as by hand.
#[test]
fn three_stages_of_reduced_gears() {
    let result = bearings_carry_what_statics_say(
        "gearbox_three_stage_hybrid.toml",
        "../out/gearbox/",
        THREE_STAGES,
        0.02,
    );
    // Elastic teeth keep the ratio in the mean of a mesh period; here by the forces: 1200 N m 17/59 19/67 21/73.
    let input = result.rows.read("elements/motor/moment_z_Nm").unwrap()[0].abs();
    let expected = 1200.0 * 17.0 / 59.0 * 19.0 / 67.0 * 21.0 / 73.0;
    assert!((input / expected - 1.0).abs() < 1e-3, "{input}");
}

/// A spur pair with a drilled wheel: nothing but the shafts' bending moves the load along the width.
#[test]
fn pair_23_47_with_a_drilled_wheel() {
    bearings_carry_what_statics_say("gearbox_23_47.toml", "../out/pair_23_47/", PAIR, 0.02);
}
