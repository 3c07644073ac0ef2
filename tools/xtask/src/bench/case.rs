//! One case of a benchmark: a child process, measured, and what it tells of its stages.

use std::path::Path;
use std::process::{Command, Stdio};

use serde_json::Value;

/// What the kernel and the child itself told of a run that ended well.
#[derive(Debug, Clone, PartialEq)]
pub struct Measured {
    /// Wall time \[s\] from start to end of the process.
    pub wall_s: f64,
    /// Processor time \[s\] of all its threads and children.
    pub cpu_s: f64,
    /// Largest resident memory \[byte\] of the process or one of its children.
    pub peak_bytes: f64,
    /// Its standard output.
    pub stdout: String,
}

/// Seconds of the stages that every program has; what a program does besides stands in none of them.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Stages {
    /// Making the mesh, where the program does.
    pub mesh_s: Option<f64>,
    /// Element matrices and their sum.
    pub assembly_s: f64,
    /// All factorisations.
    pub factor_s: f64,
    /// Solving for the loads.
    pub solve_s: f64,
}

/// Runs a command under `tools/bench/measure.py`; the error is the reason in one line.
pub fn measure(
    python: &Path,
    bench_dir: &Path,
    timeout_s: u32,
    command: &Command,
) -> Result<Measured, String> {
    let mut wrapper = Command::new(python);
    wrapper
        .arg(bench_dir.join("measure.py"))
        .arg(timeout_s.to_string())
        .arg(command.get_program())
        .args(command.get_args())
        .stdin(Stdio::null());
    for (name, value) in command.get_envs() {
        if let Some(value) = value {
            wrapper.env(name, value);
        }
    }
    if let Some(dir) = command.get_current_dir() {
        wrapper.current_dir(dir);
    }
    let output = wrapper
        .output()
        .map_err(|error| format!("cannot start the measuring: {error}"))?;
    if !output.status.success() {
        return Err(format!("the measuring ended with {}", output.status));
    }
    read_measured(&String::from_utf8_lossy(&output.stdout), timeout_s)
}

/// Reads what `measure.py` prints.
fn read_measured(text: &str, timeout_s: u32) -> Result<Measured, String> {
    let value: Value =
        serde_json::from_str(text).map_err(|error| format!("unreadable measurement: {error}"))?;
    if let Some(reason) = value["error"].as_str() {
        return Err(format!("not started: {reason}"));
    }
    if value["timed_out"].as_bool() == Some(true) {
        return Err(format!("stopped after {timeout_s} s"));
    }
    let number = |key: &str| {
        value[key]
            .as_f64()
            .ok_or_else(|| format!("no {key} in the measurement"))
    };
    match value["exit"].as_i64() {
        Some(0) => Ok(Measured {
            wall_s: number("wall_s")?,
            cpu_s: number("cpu_s")?,
            peak_bytes: number("peak_bytes")?,
            stdout: value["stdout"].as_str().unwrap_or_default().to_owned(),
        }),
        Some(-9) => Err(format!(
            "killed (memory?) at {:.1} GB after {:.0} s",
            number("peak_bytes")? / 1e9,
            number("wall_s")?
        )),
        Some(code) => {
            let tail = value["stderr"].as_str().unwrap_or_default();
            let last = tail.lines().rev().find(|line| !line.trim().is_empty());
            Err(format!(
                "exit code {code}: {}",
                last.unwrap_or("no message").trim()
            ))
        }
        None => Err("no exit code in the measurement".into()),
    }
}

/// Sums `stage_seconds` by what the stages are, over the stage names of all programs.
pub fn stages(figures: &Value) -> Stages {
    let mut stages = Stages::default();
    for entry in figures["stage_seconds"].as_array().into_iter().flatten() {
        let seconds = entry["seconds"].as_f64().unwrap_or(0.0);
        match entry["stage"].as_str() {
            Some("mesh") => stages.mesh_s = Some(seconds),
            Some("model" | "assembly") => stages.assembly_s += seconds,
            // Ours by repetition: element matrices of a tooth and a sector are made where they are factorised.
            Some("factor" | "tooth factor" | "sector factor" | "harmonics") => {
                stages.factor_s += seconds;
            }
            Some("solve") => stages.solve_s += seconds,
            _ => {}
        }
    }
    stages
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn a_good_run_is_read_with_its_output() {
        let text = r#"{"exit": 0, "timed_out": false, "wall_s": 2.5, "cpu_s": 4.0, "peak_bytes": 1e9,
            "stdout": "{}\n", "stderr": "a warning"}"#;
        let expected = Measured {
            wall_s: 2.5,
            cpu_s: 4.0,
            peak_bytes: 1e9,
            stdout: "{}\n".into(),
        };
        assert_eq!(read_measured(text, 10), Ok(expected));
    }

    #[test]
    fn a_bad_run_says_why() {
        let reason = |text: &str| read_measured(text, 60).unwrap_err();
        assert_eq!(
            reason(r#"{"exit": 1, "stderr": "Traceback\nMemoryError: 3 GB\n\n"}"#),
            "exit code 1: MemoryError: 3 GB"
        );
        assert_eq!(
            reason(r#"{"exit": -9, "timed_out": true}"#),
            "stopped after 60 s"
        );
        assert_eq!(
            reason(r#"{"exit": -9, "timed_out": false, "wall_s": 30.2, "peak_bytes": 2.2e10}"#),
            "killed (memory?) at 22.0 GB after 30 s"
        );
        assert_eq!(
            reason(r#"{"exit": null, "error": "No such file"}"#),
            "not started: No such file"
        );
        assert!(reason("no json").starts_with("unreadable measurement"));
        assert_eq!(reason(r#"{"exit": 0}"#), "no wall_s in the measurement");
    }

    #[test]
    fn stages_are_summed_by_kind() {
        let entry = |stage: &str, seconds: f64| json!({"stage": stage, "seconds": seconds});
        let figures = json!({"stage_seconds": [
            entry("mesh", 1.0), entry("model", 2.0), entry("assembly", 4.0), entry("tooth factor", 8.0),
            entry("harmonics", 16.0), entry("solve", 32.0), entry("near field", 64.0),
        ]});
        assert_eq!(
            stages(&figures),
            Stages {
                mesh_s: Some(1.0),
                assembly_s: 6.0,
                factor_s: 24.0,
                solve_s: 32.0
            }
        );
    }

    #[test]
    fn the_wrapper_measures_a_real_child() {
        let bench_dir = Path::new(env!("CARGO_MANIFEST_DIR")).join("../bench");
        let Ok(python) = crate::machine::find_python() else {
            panic!("the tests need the Python that the whole project needs");
        };
        let run = |script: &str, timeout_s| {
            let mut command = Command::new("sh");
            command.args(["-c", script]);
            measure(Path::new(&python.program), &bench_dir, timeout_s, &command)
        };
        let measured = run("echo out; sleep 0.2", 20).unwrap();
        assert_eq!(measured.stdout, "out\n");
        assert!(
            measured.wall_s >= 0.2 && measured.cpu_s < measured.wall_s,
            "{measured:?}"
        );
        assert!(
            measured.peak_bytes > 1e5 && measured.peak_bytes < 1e8,
            "{measured:?}"
        );
        assert_eq!(
            run("echo why >&2; exit 3", 20),
            Err("exit code 3: why".into())
        );
        assert_eq!(run("sleep 20", 1), Err("stopped after 1 s".into()));
    }
}
