//! Force elements: everything that pushes on bodies apart from joints and inertia.
//!
//! | element | file |
//! | --- | --- |
//! | the trait, for elements of other crates, too | this one |
//! | weight | `gravity.rs` |
//! | force or torque as a function of time | `applied_load.rs` |
//! | what acts between two markers, as a 6-component law | `marker_element.rs` |
//! | an end of it that moves with the modes of its body | `moving_end.rs` |
//! | spring and damper along a line | `spring_damper.rs` |
//! | torsion spring and damper, any number of turns | `torsion_spring.rs` |
//! | bushing, 6×6 | `bushing.rs` |
//! | linear bearing, spins freely | `linear_bearing.rs` |
//! | bearing of a whole matrix about an operating point, spins freely | `matrix_bearing.rs` |
//! | Timoshenko beam | `beam.rs` |
//! | a law of the calling program | `host_element.rs` |

mod applied_load;
mod beam;
mod bushing;
mod gravity;
mod host_element;
mod linear_bearing;
mod marker_element;
mod matrix_bearing;
mod moving_end;
mod spring_damper;
mod torsion_spring;

pub use applied_load::{AppliedLoad, Axes, LoadKind};
pub use beam::BeamSection;
pub use bushing::Bushing;
pub use gravity::Gravity;
pub use host_element::{HostElement, HostLaw, HostMotion};
pub use linear_bearing::{AxialSupport, LinearBearing};
pub use marker_element::{Law, LawTangent, MarkerElement, PairLoad, load_channels};
pub use matrix_bearing::MatrixBearing;
pub use moving_end::MovingEnd;
pub use spring_damper::SpringDamper;
pub use torsion_spring::TorsionSpring;

use std::sync::Arc;

use nalgebra::SVector;

use crate::body::{BodyId, GROUND};
use crate::error::{DynamicsError, ElementFailure};
use crate::matrix::Matrix;
use crate::pattern::Pattern;
use crate::relative_motion::PairTangent;
use crate::state::{BodyMotion, Layout, motion_of};
use crate::unknown::Unknown;

/// How a motion at which an element is asked stands to the others that it is asked at.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Iterate {
    /// By itself: at rest, at the start of a run.
    #[default]
    Single,
    /// The first guess of a step: iterates nearby will follow.
    First,
    /// A motion next to the one at which the element was asked last: a correction of an iterate, or its outcome for
    /// output. What hardly changes between them may be taken from there, as far as the force is that of this motion to
    /// rounding.
    Correction,
}

/// All that an element may look at: time, and the motion of its bodies.
#[derive(Debug, Clone, Copy)]
pub struct View<'a> {
    /// Time \[s\].
    pub time_s: f64,
    /// Share of the external loads that acts, 0…1: below 1 only while a static equilibrium is approached. Elements that
    /// stand for applied loads multiply by it.
    pub load_factor: f64,
    /// Whether the motion is one of several iterates.
    pub iterate: Iterate,
    pub(crate) motions: &'a [BodyMotion],
    pub(crate) modal: &'a [f64],
    pub(crate) velocity: &'a [f64],
    pub(crate) layout: &'a Layout,
    pub(crate) unknowns: &'a [f64],
    pub(crate) unknown_rates: &'a [f64],
}

impl View<'_> {
    /// Rigid motion of a body; the ground's is at rest.
    #[must_use]
    pub fn body(&self, body: BodyId) -> &BodyMotion {
        motion_of(self.motions, body)
    }

    /// Modal coordinates of a body \[√kg·m\]; none for rigid bodies and the ground.
    #[must_use]
    pub fn modal(&self, body: BodyId) -> &[f64] {
        if body == GROUND {
            return &[];
        }
        let start = self.layout.modal_start(body.0);
        &self.modal[start..start + self.layout.size(body) - 6]
    }

    /// Rates of the modal coordinates.
    #[must_use]
    pub fn modal_rates(&self, body: BodyId) -> &[f64] {
        match self.layout.start(body) {
            None => &[],
            Some(start) => &self.velocity[start + 6..start + self.layout.size(body)],
        }
    }

    /// Coordinates of this element, in the order of [`ForceElement::unknowns`].
    #[must_use]
    pub fn unknowns(&self) -> &[f64] {
        self.unknowns
    }

    /// Their rates.
    #[must_use]
    pub fn unknown_rates(&self) -> &[f64] {
        self.unknown_rates
    }
}

