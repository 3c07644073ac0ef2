//! What can go wrong in setting up or running a multibody system.

use thiserror::Error;

/// What a force element reports when it cannot give its force.
pub type ElementFailure = Box<dyn std::error::Error + Send + Sync + 'static>;

/// Error of this crate.
#[derive(Debug, Error)]
pub enum DynamicsError {
    /// A STEP function does not go forward in time.
    #[error(
        "STEP runs from {start_s} s to {end_s} s: the end must come after the start, all numbers finite"
    )]
    Step {
        /// Given start \[s\].
        start_s: f64,
        /// Given end \[s\].
        end_s: f64,
    },
    /// A table cannot be interpolated.
    #[error("table `{name}`, row {row} (time {time_s} s): {what}")]
    Table {
        /// Name of the table.
        name: String,
        /// Row, counted from 0.
        row: usize,
        /// Time in that row \[s\].
        time_s: f64,
        /// What is wrong.
        what: &'static str,
    },
    /// A number that must be positive, or not negative, is not.
    #[error("{owner}: {what} is {found}; it must be {allowed}")]
    Value {
        /// Body, joint or element.
        owner: String,
        /// Name of the number, with its unit.
        what: &'static str,
        /// What was given.
        found: f64,
        /// What is allowed.
        allowed: &'static str,
    },
    /// An inertia tensor that no body can have.
    #[error(
        "body `{body}`: {what}; principal moments of inertia are {principal_kg_m2:?} kg m², each must be positive and at most the \
         sum of the other two"
    )]
    Inertia {
        /// Name of the body.
        body: String,
        /// What is wrong.
        what: &'static str,
        /// Principal moments about the centre of mass, ascending.
        principal_kg_m2: [f64; 3],
    },
    /// Arrays of one thing differ in length.
    #[error("{owner}: {what} has {found} entries, {expected} are needed")]
    Shape {
        /// Body, element or array.
        owner: String,
        /// Name of the array.
        what: &'static str,
        /// Its length.
        found: usize,
        /// The length needed.
        expected: usize,
    },
    /// The modes of a body carry more inertia than the body has.
    #[error(
        "body `{body}`: the coupling of its modes to its rigid motion is too strong for its mass and inertia (the mass matrix is not \
         positive definite): check that modes are scaled to unit modal mass and that coupling and inertia refer to one point"
    )]
    ModalCoupling {
        /// Name of the body.
        body: String,
    },
    /// Two things of one kind have the same name, or a name is empty.
    #[error(
        "the name `{name}` is empty or used twice: give every body, joint and force element its own"
    )]
    Name {
        /// The name.
        name: String,
    },
    /// Something names a body that is not in the system.
    #[error("{owner} names body number {body}, the system has {count}: add the body first")]
    UnknownBody {
        /// Joint or element.
        owner: String,
        /// The number.
        body: usize,
        /// Bodies in the system.
        count: usize,
    },
    /// A prescribed speed cannot be integrated in closed form.
    #[error(
        "joint `{joint}`: a speed that is a product of functions, or that the calling program computes, cannot be prescribed: prescribe the position, or \
         use a table or a sum"
    )]
    SpeedOfProduct {
        /// Name of the joint.
        joint: String,
    },
    /// Joints ask for positions that exclude each other.
    #[error(
        "joints {joints:?} contradict each other at t = {time_s} s: their equations cannot all hold, {violation:.3e} (m or rad) is left; \
         correct their places or prescribed motions, or remove one"
    )]
    Contradiction {
        /// Names of the joints, the one that cannot be met first.
        joints: Vec<String>,
        /// What is left of the equation \[m or rad\].
        violation: f64,
        /// When \[s\].
        time_s: f64,
    },
    /// The matrix of a linear system is singular.
    #[error(
        "{what} is singular at t = {time_s} s: two joints act alike there, or a body has no inertia along a free direction"
    )]
    Singular {
        /// Which matrix.
        what: &'static str,
        /// When \[s\].
        time_s: f64,
    },
    /// A force element failed.
    #[error("force element `{element}` failed at t = {time_s} s: {source}")]
    Element {
        /// Name of the element.
        element: String,
        /// When \[s\].
        time_s: f64,
        /// Its own error.
        source: ElementFailure,
    },
    /// An element wrote a tangent outside of what it says depends on each other.
    #[error(
        "force element `{element}` has a tangent outside the groups that its `couplings` states: add the degrees of freedom that depend on each other \
         to one group"
    )]
    Couplings {
        /// Name of the element.
        element: String,
    },
    /// Coordinates of an element without mass have no start.
    #[error(
        "force element `{element}`: its coordinates without mass find no equilibrium at t = {time_s} s: {left:.3e} times their scale is left after \
         {iterations} iterations; start them closer to it"
    )]
    UnknownStart {
        /// Name of the element.
        element: String,
        /// When \[s\].
        time_s: f64,
        /// Last correction over the scale.
        left: f64,
        /// Iterations made.
        iterations: usize,
    },
    /// The step does not converge.
    #[error(
        "no convergence at t = {time_s} s with a step of {step_s:.3e} s: after {iterations} iterations the correction is {ratio:.2e} times \
         the tolerance, largest in {largest}; {advice}"
    )]
    StepTooLarge {
        /// Start of the step \[s\].
        time_s: f64,
        /// The step \[s\].
        step_s: f64,
        /// Newton iterations made.
        iterations: usize,
        /// Last correction over the tolerance.
        ratio: f64,
        /// Body and direction where the correction is largest.
        largest: String,
        /// What to do.
        advice: &'static str,
    },
    /// The step's matrix is singular at its first guess, the joints where it begins are not.
    #[error(
        "no convergence at t = {time_s} s with a step of {step_s:.3e} s: its iteration matrix is singular at the first guess, though the \
         joints are regular where the step begins; {advice}"
    )]
    StepSingular {
        /// Start of the step \[s\].
        time_s: f64,
        /// The step \[s\].
        step_s: f64,
        /// What to do.
        advice: &'static str,
    },
    /// A solver parameter is out of range.
    #[error("solver: {what} is {found}; allowed is {allowed}")]
    Parameter {
        /// Name with unit.
        what: &'static str,
        /// What was given.
        found: f64,
        /// What is allowed.
        allowed: &'static str,
    },
    /// A static load acts along a motion that nothing resists.
    #[error(
        "no static equilibrium: nothing resists {motion}, and {load:.3e} (N or N m) acts along it; hold it by a joint or a spring, or \
         balance the load"
    )]
    Unbalanced {
        /// The free motion: bodies and directions.
        motion: String,
        /// Generalised force along it.
        load: f64,
    },
    /// The static equilibrium was not found.
    #[error(
        "static equilibrium not found: {iterations} iterations at load factor {load_factor}, correction {ratio:.2e} times the tolerance, \
         largest in {largest}; {unbalanced}. Shorter steps did not help: start closer to the equilibrium, take an element that balances there, or \
         settle by a damped transient run"
    )]
    NoEquilibrium {
        /// Iterations of the load step that failed.
        iterations: usize,
        /// Share of the loads applied.
        load_factor: f64,
        /// Last correction over the tolerance.
        ratio: f64,
        /// Body and direction where the correction is largest.
        largest: String,
        /// Where forces balance least, and what pushes there.
        unbalanced: String,
    },
    /// The search for equilibrium left what an element can follow.
    #[error(
        "static equilibrium not found at load factor {load_factor}: the search moved {moved} farthest, until force element `{element}` could not follow: \
         {source}. What should hold that motion carries too little or nothing there: a support that is missing or too soft, a contact that is open or \
         lost to a fault, a load too large for it. Shorter steps did not help"
    )]
    LeftOnTheWay {
        /// Share of the loads applied.
        load_factor: f64,
        /// Body and direction of the largest correction before.
        moved: String,
        /// The element.
        element: String,
        /// Its own error.
        source: ElementFailure,
    },
    /// The eigenvalue solver failed.
    #[error(
        "the eigenvalues of the linearised system ({size} unknowns) were not found: the matrix has entries that are not finite, or the iteration stalled"
    )]
    Eigen {
        /// Unknowns.
        size: usize,
    },
    /// A checkpoint with a number that no run has.
    #[error("the checkpoint cannot be resumed: {what} is {found} s; begin the run anew")]
    CheckpointNumber {
        /// Which number.
        what: &'static str,
        /// What it is \[s\].
        found: f64,
    },
    /// A checkpoint does not belong to the system.
    #[error(
        "the checkpoint does not fit the system: {what} has {found} entries, the system needs {expected}: resume with the scene that wrote it"
    )]
    Checkpoint {
        /// Which array.
        what: &'static str,
        /// Its length.
        found: usize,
        /// The length needed.
        expected: usize,
    },
}

impl DynamicsError {
    /// Refuses a number of a body, joint or element that is not as allowed.
    pub(crate) fn require(
        owner: String,
        (what, found): (&'static str, f64),
        is_allowed: bool,
        allowed: &'static str,
    ) -> Result<(), Self> {
        if is_allowed {
            return Ok(());
        }
        Err(Self::Value {
            owner,
            what,
            found,
            allowed,
        })
    }

    /// Refuses a number of a body, joint or element that is not positive and finite.
    pub(crate) fn positive(owner: String, what: &'static str, found: f64) -> Result<(), Self> {
        let is_allowed = found > 0.0 && found.is_finite();
        Self::require(owner, (what, found), is_allowed, "positive and finite")
    }

    /// Refuses a number of a body, joint or element that is negative or not finite.
    pub(crate) fn not_negative(owner: String, what: &'static str, found: f64) -> Result<(), Self> {
        let is_allowed = found >= 0.0 && found.is_finite();
        Self::require(
            owner,
            (what, found),
            is_allowed,
            "zero or positive, and finite",
        )
    }

    /// A matrix without inverse.
    pub(crate) fn singular(what: &'static str, time_s: f64) -> Self {
        Self::Singular { what, time_s }
    }
}
