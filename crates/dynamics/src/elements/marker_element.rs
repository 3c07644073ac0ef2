//! A force element between two markers: a law gives the load on B from the motion of B as seen in A.
//!
//! ```text
//! load = (f, μ) on B in A axes,   Q = Jᵀ load
//! ∂Q/∂increments = Jᵀ (L_x J + L_v J̇) + geometric tangent,   ∂Q/∂velocities = Jᵀ L_v J
//! ```
//!
//! with L_x = ∂load/∂(u, rotation), L_v = ∂load/∂(u̇, ω) and J̇ the derivative of (u̇, ω) by the increments.

use nalgebra::{DMatrix, SMatrix, SVector};

use super::moving_end::{MovedEnd, MovingEnd};
use super::{Channel, ForceElement, Loads, Power, View};
use crate::body::BodyId;
use crate::error::{DynamicsError, ElementFailure};
use crate::relative_motion::{MarkerPair, PairTangent, RelativeMotion};

/// Load on B, A axes: force \[N\] in the point of B, moment \[N·m\].
pub type PairLoad = SVector<f64, 6>;

/// Derivatives of a [`PairLoad`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LawTangent {
    /// By (u, rotation of B against A, A axes).
    pub by_position: SMatrix<f64, 6, 6>,
    /// By (u̇, ω).
    pub by_velocity: SMatrix<f64, 6, 6>,
}

/// A law between two markers.
pub trait Law: Send {
    /// Load on B and its energy.
    fn load(&self, motion: &RelativeMotion) -> (PairLoad, Power);

    /// Derivatives of the load.
    fn tangent(&self, motion: &RelativeMotion) -> LawTangent;

    /// What the axes of marker A are called in the names of channels, with `_` behind; nothing where they have no name
    /// of their own.
    fn axes(&self) -> &'static str {
        ""
    }

    /// Whether there is any internal state to move on; where there is none, accepted steps cost nothing.
    fn has_state(&self) -> bool {
        false
    }

    /// Internal state begins at this motion.
    fn begin(&mut self, _motion: &RelativeMotion) {}

    /// Internal state moves on.
    fn commit(&mut self, _motion: &RelativeMotion) {}

    /// Appends the internal state.
    fn save(&self, _out: &mut Vec<f64>) {}

    /// Takes what [`Self::save`] wrote.
    fn restore(&mut self, _numbers: &[f64]) {}
}

/// What an element between two markers shows of its load on body 2: force and moment, A axes, and the force in world
/// axes; where A's axes have a name (with `_` behind), the force across z, too. Nine or ten channels.
#[must_use]
pub fn load_channels(axes: &str) -> Vec<Channel> {
    let three = |head: &str, (end, unit), what: &str| {
        ["x", "y", "z"].map(|axis| Channel::new(format!("{head}{axis}_{end}"), unit, what))
    };
    let frame = if axes.is_empty() {
        "axes of the marker of body 1"
    } else {
        "axes of the shaft, which do not turn with it"
    };
    let (force, moment) = (("N", "N"), ("Nm", "N·m"));
    let on_2 = |load: &str| format!("{load} on body 2, {frame}");
    let mut channels = three(&format!("force_{axes}"), force, &on_2("force")).to_vec();
    let what = on_2("moment about the marker");
    channels.extend(three(&format!("moment_{axes}"), moment, &what));
    channels.extend(three("force_world_", force, "force on body 2, world axes"));
    if !axes.is_empty() {
        let what = "amount of the force across the shaft";
        channels.push(Channel::new("force_radial_N", "N", what));
    }
    channels
}

/// A law at its place. Channels: force and moment on B, A axes, and the force in world axes; where A's axes have a
/// name, the force across z, too.
#[derive(Debug, Clone)]
pub struct MarkerElement<L> {
    name: String,
    pair: MarkerPair,
    bodies: [BodyId; 2],
    /// Where an end moves with the modes of its body.
    moving: [Option<MovingEnd>; 2],
    law: L,
}

impl<L: Law> MarkerElement<L> {
    /// Puts a law between two markers.
    #[must_use]
    pub fn new(name: &str, pair: MarkerPair, law: L) -> Self {
        Self {
            name: name.to_owned(),
            bodies: [pair.a.body, pair.b.body],
            pair,
            moving: [None, None],
            law,
        }
    }

    /// Lets ends move with the modes of their bodies, which must have as many; the origins of such markers become those
    /// of the frames that move.
    ///
    /// # Errors
    /// [`DynamicsError::Shape`] if the shapes of an end have not six rows.
    pub fn on_moving_ends(
        mut self,
        ends: [Option<DMatrix<f64>>; 2],
    ) -> Result<Self, DynamicsError> {
        let markers = [&mut self.pair.a, &mut self.pair.b];
        for ((shapes, marker), moving) in ends.into_iter().zip(markers).zip(&mut self.moving) {
            let Some(shapes) = shapes else { continue };
            if shapes.nrows() != 6 {
                return Err(DynamicsError::Shape {
                    owner: format!("force element `{}`", self.name),
                    what: "motion of an end (rows)",
                    found: shapes.nrows(),
                    expected: 6,
                });
            }
            let place_m = std::mem::take(&mut marker.position_m);
            *moving = Some(MovingEnd { place_m, shapes });
        }
        Ok(self)
    }

    fn moved(&self, view: &View<'_>) -> [Option<MovedEnd>; 2] {
        [0, 1].map(|end| {
            let body = self.bodies[end];
            let moving = self.moving[end].as_ref()?;
            Some(moving.moved(view.body(body), view.modal(body), view.modal_rates(body)))
        })
    }

