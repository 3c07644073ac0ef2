//! `cargo xtask accuracy-cost`: what accuracy costs in time, by `gearmesh accuracy` on scenes of every kind, in one
//! page and one picture.
//!
//! Processor time counts: it hardly changes where other work shares the machine.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};
use std::time::Instant;

use serde_json::{Value, json};

use super::accuracy_page;
use super::host::Host;
use super::{Bench, Options, write_whole};
use crate::console::{readable, say};
use crate::error::XtaskError;
use crate::workspace::Workspace;

/// A scene and what of it is to be exact.
pub struct Subject {
    /// Heading.
    pub title: &'static str,
    /// In fe_models.
    pub scene: &'static str,
    /// What of the scene's text is replaced, so that a run is no longer than the question needs.
    pub changed: &'static [(&'static str, &'static str)],
    /// Columns of `gearmesh accuracy`.
    pub columns: &'static [&'static str],
    /// Seconds that a run in time settles.
    pub from_s: f64,
    /// Vary the gears' meshes, too.
    pub elements: bool,
}

const AT_REST: &[&str] = &[
    "te_mean_um",
    "te_peak_to_peak_um",
    "te_harmonic_1_um",
    "pressure_largest_MPa",
    "strain_gear2_t0_tension_method2_range_ustrain",
];
/// Mean, largest value, mesh line and the speed of resonance, over five speeds.
const THROUGH: &[&str] = &[
    "elements/mesh/normal_force_right_N:largest",
    "elements/mesh/transmission_error_m:peak-to-peak",
    "elements/mesh/transmission_error_m:resonance-rpm",
];
/// What the step decides; means are fixed by statics.
const BEVEL_IN_MOTION: &[&str] = &[
    "elements/mesh/transmission_error_m:deviation",
    "elements/mesh/tangential_force_1_N:deviation",
];
const GEARBOX: &[&str] = &[
    "elements/first stage/transmission_error_m:mean",
    "elements/third stage/transmission_error_m:mean",
    "elements/bearing 2A/force_radial_N:mean",
    "elements/bearing 3B/force_radial_N:mean",
];

