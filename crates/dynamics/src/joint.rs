//! Joints: which relative motions of two markers are forbidden, prescribed or coupled.
//!
//! Every joint is a list of equations on three kinds of coordinate of a marker pair,
//!
//! ```text
//! along axis i           e_iᵀ u
//! axes i of A, k of B    e_iᵀ Q e_k          zero when the axes are perpendicular
//! angle about z          a (relative_angle.rs)
//! polar angle            β of u about z (polar_angle.rs)
//!
//! Σ factor · coordinate − offset − f(t) = 0
//! ```
//!
//! The reaction is Bᵀλ, with λ \[N, or N·m for angles\] on the left-hand side of the equation of motion. It is a force
//! between the two markers, so Jacobian and derivative of Bᵀλ come from relative_motion.rs.

use nalgebra::{Matrix3, SVector, Vector3};

use crate::body::BodyId;
use crate::derivatives::Derivatives;
use crate::error::DynamicsError;
use crate::polar_angle::PolarAngle;
use crate::relative_angle::RelativeAngle;
use crate::relative_motion::{Marker, MarkerPair, PairTangent, RelativeMotion};
use crate::rotation::skew;
use crate::state::BodyMotion;
use crate::time_function::TimeFunction;

/// What a motion prescribes: place or speed, metres or radians.
#[derive(Debug, Clone, PartialEq)]
pub enum Motion {
    /// The coordinate itself, counted from the markers' own zero (m or rad).
    Position(TimeFunction),
    /// Its rate (m/s or rad/s); the coordinate starts from where the joint stands.
    Speed(TimeFunction),
}

/// The joints; axes are those of marker A and B, which coincide when the joint is at zero.
#[derive(Debug, Clone, PartialEq)]
pub enum JointKind {
    /// No relative motion: 6 equations.
    Fixed,
    /// Turns about z: 5.
    Revolute,
    /// Slides along z: 5.
    Prismatic,
    /// Turns about and slides along z: 4.
    Cylindrical,
    /// Turns freely about a common point: 3.
    Spherical,
    /// The point of B stays on the z axis of A and turns freely: 2.
    PointOnAxis,
    /// Slides in the x-y plane of A and turns about z: 3.
    Planar,
    /// Common point, x of A stays perpendicular to y of B: 4.
    Universal,
    /// The distance of the planes z = 0 follows a function of time: 1.
    Translation(Motion),
    /// The angle about z follows a function of time: 1. Use together with a joint that keeps the axes aligned.
    Rotation(Motion),
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Coordinate {
    Along(usize),
    Axes { of_a: usize, of_b: usize },
    Angle,
    Polar,
}

#[derive(Debug, Clone, PartialEq)]
struct Term {
    pair: usize,
    coordinate: Coordinate,
    factor: f64,
}

#[derive(Debug, Clone, PartialEq)]
struct Equation {
    terms: Vec<Term>,
    /// Value at the start, for couplings and prescribed speeds.
    offset: f64,
    starts_here: bool,
    motion: Option<Motion>,
}

/// A joint between two bodies, or a coupling of the motions of several.
#[derive(Debug, Clone, PartialEq)]
pub struct Joint {
    name: String,
    pairs: Vec<MarkerPair>,
    angles: Vec<RelativeAngle>,
    /// One a pair where an equation has a polar angle, none otherwise.
    polars: Vec<PolarAngle>,
    equations: Vec<Equation>,
}

/// Derivatives of unit loads: of moments by the relative rotation, of forces by the displacement.
#[derive(Default)]
struct UnitSlope {
    by_rotation: Matrix3<f64>,
    by_displacement: Matrix3<f64>,
}

/// The part of one marker pair in the gradient of one equation.
pub(crate) struct Row<'a> {
    pub equation: usize,
    /// Part of the pair in the rate of the equation's left-hand side.
    pub rate: f64,
    /// Load (f, μ) of one unit of λ: ∂(equation)/∂(u, rotation).
    pub load: SVector<f64, 6>,
    motion: &'a RelativeMotion,
}

impl Row<'_> {
    /// Row of B, on the degrees of freedom of both bodies.
    pub(crate) fn gradient(&self) -> SVector<f64, 12> {
        self.motion.generalised_force(&self.load)
    }
}

