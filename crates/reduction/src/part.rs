//! A part of the whole model: some of its elements with nodes numbered anew.

use gearmesh_fe::{FeError, FeModel};

/// A part of a finite element model.
pub struct Part {
    /// Node of the whole model of each node of the part, ascending.
    pub nodes: Vec<u32>,
    /// The part on its own.
    pub model: FeModel,
}

impl Part {
    /// The part made of the given elements.
    ///
    /// # Errors
    /// [`FeError::NoElements`] when there are none.
    pub fn new(whole: &FeModel, elements: &[u32]) -> Result<Self, FeError> {
        let (nodes, model) = whole.part(elements)?;
        Ok(Self { nodes, model })
    }

    /// Number in the part of a node of the whole model.
    pub fn place(&self, node: u32) -> Option<usize> {
        self.nodes.binary_search(&node).ok()
    }
}
