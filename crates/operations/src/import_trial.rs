//! What an import ends with: its files are checked as `gearmesh check` does, its scenes run at rest as `gearmesh run`
//! does, and the figures are held against those that follow by the ratios.

use crate::check;
use crate::failure::{Failure, Fault, Result};
use crate::run::{RunHow, run_system};
use crate::scratch::Scratch;
use crate::watch::{Silent, Watch};
use gearmesh_rexs::{Import, Sheet};
use gearmesh_scene::SceneFile;
use gearmesh_scene::system_run::{StageRow, SystemResult};
use serde_json::{Value, json};
use std::path::Path;

/// A scene of more bodies takes its time at rest: it is left to `gearmesh run`.
const MOST_BODIES: usize = 300;

/// Files that are checked, and scenes that are run; the others differ from them in numbers only.
const MOST_FILES: usize = 100;
const MOST_SCENES: usize = 20;

/// Torques that differ by less than this share are the same.
const SAME: f64 = 0.01;

/// Torques \[N m\] and powers \[W\] below this are none.
const NONE: f64 = 1e-6;

/// Place where power goes in or out.
#[derive(Debug)]
pub struct PortRow {
    /// Name of the load or spring.
    pub name: String,
    /// Shaft that it acts on.
    pub shaft: String,
    /// Speed of the shaft \[1/min\].
    pub speed_rpm: f64,
    /// Torque on the shaft \[N m\].
    pub torque_nm: f64,
    /// Power that goes in \[W\]; negative where it comes out.
    pub power_w: f64,
}

/// A scene that was run.
#[derive(Debug)]
pub struct SceneRow {
    /// Its file.
    pub scene: String,
    /// Where power goes in and out.
    pub ports: Vec<PortRow>,
    /// Shaft, speed \[1/min\], largest torque in it \[N m\].
    pub shafts: Vec<(String, f64, f64)>,
    /// Bearing, force across and along the axis \[N\].
    pub bearings: Vec<(String, f64, f64)>,
    /// Mesh, normal force \[N\], largest over mean line load; none where the mesh has no slices.
    pub meshes: Vec<(String, f64, Option<f64>)>,
}

impl SceneRow {
    /// Power that goes in, and that comes out \[W\].
    pub fn power_w(&self) -> [f64; 2] {
        let powers = || self.ports.iter().map(|p| p.power_w);
        [
            powers().filter(|p| *p > 0.0).sum(),
            -powers().filter(|p| *p < 0.0).sum::<f64>(),
        ]
    }
}

/// What came of it.
#[derive(Debug, Default)]
pub struct Trial {
    /// What was run.
    pub scenes: Vec<SceneRow>,
    /// What is wrong with figures of scenes that run.
    pub warnings: Vec<String>,
    /// Files that the program refuses, and why.
    pub refused: Vec<(String, Failure)>,
    /// What was not tried, and why.
    pub notes: Vec<String>,
}

impl Trial {
    /// Checks the files of a folder, all but the scenes and studies where these are not to be run.
    pub fn check(&mut self, made: &Import, folder: &Path, with_scenes: bool) {
        let is_scene = |name: &String| {
            name.ends_with("_study.toml") || made.scenes.iter().any(|scene| scene == name)
        };
        let is_large = made.sheets.iter().any(|sheet| sheet.bodies > MOST_BODIES);
        let names = made.files.iter().map(|f| &f.name);
        let names = names.filter(|n| (with_scenes && !is_large) || !is_scene(n));
        let names: Vec<&String> = names.collect();
        if names.len() > MOST_FILES {
            self.notes.push(format!(
                "{MOST_FILES} of {} files were checked; `gearmesh check FILE` checks the others",
                names.len()
            ));
        }
        for name in names.into_iter().take(MOST_FILES) {
            match check::demand(&folder.join(name)) {
                Ok(slips) => self.warnings.extend(slips.iter().map(ToString::to_string)),
                Err(cause) if is_scene(name) || made.gears.contains(name) => {
                    self.refused.push((name.clone(), cause));
                }
                // No scene needs it: files of bearings and bevel pairs are for those who want more.
                Err(cause) => self.notes.push(format!("not usable: {}", cause.message)),
            }
        }
    }