/// All of them; the first two make the quick page.
pub const SUBJECTS: [Subject; 13] = [
    Subject {
        title: "Pair A at rest",
        scene: "pair_a.toml",
        changed: &[],
        columns: AT_REST,
        from_s: 0.0,
        elements: false,
    },
    Subject {
        title: "Pair B at rest",
        scene: "pair_b.toml",
        changed: &[],
        columns: AT_REST,
        from_s: 0.0,
        elements: false,
    },
    Subject {
        title: "Pair A on its resonance, 2450 rpm",
        scene: "dynamics_pair_a_resonance.toml",
        changed: &[],
        columns: &[
            "elements/mesh/normal_force_right_N:largest",
            "elements/mesh/transmission_error_m:mean",
            "elements/mesh/transmission_error_m:peak-to-peak",
            "elements/mesh/transmission_error_m:line-2327.5Hz",
        ],
        from_s: 0.06,
        elements: false,
    },
    Subject {
        title: "A three-stage gearbox of reduced gears under load",
        scene: "gearbox_three_stage_hybrid.toml",
        changed: &[],
        columns: GEARBOX,
        from_s: 0.0,
        elements: false,
    },
    Subject {
        title: "A spindle on a bearing pair whose balls move, 6000 rpm",
        scene: "spindle_6000_rpm.toml",
        changed: &[("end_s = 0.1", "end_s = 0.04")],
        columns: &["bodies/shaft/y_m:mean", "elements/pair/force_radial_N:mean"],
        from_s: 0.02,
        elements: false,
    },
    Subject {
        title: "A bevel pair's tooth contact",
        scene: "bevel_13_35.toml",
        changed: &[],
        columns: &[
            "te_peak_to_peak_urad",
            "te_harmonic_1_urad",
            "contact_ratio",
        ],
        from_s: 0.0,
        elements: false,
    },
    Subject {
        title: "Pair A through its resonance, 2200 to 2800 rpm",
        scene: "dynamics_pair_a_sweep.toml",
        changed: &[
            ("from_rpm = -600.0", "from_rpm = -2200.0"),
            ("to_rpm = -4200.0", "to_rpm = -2800.0"),
            ("speeds = 37", "speeds = 5\ndirection = \"up\""),
            ("settle_s = 0.06", "settle_s = 0.03"),
            ("measure_s = 0.1 ", "measure_s = 0.03 "),
            ("speed_rpm = -600.0", "speed_rpm = -2200.0"),
        ],
        columns: THROUGH,
        from_s: 0.0,
        elements: false,
    },
    Subject {
        title: "Pair B through its resonance, 1600 to 2200 rpm",
        scene: "dynamics_pair_b_sweep.toml",
        changed: &[
            ("from_rpm = -600.0", "from_rpm = -1600.0"),
            ("to_rpm = -4200.0", "to_rpm = -2200.0"),
            ("speeds = 37", "speeds = 5\ndirection = \"up\""),
            ("settle_s = 0.06", "settle_s = 0.03"),
            ("measure_s = 0.1 ", "measure_s = 0.03 "),
            ("speed_rpm = -600.0", "speed_rpm = -1600.0"),
        ],
        columns: THROUGH,
        from_s: 0.0,
        elements: false,
    },
    Subject {
        title: "A bevel pair in motion",
        scene: "dynamics_bevel_20_20.toml",
        changed: &[],
        columns: BEVEL_IN_MOTION,
        from_s: 0.0,
        elements: false,
    },
    Subject {
        title: "A bevel pair of elastic members in motion",
        scene: "dynamics_bevel_20_20_hybrid.toml",
        changed: &[("end_s = 0.08", "end_s = 0.05")],
        columns: BEVEL_IN_MOTION,
        from_s: 0.04,
        elements: false,
    },
    Subject {
        title: "A bevel pair under load",
        scene: "bevel_20_20_loaded.toml",
        changed: &[],
        columns: &[
            "loaded_te_mean_urad",
            "loaded_te_peak_to_peak_urad",
            "pressure_inside_MPa",
        ],
        from_s: 0.0,
        elements: false,
    },
    Subject {
        title: "Pinion 23 and a drilled wheel 47 at rest",
        scene: "pair_23_47.toml",
        changed: &[],
        columns: AT_REST,
        from_s: 0.0,
        elements: false,
    },
    Subject {
        title: "Pair A at rest over one pitch, with the meshes of its gears",
        scene: "pair_a_one_pitch.toml",
        changed: &[("[run]", "[gauges]\ngear_2 = [\"t0_tension\"]\n\n[run]")],
        columns: AT_REST,
        from_s: 0.0,
        elements: true,
    },
];

/// Models that the scenes name, by the gear files they are made of.
const MODELS: [(&str, &str); 13] = [
    ("gear1", "demo"),
    ("gear2", "demo"),
    ("gear3", "demo"),
    ("gearbox_17", "gearbox"),
    ("gearbox_59", "gearbox"),
    ("gearbox_19", "gearbox"),
    ("gearbox_67", "gearbox"),
    ("gearbox_21", "gearbox"),
    ("gearbox_73", "gearbox"),
    ("bevel_pinion_20_20", "scenes"),
    ("bevel_gear_20_20", "scenes"),
    ("pinion_23", "pair_23_47"),
    ("wheel_47_drilled", "pair_23_47"),
];

