//! A force or a torque on one body as a function of time.

use nalgebra::{Matrix3, Vector3};

use super::{ForceElement, Loads, Power, View};
use crate::body::BodyId;
use crate::error::{DynamicsError, ElementFailure};
use crate::rotation::skew;
use crate::time_function::TimeFunction;

/// In which axes the direction of a load stands still.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Axes {
    /// The world's.
    World,
    /// The body's: the load turns with it.
    Body,
}

/// What is applied.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LoadKind {
    /// A force \[N\] in a point of the body (body axes, from the reference point, m).
    Force {
        /// The point.
        point_m: [f64; 3],
    },
    /// A torque \[N·m\].
    Torque,
}

/// magnitude(t) · direction, on one body.
#[derive(Debug, Clone)]
pub struct AppliedLoad {
    name: String,
    body: [BodyId; 1],
    kind: LoadKind,
    axes: Axes,
    direction: Vector3<f64>,
    magnitude: TimeFunction,
}

impl AppliedLoad {
    /// A load along `direction`, which is scaled to length 1.
    ///
    /// # Errors
    /// [`DynamicsError::Value`] if the direction has no length.
    pub fn new(
        name: &str,
        body: BodyId,
        kind: LoadKind,
        (axes, direction): (Axes, [f64; 3]),
        magnitude: TimeFunction,
    ) -> Result<Self, DynamicsError> {
        let direction = Vector3::from(direction);
        let length = direction.norm();
        DynamicsError::positive(
            format!("force element `{name}`"),
            "length of the direction",
            length,
        )?;
        Ok(Self {
            name: name.to_owned(),
            body: [body],
            kind,
            axes,
            direction: direction / length,
            magnitude,
        })
    }
}

impl ForceElement for AppliedLoad {
    fn name(&self) -> &str {
        &self.name
    }

    fn bodies(&self) -> &[BodyId] {
        &self.body
    }

    fn evaluate(&mut self, view: &View<'_>, loads: &mut Loads) -> Result<(), ElementFailure> {
        let motion = view.body(self.body[0]);
        let magnitude = self.magnitude.at(view.time_s).value;
        if !magnitude.is_finite() {
            return Err(format!("its function gave {magnitude}").into());
        }
        let load = view.load_factor * magnitude * self.direction;
        let (world, own) = match self.axes {
            Axes::World => (load, motion.rotation.transpose() * load),
            Axes::Body => (motion.rotation * load, load),
        };
        // δ(load in body axes) = own × δψ where the world holds it; nothing where the body does.
        let turned = match self.axes {
            Axes::World => skew(&own),
            Axes::Body => Matrix3::zeros(),
        };
        match self.kind {
            LoadKind::Force { point_m } => {
                let point = Vector3::from(point_m);
                loads.add_force(0, world.as_slice());
                loads.add_force(3, point.cross(&own).as_slice());
                let spin = motion.angular_velocity_rad_per_s.cross(&point);
                loads.power.supplied_w = world.dot(&motion.velocity_m_per_s) + own.dot(&spin);
                if loads.wants_tangents() {
                    loads.add_block_by_position(3, 3, &(skew(&point) * turned));
                    if self.axes == Axes::Body {
                        loads.add_block_by_position(0, 3, &(-motion.rotation * skew(&load)));
                    }
                }
            }
            LoadKind::Torque => {
                loads.add_force(3, own.as_slice());
                loads.power = Power {
                    supplied_w: own.dot(&motion.angular_velocity_rad_per_s),
                    ..Power::default()
                };
                if loads.wants_tangents() {
                    loads.add_block_by_position(3, 3, &turned);
                }
            }
        }
        Ok(())
    }
}
