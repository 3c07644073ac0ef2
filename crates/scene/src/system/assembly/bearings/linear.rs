//! Bearings of constant stiffness and damping.

use gearmesh_bearings::{QuasiStaticElement, RingDamping};
use gearmesh_dynamics::elements::{AxialSupport, LinearBearing, MatrixBearing};
use gearmesh_geometry::InputError;
use gearmesh_geometry::given;
use gearmesh_geometry::input::TableKeys;
use gearmesh_specification::system::bearing::{
    AxialSupportWord, LinearBearingTable, QuasiStaticBearingTable,
};
use nalgebra::{Matrix5, Vector5};

use super::placed_bearing::PlacedBearing;
use super::quasi_static;
use super::tangent::TangentSeat;
use crate::system::assembly::connections::Connections;
use crate::system::assembly::elements::PER_MM;
use crate::system::assembly::stiffness::refuse_rigid;

/// As plans call them.
const KIND: &str = "linear bearing";

/// Adds one.
pub(super) fn add(
    bearing: &PlacedBearing<'_>,
    model: &LinearBearingTable,
    connections: &mut Connections<'_>,
) -> Result<(), InputError> {
    let document = &connections.scene.document;
    let keys = TableKeys::new(document, format!("bearing.{}.model", bearing.number));
    let beside = |said| format!("is not used together with {said}; remove one of the two");
    let diagonals = given!(model; radial_stiffness_N_per_mm, axial_stiffness_N_per_mm, tilt_stiffness_Nm_per_rad, axial_support);
    if let Some(file) = &model.tangent_of {
        keys.refuse(&diagonals, beside("tangent_of"))?;
        let matrices = given!(model; stiffness_matrix_SI, damping_matrix_SI);
        keys.refuse(&matrices, beside("tangent_of"))?;
        return by_tangent((bearing, file), model, connections);
    }
    let (named, ends) = ((&*bearing.table.name, KIND), &bearing.seat.ends);
    let at = connections.bodies.markers(&bearing.seat);
    if let Some(stiffness) = &model.stiffness_matrix_SI {
        let dampings = given!(model; control, radial_damping_N_s_per_mm, axial_damping_N_s_per_mm, tilt_damping_Nm_s_per_rad);
        keys.refuse(&diagonals, beside("stiffness_matrix_SI"))?;
        keys.refuse(&dampings, beside("stiffness_matrix_SI"))?;
        let stiffness = matrix(stiffness, "stiffness_matrix_SI", &keys)?;
        let damping = model.damping_matrix_SI.as_ref();
        let damping = damping.map(|rows| matrix(rows, "damping_matrix_SI", &keys));
        let damping = damping.transpose()?.unwrap_or_else(Matrix5::zeros);
        let made = MatrixBearing::unloaded(stiffness, damping).between(named.0, at);
        connections.element(named, ends, made.map_err(|e| bearing.keys.error("", e))?);
        return Ok(());
    }
    let others = given!(model; damping_matrix_SI, control);
    keys.refuse(&others, beside("radial_stiffness_N_per_mm"))?;
    let made = diagonal(model, &keys)?.between(named.0, at);
    connections.element(named, ends, made.map_err(|e| bearing.keys.error("", e))?);
    Ok(())
}

/// The bearing whose stiffness is stated by its diagonal.
fn diagonal(model: &LinearBearingTable, keys: &TableKeys<'_>) -> Result<LinearBearing, InputError> {
    let radial = keys.needed(
        "radial_stiffness_N_per_mm",
        model.radial_stiffness_N_per_mm,
        "a bearing of kind \"linear\" without stiffness_matrix_SI and tangent_of",
    )?;
    let axial = model.axial_stiffness_N_per_mm.unwrap_or_default();
    let tilt = model.tilt_stiffness_Nm_per_rad.unwrap_or_default();
    let stated = [
        ("radial_stiffness_N_per_mm", radial, PER_MM),
        ("axial_stiffness_N_per_mm", axial, PER_MM),
        ("tilt_stiffness_Nm_per_rad", tilt, 1.0),
    ];
    refuse_rigid(keys, &stated)?;
    if model.axial_support.is_some() && axial == 0.0 {
        let problem = "says which way axial_stiffness_N_per_mm carries, which is missing";
        return Err(keys.error("axial_support", problem));
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
    (bearing, file): (&PlacedBearing<'_>, &str),
    model: &LinearBearingTable,
    connections: &mut Connections<'_>,
) -> Result<(), InputError> {
    let (name, keys, ends) = (&bearing.table.name, &bearing.keys, &bearing.seat.ends);
    let [radial, axial, tilt] = dampings(model);
    let definition = bearing.definition("model.tangent_of", file)?;
    let (rolling, between) = (
        bearing.rolling(&definition)?,
        connections.bodies.markers(&bearing.seat),
    );
    let at = rolling.ring_markers(between);
    let control = model.control.unwrap_or_default();
    let seat = TangentSeat::new(bearing.number, (at, rolling), control);
    connections.parts.tangents.push(seat);
    let mut found = connections.tangents.iter();
    let Some(tangent) = found.find(|tangent| tangent.bearing == bearing.number) else {
        // On the way to the operating point.
        let rolling = QuasiStaticBearingTable {
            file: file.to_owned(),
            control,
            radial_damping_N_s_per_mm: radial,
            axial_damping_N_s_per_mm: axial,
            tilt_damping_Nm_s_per_rad: tilt,
            element_loads: false,
        };
        return quasi_static::add(bearing, &rolling, connections);
    };
    let diagonal = Vector5::new(PER_MM * radial, PER_MM * radial, PER_MM * axial, tilt, tilt);
    let made = MatrixBearing {
        stiffness: tangent.stiffness,
        damping: Matrix5::from_diagonal(&diagonal),
        at: tangent.at,
        load: tangent.load,
    };
    let made = made.between(name, at).map_err(|e| keys.error("", e))?;
    connections.element((name, KIND), ends, made);
    if definition.friction.is_some() {
        // The torque of the loads that the bearing itself has where the rings stand.
        let (name, damping) = (format!("{name}/friction"), RingDamping::default());
        let element = QuasiStaticElement::new(&name, between, &definition, control, damping);
        let mut element = element
            .map_err(|e| keys.error("model", e))?
            .friction_alone();
        if connections.at_rest {
            element = element.without_friction_torque();
        }
        connections.element((&name, "bearing friction"), ends, element);
    }
    Ok(())
}
