//! Runs whose speed changes: amplitudes over time and frequency, with the mesh frequencies drawn.

use std::f64::consts::TAU;

use gearmesh_model::FileError;
use gearmesh_scene::system_run::{MeshPassing, SystemResult, is_prominent};
use gearmesh_signal::CampbellRow;

use super::columns::{Group, groups, harmonic, turning, varies};
use crate::page::{Axis, MapChart, Section, Text};
use crate::short_number::usual_unit;
use crate::waterfall::waterfall;

/// Share by which the speed of a shaft changes in a run whose waterfalls are drawn.
const CHANGE: f64 = 0.05;

/// Charts of the section.
const CHARTS: usize = 4;

/// Multiples of a mesh frequency that are drawn, and up to which the map goes.
const HARMONICS: usize = 3;
const HIGHEST: f64 = 5.0;

/// Share by which a line of centres may turn, and the frequency still follow from the gear alone.
const STANDS: f64 = 0.01;

/// Mesh frequencies over time: name of the mesh, points of time and frequency.
type MeshLines<'a> = Vec<(&'a str, Vec<[f64; 2]>)>;

/// Waterfalls of the first channels of force elements; none for a run at one speed, and one that is too short.
pub(super) fn section(
    r: &SystemResult,
    passings: &[MeshPassing],
) -> Result<Option<Section>, FileError> {
    let times = r.rows.read("time_s")?;
    let interval_s = r.interval_s()?;
    let is_even = |w: &[f64]| (w[1] - w[0] - interval_s).abs() <= 1e-6 * interval_s;
    if times.len() < 2 || !times.windows(2).all(is_even) {
        return Ok(None);
    }
    let (begin_s, rate_hz) = (times[0], 1.0 / interval_s);
    let speeds = speeds_of_meshes(r, passings, rate_hz)?;
    if !speeds.iter().any(|(_, rows)| changes(rows)) {
        return Ok(None);
    }
    let lines: MeshLines<'_> = (speeds.iter())
        .map(|(mesh, rows)| {
            let teeth = mesh.mesh.teeth[0] as f64;
            let at = |row: &CampbellRow| [begin_s + row.time_s, teeth * row.speed_rad_per_s / TAU];
            (&mesh.mesh.name[..], rows.iter().map(at).collect())
        })
        .collect();
    let mut section = Section::new(format!("{}: over time and frequency", r.head.title)).push(
        Text::paragraph(
            "The speed changes: amplitudes of short blocks of the run, Hann window, mean and trend of each block removed. Dashed: the mesh \
             frequencies and their multiples.",
        ),
    );
    let mut charts = 0;
    for group in groups(r, varies(r)) {
        if charts == CHARTS || !group.columns.iter().all(|(c, _)| is_prominent(c)) {
            continue;
        }
        if let Some(map) = map_of(r, &group, (begin_s, rate_hz), &lines)? {
            section = section.push(map);
            charts += 1;
        }
    }
    Ok((charts > 0).then_some(section))
}

/// Speeds, block by block, of the meshes whose frequency follows from the first gear alone.
fn speeds_of_meshes<'a>(
    r: &SystemResult,
    passings: &'a [MeshPassing],
    rate_hz: f64,
) -> Result<Vec<(&'a MeshPassing, Vec<CampbellRow>)>, FileError> {
    let mut found = Vec::new();
    for mesh in turning(passings) {
        let body = &mesh.mesh.bodies[0];
        let speed = (r.rows).read(&format!("bodies/{body}/angular_velocity_z_rad_per_s"))?;
        // The frequency over the second half is that of the gear where the line of centres stands.
        let half = &speed[speed.len() / 2..];
        let mean = half.iter().sum::<f64>() / half.len() as f64;
        let own_hz = mesh.mesh.teeth[0] as f64 * mean.abs() / TAU;
        let stands = (own_hz - mesh.frequency_hz).abs() <= STANDS * mesh.frequency_hz;
        if let Some(rows) =
            (stands.then(|| waterfall(&speed, Some(&speed), rate_hz))).and_then(Result::ok)
        {
            found.push((mesh, rows));
        }
    }
    Ok(found)
}

fn changes(rows: &[CampbellRow]) -> bool {
    let of = rows.iter().map(|row| row.speed_rad_per_s);
    let (least, most) = of.fold((f64::INFINITY, 0.0_f64), |(a, b), x| (a.min(x), b.max(x)));
    most > 0.0 && most - least > CHANGE * most
}

/// The map of a group's first column; none where nothing is to be seen in it.
fn map_of(
    r: &SystemResult,
    group: &Group,
    (begin_s, rate_hz): (f64, f64),
    lines: &MeshLines<'_>,
) -> Result<Option<MapChart>, FileError> {
    let Some((column, curve)) = group.columns.first() else {
        return Ok(None);
    };
    let values = r.read_for_spectrum(column)?;
    let Ok(mut rows) = waterfall(&values, None, rate_hz) else {
        return Ok(None);
    };
    let spacing = rows[0].spectrum.line_spacing;
    let points = lines.iter().flat_map(|(_, points)| points);
    let highest_hz = HIGHEST * points.map(|[_, hz]| *hz).fold(0.0, f64::max);
    let end = (0.5 * rate_hz * r.spectrum_band()).min(highest_hz);
    let shown = ((end / spacing) as usize).min(rows[0].spectrum.values.len());
    for row in &mut rows {
        row.spectrum.values.truncate(shown);
    }
    let of_lines = rows.iter().flat_map(|row| &row.spectrum.values);
    let largest = of_lines.copied().fold(0.0, f64::max);
    if shown < 4 || largest <= 0.0 {
        return Ok(None);
    }
    let (factor, unit) = usual_unit(&group.unit, largest);
    let along = rows.iter().map(|row| begin_s + row.time_s).collect();
    let scaled = |row: &CampbellRow| row.spectrum.values.iter().map(|v| factor * v).collect();
    let title = match group.title.ends_with(&curve[..]) {
        true => group.title.clone(),
        false => format!("{}: {curve}", group.title),
    };
    let mut chart = MapChart::new(
        title,
        Axis::new("time", "s"),
        Axis::new("frequency", "Hz"),
        Axis::new(group.amplitude(), unit),
    )
    .values(along, spacing, rows.iter().map(scaled).collect());
    for (name, points) in lines {
        for k in 1..=HARMONICS {
            let times_k = points.iter().map(|[t, hz]| [*t, k as f64 * hz]);
            chart = chart.line(harmonic(name, k), times_k.collect());
        }
    }
    Ok(Some(chart))
}
