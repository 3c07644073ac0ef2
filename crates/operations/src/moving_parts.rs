//! Shafts, bearings and bodies of a multibody result where its rows have them, as JSON for pictures that move.

use std::collections::BTreeMap;

use gearmesh_scene::system::{GearState, MovingElements, MovingParts, PartShape};
use gearmesh_scene::system_run::SystemResult;
use serde_json::{Value, json};

use crate::failure::{Failure, Result};

/// Micrometres: finer than a picture.
pub fn rounded_mm(x_m: f64) -> f64 {
    (1e6 * x_m).round() / 1e3
}

/// Rotation (by rows) and origin of a body.
pub fn place(rotation: &[[f64; 3]; 3], origin_m: &[f64; 3]) -> Value {
    let rotation: Vec<f64> = rotation
        .iter()
        .flatten()
        .map(|x| (1e7 * x).round() / 1e7)
        .collect();
    json!({"rotation": rotation, "origin_mm": origin_m.map(rounded_mm)})
}

/// How the balls or rollers of a row go round.
#[derive(Debug, Clone)]
enum Angles {
    /// Each by itself: a column of each.
    Recorded(Vec<Vec<f64>>),
    /// All by pure rolling: turn of the cage against the outer ring.
    Rolling(Vec<f64>),
}

/// Parts whose bodies the result has recorded, with the columns that move them.
#[derive(Debug)]
pub struct PartsInMotion {
    parts: MovingParts,
    /// Bodies that carry something.
    carriers: Vec<String>,
    /// `[carrier][column][row]`.
    states: Vec<Vec<Vec<f64>>>,
    angles: Vec<Angles>,
    /// Of each row of balls or rollers `[element][row]`, where their loads are recorded \[N\].
    loads_n: Vec<Option<Vec<Vec<f64>>>>,
}

impl PartsInMotion {
    /// Reads what moves the parts; a part whose body was not recorded is left out.
    ///
    /// # Errors
    /// [`Failure`] for a result that cannot be read.
    pub fn new(parts: &MovingParts, result: &SystemResult) -> Result<Self> {
        let names: Vec<&str> = result.rows.columns().iter().map(|c| &*c.name).collect();
        let is_recorded = |body: &Option<String>| match body {
            None => true,
            Some(body) => {
                let columns = GearState::columns(body);
                columns[..6].iter().all(|name| names.contains(&&**name))
            }
        };
        let mut parts = parts.clone();
        parts.parts.retain(|part| is_recorded(&part.body));
        parts.elements.retain(|row| is_recorded(&row.outer));
        let read = |name: &str| result.rows.read(name).map_err(Failure::input);
        let carriers = carriers_of(&parts);
        let state = |body: &String| -> Result<Vec<Vec<f64>>> {
            let columns = GearState::columns(body);
            columns[..6].iter().map(|name| read(name)).collect()
        };
        let states = carriers.iter().map(state).collect::<Result<_, _>>()?;
        let count = result.rows.rows();
        let mut turns: BTreeMap<String, Vec<f64>> = BTreeMap::new();
        let recorded = |columns: &[String]| -> Result<Option<Vec<Vec<f64>>>> {
            let all = columns.iter().all(|name| names.contains(&&**name));
            if columns.is_empty() || !all {
                return Ok(None);
            }
            let values = columns.iter().map(|name| read(name));
            Ok(Some(values.collect::<Result<_, _>>()?))
        };
        let mut angles = Vec::new();
        let mut loads_n = Vec::new();
        for row in &parts.elements {
            loads_n.push(recorded(&row.load_columns)?);
            if let Some(columns) = recorded(&row.angle_columns)? {
                angles.push(Angles::Recorded(columns));
                continue;
            }
            let mut cage = vec![0.0; count];
            for (end, turn) in row.turns.iter().enumerate() {
                let Some((column, sense)) = turn else {
                    continue;
                };
                if !names.contains(&&**column) {
                    continue;
                }
                if !turns.contains_key(column) {
                    turns.insert(column.clone(), read(column)?);
                }
                let sign = if end == 1 { 1.0 } else { -1.0 };
                let by = sign * sense * row.outline.cage_share;
                for (cage, turn) in cage.iter_mut().zip(&turns[column]) {
                    *cage += by * turn;
                }
            }
            angles.push(Angles::Rolling(cage));
        }
        Ok(Self {
            parts,
            carriers,
            states,
            angles,
            loads_n,
        })
    }

