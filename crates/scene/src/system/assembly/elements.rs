//! `[[load]]`, `[[spring]]`, `[[torsion_spring]]`, `[[bushing]]` and `[[python_element]]` to force elements; `bearings/` has those of `[[bearing]]`.

use gearmesh_geometry::given;
use std::path::Path;

use gearmesh_bearings::QuasiStaticElement;
use gearmesh_dynamics::elements::{
    AppliedLoad, Axes, Bushing, ForceElement, HostElement, LoadKind, SpringDamper, TorsionSpring,
};
use gearmesh_dynamics::{DynamicsError, MarkerPair, SystemBuilder, TimeFunction};
use gearmesh_geometry::InputError;
use gearmesh_geometry::input::{InputDocument, TableKeys};
use nalgebra::{Matrix6, Vector3};

use super::bearings::cages::PlacedCage;
use super::bearings::{self, tangent::Tangent};
use super::bodies::{Bodies, Frame, direction};
use super::parts::Parts;
use super::stiffness::refuse_rigid;
use crate::system::scene::SystemTables;
use crate::system::tables::MM;
use crate::system::tables::connection::{BushingTable, SpringTable};
use crate::system::tables::function::Sources;
use crate::system::tables::load::{AxesWord, LoadTable};

/// N/mm in N/m, N·s/mm in N·s/m.
pub(super) const PER_MM: f64 = 1e3;

/// How the elements are to be.
#[derive(Debug, Clone, Copy)]
pub(super) struct Manner<'a> {
    /// Loads are multiplied by it.
    pub load_factor: f64,
    /// Whether balls that move are taken in equilibrium.
    pub at_rest: bool,
    /// Cages that stand among the bodies.
    pub cages: &'a [PlacedCage],
    /// Bearings of which a tangent is taken, where it is known already.
    pub tangents: &'a [Tangent],
}

/// Adds all of them.
pub(super) fn add(
    tables: &SystemTables,
    (document, sources): (&InputDocument, Sources<'_>),
    manner: Manner<'_>,
    bodies: &Bodies,
    builder: &mut SystemBuilder,
    parts: &mut Parts,
) -> Result<Vec<SeatedBearing>, InputError> {
    for (i, table) in tables.load.iter().enumerate() {
        let key = format!("load.{i}");
        let keys = TableKeys::new(document, &key);
        let body = bodies.find_body(&keys, "body", &table.body)?;
        builder.element(load(
            table,
            &keys,
            sources,
            manner.load_factor,
            bodies,
            body,
        )?);
        parts.element_on(&table.name(), "load", bodies, body);
    }
    let mut connections = Connections {
        document,
        folder: sources.folder,
        bodies,
        manner,
        gravity_m_per_s2: tables.gravity_m_per_s2,
        builder,
        parts,
        seated: Vec::new(),
    };
    let mut notes = Vec::new();
    for (i, table) in tables.spring.iter().enumerate() {
        let named = (&*table.name, table.body_1.as_deref(), &*table.body_2);
        connections.add(("spring", i), "spring", named, |keys, ends| {
            refuse_rigid(
                keys,
                &[("stiffness_N_per_mm", table.stiffness_N_per_mm, PER_MM)],
            )?;
            let (spring, pair) = spring(table, bodies, ends, &mut notes);
            Ok(spring.between(&table.name, pair))
        })?;
    }
    connections.parts.notes.append(&mut notes);
    for (i, table) in tables.torsion_spring.iter().enumerate() {
        let named = (&*table.name, table.body_1.as_deref(), &*table.body_2);
        connections.add(
            ("torsion_spring", i),
            "torsion spring",
            named,
            |keys, ends| {
                let frame = bodies.stated_frame(keys, ends[1], None, table.axis)?;
                let stiffness = table.stiffness_Nm_per_rad;
                refuse_rigid(keys, &[("stiffness_Nm_per_rad", stiffness, 1.0)])?;
                let mut spring =
                    TorsionSpring::new(table.stiffness_Nm_per_rad, table.damping_Nm_s_per_rad);
                spring.free_angle_rad = table.free_angle_deg.to_radians();
                Ok(spring.between(&table.name, pair(bodies, ends, &frame)))
            },
        )?;
    }
    for (i, table) in tables.bushing.iter().enumerate() {
        let named = (&*table.name, table.body_1.as_deref(), &*table.body_2);
        connections.add(("bushing", i), "bushing", named, |keys, ends| {
            let frame = bodies.stated_frame(keys, ends[1], table.at_mm, table.axis)?;
            Ok(bushing(table, keys)?.between(&table.name, pair(bodies, ends, &frame)))
        })?;
    }
    for (i, table) in tables.python_element.iter().enumerate() {
        let named = (&*table.name, table.body_1.as_deref(), &*table.body_2);
        let at = ("python_element", i);
        connections.add(at, "Python element", named, |keys, ends| {
            let frame = bodies.stated_frame(keys, ends[1], table.at_mm, table.axis)?;
            let law = sources.host.law(&table.function);
            let law = law.map_err(|problem| keys.error("function", problem))?;
            let between = pair(bodies, ends, &frame);
            Ok(Ok(HostElement::new(&table.name, between, law)))
        })?;
    }
    bearings::add(&tables.bearing, &mut connections)?;
    Ok(connections.seated)
}

/// A bearing whose rollers press on the bore of a gear, left for the meshes of that gear.
pub(super) struct SeatedBearing {
    /// Number of the bearing.
    pub number: usize,
    /// Number of the gear's body.
    pub body: usize,
    pub element: QuasiStaticElement,
}

/// Where elements between two bodies are added.
pub(super) struct Connections<'a> {
    pub document: &'a InputDocument,
    /// Where the files that the scene names are looked for.
    pub folder: &'a Path,
    pub bodies: &'a Bodies,
    pub manner: Manner<'a>,
    /// Acceleration of weight, where the scene has any.
    pub gravity_m_per_s2: Option<[f64; 3]>,
    builder: &'a mut SystemBuilder,
    pub parts: &'a mut Parts,
    /// What is left for meshes.
    pub seated: Vec<SeatedBearing>,
}