/// Tries all scenes, writes the page and the picture. A scene that fails is told in its place, and the command fails at
/// the end.
///
/// # Errors
/// [`XtaskError`] where the program does not build, a gear is not reduced or a file cannot be written.
pub fn accuracy_cost(workspace: &Workspace, options: &Options) -> Result<ExitCode, XtaskError> {
    let start = Instant::now();
    let bench = Bench::prepare(workspace, options)?;
    let host = Host::find(workspace.root());
    let count = if options.quick { 2 } else { SUBJECTS.len() };
    let models = if options.quick { 3 } else { MODELS.len() };
    for (gear, folder) in &MODELS[..models] {
        reduce(&bench, gear, folder)?;
    }
    let (folder, name) = match options.quick {
        true => ("out", "accuracy-cost-quick"),
        false => ("docs", "accuracy-cost"),
    };
    let folder = workspace.root().join(folder);
    fs::create_dir_all(&folder)
        .map_err(XtaskError::io(|| format!("making {}", folder.display())))?;
    let (picture, page) = (format!("{name}.svg"), folder.join(format!("{name}.md")));
    let mut found: Vec<accuracy_page::Tried<'_>> = Vec::new();
    for subject in &SUBJECTS[..count] {
        say(&format!("== {}", subject.title));
        let outcome = tried(&bench, subject);
        if let Err(reason) = &outcome {
            say(reason);
        }
        found.push((subject, outcome));
        // After each scene: a run that is broken off leaves what it has.
        plot(&bench, &found, &folder.join(&picture)).map_err(|reason| XtaskError::Io {
            action: "drawing the picture".into(),
            source: std::io::Error::other(reason),
        })?;
        let left: Vec<&str> = SUBJECTS[found.len()..count]
            .iter()
            .map(|s| s.title)
            .collect();
        let text = accuracy_page::page(&host, &bench.profile, (&found, &left), &picture);
        // Pages name no place of one machine.
        let place = format!("{}/", workspace.root().display());
        write_whole(&page, &text.replace(&place, ""))?;
    }
    if !options.quick {
        let stored = workspace
            .root()
            .join("crates/scene/src/accuracy/fronts.toml");
        write_whole(&stored, &fronts(&found))?;
    }
    say(&format!(
        "\nwritten in {}: {}",
        readable(start.elapsed()),
        page.display()
    ));
    let failed = found.iter().any(|(_, outcome)| outcome.is_err());
    Ok(ExitCode::from(u8::from(failed)))
}

