//! Bearings of constant stiffness and damping.

use gearmesh_bearings::{QuasiStaticBearing, QuasiStaticElement, RingDamping};
use gearmesh_dynamics::elements::{AxialSupport, ForceElement, LinearBearing, MatrixBearing};
use gearmesh_dynamics::{DynamicsError, MarkerPair};
use gearmesh_geometry::InputError;
use gearmesh_geometry::given;
use gearmesh_geometry::input::TableKeys;
use nalgebra::{Matrix5, Vector5};

use super::tangent::TangentSeat;
use super::{control, quasi_static, rolling_bearing};
use crate::system::assembly::elements::{Connections, PER_MM, pair};
use crate::system::assembly::stiffness::refuse_rigid;
use crate::system::tables::bearing::{
    AxialSupportWord, BearingTable, LinearBearingTable, QuasiStaticBearingTable,
};

/// Adds one.
pub(super) fn add(
    number: usize,
    table: &BearingTable,
    model: &LinearBearingTable,
    connections: &mut Connections<'_>,
) -> Result<(), InputError> {
    let key = format!("bearing.{number}.model");
    let keys = TableKeys::new(connections.document, &key);
    let beside = |said| format!("is not used together with {said}; remove one of the two");
    let diagonals = given!(model; radial_stiffness_N_per_mm, axial_stiffness_N_per_mm, tilt_stiffness_Nm_per_rad, axial_support);
    if let Some(file) = &model.tangent_of {
        keys.refuse(&diagonals, beside("tangent_of"))?;
        let matrices = given!(model; stiffness_matrix_SI, damping_matrix_SI);
        keys.refuse(&matrices, beside("tangent_of"))?;
        return by_tangent(number, (table, file), model, connections);
    }
    if let Some(stiffness) = &model.stiffness_matrix_SI {
        let dampings = given!(model; control, radial_damping_N_s_per_mm, axial_damping_N_s_per_mm, tilt_damping_Nm_s_per_rad);
        keys.refuse(&diagonals, beside("stiffness_matrix_SI"))?;
        keys.refuse(&dampings, beside("stiffness_matrix_SI"))?;
        return between(number, table, connections, |keys, at| {
            let stiffness = matrix(stiffness, "model.stiffness_matrix_SI", keys)?;
            let damping = model.damping_matrix_SI.as_ref();
            let damping = damping.map(|rows| matrix(rows, "model.damping_matrix_SI", keys));
            let damping = damping.transpose()?.unwrap_or_else(Matrix5::zeros);
            Ok(MatrixBearing::unloaded(stiffness, damping).between(&table.name, at))
        });
    }
    let others = given!(model; damping_matrix_SI, control);
    keys.refuse(&others, beside("radial_stiffness_N_per_mm"))?;
    between(number, table, connections, |keys, at| {
        Ok(diagonal(model, keys)?.between(&table.name, at))
    })
}

/// Adds an element in the bearing's frame, between both bodies.
fn between<E: ForceElement + 'static>(
    number: usize,
    table: &BearingTable,
    connections: &mut Connections<'_>,
    make: impl FnOnce(&TableKeys<'_>, MarkerPair) -> Result<Result<E, DynamicsError>, InputError>,
) -> Result<(), InputError> {
    let named = (&*table.name, table.body_1.as_deref(), &*table.body_2);
    let (bodies, at) = (connections.bodies, ("bearing", number));
    connections.add(at, "linear bearing", named, |keys, ends| {
        let frame = bodies.stated_frame(keys, ends[1], table.at_mm, table.axis)?;
        make(keys, pair(bodies, ends, &frame))
    })
}

/// The bearing whose stiffness is stated by its diagonal.
fn diagonal(model: &LinearBearingTable, keys: &TableKeys<'_>) -> Result<LinearBearing, InputError> {
    let radial = keys.needed(
        "model.radial_stiffness_N_per_mm",
        model.radial_stiffness_N_per_mm,
        "a bearing of kind \"linear\" without stiffness_matrix_SI and tangent_of",
    )?;
    let axial = model.axial_stiffness_N_per_mm.unwrap_or_default();
    let tilt = model.tilt_stiffness_Nm_per_rad.unwrap_or_default();
    let stated = [
        ("model.radial_stiffness_N_per_mm", radial, PER_MM),
        ("model.axial_stiffness_N_per_mm", axial, PER_MM),
        ("model.tilt_stiffness_Nm_per_rad", tilt, 1.0),
    ];
    refuse_rigid(keys, &stated)?;
    if model.axial_support.is_some() && axial == 0.0 {
        let problem = "says which way axial_stiffness_N_per_mm carries, which is missing";
        return Err(keys.error("model.axial_support", problem));
    }
    let [radial_damping, axial_damping, tilt_damping] = dampings(model);
    Ok(LinearBearing {
        radial_stiffness_n_per_m: PER_MM * radial,
        axial_stiffness_n_per_m: PER_MM * axial,
        tilt_stiffness_nm_per_rad: tilt,
        radial_damping_n_s_per_m: PER_MM * radial_damping,
        axial_damping_n_s_per_m: PER_MM * axial_damping,
        tilt_damping_nm_s_per_rad: tilt_damping,
        axial_support: match model.axial_support.unwrap_or_default() {
            AxialSupportWord::Both => AxialSupport::Both,
            AxialSupportWord::Positive => AxialSupport::Positive,
            AxialSupportWord::Negative => AxialSupport::Negative,
        },
    })
}