/// Energy and power of an element, for the energy balance.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Power {
    /// Energy stored \[J\].
    pub stored_j: f64,
    /// Power turned into heat \[W\], not negative.
    pub dissipated_w: f64,
    /// Power brought in from outside \[W\].
    pub supplied_w: f64,
}

/// What an element returns: generalised force on its bodies, and tangents where wanted.
///
/// Local order: the degrees of freedom of the first body of [`ForceElement::bodies`], then of the second and so on,
/// then the element's own coordinates, whose place holds Q of their equation ([`crate::UnknownKind`]);
/// [`Loads::starts`] says where each begins. Of a body there are the force on the reference point (world axes \[N\]),
/// the moment about it (body axes \[N·m\]) and the modal forces \[√kg·m/s²\]. The ground has six places, whose content
/// is dropped. Tangents are ∂force/∂increments and ∂force/∂velocities, row: force.
#[derive(Debug)]
pub struct Loads {
    pub(crate) force: Vec<f64>,
    pub(crate) by_position: Matrix,
    pub(crate) by_velocity: Matrix,
    pub(crate) tangents: bool,
    starts: Vec<usize>,
    /// Energy and power at this motion; zero unless set.
    pub power: Power,
}

impl Loads {
    pub(crate) fn new(pattern: &Arc<Pattern>, starts: Vec<usize>) -> Self {
        Self {
            force: vec![0.0; pattern.rows()],
            by_position: Matrix::zeros(pattern),
            by_velocity: Matrix::zeros(pattern),
            tangents: false,
            starts,
            power: Power::default(),
        }
    }

    pub(crate) fn begin(&mut self, tangents: bool) {
        self.force.fill(0.0);
        self.tangents = tangents;
        self.power = Power::default();
        if tangents {
            self.by_position.clear();
            self.by_velocity.clear();
        }
    }

    /// Where the degrees of freedom of each body begin, and behind them where the element's own coordinates do.
    #[must_use]
    pub fn starts(&self) -> &[usize] {
        &self.starts
    }

    /// Where the element's own coordinates begin.
    #[must_use]
    pub fn first_unknown(&self) -> usize {
        self.starts.last().copied().unwrap_or_default()
    }

    /// Whether something was written where the element has stated that nothing depends on anything.
    pub(crate) fn is_outside_couplings(&self) -> bool {
        self.by_position.is_left() || self.by_velocity.is_left()
    }

    /// Whether tangents are asked for; writing them otherwise is wasted time, but allowed.
    #[must_use]
    pub fn wants_tangents(&self) -> bool {
        self.tangents
    }

    /// Adds to the force.
    #[inline]
    pub fn add_force(&mut self, first: usize, values: &[f64]) {
        for (place, value) in self.force[first..].iter_mut().zip(values) {
            *place += value;
        }
    }

    /// Adds to the rigid bodies of a pair; `places`: where their degrees of freedom begin.
    #[inline]
    pub fn add_pair_force(&mut self, places: [usize; 2], force: &SVector<f64, 12>) {
        for (place, half) in places.iter().zip(force.as_slice().chunks_exact(6)) {
            self.add_force(*place, half);
        }
    }

    /// Adds to the tangents of the rigid bodies of a pair: ∂force/∂increments and ∂force/∂velocities.
    pub fn add_pair_tangents(
        &mut self,
        places: [usize; 2],
        by_position: &PairTangent,
        by_velocity: &PairTangent,
    ) {
        for (matrix, values) in [
            (&mut self.by_position, by_position),
            (&mut self.by_velocity, by_velocity),
        ] {
            for (column, values) in values.as_slice().chunks_exact(12).enumerate() {
                let column = places[column / 6] + column % 6;
                for (place, half) in places.iter().zip(values.chunks_exact(6)) {
                    matrix.add_column(*place, column, half);
                }
            }
        }
    }

    /// Adds to ∂force/∂increments.
    pub fn add_by_position(&mut self, row: usize, column: usize, value: f64) {
        self.by_position.add(row, column, value);
    }

    /// Adds to ∂force/∂velocities.
    pub fn add_by_velocity(&mut self, row: usize, column: usize, value: f64) {
        self.by_velocity.add(row, column, value);
    }

