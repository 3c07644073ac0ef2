//! `cargo xtask bench offline`: time and memory of the offline stage beside other programs on the same meshes.
//! `cargo xtask bench chain`: steps of multibody systems. `cargo xtask bench bearings`: rolling bearings.
//!
//! A list of cases, each a child process; one that fails or is too big tells why in its row and the next one runs.

mod accuracy;
mod accuracy_page;
mod bearing_models;
mod bearings;
mod bearings_page;
mod bevel_machines;
mod case;
mod chain;
mod elements;
mod elements_page;
mod host;
mod page;
mod projection;
mod whole_machines;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};
use std::time::Instant;

use serde_json::Value;

use crate::console::{readable, say};
use crate::error::XtaskError;
use crate::prepare;
use crate::steps::build_program;
use crate::workspace::Workspace;
pub use accuracy::accuracy_cost;
pub use bearing_models::bearing_models;
pub use bearings::bearings;
pub use bevel_machines::bevel_machines;
use case::{measure, stages};
pub use chain::chain;
pub use elements::elements;
pub use host::Host;
use page::{Figures, MeshSize, Row, STATED_LOADS};
pub use whole_machines::whole_machines;

/// Which cases run, and with what.
#[derive(Debug, PartialEq, Eq, Default)]
pub struct Options {
    /// The two coarsest meshes only; the page then goes to `out/`.
    pub quick: bool,
    /// This program with the Python of `GEARMESH_PYTHON`, nothing is built.
    pub program: Option<PathBuf>,
}

/// Longest time \[s\] of a case.
const TIMEOUT_S: u32 = 1800;
const GEAR: &str = "fe_models/gear2.toml";
const FLANKS: &str = "flanks = [\"right\"]";

/// Factors on the default element lengths in the cross-section and along the axis, coarse to default. Lengths in the
/// section beyond these hardly save elements: profile and fillet ask for a least number of them.
const SIZES: [[f64; 2]; 4] = [[3.2, 5.0], [2.2, 2.2], [1.8, 1.8], [1.0, 1.0]];
/// Least factor at which factors of the whole gear, incompatible modes and all, stay within 23 GB.
const LEAST_OF_WHOLE: f64 = 1.8;
/// Default lengths: key, share of the module, share of the face width.
const LENGTHS: [(&str, f64, f64); 4] = [
    ("flank_mm", 0.3, 0.0),
    ("fillet_mm", 0.05, 0.0),
    ("body_mm", 1.2, 0.0),
    ("axial_mm", 0.0, 0.1),
];

/// Runs all cases and writes the page.
///
/// # Errors
/// [`XtaskError`] where the program does not build or a file cannot be written; a case that fails is a row of the page.
pub fn offline(workspace: &Workspace, options: &Options) -> Result<ExitCode, XtaskError> {
    let start = Instant::now();
    let bench = Bench::prepare(workspace, options)?;
    let host = Host::find(workspace.root());
    let path = workspace.root().join(GEAR);
    let source = fs::read_to_string(&path)
        .map_err(XtaskError::io(|| format!("reading {}", path.display())))?;
    let solver = bench.solver();
    let count = if options.quick { 2 } else { SIZES.len() };
    let sizes: Vec<MeshSize> = SIZES[..count]
        .iter()
        .map(|factors| bench.on_mesh(&source, *factors, &solver))
        .collect::<Result<_, _>>()?;
    let text = page::page(&host, &bench.profile, &solver.shown, &sizes);
    let page_path = workspace.root().join(if options.quick {
        "out/offline-quick.md"
    } else {
        "docs/benchmarks/offline.md"
    });
    write_whole(&page_path, &text)?;
    say(&format!(
        "\nwritten in {}: {}",
        readable(start.elapsed()),
        page_path.display()
    ));
    Ok(ExitCode::SUCCESS)
}

/// What all cases share.
struct Bench {
    root: PathBuf,
    scripts: PathBuf,
    scratch: PathBuf,
    program: PathBuf,
    profile: String,
    python: PathBuf,
}

/// The direct solver for scikit-fem.
struct Solver {
    python: PathBuf,
    name: &'static str,
    shown: String,
}

impl Bench {
    /// What a bench of the workspace prints, compiled as the program is.
    fn own(&self, name: &str) -> Result<String, XtaskError> {
        let mut command = Command::new("cargo");
        command
            .args(["bench", "--workspace", "--bench", name, "--profile", "dev"])
            .current_dir(&self.root);
        let measured = measure(&self.python, &self.scripts, TIMEOUT_S, &command);
        measured
            .map(|measured| measured.stdout)
            .map_err(|what| XtaskError::Io {
                action: format!("measuring by the bench `{name}`"),
                source: std::io::Error::other(what),
            })
    }

