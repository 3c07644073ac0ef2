//! `cargo xtask accuracy-cost bevel-machines`: seed 000's machines with every fidelity of their bearings, what each
//! costs and what it changes.

mod flexibility;

use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

use serde_json::Value;

use super::case::measure;
use super::host::Host;
use super::{Bench, Options, TIMEOUT_S, write_whole};
use crate::console::say;
use crate::error::XtaskError;
use crate::workspace::Workspace;
use flexibility::flexibility;

const PAIRS: [&str; 2] = ["13_35", "31_36"];
const SIMULATED_S: f64 = 0.1;
const BEARINGS: [&str; 4] = ["pinion near", "pinion far", "gear near", "gear far"];
const BALLS: usize = 72;
const BODIES: usize = 3;
const CAGES: usize = 4;

/// A fidelity: the shipped scene that it comes from, and what is taken out of it.
struct Fidelity {
    name: &'static str,
    scene: &'static str,
    without: &'static [&'static str],
    coordinates: usize,
}

/// The cheapest first.
const FIDELITIES: [Fidelity; 6] = [
    Fidelity {
        name: "`linear`, tangent under 100 N·m",
        scene: "_linear",
        without: &[],
        coordinates: 6 * BODIES,
    },
    Fidelity {
        name: "`quasi-static`",
        scene: "",
        without: &[],
        coordinates: 6 * BODIES,
    },
    Fidelity {
        name: "`dynamic`: balls alone",
        scene: "_dynamic",
        without: &[
            "traction = ",
            "[bearing.model.cage]",
            "mass_kg = 0.03",
            "pockets = ",
            "land = ",
        ],
        coordinates: 6 * BODIES + 3 * BALLS,
    },
    Fidelity {
        name: "with traction",
        scene: "_dynamic",
        without: &[
            "[bearing.model.cage]",
            "mass_kg = 0.03",
            "pockets = ",
            "land = ",
        ],
        coordinates: 6 * BODIES + 6 * BALLS,
    },
    Fidelity {
        name: "with traction and cages",
        scene: "_dynamic",
        without: &[FILM],
        coordinates: 6 * (BODIES + CAGES) + 6 * BALLS,
    },
    Fidelity {
        name: "with traction, cages and films on their lands",
        scene: "_dynamic",
        without: &[],
        coordinates: 6 * (BODIES + CAGES) + 6 * BALLS,
    },
];

/// Taken out within its line.
const FILM: &str = ", film = { viscosity_mPa_s = 33.0, width_mm = 5.0 }";

/// Mean, deviation and range of a column over the second half of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Spread {
    pub(super) mean: f64,
    pub(super) deviation: f64,
    pub(super) range: f64,
}

/// What a run gives.
#[derive(Debug, Clone, PartialEq)]
struct Figures {
    step_s: f64,
    cpu_s: f64,
    evaluations: f64,
    factorisations: f64,
    mesh_n: Spread,
    radial_n: [Spread; 4],
    axial_n: [Spread; 4],
    /// Of the pinion's apex, both ways across its axis \[m\].
    orbit_m: [f64; 2],
    /// Of the cages over their rings; none where there are none.
    cages: Option<[Spread; 4]>,
}

/// Measures and writes docs/benchmarks/bevel-machines.md.
///
/// # Errors
/// [`XtaskError`] where the program does not build, a run fails or the page cannot be written.
pub fn bevel_machines(workspace: &Workspace, options: &Options) -> Result<ExitCode, XtaskError> {
    let bench = Bench::prepare(workspace, options)?;
    let folder = bench.scratch.join("bevel-machines");
    std::fs::create_dir_all(&folder)
        .map_err(XtaskError::io(|| format!("making {}", folder.display())))?;
    let shipped = workspace.root().join("fe_models");
    let runner = Runner::new(bench, folder);
    for file in [
        "bearing_seed_000.toml",
        "bevel_13_35.toml",
        "bevel_31_36.toml",
    ] {
        runner.copied(&shipped, file)?;
    }
    let mut text = head(&Host::find(workspace.root()));
    for pair in PAIRS {
        let mut rows = Vec::new();
        for fidelity in &FIDELITIES {
            say(&format!("== {pair}: {}", fidelity.name));
            let file = shipped.join(format!("dynamics_bevel_{pair}{}.toml", fidelity.scene));
            let scene = std::fs::read_to_string(&file)
                .map_err(XtaskError::io(|| format!("reading {}", file.display())))?;
            let scene = taken_out(&scene, fidelity.without);
            let step_s = step(&scene).ok_or_else(|| XtaskError::Failed {
                command: format!("reading the step of {}", file.display()),
                status: "no `step_s = ` in it".into(),
            })?;
            let found = runner.figures(&scene, step_s);
            let both = found.and_then(|rough| Ok((rough, runner.figures(&scene, 0.5 * step_s)?)));
            rows.push((fidelity, both.map_err(|error| reason(&error))));
        }
        page(&mut text, pair, &rows);
    }
    flexibility(&mut text, runner, &shipped)?;
    let path = workspace.root().join("docs/benchmarks/bevel-machines.md");
    write_whole(&path, &text)?;
    Ok(ExitCode::SUCCESS)
}

