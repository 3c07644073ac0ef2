//! Points of a flank as measuring machines and publications list them: sectors along the face × heights up the flank,
//! each with coordinates and normal.

use std::path::Path;

use gearmesh_geometry::InputError;
use gearmesh_geometry::input::NumberTable;
use nalgebra::Vector3;

/// Heads of the columns, in this order below; the last three may all be missing.
const HEADS: [&str; 8] = ["sector", "height", "x_mm", "y_mm", "z_mm", "nx", "ny", "nz"];
/// Number of those that must be there.
const PLACES: usize = 5;
const DEVIATION: &str = "deviation_um";
/// Sectors and heights at least.
const LEAST: [usize; 2] = [4, 3];
/// Points at most: a fit takes a second.
const MOST_POINTS: usize = 1000;
/// Normals are rounded in print.
const UNIT_SLACK: f64 = 2e-3;

/// A point of the list.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct GridPoint {
    /// Place in the member's frame \[m\].
    pub r: Vector3<f64>,
    /// Unit normal as given; made of neighbouring points where none is, and rough then.
    pub normal: Vector3<f64>,
    /// Material added, normal to the flank \[m\].
    pub deviation_m: f64,
    /// Row of the file.
    row: usize,
}

/// A grid of points.
#[derive(Debug, Clone)]
pub(crate) struct PointGrid {
    /// Sectors and heights.
    pub size: [usize; 2],
    /// By sector, heights within.
    pub points: Vec<GridPoint>,
    /// Whether the file has deviations: its points and normals are then nominal.
    pub is_measured: bool,
    /// Whether the file has normals.
    pub has_normals: bool,
    table: NumberTable,
}

impl PointGrid {
    /// Reads a file whose origin lies `apex_m` from the pitch apex along the member's axis, towards the heel.
    ///
    /// # Errors
    /// [`InputError`] with file, line and reason.
    pub(crate) fn read(path: &Path, apex_m: f64) -> Result<Self, InputError> {
        let is_measured = NumberTable::head_among(path, [DEVIATION, HEADS[0]])? == DEVIATION;
        let mut has_normals = false;
        for head in &HEADS[PLACES..] {
            has_normals |= NumberTable::head_among(path, [head, HEADS[0]])? == *head;
        }
        let given = if has_normals { HEADS.len() } else { PLACES };
        let mut heads = HEADS[..given].to_vec();
        if is_measured {
            heads.push(DEVIATION);
        }
        let table = NumberTable::read(path, &heads)?;
        let rows = table.column(0).len();
        if rows > MOST_POINTS {
            let problem = format!("{rows} points, allowed are {MOST_POINTS}; leave rows out");
            return Err(table.error(problem));
        }
        let size = grid_size(&table)?;
        let mut places: Vec<Option<GridPoint>> = vec![None; size[0] * size[1]];
        for row in 0..rows {
            let at = |column: usize| table.column(column)[row];
            let vector = |first: usize| Vector3::new(at(first), at(first + 1), at(first + 2));
            let normal = if has_normals {
                vector(PLACES)
            } else {
                Vector3::z()
            };
            if (normal.norm() - 1.0).abs() > UNIT_SLACK {
                let [x, y, z]: [f64; 3] = normal.into();
                let length = normal.norm();
                let problem =
                    format!("the normal ({x}, {y}, {z}) is {length:.4} long, allowed is 1");
                return Err(table.error_at(row, PLACES, problem));
            }
            let [sector, height] = [at(0), at(1)].map(|x| x as usize - 1);
            let place = &mut places[sector * size[1] + height];
            if let Some(first) = place {
                let problem = format!(
                    "sector {} with height {} stands here and in row {} of the numbers; each once",
                    sector + 1,
                    height + 1,
                    first.row + 1
                );
                return Err(table.error_at(row, 0, problem));
            }
            *place = Some(GridPoint {
                r: vector(2) * 1e-3 + Vector3::z() * apex_m,
                normal: normal.normalize(),
                deviation_m: match is_measured {
                    true => 1e-6 * at(given),
                    false => 0.0,
                },
                row,
            });
        }
        if let Some(place) = places.iter().position(Option::is_none) {
            let (sector, height) = (place / size[1] + 1, place % size[1] + 1);
            let problem = format!(
                "sector {sector} has no height {height}; a grid of {} sectors and {} heights needs {} rows",
                size[0],
                size[1],
                size[0] * size[1]
            );
            return Err(table.error(problem));
        }
        let mut points: Vec<GridPoint> = places.into_iter().flatten().collect();
        if !has_normals {
            let normals = normals_of_neighbours(&points, size);
            for (point, normal) in points.iter_mut().zip(normals) {
                point.normal = normal;
            }
        }
        Ok(Self {
            size,
            points,
            is_measured,
            has_normals,
            table,
        })
    }

    /// A complaint about a point.
    pub(crate) fn error_at(&self, point: usize, column: &str, problem: String) -> InputError {
        let number = HEADS.iter().position(|head| *head == column).unwrap_or(2);
        self.table.error_at(self.points[point].row, number, problem)
    }

    /// A complaint about the whole grid.
    pub(crate) fn error(&self, problem: String) -> InputError {
        self.table.error(problem)
    }
}

/// Sectors and heights of a list.
fn grid_size(table: &NumberTable) -> Result<[usize; 2], InputError> {
    let mut size = [0; 2];
    for k in 0..2 {
        for (row, &value) in table.column(k).iter().enumerate() {
            if value.fract() != 0.0 || !(1.0..=MOST_POINTS as f64).contains(&value) {
                let problem = format!("found {value}, allowed is a whole number from 1");
                return Err(table.error_at(row, k, problem));
            }
            size[k] = size[k].max(value as usize);
        }
        if size[k] < LEAST[k] {
            let what = ["sectors", "heights"][k];
            let problem = format!("{} {what}, at least {} are needed", size[k], LEAST[k]);
            return Err(table.error(problem));
        }
    }
    Ok(size)
}

/// Normals from the chords to neighbouring points; 0 where these do not span a plane.
fn normals_of_neighbours(
    points: &[GridPoint],
    [sectors, heights]: [usize; 2],
) -> Vec<Vector3<f64>> {
    let place = |sector: usize, height: usize| points[sector * heights + height].r;
    let beside = |i: usize, count: usize| (i.saturating_sub(1), (i + 1).min(count - 1));
    let normal = |i: usize| {
        let (sector, height) = (i / heights, i % heights);
        let (before, after) = beside(sector, sectors);
        let (below, above) = beside(height, heights);
        let along = place(after, height) - place(before, height);
        let up = place(sector, above) - place(sector, below);
        let across = along.cross(&up);
        across
            .try_normalize(1e-6 * along.norm() * up.norm())
            .unwrap_or_else(Vector3::zeros)
    };
    (0..points.len()).map(normal).collect()
}
