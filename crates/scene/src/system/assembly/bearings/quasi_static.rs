//! Bearings whose balls or rollers are in equilibrium.

use gearmesh_bearings::bearing_file::BearingFromFile;
use gearmesh_bearings::{Control, QuasiStaticElement, RingDamping};
use gearmesh_geometry::InputError;
use gearmesh_geometry::input::InputDocument;

use crate::system::assembly::elements::{Connections, PER_MM, pair};
use crate::system::tables::bearing::{BearingTable, ControlWord, QuasiStaticBearingTable};

/// Adds one.
pub(super) fn add(
    number: usize,
    table: &BearingTable,
    model: &QuasiStaticBearingTable,
    connections: &mut Connections<'_>,
) -> Result<(), InputError> {
    let named = (&*table.name, table.body_1.as_deref(), &*table.body_2);
    let (bodies, folder) = (connections.bodies, connections.folder);
    connections.add(
        ("bearing", number),
        "quasi-static bearing",
        named,
        |keys, ends| {
            let frame = bodies.stated_frame(keys, ends[1], table.at_mm, table.axis)?;
            let path = folder.join(&model.file);
            if !path.exists() {
                let problem = format!("the bearing file {} does not exist", path.display());
                return Err(keys.error("model.file", problem));
            }
            let found = BearingFromFile::from_document(&InputDocument::read(&path)?)?;
            let control = match model.control {
                ControlWord::OuterRace => Control::OuterRace,
                ControlWord::LeastSpin => Control::LeastSpin,
            };
            let damping = RingDamping {
                radial_n_s_per_m: PER_MM * model.radial_damping_N_s_per_mm,
                axial_n_s_per_m: PER_MM * model.axial_damping_N_s_per_mm,
                tilt_nm_s_per_rad: model.tilt_damping_Nm_s_per_rad,
            };
            let pair = pair(bodies, ends, &frame);
            let element =
                QuasiStaticElement::new(&table.name, pair, &found.definition, control, damping)
                    .map_err(|e| keys.error("model", e))?;
            Ok(Ok(if model.element_loads {
                element.with_element_loads()
            } else {
                element
            }))
        },
    )
}