/// Why a run failed, in a cell of a table.
pub(super) fn reason(error: &XtaskError) -> String {
    let told = match error {
        XtaskError::Failed { status, .. } => status.clone(),
        other => other.to_string(),
    };
    told.replace(['\n', '|'], " ")
}

/// A scene without the lines that begin so, or without that part of its lines.
fn taken_out(scene: &str, without: &[&str]) -> String {
    let keeps = |line: &&str| !without.iter().any(|start| line.starts_with(start));
    let kept: Vec<&str> = scene.lines().filter(keeps).collect();
    let mut text = kept.join("\n");
    for part in without.iter().filter(|part| part.starts_with(", ")) {
        text = text.replace(part, "");
    }
    text + "\n"
}

/// The step that a scene states \[s\].
pub(super) fn step(scene: &str) -> Option<f64> {
    let mut lines = scene.lines();
    let stated = lines.find_map(|line| line.strip_prefix("step_s = "))?;
    stated.trim().parse().ok()
}

/// Runs scenes in a folder.
pub(super) struct Runner {
    bench: Bench,
    /// Where commands are called.
    folder: PathBuf,
    result: PathBuf,
}

impl Runner {
    pub(super) fn new(bench: Bench, folder: PathBuf) -> Self {
        let result = folder.join("result.h5");
        Self {
            bench,
            folder,
            result,
        }
    }

    /// A file that scenes name, beside them.
    pub(super) fn copied(&self, from: &Path, file: &str) -> Result<(), XtaskError> {
        std::fs::copy(from.join(file), self.folder.join(file))
            .map_err(XtaskError::io(|| format!("copying {file}")))?;
        Ok(())
    }

    /// Reduces a gear, unless its model is there.
    pub(super) fn reduced(&self, gear: &Path, model: &Path) -> Result<(), XtaskError> {
        if model.exists() {
            return Ok(());
        }
        if let Some(folder) = model.parent() {
            std::fs::create_dir_all(folder)
                .map_err(XtaskError::io(|| format!("making {}", folder.display())))?;
        }
        let [gear, model] = [gear, model].map(|path| path.display().to_string());
        self.call(&["reduce", &gear, "-o", &model, "--json"])?;
        Ok(())
    }

    /// Runs a scene of this text.
    pub(super) fn run_text(&self, text: &str) -> Result<(Value, f64), XtaskError> {
        let file = self.folder.join("scene.toml");
        std::fs::write(&file, text)
            .map_err(XtaskError::io(|| format!("writing {}", file.display())))?;
        self.run("scene.toml")
    }

    fn call(&self, arguments: &[&str]) -> Result<(Value, f64), XtaskError> {
        let failed = |status: String| XtaskError::Failed {
            command: arguments.join(" "),
            status,
        };
        let mut command = Command::new(&self.bench.program);
        command.args(arguments).current_dir(&self.folder);
        let (python, scripts): (&Path, &Path) = (&self.bench.python, &self.bench.scripts);
        let measured = measure(python, scripts, TIMEOUT_S, &command).map_err(failed)?;
        let told = serde_json::from_str(&measured.stdout);
        let told = told.map_err(|problem| failed(problem.to_string()))?;
        Ok((told, measured.cpu_s))
    }

    fn run(&self, scene: &str) -> Result<(Value, f64), XtaskError> {
        let result = self.result.display().to_string();
        // What a failed run has left is not to be gone on with.
        self.call(&["run", scene, "-o", &result, "--restart", "--json"])
    }

    fn figures(&self, scene: &str, step_s: f64) -> Result<Figures, XtaskError> {
        let stated = step(scene).map_or_else(String::new, |_| {
            let line = scene.lines().find(|line| line.starts_with("step_s = "));
            line.unwrap_or_default().to_owned()
        });
        let text = scene.replace(&stated, &format!("step_s = {step_s:e}"));
        let (told, cpu_s) = self.run_text(&text)?;
        let number = |name: &str| told["run"][name].as_f64().unwrap_or(f64::NAN);
        let column = |name: &str| self.spread(name);
        let each = |name: &str| {
            let mut found = [Spread::NONE; 4];
            for (place, bearing) in found.iter_mut().zip(BEARINGS) {
                *place = column(&format!("elements/{bearing}/{name}"))?;
            }
            Ok::<_, XtaskError>(found)
        };
        Ok(Figures {
            step_s,
            cpu_s,
            evaluations: number("evaluations"),
            factorisations: number("factorisations"),
            mesh_n: column("elements/mesh/normal_force_left_N")?,
            radial_n: each("force_radial_N")?,
            axial_n: each("force_shaft_z_N")?,
            orbit_m: [
                column("bodies/pinion/x_m")?.range,
                column("bodies/pinion/y_m")?.range,
            ],
            cages: match scene.contains("\n[bearing.model.cage]") {
                true => Some(each("cage_1_speed_ratio")?),
                false => None,
            },
        })
    }

