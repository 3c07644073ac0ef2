//! Pairs of teeth in a run: the force of each; of bevel teeth that touch in points where on the flanks it acted, path
//! of contact and ellipses.

use gearmesh_model::FileError;
use gearmesh_scene::system_run::{MeshPassing, MeshRecord, SystemResult};

use crate::page::{
    Axis, FieldPicture, FieldValues, FlankChart, KeyFigures, LineChart, LineSeries, Section, Text,
};
use crate::short_number::short;

/// Pitches whose forces are drawn.
const PITCHES: f64 = 5.0;
/// Cells of the pattern along the face and up the flank.
const CELLS: [usize; 2] = [72, 24];
/// Ellipses drawn along a path.
const ELLIPSES: usize = 9;
/// Corners of a drawn ellipse.
const CORNERS: usize = 36;

/// A pair at a moment.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Touch {
    row: usize,
    tooth: usize,
    force_n: f64,
    /// On gear 1 and gear 2: shares along the face and up the flank.
    places: [[f64; 2]; 2],
    pressure_pa: f64,
    /// On both gears long and short half axis, as shares; none where slices were summed.
    axes: Option<[[[f64; 2]; 2]; 2]>,
}

/// A section for each mesh whose pairs have columns.
pub(super) fn sections(
    r: &SystemResult,
    passings: &[MeshPassing],
) -> Result<Vec<Section>, FileError> {
    let mut found = Vec::new();
    for passing in passings {
        let mesh = &passing.mesh;
        let touches = read(r, &mesh.name)?;
        if !touches.is_empty() {
            found.push(section(r, passing, mesh, &touches)?);
        }
    }
    Ok(found)
}

/// All pairs that carry in the second half of the run, in the order of time.
fn read(r: &SystemResult, mesh: &str) -> Result<Vec<Touch>, FileError> {
    let has = |name: &str| r.rows.columns().iter().any(|column| column.name == name);
    let mut found = Vec::new();
    for pair in 1.. {
        let name = |what: &str| format!("elements/{mesh}/pair_{pair}_{what}");
        if !has(&name("force_N")) {
            break;
        }
        let column = |what: &str| r.rows.read(&name(what));
        let (teeth, forces) = (column("tooth_1")?, column("force_N")?);
        let of_gear = |gear: usize| {
            let along = column(&format!("along_{gear}"))?;
            let height = column(&format!("height_{gear}"))?;
            Ok::<_, FileError>([along, height])
        };
        let places = [of_gear(1)?, of_gear(2)?];
        let pressures = column("pressure_Pa")?;
        let mut axes = Vec::new();
        let has_ellipses = has(&name("long_along_1"));
        for gear in [1, 2].into_iter().filter(|_| has_ellipses) {
            for axis in ["long", "short"] {
                for way in ["along", "height"] {
                    axes.push(column(&format!("{axis}_{way}_{gear}"))?);
                }
            }
        }
        for row in forces.len() / 2..forces.len() {
            if forces[row] > 0.0 {
                let at = |gear: usize, axis: usize| {
                    let first = 4 * gear + 2 * axis;
                    [axes[first][row], axes[first + 1][row]]
                };
                found.push(Touch {
                    row,
                    tooth: teeth[row] as usize,
                    force_n: forces[row],
                    places: [0, 1].map(|gear: usize| [0, 1].map(|k: usize| places[gear][k][row])),
                    pressure_pa: pressures[row],
                    axes: has_ellipses
                        .then(|| [0, 1].map(|gear| [0, 1].map(|axis| at(gear, axis)))),
                });
            }
        }
    }
    found.sort_by_key(|touch| touch.row);
    Ok(found)
}

