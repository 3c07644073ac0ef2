//! What of a machine is drawn beside its gears: sections of shafts, bearings with their balls or rollers, cages, and
//! the bodies of which nothing but the inertia is known.

use gearmesh_bearings::ElementOutline;
use gearmesh_geometry::InputError;
use gearmesh_specification::system::bearing::{BearingModel, BearingTable};
use nalgebra::{UnitQuaternion, Vector3};

use super::bearings::cages::{self, PlacedCage};
use super::bearings::housing;
use super::bearings::placed_bearing::PlacedBearing;
use super::bodies::{Bodies, Frame, Seat};
use super::shafts::PlacedShaft;
use crate::system::names::{body_column, element_column};
use crate::system::scene::SystemScene;

/// Where a ring begins and ends from the pitch circle, as shares of a ball's diameter: for a picture, files state
/// neither.
const RING: [f64; 2] = [0.2, 0.85];
/// Width of a ring over that of its balls or rollers.
const RING_WIDTH: f64 = 1.15;
/// A bearing of which no ball is known, over the radius of its shaft: outside of the ring, and width.
const PLAIN_RING: [f64; 2] = [1.5, 0.8];
/// A cage's height and width over the diameter of its balls.
const CAGE: [f64; 2] = [0.3, 0.9];

/// A solid that a body carries.
#[derive(Debug, Clone, PartialEq)]
pub struct MovingPart {
    /// Whose it is: a shaft, a bearing, a body.
    pub owner: String,
    /// What it is.
    pub kind: PartKind,
    /// Body whose columns place it; none: it stands in the world.
    pub body: Option<String>,
    /// Middle in the body's frame \[m\].
    pub middle_m: [f64; 3],
    /// Axes in the body's frame, columns of the rotation by rows.
    pub axes: [[f64; 3]; 3],
    /// Its extent.
    pub shape: PartShape,
}

/// What a part is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PartKind {
    /// A section of a shaft, or a half of one.
    Shaft,
    /// A ring of a bearing.
    Ring,
    /// A cage.
    Cage,
    /// A body without a shape, drawn by its inertia.
    Body,
}

impl PartKind {
    /// Its word.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Shaft => "shaft",
            Self::Ring => "ring",
            Self::Cage => "cage",
            Self::Body => "body",
        }
    }
}

/// How a part extends about its middle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum PartShape {
    /// A tube about z \[m\].
    Tube {
        /// Inner and outer radius.
        radii_m: [f64; 2],
        /// Length.
        length_m: f64,
    },
    /// The box of even density with the body's mass and moments of inertia: edges \[m\].
    Box([f64; 3]),
}

/// The balls or rollers of a row.
#[derive(Debug, Clone, PartialEq)]
pub struct MovingElements {
    /// Bearing.
    pub bearing: String,
    /// Body of the outer ring, in whose frame they go round; none: the world.
    pub outer: Option<String>,
    /// Middle of the bearing in that frame \[m\].
    pub middle_m: [f64; 3],
    /// Axes of the bearing in that frame, columns of the rotation by rows.
    pub axes: [[f64; 3]; 3],
    /// How many.
    pub count: usize,
    /// Size and circle.
    pub outline: ElementOutline,
    /// Columns of their angles where they move by themselves \[rad\].
    pub angle_columns: Vec<String>,
    /// Columns of their loads at the outer race, where they are recorded \[N\].
    pub load_columns: Vec<String>,
    /// Columns of the turns of the bodies of outer and inner ring, with the sense of the bearing's axis: for pure
    /// rolling, where angles are not recorded.
    pub turns: [Option<(String, f64)>; 2],
}

/// Where a body stands at the start.
#[derive(Debug, Clone, PartialEq)]
pub struct BodyAtStart {
    /// Body.
    pub name: String,
    /// Its reference point, world \[m\].
    pub position_m: [f64; 3],
    /// World from body axes, by rows.
    pub rotation: [[f64; 3]; 3],
    /// Modes of its own.
    pub modes: usize,
}

/// Everything that is drawn.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct MovingParts {
    /// All bodies.
    pub bodies: Vec<BodyAtStart>,
    /// Solids.
    pub parts: Vec<MovingPart>,
    /// Balls and rollers.
    pub elements: Vec<MovingElements>,
}

