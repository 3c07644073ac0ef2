//! `[[joint]]` and `[[motion]]` to joints.

use std::f64::consts::TAU;
use std::path::Path;

use gearmesh_dynamics::{Joint, JointKind, Motion, SystemBuilder, TimeFunction};
use gearmesh_geometry::InputError;
use gearmesh_geometry::input::{InputDocument, TableKeys};

use super::bodies::{Bodies, Frame};
use super::parts::Parts;
use crate::system::names;
use crate::system::tables::MM;
use crate::system::tables::joint::{JointTable, JointWord, MotionTable};

/// What a motion drives.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Driven {
    Angle,
    Place,
}

/// A joint's bodies and its frame at the start.
pub(super) struct PlacedJoint<'a> {
    pub table: &'a JointTable,
    pub ends: [Option<usize>; 2],
    pub frame: Frame,
}

/// Finds the bodies and frames of all joints.
pub(super) fn place<'a>(
    tables: &'a [JointTable],
    document: &InputDocument,
    bodies: &Bodies,
) -> Result<Vec<PlacedJoint<'a>>, InputError> {
    let each = tables.iter().enumerate().map(|(i, table)| {
        let key = format!("joint.{i}");
        let keys = TableKeys::new(document, &key);
        if matches!(table.kind, JointWord::Fixed | JointWord::Spherical) && table.axis.is_some() {
            return Err(keys.error(
                "axis",
                format!("is not used by kind = \"{}\"; remove it", table.kind.name()),
            ));
        }
        let ends = bodies.find_pair(&keys, table.body_1.as_deref(), &table.body_2)?;
        let frame = bodies.stated_frame(&keys, ends[1], table.at_mm, table.axis)?;
        Ok(PlacedJoint { table, ends, frame })
    });
    each.collect()
}

