//! Sections of the report of a multibody scene.
//!
//! | sections | file |
//! | --- | --- |
//! | which columns, in which charts, with which units | `columns.rs` |
//! | time histories, spectra, energy | `transient.rs` |
//! | curves over the speed | `sweep.rs` |
//! | equilibria, natural frequencies | `equilibria.rs`, `eigen.rs` |
//! | what was judged after the run | `../ratings.rs` |

mod columns;
mod eigen;
mod equilibria;
mod sweep;
mod transient;

use gearmesh_model::FileError;
use gearmesh_scene::system_run::{MeshPassing, SystemResult};

use self::columns::mesh_frequencies;
use crate::page::{Section, Text};
use crate::ratings;

/// All sections of a result.
pub(crate) fn sections(r: &SystemResult) -> Result<Vec<Section>, FileError> {
    let mut sections = vec![overview(r)?];
    match &r.kind[..] {
        "transient" => {
            sections.push(transient::histories(r)?);
            sections.extend(transient::spectra(r)?);
            sections.push(transient::accuracy(r)?);
        }
        "speed-sweep" => {
            if let Some(sweep) = &r.sweep {
                sections.push(sweep::sweep_section(r, sweep));
            }
        }
        "static" => sections.push(equilibria::equilibria(r)?),
        _ => sections.push(eigen::eigen(r)),
    }
    sections.extend(ratings::section(&r.head.title, &r.ratings));
    sections.push(provenance(r));
    Ok(sections)
}

fn overview(r: &SystemResult) -> Result<Section, FileError> {
    let mut figures = match (&r.sweep, &r.kind[..]) {
        (Some(sweep), _) => sweep::key_figures(sweep),
        (None, "static") => equilibria::key_figures(r)?,
        _ => transient::key_figures(r),
    };
    for (name, hz) in mesh_frequencies(r)? {
        figures = figures.figure(format!("mesh frequency {name}"), format!("{hz:.3}"), "Hz");
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
    if r.kind == "transient" {
        for table in transient::columns_tables(r)? {
            if !table.is_empty() {
                section = section.push(table);
            }
        }
    }
    let passings = r.mesh_passings()?;
    if !passings.is_empty() {
        let lines: Vec<String> = passings.iter().map(MeshPassing::in_words).collect();
        section = section.push(Text::preformatted(lines.join("\n")));
    }
    Ok(section)
}

/// What was computed: assumptions, input files, the scene.
fn provenance(r: &SystemResult) -> Section {
    let mut section = Section::new(format!("{}: scene", r.head.title)).push(Text::paragraph(
        format!("gearmesh {}, computed {}.", r.version, r.created_utc),
    ));
    if !r.head.notes.is_empty() {
        let text = "What was assumed, and what follows from the scene:";
        section = section.push(Text::paragraph(text));
        section = section.push(Text::preformatted(r.head.notes.join("\n")));
    }
    if !r.head.inputs.is_empty() {
        section = section.push(Text::preformatted(r.head.inputs.join("\n")));
    }
    section.push(Text::preformatted(r.head.scene_toml.clone()))
}
