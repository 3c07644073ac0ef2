//! Elements of one kind as a flat list of node numbers.

use gearmesh_elements::CellKind;

/// Elements of one shape.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ElementList {
    shape: CellKind,
    connectivity: Vec<u32>,
}

impl ElementList {
    /// No elements yet.
    pub const fn new(shape: CellKind) -> Self {
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
    pub const fn shape(&self) -> CellKind {
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

/// Nodes of a section and levels of the hexahedron above a quad from the level `low` on, in VTK's order; with nodes in
/// the middle of the quad's sides that of a quadratic one, which reaches over two steps.
pub(crate) fn brick(
    corners: [usize; 4],
    middles: Option<[usize; 4]>,
    low: usize,
) -> Vec<(usize, usize)> {
    let at = |nodes: [usize; 4], level: usize| nodes.map(|node| (node, level));
    match middles {
        None => [at(corners, low), at(corners, low + 1)].concat(),
        Some(middles) => [
            at(corners, low),
            at(corners, low + 2),
            at(middles, low),
            at(middles, low + 2),
            at(corners, low + 1),
        ]
        .concat(),
    }
}