    /// Runs the scenes of a folder that it has not refused.
    pub fn run(&mut self, made: &Import, folder: &Path, watch: &Watch<'_>) -> Result<()> {
        let scratch = Scratch::new()?;
        if made.sheets.len() > MOST_SCENES {
            self.notes.push(format!(
                "{MOST_SCENES} of {} scenes were run",
                made.sheets.len()
            ));
        }
        for sheet in made.sheets.iter().take(MOST_SCENES) {
            if sheet.bodies > MOST_BODIES {
                self.notes.push(format!(
                    "{}: {} bodies, more than {MOST_BODIES}: neither checked nor run here",
                    sheet.scene, sheet.bodies
                ));
                continue;
            }
            if self.refused.iter().any(|(name, _)| *name == sheet.scene) {
                continue;
            }
            let output = scratch.path().join("rest.h5");
            match at_rest(&folder.join(&sheet.scene), &output, watch)
                .and_then(|r| figures(sheet, &r))
            {
                Ok(row) => {
                    judge(sheet, &row, &mut self.warnings);
                    self.scenes.push(row);
                }
                Err(cause) if cause.fault == Fault::Stopped => return Err(cause),
                Err(cause) => self.refused.push((sheet.scene.clone(), cause)),
            }
        }
        Ok(())
    }

    /// Whether all that was tried works.
    pub fn works(&self, file: &str) -> bool {
        !self.refused.iter().any(|(name, _)| name == file)
    }

    /// For machines.
    pub fn json(&self) -> Value {
        let scenes = self.scenes.iter().map(|row| {
            let [input, output] = row.power_w();
            json!({
                "scene": row.scene,
                "power_in_W": input,
                "power_out_W": output,
                "loads": row.ports.iter().map(|p| json!({
                    "name": p.name, "shaft": p.shaft, "speed_rpm": p.speed_rpm, "torque_Nm": p.torque_nm, "power_W": p.power_w,
                })).collect::<Vec<_>>(),
                "shafts": row.shafts.iter().map(|(name, speed, torque)| json!({
                    "name": name, "speed_rpm": speed, "torque_Nm": torque,
                })).collect::<Vec<_>>(),
                "bearings": row.bearings.iter().map(|(name, radial, axial)| json!({
                    "name": name, "force_radial_N": radial, "force_axial_N": axial,
                })).collect::<Vec<_>>(),
                "meshes": row.meshes.iter().map(|(name, force, k_h_beta)| json!({
                    "name": name, "normal_force_N": force, "k_h_beta": k_h_beta,
                })).collect::<Vec<_>>(),
            })
        });
        json!({
            "scenes": scenes.collect::<Vec<_>>(),
            "refused": self.refused.iter().map(|(name, cause)| json!({ "file": name, "message": cause.message })).collect::<Vec<_>>(),
            "notes": self.notes,
        })
    }
}

/// What a scene comes to at rest; its remarks and warnings are those of its file, which has been judged.
fn at_rest(scene: &Path, output: &Path, watch: &Watch<'_>) -> Result<SystemResult> {
    let SceneFile::System(scene) = SceneFile::read(scene)? else {
        return Err(Failure::work("the scene is none of shafts and bearings"));
    };
    let how = RunHow {
        output: Some(output),
        restart: true,
        ..RunHow::default()
    };
    let unheard = Watch {
        listener: &Silent,
        ..*watch
    };
    run_system(scene.load()?, &how, &unheard)
}