    /// Adds a 3×3 block to ∂force/∂increments.
    pub fn add_block_by_position(
        &mut self,
        row: usize,
        column: usize,
        block: &nalgebra::Matrix3<f64>,
    ) {
        self.by_position.add3(row, column, block);
    }

    /// Adds a 3×3 block to ∂force/∂velocities.
    pub fn add_block_by_velocity(
        &mut self,
        row: usize,
        column: usize,
        block: &nalgebra::Matrix3<f64>,
    ) {
        self.by_velocity.add3(row, column, block);
    }
}

/// A quantity that an element can report at every output time.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Channel {
    /// Name with unit, as in a column head: `force_x_N`.
    pub name: String,
    /// Unit: `N`; `1` for plain numbers. Nothing reads it off the name.
    pub unit: &'static str,
    /// What it is, with axes and sign.
    pub description: String,
}

impl Channel {
    /// A channel.
    #[must_use]
    pub fn new(
        name: impl Into<String>,
        unit: &'static str,
        description: impl Into<String>,
    ) -> Self {
        Self {
            name: name.into(),
            unit,
            description: description.into(),
        }
    }
}

/// A force that acts on some bodies, with coordinates of its own where it has any (docs/extending.md).
///
/// `evaluate` must depend on the view and on what was kept by the last `commit` only: it is called many times a step,
/// also for motions that are then given up.
pub trait ForceElement: Send {
    /// Name, used in every message.
    fn name(&self) -> &str;

    /// The bodies it acts on, in the order of the local degrees of freedom.
    fn bodies(&self) -> &[BodyId];

    /// Coordinates that the element owns. They are solved with the motion of the bodies, saved in checkpoints, and part
    /// of equilibria and natural modes.
    fn unknowns(&self) -> Vec<Unknown> {
        Vec::new()
    }

    /// Where its coordinates start, given the start of its bodies; all are zero before. Those in equilibrium are solved
    /// from there.
    fn start_unknowns(&self, _view: &View<'_>, _values: &mut [f64], _rates: &mut [f64]) {}

    /// Groups of local degrees of freedom of which each may depend on each other; none: all depend on all. `starts` is
    /// that of [`Loads::starts`]. An element with many coordinates states the few that meet (a ball: its own, and the
    /// rings' six each), so that its part of the matrix is sparse. Tangents outside the groups are an error.
    fn couplings(&self, _starts: &[usize]) -> Vec<Vec<usize>> {
        Vec::new()
    }

    /// Adds force, and tangents where [`Loads::wants_tangents`], at a motion.
    ///
    /// # Errors
    /// Whatever keeps the element from giving its force; the step is then repeated with a shorter one or given up.
    fn evaluate(&mut self, view: &View<'_>, loads: &mut Loads) -> Result<(), ElementFailure>;

    /// Called once before the run, at its first motion: internal state begins here.
    fn begin(&mut self, _view: &View<'_>) {}

    /// Asked after the last evaluation, which was at this motion, where an equilibrium is sought along a motion that
    /// nothing resists: whether the element's model covers that motion.
    ///
    /// # Errors
    /// A motion that the model does not cover: the search ends with this message.
    fn admits(&self, _view: &View<'_>) -> Result<(), ElementFailure> {
        Ok(())
    }

    /// Called at the end of every accepted step and at every static equilibrium: internal state (turns, slip, warm
    /// starts) moves on here only.
    ///
    /// # Errors
    /// A motion that the element's model does not cover: the run ends with this message.
    fn commit(&mut self, _view: &View<'_>) -> Result<(), ElementFailure> {
        Ok(())
    }

    /// Appends the internal state, as plain numbers, always as many.
    fn save(&self, _out: &mut Vec<f64>) {}

    /// Takes what [`Self::save`] wrote.
    fn restore(&mut self, _numbers: &[f64]) {}

    /// What [`Self::sample`] writes.
    fn channels(&self) -> Vec<Channel> {
        Vec::new()
    }

    /// Writes the values of [`Self::channels`] at a motion. Called for output only.
    fn sample(&mut self, _view: &View<'_>, _out: &mut [f64]) {}
}

/// A parameter that must be finite and not negative.
pub(crate) fn not_negative(
    element: &str,
    what: &'static str,
    found: f64,
) -> Result<(), DynamicsError> {
    DynamicsError::not_negative(format!("force element `{element}`"), what, found)
}
