//! `cargo xtask accuracy-cost bearings`: what the models of a bearing differ by, and what they cost, on one shaft.

use std::fmt::Write;
use std::path::PathBuf;
use std::process::{Command, ExitCode};

use serde_json::Value;

use super::host::Host;
use super::{Bench, Options, write_whole};
use crate::console::say;
use crate::error::XtaskError;
use crate::workspace::Workspace;

/// Scene without its run and its bearings.
const SHAFT: &str = include_str!("bearing_models.toml");
const BEARING: &str = "bearing_pair_500_N.toml";
const LOAD_N: f64 = 600.0;
const SIMULATED_S: f64 = 0.05;

const DAMPING: &str = "radial_damping_N_s_per_mm = 0.5, axial_damping_N_s_per_mm = 0.5, tilt_damping_Nm_s_per_rad = 0.5";
const FILMS: &str = "rebound = { restitution = 0.9, at_speed_mm_per_s = 100.0 }, \
     traction = { kind = \"fluid\", viscosity_mPa_s = 33.0, pressure_viscosity_per_GPa = 15.0, eyring_stress_MPa = 5.0, film_thickness_um = 0.3 }";
const CAGE: &str = "cage = { mass_kg = 0.03, \
     pockets = { clearance_um = 864.0, film_stiffness_N_per_mm = 0.1, stiffness_N_per_mm_e = 1e4, rebound = { restitution = 0.8, at_speed_mm_per_s = 100.0 } }, \
     land = { ring = \"outer\", diameter_mm = 74.0, clearance_um = 1400.0, stiffness_N_per_mm_e = 1e4 } }";

/// A model and the step that it is run with.
struct Model {
    name: &'static str,
    table: String,
    step_s: f64,
}

/// What a model gives.
struct Figures {
    name: &'static str,
    step_s: f64,
    /// Mean radial force of the bearing next to the load \[N\].
    force_n: f64,
    /// Load over the mean deflection at the load \[N/m\].
    stiffness_n_per_m: f64,
    frequency_hz: f64,
    ms_per_step: f64,
    ms_per_simulated_ms: f64,
}

/// Measures and writes docs/benchmarks/bearing-models.md.
///
/// # Errors
/// [`XtaskError`] where the program does not build, a run fails or the page cannot be written.
pub fn bearing_models(workspace: &Workspace, options: &Options) -> Result<ExitCode, XtaskError> {
    let bench = Bench::prepare(workspace, options)?;
    let folder = bench.scratch.join("bearing-models");
    std::fs::create_dir_all(&folder)
        .map_err(XtaskError::io(|| format!("making {}", folder.display())))?;
    let file = folder.join(BEARING);
    let shipped = workspace.root().join("fe_models").join(BEARING);
    std::fs::copy(&shipped, &file)
        .map_err(XtaskError::io(|| format!("copying {}", shipped.display())))?;
    let runner = Runner {
        program: bench.program.clone(),
        folder,
    };
    let unloaded = runner.call(&[
        "bearing".into(),
        file.display().to_string(),
        "--load-N=0,0,0".into(),
        "--speed-rpm=6000".into(),
        "--json".into(),
    ])?;
    let mut found = Vec::new();
    for model in models(&unloaded["stiffness_SI"]) {
        say(&format!("== {}", model.name));
        found.push(runner.figures(&model)?);
    }
    let text = page(&Host::find(workspace.root()), &found);
    write_whole(
        &workspace.root().join("docs/benchmarks/bearing-models.md"),
        &text,
    )?;
    Ok(ExitCode::SUCCESS)
}

/// All models, the cheapest first; the last one is the reference.
fn models(stiffness: &Value) -> Vec<Model> {
    let diagonal = |k: usize| stiffness[k][k].as_f64().unwrap_or(f64::NAN);
    let stated = format!(
        "kind = \"linear\", radial_stiffness_N_per_mm = {}, axial_stiffness_N_per_mm = {}, tilt_stiffness_Nm_per_rad = {}, {DAMPING}",
        1e-3 * diagonal(0),
        1e-3 * diagonal(2),
        diagonal(3)
    );
    let of_file = |kind: &str, key: &str, rest: &str| {
        format!("kind = \"{kind}\", {key} = \"{BEARING}\", {rest}")
    };
    let model = |name, table: String, step_s| Model {
        name,
        table,
        step_s,
    };
    vec![
        model(
            "`rigid`, free to tilt",
            "kind = \"rigid\", tilt = \"free\"".into(),
            2e-5,
        ),
        model("`rigid`", "kind = \"rigid\"".into(), 2e-5),
        model("`linear`, the unloaded bearing's stiffness", stated, 2e-5),
        model(
            "`linear`, `tangent_of`",
            of_file("linear", "tangent_of", DAMPING),
            2e-5,
        ),
        model(
            "`quasi-static`",
            of_file("quasi-static", "file", DAMPING),
            2e-5,
        ),
        model("`dynamic`", of_file("dynamic", "file", FILMS), 5e-6),
        model(
            "`dynamic` with cage",
            of_file("dynamic", "file", &format!("{FILMS}, {CAGE}")),
            5e-6,
        ),
        model(
            "`dynamic` with cage, half the step",
            of_file("dynamic", "file", &format!("{FILMS}, {CAGE}")),
            2.5e-6,
        ),
    ]
}

