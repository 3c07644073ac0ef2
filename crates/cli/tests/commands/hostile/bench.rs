//! A folder with a file of each kind, as all commands read them; the same with names that steer a terminal.

use crate::common::{Answer, ends, program};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;

/// Modules that the Python children of the program import.
const TRAPS: [&str; 15] = [
    "numpy",
    "scipy",
    "gmsh",
    "meshio",
    "h5py",
    "pyuff",
    "dask",
    "distributed",
    "gearmesh",
    "json",
    "os",
    "site",
    "sitecustomize",
    "usercustomize",
    "socket",
];

/// The file that a sprung trap leaves.
const SPRUNG: &str = "sprung";

/// A command that takes longer does not end.
const FOREVER: Duration = Duration::from_secs(60);

/// What a terminal obeys: clear the screen, title, bell, begin of line, control of eight bits, turned reading.
pub const STEERING: &str = "\u{1b}[2J\u{1b}]0;x\u{7}\r\u{9b}\u{202e}";

/// What texts of TOML files may hold, where control characters are refused: what turns and hides letters.
const TURNING: &str = "\u{202e}\u{200b}";

/// Names of the files and parts of a bench.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Names {
    /// Ordinary ones.
    Plain,
    /// With characters that steer a terminal wherever a name is free.
    Steering,
}

/// The folder.
#[derive(Debug)]
pub struct Bench {
    folder: tempfile::TempDir,
    names: Names,
}

impl Bench {
    /// Text files, and what the program makes of them; traps among them.
    pub fn new(names: Names) -> Self {
        let bench = Self {
            folder: tempfile::tempdir().unwrap(),
            names,
        };
        for name in TRAPS {
            let mark = bench.folder().join(SPRUNG);
            let text = format!(
                "open({:?}, 'a').write({name:?})\nraise SystemExit(3)\n",
                mark.to_str().unwrap()
            );
            std::fs::write(bench.folder().join(format!("{name}.py")), text).unwrap();
        }
        for (name, text) in bench.texts() {
            bench.write(name, text.as_bytes());
        }
        let record = bench.path("record");
        std::fs::create_dir(&record).unwrap();
        let label = bench.label();
        let head = toml_text(&format!("title{label}"));
        let text = format!(
            "title = {head}\nkind = \"measured\"\nsource = {head}\nangle_origin = \"any\"\n[columns]\n{} = {head}\n",
            toml_text("strain_root_ustrain_50Nm")
        );
        std::fs::write(record.join("record.toml"), text).unwrap();
        let lines: String = (0..72)
            .map(|k| format!("{},{},{}\n", 5 * k, k % 4, k % 3))
            .collect();
        let data = format!("angle_deg,te_um_50Nm,strain_root_ustrain_50Nm\n{lines}");
        std::fs::write(record.join("data.csv"), data).unwrap();
        bench.archive("box.rexsz", "box.rexs", "model");
        bench.archive("two.rexsz", "box.rexs", "a.rexs b");
        for words in [
            "reduce gear.toml -o gear.h5 --no-error-estimate",
            "run pair.toml -o pair.h5",
            "run wheel.toml -o wheel.h5",
            "export pair.h5 -o curves.uff",
        ] {
            let answer = bench.run(words);
            assert_eq!(answer.code, Some(0), "{words}: {answer:#?}");
        }
        if names == Names::Steering {
            // The exporter writes ASCII; others do not.
            let path = bench.path("curves.uff");
            let bytes = std::fs::read(&path).unwrap();
            let text = String::from_utf8(bytes).unwrap();
            std::fs::write(&path, text.replace("te_m ", "t\u{1b}\u{7}")).unwrap();
        }
        bench
    }

    /// The folder.
    pub fn folder(&self) -> &Path {
        self.folder.path()
    }

