//! Elimination order of the degrees of freedom: nested dissection by METIS on the node graph.
//!
//! The nodes are ordered, not the degrees of freedom: the graph is nine times smaller, and the three degrees of
//! freedom of a node stay together, which is what supernodes want.
//!
//! Source: G. Karypis, V. Kumar, *A fast and high quality multilevel scheme for partitioning irregular graphs*,
//! SIAM J. Sci. Comput. 20 (1998) 359-392 (METIS 5, `METIS_NodeND`).

use std::sync::{Mutex, PoisonError};

use metis_sys as metis;

use crate::constraints::DofMap;
use crate::error::FeError;
use crate::graph::NodeGraph;

/// Below this many nodes the natural order costs nothing, and METIS has little to dissect.
const SMALLEST_DISSECTED: usize = 64;

/// METIS draws from the C library's random numbers, seeded at each call. Calls that ran side by side would take
/// numbers from one another and the order would differ from run to run.
static METIS_AT_A_TIME: Mutex<()> = Mutex::new(());

/// An order of elimination of the free degrees of freedom.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct DofOrdering {
    /// `forward[new] = old`.
    forward: Vec<usize>,
    /// `inverse[old] = new`.
    inverse: Vec<usize>,
}

impl DofOrdering {
    /// Nested dissection of the node graph, expanded to the free degrees of freedom. The same graph gives the
    /// same order in every run.
    ///
    /// # Errors
    /// [`FeError::TooLarge`] when nodes and edges pass 2³¹; [`FeError::Metis`].
    pub fn nested_dissection(graph: &NodeGraph, dofs: &DofMap) -> Result<Self, FeError> {
        let nodes = graph.active_nodes();
        let order = if nodes.len() < SMALLEST_DISSECTED {
            (0..nodes.len() as i32).collect()
        } else {
            dissect(graph)?
        };
        let forward = order
            .into_iter()
            .flat_map(|place| {
                dofs.free_of_node(nodes[place as usize] as usize)
                    .map(|(_, free)| free)
            })
            // The few unknowns of reference points touch many nodes: eliminated last they fill in nothing.
            .chain(dofs.nodal_free_count()..dofs.free_count())
            .collect();
        Self::from_forward(forward)
    }

    /// An order given by `forward[new] = old`.
    ///
    /// # Errors
    /// [`FeError::NotAPermutation`].
    pub fn from_forward(forward: Vec<usize>) -> Result<Self, FeError> {
        let size = forward.len();
        let mut inverse = vec![usize::MAX; size];
        for (new, &old) in forward.iter().enumerate() {
            match inverse.get_mut(old) {
                Some(slot) if *slot == usize::MAX => *slot = new,
                _ => return Err(FeError::NotAPermutation { index: old, size }),
            }
        }
        Ok(Self { forward, inverse })
    }

    /// The order of the numbering itself.
    pub fn natural(size: usize) -> Self {
        Self {
            forward: (0..size).collect(),
            inverse: (0..size).collect(),
        }
    }

    /// Old number of each new number.
    pub fn forward(&self) -> &[usize] {
        &self.forward
    }

    /// New number of each old number.
    pub fn inverse(&self) -> &[usize] {
        &self.inverse
    }
}