fn section(
    r: &SystemResult,
    passing: &MeshPassing,
    mesh: &MeshRecord,
    touches: &[Touch],
) -> Result<Section, FileError> {
    let most = |of: &dyn Fn(&Touch) -> f64| touches.iter().map(of).fold(0.0, f64::max);
    let pressure = short(1e-6 * most(&|t| t.pressure_pa));
    let figures = KeyFigures::new()
        .figure("largest force of a pair", short(most(&|t| t.force_n)), "N")
        .figure("largest pressure after Hertz", pressure, "MPa");
    let text = "Over the second half of the run: at each place of the flank the largest pressure of all contact ellipses that covered it, as marking compound would show it. \
                Ellipses are Hertz' under the forces of the run, cut off at the edges; pressure that edges concentrate is not in them.";
    let mut section = Section::new(format!("{}: teeth of {}", r.head.title, mesh.name))
        .push(figures)
        .push(forces(r, passing, touches)?);
    if touches[0].axes.is_none() {
        let summed = "The force of a pair is the sum of its slices. How it spreads along the face is in the columns line_load_slice_….";
        return Ok(section.push(Text::paragraph(summed)));
    }
    section = section
        .push(Text::paragraph(moved(mesh, touches)))
        .push(Text::paragraph(text));
    let path = last_passage(r, touches)?;
    for gear in 0..2 {
        let flank = Flank::new(&mesh.flank_corners_m, gear);
        let name = &mesh.bodies[gear];
        section = section.push(flank.pattern(
            format!("Contact pattern on {name}, toe left, tip up"),
            touches,
        ));
        if !path.is_empty() {
            let title = format!("Path of contact of one tooth on {name}");
            section = section.push(flank.path(title, &path));
        }
    }
    Ok(section)
}

/// Places this near to the tip, as shares of the height, are the tip's.
const AT_TIP: f64 = 0.995;

/// Place of the contact on the first gear in the mean, weighted with the force: L and h \[mm\], and the share of the
/// force at tips.
fn mean_place(flank: &Flank, touches: &[Touch]) -> ([f64; 2], f64) {
    let (mut sum, mut at, mut tips) = (0.0, [0.0; 2], 0.0);
    for touch in touches {
        let place = flank.place_mm(touch.places[flank.gear]);
        sum += touch.force_n;
        (0..2).for_each(|k| at[k] += touch.force_n * place[k]);
        if touch.places.iter().any(|place| place[1] > AT_TIP) {
            tips += touch.force_n;
        }
    }
    (at.map(|x| x / sum), tips / sum)
}

/// Where the force acted in the mean beside the mean point, for which the formulas of statics hold.
fn moved(mesh: &MeshRecord, touches: &[Touch]) -> String {
    let flanks = [0, 1].map(|gear: usize| Flank::new(&mesh.flank_corners_m, gear));
    // Both faces end at the heel, the mean point is in the middle of the narrower one.
    let toe = f64::max(flanks[0].corners_mm[0][0], flanks[1].corners_mm[0][0]);
    let mean = 0.5 * (toe + flanks[0].corners_mm[3][0]);
    let ([along, up], tips) = mean_place(&flanks[0], touches);
    format!(
        "Formulas of tooth forces at the mean point (here {mean:.2} mm from the apex along the pitch cone) hold for a force that acts there. In this run the \
         contact on {} was in the mean, weighted with the force, {:+.2} mm from it towards the heel and {up:+.2} mm above the pitch cone, and tips carried \
         {:.1} % of the force: lever arms are longer by about {:.1} % by the place along the cone, and normals are those of that place. What moves the contact is the ease-off of the \
         flanks, where bodies and bearings let the members stand, and edges that touch first.",
        mesh.bodies[0],
        along - mean,
        100.0 * tips,
        100.0 * (along / mean - 1.0)
    )
}

/// Forces of the pairs over the last pitches, a curve for each tooth of gear 1.
fn forces(
    r: &SystemResult,
    passing: &MeshPassing,
    touches: &[Touch],
) -> Result<LineChart, FileError> {
    let times = r.rows.read("time_s")?;
    let last_s = times.last().copied().unwrap_or(0.0);
    let from_s = last_s - PITCHES / passing.frequency_hz.max(f64::MIN_POSITIVE);
    let half = times.len() / 2;
    let first = times.partition_point(|t| *t < from_s).max(half);
    let mut curves: Vec<(usize, Vec<f64>)> = Vec::new();
    let mut sum = vec![0.0; times.len() - first];
    for touch in touches.iter().filter(|touch| touch.row >= first) {
        let known = curves.iter().position(|(tooth, _)| *tooth == touch.tooth);
        let number = known.unwrap_or_else(|| {
            curves.push((touch.tooth, vec![f64::NAN; sum.len()]));
            curves.len() - 1
        });
        curves[number].1[touch.row - first] = touch.force_n;
        sum[touch.row - first] += touch.force_n;
    }
    let mut chart = LineChart::new(
        "Normal forces by pair of teeth, last pitches of the run",
        Axis::new("time", "s"),
        Axis::new("normal force", "N"),
    )
    .x_values(times[first..].to_vec())
    .series(LineSeries::new("sum", sum));
    for (tooth, curve) in curves {
        let name = format!("tooth {tooth} of {}", passing.mesh.bodies[0]);
        chart = chart.series(LineSeries::new(name, curve));
    }
    Ok(chart)
}

