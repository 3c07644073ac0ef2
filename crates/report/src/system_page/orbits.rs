//! Ways of the gears' bodies across their axes, and slow lines of machines on balls: shafts and cages.

use std::f64::consts::TAU;

use gearmesh_model::FileError;
use gearmesh_scene::system_run::{MeshPassing, SystemResult};
use gearmesh_signal::{Window, amplitude_spectrum};

use super::columns::{half, mean};
use crate::page::{Axis, AxisScale, LineChart, LineSeries, PathChart, Section, Text};

/// Points of a picture at most.
const MOST_POINTS: usize = 2000;
/// Highest frequency over that of the mesh.
const SPECTRUM_END: f64 = 1.3;

/// Orbits of all gears of meshes that are recorded; none where no axis is known or no body moves.
pub(super) fn section(
    r: &SystemResult,
    passings: &[MeshPassing],
) -> Result<Option<Section>, FileError> {
    let mut charts = Vec::new();
    for passing in passings {
        for body in &passing.mesh.bodies {
            if let Some(chart) = orbit(r, body)? {
                charts.push(chart);
            }
        }
    }
    if charts.is_empty() {
        return Ok(None);
    }
    let text = "Way of the body's origin (of a bevel gear the pitch apex) across its axis over the second half of the run, from its mean place.";
    let section = Section::new(format!("{}: orbits", r.head.title)).push(Text::paragraph(text));
    Ok(Some(charts.into_iter().fold(section, Section::push)))
}

fn orbit(r: &SystemResult, body: &str) -> Result<Option<PathChart>, FileError> {
    let read = |what: &str| half(r, &format!("bodies/{body}/{what}"));
    let (x_rad, y_rad) = (mean(&read("cardan_x_rad")?), mean(&read("cardan_y_rad")?));
    let axis = [
        y_rad.sin(),
        -x_rad.sin() * y_rad.cos(),
        x_rad.cos() * y_rad.cos(),
    ];
    let [right, upwards] = across(axis);
    let places = [read("x_m")?, read("y_m")?, read("z_m")?];
    let means = [0, 1, 2].map(|k: usize| mean(&places[k]));
    let rows = places[0].len();
    let points: Vec<[f64; 2]> = (0..rows)
        .step_by(rows.div_ceil(MOST_POINTS).max(1))
        .map(|row| {
            let place = [0, 1, 2].map(|k: usize| places[k][row] - means[k]);
            [1e6 * dot(place, right), 1e6 * dot(place, upwards)]
        })
        .collect();
    let moves = points.iter().flatten().any(|x| x.abs() > 1e-6);
    Ok(moves.then(|| PathChart::new(format!("Orbit of {body}"), "µm", points)))
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Two directions across a unit axis: to the right the world's axis behind the one that it is nearest to, and upwards.
fn across(axis: [f64; 3]) -> [[f64; 3]; 2] {
    let nearest = (0..3).fold(0, |most, k| {
        if axis[k].abs() > axis[most].abs() {
            k
        } else {
            most
        }
    });
    let behind = (nearest + 1) % 3;
    let mut right = axis.map(|along| -along * axis[behind]);
    right[behind] += 1.0;
    let length = dot(right, right).sqrt();
    let right = right.map(|x| x / length);
    let upwards = [0, 1, 2].map(|k: usize| {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        axis[i] * right[j] - axis[j] * right[i]
    });
    [right, upwards]
}

/// Spectra of the cages' speeds up to the mesh frequency, with shafts, cages and meshes marked.
pub(super) fn cage_spectrum(
    r: &SystemResult,
    passings: &[MeshPassing],
) -> Result<Option<LineChart>, FileError> {
    let interval_s = r.interval_s()?;
    let mut marks = Vec::new();
    let mut end_hz = 0.0_f64;
    for passing in passings {
        let mesh = &passing.mesh;
        for (body, teeth) in mesh.bodies.iter().zip(mesh.teeth) {
            marks.push((passing.frequency_hz / teeth as f64, body.clone()));
        }
        marks.push((passing.frequency_hz, mesh.name.clone()));
        end_hz = end_hz.max(SPECTRUM_END * passing.frequency_hz);
    }
    let (mut frequencies, mut curves) = (Vec::new(), Vec::new());
    for column in r.rows.columns() {
        let Some(head) = column.name.strip_suffix("_speed_ratio") else {
            continue;
        };
        let Some((bearing, cage)) = head.rsplit_once('/') else {
            continue;
        };
        let bearing = bearing.trim_start_matches("elements/");
        let suffix = cage.replace("cage_1", "cage").replace("cage_", "cage ");
        let speed = format!("bodies/{bearing}_cage/angular_velocity_z_rad_per_s");
        let name = r.rows.columns().iter().any(|column| column.name == speed);
        let values = if name { half(r, &speed)? } else { continue };
        let middle = mean(&values);
        marks.push((middle.abs() / TAU, format!("{bearing} {suffix}")));
        let centred: Vec<f64> = values.iter().map(|v| v - middle).collect();
        let Ok(spectrum) = amplitude_spectrum(&centred, 1.0 / interval_s, Window::Hann) else {
            continue;
        };
        frequencies = (0..spectrum.values.len()).map(|i| spectrum.at(i)).collect();
        curves.push((bearing.to_owned(), spectrum.values));
    }
    let shown = frequencies.partition_point(|f| *f <= end_hz);
    if curves.is_empty() || shown < 4 {
        return Ok(None);
    }
    let mut chart = LineChart::new(
        "Speeds of the cages: spectrum over the second half of the run",
        Axis::new("frequency", "Hz"),
        Axis::new("amplitude", "rad/s"),
    )
    .y_scale(AxisScale::Logarithmic)
    .x_values(frequencies[1..shown].to_vec());
    for (name, values) in curves {
        chart = chart.series(LineSeries::new(name, values[1..shown].to_vec()));
    }
    for (at, name) in marks {
        chart = chart.mark(at, name);
    }
    Ok(Some(chart))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_orbit_is_seen_along_its_axis() {
        for (axis, expected) in [
            ([0.0, 0.0, 1.0], [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]),
            ([1.0, 0.0, 0.0], [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]),
        ] {
            for (found, expected) in across(axis).into_iter().zip(expected) {
                assert!(dot(found, expected) > 1.0 - 1e-12, "{found:?}");
            }
        }
    }
}