impl Connections<'_> {
    /// Adds the element that `make` gives for a table: finds its bodies, points at the table in complaints, notes the
    /// part. `named` holds the names of the element and of its bodies.
    pub(super) fn add<E: ForceElement + 'static>(
        &mut self,
        (list, number): (&str, usize),
        kind: &'static str,
        (name, body_1, body_2): (&str, Option<&str>, &str),
        make: impl FnOnce(
            &TableKeys<'_>,
            [Option<usize>; 2],
        ) -> Result<Result<E, DynamicsError>, InputError>,
    ) -> Result<(), InputError> {
        let key = format!("{list}.{number}");
        let keys = TableKeys::new(self.document, &key);
        let ends = self.bodies.find_pair(&keys, body_1, body_2)?;
        let element = make(&keys, ends)?.map_err(|e| keys.error("", e))?;
        self.builder.element(element);
        self.parts.element(name, kind, self.bodies, ends);
        Ok(())
    }
}

pub(super) fn pair(bodies: &Bodies, ends: [Option<usize>; 2], frame: &Frame) -> MarkerPair {
    let [a, b] = ends.map(|end| bodies.marker(end, frame));
    MarkerPair { a, b }
}

fn load(
    table: &LoadTable,
    keys: &TableKeys<'_>,
    sources: Sources<'_>,
    factor: f64,
    bodies: &Bodies,
    body: usize,
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
            return Err(keys.error(
                "force_N",
                "is given together with torque_Nm; make it two loads",
            ));
        }
        (None, None) => {
            return Err(keys.error("torque_Nm", "missing; a load needs torque_Nm or force_N"));
        }
    };
    let magnitude = function.function(keys, key, 1.0, sources)?;
    let magnitude = if factor == 1.0 {
        magnitude
    } else {
        TimeFunction::Product(
            Box::new(TimeFunction::Constant(factor)),
            Box::new(magnitude),
        )
    };
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
    AppliedLoad::new(&table.name(), bodies.id(Some(body)), kind, along, magnitude)
        .map_err(|e| keys.error("", e))
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

pub(super) fn bushing(table: &BushingTable, keys: &TableKeys<'_>) -> Result<Bushing, InputError> {
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
        return Err(keys.error(
            "stiffness_N_per_mm",
            "missing; a bushing needs a stiffness, as diagonals or as stiffness_matrix_SI",
        ));
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
