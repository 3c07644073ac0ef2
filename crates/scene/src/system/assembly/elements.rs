//! `[[load]]`, `[[spring]]`, `[[torsion_spring]]`, `[[bushing]]` and `[[python_element]]` to force elements;
//! `bearings/` has those of `[[bearing]]`.

use gearmesh_dynamics::elements::{
    AppliedLoad, Axes, Bushing, HostElement, LoadKind, SpringDamper, TorsionSpring,
};
use gearmesh_dynamics::{BodyId, MarkerPair, TimeFunction};
use gearmesh_geometry::InputError;
use gearmesh_geometry::given;
use gearmesh_geometry::input::{Beside, TableKeys};
use gearmesh_specification::gear_tables::MM;
use gearmesh_specification::system::connection::{SpringTable, StiffnessTable};
use gearmesh_specification::system::function::{Sources, product};
use gearmesh_specification::system::load::{AxesWord, LoadTable};
use nalgebra::{Matrix6, Vector3};

use super::bearings;
use super::bodies::{Bodies, Frame, direction};
use super::connections::Connections;
use super::stiffness::refuse_rigid;

/// N/mm in N/m, N·s/mm in N·s/m.
pub(super) const PER_MM: f64 = 1e3;

/// Adds all of them; loads are multiplied by `load_factor`.
pub(super) fn add(
    load_factor: f64,
    sources: Sources<'_>,
    connections: &mut Connections<'_>,
) -> Result<(), InputError> {
    let (tables, bodies) = (&connections.scene.tables, connections.bodies);
    for (i, table) in tables.load.iter().enumerate() {
        let keys = connections.keys("load", i);
        let body = Some(bodies.find_body(&keys, "body", &table.body)?);
        let element = load(table, &keys, (sources, load_factor), bodies.id(body))?;
        connections.element((&table.name(), "load"), &[body], element);
    }
    let mut notes = Vec::new();
    for (i, table) in tables.spring.iter().enumerate() {
        let keys = connections.keys("spring", i);
        let ends = bodies.find_pair(&keys, table.body_1.as_deref(), &table.body_2)?;
        let stiffness = table.stiffness_N_per_mm;
        refuse_rigid(&keys, &[("stiffness_N_per_mm", stiffness, PER_MM)])?;
        let (spring, pair) = spring(table, bodies, ends, &mut notes);
        let element = spring.between(&table.name, pair);
        let element = element.map_err(|e| keys.error("", e))?;
        connections.element((&table.name, "spring"), &ends, element);
    }
    connections.parts.notes.append(&mut notes);
    for (i, table) in tables.torsion_spring.iter().enumerate() {
        let keys = connections.keys("torsion_spring", i);
        let seat = bodies.seat(&keys, (&table.body_1, &table.body_2), (None, table.axis))?;
        let stiffness = table.stiffness_Nm_per_rad;
        refuse_rigid(&keys, &[("stiffness_Nm_per_rad", stiffness, 1.0)])?;
        let mut spring = TorsionSpring::new(stiffness, table.damping_Nm_s_per_rad);
        spring.free_angle_rad = table.free_angle_deg.to_radians();
        let element = spring.between(&table.name, bodies.markers(&seat));
        let element = element.map_err(|e| keys.error("", e))?;
        connections.element((&table.name, "torsion spring"), &seat.ends, element);
    }
    for (i, Beside(stiffness, table)) in tables.bushing.iter().enumerate() {
        let keys = connections.keys("bushing", i);
        let (on, at) = ((&table.body_1, &*table.body_2), (table.at_mm, table.axis));
        let seat = bodies.seat(&keys, on, at)?;
        let element = bushing(stiffness, &keys)?.between(&table.name, bodies.markers(&seat));
        let element = element.map_err(|e| keys.error("", e))?;
        connections.element((&table.name, "bushing"), &seat.ends, element);
    }
    for (i, table) in tables.python_element.iter().enumerate() {
        let keys = connections.keys("python_element", i);
        let (on, at) = ((&table.body_1, &*table.body_2), (table.at_mm, table.axis));
        let seat = bodies.seat(&keys, on, at)?;
        let law = sources.host.law(&table.function);
        let law = law.map_err(|problem| keys.error("function", problem))?;
        let element = HostElement::new(&table.name, bodies.markers(&seat), law);
        connections.element((&table.name, "Python element"), &seat.ends, element);
    }
    bearings::add(connections)
}