    /// Size and time of the program: what another build changes.
    fn stamp(&self) -> Result<String, String> {
        let of = || {
            let data = fs::metadata(&self.program)?;
            Ok::<_, std::io::Error>((data.len(), data.modified()?))
        };
        let (size, time) = of().map_err(|error| error.to_string())?;
        Ok(format!("{size} {time:?}"))
    }

    fn prepare(workspace: &Workspace, options: &Options) -> Result<Self, XtaskError> {
        let built = std::env::current_exe()
            .map_err(XtaskError::io(|| "finding xtask's own place".into()))?;
        let (program, python, profile) = match &options.program {
            Some(program) => {
                let program = fs::canonicalize(program)
                    .map_err(XtaskError::io(|| format!("finding {}", program.display())))?;
                let python =
                    std::env::var_os("GEARMESH_PYTHON").unwrap_or_else(|| "python3".into());
                (
                    program,
                    PathBuf::from(python),
                    "given by `--program`; profile not known",
                )
            }
            None => {
                let venv = prepare::prepare(workspace)?;
                (
                    build_program(workspace, &venv)?,
                    venv.python(),
                    "profile `dev` of Cargo.toml (opt-level 3, overflow checks in the project's own crates)",
                )
            }
        };
        let scratch = built.with_file_name("bench");
        fs::create_dir_all(&scratch)
            .map_err(XtaskError::io(|| format!("making {}", scratch.display())))?;
        Ok(Self {
            root: workspace.root().to_owned(),
            scripts: workspace.root().join("tools/bench"),
            scratch,
            program,
            profile: profile.to_owned(),
            python,
        })
    }

    /// Pardiso where its wheels install, else SuperLU of scipy.
    fn solver(&self) -> Solver {
        say("== direct solver for scikit-fem");
        let mut command = self.python_script("solver_venv.py");
        command.arg(self.scratch.join("solver-venv"));
        match measure(&self.python, &self.scripts, TIMEOUT_S, &command) {
            Ok(made) => Solver {
                python: PathBuf::from(made.stdout.trim()),
                name: "pardiso",
                shown: "Pardiso of Intel's MKL by PyPardiso".into(),
            },
            Err(reason) => Solver {
                python: self.python.clone(),
                name: "superlu",
                shown: format!(
                    "SuperLU of scipy, small meshes only; PyPardiso does not install ({})",
                    self.without_place(&reason)
                ),
            },
        }
    }

    /// All cases on one mesh.
    fn on_mesh(
        &self,
        source: &str,
        factors: [f64; 2],
        solver: &Solver,
    ) -> Result<MeshSize, XtaskError> {
        let gear = self.scratch.join("gear.toml");
        let off = self.scratch.join("gear-off.toml");
        let mesh = self.scratch.join("gear.vtu");
        let deck = self.scratch.join("gear.inp");
        let model = self.scratch.join("gear.h5");
        let bad_gear = |what| XtaskError::Io {
            action: format!("reading {GEAR}"),
            source: std::io::Error::other(what),
        };
        for (path, symmetry) in [(&gear, "auto"), (&off, "off")] {
            let text = gear_text(source, factors, symmetry).map_err(bad_gear)?;
            fs::write(path, text)
                .map_err(XtaskError::io(|| format!("writing {}", path.display())))?;
        }
        let teeth = number_after(source, "teeth").map_err(bad_gear)?;

        say(&format!(
            "== mesh, lengths times {} and {}",
            factors[0], factors[1]
        ));
        let mut command = self.gearmesh("mesh", &gear, &mesh);
        let dofs = self.run(&mut command).and_then(|(_, figures)| {
            let dofs = figures["dofs"].as_u64();
            dofs.ok_or_else(|| "no number of degrees of freedom".to_owned())
        });
        let mut size = MeshSize {
            lengths: factors,
            dofs,
            all_loads: 0.0,
            rows: Vec::new(),
            projected: Err("the gear was not reduced".into()),
        };
        if size.dofs.is_err() {
            return Ok(size);
        }
        let mut projected = size.projected.clone();
        let mut add = |program: String, outcome: Result<Figures, String>| {
            match &outcome {
                Ok(figures) => say(&format!("   {program}: {:.1} s", figures.wall_s)),
                Err(reason) => say(&format!("   {program}: {reason}")),
            }
            size.rows.push(Row { program, outcome });
        };

        let whole_fits = factors[0] >= LEAST_OF_WHOLE;
        for (name, path) in [("ours, symmetry", &gear), ("ours, off", &off)] {
            if name == "ours, off" && !whole_fits {
                continue;
            }
            let mut command = self.gearmesh("reduce", path, &model);
            command.arg("--no-error-estimate");
            let outcome = self.run(&mut command).and_then(|(mut figures, told)| {
                let stations = told["flank_loads"].as_f64().ok_or("no number of loads")?;
                figures.complete = name == "ours, symmetry";
                figures.loads = 2.0 * stations;
                if figures.complete {
                    figures.loads *= teeth;
                    size.all_loads = figures.loads;
                }
                figures.stages = Some(stages(&told));
                Ok(figures)
            });
            add(name.into(), outcome);
            if name == "ours, symmetry" {
                projected = self.projected(&model);
            }
        }

        size.projected = projected;
        if !whole_fits {
            let reason = "not run: its factors take more memory than this machine has";
            add("the whole gear at once".into(), Err(reason.into()));
            return Ok(size);
        }
        let mut command = Command::new(&solver.python);
        command
            .arg(self.scripts.join("scikit_fem.py"))
            .arg(&mesh)
            .arg(STATED_LOADS.to_string())
            .arg(solver.name);
        let outcome = self.run(&mut command).map(|(mut figures, told)| {
            figures.loads = STATED_LOADS;
            figures.stages = Some(stages(&told));
            figures
        });
        add(format!("scikit-fem, {}", solver.name), outcome);
        for element in ["C3D8I", "C3D8"] {
            let (name, outcome) = self.calculix(&mesh, &deck, element);
            add(name, outcome);
        }
        Ok(size)
    }

