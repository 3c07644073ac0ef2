//! Outer rings on a stiffness of the housing: a body and a bushing for each `bearing.housing`.

use std::borrow::Cow;

use gearmesh_dynamics::Body;
use gearmesh_geometry::InputError;
use gearmesh_geometry::input::{Beside, TableKeys};
use gearmesh_specification::system::bearing::BearingTable;

use super::placed_bearing::PlacedBearing;
use crate::system::assembly::bodies::{Bodies, PlacedBody, Seat};
use crate::system::assembly::connections::Connections;
use crate::system::assembly::elements::bushing;
use crate::system::scene::SystemScene;

/// Name of the outer ring's body.
fn ring(bearing: &str) -> String {
    format!("{bearing}/ring")
}

/// The bearing as it sits: on its outer ring's body where it has one.
pub(super) fn seated(table: &BearingTable) -> Cow<'_, BearingTable> {
    if table.housing.is_none() {
        return Cow::Borrowed(table);
    }
    Cow::Owned(BearingTable {
        body_1: Some(ring(&table.name)),
        ..table.clone()
    })
}

/// Adds the outer rings to the bodies. They move with their housings at the start.
pub(in crate::system::assembly) fn place(
    scene: &SystemScene,
    bodies: &mut Bodies,
) -> Result<(), InputError> {
    for (number, table) in scene.tables.bearing.iter().enumerate() {
        let Some(Beside(_, own)) = &table.housing else {
            continue;
        };
        let keys = TableKeys::new(&scene.document, format!("bearing.{number}"));
        let (on, at) = ((&table.body_1, &*table.body_2), (table.at_mm, table.axis));
        let Seat { ends, frame } = bodies.seat(&keys, on, at)?;
        let name = ring(&table.name);
        let mut body = Body::rigid(&name, own.ring_mass_kg, own.ring_inertia_kg_m2);
        body.position_m = frame.origin_m;
        body.orientation = frame.axes;
        body.velocity_m_per_s = bodies.velocity_with(ends[0], &frame.origin_m);
        body.angular_velocity_rad_per_s = frame.axes.inverse() * bodies.turning(ends[0]);
        body.validate()
            .map_err(|e| keys.error("housing.ring_mass_kg", e))?;
        let source = format!("outer ring of bearing `{}`", table.name);
        bodies.list.push(PlacedBody::placed(body, source));
    }
    Ok(())
}

/// Adds the stiffness between housing and outer ring, if the bearing has a housing.
pub(super) fn add(
    bearing: &PlacedBearing<'_>,
    connections: &mut Connections<'_>,
) -> Result<(), InputError> {
    let Some(Beside(stiffness, _)) = &bearing.table.housing else {
        return Ok(());
    };
    let (scene, bodies, number) = (connections.scene, connections.bodies, bearing.number);
    let keys = TableKeys::new(&scene.document, format!("bearing.{number}.housing"));
    let on = &scene.tables.bearing[number].body_1;
    // Place and axis are those of the ring.
    let seat = bodies.seat(
        &bearing.keys,
        (on, &ring(&bearing.table.name)),
        (None, None),
    )?;
    let name = format!("{}/housing", bearing.table.name);
    let made = bushing(stiffness, &keys)?.between(&name, bodies.markers(&seat));
    let made = made.map_err(|e| keys.error("", e))?;
    connections.element((&name, "housing"), &seat.ends, made);
    Ok(())
}
