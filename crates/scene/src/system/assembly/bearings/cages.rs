//! Cages of `dynamic` bearings: bodies in the middle of their rows, turning as balls that roll carry them.

use gearmesh_bearings::BearingDefinition;
use gearmesh_bearings::quasi_static::Row;
use gearmesh_dynamics::Body;
use gearmesh_geometry::InputError;
use gearmesh_specification::system::bearing::{BearingModel, CageTable};
use nalgebra::Vector3;

use super::placed_bearing::PlacedBearing;
use crate::system::assembly::bodies::{Bodies, Frame, PlacedBody};
use crate::system::scene::SystemScene;

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
    scene: &SystemScene,
    bodies: &mut Bodies,
) -> Result<Vec<PlacedCage>, InputError> {
    let mut cages = Vec::new();
    for (number, table) in scene.tables.bearing.iter().enumerate() {
        let BearingModel::Dynamic(model) = &table.model else {
            continue;
        };
        let Some(cage) = &model.cage else {
            continue;
        };
        let bearing = PlacedBearing::new(scene, number, bodies)?;
        let definition = bearing.definition("model.file", &model.file)?;
        let made = bearing.rolling(&definition)?;
        for (row, balls) in made.rows.iter().enumerate() {
            let Row::Ball(balls) = balls else {
                // The bearing itself is refused where it is made.
                continue;
            };
            let name = match made.rows.len() {
                1 => format!("{}/cage", table.name),
                _ => format!("{}/cage_{}", table.name, row + 1),
            };
            let at = (
                bearing.seat.frame.raised(balls.middle_z_m),
                balls.pitch_radius_m,
            );
            let placed = body((&name, cage), at, (&bearing, &definition), bodies)?;
            bodies.list.push(placed);
            cages.push(PlacedCage {
                bearing: number,
                row,
                body: bodies.list.len() - 1,
                outer: bearing.seat.ends[0],
            });
        }
    }
    Ok(cages)
}

fn body(
    (name, table): (&str, &CageTable),
    (frame, pitch_radius_m): (Frame, f64),
    (bearing, definition): (&PlacedBearing<'_>, &BearingDefinition),
    bodies: &Bodies,
) -> Result<PlacedBody, InputError> {
    let mass_kg = *table.mass_kg;
    let along = mass_kg * pitch_radius_m.powi(2);
    let inertia = table
        .inertia_kg_m2
        .unwrap_or([0.5 * along, 0.5 * along, along]);
    let mut body = Body::rigid(name, mass_kg, inertia);
    body.position_m = frame.origin_m;
    body.orientation = frame.axes;
    let axis = frame.axes * Vector3::z();
    let [outer, inner] = bearing.seat.ends.map(|end| axis.dot(&bodies.turning(end)));
    // Linear in the speeds, whatever their unit.
    let rolling = definition.rolling_sizes().frequencies(inner, outer);
    body.angular_velocity_rad_per_s = Vector3::new(0.0, 0.0, rolling.cage_hz);
    body.velocity_m_per_s = bodies.velocity_with(bearing.seat.ends[0], &body.position_m);
    body.validate()
        .map_err(|e| bearing.keys.error("model.cage.inertia_kg_m2", e))?;
    let source = "mass and inertia of the cage".to_owned();
    Ok(PlacedBody::placed(body, source))
}