/// The last passage of a tooth that began after the middle of the run and ended before its end.
fn last_passage(r: &SystemResult, touches: &[Touch]) -> Result<Vec<Touch>, FileError> {
    let rows = r.rows.read("time_s")?.len();
    let mut ending = touches.iter().rev().filter(|touch| {
        let goes_on = |other: &Touch| other.row == touch.row + 1 && other.tooth == touch.tooth;
        touch.row + 1 < rows && !touches.iter().rev().any(goes_on)
    });
    let Some(last) = ending.next() else {
        return Ok(Vec::new());
    };
    let mut path = vec![*last];
    for touch in touches.iter().rev().filter(|t| t.tooth == last.tooth) {
        if touch.row + 1 == path[path.len() - 1].row {
            path.push(*touch);
        }
    }
    path.reverse();
    Ok(path)
}

/// A flank from shares to mm: x along the pitch cone from the apex, y above it.
struct Flank {
    gear: usize,
    /// Lower line and tip at the toe, tip and lower line at the heel \[mm\].
    corners_mm: Vec<[f64; 2]>,
}

impl Flank {
    fn new(corners_m: &[f64], gear: usize) -> Self {
        let own = &corners_m[8 * gear..8 * gear + 8];
        Self {
            gear,
            corners_mm: own
                .chunks(2)
                .map(|place| [1e3 * place[0], 1e3 * place[1]])
                .collect(),
        }
    }

    fn place_mm(&self, [along, height]: [f64; 2]) -> [f64; 2] {
        let [lower_toe, tip_toe, tip_heel, lower_heel] =
            [0, 1, 2, 3].map(|corner: usize| self.corners_mm[corner]);
        [0, 1].map(|k: usize| {
            let lower = lower_toe[k] + (lower_heel[k] - lower_toe[k]) * along;
            let tip = tip_toe[k] + (tip_heel[k] - tip_toe[k]) * along;
            lower + (tip - lower) * height
        })
    }

    /// Largest pressure of every cell.
    fn pattern(&self, title: String, touches: &[Touch]) -> FieldPicture {
        let [across, up] = CELLS;
        let mut cells = vec![0.0_f64; across * up];
        for touch in touches {
            let place = touch.places[self.gear];
            if let Some(axes) = &touch.axes {
                spread(
                    &mut cells,
                    place,
                    &axes[self.gear],
                    1e-6 * touch.pressure_pa,
                );
            }
        }
        let nodes = (0..=up).flat_map(|j| (0..=across).map(move |i| (i, j)));
        let nodes =
            nodes.map(|(i, j)| self.place_mm([i as f64 / across as f64, j as f64 / up as f64]));
        let quads = (0..across * up).map(|cell| {
            let first = (cell / across * (across + 1) + cell % across) as u32;
            let above = first + across as u32 + 1;
            [first, first + 1, above + 1, above]
        });
        FieldPicture::new(title, "pressure", "MPa")
            .mesh(nodes.collect(), quads.collect())
            .values(FieldValues::PerElement(cells))
            .colours_of_most()
    }

