//! Balls and cages of bearings whose balls move: loads over the angle, the way of the cage's middle, how fast it turns
//! and whirls.

use gearmesh_model::FileError;
use gearmesh_scene::system_run::SystemResult;

use super::columns::{half, mean};
use crate::page::{Axis, KeyFigures, LineChart, LineSeries, PathChart, Section};
use crate::short_number::short;

/// Points of a picture at most.
const MOST_POINTS: usize = 2000;

/// A section for every bearing whose columns have balls or cages; over the second half of the run.
pub(super) fn sections(r: &SystemResult) -> Result<Vec<Section>, FileError> {
    let has = |name: &str| r.rows.columns().iter().any(|column| column.name == name);
    let mut found = Vec::new();
    for column in r.rows.columns() {
        let Some(bearing) = column.name.strip_suffix("/orbit_speed_rad_per_s") else {
            continue;
        };
        let name = bearing.split('/').skip(1).collect::<Vec<_>>().join("/");
        let mut section = Section::new(format!("{}: bearing {name}", r.head.title));
        let mut is_empty = true;
        for cage in 1.. {
            let head = format!("{bearing}/cage_{cage}");
            if !has(&format!("{head}_x_m")) {
                break;
            }
            section = of_cage(r, section, &head, cage)?;
            is_empty = false;
        }
        if has(&format!("{bearing}/ball_1_angle_rad")) {
            section = section.push(loads_over_angle(r, bearing)?);
            is_empty = false;
        }
        if !is_empty {
            found.push(section);
        }
    }
    Ok(found)
}

fn of_cage(
    r: &SystemResult,
    section: Section,
    head: &str,
    cage: usize,
) -> Result<Section, FileError> {
    let read = |what: &str| half(r, &format!("{head}_{what}"));
    let (ratio, whirl) = (read("speed_ratio")?, read("whirl_rad_per_s")?);
    let forces = [read("force_x_N")?, read("force_y_N")?, read("force_z_N")?];
    let largest = (0..ratio.len())
        .map(|row| forces.iter().map(|f| f[row] * f[row]).sum::<f64>().sqrt())
        .fold(0.0, f64::max);
    let figures = KeyFigures::new()
        .figure(
            format!("cage {cage}: speed over the inner ring's"),
            short(mean(&ratio)),
            "",
        )
        .figure("whirl of its middle, mean", short(mean(&whirl)), "rad/s")
        .figure("largest force of its pockets", short(largest), "N");
    let (x, y) = (read("x_m")?, read("y_m")?);
    let every = x.len().div_ceil(MOST_POINTS).max(1);
    let points = x.iter().zip(&y).step_by(every);
    let path = PathChart::new(
        format!("Way of the middle of cage {cage}"),
        "µm",
        points.map(|(x, y)| [1e6 * x, 1e6 * y]).collect(),
    );
    Ok(section.push(figures).push(path))
}

/// Loads of the first ball at both races over its angle, turn upon turn.
fn loads_over_angle(r: &SystemResult, bearing: &str) -> Result<LineChart, FileError> {
    let read = |what: &str| half(r, &format!("{bearing}/ball_1_{what}"));
    let (angle, outer, inner) = (read("angle_rad")?, read("outer_N")?, read("inner_N")?);
    let every = angle.len().div_ceil(MOST_POINTS).max(1);
    let mut rows: Vec<[f64; 3]> = (0..angle.len())
        .step_by(every)
        .map(|row| {
            [
                angle[row].to_degrees().rem_euclid(360.0),
                outer[row],
                inner[row],
            ]
        })
        .collect();
    rows.sort_by(|a, b| a[0].total_cmp(&b[0]));
    rows.dedup_by(|a, b| a[0] <= b[0]);
    let column = |place: usize| rows.iter().map(|row| row[place]).collect::<Vec<_>>();
    Ok(LineChart::new(
        "Load of ball 1 over its angle round the axis",
        Axis::new("angle", "deg"),
        Axis::new("load", "N"),
    )
    .x_values(column(0))
    .series(LineSeries::new("outer race", column(1)))
    .series(LineSeries::new("inner race", column(2))))
}