/// The parts of a scene whose bodies stand as at the start, gears turned as their meshes turn them.
pub(super) fn moving_parts(
    scene: &SystemScene,
    shafts: &[PlacedShaft],
    bodies: &mut Bodies,
) -> Result<MovingParts, InputError> {
    // Bodies that the scene states or its shafts make; what bearings bring comes after them.
    let stated = bodies.list.len();
    housing::place(scene, bodies)?;
    let cages = cages::place(scene, bodies)?;
    let starts = bodies.list.iter().map(|placed| BodyAtStart {
        name: placed.body.name.clone(),
        position_m: placed.body.position_m.into(),
        rotation: rows(placed.body.orientation),
        modes: placed.body.mode_count(),
    });
    let mut found = MovingParts {
        bodies: starts.collect(),
        ..MovingParts::default()
    };
    let mut is_drawn = vec![false; stated];
    for shaft in shafts {
        for (station, frame, radii_m, length_m) in shaft.half_sections() {
            is_drawn[station] = true;
            let shape = PartShape::Tube { radii_m, length_m };
            let whose = (shaft.name(), PartKind::Shaft);
            (found.parts).push(part(bodies, whose, Some(station), &frame, shape));
        }
    }
    for number in 0..scene.tables.bearing.len() {
        let bearing = PlacedBearing::new(scene, number, bodies)?;
        add_bearing(&bearing, &cages, (shafts, bodies), &mut found)?;
    }
    for (number, is_drawn) in is_drawn.into_iter().enumerate() {
        let placed = &bodies.list[number];
        if is_drawn || placed.gear.is_some() {
            continue;
        }
        let body = &placed.body;
        let [x, y, z] = std::array::from_fn(|k| body.inertia_kg_m2[(k, k)]);
        // m (b² + c²)/12 = I_x and so on round.
        let edge = |square: f64| (6.0 * square.max(0.0) / body.mass_kg).sqrt();
        let shape = PartShape::Box([edge(y + z - x), edge(z + x - y), edge(x + y - z)]);
        let mut frame = bodies.frame(Some(number));
        frame.origin_m += frame.axes * body.center_of_mass_m;
        let whose = (&*body.name, PartKind::Body);
        (found.parts).push(part(bodies, whose, Some(number), &frame, shape));
    }
    Ok(found)
}

/// Adds the rings of a bearing, its balls or rollers and its cages.
fn add_bearing(
    bearing: &PlacedBearing<'_>,
    cages: &[PlacedCage],
    (shafts, bodies): (&[PlacedShaft], &Bodies),
    found: &mut MovingParts,
) -> Result<(), InputError> {
    let (table, seat) = (&*bearing.table, &bearing.seat);
    let file = match &table.model {
        BearingModel::Rigid(_) | BearingModel::Linear(_) => {
            let ring = plain_ring(&table.name, seat, shafts, bodies);
            found.parts.extend(ring);
            return Ok(());
        }
        BearingModel::QuasiStatic(model) => &model.file,
        BearingModel::Dynamic(model) => &model.file,
    };
    let made = bearing.rolling(&bearing.definition("model.file", file)?)?;
    let mut before = 0;
    for (row, (count, outline)) in (made.rows.iter())
        .map(|row| (row.elements(), row.outline()))
        .enumerate()
    {
        let frame = seat.frame.raised(outline.middle_z_m);
        let width_m = RING_WIDTH * outline.length_m.unwrap_or(outline.diameter_m);
        for (end, sense) in [(0, 1.0), (1, -1.0)] {
            let mut radii_m =
                RING.map(|share| outline.pitch_radius_m + sense * share * outline.diameter_m);
            radii_m.sort_by(f64::total_cmp);
            let shape = PartShape::Tube {
                radii_m: radii_m.map(|radius| radius.max(0.0)),
                length_m: width_m,
            };
            let whose = (&*table.name, PartKind::Ring);
            (found.parts).push(part(bodies, whose, seat.ends[end], &frame, shape));
        }
        let is_own = |cage: &&PlacedCage| cage.bearing == bearing.number && cage.row == row;
        if let Some(cage) = cages.iter().find(is_own) {
            let [height, width] = CAGE.map(|share| share * outline.diameter_m);
            let shape = PartShape::Tube {
                radii_m: [-0.5, 0.5].map(|share| outline.pitch_radius_m + share * height),
                length_m: width,
            };
            let body = Some(cage.body);
            let whose = (bodies.name(body), PartKind::Cage);
            (found.parts).push(part(bodies, whose, body, &bodies.frame(body), shape));
        }
        (found.elements).push(elements(table, seat, bodies, (before, count), outline));
        before += count;
    }
    Ok(())
}