    /// One static step of CalculiX; the deck is written before, outside the measurement.
    fn calculix(
        &self,
        mesh: &Path,
        deck: &Path,
        element: &str,
    ) -> (String, Result<Figures, String>) {
        let Ok(version) = Command::new("ccx").arg("-v").output() else {
            return (format!("CalculiX {element}"), Err("not installed".into()));
        };
        let version = String::from_utf8_lossy(&version.stdout);
        let version = version.trim().trim_start_matches("This is Version ");
        let name = format!("CalculiX {version} {element}");
        let mut command = self.python_script("calculix_deck.py");
        command.arg(mesh).arg(deck).arg(element);
        if let Err(reason) = measure(&self.python, &self.scripts, TIMEOUT_S, &command) {
            return (name, Err(self.without_place(&reason)));
        }
        let mut command = Command::new("ccx");
        command.arg("-i").arg(deck.with_extension(""));
        command.current_dir(&self.scratch);
        match self.measured(&mut command) {
            Ok(run) if run.stdout.contains("Job finished") => {
                let equations = equations(&run.stdout);
                let equations = equations.map_or(String::new(), |n| format!(", {n} equations"));
                let mut figures = figures(&run);
                figures.loads = 1.0;
                (name + &equations, Ok(figures))
            }
            Ok(run) => {
                let error = run.stdout.lines().find(|line| line.contains("*ERROR"));
                let reason = error.unwrap_or("it did not say that the job finished");
                (name, Err(self.without_place(reason.trim())))
            }
            Err(reason) => (name, Err(reason)),
        }
    }

    /// Runs a case that prints JSON.
    fn run(&self, command: &mut Command) -> Result<(Figures, Value), String> {
        let run = self.measured(command)?;
        let told: Value = serde_json::from_str(run.stdout.trim())
            .map_err(|error| format!("its figures cannot be read: {error}"))?;
        Ok((figures(&run), told))
    }

    /// Runs a case on all cores.
    fn measured(&self, command: &mut Command) -> Result<case::Measured, String> {
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        command.env("GEARMESH_PYTHON", &self.python);
        command.env("PYTHONDONTWRITEBYTECODE", "1");
        for name in ["OMP_NUM_THREADS", "MKL_NUM_THREADS", "RAYON_NUM_THREADS"] {
            command.env(name, cores.to_string());
        }
        // MKL would leave out what it takes for the second thread of a core.
        command.env("MKL_DYNAMIC", "FALSE");
        measure(&self.python, &self.scripts, TIMEOUT_S, command)
            .map_err(|reason| self.without_place(&reason))
    }

    fn gearmesh(&self, subcommand: &str, gear: &Path, output: &Path) -> Command {
        let mut command = Command::new(&self.program);
        command
            .arg(subcommand)
            .arg(gear)
            .arg("-o")
            .arg(output)
            .arg("--json");
        command
    }

