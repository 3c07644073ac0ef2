//! `cargo xtask accuracy-cost elements`: error and cost of every element, mesh size and local term, in one table and
//! one plot.
//!
//! Each case is the program itself, as a user runs it: `reduce`, then `compliance` at seven radii and two half widths
//! for each local term, then a short `run` of the gear against itself. What a program does not know (an element of a
//! later version) is a row that says so.
//!
//! The error in plane strain is that against `reference/plane_gear`, computed by other software. The error in three
//! dimensions is that against the same figures plus what the third dimension changes: deflection of the whole gear less
//! that in plane strain, both by the program on the meshes of [`REFERENCE_MM`] and extrapolated. The near field of the
//! load is the same in both and cancels.

use std::fs;
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Instant;

use serde_json::{Value, json};

use super::elements_page::{self, Case, Cost, Outcome, Reference, Space};
use super::host::Host;
use super::{Bench, Options, figures, write_whole};
use crate::console::{readable, say};
use crate::error::XtaskError;
use crate::workspace::Workspace;

/// Elements by the name that a gear file gives them.
const ELEMENTS: [&str; 3] = ["hex8", "hex8-incompatible", "hex20"];
/// Element lengths on the flank \[mm\]; all others are in proportion to it.
const FLANK_MM: [f64; 5] = [1.5, 1.2, 0.8, 0.55, 0.4];
/// The finest in three dimensions \[mm\]. Quadratic elements stop earlier: from 0.8 to 0.55 mm they went from 0.06 to
/// 0.05 %, in 23 GB.
const FINEST_WHOLE_MM: f64 = 0.55;
const FINEST_WHOLE_QUADRATIC_MM: f64 = 0.8;
/// Pitches of the runs that time a position: enough for what a run does once, some 50 ms, to fade.
const PITCHES: u32 = 500;
/// Flank element lengths \[mm\] of the two meshes from which the reference in three dimensions is extrapolated.
const REFERENCE_MM: [f64; 2] = [0.75, 0.5];
const REFERENCE_ELEMENT: &str = "hex8-incompatible";
/// Order of the error in a deflection, against the element length.
const ORDER: i32 = 2;
/// Local terms by the name that scene and command line give them.
const LOCALS: [&str; 3] = ["none", "weber-banaschek", "calibrated"];
const LINE_LOAD_N_PER_MM: &str = "100";
const FACE_WIDTH_MM: f64 = 20.0;

/// Runs all cases, writes the page and the plot.
///
/// # Errors
/// [`XtaskError`] where the program does not build, the reference cannot be made or a file cannot be written; a case
/// that fails is a row of the page.
pub fn elements(workspace: &Workspace, options: &Options) -> Result<ExitCode, XtaskError> {
    let start = Instant::now();
    let bench = Bench::prepare(workspace, options)?;
    let host = Host::find(workspace.root());
    let study = Study::new(&bench)?;
    let reference = study
        .reference()
        .map_err(|reason| failed("making the reference in three dimensions", reason))?;
    let sizes = if options.quick {
        &FLANK_MM[..2]
    } else {
        &FLANK_MM
    };
    let mut cases = Vec::new();
    for space in [Space::PlaneStrain, Space::Whole] {
        for element in ELEMENTS {
            let finest_mm = match space {
                Space::PlaneStrain => 0.0,
                Space::Whole if element == "hex20" => FINEST_WHOLE_QUADRATIC_MM,
                Space::Whole => FINEST_WHOLE_MM,
            };
            for &flank_mm in sizes.iter().filter(|length| **length >= finest_mm) {
                let outcome = study.case(space, element, flank_mm, reference.of(space));
                match &outcome {
                    Ok(found) => say(&format!(
                        "{} {element} {flank_mm} mm: {:.1} s, {} DOF",
                        space.name(),
                        found.cost.wall_s,
                        found.cost.dofs
                    )),
                    Err(reason) => say(&format!(
                        "{} {element} {flank_mm} mm: {reason}",
                        space.name()
                    )),
                }
                cases.push(Case {
                    space,
                    element,
                    flank_mm,
                    outcome,
                });
            }
        }
    }
    let folder = workspace.root().join(if options.quick {
        "out"
    } else {
        "docs/benchmarks"
    });
    let name = if options.quick {
        "elements-quick"
    } else {
        "elements"
    };
    fs::create_dir_all(&folder)
        .map_err(XtaskError::io(|| format!("making {}", folder.display())))?;
    let picture = folder.join(format!("{name}.svg"));
    study
        .plot(&cases, &picture)
        .map_err(|reason| failed("drawing the plot", reason))?;
    let page = folder.join(format!("{name}.md"));
    let text = elements_page::page(
        &host,
        &bench.profile,
        &reference,
        &cases,
        &format!("{name}.svg"),
    );
    write_whole(&page, &text)?;
    say(&format!(
        "\nwritten in {}: {}",
        readable(start.elapsed()),
        page.display()
    ));
    Ok(ExitCode::SUCCESS)
}