    /// Figures of a column over the second half of the last run.
    pub(super) fn spread(&self, column: &str) -> Result<Spread, XtaskError> {
        let result = self.result.display().to_string();
        let (told, _) = self.call(&["signal", "statistics", &result, column, "--json"])?;
        let figures = told["figures"].as_array().into_iter().flatten();
        let figures: Vec<&Value> = figures.collect();
        let of = |name: &str| {
            let named = figures.iter().find(|figure| figure["name"] == name);
            named
                .and_then(|figure| figure["value"].as_f64())
                .unwrap_or(f64::NAN)
        };
        Ok(Spread {
            mean: of("mean"),
            deviation: of("RMS about the mean"),
            range: of("peak to peak"),
        })
    }
}

impl Spread {
    const NONE: Self = Self {
        mean: f64::NAN,
        deviation: f64::NAN,
        range: f64::NAN,
    };

    /// `mean ± deviation`.
    pub(super) fn shown(&self) -> String {
        format!("{:.0} ± {:.0}", self.mean, self.deviation)
    }
}

impl Figures {
    fn spreads(&self) -> impl Iterator<Item = &Spread> {
        let cages = self.cages.iter().flatten();
        let forces = self.radial_n.iter().chain(&self.axial_n);
        std::iter::once(&self.mesh_n).chain(forces).chain(cages)
    }

    /// Largest change of a mean force or cage speed against another run \[%\].
    fn change_of_means(&self, other: &Self) -> f64 {
        let pairs = self.spreads().zip(other.spreads());
        pairs
            .map(|(a, b)| 100.0 * (a.mean / b.mean - 1.0).abs())
            .fold(0.0, f64::max)
    }

    /// Largest change of a deviation of a force \[% of the mean\].
    fn change_of_deviations(&self, other: &Self) -> f64 {
        let pairs = self.spreads().zip(other.spreads());
        let change =
            |(a, b): (&Spread, &Spread)| 100.0 * ((a.deviation - b.deviation) / b.mean).abs();
        pairs.map(change).fold(0.0, f64::max)
    }
}

fn head(host: &Host) -> String {
    format!(
        "# Bevel machines of seed 000: fidelity of the bearings, what it costs and what it changes\n\nWritten by `cargo xtask accuracy-cost bevel-machines`; do not edit.\n\n\
         | | |\n| --- | --- |\n| processor | {}, {} cores |\n| memory | {} |\n| system | {} |\n| date | {} |\n| commit | {} |\n\n\
         fe_models/dynamics_bevel_13_35.toml and dynamics_bevel_31_36.toml with their `_linear` and `_dynamic` neighbours: {SIMULATED_S} s from rest, ramp of the pinion to 6000 rpm over the first half, 100 N·m on the gear, \
         four bearings with 500 N of preload, {BALLS} balls. All figures are of the second half, at 6000 rpm; ± is the RMS about the mean. Seconds are processor time of the whole run, its start and its result file included. \
         *Coordinates*: of bodies and balls, each with a rate. *Halved step*: largest change with half the step, over the mesh force, radial and axial loads of all bearings and speeds of all cages: of a mean, and of a deviation \
         over its mean. *Orbit*: peak to peak of the pinion's pitch apex across its axis, both ways. *Cages*: speed over the ring's.\n",
        host.cpu, host.cores, host.memory, host.system, host.date, host.commit
    )
}

/// A fidelity, and its runs with the stated step and half of it or why they failed.
type Row<'a> = (&'a Fidelity, Result<(Figures, Figures), String>);

