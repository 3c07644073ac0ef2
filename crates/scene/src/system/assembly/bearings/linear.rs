//! Bearings of constant stiffness and damping.

use gearmesh_dynamics::elements::LinearBearing;
use gearmesh_geometry::InputError;

use crate::system::assembly::elements::{Connections, PER_MM, pair};
use crate::system::assembly::stiffness::refuse_rigid;
use crate::system::tables::bearing::{BearingTable, LinearBearingTable};

/// Adds one.
pub(super) fn add(
    number: usize,
    table: &BearingTable,
    model: &LinearBearingTable,
    connections: &mut Connections<'_>,
) -> Result<(), InputError> {
    let named = (&*table.name, table.body_1.as_deref(), &*table.body_2);
    let bodies = connections.bodies;
    connections.add(
        ("bearing", number),
        "linear bearing",
        named,
        |keys, ends| {
            let frame = bodies.stated_frame(keys, ends[1], table.at_mm, table.axis)?;
            let radial = model.radial_stiffness_N_per_mm;
            let axial = model.axial_stiffness_N_per_mm;
            let tilt = model.tilt_stiffness_Nm_per_rad;
            let stated = [
                ("model.radial_stiffness_N_per_mm", radial, PER_MM),
                ("model.axial_stiffness_N_per_mm", axial, PER_MM),
                ("model.tilt_stiffness_Nm_per_rad", tilt, 1.0),
            ];
            refuse_rigid(keys, &stated)?;
            let bearing = LinearBearing {
                radial_stiffness_n_per_m: PER_MM * radial,
                axial_stiffness_n_per_m: PER_MM * axial,
                tilt_stiffness_nm_per_rad: tilt,
                radial_damping_n_s_per_m: PER_MM * model.radial_damping_N_s_per_mm,
                axial_damping_n_s_per_m: PER_MM * model.axial_damping_N_s_per_mm,
                tilt_damping_nm_s_per_rad: model.tilt_damping_Nm_s_per_rad,
            };
            Ok(bearing.between(&table.name, pair(bodies, ends, &frame)))
        },
    )
}