    fn python_script(&self, name: &str) -> Command {
        let mut command = Command::new(&self.python);
        command.arg(self.scripts.join(name));
        command.env("PYTHONDONTWRITEBYTECODE", "1");
        command
    }

    /// A reason without the places of this machine.
    fn without_place(&self, reason: &str) -> String {
        [&self.scratch, &self.root]
            .iter()
            .fold(reason.to_owned(), |text, place| {
                text.replace(&format!("{}/", place.display()), "")
            })
    }
}

fn figures(run: &case::Measured) -> Figures {
    Figures {
        wall_s: run.wall_s,
        cpu_s: run.cpu_s,
        peak_bytes: run.peak_bytes,
        stages: None,
        loads: 0.0,
        complete: false,
    }
}

/// The gear file with both flanks, the way to solve and element lengths; factors of one leave the program's default.
fn gear_text(source: &str, factors: [f64; 2], symmetry: &str) -> Result<String, String> {
    if !source.contains(FLANKS) || source.contains("[mesh]") {
        return Err(format!("expected `{FLANKS}` and no [mesh] table"));
    }
    let mut text = source.replace(
        FLANKS,
        &format!("flanks = [\"right\", \"left\"]\nsymmetry = \"{symmetry}\""),
    );
    if factors == [1.0, 1.0] {
        return Ok(text);
    }
    let module_mm = number_after(source, "module_mm")?;
    let width_mm = number_after(source, "face_width_mm")?;
    text.push_str("\n[mesh]\n");
    for (key, of_module, of_width) in LENGTHS {
        let length_mm = factors[0] * of_module * module_mm + factors[1] * of_width * width_mm;
        text.push_str(&format!("{key} = {length_mm:.4}\n"));
    }
    Ok(text)
}

/// The number in the line `key = number`.
fn number_after(source: &str, key: &str) -> Result<f64, String> {
    source
        .lines()
        .filter_map(|line| line.split_once('='))
        .find(|(name, _)| name.trim() == key)
        .and_then(|(_, value)| value.split('#').next()?.trim().parse().ok())
        .ok_or_else(|| format!("no number `{key}`"))
}

/// The number that CalculiX prints in the line below `number of equations`.
fn equations(stdout: &str) -> Option<u64> {
    let mut lines = stdout.lines();
    lines.find(|line| line.trim() == "number of equations")?;
    lines.next()?.trim().parse().ok()
}

/// Written beside and renamed, so that a killed run leaves the old page.
pub fn write_whole(path: &Path, text: &str) -> Result<(), XtaskError> {
    let beside = path.with_extension("md.tmp");
    let written = path
        .parent()
        .map_or(Ok(()), fs::create_dir_all)
        .and_then(|()| fs::write(&beside, text))
        .and_then(|()| fs::rename(&beside, path));
    written.map_err(XtaskError::io(|| format!("writing {}", path.display())))
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    fn gear2() -> String {
        let root = Workspace::find().unwrap().root().to_owned();
        fs::read_to_string(root.join(GEAR)).unwrap()
    }

    #[test]
    fn the_default_size_changes_no_length() {
        let text = gear_text(&gear2(), [1.0, 1.0], "off").unwrap();
        assert!(text.contains("flanks = [\"right\", \"left\"]\nsymmetry = \"off\""));
        assert!(!text.contains("[mesh]"));
    }

    #[test]
    fn other_sizes_scale_the_default_lengths() {
        let text = gear_text(&gear2(), [2.0, 5.0], "auto").unwrap();
        let mesh = text.split("[mesh]\n").nth(1).unwrap();
        // Module 2.6 mm, face width 23 mm.
        assert_eq!(
            mesh,
            "flank_mm = 1.5600\nfillet_mm = 0.2600\nbody_mm = 6.2400\naxial_mm = 11.5000\n"
        );
    }

    #[test]
    fn a_gear_file_that_has_changed_is_refused() {
        let changed = gear2().replace(FLANKS, "");
        assert!(gear_text(&changed, [1.0, 1.0], "off").is_err());
        assert_eq!(number_after(&gear2(), "teeth"), Ok(57.0));
        assert_eq!(
            number_after("profile_shift = 0.33   # <", "profile_shift"),
            Ok(0.33)
        );
        assert!(number_after(&gear2(), "tooth_count").is_err());
    }

    #[test]
    fn the_equations_of_calculix_are_read() {
        let stdout = " Determining\n number of equations\n 429723\n number of nonzero\n 5\n";
        assert_eq!(equations(stdout), Some(429_723));
        assert_eq!(equations("nothing"), None);
    }
}