fn failed(action: &str, reason: String) -> XtaskError {
    XtaskError::Io {
        action: action.into(),
        source: std::io::Error::other(reason),
    }
}

/// The gear of `reference/plane_gear` with a face width, right flanks loaded.
fn gear_text(space: Space, element: &str, flank_mm: f64) -> String {
    // Defaults for the module of 3 mm: flank 0.9, body 3.6 mm, axial a tenth of the width; fillets of 0.24 mm, the
    // default of quadratic elements, for all: no strain is read.
    let factor = flank_mm / 0.9;
    let space_keys = match space {
        Space::PlaneStrain => "plane_strain = true".to_owned(),
        Space::Whole => format!("axial_mm = {:.4}", factor * FACE_WIDTH_MM / 10.0),
    };
    format!(
        "name = \"accuracy\"\n[tooth]\nteeth = 50\nmodule_mm = 3.0\nface_width_mm = {FACE_WIDTH_MM}\n\
         [blank]\nkind = \"solid\"\nbore_diameter_mm = 60.0\n[material]\nyoung_GPa = 206.0\npoisson = 0.3\n\
         [mesh]\nelement = \"{element}\"\n{space_keys}\nflank_mm = {flank_mm}\nfillet_mm = {:.4}\nbody_mm = {:.4}\n\
         [reduction]\nflanks = [\"right\"]\n",
        factor * 0.24,
        factor * 3.6
    )
}

fn scene_text(model: &str, local: &str) -> String {
    format!(
        "title = \"accuracy\"\n[pair]\ngear_1 = \"{model}\"\ngear_2 = \"{model}\"\ncentre_distance_mm = 150.05\n\
         [mesh]\nmodel.kind = \"hybrid\"\nmodel.local = \"{local}\"\nteeth.path = \"line-of-action\"\n\
         [run]\ntorques_Nm = [170.0, 340.0]\npitches = {PITCHES}\npoints_per_pitch = 60\n"
    )
}

/// What all cases share.
struct Study<'a> {
    bench: &'a Bench,
    model: PathBuf,
    radii_mm: Vec<f64>,
    half_widths_mm: Vec<f64>,
    /// In plane strain \[µm\], `[half width][radius]`.
    plane_um: Vec<Vec<f64>>,
}

impl<'a> Study<'a> {
    fn new(bench: &'a Bench) -> Result<Self, XtaskError> {
        let path = bench.root.join("reference/plane_gear/data.csv");
        let reading = || format!("reading {}", path.display());
        let text = fs::read_to_string(&path).map_err(XtaskError::io(reading))?;
        let (half_widths_mm, rows) = elements_page::read_plane_gear(&text)
            .ok_or_else(|| failed(&reading(), "not the table expected".into()))?;
        Ok(Self {
            bench,
            model: bench.scratch.join("accuracy.h5"),
            radii_mm: rows.iter().map(|row| row.0).collect(),
            plane_um: (0..half_widths_mm.len())
                .map(|k| rows.iter().map(|row| row.1[k]).collect())
                .collect(),
            half_widths_mm,
        })
    }

    /// What the third dimension changes, from two meshes.
    fn reference(&self) -> Result<Reference, String> {
        let mut changes: Vec<Vec<f64>> = Vec::new();
        for flank_mm in REFERENCE_MM {
            say(&format!(
                "== reference in three dimensions, flank mesh {flank_mm} mm"
            ));
            let mut of = Vec::new();
            for space in [Space::PlaneStrain, Space::Whole] {
                self.reduce(space, REFERENCE_ELEMENT, flank_mm)?;
                of.push(self.deflections_um("none", self.half_widths_mm[0])?);
            }
            changes.push(of[1].iter().zip(&of[0]).map(|(w, p)| w - p).collect());
        }
        let gain = 1.0 / ((REFERENCE_MM[0] / REFERENCE_MM[1]).powi(ORDER) - 1.0);
        let steps: Vec<f64> = changes[0]
            .iter()
            .zip(&changes[1])
            .map(|(c, f)| gain * (f - c))
            .collect();
        let change: Vec<f64> = changes[1].iter().zip(&steps).map(|(f, s)| f + s).collect();
        let whole_um: Vec<Vec<f64>> = (self.plane_um.iter())
            .map(|plane| plane.iter().zip(&change).map(|(p, c)| p + c).collect())
            .collect();
        let relative = |values: &[f64]| {
            values
                .iter()
                .zip(&whole_um[0])
                .map(|(v, w)| v / w)
                .collect()
        };
        Ok(Reference {
            radii_mm: self.radii_mm.clone(),
            change: relative(&change),
            step: relative(&steps),
            plane_um: self.plane_um.clone(),
            whole_um: whole_um.clone(),
        })
    }