fn page(text: &mut String, pair: &str, rows: &[Row<'_>]) {
    // Writing to a String does not fail.
    let _ = write!(
        text,
        "\n## {}\n\n| bearings | coordinates | step µs | evaluations | factorisations | s for {SIMULATED_S} s | halved step: means % | deviations % |\n\
         | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n",
        pair.replace('_', "/")
    );
    for (fidelity, found) in rows {
        let start = format!("| {} | {} |", fidelity.name, fidelity.coordinates);
        let _ = match found {
            Ok((rough, fine)) => writeln!(
                text,
                "{start} {} | {} | {} | {:.1} | {:.2} | {:.2} |",
                1e6 * rough.step_s,
                rough.evaluations,
                rough.factorisations,
                rough.cpu_s,
                rough.change_of_means(fine),
                rough.change_of_deviations(fine)
            ),
            Err(_) => writeln!(text, "{start} | | | fails | | |"),
        };
    }
    let _ = write!(
        text,
        "\n| bearings | mesh force N | radial N: {} | orbit µm | cages |\n| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n",
        BEARINGS.join(" | ")
    );
    let ran = || {
        rows.iter()
            .filter_map(|(fidelity, found)| Some((fidelity, &found.as_ref().ok()?.0)))
    };
    for (fidelity, rough) in ran() {
        let radial: Vec<String> = rough.radial_n.iter().map(Spread::shown).collect();
        let cages = rough.cages.as_ref().map_or_else(String::new, |cages| {
            let each: Vec<String> = cages.iter().map(|c| format!("{:.4}", c.mean)).collect();
            each.join(", ")
        });
        let [x, y] = rough.orbit_m.map(|range| 1e6 * range);
        let _ = writeln!(
            text,
            "| {} | {} | {} | {x:.1} × {y:.1} | {cages} |",
            fidelity.name,
            rough.mesh_n.shown(),
            radial.join(" | ")
        );
    }
    let axial = BEARINGS.join(" | ");
    let _ = write!(
        text,
        "\n| bearings | axial N: {axial} |\n| --- | ---: | ---: | ---: | ---: |\n"
    );
    for (fidelity, rough) in ran() {
        let axial: Vec<String> = rough.axial_n.iter().map(Spread::shown).collect();
        let _ = writeln!(text, "| {} | {} |", fidelity.name, axial.join(" | "));
    }
    for (fidelity, found) in rows {
        if let Err(reason) = found {
            let _ = writeln!(text, "\n{} fails: {reason}", fidelity.name);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scene(name: &str) -> String {
        let file = Path::new(env!("CARGO_MANIFEST_DIR"))
            .join("../../fe_models")
            .join(name);
        std::fs::read_to_string(file).unwrap_or_default()
    }

    #[test]
    fn what_is_taken_out_is_there_in_the_shipped_scenes() {
        for pair in PAIRS {
            for fidelity in &FIDELITIES {
                let whole = scene(&format!("dynamics_bevel_{pair}{}.toml", fidelity.scene));
                assert!(step(&whole).is_some(), "{pair} {}", fidelity.scene);
                for part in fidelity.without {
                    let is_there =
                        whole.lines().any(|line| line.starts_with(part)) || whole.contains(part);
                    assert!(is_there, "`{part}` is not in {pair}{}", fidelity.scene);
                }
                let rest = taken_out(&whole, fidelity.without);
                assert_eq!(rest.matches("[[bearing]]").count(), BEARINGS.len());
            }
        }
    }

    #[test]
    fn a_line_and_a_part_of_a_line_are_taken_out() {
        let text = "a = 1\nfilm = 2\nland = { b = 3, film = { c = 4 } }\n";
        let rest = taken_out(text, &["a = ", ", film = { c = 4 }"]);
        assert_eq!(rest, "film = 2\nland = { b = 3 }\n");
    }

    #[test]
    fn changes_are_the_largest_ones() {
        let one = |mean: f64, deviation: f64| Spread {
            mean,
            deviation,
            range: 1.0,
        };
        let figures = |mean: f64, deviation: f64| Figures {
            step_s: 1e-5,
            cpu_s: 1.0,
            evaluations: 1.0,
            factorisations: 1.0,
            mesh_n: one(100.0, 10.0),
            radial_n: [one(mean, deviation); 4],
            axial_n: [one(-50.0, 5.0); 4],
            orbit_m: [1e-6; 2],
            cages: None,
        };
        let (a, b) = (figures(102.0, 11.0), figures(100.0, 10.0));
        assert!((a.change_of_means(&b) - 2.0).abs() < 1e-9);
        assert!((a.change_of_deviations(&b) - 1.0).abs() < 1e-9);
        let mut text = String::new();
        let failed = Err("balls drift".to_owned());
        let rows = [(&FIDELITIES[1], Ok((a, b))), (&FIDELITIES[2], failed)];
        page(&mut text, "13_35", &rows);
        assert!(text.contains("balls alone fails: balls drift"), "{text}");
        assert!(
            text.contains("| `quasi-static` | 18 | 10 | 1 | 1 | 1.0 | 2.00 | 1.00 |"),
            "{text}"
        );
        assert!(
            text.contains("| 100 ± 10 | 102 ± 11 | 102 ± 11 |"),
            "{text}"
        );
    }
}
