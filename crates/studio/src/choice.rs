//! What can be opened in a folder, and a multibody scene that has not been run.

use std::path::{Path, PathBuf};

use gearmesh_operations::Watch;
use gearmesh_operations::run::{RunHow, run_system};
use gearmesh_scene::system::SystemScene;
use gearmesh_scene::{ResultFile, SceneFile};
use serde::Deserialize;
use serde_json::{Value, json};

use crate::problem::Problem;

/// Files of a folder that are looked at.
const MOST_FILES: usize = 500;

/// A file that can be opened.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Choice {
    path: PathBuf,
    title: String,
    what: &'static str,
}

/// A folder whose scenes and results can be opened.
#[derive(Debug)]
pub struct FolderSession {
    folder: PathBuf,
    choices: Vec<Choice>,
}

/// Which of them.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Chosen {
    number: usize,
}

impl FolderSession {
    /// Looks at the files of a folder; those that are neither scenes nor results are left out.
    ///
    /// # Errors
    /// [`Problem::Input`] for a folder that cannot be read, and for one without scenes and results.
    pub fn new(folder: &Path) -> Result<Self, Problem> {
        let shown = folder.display();
        let unread = |error| Problem::Input(format!("{shown}: {error}"));
        let mut files = Vec::new();
        for entry in std::fs::read_dir(folder).map_err(unread)? {
            files.push(entry.map_err(unread)?.path());
        }
        files.sort();
        let choices: Vec<Choice> = files
            .into_iter()
            .filter(|path| path.is_file())
            .take(MOST_FILES)
            .filter_map(choice)
            .collect();
        if choices.is_empty() {
            return Err(Problem::Input(format!(
                "{shown}: has neither scenes (.toml) nor results (.h5); `gearmesh studio` without a file begins something new"
            )));
        }
        Ok(Self {
            folder: folder.to_owned(),
            choices,
        })
    }

    /// The files, for the page.
    pub fn description(&self) -> Value {
        let name = |path: &Path| {
            path.file_name()
                .map(|name| name.to_string_lossy().into_owned())
        };
        let files = self.choices.iter();
        let files =
            files.map(|one| json!({"name": name(&one.path), "title": one.title, "what": one.what}));
        json!({"folder": self.folder.display().to_string(), "files": files.collect::<Vec<_>>()})
    }

    /// The file of a number.
    ///
    /// # Errors
    /// [`Problem::Input`] for a number that none has.
    pub fn chosen(&self, chosen: &Chosen) -> Result<&Path, Problem> {
        let found = self.choices.get(chosen.number);
        let problem = || {
            format!(
                "found {}, allowed are 0 to {}",
                chosen.number,
                self.choices.len() - 1
            )
        };
        Ok(&found.ok_or_else(|| Problem::Input(problem()))?.path)
    }
}

/// What a file is; none where it is neither scene nor result.
fn choice(path: PathBuf) -> Option<Choice> {
    let (title, what) = match path.extension()?.to_str()? {
        "toml" => {
            let scene = SceneFile::read(&path).ok()?;
            let what = match &scene {
                SceneFile::Pair(_) => "pair",
                SceneFile::Bevel(_) => "bevel pair",
                SceneFile::System(_) => "multibody scene",
            };
            (scene.title().to_owned(), what)
        }
        "h5" => match ResultFile::open(&path).ok()? {
            ResultFile::Pair(result) => (result.source.title, "result of a pair"),
            ResultFile::System(result) => (result.head.title, "result of a multibody scene"),
        },
        _ => return None,
    };
    Some(Choice { path, title, what })
}

/// A multibody scene whose result does not exist yet.
#[derive(Debug)]
pub struct SceneSession {
    file: PathBuf,
    scene: SystemScene,
}

impl SceneSession {
    /// The scene of a file.
    pub fn new(file: &Path, scene: SystemScene) -> Self {
        let file = file.to_owned();
        Self { file, scene }
    }

    /// Title, kind of run, where the result goes.
    pub fn description(&self) -> Value {
        json!({
            "title": self.scene.title,
            "file": self.file.display().to_string(),
            "run": self.scene.run.kind().name(),
            "result": self.output().display().to_string(),
        })
    }

    /// Beside the scene, under its name and a number that no file has.
    fn output(&self) -> PathBuf {
        let stem = self.file.file_stem().unwrap_or_default().to_string_lossy();
        let numbered = |number: usize| match number {
            1 => self.file.with_file_name(format!("{stem}.h5")),
            number => self.file.with_file_name(format!("{stem}-{number}.h5")),
        };
        let mut all = (1..).map(numbered);
        all.find(|path| !path.exists())
            .unwrap_or_else(|| numbered(1))
    }

    /// Runs it; the path of its result.
    ///
    /// # Errors
    /// [`Problem`] for what is wrong with it, and once `watch` stops it.
    pub fn run(&self, watch: &Watch<'_>) -> Result<PathBuf, Problem> {
        let output = self.output();
        let how = RunHow {
            output: Some(&output),
            ..RunHow::default()
        };
        run_system(self.scene.clone().load()?, &how, watch)?;
        Ok(output)
    }
}
