//! `[[joint]]` and `[[motion]]` to joints.

use std::f64::consts::TAU;

use gearmesh_dynamics::{JointKind, Motion, TimeFunction};
use gearmesh_geometry::InputError;
use gearmesh_geometry::input::{InputDocument, TableKeys};
use gearmesh_specification::gear_tables::MM;
use gearmesh_specification::names::unknown;
use gearmesh_specification::system::function::Sources;
use gearmesh_specification::system::joint::{JointTable, JointWord, MotionTable};
use gearmesh_specification::system::run::Run;

use super::bodies::{Bodies, Seat};
use super::connections::Connections;

/// What a motion drives.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Driven {
    Angle,
    Place,
}

/// A joint where it is at the start.
pub(super) struct PlacedJoint<'a> {
    pub table: &'a JointTable,
    pub seat: Seat,
}

/// Finds the bodies and frames of all joints.
pub(super) fn place<'a>(
    tables: &'a [JointTable],
    document: &InputDocument,
    bodies: &Bodies,
) -> Result<Vec<PlacedJoint<'a>>, InputError> {
    let each = tables.iter().enumerate().map(|(i, table)| {
        let keys = TableKeys::new(document, format!("joint.{i}"));
        if matches!(table.kind, JointWord::Fixed | JointWord::Spherical) && table.axis.is_some() {
            let problem = format!("is not used by kind = \"{}\"; remove it", table.kind.name());
            return Err(keys.error("axis", problem));
        }
        let (on, at) = ((&table.body_1, &*table.body_2), (table.at_mm, table.axis));
        let seat = bodies.seat(&keys, on, at)?;
        Ok(PlacedJoint { table, seat })
    });
    each.collect()
}

