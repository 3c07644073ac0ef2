//! What can be wrong with a gear that was meshed elsewhere.

use thiserror::Error;

/// Why a gear that was meshed elsewhere cannot be reduced.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum ImportedMeshError {
    /// The mesh is not the gear of the definition.
    #[error("{file}: {problem}")]
    Misfit {
        /// Mesh file.
        file: String,
        /// What does not fit.
        problem: Misfit,
    },
    /// The mesh program could not read the file.
    #[error(transparent)]
    Python(#[from] PythonFailure),
    /// The exchange file could not be read.
    #[error("{0}")]
    Exchange(String),
}

/// Why a mesh from elsewhere is not the gear of the definition.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum Misfit {
    /// A named set is missing or empty.
    #[error(
        "there is no node or element set \"{wanted}\"{}, {use_of}; the file has {}. Name the sets in the mesher (gmsh: \
         physical groups, Abaqus: *NSET or *ELSET) or their names in [blank]",
        if *more > 0 { format!(" (and {more} more of that pattern)") } else { String::new() },
        if found.is_empty() { "no sets at all".to_string() } else { format!("the sets {found}") }
    )]
    SetMissing {
        /// Name of the set.
        wanted: String,
        /// How many others of the same pattern are missing too.
        more: usize,
        /// What it is needed for.
        use_of: &'static str,
        /// Names of the sets found, shortened.
        found: String,
    },
    /// A bore that is none.
    #[error(
        "node {node} of the set \"{set}\" at x {:.4} y {:.4} z {:.4} mm has the radius {found_mm:.4} mm; the bore has {expected_mm:.4} mm \
         and {allowed_um:.1} um (0.2 % of the module) are allowed: check blank.bore_diameter_mm and blank.length_unit; the axis of \
         the gear must be z",
        at_mm[0], at_mm[1], at_mm[2]
    )]
    Bore {
        /// Name of the set.
        set: String,
        /// Worst node.
        node: u32,
        /// Where it is.
        at_mm: [f64; 3],
        /// Its radius.
        found_mm: f64,
        /// Radius of the definition.
        expected_mm: f64,
        /// Deviation allowed.
        allowed_um: f64,
    },
    /// A flank that is not where the definition has it.
    #[error(
        "node {node} of the set \"{set}\" at x {:.4} y {:.4} z {:.4} mm lies {distance_um:.1} um off the {side} flank of tooth \
         {tooth}; {allowed_um:.1} um (0.2 % of the module) are allowed, for the exact profile without microgeometry. {hint}",
        at_mm[0], at_mm[1], at_mm[2]
    )]
    Flank {
        /// Name of the set.
        set: String,
        /// Worst node.
        node: u32,
        /// Where it is.
        at_mm: [f64; 3],
        /// Distance to the profile.
        distance_um: f64,
        /// Side of the tooth.
        side: &'static str,
        /// Tooth.
        tooth: usize,
        /// Distance allowed.
        allowed_um: f64,
        /// What to look at.
        hint: String,
    },
    /// Faces that do not cover the flank.
    #[error(
        "the faces of the set \"{set}\" cover {covered_percent:.2} % of the {side} flank of tooth {tooth}, which reaches from radius \
         {from_mm:.3} to {to_mm:.3} mm over the face width of {width_mm:.3} mm; at least 99 % are needed: put all nodes of the flank in the \
         set, the edges too, and check tooth.face_width_mm (z = 0 is mid-face)"
    )]
    Coverage {
        /// Name of the set.
        set: String,
        /// Share covered.
        covered_percent: f64,
        /// Side of the tooth.
        side: &'static str,
        /// Tooth.
        tooth: usize,
        /// Innermost radius of the flank.
        from_mm: f64,
        /// Outermost radius of the flank.
        to_mm: f64,
        /// Face width.
        width_mm: f64,
    },
    /// Parts that hang together nowhere.
    #[error(
        "the mesh falls into {parts} parts that share no node, the smallest has {nodes} nodes around x {:.3} y {:.3} z {:.3} mm; \
         merge coinciding nodes (gmsh: coherence, removeDuplicateNodes) or remove what does not belong to the gear",
        at_mm[0], at_mm[1], at_mm[2]
    )]
    Parts {
        /// How many parts.
        parts: usize,
        /// Nodes of the smallest.
        nodes: usize,
        /// One of its nodes.
        at_mm: [f64; 3],
    },
    /// The formulation asked for does not fit the elements.
    #[error("mesh.element is {element}, but the mesh has {found} elements only; remove the key")]
    Element {
        /// Formulation asked for.
        element: &'static str,
        /// Kinds found.
        found: String,
    },
}

impl ImportedMeshError {
    /// Whether the mesh file or the definition is at fault.
    pub const fn is_input(&self) -> bool {
        match self {
            Self::Python(failure) => failure.input,
            Self::Exchange(_) => false,
            Self::Misfit { .. } => true,
        }
    }
}

/// What the reader said.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("{message}")]
pub struct PythonFailure {
    /// Its words.
    pub message: String,
    /// Whether the file is at fault.
    pub input: bool,
}
