//! The volume elements that a mesh can have, by their nodes.

/// The corners at the ends of each edge of a hexahedron; edge k carries node 8 + k of one with twenty nodes.
pub const HEX_EDGES: [[usize; 2]; 12] = [
    [0, 1],
    [1, 2],
    [2, 3],
    [3, 0],
    [4, 5],
    [5, 6],
    [6, 7],
    [7, 4],
    [0, 4],
    [1, 5],
    [2, 6],
    [3, 7],
];

/// The corners at the ends of each edge of a tetrahedron; edge k carries node 4 + k of one with ten nodes.
pub const TET_EDGES: [[usize; 2]; 6] = [[0, 1], [1, 2], [2, 0], [0, 3], [1, 3], [2, 3]];

/// Natural coordinates of the nodes of a tetrahedron: the corners, then the middles of [`TET_EDGES`].
pub const TET_NODES: [[f64; 3]; 10] = [
    [0.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, 1.0],
    [0.5, 0.0, 0.0],
    [0.5, 0.5, 0.0],
    [0.0, 0.5, 0.0],
    [0.0, 0.0, 0.5],
    [0.5, 0.0, 0.5],
    [0.0, 0.5, 0.5],
];

/// The corners at the ends of each edge of a wedge; edge k carries node 6 + k of one with fifteen nodes.
pub const WEDGE_EDGES: [[usize; 2]; 9] = [
    [0, 1],
    [1, 2],
    [2, 0],
    [3, 4],
    [4, 5],
    [5, 3],
    [0, 3],
    [1, 4],
    [2, 5],
];

/// Kind of a volume element. Node order as in VTK, except that wedges number their lower triangle counter-clockwise
/// seen from the upper one, as Abaqus and gmsh do.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum CellKind {
    /// Hexahedron: 0-3 round the bottom, counter-clockwise seen from the top; 4-7 above them.
    Hex8,
    /// Hexahedron with a node on every edge: 0-1, 1-2, 2-3, 3-0, the same above, then 0-4, 1-5, 2-6, 3-7.
    Hex20,
    /// Tetrahedron with a node on every edge: 0-1, 1-2, 2-0, 0-3, 1-3, 2-3.
    Tet10,
    /// Wedge: 0-2 the bottom, 3-5 above them.
    Wedge6,
    /// Wedge with a node on every edge: 0-1, 1-2, 2-0, the same above, then 0-3, 1-4, 2-5.
    Wedge15,
}

impl CellKind {
    /// Every kind.
    pub const ALL: [Self; 5] = [
        Self::Hex8,
        Self::Hex20,
        Self::Tet10,
        Self::Wedge6,
        Self::Wedge15,
    ];

    /// The name in files and messages.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Hex8 => "hex8",
            Self::Hex20 => "hex20",
            Self::Tet10 => "tet10",
            Self::Wedge6 => "wedge6",
            Self::Wedge15 => "wedge15",
        }
    }

    /// The kind with this name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| kind.name() == name)
    }

    /// Number of nodes; the corners come first.
    pub const fn node_count(self) -> usize {
        match self {
            Self::Hex8 => 8,
            Self::Hex20 => 20,
            Self::Tet10 => 10,
            Self::Wedge6 => 6,
            Self::Wedge15 => 15,
        }
    }

    /// Number of corners.
    pub const fn corner_count(self) -> usize {
        match self {
            Self::Hex8 | Self::Hex20 => 8,
            Self::Tet10 => 4,
            Self::Wedge6 | Self::Wedge15 => 6,
        }
    }

    /// Name of such elements in prints.
    pub const fn plural(self) -> &'static str {
        match self {
            Self::Hex8 | Self::Hex20 => "hexahedra",
            Self::Tet10 => "tetrahedra",
            Self::Wedge6 | Self::Wedge15 => "wedges",
        }
    }

    /// The corners at the ends of each edge, whether it carries a node or not.
    pub const fn edges(self) -> &'static [[usize; 2]] {
        match self {
            Self::Hex8 | Self::Hex20 => &HEX_EDGES,
            Self::Tet10 => &TET_EDGES,
            Self::Wedge6 | Self::Wedge15 => &WEDGE_EDGES,
        }
    }

    /// Whether there are nodes on the edges. Faces of the two sorts do not fit together.
    pub const fn is_quadratic(self) -> bool {
        matches!(self, Self::Hex20 | Self::Tet10 | Self::Wedge15)
    }

    /// Neighbours of each corner along its three edges, in right-handed order.
    pub const fn corner_edges(self) -> &'static [[usize; 3]] {
        match self {
            Self::Hex8 | Self::Hex20 => &[
                [1, 3, 4],
                [2, 0, 5],
                [3, 1, 6],
                [0, 2, 7],
                [7, 5, 0],
                [4, 6, 1],
                [5, 7, 2],
                [6, 4, 3],
            ],
            Self::Tet10 => &[[1, 2, 3], [2, 0, 3], [0, 1, 3], [0, 2, 1]],
            Self::Wedge6 | Self::Wedge15 => &[
                [1, 2, 3],
                [2, 0, 4],
                [0, 1, 5],
                [5, 4, 0],
                [3, 5, 1],
                [4, 3, 2],
            ],
        }
    }
}
