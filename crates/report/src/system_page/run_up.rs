//! Runs whose speed changes: amplitudes over time and frequency, with the mesh frequencies drawn.

use std::f64::consts::TAU;

use gearmesh_model::FileError;
use gearmesh_scene::system_run::{MeshPassing, SystemResult, is_prominent};
use gearmesh_signal::CampbellRow;

use super::columns::{groups, turning, varies};
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
    let rate_hz = 1.0 / interval_s;
    let mut meshes = Vec::new();
    for mesh in turning(passings) {
        let speed = r.rows.read(&format!(
            "bodies/{}/angular_velocity_z_rad_per_s",
            mesh.mesh.bodies[0]
        ))?;
        // The frequency over the second half is that of the gear where the line of centres stands.
        let half = &speed[speed.len() / 2..];
        let mean = half.iter().sum::<f64>() / half.len() as f64;
        let own_hz = mesh.mesh.teeth[0] as f64 * mean.abs() / TAU;
        if (own_hz - mesh.frequency_hz).abs() <= STANDS * mesh.frequency_hz {
            meshes.push((mesh, speed));
        }
    }
    let speeds =
        |speed: &[f64]| -> Option<Vec<CampbellRow>> { waterfall(speed, Some(speed), rate_hz).ok() };
    let changes = meshes.iter().any(|(_, speed)| {
        let rows = speeds(speed).unwrap_or_default();
        let of = rows.iter().map(|row| row.speed_rad_per_s);
        let (least, most) = of.fold((f64::INFINITY, 0.0_f64), |(a, b), x| (a.min(x), b.max(x)));
        most > 0.0 && most - least > CHANGE * most
    });
    if !changes {
        return Ok(None);
    }
    let lines: Vec<(&str, Vec<[f64; 2]>)> = (meshes.iter())
        .filter_map(|(mesh, speed)| {
            let teeth = mesh.mesh.teeth[0] as f64;
            let at = |row: &CampbellRow| [times[0] + row.time_s, teeth * row.speed_rad_per_s / TAU];
            Some((&mesh.mesh.name[..], speeds(speed)?.iter().map(at).collect()))
        })
        .collect();
    let points = lines.iter().flat_map(|(_, points)| points);
    let highest_hz = HIGHEST * points.map(|[_, hz]| *hz).fold(0.0, f64::max);
    let mut section = Section::new(format!("{}: over time and frequency", r.head.title)).push(
        Text::paragraph(
            "The speed changes: amplitudes of short blocks of the run, Hann window, mean and trend of each block removed. Dashed: the mesh \
             frequencies and their multiples.",
        ),
    );
    let mut charts = 0;
    for group in groups(r, varies(r)) {
        let Some((column, curve)) = group.columns.first() else {
            continue;
        };
        if charts == CHARTS || !group.columns.iter().all(|(c, _)| is_prominent(c)) {
            continue;
        }
        let values = r.read_for_spectrum(column)?;
        let Ok(mut rows) = waterfall(&values, None, rate_hz) else {
            continue;
        };
        let spacing = rows[0].spectrum.line_spacing;
        let end = (0.5 * rate_hz * r.spectrum_band()).min(highest_hz);
        let lines_shown = ((end / spacing) as usize).min(rows[0].spectrum.values.len());
        let of_lines = rows
            .iter()
            .flat_map(|row| &row.spectrum.values[..lines_shown]);
        let largest = of_lines.copied().fold(0.0, f64::max);
        if lines_shown < 4 || largest <= 0.0 {
            continue;
        }
        let (factor, unit) = usual_unit(&group.unit, largest);
        let along = rows.iter().map(|row| times[0] + row.time_s).collect();
        let columns = rows.iter_mut().map(|row| {
            row.spectrum.values.truncate(lines_shown);
            row.spectrum
                .values
                .iter()
                .map(|value| factor * value)
                .collect()
        });
        let mut chart = MapChart::new(
            if group.title.ends_with(&curve[..]) {
                group.title.clone()
            } else {
                format!("{}: {curve}", group.title)
            },
            Axis::new("time", "s"),
            Axis::new("frequency", "Hz"),
            Axis::new(group.amplitude(), unit),
        )
        .values(along, spacing, columns.collect());
        for (name, points) in &lines {
            for k in 1..=HARMONICS {
                let name = match k {
                    1 => (*name).to_owned(),
                    k => format!("{k}×"),
                };
                let times_k = points.iter().map(|[t, hz]| [*t, k as f64 * hz]);
                chart = chart.line(name, times_k.collect());
            }
        }
        section = section.push(chart);
        charts += 1;
    }
    Ok((charts > 0).then_some(section))
}
