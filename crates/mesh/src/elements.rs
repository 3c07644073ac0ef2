//! Elements of one kind as a flat list of node numbers.

use gearmesh_geometry::ElementKind;

/// Kind of an element by its nodes; the formulation (incompatible modes or none) is no matter of the mesh.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ElementShape {
    /// Hexahedron with eight nodes, VTK order.
    Hex8,
    /// Hexahedron with twenty nodes, VTK order: the corners first, then the middles of the edges.
    Hex20,
    /// Tetrahedron with ten nodes, VTK order: the corners first, then the middles of the edges.
    Tet10,
}

impl ElementShape {
    /// The shape of an element that a definition names.
    pub const fn of(kind: ElementKind) -> Self {
        match kind {
            ElementKind::Hex8 | ElementKind::Hex8Incompatible => Self::Hex8,
            ElementKind::Hex20 => Self::Hex20,
            ElementKind::Tet10 => Self::Tet10,
        }
    }

    /// Number of nodes.
    pub const fn node_count(self) -> usize {
        match self {
            Self::Hex8 => 8,
            Self::Hex20 => 20,
            Self::Tet10 => 10,
        }
    }

    /// Name of such elements in prints.
    pub const fn plural(self) -> &'static str {
        match self {
            Self::Hex8 | Self::Hex20 => "hexahedra",
            Self::Tet10 => "tetrahedra",
        }
    }

    /// True for those with nodes in the middle of their edges.
    pub const fn is_quadratic(self) -> bool {
        !matches!(self, Self::Hex8)
    }

    /// Number of corners; they are the first nodes of an element.
    pub const fn corner_count(self) -> usize {
        match self {
            Self::Hex8 | Self::Hex20 => 8,
            Self::Tet10 => 4,
        }
    }
}

/// Elements of one shape.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ElementList {
    shape: ElementShape,
    connectivity: Vec<u32>,
}

impl ElementList {
    /// No elements yet.
    pub const fn new(shape: ElementShape) -> Self {
        Self {
            shape,
            connectivity: Vec::new(),
        }
    }

    /// Adds an element and returns its number.
    ///
    /// # Panics
    /// If `nodes` yields another number of nodes than the shape has.
    pub fn push(&mut self, nodes: impl IntoIterator<Item = u32>) -> u32 {
        let number = self.len();
        self.connectivity.extend(nodes);
        assert_eq!(
            self.connectivity.len(),
            (number + 1) * self.shape.node_count(),
            "an element has {} nodes",
            self.shape.node_count()
        );
        number as u32
    }

    /// Their shape.
    pub const fn shape(&self) -> ElementShape {
        self.shape
    }

    /// Number of elements.
    pub const fn len(&self) -> usize {
        self.connectivity.len() / self.shape.node_count()
    }

    /// True when there are none.
    pub const fn is_empty(&self) -> bool {
        self.connectivity.is_empty()
    }

    /// Nodes of an element.
    ///
    /// # Panics
    /// If `element` is not below [`ElementList::len`].
    pub fn nodes(&self, element: u32) -> &[u32] {
        let n = self.shape.node_count();
        &self.connectivity[n * element as usize..][..n]
    }

    /// The nodes of each element.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = &[u32]> {
        self.connectivity.chunks_exact(self.shape.node_count())
    }

    /// Node numbers, element by element.
    pub fn connectivity(&self) -> &[u32] {
        &self.connectivity
    }
}
