//! Elimination order of the degrees of freedom: nested dissection by METIS on the node graph.
//!
//! The nodes are ordered, not the degrees of freedom: the graph is nine times smaller, and the three degrees of
//! freedom of a node stay together, which is what supernodes want.
//!
//! Source: G. Karypis, V. Kumar, *A fast and high quality multilevel scheme for partitioning irregular graphs*,
//! SIAM J. Sci. Comput. 20 (1998) 359-392 (METIS 5, `METIS_NodeND`).

use std::sync::{Mutex, PoisonError};

use metis_sys as metis;

use crate::compressed_columns::StiffnessMatrix;
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
        let forward = dissect(Adjacency::of_graph(graph)?)?
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

    /// Nested dissection of the interior, then the nodes `late` of the interior, then the kept ones, both in the order
    /// given. Nodes are triples of rows of `k`, of which the lower triangle is read. Late nodes that separate the
    /// others into parts keep what is eliminated in one part out of the other.
    ///
    /// # Errors
    /// [`FeError::TooLarge`]; [`FeError::Metis`]; [`FeError::NotAPermutation`] when a node is listed twice or does not
    /// exist.
    pub fn interior_first(
        k: &StiffnessMatrix,
        late: &[usize],
        kept: &[usize],
    ) -> Result<Self, FeError> {
        let count = k.ncols() / 3;
        let mut place = vec![0i32; count];
        for &node in late.iter().chain(kept) {
            match place.get_mut(node) {
                Some(slot) if *slot == 0 => *slot = -1,
                _ => {
                    return Err(FeError::NotAPermutation {
                        index: node,
                        size: count,
                    });
                }
            }
        }
        let interior: Vec<usize> = (0..count).filter(|n| place[*n] == 0).collect();
        for (i, &node) in interior.iter().enumerate() {
            place[node] = i as i32;
        }
        let mut lists: Vec<Vec<i32>> = vec![Vec::new(); interior.len()];
        for (i, &node) in interior.iter().enumerate() {
            for row in k.as_ref().row_idx_of_col(3 * node) {
                let other = place[row / 3];
                if row / 3 > node && row % 3 == 0 && other >= 0 {
                    lists[i].push(other);
                    lists[other as usize].push(i as i32);
                }
            }
        }
        let order = dissect(Adjacency::new(interior.len(), |i, list| {
            list.extend_from_slice(&lists[i]);
        })?)?;
        let nodes = order.into_iter().map(|i| interior[i as usize]);
        let forward = nodes
            .chain(late.iter().chain(kept).copied())
            .flat_map(|node| 3 * node..3 * node + 3)
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

/// Neighbours of each node as METIS wants them: compressed lists without the node itself.
struct Adjacency {
    offsets: Vec<i32>,
    neighbours: Vec<i32>,
}

impl Adjacency {
    /// # Errors
    /// [`FeError::TooLarge`] when nodes and edges pass 2³¹.
    fn new(nodes: usize, lists: impl Fn(usize, &mut Vec<i32>)) -> Result<Self, FeError> {
        let mut graph = Self {
            offsets: vec![0],
            neighbours: Vec::new(),
        };
        let allowed = i32::MAX as usize;
        for node in 0..nodes {
            lists(node, &mut graph.neighbours);
            let found = graph.neighbours.len();
            if found > allowed {
                return Err(FeError::TooLarge { found, allowed });
            }
            graph.offsets.push(found as i32);
        }
        Ok(graph)
    }

    /// Of the active nodes, numbered by their place among them.
    fn of_graph(graph: &NodeGraph) -> Result<Self, FeError> {
        let nodes = graph.active_nodes();
        Self::new(nodes.len(), |i, list| {
            // Every neighbour listed is active, so the search succeeds.
            let others = graph.neighbours(i).iter().filter(|n| **n != nodes[i]);
            list.extend(others.filter_map(|n| Some(nodes.binary_search(n).ok()? as i32)));
        })
    }
}

/// Order of the nodes: `result[new] = old`.
fn dissect(graph: Adjacency) -> Result<Vec<i32>, FeError> {
    let Adjacency {
        mut offsets,
        mut neighbours,
    } = graph;
    let nodes = offsets.len() - 1;
    if nodes < SMALLEST_DISSECTED {
        return Ok((0..nodes as i32).collect());
    }
    let mut count = nodes as i32;
    let mut order = vec![0i32; nodes];
    let mut inverse = vec![0i32; nodes];
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
            nodes,
            status,
            meaning,
        })
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::{Element, FeModel, Material, StructuredMesh};

    #[test]
    fn dissection_is_a_repeatable_permutation_that_keeps_nodes_together() {
        let mesh = StructuredMesh::block([6, 5, 4], [6.0, 5.0, 4.0]);
        let model = FeModel::new(
            mesh.nodes,
            mesh.hexes,
            Material::new(1.0, 0.3).unwrap(),
            Element::Hex8,
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
