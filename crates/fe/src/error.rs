//! What can go wrong between a mesh and a factor, one variant per cause.

use thiserror::Error;

/// A failure inside one element.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum ElementError {
    /// The map from the reference shape to the element folds over or collapses.
    #[error(
        "the Jacobian determinant is {determinant_m3:e} m^3 at the natural point {natural:?}; it must be positive: \
         number the nodes as VTK does, or repair the shape"
    )]
    JacobianNotPositive {
        /// Natural coordinates of the point.
        natural: [f64; 3],
        /// Determinant found (m³).
        determinant_m3: f64,
    },
    /// Coordinates of another number of nodes than the element has.
    #[error("the coordinates of {found} nodes were given; the element has {expected}")]
    NodeCount {
        /// Number given.
        found: usize,
        /// Number of nodes of the element.
        expected: usize,
    },
    /// The 9x9 stiffness of the incompatible modes has no Cholesky factor: only coordinates that overflow reach this.
    #[error(
        "the stiffness of the incompatible modes is not positive definite; the coordinates must be finite and of ordinary size (m)"
    )]
    ModesNotPositiveDefinite,
}

/// A failure of model building, assembly, ordering or factorisation.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum FeError {
    /// Young's modulus outside its range.
    #[error("Young's modulus is {young_pa:e} Pa; it must be positive and finite")]
    YoungOutOfRange {
        /// Value found (Pa).
        young_pa: f64,
    },
    /// Poisson's ratio outside its range.
    #[error("Poisson's ratio is {poisson}; it must lie strictly between -1 and 0.5")]
    PoissonOutOfRange {
        /// Value found.
        poisson: f64,
    },
    /// Density outside its range.
    #[error("the density is {density_kg_per_m3:e} kg/m^3; it must be positive and finite")]
    DensityOutOfRange {
        /// Value found (kg/m³).
        density_kg_per_m3: f64,
    },
    /// A node is to be rigid that is fixed or rigid already.
    #[error(
        "node {node} is to move rigidly with a reference point, but it is fixed, or listed in a group before"
    )]
    RigidNodeTwice {
        /// Node index.
        node: usize,
    },
    /// The search for natural modes did not converge.
    #[error(
        "{converged} of {wanted} natural modes converged within {restarts} restarts; ask for fewer, or allow more"
    )]
    ModesNotConverged {
        /// Modes found to the tolerance.
        converged: usize,
        /// Modes asked for.
        wanted: usize,
        /// Restarts made.
        restarts: usize,
    },
    /// More modes than unknowns, or none.
    #[error(
        "{found} natural modes were asked for; the model has {unknowns} unknowns: ask for 1 to {unknowns}"
    )]
    ModeCount {
        /// Number asked for.
        found: usize,
        /// Unknowns of the model.
        unknowns: usize,
    },
    /// The model has no elements.
    #[error("the model has {nodes} nodes and no elements; give at least one element")]
    NoElements {
        /// Number of nodes given.
        nodes: usize,
    },
    /// The rows of the connectivity do not have as many nodes as the element.
    #[error("the connectivity has {found} nodes an element; {element} has {expected}")]
    NodesPerElement {
        /// Name of the element.
        element: &'static str,
        /// Nodes an element found.
        found: usize,
        /// Nodes the element has.
        expected: usize,
    },
    /// The list of nodes of a block of elements is not a whole number of elements long.
    #[error(
        "the connectivity of the {element} elements has {found} entries; it must be a multiple of {per_element}"
    )]
    ConnectivityLength {
        /// Name of the element.
        element: &'static str,
        /// Entries found.
        found: usize,
        /// Nodes of one element.
        per_element: usize,
    },
    /// More nodes than 32-bit indices allow.
    #[error(
        "{found} nodes and edges exceed the {allowed} that 32-bit indices allow; use a coarser mesh or a sector"
    )]
    TooLarge {
        /// Count found.
        found: usize,
        /// Largest count allowed.
        allowed: usize,
    },
    /// A coordinate is NaN or infinite.
    #[error("node {node} has the coordinates {coordinates_m:?} m; all must be finite")]
    CoordinateNotFinite {
        /// Node index.
        node: usize,
        /// Coordinates found (m).
        coordinates_m: [f64; 3],
    },
    /// An element refers to a node that does not exist.
    #[error("element {element} names node {node}; the model has the nodes 0 to {}", node_count.saturating_sub(1))]
    NodeOutOfRange {
        /// Element index.
        element: usize,
        /// Node index found.
        node: u32,
        /// Number of nodes of the model.
        node_count: usize,
    },
    /// A node belongs to no element: its degrees of freedom would have no stiffness.
    #[error("node {node} belongs to no element; remove it or connect it")]
    NodeWithoutElement {
        /// Node index.
        node: usize,
    },
    /// An element failed.
    #[error("element {element}: {source}")]
    Element {
        /// Element index.
        element: usize,
        /// Cause.
        source: ElementError,
    },
    /// An element index that the model does not have.
    #[error("element {element} was asked for; the model has {element_count} elements")]
    ElementOutOfRange {
        /// Index asked for.
        element: usize,
        /// Number of elements.
        element_count: usize,
    },
    /// A constraint on a degree of freedom that does not exist.
    #[error("degree of freedom {dof} is to be fixed; the model has {dof_count} (three per node)")]
    DofOutOfRange {
        /// Index found.
        dof: usize,
        /// Number of degrees of freedom.
        dof_count: usize,
    },
    /// Everything is fixed.
    #[error("all {dof_count} degrees of freedom are fixed; leave at least one free")]
    NothingFree {
        /// Number of degrees of freedom.
        dof_count: usize,
    },
    /// Two objects were built for different sizes.
    #[error(
        "{what} has the size {found}, expected {expected}; build both from the same model and constraints"
    )]
    SizeMismatch {
        /// Which object.
        what: &'static str,
        /// Its size.
        found: usize,
        /// The size needed.
        expected: usize,
    },
    /// An ordering that leaves out or repeats an index.
    #[error(
        "the ordering is not a permutation: index {index} of {size} is out of range or repeated"
    )]
    NotAPermutation {
        /// Offending index.
        index: usize,
        /// Length of the ordering.
        size: usize,
    },
    /// METIS returned an error code.
    #[error(
        "METIS nested dissection of {nodes} nodes failed with status {status} ({meaning}); free memory or use a coarser mesh"
    )]
    Metis {
        /// Number of nodes of the graph.
        nodes: usize,
        /// METIS status code.
        status: i32,
        /// What METIS calls it.
        meaning: &'static str,
    },
    /// The stiffness matrix has a pivot that is zero or negative.
    #[error(
        "the stiffness matrix is not positive definite (pivot of free degree of freedom {free_dof} after ordering): \
         the body is not held against all six rigid motions, a part is loose, or an element is broken"
    )]
    NotPositiveDefinite {
        /// Free degree of freedom whose pivot failed.
        free_dof: usize,
    },
    /// The jumps across a crack have no positive stiffness.
    #[error(
        "the stiffness of the {jumps} jumps across a crack is not positive definite: it cuts a part off, or a doubled node has elements on \
         one side only; shorten the crack"
    )]
    CrackNotPositiveDefinite {
        /// Number of jumps.
        jumps: usize,
    },
    /// The matrix does not have the pattern that was analysed.
    #[error(
        "the matrix has {found} nonzeros, the analysed pattern {expected}; analyse again for this mesh and constraints"
    )]
    PatternChanged {
        /// Nonzeros of the matrix.
        found: usize,
        /// Nonzeros analysed.
        expected: usize,
    },
    /// Not enough memory.
    #[error("no memory for the factor ({bytes} bytes asked for); use a coarser mesh or one sector")]
    OutOfMemory {
        /// Bytes asked for; 0 where the count itself failed.
        bytes: usize,
    },
}

impl FeError {
    /// Refuses an object of another size.
    pub(crate) fn check_size(
        what: &'static str,
        found: usize,
        expected: usize,
    ) -> Result<(), Self> {
        if found == expected {
            return Ok(());
        }
        Err(Self::SizeMismatch {
            what,
            found,
            expected,
        })
    }
}
