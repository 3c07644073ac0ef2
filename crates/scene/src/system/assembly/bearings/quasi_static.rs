//! Bearings whose balls or rollers are in equilibrium.

use gearmesh_bearings::{QuasiStaticElement, RingDamping};
use gearmesh_geometry::InputError;
use gearmesh_specification::system::bearing::QuasiStaticBearingTable;

use super::placed_bearing::PlacedBearing;
use crate::system::assembly::connections::{Connections, SeatedBearing};
use crate::system::assembly::elements::PER_MM;

/// Adds one.
pub(super) fn add(
    bearing: &PlacedBearing<'_>,
    model: &QuasiStaticBearingTable,
    connections: &mut Connections<'_>,
) -> Result<(), InputError> {
    let definition = bearing.definition("model.file", &model.file)?;
    let damping = RingDamping {
        radial_n_s_per_m: PER_MM * model.radial_damping_N_s_per_mm,
        axial_n_s_per_m: PER_MM * model.axial_damping_N_s_per_mm,
        tilt_nm_s_per_rad: model.tilt_damping_Nm_s_per_rad,
    };
    let (bodies, ends) = (connections.bodies, bearing.seat.ends);
    let (name, at) = (&*bearing.table.name, bodies.markers(&bearing.seat));
    let mut element = QuasiStaticElement::new(name, at, &definition, model.control, damping)
        .map_err(|e| bearing.keys.error("model", e))?;
    if connections.at_rest {
        element = element.without_friction_torque();
    }
    if model.element_loads {
        element = element.with_element_loads();
    }
    let kind = "quasi-static bearing";
    let Some(body) = ends[0].filter(|body| bodies.list[*body].bore_motions().is_some()) else {
        connections.element((name, kind), &ends, element);
        return Ok(());
    };
    let part = bodies.part(name, kind, &ends);
    connections.parts.elements.push(part);
    connections.seated.push(SeatedBearing {
        number: bearing.number,
        body,
        element,
    });
    Ok(())
}