    /// Writes the gear and reduces it.
    fn reduce(&self, space: Space, element: &str, flank_mm: f64) -> Result<Cost, String> {
        let gear = self.bench.scratch.join("accuracy.toml");
        fs::write(&gear, gear_text(space, element, flank_mm)).map_err(|error| error.to_string())?;
        let mut command = self.bench.gearmesh("reduce", &gear, &self.model);
        command.arg("--no-error-estimate");
        let run = self.bench.measured(&mut command)?;
        let told: Value =
            serde_json::from_str(run.stdout.trim()).map_err(|error| error.to_string())?;
        let measured = figures(&run);
        Ok(Cost {
            wall_s: measured.wall_s,
            peak_bytes: measured.peak_bytes,
            dofs: told["dofs"]
                .as_u64()
                .ok_or("no number of degrees of freedom")?,
        })
    }

    /// Mean over the width \[µm\] at the seven radii.
    fn deflections_um(&self, local: &str, half_width_mm: f64) -> Result<Vec<f64>, String> {
        let radii: Vec<String> = self.radii_mm.iter().map(f64::to_string).collect();
        let mut command = std::process::Command::new(&self.bench.program);
        command.arg("compliance").arg(&self.model).args([
            "--tooth",
            "0",
            "--line-load-N-per-mm",
            LINE_LOAD_N_PER_MM,
            "--half-width-mm",
            &half_width_mm.to_string(),
            "--radius-mm",
            &radii.join(","),
            "--local",
            local,
            "--json",
        ]);
        let (_, told) = self.bench.run(&mut command)?;
        let rows = told["rows"].as_array().ok_or("no rows of deflections")?;
        rows.iter()
            .map(|row| {
                row["total_m"]
                    .as_f64()
                    .map(|m| 1e6 * m)
                    .ok_or_else(|| "no deflection".into())
            })
            .collect()
    }

    /// Wall time of a contact position \[s\] of the gear with itself.
    fn position_s(&self, local: &str) -> Result<f64, String> {
        let scene = self.bench.scratch.join("accuracy-scene.toml");
        fs::write(&scene, scene_text("accuracy.h5", local)).map_err(|error| error.to_string())?;
        let result = self.bench.scratch.join("accuracy-result.h5");
        let (_, told) = self
            .bench
            .run(&mut self.bench.gearmesh("run", &scene, &result))?;
        let contact_s = told["seconds"][0]
            .as_f64()
            .ok_or("no time of the contact")?;
        // Torques × pitches × points of `scene_text`.
        Ok(contact_s / (2.0 * f64::from(PITCHES) * 60.0))
    }

    fn case(
        &self,
        space: Space,
        element: &str,
        flank_mm: f64,
        expected_um: &[Vec<f64>],
    ) -> Result<Outcome, String> {
        let cost = self.reduce(space, element, flank_mm)?;
        let mut locals = Vec::new();
        for local in LOCALS {
            let mut errors = Vec::new();
            for (&half_width_mm, expected) in self.half_widths_mm.iter().zip(expected_um) {
                let found = self.deflections_um(local, half_width_mm)?;
                errors.extend(found.iter().zip(expected).map(|(f, e)| f / e - 1.0));
            }
            locals.push(elements_page::LocalTerm {
                name: local,
                errors,
                position_s: self.position_s(local)?,
            });
        }
        Ok(Outcome { cost, locals })
    }

    fn plot(&self, cases: &[Case], picture: &std::path::Path) -> Result<(), String> {
        let points: Vec<Value> = cases
            .iter()
            .filter_map(|case| Some((case, case.outcome.as_ref().ok()?)))
            .flat_map(|(case, outcome)| {
                outcome.locals.iter().map(move |local| {
                    json!({"space": case.space.name(), "element": case.element, "flank_mm": case.flank_mm,
                           "local": local.name, "wall_s": outcome.cost.wall_s, "worst": local.worst()})
                })
            })
            .collect();
        let data = self.bench.scratch.join("elements-points.json");
        fs::write(&data, Value::from(points).to_string()).map_err(|error| error.to_string())?;
        let mut command = self.bench.python_script("elements_plot.py");
        command.arg(&data).arg(picture);
        self.bench.measured(&mut command).map(|_| ())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn plane_strain_has_no_axial_length() {
        let plane = gear_text(Space::PlaneStrain, "hex8", 0.9);
        assert!(plane.contains("plane_strain = true") && !plane.contains("axial_mm"));
        let whole = gear_text(Space::Whole, "hex20", 0.45);
        assert!(whole.contains("element = \"hex20\"\naxial_mm = 1.0000\nflank_mm = 0.45\nfillet_mm = 0.1200\nbody_mm = 1.8000"));
    }
}
