//! What the tests of the program share: starting it, two small gears, their reduced models and scenes.
//!
//! Both gears have the teeth and the coarse mesh of the tests of the reduction: they take seconds, and the identities
//! that are asserted hold on any mesh.
#![allow(clippy::unwrap_used, clippy::expect_used, dead_code, missing_docs)]

pub mod doors;

use gearmesh_bevel::Flank;
use serde_json::Value;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::sync::OnceLock;
use std::sync::mpsc::channel;
use std::time::Duration;

/// A solid gear with 18 teeth.
pub const SOLID: &str = r#"name = "small solid"
[tooth]
teeth = 18
module_mm = 3.0
profile_shift = 0.1
face_width_mm = 12.0
[blank]
kind = "solid"
bore_diameter_mm = 14.0
[material]
young_GPa = 210.0
poisson = 0.3
[reduction]
roll_stations = 4
slices = 2
flanks = ["right"]
[mesh]
flank_mm = 1.5
fillet_mm = 0.6
body_mm = 4.0
axial_mm = 3.0
"#;

/// A gear with a thin rim, 18 teeth and a gauge in each root of tooth 17, which pair 1 loads.
pub const THIN: &str = r#"name = "small thin rim"
[tooth]
teeth = 18
module_mm = 3.0
profile_shift = 0.1
face_width_mm = 12.0
[blank]
kind = "thin-rim"
bore_diameter_mm = 14.0
hub_diameter_mm = 20.0
rim_inner_diameter_mm = 38.0
web_thickness_mm = 4.0
[material]
young_GPa = 210.0
poisson = 0.3
[reduction]
roll_stations = 4
slices = 2
flanks = ["right", "left"]
[mesh]
flank_mm = 1.5
fillet_mm = 0.6
body_mm = 4.0
axial_mm = 3.0
[[gauge]]
name = "tension"
tooth = 17
side = "right"
length_mm = 0.9
width_mm = 4.0
[[gauge]]
name = "compression"
tooth = 17
side = "left"
length_mm = 0.9
width_mm = 4.0
"#;

/// What the program answered.
#[derive(Debug)]
pub struct Answer {
    /// Exit code; `None` when a signal ended it.
    pub code: Option<i32>,
    /// Data.
    pub stdout: String,
    /// Progress, warnings, errors.
    pub stderr: String,
}

impl From<Output> for Answer {
    fn from(output: Output) -> Self {
        Self {
            code: output.status.code(),
            stdout: String::from_utf8(output.stdout).unwrap(),
            stderr: String::from_utf8(output.stderr).unwrap(),
        }
    }
}

impl Answer {
    /// The data as JSON.
    pub fn json(&self) -> Value {
        serde_json::from_str(&self.stdout).unwrap_or_else(|e| panic!("{e} in {self:#?}"))
    }
}

/// The program with its words, not yet started. Its output is read, never inherited.
pub fn program(arguments: &[impl AsRef<OsStr>]) -> Command {
    let mut program = Command::new(env!("CARGO_BIN_EXE_gearmesh"));
    // Help is folded at the width of the terminal, so the tests state one.
    program
        .args(arguments)
        .env("COLUMNS", "100")
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped());
    program
}

/// Starts the program.
pub fn gearmesh(arguments: &[impl AsRef<OsStr>]) -> Answer {
    program(arguments).output().unwrap().into()
}

/// Runs a program, which must end by itself within a time.
pub fn ends(mut program: Command, within: Duration) -> Answer {
    let child = program.spawn().unwrap();
    let pid = child.id();
    let (done, waits) = channel();
    let work = std::thread::spawn(move || {
        let output = child.wait_with_output();
        let _ = done.send(());
        output
    });
    if waits.recv_timeout(within).is_err() {
        send("-KILL", pid);
        panic!("{program:?} does not end within {within:?}");
    }
    work.join().unwrap().unwrap().into()
}

/// Sends a signal, as `-INT`, to a process that may have ended by itself.
pub fn send(signal: &str, process: u32) {
    let kill = Command::new("kill")
        .args([signal, &process.to_string()])
        .stderr(Stdio::null())
        .status();
    let _ = kill.unwrap();
}

/// Starts the program and goes on.
pub fn begin(arguments: &[impl AsRef<OsStr>]) -> Child {
    program(arguments).spawn().unwrap()
}

/// The root of the project.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Starts the program, which must succeed.
pub fn succeeds(arguments: &[impl AsRef<OsStr>]) -> Answer {
    let answer = gearmesh(arguments);
    assert_eq!(answer.code, Some(0), "{answer:#?}");
    answer
}

/// `text` with one part replaced; the part must be there.
pub fn changed(text: &str, from: &str, to: &str) -> String {
    assert!(text.contains(from), "{from} is not in {text}");
    text.replacen(from, to, 1)
}

/// Line of `part` in `text`, counted from one.
pub fn line_of(text: &str, part: &str) -> usize {
    1 + text.lines().position(|line| line.contains(part)).unwrap()
}

/// A file path as an argument.
pub fn argument(path: &Path) -> &str {
    path.to_str().unwrap()
}

