//! Outer rings on a stiffness of the housing: a body and a bushing for each `bearing.housing`.

use std::borrow::Cow;

use gearmesh_dynamics::Body;
use gearmesh_geometry::InputError;
use gearmesh_geometry::input::{InputDocument, TableKeys};

use super::cages::velocity_with;
use crate::system::assembly::bodies::{Bodies, PlacedBody};
use crate::system::assembly::elements::{Connections, bushing, pair};
use crate::system::tables::bearing::{BearingTable, HousingTable};
use crate::system::tables::connection::BushingTable;

/// Name of the outer ring's body.
fn ring(bearing: &str) -> String {
    format!("{bearing}/ring")
}

/// The bearing as it sits: on its outer ring's body where it has one.
pub(in crate::system::assembly) fn seated(table: &BearingTable) -> Cow<'_, BearingTable> {
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
    tables: &[BearingTable],
    document: &InputDocument,
    bodies: &mut Bodies,
) -> Result<(), InputError> {
    for (number, table) in tables.iter().enumerate() {
        let Some(housing) = &table.housing else {
            continue;
        };
        let key = format!("bearing.{number}");
        let keys = TableKeys::new(document, &key);
        let ends = bodies.find_pair(&keys, table.body_1.as_deref(), &table.body_2)?;
        let frame = bodies.stated_frame(&keys, ends[1], table.at_mm, table.axis)?;
        let mut body = Body::rigid(
            &ring(&table.name),
            housing.ring_mass_kg,
            housing.ring_inertia_kg_m2,
        );
        body.position_m = frame.origin_m;
        body.orientation = frame.axes;
        body.velocity_m_per_s = velocity_with(bodies, ends[0], &frame.origin_m);
        if let Some(seat) = ends[0] {
            let motion = bodies.list[seat].motion();
            let turning = motion.rotation * motion.angular_velocity_rad_per_s;
            body.angular_velocity_rad_per_s = frame.axes.inverse() * turning;
        }
        body.validate()
            .map_err(|e| keys.error("housing.ring_mass_kg", e))?;
        bodies.list.push(PlacedBody {
            body,
            source: format!("outer ring of bearing `{}`", table.name),
            gear: None,
            modes: 0,
            place_is_free: false,
            turn_is_free: false,
            speed_is_free: false,
            velocity_is_free: false,
        });
    }
    Ok(())
}

/// Adds the stiffness between housing and outer ring.
pub(super) fn add(
    number: usize,
    table: &BearingTable,
    housing: &HousingTable,
    connections: &mut Connections<'_>,
) -> Result<(), InputError> {
    let name = format!("{}/housing", table.name);
    let ring = ring(&table.name);
    let named = (&*name, table.body_1.as_deref(), &*ring);
    let (bodies, document) = (connections.bodies, connections.document);
    connections.add(("bearing", number), "housing", named, |_, ends| {
        let key = format!("bearing.{number}.housing");
        let keys = TableKeys::new(document, &key);
        // Place and axis are those of the ring.
        let stiffness = BushingTable {
            name: name.clone(),
            body_1: None,
            body_2: ring.clone(),
            at_mm: None,
            axis: None,
            stiffness_N_per_mm: housing.stiffness_N_per_mm,
            stiffness_Nm_per_rad: housing.stiffness_Nm_per_rad,
            damping_N_s_per_mm: housing.damping_N_s_per_mm,
            damping_Nm_s_per_rad: housing.damping_Nm_s_per_rad,
            stiffness_matrix_SI: housing.stiffness_matrix_SI,
            damping_matrix_SI: housing.damping_matrix_SI,
        };
        let frame = bodies.stated_frame(&keys, ends[1], None, None)?;
        let made = bushing(&stiffness, &keys)?.between(&name, pair(bodies, ends, &frame));
        Ok(Ok(made.map_err(|e| keys.error("", e))?))
    })
}
