//! A spur set of four planets with eight meshes: time of a step by kind of mesh, and of a static turn of one mesh
//! period at 60 positions; on rigid bodies, and `hybrid` on made-up elastic ones with and without coupling.
//!
//! `cargo bench --workspace --bench planetary --profile dev`; on a busy machine the figures are too high.
#![allow(clippy::unwrap_used, clippy::print_stdout, missing_docs)]

#[path = "../tests/made_up_gears/mod.rs"]
mod made_up_gears;

use std::path::Path;
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

use gearmesh_geometry::input::InputDocument;
use gearmesh_scene::system::SystemScene;
use gearmesh_scene::system_run::{RunJob, RunOptions, SystemResult, run};

const IMPACT: &str = "{ kind = \"impact\", stiffness_N_per_mm_e = 1e6, exponent = 1.5, damping_N_s_per_mm = 100.0, full_damping_depth_um = 5.0 }";
const ISO: &str = "{ kind = \"iso6336\", stiffness_amplitude = 0.1, damping = { kind = \"stiffness-proportional\", time_s = 2e-6, full_depth_um = 1.0 } }";
const IN_TIME: &str = "[run]\nkind = \"transient\"\nend_s = 0.05\n[solver]\nstep_s = 1e-5\nstart = \"equilibrium\"\n[output]\ninterval_s = 1e-3\n";

/// Teeth 28, 24, 76: (28 + 76)/4 is whole.
fn scene(model: &str, run: &str) -> String {
    format!(
        "title = \"set\"\n{run}[[planetary]]\nname = \"set\"\ncentre_distance_mm = 52.0\nsun_mesh.model = {model}\nring_mesh.model = {model}\n\
         sun = {{ gear = \"sun.toml\", support = \"floating\", speed_rpm = 600.0 }}\nring = {{ gear = \"ring.toml\", support = \"held\" }}\n\
         carrier = {{ mass_kg = 3.0, inertia_kg_m2 = [6e-3, 6e-3, 9e-3], torque_Nm = -400.0 }}\n\
         planets = {{ gear = \"planet.toml\", count = 4, bearings = [{{ model = {{ kind = \"linear\", radial_stiffness_N_per_mm = 2e5, \
         axial_stiffness_N_per_mm = 1e4, tilt_stiffness_Nm_per_rad = 1e4 }} }}] }}\n"
    )
}

/// Teeth 27, 24, 75 and angles at which four planets fit; elastic gears, five slices.
fn hybrid(coupling: &str, run: &str) -> String {
    let own = format!("coupling = \"{coupling}\"");
    let angles = [0, 26, 51, 77].map(|k| 360.0 * f64::from(k) / 102.0);
    let model = "{ kind = \"hybrid\", local = \"weber-banaschek\", damping = { kind = \"stiffness-proportional\", time_s = 2e-6, full_depth_um = 1.0 } }";
    scene(model, run)
        .replace("52.0", "76.5")
        .replace("sun.toml\"", &format!("sun.h5\", {own}"))
        .replace("ring.toml\"", &format!("ring.h5\", {own}"))
        .replace("planet.toml\"", &format!("planet.h5\", {own}"))
        .replace("count = 4", &format!("angles_deg = {angles:?}"))
}

fn write_gears(folder: &Path) {
    for (name, teeth, blank) in [
        ("sun", "28", "kind = \"solid\"\nbore_diameter_mm = 20.0"),
        ("planet", "24", "kind = \"solid\"\nbore_diameter_mm = 20.0"),
        (
            "ring",
            "-76\naddendum = 0.8",
            "kind = \"ring\"\nouter_diameter_mm = 182.0",
        ),
    ] {
        let text = format!(
            "name = \"{name}\"\n[tooth]\nteeth = {teeth}\nmodule_mm = 2.0\nthickness_allowance_mm = 0.05\nface_width_mm = 25.0\n[blank]\n{blank}\n\
             [material]\nyoung_GPa = 206.0\npoisson = 0.3\ndensity_kg_per_m3 = 7850.0\n"
        );
        std::fs::write(folder.join(format!("{name}.toml")), text).unwrap();
    }
}

fn result(text: &str, folder: &Path) -> (SystemResult, Duration) {
    let document = InputDocument::new("scene.toml", text);
    let loaded = SystemScene::from_document(document, folder)
        .unwrap()
        .load()
        .unwrap();
    let job = RunJob::from_scene(loaded).unwrap();
    let (output, stop) = (folder.join("result.h5"), AtomicBool::new(false));
    let options = RunOptions {
        output: &output,
        restart: true,
        checkpoint_interval: Duration::from_secs(3600),
        stop: &stop,
        progress: &|_| {},
    };
    let start = Instant::now();
    run(job, &options).unwrap();
    (SystemResult::open(&output).unwrap(), start.elapsed())
}

fn print_steps(name: &str, scene: &str, folder: &Path) {
    let record = result(scene, folder).0.record.unwrap();
    println!(
        "{name:<18} {:8.1} us a step, {:.2} evaluations and {:.3} factorisations a step",
        1e6 * record.wall_s / record.steps,
        record.evaluations / record.steps,
        record.factorisations / record.steps
    );
}

fn main() {
    let folder = tempfile::tempdir().unwrap();
    write_gears(folder.path());
    for (name, model) in [("iso6336", ISO), ("impact", IMPACT)] {
        print_steps(name, &scene(model, IN_TIME), folder.path());
    }
    // One mesh period is 360/28 degrees of the sun against the carrier, which turns by 28/104 of the sun.
    let period = 360.0 / 28.0 / (1.0 - 28.0 / 104.0);
    made_up_gears::write_set(folder.path());
    for coupling in ["all-meshes", "own-mesh"] {
        let name = format!("hybrid, {coupling}");
        print_steps(&name, &hybrid(coupling, IN_TIME), folder.path());
    }
    let angles: Vec<String> = (0..60)
        .map(|i| format!("{:?}", period * f64::from(i) / 60.0))
        .collect();
    let series = format!(
        "[run]\nkind = \"static\"\nmotion = \"set sun speed\"\nangles_deg = [{}]\n",
        angles.join(", ")
    );
    // The amplitude of the stiffness varies the equilibria; damping does nothing at rest.
    let (_, wall) = result(&scene(ISO, &series), folder.path());
    println!(
        "iso6336    {:8.1} ms for 60 equilibria over a mesh period, with building and writing",
        1e3 * wall.as_secs_f64()
    );
    for coupling in ["all-meshes", "own-mesh"] {
        let (_, wall) = result(&hybrid(coupling, &series), folder.path());
        println!(
            "hybrid, {coupling:<10} {:8.1} ms for 60 equilibria",
            1e3 * wall.as_secs_f64()
        );
    }
}