    fn motion_of(&self, view: &View<'_>, moved: &[Option<MovedEnd>; 2]) -> RelativeMotion {
        let [a, b] = [0, 1].map(|end| {
            let of_body = || view.body(self.bodies[end]);
            (moved[end].as_ref()).map_or_else(of_body, |moved| &moved.motion)
        });
        self.pair.motion(a, b)
    }

    fn motion(&self, view: &View<'_>) -> RelativeMotion {
        self.motion_of(view, &self.moved(view))
    }

    /// Adds force and tangents on the frames of the ends to the bodies that carry them.
    fn add_carried(
        &self,
        (moved, places): (&[Option<MovedEnd>; 2], [usize; 2]),
        force: &SVector<f64, 12>,
        tangents: Option<&[PairTangent; 2]>,
        loads: &mut Loads,
    ) {
        let rigid = DMatrix::<f64>::identity(6, 6);
        let still = DMatrix::<f64>::zeros(6, 6);
        let ends = [0, 1].map(|end| match &moved[end] {
            Some(moved) => (&moved.jacobian, &moved.rate_jacobian),
            None => (&rigid, &still),
        });
        for (end, (jacobian, _)) in ends.iter().enumerate() {
            let own = jacobian.tr_mul(&force.fixed_rows::<6>(6 * end));
            loads.add_force(places[end], own.as_slice());
        }
        let Some([by_position, by_velocity]) = tangents else {
            return;
        };
        for (row, (to, _)) in ends.iter().enumerate() {
            for (column, (from, rates)) in ends.iter().enumerate() {
                let of = |tangent: &PairTangent| {
                    let block = tangent.fixed_view::<6, 6>(6 * row, 6 * column).into_owned();
                    to.tr_mul(&block)
                };
                let viscous = of(by_velocity);
                let mut elastic = of(by_position) * *from + &viscous * *rates;
                if let (true, Some(moving), Some(moved)) =
                    (row == column, &self.moving[row], &moved[row])
                {
                    let own = force.fixed_rows::<6>(6 * row).into_owned();
                    elastic += moving.geometric_tangent(moved, &own);
                }
                let viscous = viscous * *from;
                for i in 0..elastic.nrows() {
                    for j in 0..elastic.ncols() {
                        let at = (places[row] + i, places[column] + j);
                        loads.add_by_position(at.0, at.1, elastic[(i, j)]);
                        loads.add_by_velocity(at.0, at.1, viscous[(i, j)]);
                    }
                }
            }
        }
    }

    /// Local place of a row or column of the pair: bodies with modes have more than six.
    fn places(&self, view: &View<'_>) -> [usize; 2] {
        [0, view.layout.size(self.bodies[0])]
    }
}

impl<L: Law> ForceElement for MarkerElement<L> {
    fn name(&self) -> &str {
        &self.name
    }

    fn bodies(&self) -> &[BodyId] {
        &self.bodies
    }

    fn evaluate(&mut self, view: &View<'_>, loads: &mut Loads) -> Result<(), ElementFailure> {
        for (moving, body) in self.moving.iter().zip(self.bodies) {
            let expected = view.modal(body).len();
            if let Some(found) = moving.as_ref().map(|moving| moving.shapes.ncols())
                && found != expected
            {
                return Err(ElementFailure::from(DynamicsError::Shape {
                    owner: format!("force element `{}`", self.name),
                    what: "motion of an end (modes)",
                    found,
                    expected,
                }));
            }
        }
        let moved = self.moved(view);
        let motion = self.motion_of(view, &moved);
        let (load, power) = self.law.load(&motion);
        loads.power = power;
        let force = motion.generalised_force(&load);
        let places = self.places(view);
        let tangents = loads.wants_tangents().then(|| {
            let jacobian = motion.jacobian();
            let law = self.law.tangent(&motion);
            let along =
                law.by_position * jacobian + law.by_velocity * motion.rate_jacobian(&jacobian);
            let by_position = jacobian.tr_mul(&along) + motion.geometric_tangent(&jacobian, &load);
            [by_position, jacobian.tr_mul(&(law.by_velocity * jacobian))]
        });
        if self.moving.iter().any(Option::is_some) {
            self.add_carried((&moved, places), &force, tangents.as_ref(), loads);
            return Ok(());
        }
        loads.add_pair_force(places, &force);
        if let Some([by_position, by_velocity]) = &tangents {
            loads.add_pair_tangents(places, by_position, by_velocity);
        }
        Ok(())
    }

    fn begin(&mut self, view: &View<'_>) {
        let motion = self.motion(view);
        self.law.begin(&motion);
    }

    fn commit(&mut self, view: &View<'_>) -> Result<(), ElementFailure> {
        if self.law.has_state() {
            let motion = self.motion(view);
            self.law.commit(&motion);
        }
        Ok(())
    }

    fn save(&self, out: &mut Vec<f64>) {
        self.law.save(out);
    }

    fn restore(&mut self, numbers: &[f64]) {
        self.law.restore(numbers);
    }

    fn channels(&self) -> Vec<Channel> {
        load_channels(self.law.axes())
    }

    fn sample(&mut self, view: &View<'_>, out: &mut [f64]) {
        let motion = self.motion(view);
        let (load, _) = self.law.load(&motion);
        let force = load.fixed_rows::<3>(0).into_owned();
        out[..6].copy_from_slice(load.as_slice());
        out[6..9].copy_from_slice(motion.to_world(&force).as_slice());
        if let Some(radial) = out.get_mut(9) {
            *radial = force[0].hypot(force[1]);
        }
    }
}