    /// All parts, moved by nothing.
    pub fn at_start(parts: &MovingParts) -> Self {
        Self {
            carriers: carriers_of(parts),
            states: Vec::new(),
            angles: vec![Angles::Rolling(vec![0.0]); parts.elements.len()],
            loads_n: vec![None; parts.elements.len()],
            parts: parts.clone(),
        }
    }

    /// Bodies that carry something.
    pub fn carriers(&self) -> &[String] {
        &self.carriers
    }

    /// The solids: owner, kind, number of the body that carries them (none: the world), middle, axes, extent.
    pub fn solids(&self) -> Value {
        let solid = |part: &gearmesh_scene::system::MovingPart| {
            let mut described = json!({
                "owner": part.owner,
                "kind": part.kind.name(),
                "carrier": self.carrier(&part.body),
                "place": place(&part.axes, &part.middle_m),
            });
            match part.shape {
                PartShape::Tube { radii_m, length_m } => {
                    described["radii_mm"] = json!(radii_m.map(rounded_mm));
                    described["length_mm"] = json!(rounded_mm(length_m));
                }
                PartShape::Box(edges_m) => {
                    described["edges_mm"] = json!(edges_m.map(rounded_mm));
                }
            }
            described
        };
        self.parts.parts.iter().map(solid).collect()
    }

    /// The rows of balls or rollers.
    pub fn elements(&self) -> Value {
        let row = |row: &MovingElements| {
            let outline = row.outline;
            json!({
                "owner": row.bearing,
                "carrier": self.carrier(&row.outer),
                "place": place(&row.axes, &row.middle_m),
                "count": row.count,
                "diameter_mm": rounded_mm(outline.diameter_m),
                "length_mm": outline.length_m.map(rounded_mm),
                "tilt_rad": outline.tilt_rad,
                "pitch_radius_mm": rounded_mm(outline.pitch_radius_m),
                "height_mm": rounded_mm(outline.middle_z_m),
            })
        };
        self.parts.elements.iter().map(row).collect()
    }

    /// Where the bodies are.
    pub fn places(&self, row: usize) -> Value {
        let placed = |columns: &Vec<Vec<f64>>| {
            let values: Vec<f64> = columns.iter().map(|column| column[row]).collect();
            let state = GearState::from_values(&values);
            place(&state.rotation(), &state.position_m)
        };
        self.states.iter().map(placed).collect()
    }

    /// Of each row the angles of its balls or rollers in the frame of the outer ring.
    pub fn angles_rad(&self, row: usize) -> Value {
        let of_row = |(elements, angles): (&MovingElements, &Angles)| -> Value {
            match angles {
                Angles::Recorded(columns) => {
                    columns.iter().map(|column| json!(column[row])).collect()
                }
                Angles::Rolling(cage) => {
                    let step = std::f64::consts::TAU / elements.count as f64;
                    let first = elements.outline.first_angle_rad + cage[row];
                    (0..elements.count)
                        .map(|k| json!(first + step * k as f64))
                        .collect()
                }
            }
        };
        self.parts
            .elements
            .iter()
            .zip(&self.angles)
            .map(of_row)
            .collect()
    }

    /// Of each row the loads of its balls or rollers at the outer race, null where they are not recorded \[N\].
    pub fn loads_n(&self, row: usize) -> Value {
        let of_row = |columns: &Option<Vec<Vec<f64>>>| {
            let columns = columns.as_ref()?;
            let loads = columns.iter().map(|column| column[row]);
            Some(loads.collect::<Vec<f64>>())
        };
        self.loads_n
            .iter()
            .map(|columns| json!(of_row(columns)))
            .collect()
    }

    fn carrier(&self, body: &Option<String>) -> Option<usize> {
        let body = body.as_ref()?;
        self.carriers.iter().position(|name| name == body)
    }
}

/// Bodies that carry something, each once.
fn carriers_of(parts: &MovingParts) -> Vec<String> {
    let solids = parts.parts.iter().filter_map(|part| part.body.as_ref());
    let rings = parts.elements.iter().filter_map(|row| row.outer.as_ref());
    let mut carriers: Vec<String> = solids.chain(rings).cloned().collect();
    carriers.sort();
    carriers.dedup();
    carriers
}
