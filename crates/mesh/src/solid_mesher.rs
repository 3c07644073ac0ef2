//! Quadratic tetrahedra in one sector of a body of revolution, by gmsh in a child process.

use crate::python::{PythonEnvironment, PythonError};
use serde::{Deserialize, Serialize};

const SCRIPT: &str = include_str!("solid_mesher.py");
/// gmsh works in millimetres: its geometric tolerances are absolute.
const MM: f64 = 1e-3;

/// Why the body could not be meshed.
#[derive(Debug, thiserror::Error)]
pub enum SolidMeshError {
    /// The child process failed.
    #[error(transparent)]
    Python(#[from] PythonError),
    /// It answered something else than a mesh.
    #[error("the mesher's answer cannot be read: {0}")]
    Answer(#[from] serde_json::Error),
    /// Its mesh does not meet the teeth or itself.
    #[error("the mesh of the body does not fit: {0}; choose other element sizes in [mesh]")]
    Mismatch(String),
}

/// A closed line in a plane.
#[derive(Debug, Clone, Default, Serialize)]
pub struct PlaneLoop {
    /// Two coordinates and the wanted element size \[mm\]; a size of 0 leaves it to the surroundings.
    pub points: Vec<[f64; 3]>,
    /// Lines (two point numbers) and arcs of less than half a turn (from, centre, to).
    pub edges: Vec<Vec<usize>>,
}

impl PlaneLoop {
    /// Adds a point \[m\] and returns its number.
    pub fn add(&mut self, [a, b]: [f64; 2], size_m: f64) -> usize {
        self.points.push([a / MM, b / MM, size_m / MM]);
        self.points.len() - 1
    }
}

/// A sector of a body of revolution.
#[derive(Debug, Clone, Serialize)]
pub struct SolidProblem {
    /// Name in error messages.
    pub name: String,
    /// Contour in \[r, z\], counter-clockwise.
    pub contour: PlaneLoop,
    /// Outlines of the openings in \[x, y\], cut through along z.
    pub openings: Vec<PlaneLoop>,
    /// Radius of the cylinder on which the teeth stand \[mm\].
    pub ring_radius: f64,
    /// Pieces of the ring round the axis, in each of the sector's pieces.
    pub ring_arcs: usize,
    /// Pieces of the ring along the axis.
    pub ring_layers: usize,
    /// Polar angle at which the sector begins \[rad\].
    pub start: f64,
    /// Its angle \[rad\].
    pub angle: f64,
    /// Whether it is the whole body.
    pub closed: bool,
    /// Pieces that it is revolved in.
    pub pieces: usize,
    /// Largest element size \[mm\].
    pub largest: f64,
    /// Elements on a full turn of a curved surface, at least.
    pub elements_per_turn: f64,
}

/// The mesh of a [`SolidProblem`].
#[derive(Debug, Clone)]
pub struct SolidMesh {
    /// \[x, y, z\] \[m\].
    pub nodes: Vec<[f64; 3]>,
    /// Node numbers, VTK order.
    pub elements: Vec<[usize; 10]>,
    /// Nodes on the side at the larger angle, and the nodes at the smaller angle that turn into them.
    pub left_right: Vec<[usize; 2]>,
}

#[derive(Deserialize)]
struct Answer {
    nodes: Vec<[f64; 3]>,
    elements: Vec<[usize; 10]>,
    left_right: Vec<[usize; 2]>,
}

/// Meshes a sector in a child process.
///
/// # Errors
/// [`SolidMeshError`] when gmsh fails or the answer does not fit.
pub fn mesh_solid(
    python: &PythonEnvironment,
    problem: &SolidProblem,
) -> Result<SolidMesh, SolidMeshError> {
    let input = serde_json::to_vec(problem)?;
    let output = python.run("meshing the body in tetrahedra", SCRIPT, &[], &input)?;
    let answer: Answer = serde_json::from_slice(&output)?;
    let count = answer.nodes.len();
    let named = answer.elements.as_flattened().iter();
    if named
        .chain(answer.left_right.as_flattened())
        .any(|&n| n >= count)
    {
        return Err(SolidMeshError::Mismatch(
            "a node number is out of range".into(),
        ));
    }
    Ok(SolidMesh {
        nodes: answer.nodes.iter().map(|p| p.map(|v| v * MM)).collect(),
        elements: answer.elements,
        left_right: answer.left_right,
    })
}
