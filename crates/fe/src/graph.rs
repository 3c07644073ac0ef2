//! Which nodes share an element: the pattern of the stiffness and the graph that is dissected.

use rayon::prelude::*;

use crate::constraints::DofMap;
use crate::error::FeError;
use crate::model::FeModel;

/// Lists of small integers, one after the other: list i is `items[offsets[i]..offsets[i + 1]]`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Lists {
    offsets: Vec<usize>,
    items: Vec<u32>,
}

impl Lists {
    pub fn get(&self, i: usize) -> &[u32] {
        &self.items[self.offsets[i]..self.offsets[i + 1]]
    }

    fn from_vecs(lists: &[Vec<u32>]) -> Self {
        let mut offsets = Vec::with_capacity(lists.len() + 1);
        offsets.push(0);
        let mut total = 0;
        for list in lists {
            total += list.len();
            offsets.push(total);
        }
        Self {
            offsets,
            items: lists.concat(),
        }
    }
}

/// Neighbourhood of the nodes that have at least one free degree of freedom ("active" nodes).
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NodeGraph {
    /// Active nodes, ascending.
    active: Vec<u32>,
    /// Active neighbours of each active node as node numbers, ascending, itself included.
    neighbours: Lists,
    /// Elements at each active node, ascending.
    elements: Lists,
}

impl NodeGraph {
    /// The graph of a model under constraints. Cost: linear in the number of elements with a free node.
    ///
    /// # Errors
    /// [`FeError::SizeMismatch`] when the constraints were made for another number of nodes.
    pub fn new(model: &FeModel, dofs: &DofMap) -> Result<Self, FeError> {
        FeError::check_size(
            "the constraint map (nodes)",
            dofs.node_count(),
            model.node_count(),
        )?;
        let is_active: Vec<bool> = (0..model.node_count())
            .map(|n| dofs.free_count_of_node(n) > 0)
            .collect();
        let active: Vec<u32> = (0..model.node_count() as u32)
            .filter(|n| is_active[*n as usize])
            .collect();
        let mut position = vec![u32::MAX; model.node_count()];
        for (i, node) in active.iter().enumerate() {
            position[*node as usize] = i as u32;
        }
        let elements = elements_at_nodes(model, &position, active.len());
        let lists: Vec<Vec<u32>> = (0..active.len())
            .into_par_iter()
            .map(|i| {
                let mut list: Vec<u32> = elements
                    .get(i)
                    .iter()
                    .flat_map(|e| model.element_nodes(*e as usize).iter().copied())
                    .filter(|n| is_active[*n as usize])
                    .collect();
                list.sort_unstable();
                list.dedup();
                list.shrink_to_fit();
                list
            })
            .collect();
        Ok(Self {
            neighbours: Lists::from_vecs(&lists),
            active,
            elements,
        })
    }

    /// Active nodes, ascending.
    pub fn active_nodes(&self) -> &[u32] {
        &self.active
    }

    /// Active neighbours (node numbers, ascending, itself included) of the i-th active node.
    ///
    /// # Panics
    /// If `i` is not below the number of active nodes.
    pub fn neighbours(&self, i: usize) -> &[u32] {
        self.neighbours.get(i)
    }

    /// Elements (ascending) that contain the i-th active node.
    pub(crate) fn elements(&self, i: usize) -> &[u32] {
        self.elements.get(i)
    }
}

/// Count, then fill: the elements at each active node, ascending.
fn elements_at_nodes(model: &FeModel, position: &[u32], active_count: usize) -> Lists {
    let active_of = |element: usize| {
        model
            .element_nodes(element)
            .iter()
            .map(|n| position[*n as usize])
            .filter(|p| *p != u32::MAX)
            .map(|p| p as usize)
    };
    let mut offsets = vec![0usize; active_count + 1];
    for e in 0..model.element_count() {
        for p in active_of(e) {
            offsets[p + 1] += 1;
        }
    }
    for i in 0..active_count {
        offsets[i + 1] += offsets[i];
    }
    let mut next = offsets.clone();
    let mut items = vec![0u32; offsets[active_count]];
    for e in 0..model.element_count() {
        for p in active_of(e) {
            items[next[p]] = e as u32;
            next[p] += 1;
        }
    }
    Lists { offsets, items }
}