/// Adds the joints.
pub(super) fn add_joints(
    placed: &[PlacedJoint<'_>],
    connections: &mut Connections<'_>,
) -> Result<(), InputError> {
    for (i, PlacedJoint { table, seat }) in placed.iter().enumerate() {
        let kind = match table.kind {
            JointWord::Fixed => JointKind::Fixed,
            JointWord::Revolute => JointKind::Revolute,
            JointWord::Prismatic => JointKind::Prismatic,
            JointWord::Cylindrical => JointKind::Cylindrical,
            JointWord::Spherical => JointKind::Spherical,
            JointWord::Planar => JointKind::Planar,
        };
        let keys = connections.keys("joint", i);
        connections.joint(&keys, (&table.name, table.kind.name()), seat, kind)?;
    }
    Ok(())
}

/// How often a function is looked at for its fastest speed.
const LOOKS: u32 = 1000;

/// Share by which a steady speed may change: a thousand periods later a line is a thousandth of a period off.
const STEADY: f64 = 1e-6;

/// A motion with its joint.
pub(super) struct PlacedMotion {
    name: String,
    /// Number of its joint.
    pub joint: usize,
    driven: Driven,
    motion: Motion,
    /// Of a static series: the speed that the scene states \[rad/s\], whichever way the first angle lies.
    stated_spin: Option<f64>,
}

impl PlacedMotion {
    /// Name of the motion.
    pub(super) fn name(&self) -> &str {
        &self.name
    }

    /// Speed about the joint's axis at t = 0 \[rad/s\], where the angle is driven.
    pub(super) fn spin_at_start(&self) -> Option<f64> {
        if self.stated_spin.is_some() {
            return self.stated_spin;
        }
        self.spin_at(0.0)
    }

    /// Speed about the joint's axis at a time \[rad/s\], where the angle is driven.
    fn spin_at(&self, time_s: f64) -> Option<f64> {
        match (&self.motion, self.driven) {
            (_, Driven::Place) => None,
            (Motion::Speed(f), Driven::Angle) => Some(f.at(time_s).value),
            (Motion::Position(f), Driven::Angle) => Some(f.at(time_s).rate),
        }
    }

    /// The fastest speed about the joint's axis in a run that steps through time \[rad/s\], where the angle is driven:
    /// that of the values which the run gives the motion, or the largest of its function, looked at often. Of
    /// the motion of a static series it is 1 rad/s.
    pub(super) fn fastest_spin(&self, run: &Run) -> Option<f64> {
        let at = |time_s: f64| self.spin_at(time_s);
        let varied = run.varied_motion() == Some(&self.name);
        let stated: Vec<f64> = match run {
            Run::SpeedSweep(sweep) if varied => vec![sweep.from_rad_per_s, sweep.to_rad_per_s],
            Run::Eigen {
                speeds_rad_per_s: Some(speeds),
                ..
            } if varied => speeds.values.clone(),
            // What a radian of it is: 1 rad in a second.
            Run::Static { .. } if varied => vec![1.0],
            _ => {
                let end_s = run.simulated_s().unwrap_or(0.0);
                let times = (0..=LOOKS).map(|i| end_s * f64::from(i) / f64::from(LOOKS));
                times.map_while(at).collect()
            }
        };
        at(0.0)?;
        let fastest = stated
            .into_iter()
            .max_by(|a, b| a.abs().total_cmp(&b.abs()));
        fastest.filter(|speed| speed.is_finite())
    }

    /// The speed about the joint's axis that the motion has from one time to another \[rad/s\]: none where it drives a
    /// place, not a number where the speed changes by more than [`STEADY`] of itself.
    pub(super) fn steady_spin(&self, [from_s, end_s]: [f64; 2]) -> Option<f64> {
        let at = |time_s: f64| self.spin_at(time_s);
        let last = at(end_s)?;
        let share = |i: u32| f64::from(i) / f64::from(LOOKS);
        let times = (0..LOOKS).map(|i| from_s + (end_s - from_s) * share(i));
        let stays = |spin: f64| (spin - last).abs() <= STEADY * last.abs();
        let steady = times.filter_map(at).all(stays);
        Some(if steady { last } else { f64::NAN })
    }

    /// Takes another function, of the same kind of coordinate: other speeds, or the angles of a static series.
    fn vary(&mut self, motion: &Motion) {
        if matches!(motion, Motion::Position(_)) {
            self.stated_spin = self.spin_at_start().filter(|spin| *spin != 0.0);
        }
        self.motion = motion.clone();
    }
}

/// Reads all motions; `varied` replaces the functions of those it names.
pub(super) fn motions(
    tables: &[MotionTable],
    (document, sources): (&InputDocument, Sources<'_>),
    joints: &[PlacedJoint<'_>],
    varied: &[(String, Motion)],
) -> Result<Vec<PlacedMotion>, InputError> {
    let mut placed: Vec<PlacedMotion> = Vec::new();
    for (i, table) in tables.iter().enumerate() {
        let keys = TableKeys::new(document, format!("motion.{i}"));
        let mut known = joints.iter().map(|joint| &joint.table.name);
        let position = known.clone().position(|name| *name == table.joint);
        let joint = position.ok_or_else(|| {
            let known: Vec<&String> = known.by_ref().collect();
            keys.error("joint", unknown("joint", &table.joint, &known))
        })?;
        let (driven, motion) = function(table, &keys, sources)?;
        let word = joints[joint].table.kind;
        let fits = match driven {
            Driven::Angle => matches!(
                word,
                JointWord::Revolute | JointWord::Cylindrical | JointWord::Planar
            ),
            Driven::Place => matches!(word, JointWord::Prismatic | JointWord::Cylindrical),
        };
        if !fits {
            let what = match driven {
                Driven::Angle => "turn about",
                Driven::Place => "slide along",
            };
            let (name, kind) = (&table.joint, word.name());
            let problem = format!("`{name}` is {kind}, which does not {what} its axis");
            return Err(keys.error("joint", problem));
        }
        let is_same = |other: &&PlacedMotion| other.joint == joint && other.driven == driven;
        if let Some(earlier) = placed.iter().find(is_same) {
            let problem = format!(
                "`{}` is driven by `{}` already; remove one of the two",
                table.joint, earlier.name
            );
            return Err(keys.error("joint", problem));
        }
        let mut motion = PlacedMotion {
            name: table.name(),
            joint,
            driven,
            motion,
            stated_spin: None,
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
    sources: Sources<'_>,
) -> Result<(Driven, Motion), InputError> {
    type Wrap = fn(TimeFunction) -> Motion;
    let (position, speed): (Wrap, Wrap) = (Motion::Position, Motion::Speed);
    let (angle, place) = (Driven::Angle, Driven::Place);
    let all = [
        ("angle_deg", &table.angle_deg, angle, TAU / 360.0, position),
        ("speed_rpm", &table.speed_rpm, angle, TAU / 60.0, speed),
        ("position_mm", &table.position_mm, place, MM, position),
        ("speed_mm_per_s", &table.speed_mm_per_s, place, MM, speed),
    ];
    let stated = all
        .into_iter()
        .filter_map(|(key, function, driven, unit, wrap)| {
            function.as_ref().map(|f| (key, f, driven, unit, wrap))
        });
    let stated: Vec<_> = stated.collect();
    match stated[..] {
        [(key, function, driven, unit, wrap)] => {
            let motion = wrap(function.function(keys, key, unit, sources)?);
            demand_motion(&motion).map_err(|problem| keys.error(key, problem))?;
            Ok((driven, motion))
        }
        _ => Err(keys.error(
            stated.get(1).map_or("", |second| second.0),
            "a motion states exactly one of angle_deg, speed_rpm, position_mm, speed_mm_per_s",
        )),
    }
}

/// What only functions of the calling program can lack.
fn demand_motion(motion: &Motion) -> Result<(), String> {
    match motion {
        Motion::Speed(speed) if speed.integral(0.0).is_none() => Err(
            "is a product of functions or a Python function, whose integral is not known; state angle_deg or position_mm"
                .to_owned(),
        ),
        Motion::Speed(_) => Ok(()),
        Motion::Position(place) => {
            let start = place.at(0.0);
            let parts = [start.value, start.rate, start.acceleration];
            if parts.iter().all(|part| part.is_finite()) {
                return Ok(());
            }
            Err(format!(
                "is {parts:?} with its rate and acceleration at t = 0, which must be finite: the Python function of a motion returns (value, rate, acceleration)"
            ))
        }
    }
}

/// Adds the motions.
pub(super) fn add_motions(
    placed: &[PlacedMotion],
    joints: &[PlacedJoint<'_>],
    connections: &mut Connections<'_>,
) -> Result<(), InputError> {
    for (i, placed) in placed.iter().enumerate() {
        let kind = match placed.driven {
            Driven::Angle => JointKind::Rotation(placed.motion.clone()),
            Driven::Place => JointKind::Translation(placed.motion.clone()),
        };
        let keys = connections.keys("motion", i);
        let seat = &joints[placed.joint].seat;
        connections.joint(&keys, (&placed.name, "motion"), seat, kind)?;
    }
    Ok(())
}
