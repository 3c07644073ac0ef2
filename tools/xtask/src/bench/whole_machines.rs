//! `cargo xtask accuracy-cost whole-machines`: scenes with everything in them, how they change with half the step, and
//! what each part costs.

use std::fmt::Write;
use std::process::ExitCode;

use super::bevel_machines::{Runner, Spread, reason, step};
use super::host::Host;
use super::{Bench, Options, write_whole};
use crate::console::say;
use crate::error::XtaskError;
use crate::workspace::Workspace;

/// What is changed in a scene.
enum Edit {
    /// This text, which is there once or more, by another one.
    Replaced(&'static str, &'static str),
    /// Lines that begin so.
    Without(&'static str),
    /// From a line on, to the next empty one.
    Paragraph(&'static str),
}

use Edit::{Paragraph, Replaced, Without};

/// A machine without a part.
struct Part {
    name: &'static str,
    edits: &'static [Edit],
}

/// A scene, the reduced gears that it names, and the parts that can be left out of it.
struct Machine {
    scene: &'static str,
    /// Gear file and model.
    gears: &'static [(&'static str, &'static str)],
    /// Files that it names.
    files: &'static [&'static str],
    /// Columns whose mean and deviation are compared.
    forces: &'static [(&'static str, &'static str)],
    /// Columns of whom the range is compared, in µε.
    strains: &'static [(&'static str, &'static str)],
    parts: &'static [Part],
}

const MACHINES: [Machine; 2] = [
    Machine {
        scene: "dynamics_bevel_13_35_chain.toml",
        gears: &[
            ("bevel_pinion_13_35.toml", "scenes/bevel_pinion_13_35.h5"),
            ("bevel_gear_13_35.toml", "scenes/bevel_gear_13_35.h5"),
        ],
        files: &["bearing_seed_000.toml", "bevel_13_35.toml"],
        forces: &[
            ("mesh force", "elements/mesh/normal_force_left_N"),
            ("pinion near", "elements/pinion near/force_radial_N"),
            ("pinion far", "elements/pinion far/force_radial_N"),
            ("gear near", "elements/gear near/force_radial_N"),
            ("gear far", "elements/gear far/force_radial_N"),
        ],
        strains: &[
            (
                "pinion's root",
                "elements/mesh/strain_gear1_root_method2_ustrain",
            ),
            (
                "gear's root",
                "elements/mesh/strain_gear2_root_method2_ustrain",
            ),
        ],
        parts: &[
            Part {
                name: "root strain",
                edits: &[Paragraph("[[gauge]]")],
            },
            Part {
                name: "modes of the members",
                edits: &[
                    Without("modal_damping_ratio"),
                    Replaced("\"modal\"", "\"reduced\""),
                ],
            },
            Part {
                name: "slices, modes and root strain: one contact a pair of teeth, rigid members",
                edits: &[
                    Paragraph("[[gauge]]"),
                    Without("modal_damping_ratio"),
                    Without("flexibility"),
                    Replaced(
                        "{ kind = \"hybrid\", damping = { kind = \"stiffness-proportional\", time_s = 5e-6, full_depth_um = 1.0 } }",
                        "{ kind = \"impact\", stiffness_N_per_mm_e = 7.2e5, exponent = 1.5, damping_N_s_per_mm = 2.0, full_damping_depth_um = 1.0 }",
                    ),
                ],
            },
            Part {
                name: "balls and cages that move: balls in equilibrium",
                edits: &[
                    Paragraph("[bearing.model.cage]"),
                    Without("ball_loads"),
                    Without("ball_weight"),
                    Without("rebound"),
                    Without("traction"),
                    Replaced(
                        "kind = \"dynamic\"\n",
                        "kind = \"quasi-static\"\nradial_damping_N_s_per_mm = 0.3\naxial_damping_N_s_per_mm = 0.3\ntilt_damping_Nm_s_per_rad = 0.2\n",
                    ),
                ],
            },
        ],
    },
    Machine {
        scene: "dynamics_pair_b_machine.toml",
        gears: &[
            ("gear1.toml", "demo/gear1.h5"),
            ("gear3.toml", "demo/gear3.h5"),
        ],
        files: &["bearing_shaft_pair_b.toml"],
        forces: &[
            ("mesh force", "elements/mesh/normal_force_right_N"),
            ("input left", "elements/input left/force_radial_N"),
            ("input right", "elements/input right/force_radial_N"),
            ("output left", "elements/output left/force_radial_N"),
            ("output right", "elements/output right/force_radial_N"),
        ],
        strains: &[
            (
                "tension",
                "elements/mesh/strain_gear2_t0_tension_method2_ustrain",
            ),
            (
                "compression",
                "elements/mesh/strain_gear2_t0_compression_method2_ustrain",
            ),
        ],
        parts: &[],
    },
];

/// A run of a machine.
struct Found {
    cpu_s: f64,
    evaluations: f64,
    factorisations: f64,
    forces: Vec<Spread>,
    strains: Vec<Spread>,
}

/// Measures and writes docs/benchmarks/whole-machines.md.
///
/// # Errors
/// [`XtaskError`] where the program does not build, a gear cannot be reduced or the page cannot be written; a run that
/// fails is a row of the page.
pub fn whole_machines(workspace: &Workspace, options: &Options) -> Result<ExitCode, XtaskError> {
    let bench = Bench::prepare(workspace, options)?;
    let folder = bench.scratch.join("whole-machines");
    std::fs::create_dir_all(&folder)
        .map_err(XtaskError::io(|| format!("making {}", folder.display())))?;
    let shipped = workspace.root().join("fe_models");
    let models = workspace.root().join("out");
    let runner = Runner::new(bench, folder);
    let mut text = head(&Host::find(workspace.root()));
    for machine in &MACHINES {
        for (gear, model) in machine.gears {
            runner.reduced(&shipped.join(gear), &models.join(model))?;
        }
        for file in machine.files {
            runner.copied(&shipped, file)?;
        }
        let file = shipped.join(machine.scene);
        let scene = std::fs::read_to_string(&file)
            .map_err(XtaskError::io(|| format!("reading {}", file.display())))?;
        let run = |name: &str, scene: &str| {
            say(&format!("== {}: {name}", machine.scene));
            let scene = scene.replace("../out/", &format!("{}/", models.display()));
            found(&runner, machine, &scene).map_err(|error| reason(&error))
        };
        let stated = step(&scene).unwrap_or_default();
        let rows = [
            ("the whole".to_owned(), run("the whole", &scene)),
            (
                "the whole, half the step".to_owned(),
                run("half the step", &with_step(&scene, 0.5 * stated)),
            ),
        ];
        let without = machine.parts.iter().map(|part| {
            let edited = part
                .edits
                .iter()
                .fold(scene.clone(), |text, edit| edit.on(&text));
            (format!("without {}", part.name), run(part.name, &edited))
        });
        let rows: Vec<Row> = rows.into_iter().chain(without).collect();
        page(&mut text, machine, stated, &rows);
    }
    write_whole(
        &workspace.root().join("docs/benchmarks/whole-machines.md"),
        &text,
    )?;
    Ok(ExitCode::SUCCESS)
}

impl Edit {
    fn on(&self, text: &str) -> String {
        match self {
            Replaced(from, to) => text.replace(from, to),
            Without(start) => {
                let kept = text.lines().filter(|line| !line.starts_with(start));
                kept.collect::<Vec<_>>().join("\n") + "\n"
            }
            Paragraph(start) => {
                let kept = text.split("\n\n").filter(|part| !part.starts_with(start));
                kept.collect::<Vec<_>>().join("\n\n") + "\n"
            }
        }
    }
}

fn with_step(scene: &str, step_s: f64) -> String {
    let line = scene.lines().find(|line| line.starts_with("step_s = "));
    scene.replace(line.unwrap_or_default(), &format!("step_s = {step_s:e}"))
}

fn found(runner: &Runner, machine: &Machine, scene: &str) -> Result<Found, XtaskError> {
    let (told, cpu_s) = runner.run_text(scene)?;
    let number = |name: &str| told["run"][name].as_f64().unwrap_or(f64::NAN);
    let spreads = |columns: &[(&str, &str)]| {
        let spread = |(_, column): &(&str, &str)| runner.spread(column);
        columns.iter().map(spread).collect::<Result<Vec<_>, _>>()
    };
    Ok(Found {
        cpu_s,
        evaluations: number("evaluations"),
        factorisations: number("factorisations"),
        forces: spreads(machine.forces)?,
        strains: match scene.contains("[[gauge]]") {
            true => spreads(machine.strains)?,
            false => Vec::new(),
        },
    })
}

fn head(host: &Host) -> String {
    format!(
        "# Whole machines: converged over the step, cost of each part\n\nWritten by `cargo xtask accuracy-cost whole-machines`; do not edit.\n\n\
         | | |\n| --- | --- |\n| processor | {}, {} cores |\n| memory | {} |\n| system | {} |\n| date | {} |\n| commit | {} |\n\n\
         Each row is a run of the shipped scene, whole or without one part. Forces are mean ± RMS about it, strains peak to peak, all over the second half of the run. Seconds are processor time of the whole run; what a part costs is the \
         whole less the run without it, so that parts which make others work harder have their share.\n",
        host.cpu, host.cores, host.memory, host.system, host.date, host.commit
    )
}

/// What was run, and what it gave or why it failed.
type Row = (String, Result<Found, String>);

fn page(text: &mut String, machine: &Machine, step_s: f64, rows: &[Row]) {
    let names = |columns: &[(&str, &str)], unit: &str| -> String {
        let heads = columns.iter().map(|(name, _)| format!(" {name} {unit} |"));
        heads.collect()
    };
    let count = 4 + machine.forces.len() + machine.strains.len();
    // Writing to a String does not fail.
    let _ = write!(
        text,
        "\n## fe_models/{}\n\nSteps of {} µs.\n\n| run | s | evaluations | factorisations |{}{}\n|{}\n",
        machine.scene,
        1e6 * step_s,
        names(machine.forces, "N"),
        names(machine.strains, "µε"),
        " --- |".repeat(count)
    );
    for (name, found) in rows {
        let _ = match found {
            Ok(found) => {
                let forces = found
                    .forces
                    .iter()
                    .map(|force| format!(" {} |", force.shown()));
                let strains = found
                    .strains
                    .iter()
                    .map(|strain| format!(" {:.1} |", strain.range));
                let cells: String = forces.chain(strains).collect();
                writeln!(
                    text,
                    "| {name} | {:.1} | {} | {} |{cells}",
                    found.cpu_s, found.evaluations, found.factorisations
                )
            }
            Err(reason) => writeln!(text, "| {name} | fails: {reason} |"),
        };
    }
    if let [(_, Ok(whole)), (_, Ok(fine)), ..] = rows {
        let pairs = || whole.forces.iter().zip(&fine.forces);
        let most = |of: &dyn Fn((&Spread, &Spread)) -> f64| pairs().map(of).fold(0.0, f64::max);
        let strains = whole.strains.iter().zip(&fine.strains);
        let _ = writeln!(
            text,
            "\nHalf the step changes mean forces by up to {:.2} %, their deviations by {:.2} % of the mean, ranges of strain by {:.2} %.",
            most(&|(a, b)| 100.0 * (a.mean / b.mean - 1.0).abs()),
            most(&|(a, b)| 100.0 * ((a.deviation - b.deviation) / b.mean).abs()),
            strains
                .map(|(a, b)| 100.0 * (a.range / b.range - 1.0).abs())
                .fold(0.0, f64::max)
        );
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use std::path::Path;

    use super::*;

    /// Every edit changes its scene, so that no row is the whole by mistake.
    #[test]
    fn what_is_left_out_is_there_in_the_shipped_scenes() {
        let shipped = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fe_models");
        for machine in &MACHINES {
            let scene = std::fs::read_to_string(shipped.join(machine.scene)).unwrap();
            assert!(step(&scene).is_some());
            for part in machine.parts {
                let mut text = scene.clone();
                for (number, edit) in part.edits.iter().enumerate() {
                    let edited = edit.on(&text);
                    assert!(edited.trim() != text.trim(), "{}, edit {number}", part.name);
                    text = edited;
                }
                assert_eq!(text.matches("[[bearing]]").count(), 4, "{}", part.name);
            }
            for (_, model) in machine.gears {
                assert!(scene.contains(&format!("../out/{model}")), "{model}");
            }
        }
    }

    #[test]
    fn a_paragraph_goes_with_all_its_lines() {
        let text = "a = 1\n\n[[gauge]]\nbody = 2\n\nb = 3\n";
        assert_eq!(Paragraph("[[gauge]]").on(text), "a = 1\n\nb = 3\n\n");
        assert_eq!(with_step("x\nstep_s = 1e-5\n", 5e-6), "x\nstep_s = 5e-6\n");
    }
}