/// Calls the program in a folder.
struct Runner {
    program: PathBuf,
    folder: PathBuf,
}

impl Runner {
    fn call(&self, arguments: &[String]) -> Result<Value, XtaskError> {
        let mut command = Command::new(&self.program);
        command.args(arguments).current_dir(&self.folder);
        let output = command.output().map_err(XtaskError::io(|| {
            format!("starting {}", self.program.display())
        }))?;
        let failed = || XtaskError::Failed {
            command: arguments.join(" "),
            status: String::from_utf8_lossy(&output.stderr).into_owned(),
        };
        if !output.status.success() {
            return Err(failed());
        }
        serde_json::from_slice(&output.stdout).map_err(|_| failed())
    }

    fn run(&self, scene: &str, text: &str) -> Result<(Value, String), XtaskError> {
        let file = self.folder.join(format!("{scene}.toml"));
        std::fs::write(&file, text)
            .map_err(XtaskError::io(|| format!("writing {}", file.display())))?;
        let result = format!("{scene}.h5");
        let arguments = ["run", &format!("{scene}.toml"), "-o", &result, "--json"];
        let told = self.call(&arguments.map(str::to_owned))?;
        Ok((told, result))
    }

    /// Mean of a column over the second half of a run.
    fn mean(&self, result: &str, column: &str) -> Result<f64, XtaskError> {
        let arguments = ["signal", "statistics", result, column, "--json"];
        let told = self.call(&arguments.map(str::to_owned))?;
        let figures = told["figures"].as_array().into_iter().flatten();
        let mean = figures.filter(|figure| figure["name"] == "mean");
        Ok(mean
            .filter_map(|figure| figure["value"].as_f64())
            .fold(f64::NAN, |_, value| value))
    }

    fn figures(&self, model: &Model) -> Result<Figures, XtaskError> {
        let eigen = "[run]\nkind = \"eigen\"\nmost_frequency_Hz = 20000.0\n";
        let (modes, _) = self.run("eigen", &scene(eigen, &model.table))?;
        let in_time = format!(
            "[run]\nkind = \"transient\"\nend_s = {SIMULATED_S}\n[solver]\nstep_s = {}\nstart = \"equilibrium\"\n\
             [output]\ninterval_s = 1e-4\nbodies = [\"shaft/4\"]\n",
            model.step_s
        );
        let (told, result) = self.run("transient", &scene(&in_time, &model.table))?;
        let part = if model.table.contains("\"rigid\"") {
            "joints"
        } else {
            "elements"
        };
        let force = |axis: &str| self.mean(&result, &format!("{part}/near/force_world_{axis}_N"));
        let deflection = |axis: &str| self.mean(&result, &format!("bodies/shaft_4/{axis}_m"));
        let steps = told["run"]["steps"].as_f64().unwrap_or(f64::NAN);
        let wall_ms = 1e3 * told["run"]["wall_s"].as_f64().unwrap_or(f64::NAN);
        Ok(Figures {
            name: model.name,
            step_s: model.step_s,
            force_n: force("x")?.hypot(force("y")?),
            stiffness_n_per_m: LOAD_N / deflection("x")?.hypot(deflection("y")?),
            frequency_hz: first_bending(&modes),
            ms_per_step: wall_ms / steps,
            ms_per_simulated_ms: wall_ms / (1e3 * SIMULATED_S),
        })
    }
}

/// The drive's torsion mode lies below \[Hz\], all bending modes above.
const ABOVE_HZ: f64 = 100.0;