/// Adds the joints.
pub(super) fn add_joints(
    placed: &[PlacedJoint<'_>],
    document: &InputDocument,
    bodies: &Bodies,
    builder: &mut SystemBuilder,
    parts: &mut Parts,
) -> Result<(), InputError> {
    for (i, joint) in placed.iter().enumerate() {
        let key = format!("joint.{i}");
        let kind = match joint.table.kind {
            JointWord::Fixed => JointKind::Fixed,
            JointWord::Revolute => JointKind::Revolute,
            JointWord::Prismatic => JointKind::Prismatic,
            JointWord::Cylindrical => JointKind::Cylindrical,
            JointWord::Spherical => JointKind::Spherical,
            JointWord::Planar => JointKind::Planar,
        };
        let [a, b] = joint.ends.map(|end| bodies.marker(end, &joint.frame));
        let made = Joint::new(&joint.table.name, kind, a, b);
        builder.joint(made.map_err(|e| TableKeys::new(document, &key).error("", e))?);
        parts.joint(
            &joint.table.name,
            joint.table.kind.name(),
            bodies,
            joint.ends,
        );
    }
    Ok(())
}

/// A motion with its joint.
pub(super) struct PlacedMotion {
    name: String,
    key: String,
    /// Number of its joint.
    pub joint: usize,
    driven: Driven,
    motion: Motion,
}

impl PlacedMotion {
    /// Speed about the joint's axis at t = 0 \[rad/s\], where the angle is driven.
    pub(super) fn spin_at_start(&self) -> Option<f64> {
        match (&self.motion, self.driven) {
            (_, Driven::Place) => None,
            (Motion::Speed(f), Driven::Angle) => Some(f.at(0.0).value),
            (Motion::Position(f), Driven::Angle) => Some(f.at(0.0).rate),
        }
    }

    /// Takes another function, of the same kind of coordinate.
    fn vary(&mut self, motion: &Motion) {
        self.motion = motion.clone();
    }
}

/// Reads all motions; `varied` replaces the functions of those it names.
pub(super) fn motions(
    tables: &[MotionTable],
    (document, folder): (&InputDocument, &Path),
    joints: &[PlacedJoint<'_>],
    varied: &[(String, Motion)],
) -> Result<Vec<PlacedMotion>, InputError> {
    let mut placed: Vec<PlacedMotion> = Vec::new();
    for (i, table) in tables.iter().enumerate() {
        let key = format!("motion.{i}");
        let keys = TableKeys::new(document, &key);
        let position = joints
            .iter()
            .position(|joint| joint.table.name == table.joint);
        let joint = position.ok_or_else(|| {
            let known: Vec<&str> = joints
                .iter()
                .map(|joint| joint.table.name.as_str())
                .collect();
            keys.error("joint", names::unknown("joint", &table.joint, &known))
        })?;
        let (driven, motion) = function(table, &keys, folder)?;
        let word = joints[joint].table.kind;
        let fits = match driven {
            Driven::Angle => matches!(
                word,
                JointWord::Revolute | JointWord::Cylindrical | JointWord::Planar
            ),
            Driven::Place => matches!(word, JointWord::Prismatic | JointWord::Cylindrical),
        };
        if !fits {
            let what = if driven == Driven::Angle {
                "turn about"
            } else {
                "slide along"
            };
            return Err(keys.error(
                "joint",
                format!(
                    "`{}` is {}, which does not {what} its axis",
                    table.joint,
                    word.name()
                ),
            ));
        }
        if let Some(earlier) = placed
            .iter()
            .find(|other| other.joint == joint && other.driven == driven)
        {
            return Err(keys.error(
                "joint",
                format!(
                    "`{}` is driven by `{}` already; remove one of the two",
                    table.joint, earlier.name
                ),
            ));
        }
        let mut motion = PlacedMotion {
            name: table.name(),
            key,
            joint,
            driven,
            motion,
        };
        if let Some((_, other)) = varied.iter().find(|(name, _)| *name == motion.name) {
            motion.vary(other);
        }
        placed.push(motion);
    }
    Ok(placed)
}

/// The one function that a motion states.
fn function(
    table: &MotionTable,
    keys: &TableKeys<'_>,
    folder: &Path,
) -> Result<(Driven, Motion), InputError> {
    type Wrap = fn(TimeFunction) -> Motion;
    let stated: Vec<_> = [
        (
            "angle_deg",
            &table.angle_deg,
            Driven::Angle,
            TAU / 360.0,
            Motion::Position as Wrap,
        ),
        (
            "speed_rpm",
            &table.speed_rpm,
            Driven::Angle,
            TAU / 60.0,
            Motion::Speed as Wrap,
        ),
        (
            "position_mm",
            &table.position_mm,
            Driven::Place,
            MM,
            Motion::Position as Wrap,
        ),
        (
            "speed_mm_per_s",
            &table.speed_mm_per_s,
            Driven::Place,
            MM,
            Motion::Speed as Wrap,
        ),
    ]
    .into_iter()
    .filter_map(|(key, function, driven, unit, wrap)| {
        function.as_ref().map(|f| (key, f, driven, unit, wrap))
    })
    .collect();
    match stated[..] {
        [(key, function, driven, unit, wrap)] => {
            Ok((driven, wrap(function.function(keys, key, unit, folder)?)))
        }
        _ => Err(keys.error(
            stated.get(1).map_or("", |second| second.0),
            "a motion states exactly one of angle_deg, speed_rpm, position_mm, speed_mm_per_s",
        )),
    }
}

/// Adds the motions.
pub(super) fn add_motions(
    placed: &[PlacedMotion],
    joints: &[PlacedJoint<'_>],
    document: &InputDocument,
    bodies: &Bodies,
    builder: &mut SystemBuilder,
    parts: &mut Parts,
) -> Result<(), InputError> {
    for motion in placed {
        let joint = &joints[motion.joint];
        let kind = match motion.driven {
            Driven::Angle => JointKind::Rotation(motion.motion.clone()),
            Driven::Place => JointKind::Translation(motion.motion.clone()),
        };
        let [a, b] = joint.ends.map(|end| bodies.marker(end, &joint.frame));
        let made = Joint::new(&motion.name, kind, a, b);
        builder.joint(made.map_err(|e| TableKeys::new(document, &motion.key).error("", e))?);
        parts.joint(&motion.name, "motion", bodies, joint.ends);
    }
    Ok(())
}
