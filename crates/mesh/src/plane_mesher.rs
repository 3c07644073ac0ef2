//! Quads in plane regions whose boundary nodes are all given, by gmsh in a child process.

use crate::python::{PythonEnvironment, PythonError};
use serde::{Deserialize, Serialize};

const SCRIPT: &str = include_str!("plane_mesher.py");

/// Why the regions could not be meshed.
#[derive(Debug, thiserror::Error)]
pub enum PlaneMeshError {
    /// The child process failed.
    #[error(transparent)]
    Python(#[from] PythonError),
    /// It answered something else than a mesh.
    #[error("the mesher's answer cannot be read: {0}")]
    Answer(#[from] serde_json::Error),
    /// It answered for another number of problems or with nodes that do not exist.
    #[error("the mesher's answer does not fit the question: {0}")]
    Mismatch(&'static str),
}

/// A region: loops of point numbers (the outline first, then openings). With corners it is structured, with quads it is
/// meshed already.
#[derive(Debug, Clone, Default, Serialize)]
pub struct Region {
    /// Closed loops of point numbers; the last point is joined to the first.
    pub loops: Vec<Vec<usize>>,
    /// The four corner points of a structured region; empty for a free one.
    pub corners: Vec<usize>,
    /// Its quads where they are given, their inner nodes among the points; none where it is to be meshed.
    pub quads: Vec<[usize; 4]>,
}

/// Regions that share points.
#[derive(Debug, Clone, Serialize)]
pub struct PlaneProblem {
    /// Name in error messages.
    pub name: String,
    /// x \[m\], y \[m\] and wanted element size \[m\].
    pub points: Vec<[f64; 3]>,
    /// Regions.
    #[serde(rename = "surfaces")]
    pub regions: Vec<Region>,
    /// Largest element size \[m\].
    pub largest: f64,
}

/// The mesh of a [`PlaneProblem`]: its points keep their numbers, new nodes follow.
#[derive(Debug, Clone)]
pub struct PlaneMesh {
    /// \[x, y\] \[m\].
    pub nodes: Vec<[f64; 2]>,
    /// Node numbers, counter-clockwise.
    pub quads: Vec<[usize; 4]>,
    /// Nodes in the middle of each quad's sides (side k from corner k to k + 1); none until
    /// [`crate::mid_sides::MidSides::add`] has put them there.
    pub mid_sides: Vec<[usize; 4]>,
    /// Region of each quad.
    pub owners: Vec<usize>,
}

impl PlaneMesh {
    /// Smallest scaled Jacobian of the quads with straight sides: the sine of the angle at a corner, smallest of all.
    /// That of the bricks which stand upright on them.
    pub fn smallest_scaled_jacobian(&self) -> f64 {
        let at_corner = |quad: &[usize; 4], k: usize| {
            let [before, here, after] = [3, 0, 1].map(|step| self.nodes[quad[(k + step) % 4]]);
            let to = |p: [f64; 2]| [p[0] - here[0], p[1] - here[1]];
            let (a, b) = (to(after), to(before));
            (a[0] * b[1] - a[1] * b[0]) / (a[0].hypot(a[1]) * b[0].hypot(b[1]))
        };
        let corners = self
            .quads
            .iter()
            .flat_map(|quad| (0..4).map(move |k| at_corner(quad, k)));
        corners.fold(1.0, f64::min)
    }

    /// Adds a node in the middle of every quad, where the curved sides put it: half the sum of the middles of the sides
    /// less a quarter of that of the corners (Coons' patch). The sides must have their middles.
    pub fn add_centres(&mut self) -> Vec<usize> {
        let first = self.nodes.len();
        for (quad, middles) in self.quads.iter().zip(&self.mid_sides) {
            let sum = |nodes: &[usize; 4], axis: usize| -> f64 {
                nodes.iter().map(|&n| self.nodes[n][axis]).sum()
            };
            let centre = [0, 1].map(|axis| 0.5 * sum(middles, axis) - 0.25 * sum(quad, axis));
            self.nodes.push(centre);
        }
        (first..self.nodes.len()).collect()
    }
}

#[derive(Deserialize)]
struct Answer {
    nodes: Vec<[f64; 2]>,
    quads: Vec<[usize; 4]>,
    owners: Vec<usize>,
}

/// Meshes several problems in one child process.
///
/// # Errors
/// [`PlaneMeshError`] when gmsh fails, when a free region keeps triangles with every algorithm, or when the answer
/// does not fit.
pub fn mesh_plane(
    python: &PythonEnvironment,
    problems: &[PlaneProblem],
) -> Result<Vec<PlaneMesh>, PlaneMeshError> {
    let input = serde_json::to_vec(problems)?;
    let output = python.run("meshing the cross-section", SCRIPT, &[], &input)?;
    let answers: Vec<Answer> = serde_json::from_slice(&output)?;
    if answers.len() != problems.len() {
        return Err(PlaneMeshError::Mismatch("another number of meshes"));
    }
    problems
        .iter()
        .zip(answers)
        .map(|(problem, answer)| {
            let mut nodes: Vec<[f64; 2]> = problem.points.iter().map(|p| [p[0], p[1]]).collect();
            nodes.extend(answer.nodes);
            if answer.owners.len() != answer.quads.len()
                || answer.quads.iter().flatten().any(|&n| n >= nodes.len())
            {
                return Err(PlaneMeshError::Mismatch("a node number is out of range"));
            }
            let quads = answer
                .quads
                .into_iter()
                .map(|q| counter_clockwise(q, &nodes))
                .collect();
            Ok(PlaneMesh {
                nodes,
                quads,
                mid_sides: Vec::new(),
                owners: answer.owners,
            })
        })
        .collect()
}

/// Meshes one problem.
///
/// # Errors
/// As [`mesh_plane`].
pub fn mesh_one(
    python: &PythonEnvironment,
    problem: &PlaneProblem,
) -> Result<PlaneMesh, PlaneMeshError> {
    let mesh = mesh_plane(python, std::slice::from_ref(problem))?.pop();
    mesh.ok_or(PlaneMeshError::Mismatch("another number of meshes"))
}

fn counter_clockwise(q: [usize; 4], nodes: &[[f64; 2]]) -> [usize; 4] {
    let p = q.map(|n| nodes[n]);
    let area =
        (p[2][0] - p[0][0]) * (p[3][1] - p[1][1]) - (p[3][0] - p[1][0]) * (p[2][1] - p[0][1]);
    if area >= 0.0 {
        q
    } else {
        [q[0], q[3], q[2], q[1]]
    }
}