/// Gear files and models of both gears, made once per test program.
pub struct Workshop {
    /// Where they are.
    pub folder: PathBuf,
    /// Gear file and model of the solid gear.
    pub solid: PathBuf,
    /// Gear file and model of the gear with the thin rim.
    pub thin: PathBuf,
    /// What `gearmesh reduce --json` printed for each.
    pub figures: [Value; 2],
}

impl Workshop {
    /// A scene of both gears in a folder of its own: solid drives thin rim, three pitches.
    ///
    /// `further` is put at the end of the table \[mesh\]; the path is the line of action unless it names one.
    pub fn scene(&self, further: &str) -> String {
        let path = if further.contains("path =") {
            ""
        } else {
            "teeth.path = \"line-of-action\"\n"
        };
        format!(
            r#"title = "small pair"
[pair]
gear_1 = "{}"
gear_2 = "{}"
centre_distance_mm = 54.7
[run]
torques_Nm = [20.0, 60.0]
pitches = 3
points_per_pitch = 8
[gauges]
gear_2 = ["tension"]
[mesh]
model.kind = "hybrid"
model.local = "weber-banaschek"
{path}{further}"#,
            self.solid.display(),
            self.thin.display()
        )
    }
}

/// The models, reduced when they are first asked for.
pub fn workshop() -> &'static Workshop {
    static MADE: OnceLock<Workshop> = OnceLock::new();
    MADE.get_or_init(|| {
        // One folder per process: test runners may start each test in a process of its own.
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR"))
            .join(format!("gears-{}", env!("CARGO_CRATE_NAME")));
        std::fs::create_dir_all(&folder).unwrap();
        let reduced = |name: &str, text: &str| {
            let (gear, model) = (
                folder.join(format!("{name}.toml")),
                folder.join(format!("{name}.h5")),
            );
            std::fs::write(&gear, text).unwrap();
            let answer = succeeds(&["reduce", argument(&gear), "-o", argument(&model), "--json"]);
            (model, answer.json())
        };
        let (solid, solid_figures) = reduced("solid", SOLID);
        let (thin, thin_figures) = reduced("thin", THIN);
        Workshop {
            folder,
            solid,
            thin,
            figures: [solid_figures, thin_figures],
        }
    })
}

/// A folder that vanishes with the test, and files in it.
pub struct Desk(tempfile::TempDir);

impl Desk {
    pub fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub fn file(&self, name: &str, content: impl AsRef<[u8]>) -> PathBuf {
        let path = self.path(name);
        std::fs::write(&path, content).unwrap();
        path
    }

    /// Names of all files, sorted.
    pub fn names(&self) -> Vec<String> {
        names_in(self.0.path())
    }
}

/// Names of all files of a folder, sorted; hidden ones too.
pub fn names_in(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

/// The answer is an error with this exit code and all of these parts.
pub fn refused(answer: &Answer, code: i32, parts: &[&str]) {
    assert_eq!(answer.code, Some(code), "{answer:#?}");
    assert_eq!(answer.stdout, "", "data in spite of an error");
    assert!(
        answer
            .stderr
            .lines()
            .any(|line| line.starts_with("error: ")),
        "{answer:#?}"
    );
    for part in parts {
        assert!(
            answer.stderr.contains(part),
            "`{part}` is not in {answer:#?}"
        );
    }
}

/// A number of a JSON document.
pub fn number(value: &Value) -> f64 {
    value
        .as_f64()
        .unwrap_or_else(|| panic!("{value} is no number"))
}

/// Runs a scene that has `further` in its table \[mesh\]; the result file and the printed figures.
pub fn run_scene(desk: &Desk, further: &str) -> (PathBuf, Value) {
    let scene = desk.file("scene.toml", workshop().scene(further));
    let result = desk.path("result.h5");
    let answer = succeeds(&["run", argument(&scene), "-o", argument(&result), "--json"]);
    (result, answer.json())
}

/// Largest distance of two curves.
pub fn largest_difference(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter()
        .zip(b)
        .fold(0.0, |worst, (x, y)| (x - y).abs().max(worst))
}

/// A grid of points of a flank, as a machine lists them.
pub fn points_of_flank(flank: &Flank, size: [usize; 2]) -> String {
    let blank = &flank.blank;
    let mut text = "sector,height,x_mm,y_mm,z_mm,nx,ny,nz\n".to_owned();
    for i in 0..size[0] {
        let cone = blank.inner_cone_m() + blank.face_width_m * i as f64 / (size[0] - 1) as f64;
        let bottom = flank.place(&flank.bottom(cone).unwrap().point.r)[1];
        for k in 0..size[1] {
            let share = k as f64 / (size[1] - 1) as f64;
            let height = bottom + (blank.addendum_m(cone) - bottom) * share;
            let p = flank.locate(cone, height).unwrap().point;
            let place: Vec<String> = (1e3 * p.r).iter().map(|x| format!("{x:.4}")).collect();
            let normal: Vec<String> = p.n.iter().map(|x| format!("{x:.6}")).collect();
            let [place, normal] = [place, normal].map(|list| list.join(","));
            text.push_str(&format!("{},{},{place},{normal}\n", i + 1, k + 1));
        }
    }
    text
}
