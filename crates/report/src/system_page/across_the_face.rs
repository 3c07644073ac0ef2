//! Meshes at rest: how the load lies across the face, and how bodies, shafts and bearings let the axes tilt.

use gearmesh_geometry::Flank;
use gearmesh_model::FileError;
use gearmesh_scene::system_run::{MeshRecord, SystemResult};

use crate::page::{Align, Axis, PointSeries, ScatterChart, Section, Table, Text};
use crate::short;

/// At the last equilibrium; none where no mesh has slices or places of both bodies.
pub(super) fn section(r: &SystemResult) -> Result<Option<Section>, FileError> {
    let Some(row) = r.rows.rows().checked_sub(1) else {
        return Ok(None);
    };
    let mut chart = ScatterChart::new(
        "Line load of each slice, the largest among the pairs of teeth that touch there",
        Axis::new("place across the face, along z of gear 1", "%"),
        Axis::new("line load", "N/mm"),
    );
    let mut table = Table::new("Load across the face and tilt of the axes")
        .columns(Align::Left, ["mesh", "flanks"])
        .column("largest line load N/mm", Align::Right)
        .column("K_Hbeta", Align::Right)
        .column("tilt in the plane of the axes µm/mm", Align::Right)
        .column("across it, opens the loaded flanks µm/mm", Align::Right);
    let mut is_drawn = false;
    for mesh in &r.head.meshes {
        let loads = line_loads(r, &mesh.name, row)?;
        let flank = r.loaded_flank(&mesh.name, row)?;
        let tilts = tilts(r, mesh, row, flank)?;
        let largest = loads.iter().copied().fold(0.0, f64::max);
        if loads.len() > 1 && largest > 0.0 {
            let width = 100.0 / loads.len() as f64;
            let points = loads.iter().enumerate();
            let points = points.map(|(k, load)| [width * (k as f64 + 0.5), 1e-3 * load]);
            chart = chart.series(PointSeries::new(mesh.name.clone(), points.collect()).joined());
            is_drawn = true;
        } else if tilts.is_none() {
            continue;
        }
        let mean = loads.iter().sum::<f64>() / loads.len().max(1) as f64;
        let found = |there: bool, words: String| if there { words } else { "none".to_owned() };
        let tilt = |k: usize| tilts.map_or("none".to_owned(), |tilts| short(1e3 * tilts[k]));
        table.push_row([
            mesh.name.clone(),
            match flank {
                Some(Flank::Left) => "left".to_owned(),
                Some(Flank::Right) => "right".to_owned(),
                None => "none".to_owned(),
            },
            found(largest > 0.0, short(1e-3 * largest)),
            found(
                loads.len() > 1 && largest > 0.0,
                format!("{:.3}", largest / mean),
            ),
            tilt(0),
            tilt(1),
        ]);
    }
    if table.is_empty() {
        return Ok(None);
    }
    let words = "K_Hbeta is the largest line load over the mean of the slices. A tilt of 1 µm/mm, which is 1 mrad, moves one end of a face of 20 mm by 20 µm against the other.";
    let mut section = Section::new(format!("{}: load across the face", r.head.title));
    if is_drawn {
        section = section.push(chart);
    }
    Ok(Some(section.push(table).push(Text::paragraph(words))))
}

/// Line loads of the slices of a mesh \[N/m\].
fn line_loads(r: &SystemResult, mesh: &str, row: usize) -> Result<Vec<f64>, FileError> {
    let mut loads = Vec::new();
    for slice in 1.. {
        let name = format!("elements/{mesh}/line_load_slice_{slice}_N_per_m");
        if !r.rows.columns().iter().any(|column| column.name == name) {
            break;
        }
        loads.extend(r.rows.read(&name)?.get(row).copied());
    }
    Ok(loads)
}

/// Inclination and deviation of parallel axes \[rad\]; none of axes that cross, and where nothing is carried.
fn tilts(
    r: &SystemResult,
    mesh: &MeshRecord,
    row: usize,
    flank: Option<Flank>,
) -> Result<Option<[f64; 2]>, FileError> {
    let (Some(flank), []) = (flank, &mesh.flank_corners_m[..]) else {
        return Ok(None);
    };
    let axes = r.mesh_axes(mesh, row, false)?;
    Ok(axes.map(|axes| {
        let found = axes.misalignment(flank);
        [found.inclination_rad, found.deviation_rad]
    }))
}