/// Across, along and of tilting, in the units of the keys.
fn dampings(model: &LinearBearingTable) -> [f64; 3] {
    [
        model.radial_damping_N_s_per_mm,
        model.axial_damping_N_s_per_mm,
        model.tilt_damping_Nm_s_per_rad,
    ]
    .map(Option::unwrap_or_default)
}

/// A symmetric 5×5 matrix without negative eigenvalues, stated with five or six rows.
fn matrix(rows: &[Vec<f64>], key: &str, keys: &TableKeys<'_>) -> Result<Matrix5<f64>, InputError> {
    let size = rows.len();
    if !(5..=6).contains(&size) || rows.iter().any(|row| row.len() != size) {
        let lengths: Vec<usize> = rows.iter().map(Vec::len).collect();
        let problem =
            format!("found {size} rows of {lengths:?} numbers, allowed are 5 rows of 5 or 6 of 6");
        return Err(keys.error(key, problem));
    }
    for (i, row) in rows.iter().enumerate() {
        for (j, &entry) in row.iter().enumerate() {
            let place = format!("{key}.{i}.{j}");
            refuse_rigid(keys, &[(&place, entry, 1.0)])?;
            if (i == 5 || j == 5) && entry != 0.0 {
                let problem = "found a stiffness about the axis; a bearing turns freely: write 0, or take a [[bushing]]";
                return Err(keys.error(&place, problem));
            }
            let mirrored = rows[j][i];
            if (entry - mirrored).abs() > 1e-9 * entry.abs().max(mirrored.abs()) {
                let problem = format!(
                    "found {entry:e}, but {mirrored:e} in row {} of column {}; give a symmetric matrix",
                    j + 1,
                    i + 1
                );
                return Err(keys.error(&place, problem));
            }
        }
    }
    let whole = Matrix5::from_fn(|i, j| rows[i][j]);
    // Scaled to a unit diagonal, because the units differ.
    let root = whole
        .diagonal()
        .map(|d| if d > 0.0 { 1.0 / d.sqrt() } else { 1.0 });
    let scaled = Matrix5::from_diagonal(&root) * whole * Matrix5::from_diagonal(&root);
    let least = scaled.symmetric_eigenvalues().min();
    let allowed = "at least 0: its lowest eigenvalue, scaled to a unit diagonal";
    keys.require(key, least, least >= -1e-9, allowed)?;
    Ok(whole)
}

fn by_tangent(
    number: usize,
    (table, file): (&BearingTable, &str),
    model: &LinearBearingTable,
    connections: &mut Connections<'_>,
) -> Result<(), InputError> {
    let found = connections.manner.tangents.iter();
    let found = found.clone().find(|tangent| tangent.bearing == number);
    let (folder, bodies) = (connections.folder, connections.bodies);
    let [radial, axial, tilt] = dampings(model);
    let key = format!("bearing.{number}");
    let keys = TableKeys::new(connections.document, &key);
    let ends = bodies.find_pair(&keys, table.body_1.as_deref(), &table.body_2)?;
    let frame = bodies.stated_frame(&keys, ends[1], table.at_mm, table.axis)?;
    let definition = rolling_bearing::definition("model.tangent_of", file, folder, &keys)?;
    let rolling = QuasiStaticBearing::new(&definition).map_err(|e| keys.error("model", e))?;
    let at = rolling.ring_markers(pair(bodies, ends, &frame));
    let seat = TangentSeat::new(number, (at, rolling), model);
    connections.parts.tangents.push(seat);
    let Some(tangent) = found else {
        // On the way to the operating point.
        let rolling = QuasiStaticBearingTable {
            file: file.to_owned(),
            control: model.control.unwrap_or_default(),
            radial_damping_N_s_per_mm: radial,
            axial_damping_N_s_per_mm: axial,
            tilt_damping_Nm_s_per_rad: tilt,
            element_loads: false,
        };
        return quasi_static::add(number, table, &rolling, connections);
    };
    let named = (&*table.name, table.body_1.as_deref(), &*table.body_2);
    connections.add(("bearing", number), "linear bearing", named, |_, _| {
        let diagonal = Vector5::new(PER_MM * radial, PER_MM * radial, PER_MM * axial, tilt, tilt);
        let bearing = MatrixBearing {
            stiffness: tangent.stiffness,
            damping: Matrix5::from_diagonal(&diagonal),
            at: tangent.at,
            load: tangent.load,
        };
        Ok(bearing.between(&table.name, at))
    })?;
    if definition.friction.is_none() {
        return Ok(());
    }
    // The torque of the loads that the bearing itself has where the rings stand.
    let name = format!("{}/friction", table.name);
    let named = (&*name, table.body_1.as_deref(), &*table.body_2);
    let at_rest = connections.manner.at_rest;
    let control = control(model.control.unwrap_or_default());
    connections.add(
        ("bearing", number),
        "bearing friction",
        named,
        |keys, ends| {
            let (at, damping) = (pair(bodies, ends, &frame), RingDamping::default());
            let element = QuasiStaticElement::new(&name, at, &definition, control, damping)
                .map_err(|e| keys.error("model", e))?
                .friction_alone();
            Ok(Ok(if at_rest {
                element.without_friction_torque()
            } else {
                element
            }))
        },
    )
}
