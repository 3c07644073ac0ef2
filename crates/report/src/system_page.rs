//! Sections of the report of a multibody scene.
//!
//! | sections | file |
//! | --- | --- |
//! | key figures, a line a channel | `at_a_glance.rs` |
//! | line loads over the face, tilt of the axes at rest | `across_the_face.rs` |
//! | which columns, in which charts, with which units | `columns.rs` |
//! | time histories, spectra, energy | `transient.rs` |
//! | waterfalls of runs whose speed changes | `run_up.rs` |
//! | balls and cages of bearings whose balls move | `bearings.rs` |
//! | pairs of teeth: forces, contact pattern, path | `tooth_pairs.rs` |
//! | orbits of gears, lines of shafts and cages | `orbits.rs` |
//! | curves over the speed | `sweep.rs` |
//! | planetary sets: shares of the planets, a picture | `sets.rs` |
//! | the stages, their loads beside what follows from their teeth | `stages.rs` |
//! | what friction takes, part by part | `losses.rs` |
//! | equilibria, natural frequencies | `equilibria.rs`, `eigen.rs` |
//! | what was judged after the run | `../ratings.rs` |

mod across_the_face;
mod at_a_glance;
mod bearings;
mod columns;
mod eigen;
mod equilibria;
mod losses;
mod orbits;
mod run_up;
mod sets;
mod stages;
mod sweep;
mod tooth_pairs;
mod transient;

use gearmesh_model::FileError;
use gearmesh_scene::system_run::{MeshPassing, ResultKind, SystemResult, is_prominent};

use self::columns::turning;
use crate::page::{KeyFigures, Section, Text};
use crate::ratings;
use crate::short;

/// All sections of a result.
pub(crate) fn sections(
    r: &SystemResult,
    stress: Option<Section>,
) -> Result<Vec<Section>, FileError> {
    let passings = r.mesh_passings()?;
    let mut sections = vec![overview(r, &passings)?];
    sections.extend(sets::section(r)?);
    match r.kind {
        ResultKind::Transient => {
            sections.push(transient::histories(r)?);
            sections.extend(transient::spectra(r, &passings)?);
            sections.extend(run_up::section(r, &passings)?);
            sections.extend(tooth_pairs::sections(r, &passings)?);
            sections.extend(orbits::section(r, &passings)?);
            sections.extend(bearings::sections(r)?);
            if let Some(chart) = orbits::cage_spectrum(r, &passings)? {
                let heading = format!("{}: speeds of the cages", r.head.title);
                sections.push(Section::new(heading).push(chart));
            }
            sections.push(transient::accuracy(r)?);
        }
        ResultKind::SpeedSweep => {
            if let Some(sweep) = &r.sweep {
                sections.push(sweep::sweep_section(r, sweep));
            }
        }
        ResultKind::Static => {
            sections.extend(across_the_face::section(r)?);
            sections.extend(equilibria::equilibria(r)?);
        }
        ResultKind::Eigen => sections.push(eigen::eigen(r)),
    }
    sections.extend(losses::section(r)?);
    sections.extend(stress);
    sections.extend(ratings::section(&r.head.title, &r.ratings));
    sections.push(provenance(r));
    Ok(sections)
}

fn overview(r: &SystemResult, passings: &[MeshPassing]) -> Result<Section, FileError> {
    let mut tables = Vec::new();
    let mut figures = match (&r.sweep, r.kind) {
        (Some(sweep), _) => sweep::key_figures(sweep),
        (None, ResultKind::Transient | ResultKind::Static) => {
            let found = r.summaries(is_prominent)?;
            let figures = at_a_glance::key_figures(r, &found);
            tables = at_a_glance::tables(r, found, passings);
            figures
        }
        _ => KeyFigures::new(),
    };
    for mesh in turning(passings) {
        let label = format!("{}: mesh frequency", mesh.mesh.name);
        figures = figures.figure(label, short(mesh.frequency_hz), "Hz");
    }
    if r.record.is_some() {
        let error = r.relative_energy_error().unwrap_or(f64::NAN);
        figures = figures.figure("energy error", format!("{error:.1e}"), "of the work done");
    }
    let mut section = Section::new(r.head.title.clone());
    if let Some(problem) = r.problem() {
        section = section.push(Text::note(problem));
    }
    if !figures.is_empty() {
        section = section.push(figures);
    }
    let warnings = r.warnings()?.into_iter();
    section = section.push_all(warnings.map(|text| Text::note(format!("Warning: {text}"))));
    section = section.push_all(stages::table(r)?.into_iter().chain(tables));
    let passings = passings.iter();
    Ok(section.push_all(passings.map(|passing| Text::paragraph(passing.in_words()))))
}

/// What was computed: assumptions, input files, the scene.
fn provenance(r: &SystemResult) -> Section {
    let mut section = Section::new(format!("{}: scene", r.head.title)).push(Text::paragraph(
        format!("gearmesh {}, computed {}.", r.version, r.created_utc),
    ));
    if !r.head.notes.is_empty() {
        let text = "What was assumed, and what follows from the scene:";
        section = section.push(Text::paragraph(text));
        section = section.push(Text::list(&r.head.notes));
    }
    if !r.head.inputs.is_empty() {
        section = section.push(Text::preformatted(r.head.inputs.join("\n")));
    }
    section.push(Text::preformatted(r.head.scene_toml.clone()))
}