impl Joint {
    /// A joint of two markers.
    ///
    /// # Errors
    /// [`DynamicsError::SpeedOfProduct`] if a speed is prescribed that has no closed integral.
    pub fn new(name: &str, kind: JointKind, a: Marker, b: Marker) -> Result<Self, DynamicsError> {
        use Coordinate::{Along, Angle, Axes};
        let perpendicular = |of_a, of_b| Axes { of_a, of_b };
        let point = [Along(0), Along(1), Along(2)];
        let aligned = [perpendicular(0, 2), perpendicular(1, 2)];
        let untwisted = perpendicular(1, 0);
        let (coordinates, motion): (Vec<Coordinate>, Option<Motion>) = match kind {
            JointKind::Fixed => ([&point[..], &aligned, &[untwisted]].concat(), None),
            JointKind::Revolute => ([&point[..], &aligned].concat(), None),
            JointKind::Prismatic => ([&point[..2], &aligned, &[untwisted]].concat(), None),
            JointKind::Cylindrical => ([&point[..2], &aligned].concat(), None),
            JointKind::Spherical => (point.to_vec(), None),
            JointKind::PointOnAxis => (point[..2].to_vec(), None),
            JointKind::Planar => ([&point[2..], &aligned].concat(), None),
            JointKind::Universal => ([&point[..], &[perpendicular(0, 1)]].concat(), None),
            JointKind::Translation(motion) => (vec![Along(2)], Some(motion)),
            JointKind::Rotation(motion) => (vec![Angle], Some(motion)),
        };
        if let Some(Motion::Speed(speed)) = &motion
            && speed.integral(0.0).is_none()
        {
            return Err(DynamicsError::SpeedOfProduct {
                joint: name.to_owned(),
            });
        }
        let starts_here = matches!(motion, Some(Motion::Speed(_)));
        let equations = coordinates
            .into_iter()
            .map(|coordinate| Equation {
                terms: vec![Term {
                    pair: 0,
                    coordinate,
                    factor: 1.0,
                }],
                offset: 0.0,
                starts_here,
                motion: motion.clone(),
            })
            .collect();
        Ok(Self::assembled(name, vec![MarkerPair { a, b }], equations))
    }

    /// Couples the angles of two marker pairs about their z axes over any number of turns: Σ factor·angle stays what it
    /// is at the start. For two wheels in mesh, the factors are their radii (both positive for external teeth on
    /// parallel z axes); the reaction is a torque on each, so bearings do not feel the force between the teeth.
    #[must_use]
    pub fn ratio(name: &str, first: (MarkerPair, f64), second: (MarkerPair, f64)) -> Self {
        let term = |pair, factor| Term {
            pair,
            coordinate: Coordinate::Angle,
            factor,
        };
        let equation = Equation {
            terms: vec![term(0, first.1), term(1, second.1)],
            offset: 0.0,
            starts_here: true,
            motion: None,
        };
        Self::assembled(name, vec![first.0, second.0], vec![equation])
    }

    /// Lets B roll on the outside of A without slip, wherever their parallel z axes go: with φ their turns, β the polar
    /// angle of the line of centres and radii in the ratio r_A : r_B,
    ///
    /// ```text
    /// r_A (φ_A − β) + r_B (φ_B − β) = r_B γ − (r_A + r_B) β_A = what it is at the start
    /// ```
    ///
    /// γ: turn of B against A, β_A: β seen in A. The reaction is the tangential force where the circles touch, which
    /// bearings feel.
    #[must_use]
    pub fn rolling(name: &str, pair: MarkerPair, [radius_a, radius_b]: [f64; 2]) -> Self {
        let term = |coordinate, factor| Term {
            pair: 0,
            coordinate,
            factor,
        };
        let equation = Equation {
            terms: vec![
                term(Coordinate::Angle, radius_b),
                term(Coordinate::Polar, -radius_a - radius_b),
            ],
            offset: 0.0,
            starts_here: true,
            motion: None,
        };
        Self::assembled(name, vec![pair], vec![equation])
    }

    fn assembled(name: &str, pairs: Vec<MarkerPair>, equations: Vec<Equation>) -> Self {
        let mut terms = equations.iter().flat_map(|equation| &equation.terms);
        let rolls = terms.any(|term| term.coordinate == Coordinate::Polar);
        Self {
            name: name.to_owned(),
            angles: vec![RelativeAngle::default(); pairs.len()],
            polars: vec![PolarAngle::default(); if rolls { pairs.len() } else { 0 }],
            pairs,
            equations,
        }
    }

    /// Name.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Number of equations.
    #[must_use]
    pub fn equations(&self) -> usize {
        self.equations.len()
    }

    /// The marker pairs.
    #[must_use]
    pub fn pairs(&self) -> &[MarkerPair] {
        &self.pairs
    }

    /// Angle about z of the first marker pair at the last accepted step, turns counted \[rad\].
    #[must_use]
    pub fn angle_rad(&self) -> f64 {
        self.angles[0].committed_rad()
    }

