//! Bearings whose balls or rollers are in equilibrium.

use gearmesh_bearings::{QuasiStaticElement, RingDamping};
use gearmesh_geometry::InputError;

use super::{control, rolling_bearing};
use crate::system::assembly::elements::{Connections, PER_MM, pair};
use crate::system::tables::bearing::{BearingTable, QuasiStaticBearingTable};

/// Adds one.
pub(super) fn add(
    number: usize,
    table: &BearingTable,
    model: &QuasiStaticBearingTable,
    connections: &mut Connections<'_>,
) -> Result<(), InputError> {
    let named = (&*table.name, table.body_1.as_deref(), &*table.body_2);
    let (bodies, folder) = (connections.bodies, connections.folder);
    let at_rest = connections.manner.at_rest;
    connections.add(
        ("bearing", number),
        "quasi-static bearing",
        named,
        |keys, ends| {
            let frame = bodies.stated_frame(keys, ends[1], table.at_mm, table.axis)?;
            let definition = rolling_bearing::definition("model.file", &model.file, folder, keys)?;
            let control = control(model.control);
            let damping = RingDamping {
                radial_n_s_per_m: PER_MM * model.radial_damping_N_s_per_mm,
                axial_n_s_per_m: PER_MM * model.axial_damping_N_s_per_mm,
                tilt_nm_s_per_rad: model.tilt_damping_Nm_s_per_rad,
            };
            let pair = pair(bodies, ends, &frame);
            let element = QuasiStaticElement::new(&table.name, pair, &definition, control, damping)
                .map_err(|e| keys.error("model", e))?;
            let element = if at_rest {
                element.without_friction_torque()
            } else {
                element
            };
            Ok(Ok(if model.element_loads {
                element.with_element_loads()
            } else {
                element
            }))
        },
    )
}