/// Figures of the run; speeds are those of the ratios.
fn figures(sheet: &Sheet, result: &SystemResult) -> Result<SceneRow> {
    let columns = result.rows.columns();
    let read = |column: &str| -> Result<f64> {
        if !columns.iter().any(|c| c.name == column) {
            return Ok(0.0);
        }
        let values = result.rows.read(column).map_err(Failure::work)?;
        Ok(values.last().copied().unwrap_or(0.0))
    };
    let mut row = SceneRow {
        scene: sheet.scene.clone(),
        ports: Vec::new(),
        shafts: Vec::new(),
        bearings: Vec::new(),
        meshes: Vec::new(),
    };
    for port in &sheet.ports {
        let torque_nm = match &port.spring {
            Some(spring) => read(&format!("elements/{spring}/moment_z_Nm"))?,
            None => port.torque_nm,
        };
        row.ports.push(PortRow {
            name: port.name.clone(),
            shaft: port.shaft.clone(),
            speed_rpm: port.speed_rpm,
            torque_nm,
            power_w: torque_nm * port.speed_rpm * std::f64::consts::PI / 30.0,
        });
    }
    for (name, speed_rpm) in &sheet.shafts {
        let loads = row.ports.iter().filter(|p| p.shaft == *name);
        let mut torque_nm = loads.map(|p| p.torque_nm.abs()).fold(0.0, f64::max);
        let beam = format!("elements/{name}_");
        for column in columns {
            let piece = column.name.strip_prefix(&beam);
            let piece = piece.and_then(|rest| rest.strip_suffix("/moment_z_Nm"));
            if piece.is_some_and(|p| p.chars().all(|c| c.is_ascii_digit() || c == '-')) {
                torque_nm = torque_nm.max(read(&column.name)?.abs());
            }
        }
        row.shafts.push((name.clone(), *speed_rpm, torque_nm));
    }
    for name in &sheet.bearings {
        let [radial, axial] = ["force_radial_N", "force_shaft_z_N"];
        row.bearings.push((
            name.clone(),
            read(&format!("elements/{name}/{radial}"))?,
            read(&format!("elements/{name}/{axial}"))?,
        ));
    }
    let stages = result.stages().map_err(Failure::work)?;
    for name in &sheet.meshes {
        let mut force = 0.0;
        for flank in ["left", "right"] {
            force += read(&format!("elements/{name}/normal_force_{flank}_N"))?;
        }
        let of_mesh = |stage: &&StageRow| stage.mesh.name == *name;
        let load = stages
            .iter()
            .flat_map(|s| &s.rows)
            .find(of_mesh)
            .and_then(|s| s.load);
        let k_h_beta = load.and_then(|load| load.k_h_beta);
        row.meshes.push((name.clone(), force, k_h_beta));
    }
    Ok(row)
}

/// Says where the run does not show what follows by the ratios.
fn judge(sheet: &Sheet, row: &SceneRow, warnings: &mut Vec<String>) {
    let torques = row.ports.iter().map(|p| p.torque_nm.abs());
    let largest = torques.fold(0.0, f64::max);
    let scene = &sheet.scene;
    for (port, found) in sheet.ports.iter().zip(&row.ports) {
        let (wanted, got) = (port.torque_nm, found.torque_nm);
        if (wanted - got).abs() > SAME * wanted.abs() + 1e-6 * largest + NONE {
            warnings.push(format!(
                "{scene}: {} has {got:.4} N m when the scene runs, {wanted:.4} N m follow from the file: part of the load does not arrive, or \
                 something else holds the train",
                port.name
            ));
        }
    }
    let [input, output] = row.power_w();
    if (input - output).abs() > SAME * input.max(output) + NONE {
        warnings.push(format!(
            "{scene}: power does not balance: {input:.4} W go in, {output:.4} W come out"
        ));
    }
    if input.max(output) < NONE && !sheet.meshes.is_empty() {
        warnings.push(format!(
            "{scene}: no power goes through its {} gear meshes: all figures of it are those of a gearbox without load",
            sheet.meshes.len()
        ));
    }
    for (name, force, _) in &row.meshes {
        if *force < NONE && input > NONE {
            warnings.push(format!("{scene}: the mesh {name} carries nothing"));
        }
    }
}