/// The settings that were recommended, rung by rung: where `gearmesh run --accuracy` begins.
fn fronts(found: &[accuracy_page::Tried<'_>]) -> String {
    let mut text = "# Written by `cargo xtask accuracy-cost`; do not edit.\n".to_owned();
    let told = found
        .iter()
        .filter_map(|(subject, told)| Some((subject, told.as_ref().ok()?)));
    for (subject, told) in told {
        for advice in told["advice"].as_array().into_iter().flatten() {
            let goal = advice["goal"]
                .as_str()
                .and_then(|goal| goal.strip_suffix(" %"));
            let (Some(Ok(percent)), Some(rungs)) = (
                goal.map(str::parse::<f64>),
                advice["run_again"]["rungs"].as_object(),
            ) else {
                continue;
            };
            let rungs: Vec<String> = rungs
                .iter()
                .map(|(knob, rung)| format!("\"{knob}\" = {rung}"))
                .collect();
            text += &format!(
                "\n[[front]]\nscene = \"{}\"\nkind = {}\ngoal = {}\nrungs = {{ {} }}\n",
                subject.title,
                told["kind"],
                percent / 100.0,
                rungs.join(", ")
            );
        }
    }
    text
}

/// Makes a model unless it is there.
fn reduce(bench: &Bench, gear: &str, folder: &str) -> Result<(), XtaskError> {
    let model = bench.root.join(format!("out/{folder}/{gear}.h5"));
    if model.exists() {
        return Ok(());
    }
    let folder = model.parent().unwrap_or(&bench.root);
    fs::create_dir_all(folder)
        .map_err(XtaskError::io(|| format!("making {}", folder.display())))?;
    say(&format!("== reducing {gear}"));
    let source = bench.root.join(format!("fe_models/{gear}.toml"));
    let mut command = bench.gearmesh("reduce", &source, &model);
    let done = bench.run(&mut command);
    done.map(|_| ()).map_err(|reason| XtaskError::Failed {
        command: format!("reduce {gear}"),
        status: reason,
    })
}

/// What `gearmesh accuracy` says of a scene, or has said before where neither program, scene nor arguments have changed
/// since: a page that was broken off goes on where it was.
fn tried(bench: &Bench, subject: &Subject) -> Result<Value, String> {
    let scene = scene_file(bench, subject)?;
    let arguments = arguments(&scene, subject);
    let identity = json!([
        bench.stamp()?,
        fs::read_to_string(&scene).map_err(|e| e.to_string())?,
        arguments,
    ]);
    let kept = bench.scratch.join(format!("accuracy-{}", subject.scene));
    let kept = kept.with_extension("json");
    let before = fs::read_to_string(&kept).ok();
    let before: Option<Value> = before.and_then(|text| serde_json::from_str(&text).ok());
    if let Some(before) = before.filter(|before| before["identity"] == identity) {
        say("kept from an earlier run");
        return Ok(before["told"].clone());
    }
    let mut command = Command::new(&bench.program);
    command.current_dir(&bench.root).args(&arguments);
    let (_, told) = bench.run(&mut command)?;
    let text = json!({"identity": identity, "told": told}).to_string();
    fs::write(&kept, text).map_err(|e| e.to_string())?;
    Ok(told)
}

fn arguments(scene: &Path, subject: &Subject) -> Vec<String> {
    let mut arguments = vec![
        "accuracy".to_owned(),
        scene.display().to_string(),
        format!("--columns={}", subject.columns.join(",")),
        format!("--from-s={}", subject.from_s),
    ];
    arguments.extend(["--time", "processor", "--json"].map(str::to_owned));
    if subject.elements {
        arguments.extend(["--elements", "out/accuracy-models"].map(str::to_owned));
    }
    arguments
}

/// The shipped scene, or a changed copy one folder below the root, as the shipped one stands.
fn scene_file(bench: &Bench, subject: &Subject) -> Result<PathBuf, String> {
    let shipped = bench.root.join("fe_models").join(subject.scene);
    if subject.changed.is_empty() {
        return Ok(shipped);
    }
    let text = fs::read_to_string(&shipped).map_err(|e| e.to_string())?;
    let text = changed(&text, subject.changed, &bench.root.join("fe_models"))?;
    let copy = bench.root.join("out").join(subject.scene);
    fs::write(&copy, text).map_err(|e| e.to_string())?;
    Ok(copy)
}

/// A text with words replaced, each of which must be there, and with names of files in the folder made absolute.
fn changed(text: &str, words: &[(&str, &str)], folder: &Path) -> Result<String, String> {
    let mut text = text.to_owned();
    for (old, new) in words {
        if !text.contains(old) {
            return Err(format!("the scene has no `{old}` to replace"));
        }
        text = text.replace(old, new);
    }
    for key in ["file", "bevel_pair"] {
        let begin = format!("{key} = \"");
        text = text.replace(&begin, &format!("{begin}{}/", folder.display()));
    }
    Ok(text)
}

fn plot(bench: &Bench, found: &[accuracy_page::Tried<'_>], picture: &Path) -> Result<(), String> {
    let panels: Vec<Value> = found
        .iter()
        .filter_map(|(subject, outcome)| {
            let told = outcome.as_ref().ok()?;
            Some(json!({"title": subject.title, "tried": told["tried"], "advice": told["advice"]}))
        })
        .collect();
    let data = bench.scratch.join("accuracy-points.json");
    fs::write(&data, Value::from(panels).to_string()).map_err(|error| error.to_string())?;
    let mut command = bench.python_script("accuracy_plot.py");
    command.arg(&data).arg(picture);
    bench.measured(&mut command).map(|_| ())
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    /// Scenes are there, and what is replaced in them is.
    #[test]
    fn scenes_are_shipped_and_take_their_changes() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fe_models");
        for subject in &SUBJECTS {
            let text = fs::read_to_string(folder.join(subject.scene)).unwrap();
            let text = changed(&text, subject.changed, &folder).unwrap();
            // A copy stands in another folder; comments name files, too.
            let is_copied = !subject.changed.is_empty();
            let lines = text
                .lines()
                .filter(|line| is_copied && !line.starts_with('#'));
            for line in lines {
                let quoted = line.split('"').skip(1).step_by(2);
                for name in quoted.filter(|name| name.ends_with(".toml")) {
                    assert!(Path::new(name).is_file(), "{}: {name}", subject.scene);
                }
            }
        }
    }

    #[test]
    fn files_keep_their_places_in_a_copy() {
        let text = "end = 1\nfile = \"b.toml\"\n";
        let found = changed(text, &[("end = 1", "end = 2")], Path::new("/m")).unwrap();
        assert_eq!(found, "end = 2\nfile = \"/m/b.toml\"\n");
        assert!(changed(text, &[("start", "")], Path::new("/m")).is_err());
    }
}