/// Order of the active nodes: `result[new] = place among the active nodes`.
fn dissect(graph: &NodeGraph) -> Result<Vec<i32>, FeError> {
    let nodes = graph.active_nodes();
    let allowed = i32::MAX as usize;
    let edges: usize = (0..nodes.len())
        .map(|i| graph.neighbours(i).len() - 1)
        .sum();
    if edges > allowed {
        return Err(FeError::TooLarge {
            found: edges,
            allowed,
        });
    }
    let mut offsets: Vec<i32> = Vec::with_capacity(nodes.len() + 1);
    let mut neighbours: Vec<i32> = Vec::with_capacity(edges);
    offsets.push(0);
    for (i, node) in nodes.iter().enumerate() {
        for other in graph.neighbours(i).iter().filter(|n| *n != node) {
            // Every neighbour listed is active, so the search succeeds.
            if let Ok(place) = nodes.binary_search(other) {
                neighbours.push(place as i32);
            }
        }
        offsets.push(neighbours.len() as i32);
    }
    let mut count = nodes.len() as i32;
    let mut order = vec![0i32; nodes.len()];
    let mut inverse = vec![0i32; nodes.len()];
    let mut options = [0i32; metis::METIS_NOPTIONS as usize];
    let guard = METIS_AT_A_TIME
        .lock()
        .unwrap_or_else(PoisonError::into_inner);
    // SAFETY: `options` has the METIS_NOPTIONS entries that METIS_SetDefaultOptions writes.
    #[allow(unsafe_code)]
    unsafe {
        metis::METIS_SetDefaultOptions(options.as_mut_ptr());
    }
    options[metis::moptions_et_METIS_OPTION_SEED as usize] = 1;
    options[metis::moptions_et_METIS_OPTION_NUMBERING as usize] = 0;
    // SAFETY: compressed adjacency as METIS wants it: `offsets` has count + 1 ascending entries, the last one equal
    // to the length of `neighbours`; all neighbours lie in 0..count, the graph is symmetric and has no loops
    // (sharing an element is mutual, and a node is filtered out of its own list). `order` and `inverse` have count
    // entries each. A null vertex weight means unit weights. METIS keeps no pointer after it returns.
    #[allow(unsafe_code)]
    let status = unsafe {
        metis::METIS_NodeND(
            &mut count,
            offsets.as_mut_ptr(),
            neighbours.as_mut_ptr(),
            std::ptr::null_mut(),
            options.as_mut_ptr(),
            order.as_mut_ptr(),
            inverse.as_mut_ptr(),
        )
    };
    drop(guard);
    if status == metis::rstatus_et_METIS_OK {
        Ok(order)
    } else {
        let meaning = match status {
            metis::rstatus_et_METIS_ERROR_INPUT => "input error",
            metis::rstatus_et_METIS_ERROR_MEMORY => "out of memory",
            _ => "internal error",
        };
        Err(FeError::Metis {
            nodes: nodes.len(),
            status,
            meaning,
        })
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::{FeModel, HexElement, Material, StructuredMesh};

    #[test]
    fn dissection_is_a_repeatable_permutation_that_keeps_nodes_together() {
        let mesh = StructuredMesh::block([6, 5, 4], [6.0, 5.0, 4.0]);
        let model = FeModel::new(
            mesh.nodes,
            mesh.hexes,
            Material::new(1.0, 0.3).unwrap(),
            HexElement::Hex8,
        )
        .unwrap();
        let dofs = DofMap::with_fixed_dofs(model.node_count(), &[0, 1, 2, 10]).unwrap();
        let graph = NodeGraph::new(&model, &dofs).unwrap();
        let order = DofOrdering::nested_dissection(&graph, &dofs).unwrap();
        assert_eq!(order.forward().len(), dofs.free_count());
        assert_eq!(
            order,
            DofOrdering::nested_dissection(&graph, &dofs).unwrap()
        );
        assert_ne!(order, DofOrdering::natural(dofs.free_count()));
        // The degrees of freedom of a node are consecutive.
        let mut changes = 0;
        for pair in order.forward().windows(2) {
            changes += usize::from(dofs.full_of(pair[0]) / 3 != dofs.full_of(pair[1]) / 3);
        }
        assert_eq!(changes + 1, graph.active_nodes().len());
    }

    #[test]
    fn a_list_with_a_repeat_is_no_order() {
        assert_eq!(
            DofOrdering::from_forward(vec![0, 2, 2]),
            Err(FeError::NotAPermutation { index: 2, size: 3 })
        );
    }
}