    fn steering(&self) -> &'static str {
        match self.names {
            Names::Plain => "",
            Names::Steering => STEERING,
        }
    }

    /// The end of a part's name.
    fn label(&self) -> &'static str {
        match self.names {
            Names::Plain => "",
            Names::Steering => TURNING,
        }
    }

    /// A file by its plain name.
    pub fn path(&self, name: &str) -> PathBuf {
        self.folder().join(self.renamed(name))
    }

    /// The name that a file has here; some are named in TOML files.
    fn renamed(&self, name: &str) -> String {
        let is_named = ["gear.h5", "wheel.toml"].contains(&name);
        let steering = if is_named {
            self.label()
        } else {
            self.steering()
        };
        match name.rsplit_once('.') {
            Some((stem, ending)) => format!("{stem}{steering}.{ending}"),
            None => format!("{name}{steering}"),
        }
    }

    fn write(&self, name: &str, bytes: &[u8]) {
        std::fs::write(self.path(name), bytes).unwrap();
    }

    /// A command, its words divided by blanks, in this folder, whose modules Python would find.
    pub fn command(&self, words: &str) -> Command {
        let mut words = words.split(' ');
        let command = words.next().map(str::to_owned);
        let words: Vec<String> = (command.into_iter())
            .chain(words.map(|word| self.word(word)))
            .collect();
        let mut command = program(&words);
        command
            .current_dir(self.folder())
            .env("PYTHONPATH", self.folder());
        command
    }

    /// Runs a command; it ends by itself and imports no trap.
    pub fn run(&self, words: &str) -> Answer {
        let answer = ends(self.command(words), FOREVER);
        let sprung = std::fs::read_to_string(self.folder().join(SPRUNG));
        assert!(sprung.is_err(), "{words} imported {sprung:?}");
        answer
    }

    /// A word of a command: names of files as they are here, COLUMN, and BODY.
    fn word(&self, word: &str) -> String {
        let is_file = (word.rsplit_once('.'))
            .is_some_and(|(_, ending)| !ending.is_empty() && ending.parse::<f64>().is_err());
        if is_file || ["record", "out"].contains(&word) {
            return self.renamed(word);
        }
        let column = format!("bodies/wheel{}/angular_velocity_z_rad_per_s", self.label());
        word.replace("COLUMN", &column)
            .replace("BODY", &format!("wheel{}", self.label()))
    }

    /// Zips a file under the names of one or two members.
    fn archive(&self, name: &str, content: &str, members: &str) {
        let members = members
            .split(' ')
            .map(|stem| format!("{stem}{}.rexs", self.steering()));
        let script = "import sys, zipfile\nwith zipfile.ZipFile(sys.argv[1], 'w') as out:\n    for name in sys.argv[3:]: out.write(sys.argv[2], name)\n";
        let python = gearmesh_mesh::python::PythonEnvironment::find().unwrap();
        let status = python
            .command()
            .args(["-c", script])
            .args([self.path(name), self.path(content)])
            .args(members)
            .status();
        assert!(status.unwrap().success());
    }

    /// The text files by their plain names.
    fn texts(&self) -> Vec<(&'static str, String)> {
        let (steering, label) = (self.steering(), self.label());
        let name = |name: &str| toml_text(&format!("{name}{label}"));
        let file = |name: &str| toml_text(&self.renamed(name));
        let root = crate::common::root();
        let shipped =
            |name: &str| std::fs::read_to_string(root.join("fe_models").join(name)).unwrap();
        let gear = crate::common::THIN
            .replace("\"small thin rim\"", &name("thin"))
            .replace("\"tension\"", &name("tension"))
            .replace("\"compression\"", &name("compression"))
            .replace("poisson = 0.3", "poisson = 0.3\ndensity_kg_per_m3 = 7850.0");
        let pair = format!(
            "title = {}\n[pair]\ngear_1 = {model}\ngear_2 = {model}\ncentre_distance_mm = 54.7\n[mesh.model]\nkind = \"hybrid\"\n\
             [run]\ntorques_Nm = [50.0]\npitches = 18\npoints_per_pitch = 4\n[gauges]\ngear_2 = [{}]\n",
            name("pair"),
            name("tension"),
            model = file("gear.h5"),
        );
        let wheel = include_str!("../../../../../tests/support/wheel.toml");
        let wheel = wheel
            .replace("title = \"wheel\"", &format!("title = {}", name("wheel")))
            .replace("\"wheel\"", &name("wheel"))
            .replace("\"axis\"", &name("axis"));
        let column = format!("bodies/wheel{label}/angular_velocity_z_rad_per_s");
        let study = format!(
            "title = {}\nscene = {}\ncolumns = [{}]\n[[parameter]]\nname = {}\nkeys = [\"load.0.torque_Nm\"]\nvalues = [4.0]\n",
            name("study"),
            file("wheel.toml"),
            toml_text(&column),
            name("torque"),
        );
        let optimise = format!(
            "title = {}\nscene = {}\ntrials = 20\n[[variable]]\nname = {}\nkeys = [\"load.0.torque_Nm\"]\nfrom = 1.0\nto = 2.0\n\
             [[objective]]\nname = {}\nterm = [{{ column = {} }}]\n",
            name("optimise"),
            file("wheel.toml"),
            name("torque"),
            name("speed"),
            toml_text(&format!("{column}:largest")),
        );
        let bearing = shipped("bearing_9_balls.toml")
            .replace("\"9 balls of 7.94 mm on 39.32 mm\"", &name("bearing"));
        let bevel = shipped("bevel_20_20.toml").replace(
            "\"Spiral bevel pair 20/20, m 3.5 mm, of seed 001\"",
            &name("bevel"),
        );
        let curves = format!(
            "phi{steering},TE{steering}\ndeg,um\n{}",
            (0..40)
                .map(|k| format!("{},{}\n", 10 * k, k % 3))
                .collect::<String>()
        )
        // A line break ends the head.
        .replace('\r', "");
        // XML has no control characters.
        let rexs =
            shipped("gearbox_three_stage.rexs").replace("name=\"", &format!("name=\"{label}"));
        let json = format!("kind{steering}");
        let rexsj = serde_json::json!({"model": {"version": "1.7", "relations": [
            {"id": 1, "type": json, "refs": [{"id": 1, "role": json}, {"id": 2, "role": json}]}],
            "components": [{"id": 1, "type": "gear_unit", "name": json, "attributes": [{"id": json, "string": json}]},
                {"id": 2, "type": json, "name": json, "attributes": []}]}});
        vec![
            ("gear.toml", gear),
            ("pair.toml", pair),
            ("wheel.toml", wheel),
            ("study.toml", study),
            ("optimise.toml", optimise),
            ("bearing.toml", bearing),
            ("bevel.toml", bevel),
            ("sn.toml", shipped("sn_example.toml")),
            ("curves.csv", curves),
            ("box.rexs", rexs),
            ("box.rexsj", rexsj.to_string()),
        ]
    }
}

/// A text as TOML writes it, whatever it holds.
pub fn toml_text(text: &str) -> String {
    let escaped = |c: char| match c {
        '"' | '\\' => format!("\\{c}"),
        _ if c.is_control() => format!("\\u{:04X}", u32::from(c)),
        _ => c.to_string(),
    };
    format!("\"{}\"", text.chars().map(escaped).collect::<String>())
}