/// Place and axes of a frame, seen from a body.
fn seen(bodies: &Bodies, body: Option<usize>, frame: &Frame) -> ([f64; 3], [[f64; 3]; 3]) {
    let own = bodies.frame(body);
    let back = own.axes.inverse();
    let middle = back * (frame.origin_m - own.origin_m);
    (middle.into(), rows(back * frame.axes))
}

/// A rotation by rows.
pub(super) fn rows(axes: UnitQuaternion<f64>) -> [[f64; 3]; 3] {
    let matrix = axes.to_rotation_matrix();
    std::array::from_fn(|i| std::array::from_fn(|j| matrix[(i, j)]))
}

fn part(
    bodies: &Bodies,
    (owner, kind): (&str, PartKind),
    body: Option<usize>,
    frame: &Frame,
    shape: PartShape,
) -> MovingPart {
    let (middle_m, axes) = seen(bodies, body, frame);
    MovingPart {
        owner: owner.to_owned(),
        kind,
        body: body.map(|_| bodies.name(body).to_owned()),
        middle_m,
        axes,
        shape,
    }
}

/// The ring of a bearing without balls: about the shaft, or in the bore of the gear, that it carries.
fn plain_ring(
    name: &str,
    at: &Seat,
    shafts: &[PlacedShaft],
    bodies: &Bodies,
) -> Option<MovingPart> {
    let body = at.ends[1]?;
    let along = |frame: &Frame| (frame.origin_m - at.frame.origin_m).norm();
    let sections = shafts.iter().flat_map(PlacedShaft::half_sections);
    let own = sections.filter(|(station, ..)| *station == body);
    let nearest = own.min_by(|(_, a, ..), (_, b, ..)| along(a).total_cmp(&along(b)));
    let gear = bodies.list[body].cylindrical();
    let bore = || Some(gear?.definition.blank.bore_radius_m());
    let radius_m = nearest.map(|(_, _, radii, _)| radii[1]).or_else(bore)?;
    let [outside, width] = PLAIN_RING.map(|share| share * radius_m);
    let shape = PartShape::Tube {
        radii_m: [radius_m, outside],
        length_m: width,
    };
    let whose = (name, PartKind::Ring);
    Some(part(bodies, whose, at.ends[0], &at.frame, shape))
}

fn elements(
    table: &BearingTable,
    at: &Seat,
    bodies: &Bodies,
    (before, count): (usize, usize),
    outline: ElementOutline,
) -> MovingElements {
    let (middle_m, axes) = seen(bodies, at.ends[0], &at.frame);
    // What they are called in columns, where their angles and where their loads are recorded.
    let (word, has_angles, has_loads) = match &table.model {
        BearingModel::Dynamic(model) => ("ball", model.ball_loads, model.ball_loads),
        BearingModel::QuasiStatic(model) => ("element", false, model.element_loads),
        BearingModel::Rigid(_) | BearingModel::Linear(_) => ("", false, false),
    };
    let columns = |is_there: bool, what: &str| -> Vec<String> {
        let numbers = (before + 1..=before + count).filter(|_| is_there);
        let column = |number| element_column(&table.name, &format!("{word}_{number}_{what}"));
        numbers.map(column).collect()
    };
    let turn = |end: Option<usize>| {
        let axis = bodies.list[end?].axis();
        let sense = axis.dot(&(at.frame.axes * Vector3::z()));
        Some((body_column(bodies.name(end), "turn_rad"), sense))
    };
    MovingElements {
        bearing: table.name.clone(),
        outer: at.ends[0].map(|_| bodies.name(at.ends[0]).to_owned()),
        middle_m,
        axes,
        count,
        outline,
        angle_columns: columns(has_angles, "angle_rad"),
        load_columns: columns(has_loads, "outer_N"),
        turns: at.ends.map(turn),
    }
}
