//! Cages of `dynamic` bearings: bodies in the middle of their rows, turning as balls that roll carry them.

use gearmesh_bearings::quasi_static::Row;
use gearmesh_bearings::{BearingDefinition, QuasiStaticBearing};
use gearmesh_dynamics::Body;
use gearmesh_geometry::InputError;
use gearmesh_geometry::input::{InputDocument, TableKeys};
use nalgebra::Vector3;
use std::path::Path;

use super::housing::seated;
use super::rolling_bearing;
use crate::system::assembly::bodies::{Bodies, Frame, PlacedBody};
use crate::system::tables::bearing::{BearingModel, BearingTable, CageTable};

/// A cage in the list of bodies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::system) struct PlacedCage {
    /// Number of its bearing.
    pub bearing: usize,
    /// Number of its row.
    pub row: usize,
    /// Number in the list of bodies.
    pub body: usize,
    /// The body of the outer ring; none: the ground.
    pub outer: Option<usize>,
}

/// Adds the cages of all bearings to the bodies, whose speeds must be known.
pub(in crate::system::assembly) fn place(
    tables: &[BearingTable],
    (document, folder): (&InputDocument, &Path),
    bodies: &mut Bodies,
) -> Result<Vec<PlacedCage>, InputError> {
    let mut cages = Vec::new();
    for (bearing, table) in tables.iter().enumerate() {
        let BearingModel::Dynamic(model) = &table.model else {
            continue;
        };
        let Some(cage) = &model.cage else {
            continue;
        };
        let key = format!("bearing.{bearing}");
        let keys = TableKeys::new(document, &key);
        let table = &*seated(table);
        let ends = bodies.find_pair(&keys, table.body_1.as_deref(), &table.body_2)?;
        let frame = bodies.stated_frame(&keys, ends[1], table.at_mm, table.axis)?;
        let definition = rolling_bearing::definition("model.file", &model.file, folder, &keys)?;
        let made = QuasiStaticBearing::new(&definition).map_err(|e| keys.error("model", e))?;
        for (row, balls) in made.rows.iter().enumerate() {
            let Row::Ball(balls) = balls else {
                // The bearing itself is refused where it is made.
                continue;
            };
            let seat = Seat {
                name: name(&table.name, row, made.rows.len()),
                frame: Frame {
                    origin_m: frame.origin_m
                        + frame.axes * Vector3::new(0.0, 0.0, balls.middle_z_m),
                    axes: frame.axes,
                },
                pitch_radius_m: balls.pitch_radius_m,
            };
            let placed = body(cage, &seat, &definition, (bodies, ends), &keys)?;
            bodies.list.push(placed);
            cages.push(PlacedCage {
                bearing,
                row,
                body: bodies.list.len() - 1,
                outer: ends[0],
            });
        }
    }
    Ok(cages)
}

/// Name of the cage of a row.
fn name(bearing: &str, row: usize, rows: usize) -> String {
    if rows == 1 {
        format!("{bearing}/cage")
    } else {
        format!("{bearing}/cage_{}", row + 1)
    }
}

struct Seat {
    name: String,
    frame: Frame,
    pitch_radius_m: f64,
}

fn body(
    table: &CageTable,
    seat: &Seat,
    definition: &BearingDefinition,
    (bodies, ends): (&Bodies, [Option<usize>; 2]),
    keys: &TableKeys<'_>,
) -> Result<PlacedBody, InputError> {
    let mass_kg = *table.mass_kg;
    let along = mass_kg * seat.pitch_radius_m.powi(2);
    let inertia = table
        .inertia_kg_m2
        .unwrap_or([0.5 * along, 0.5 * along, along]);
    let mut body = Body::rigid(&seat.name, mass_kg, inertia);
    body.position_m = seat.frame.origin_m;
    body.orientation = seat.frame.axes;
    let axis = seat.frame.axes * Vector3::z();
    let spin = |end: Option<usize>| {
        end.map_or(0.0, |body| {
            let motion = bodies.list[body].motion();
            axis.dot(&(motion.rotation * motion.angular_velocity_rad_per_s))
        })
    };
    // Linear in the speeds, whatever their unit.
    let rolling = definition
        .rolling_sizes()
        .frequencies(spin(ends[1]), spin(ends[0]));
    body.angular_velocity_rad_per_s = Vector3::new(0.0, 0.0, rolling.cage_hz);
    body.velocity_m_per_s = velocity_with(bodies, ends[0], &body.position_m);
    body.validate()
        .map_err(|e| keys.error("model.cage.inertia_kg_m2", e))?;
    Ok(PlacedBody {
        body,
        source: "mass and inertia of the cage".to_owned(),
        gear: None,
        modes: 0,
        place_is_free: false,
        turn_is_free: false,
        speed_is_free: false,
        velocity_is_free: false,
    })
}

/// Velocity of a place that moves with a body; 0 on the ground.
pub(super) fn velocity_with(
    bodies: &Bodies,
    body: Option<usize>,
    place_m: &Vector3<f64>,
) -> Vector3<f64> {
    body.map_or_else(Vector3::zeros, |body| {
        let motion = bodies.list[body].motion();
        let turning = motion.rotation * motion.angular_velocity_rad_per_s;
        motion.velocity_m_per_s + turning.cross(&(place_m - motion.position_m))
    })
}