/// Lowest frequency of a bending mode \[Hz\].
fn first_bending(modes: &Value) -> f64 {
    let modes = modes["points"][0]["modes"].as_array().into_iter().flatten();
    let vibrating = modes.filter(|mode| mode["overdamped"] == false);
    let frequencies = vibrating.filter_map(|mode| mode["frequency_Hz"].as_f64());
    frequencies
        .filter(|f| *f > ABOVE_HZ)
        .fold(f64::NAN, f64::min)
}

fn scene(run: &str, model: &str) -> String {
    let mut text = format!("title = \"Shaft on two bearing pairs\"\n{run}\n{SHAFT}");
    for (name, station, place_mm, other) in [
        ("far", 1, 0.0, ""),
        ("near", 3, 120.0, ", axial = \"free\""),
    ] {
        // Two rigid bearings that both hold the shaft along its axis would contradict each other.
        let other = if model.contains("\"rigid\"") {
            other
        } else {
            ""
        };
        let _ = write!(
            text,
            "\n[[bearing]]\nname = \"{name}\"\nbody_2 = \"shaft/{station}\"\nat_mm = [0.0, 0.0, {place_mm:?}]\nmodel = {{ {model}{other} }}\n"
        );
    }
    text
}

fn page(host: &Host, found: &[Figures]) -> String {
    let mut text = format!(
        "# Models of a bearing: what they differ by and what they cost\n\nWritten by `cargo xtask accuracy-cost bearings`; do not edit.\n\n\
         | | |\n| --- | --- |\n| processor | {}, {} cores |\n| memory | {} |\n| system | {} |\n| date | {} |\n| commit | {} |\n\n\
         An elastic shaft at 6000 rpm on two pairs of angular-contact bearings (fe_models/{BEARING}: 2 × 18 balls, back to back, 500 N), 120 mm apart, {LOAD_N} N across its end, 50 mm \
         beyond the second pair. *Force*: radial force of that pair; *stiffness*: load over the deflection under it; both are means over the second half of {SIMULATED_S} s from equilibrium. \
         *First mode*: lowest natural frequency of bending about the equilibrium at rest; for `dynamic` with the balls in equilibrium. Differences in percent are from the last row. Times are wall times on the \
         machine above. What a model has no parameter for, it leaves out: `rigid` and `linear` know no balls.\n\n\
         | model | step µs | force N | % | stiffness N/µm | % | first mode Hz | % | ms a step | ms a simulated ms |\n\
         | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n",
        host.cpu, host.cores, host.memory, host.system, host.date, host.commit
    );
    let Some(last) = found.last() else {
        return text;
    };
    for it in found {
        let off = |value: f64, reference: f64| format!("{:+.2}", 100.0 * (value / reference - 1.0));
        let _ = writeln!(
            text,
            "| {} | {} | {:.1} | {} | {:.2} | {} | {:.1} | {} | {:.4} | {:.2} |",
            it.name,
            1e6 * it.step_s,
            it.force_n,
            off(it.force_n, last.force_n),
            1e-6 * it.stiffness_n_per_m,
            off(it.stiffness_n_per_m, last.stiffness_n_per_m),
            it.frequency_hz,
            off(it.frequency_hz, last.frequency_hz),
            it.ms_per_step,
            it.ms_per_simulated_ms
        );
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;
    use std::path::Path;

    #[test]
    fn scenes_have_a_bearing_at_each_place() {
        let text = scene("[run]\n", "kind = \"rigid\"");
        assert_eq!(text.matches("[[bearing]]").count(), 2);
        assert_eq!(text.matches("axial = \"free\"").count(), 1);
        assert!(!scene("[run]\n", "kind = \"linear\"").contains("axial"));
    }

    #[test]
    fn the_first_mode_vibrates() {
        let mode = |frequency: f64, overdamped: bool| json!({"frequency_Hz": frequency, "overdamped": overdamped});
        let modes = json!({"points": [{"modes": [mode(0.0, false), mode(20.0, false), mode(120.0, true), mode(900.0, false), mode(700.0, false)]}]});
        assert!((first_bending(&modes) - 700.0).abs() < 1e-9);
    }

    #[test]
    fn differences_are_from_the_last_row() {
        let figures = |name, force_n| Figures {
            name,
            step_s: 1e-5,
            force_n,
            stiffness_n_per_m: 1e8,
            frequency_hz: 700.0,
            ms_per_step: 0.1,
            ms_per_simulated_ms: 10.0,
        };
        let host = Host::find(Path::new("."));
        let text = page(&host, &[figures("a", 99.0), figures("b", 100.0)]);
        assert!(
            text.contains("| a | 10 | 99.0 | -1.00 | 100.00 | +0.00 |"),
            "{text}"
        );
    }
}