    /// Largest magnitude of its counted angles at the last accepted step \[rad\].
    pub(crate) fn largest_angle_rad(&self) -> f64 {
        let angles = self.angles.iter().map(RelativeAngle::committed_rad);
        angles.fold(0.0, |most, angle| most.max(angle.abs()))
    }

    /// Whether the joint has an angle whose turns are counted.
    fn counts_turns(&self) -> bool {
        let mut terms = self.equations.iter().flat_map(|equation| &equation.terms);
        terms.any(|term| term.coordinate == Coordinate::Angle)
    }

    /// Takes the start: turns from zero, offsets of couplings and prescribed speeds. `motion` gives the bodies' motion.
    pub(crate) fn begin(&mut self, time_s: f64, motion: &impl Fn(BodyId) -> BodyMotion) {
        for (pair, angle) in self.pairs.iter().zip(&mut self.angles) {
            angle.begin(&pair.motion(&motion(pair.a.body), &motion(pair.b.body)));
        }
        for (pair, polar) in self.pairs.iter().zip(&mut self.polars) {
            polar.begin(&pair.motion(&motion(pair.a.body), &motion(pair.b.body)));
        }
        for index in 0..self.equations.len() {
            if self.equations[index].starts_here {
                self.equations[index].offset = 0.0;
                let left: f64 = (0..self.pairs.len())
                    .map(|pair| {
                        let at = self.pairs[pair];
                        let seen = at.motion(&motion(at.a.body), &motion(at.b.body));
                        self.part(index, pair, &seen)
                    })
                    .sum();
                self.equations[index].offset = left - self.prescribed(index, time_s).value;
            }
        }
    }

    /// Counts the turns of an accepted step.
    pub(crate) fn commit(&mut self, motion: &impl Fn(BodyId) -> BodyMotion) {
        if self.counts_turns() {
            for (pair, angle) in self.pairs.iter().zip(&mut self.angles) {
                angle.commit(&pair.motion(&motion(pair.a.body), &motion(pair.b.body)));
            }
            for (pair, polar) in self.pairs.iter().zip(&mut self.polars) {
                polar.commit(&pair.motion(&motion(pair.a.body), &motion(pair.b.body)));
            }
        }
    }

    /// Numbers that a checkpoint needs: angles and offsets.
    pub(crate) fn save(&self, out: &mut Vec<f64>) {
        out.extend(self.angles.iter().map(RelativeAngle::committed_rad));
        out.extend(self.polars.iter().map(PolarAngle::committed_rad));
        out.extend(self.equations.iter().map(|equation| equation.offset));
    }

    /// Takes what [`Self::save`] wrote; `numbers` is exactly that long.
    pub(crate) fn restore(&mut self, numbers: &[f64]) {
        let (angles, rest) = numbers.split_at(self.angles.len());
        let (polars, offsets) = rest.split_at(self.polars.len());
        for (polar, &number) in self.polars.iter_mut().zip(polars) {
            polar.restore(number);
        }
        for (angle, &number) in self.angles.iter_mut().zip(angles) {
            angle.restore(number);
        }
        for (equation, &number) in self.equations.iter_mut().zip(offsets) {
            equation.offset = number;
        }
    }

    /// Length of what [`Self::save`] writes.
    pub(crate) fn saved(&self) -> usize {
        self.angles.len() + self.polars.len() + self.equations.len()
    }

    /// f(t) of an equation with its derivatives; zero if nothing is prescribed.
    pub(crate) fn prescribed(&self, equation: usize, time_s: f64) -> Derivatives {
        match &self.equations[equation].motion {
            None => Derivatives::default(),
            Some(Motion::Position(f)) => f.at(time_s),
            Some(Motion::Speed(f)) => {
                let speed = f.at(time_s);
                Derivatives {
                    value: f.integral(time_s).unwrap_or(f64::NAN),
                    rate: speed.value,
                    acceleration: speed.rate,
                }
            }
        }
    }

    /// Offset of an equation, what [`Self::prescribed`] is added to.
    pub(crate) fn offset(&self, equation: usize) -> f64 {
        self.equations[equation].offset
    }

    /// Part of a pair in the left-hand side of an equation.
    pub(crate) fn part(&self, equation: usize, pair: usize, motion: &RelativeMotion) -> f64 {
        let terms = self.equations[equation].terms.iter();
        terms
            .filter(|term| term.pair == pair)
            .map(|term| term.factor * self.value(term, motion))
            .sum()
    }

