//! Bearings whose balls or rollers are in equilibrium.

use gearmesh_bearings::{QuasiStaticElement, RingDamping};
use gearmesh_geometry::InputError;
use gearmesh_geometry::input::TableKeys;

use super::{control, rolling_bearing};
use crate::system::assembly::elements::{Connections, PER_MM, SeatedBearing, pair};
use crate::system::tables::bearing::{BearingTable, QuasiStaticBearingTable};

/// Adds one.
pub(super) fn add(
    number: usize,
    table: &BearingTable,
    model: &QuasiStaticBearingTable,
    connections: &mut Connections<'_>,
) -> Result<(), InputError> {
    let named = (&*table.name, table.body_1.as_deref(), &*table.body_2);
    let key = format!("bearing.{number}");
    let keys = TableKeys::new(connections.document, &key);
    let ends = connections.bodies.find_pair(&keys, named.1, named.2)?;
    let in_bore = ends[0].filter(|body| connections.bodies.list[*body].bore_motions().is_some());
    let element = element((table, model), &keys, ends, connections)?;
    let Some(body) = in_bore else {
        return connections.add(("bearing", number), KIND, named, |_, _| Ok(Ok(element)));
    };
    connections
        .parts
        .element(&table.name, KIND, connections.bodies, ends);
    connections.seated.push(SeatedBearing {
        number,
        body,
        element,
    });
    Ok(())
}

const KIND: &str = "quasi-static bearing";

/// The bearing between two bodies, or one and the ground.
fn element(
    (table, model): (&BearingTable, &QuasiStaticBearingTable),
    keys: &TableKeys<'_>,
    ends: [Option<usize>; 2],
    connections: &Connections<'_>,
) -> Result<QuasiStaticElement, InputError> {
    let bodies = connections.bodies;
    let frame = bodies.stated_frame(keys, ends[1], table.at_mm, table.axis)?;
    let folder = connections.folder;
    let definition = rolling_bearing::definition("model.file", &model.file, folder, keys)?;
    let control = control(model.control);
    let damping = RingDamping {
        radial_n_s_per_m: PER_MM * model.radial_damping_N_s_per_mm,
        axial_n_s_per_m: PER_MM * model.axial_damping_N_s_per_mm,
        tilt_nm_s_per_rad: model.tilt_damping_Nm_s_per_rad,
    };
    let pair = pair(bodies, ends, &frame);
    let mut element = QuasiStaticElement::new(&table.name, pair, &definition, control, damping)
        .map_err(|e| keys.error("model", e))?;
    if connections.manner.at_rest {
        element = element.without_friction_torque();
    }
    if model.element_loads {
        element = element.with_element_loads();
    }
    Ok(element)
}