fn load(
    table: &LoadTable,
    keys: &TableKeys<'_>,
    (sources, factor): (Sources<'_>, f64),
    body: BodyId,
) -> Result<AppliedLoad, InputError> {
    let (key, function, kind) = match (&table.torque_Nm, &table.force_N) {
        (Some(torque), None) => {
            if table.at_mm.is_some() {
                return Err(keys.error("at_mm", "is not used by a torque; remove it"));
            }
            ("torque_Nm", torque, LoadKind::Torque)
        }
        (None, Some(force)) => {
            let point_m = table.at_mm.unwrap_or_default().map(|x| MM * x);
            ("force_N", force, LoadKind::Force { point_m })
        }
        (Some(_), Some(_)) => {
            let problem = "is given together with torque_Nm; make it two loads";
            return Err(keys.error("force_N", problem));
        }
        (None, None) => {
            return Err(keys.error("torque_Nm", "missing; a load needs torque_Nm or force_N"));
        }
    };
    let mut magnitude = function.function(keys, key, 1.0, sources)?;
    if factor != 1.0 {
        magnitude = product(TimeFunction::Constant(factor), magnitude);
    }
    let along = match (table.along, table.axes, kind) {
        (Some(along), axes, _) => {
            let axes = match axes.unwrap_or_default() {
                AxesWord::World => Axes::World,
                AxesWord::Body => Axes::Body,
            };
            (axes, direction(keys, "along", along)?.into())
        }
        (None, Some(_), _) => {
            return Err(keys.error("axes", "is given without `along`, whose axes it states"));
        }
        (None, None, LoadKind::Torque) => (Axes::Body, [0.0, 0.0, 1.0]),
        (None, None, LoadKind::Force { .. }) => {
            return Err(keys.error("along", "missing; a force needs a direction"));
        }
    };
    AppliedLoad::new(&table.name(), body, kind, along, magnitude).map_err(|e| keys.error("", e))
}

fn spring(
    table: &SpringTable,
    bodies: &Bodies,
    ends: [Option<usize>; 2],
    notes: &mut Vec<String>,
) -> (SpringDamper, MarkerPair) {
    let first = MM * Vector3::from(table.at_1_mm);
    let second = match table.at_2_mm {
        Some(at) => MM * Vector3::from(at),
        None => bodies.frame(ends[1]).origin_m,
    };
    let marker = |end: Option<usize>, origin_m: Vector3<f64>| {
        let axes = bodies.frame(end).axes;
        bodies.marker(end, &Frame { origin_m, axes })
    };
    let spring = SpringDamper {
        stiffness_n_per_m: PER_MM * table.stiffness_N_per_mm,
        damping_n_s_per_m: PER_MM * table.damping_N_s_per_mm,
        free_length_m: table
            .free_length_mm
            .map_or((second - first).norm(), |length| MM * length),
    };
    if (second - first).norm() == 0.0 && spring.stiffness_n_per_m > 0.0 {
        let name = &table.name;
        notes.push(format!(
            "spring `{name}`: its ends stand in one place at the start, where a force along their line has no direction; it pulls only once they have come \
             apart. A [[bushing]] holds two places together in every direction"
        ));
    }
    let pair = MarkerPair {
        a: marker(ends[0], first),
        b: marker(ends[1], second),
    };
    (spring, pair)
}

pub(super) fn bushing(table: &StiffnessTable, keys: &TableKeys<'_>) -> Result<Bushing, InputError> {
    let along = table.stiffness_N_per_mm.unwrap_or_default();
    let about = table.stiffness_Nm_per_rad.unwrap_or_default();
    let matrix = table.stiffness_matrix_SI.unwrap_or_default();
    for i in 0..3 {
        let diagonals = [
            (&*format!("stiffness_N_per_mm.{i}"), along[i], PER_MM),
            (&*format!("stiffness_Nm_per_rad.{i}"), about[i], 1.0),
        ];
        refuse_rigid(keys, &diagonals)?;
    }
    for (i, row) in matrix.iter().enumerate() {
        for (j, entry) in row.iter().enumerate() {
            let key = format!("stiffness_matrix_SI.{i}.{j}");
            refuse_rigid(keys, &[(&key, *entry, 1.0)])?;
        }
    }
    let diagonals = given!(table; stiffness_N_per_mm, stiffness_Nm_per_rad, damping_N_s_per_mm, damping_Nm_s_per_rad);
    if let Some(stiffness) = &table.stiffness_matrix_SI {
        let problem = "is given together with stiffness_matrix_SI; remove one of the two";
        keys.refuse(&diagonals, problem)?;
        let matrix = |rows: &[[f64; 6]; 6]| Matrix6::from_fn(|i, j| rows[i][j]);
        return Ok(Bushing {
            stiffness: matrix(stiffness),
            damping: table
                .damping_matrix_SI
                .as_ref()
                .map_or_else(Matrix6::zeros, matrix),
            free_displacement_m: Vector3::zeros(),
        });
    }
    let problem = "is given without stiffness_matrix_SI; give both, or the diagonals";
    keys.refuse(&given!(table; damping_matrix_SI), problem)?;
    if !diagonals[0].1 && !diagonals[1].1 {
        let problem =
            "missing; a bushing needs a stiffness, as diagonals or as stiffness_matrix_SI";
        return Err(keys.error("stiffness_N_per_mm", problem));
    }
    let six = |along: Option<[f64; 3]>, about: Option<[f64; 3]>| {
        let (a, b) = (
            along.unwrap_or_default().map(|value| PER_MM * value),
            about.unwrap_or_default(),
        );
        [a[0], a[1], a[2], b[0], b[1], b[2]]
    };
    Ok(Bushing::diagonal(
        six(table.stiffness_N_per_mm, table.stiffness_Nm_per_rad),
        six(table.damping_N_s_per_mm, table.damping_Nm_s_per_rad),
    ))
}