    fn value(&self, term: &Term, motion: &RelativeMotion) -> f64 {
        match term.coordinate {
            Coordinate::Along(axis) => motion.displacement_m[axis],
            Coordinate::Axes { of_a, of_b } => motion.rotation[(of_a, of_b)],
            Coordinate::Angle => self.angles[term.pair].value(motion),
            Coordinate::Polar => self.polars[term.pair].value(motion),
        }
    }

    fn terms(&self, equation: usize, pair: usize) -> impl Iterator<Item = &Term> {
        let terms = self.equations[equation].terms.iter();
        terms.filter(move |term| term.pair == pair)
    }

    /// Load (f, μ) of one unit of λ in an equation on a pair.
    fn unit_load(&self, equation: usize, pair: usize, motion: &RelativeMotion) -> SVector<f64, 6> {
        let mut load = SVector::<f64, 6>::zeros();
        for term in self.terms(equation, pair) {
            match term.coordinate {
                Coordinate::Along(axis) => load[axis] += term.factor,
                Coordinate::Axes { of_a, of_b } => {
                    let e = Vector3::ith(of_a, 1.0);
                    let c: Vector3<f64> = motion.rotation.column(of_b).into();
                    let mut moment = load.fixed_rows_mut::<3>(3);
                    moment += term.factor * c.cross(&e);
                }
                Coordinate::Angle => {
                    let mut moment = load.fixed_rows_mut::<3>(3);
                    moment += term.factor * RelativeAngle::gradient(motion);
                }
                Coordinate::Polar => {
                    let mut force = load.fixed_rows_mut::<3>(0);
                    force += term.factor * PolarAngle::gradient(motion);
                }
            }
        }
        load
    }

    /// Derivatives of the load of all λ on a pair.
    fn slope(&self, pair: usize, lambda: &[f64], motion: &RelativeMotion) -> UnitSlope {
        let mut slope = UnitSlope::default();
        for (equation, lambda) in lambda.iter().enumerate() {
            for term in self.terms(equation, pair) {
                let factor = lambda * term.factor;
                match term.coordinate {
                    Coordinate::Along(_) => {}
                    Coordinate::Axes { of_a, of_b } => {
                        let e = Vector3::ith(of_a, 1.0);
                        let c: Vector3<f64> = motion.rotation.column(of_b).into();
                        // c × e with dc = φ × c
                        slope.by_rotation += factor * skew(&e) * skew(&c);
                    }
                    Coordinate::Angle => {
                        slope.by_rotation += factor * RelativeAngle::gradient_slope(motion);
                    }
                    Coordinate::Polar => {
                        slope.by_displacement += factor * PolarAngle::gradient_slope(motion);
                    }
                }
            }
        }
        slope
    }

    /// Force \[N\] and moment \[N·m\] of the joint on the body of marker B of a pair, in B's origin and along A's axes;
    /// the body of A feels the opposite. `lambda` holds the reactions of this joint's equations: −Σ λ ∂(equation)/∂(u,
    /// rotation).
    #[must_use]
    pub fn load(&self, pair: usize, lambda: &[f64], motion: &RelativeMotion) -> SVector<f64, 6> {
        let mut load = SVector::<f64, 6>::zeros();
        for (equation, lambda) in lambda.iter().enumerate() {
            if *lambda != 0.0 {
                load -= *lambda * self.unit_load(equation, pair, motion);
            }
        }
        load
    }

    /// ∂(Bᵀλ)/∂increments of one pair, whose Σ λ ∂(equation)/∂(u, rotation) is `load`.
    pub(crate) fn tangent(
        &self,
        pair: usize,
        (lambda, load): (&[f64], &SVector<f64, 6>),
        motion: &RelativeMotion,
    ) -> PairTangent {
        let jacobian = motion.jacobian();
        let slope = self.slope(pair, lambda, motion);
        let turns = jacobian.fixed_rows::<3>(3);
        let tangent = motion.geometric_tangent(&jacobian, load)
            + turns.transpose() * (slope.by_rotation * turns);
        if self.polars.is_empty() {
            return tangent;
        }
        let moves = jacobian.fixed_rows::<3>(0);
        tangent + moves.transpose() * (slope.by_displacement * moves)
    }

    /// Calls `visit` with every equation on one pair.
    pub(crate) fn rows(
        &self,
        pair: usize,
        motion: &RelativeMotion,
        mut visit: impl FnMut(Row<'_>),
    ) {
        let rates = motion.rates();
        for equation in 0..self.equations.len() {
            let load = self.unit_load(equation, pair, motion);
            visit(Row {
                equation,
                rate: load.dot(&rates),
                load,
                motion,
            });
        }
    }
}
