//! `gearmesh doctor`: what this machine has, what it lacks and what that is needed for.

use crate::arguments::DoctorArguments;
use crate::console;
use gearmesh_mesh::python::{PYTHON_VARIABLE, PythonEnvironment};
use gearmesh_operations::Failure;
use gearmesh_operations::memory::free_bytes;
use serde_json::{Value, json};
use std::process::{Command, Stdio};

/// Packages of the Python environment and what uses them.
const PACKAGES: [(&str, &str); 4] = [
    ("gmsh", "meshing: reduce, mesh, modes"),
    (
        "meshio",
        "meshes of other programs: mesh, modes --shapes, imported bodies",
    ),
    (
        "gearmesh",
        "the Python module, through which meshes are exchanged",
    ),
    ("pyuff", UNIVERSAL_FILES),
];

/// What the one package is for that little needs.
const UNIVERSAL_FILES: &str = "universal files: record";

/// Imports each package and prints one line for it: name, version or what went wrong.
const PROBE: &str = r#"
import importlib, sys
print("python", ".".join(map(str, sys.version_info[:3])))
for name in sys.argv[1:]:
    try:
        module = importlib.import_module(name)
        print(name, getattr(module, "__version__", "found"))
    except BaseException as cause:
        print(name, "!", " ".join(str(cause).split())[:200])
"#;

/// Something that was looked for.
struct Finding {
    name: String,
    /// What was found, or what is wrong.
    text: String,
    is_sound: bool,
    /// What it is for and what to do where it is missing.
    advice: String,
    /// Whether the program is less without it.
    is_needed: bool,
}

/// Runs the command.
pub fn run(a: &DoctorArguments) -> Result<(), Failure> {
    let mut findings = vec![machine()];
    findings.extend(python());
    findings.push(calculix());
    if a.json {
        console::json(&findings.iter().map(figures).collect::<Value>());
    } else {
        for f in &findings {
            let mark = match (f.is_sound, f.is_needed) {
                (true, _) => "ok     ",
                (false, true) => "MISSING",
                (false, false) => "absent ",
            };
            console::data(format!("{mark} {}: {}", f.name, f.text));
            if !f.is_sound {
                console::data(format!("        {}", f.advice));
            }
        }
    }
    let lacking: Vec<&str> = findings
        .iter()
        .filter(|f| f.is_needed && !f.is_sound)
        .map(|f| &f.name[..])
        .collect();
    if lacking.is_empty() {
        return Ok(());
    }
    Err(Failure::work(format!(
        "missing: {}; scenes without gears to reduce run all the same",
        lacking.join(", ")
    )))
}

fn figures(f: &Finding) -> Value {
    json!({ "name": f.name, "found": f.text, "sound": f.is_sound, "needed": f.is_needed, "advice": f.advice })
}

fn machine() -> Finding {
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let memory = free_bytes().map_or_else(
        || "memory not known".to_owned(),
        |bytes| format!("{:.1} GB of memory free", 1e-9 * bytes),
    );
    Finding {
        name: "machine".to_owned(),
        text: format!("{threads} processors, {memory}"),
        is_sound: true,
        advice: String::new(),
        is_needed: false,
    }
}

fn python() -> Vec<Finding> {
    let explained = format!(
        "gears are meshed in a Python environment with gmsh and meshio: that named by {PYTHON_VARIABLE}, else `.venv/bin/python` in a folder above the program. \
         With the archive: in its folder python3 -m venv .venv, .venv/bin/pip install ./gearmesh-*.whl. With the sources: cargo xtask prepare. Elsewhere: python3 -m venv .venv, \
         .venv/bin/pip install the wheel, or gmsh meshio alone, export {PYTHON_VARIABLE}=$PWD/.venv/bin/python"
    );
    let missing = |text: String| Finding {
        name: "python".to_owned(),
        text,
        is_sound: false,
        advice: explained.clone(),
        is_needed: true,
    };
    let environment = match PythonEnvironment::find() {
        Ok(environment) => environment,
        Err(cause) => return vec![missing(cause.to_string())],
    };
    let by = if std::env::var_os(PYTHON_VARIABLE).is_some() {
        PYTHON_VARIABLE
    } else {
        "above the program"
    };
    let place = format!("{} ({by})", environment.interpreter().display());
    let names: Vec<&str> = PACKAGES.iter().map(|p| p.0).collect();
    let output = match environment.run("looking for packages", PROBE, &names, &[]) {
        Ok(output) => String::from_utf8_lossy(&output).into_owned(),
        Err(cause) => return vec![missing(format!("{place}: {cause}"))],
    };
    let mut findings = Vec::new();
    for line in output.lines() {
        let (name, rest) = line.split_once(' ').unwrap_or((line, ""));
        let problem = rest.strip_prefix("! ");
        let used = PACKAGES.iter().find(|p| p.0 == name).map_or("", |p| p.1);
        let advice = match name {
            "gmsh" => format!(
                "{used}; pip install gmsh, and on Debian apt-get install libglu1-mesa libgl1 libxcursor1 libxft2 libxinerama1 libgomp1"
            ),
            "gearmesh" => format!(
                "{used}; pip install the wheel (gearmesh-*.whl, of the archive) into that environment; with the sources `cargo xtask prepare` builds it"
            ),
            _ => format!("{used}; pip install {name} into that environment"),
        };
        let text = if name == "python" {
            format!("{rest}, {place}")
        } else {
            problem.unwrap_or(rest).to_owned()
        };
        findings.push(Finding {
            name: name.to_owned(),
            text,
            is_sound: problem.is_none(),
            advice: problem.map_or_else(String::new, |_| advice),
            is_needed: used != UNIVERSAL_FILES,
        });
    }
    findings
}

fn calculix() -> Finding {
    let found = Command::new("ccx").arg("-v").stdin(Stdio::null()).output();
    Finding {
        name: "CalculiX".to_owned(),
        text: found.as_ref().map_or_else(
            |_| "not found".to_owned(),
            |o| {
                String::from_utf8_lossy(&o.stdout)
                    .split_whitespace()
                    .collect::<Vec<_>>()
                    .join(" ")
            },
        ),
        is_sound: found.is_ok(),
        advice: "nothing that is computed needs it: a benchmark of the sources compares with it"
            .to_owned(),
        is_needed: false,
    }
}