    /// The way of one contact over the flank, with ellipses.
    fn path(&self, title: String, path: &[Touch]) -> FlankChart {
        let mut chart = FlankChart::new(title, self.corners_mm.clone());
        let every = path.len().div_ceil(ELLIPSES).max(1);
        for touch in path.iter().skip(every / 2).step_by(every) {
            let Some(axes) = &touch.axes else {
                continue;
            };
            let ([long, short], place) = (axes[self.gear], touch.places[self.gear]);
            let corner = |k: usize| {
                let angle = std::f64::consts::TAU * k as f64 / CORNERS as f64;
                let (sin, cos) = angle.sin_cos();
                self.place_mm([0, 1].map(|i: usize| place[i] + cos * long[i] + sin * short[i]))
            };
            chart = chart.patch((0..CORNERS).map(corner).collect());
        }
        let points = path
            .iter()
            .map(|touch| self.place_mm(touch.places[self.gear]));
        chart.line("way of the contact, a dot for each row", points.collect())
    }
}

/// Puts p₀ √(1 − ρ²) of an ellipse into the cells whose middles it covers, and p₀ into that of its middle.
fn spread(cells: &mut [f64], place: [f64; 2], [long, short]: &[[f64; 2]; 2], pressure: f64) {
    let size = long[0] * short[1] - long[1] * short[0];
    let range = |k: usize| {
        let reach = long[k].hypot(short[k]);
        let cell = |share: f64| (share * CELLS[k] as f64).clamp(0.0, CELLS[k] as f64);
        cell(place[k] - reach).floor() as usize..cell(place[k] + reach).ceil() as usize
    };
    let own = [0, 1].map(|k: usize| ((place[k] * CELLS[k] as f64) as usize).min(CELLS[k] - 1));
    for j in range(1) {
        for i in range(0) {
            let x = (i as f64 + 0.5) / CELLS[0] as f64 - place[0];
            let y = (j as f64 + 0.5) / CELLS[1] as f64 - place[1];
            let along = (x * short[1] - y * short[0]) / size;
            let across = (long[0] * y - long[1] * x) / size;
            let rest = 1.0 - along * along - across * across;
            let here = if [i, j] == own {
                pressure
            } else if rest > 0.0 {
                pressure * rest.sqrt()
            } else {
                continue;
            };
            let cell = &mut cells[j * CELLS[0] + i];
            *cell = cell.max(here);
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn an_ellipse_covers_its_own_area() {
        let mut cells = vec![0.0; CELLS[0] * CELLS[1]];
        let axes = [[0.2, 0.1], [-0.02, 0.3]];
        spread(&mut cells, [0.5, 0.5], &axes, 1000.0);
        let covered = cells.iter().filter(|p| **p > 0.0).count() as f64 / cells.len() as f64;
        let area = std::f64::consts::PI * (0.2 * 0.3 + 0.02 * 0.1);
        assert!((covered - area).abs() < 0.03 * area, "{covered} of {area}");
        let largest = cells.iter().copied().fold(0.0, f64::max);
        assert!((largest - 1000.0).abs() < 1e-9);
    }

    #[test]
    fn the_mean_place_is_that_of_the_force() {
        let corners = [0.1, 0.0, 0.1, 0.01, 0.2, 0.01, 0.2, 0.0].repeat(2);
        let touch = |force_n: f64, place: [f64; 2]| Touch {
            row: 0,
            tooth: 0,
            force_n,
            places: [place; 2],
            pressure_pa: 0.0,
            axes: Some([[[0.0; 2]; 2]; 2]),
        };
        let touches = [touch(1.0, [0.2, 1.0]), touch(3.0, [0.6, 0.2])];
        let (place, tips) = mean_place(&Flank::new(&corners, 0), &touches);
        assert!((place[0] - 150.0).abs() < 1e-9 && (place[1] - 4.0).abs() < 1e-9);
        assert!((tips - 0.25).abs() < 1e-12);
    }

    #[test]
    fn shares_are_places_between_the_corners() {
        let corners = [
            0.10, -0.002, 0.10, 0.003, 0.13, 0.004, 0.13, -0.003, 0.1, 0.0, 0.1, 0.1, 0.2, 0.1,
            0.2, 0.0,
        ];
        let flank = Flank::new(&corners, 0);
        let close = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).abs() + (a[1] - b[1]).abs() < 1e-9;
        assert!(close(flank.place_mm([0.0, 1.0]), [100.0, 3.0]));
        assert!(close(flank.place_mm([1.0, 0.0]), [130.0, -3.0]));
        assert!(close(flank.place_mm([0.5, 0.5]), [115.0, 0.5]));
    }
}
