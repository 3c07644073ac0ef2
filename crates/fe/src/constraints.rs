//! Constraints u = T q: degrees of freedom that are fixed, nodes that move rigidly, and the way between u and q.

use crate::error::FeError;
use crate::rigid_group::{self, RigidGroup};

/// Marks a degree of freedom that is not free itself, in the map from full to free.
const NOT_FREE: u32 = u32::MAX;

/// A rigid node: its group and its place relative to the reference point.
#[derive(Debug, Clone, PartialEq)]
struct RigidNode {
    node: u32,
    group: u32,
    arm_m: [f64; 3],
}

/// The free unknowns q of a model, and the displacements u = T q that follow from them.
///
/// Degree of freedom 3 n + a of u is the displacement of node n along axis a. q holds the free ones of u in ascending
/// order, and after them the free degrees of freedom of the reference points of [`RigidGroup`]s. Fixed ones are zero.
#[derive(Debug, Clone, PartialEq)]
pub struct DofMap {
    /// Free number of each degree of freedom, or [`NOT_FREE`].
    free_of_full: Vec<u32>,
    /// Degree of freedom of each free number, reference points apart.
    full_of_free: Vec<u32>,
    /// Nodes of all rigid groups, ascending.
    rigid_nodes: Vec<RigidNode>,
    /// Free number of each degree of freedom of each reference point.
    reference_free: Vec<[Option<usize>; 6]>,
    free_count: usize,
}

impl DofMap {
    /// Fixes the listed degrees of freedom (repeats allowed) of a model with `node_count` nodes.
    ///
    /// # Errors
    /// [`FeError::TooLarge`], [`FeError::DofOutOfRange`], [`FeError::NothingFree`].
    pub fn with_fixed_dofs(node_count: usize, fixed: &[usize]) -> Result<Self, FeError> {
        Self::build(node_count, fixed, &[], |_| [0.0; 3])
    }

    /// Fixes the listed degrees of freedom and ties each group of nodes (none of them fixed or in two groups) to its
    /// reference point. `nodes`: coordinates (m) of the model.
    ///
    /// # Errors
    /// As [`DofMap::with_fixed_dofs`]; [`FeError::RigidNodeTwice`].
    pub fn with_rigid_groups(
        nodes: &[[f64; 3]],
        fixed: &[usize],
        groups: &[RigidGroup],
    ) -> Result<Self, FeError> {
        Self::build(nodes.len(), fixed, groups, |node| nodes[node])
    }

    fn build(
        node_count: usize,
        fixed: &[usize],
        groups: &[RigidGroup],
        position: impl Fn(usize) -> [f64; 3],
    ) -> Result<Self, FeError> {
        let dof_count = 3 * node_count;
        let allowed = i32::MAX as usize;
        if dof_count > allowed {
            return Err(FeError::TooLarge {
                found: dof_count,
                allowed,
            });
        }
        let mut free_of_full = vec![0; dof_count];
        for &dof in fixed {
            *free_of_full
                .get_mut(dof)
                .ok_or(FeError::DofOutOfRange { dof, dof_count })? = NOT_FREE;
        }
        let mut rigid_nodes = Vec::new();
        for (group, rigid) in groups.iter().enumerate() {
            for &node in &rigid.nodes {
                let dof = 3 * node;
                let its_dofs = free_of_full
                    .get_mut(dof..dof + 3)
                    .ok_or(FeError::DofOutOfRange { dof, dof_count })?;
                if its_dofs.contains(&NOT_FREE) {
                    return Err(FeError::RigidNodeTwice { node });
                }
                its_dofs.fill(NOT_FREE);
                let place = position(node);
                rigid_nodes.push(RigidNode {
                    node: node as u32,
                    group: group as u32,
                    arm_m: std::array::from_fn(|k| place[k] - rigid.reference_m[k]),
                });
            }
        }
        rigid_nodes.sort_unstable_by_key(|r| r.node);
        let mut full_of_free = Vec::with_capacity(dof_count);
        for (dof, free) in free_of_full.iter_mut().enumerate() {
            if *free != NOT_FREE {
                *free = full_of_free.len() as u32;
                full_of_free.push(dof as u32);
            }
        }
        let mut free_count = full_of_free.len();
        let reference_free = groups
            .iter()
            .map(|rigid| {
                rigid.fixed.map(|fixed| {
                    free_count += usize::from(!fixed);
                    (!fixed).then(|| free_count - 1)
                })
            })
            .collect();
        if free_count == 0 {
            return Err(FeError::NothingFree { dof_count });
        }
        Ok(Self {
            free_of_full,
            full_of_free,
            rigid_nodes,
            reference_free,
            free_count,
        })
    }

    /// Fixes all three displacements of the listed nodes.
    ///
    /// # Errors
    /// As [`DofMap::with_fixed_dofs`].
    pub fn with_fixed_nodes(node_count: usize, nodes: &[usize]) -> Result<Self, FeError> {
        let fixed: Vec<usize> = nodes
            .iter()
            .flat_map(|n| [3 * n, 3 * n + 1, 3 * n + 2])
            .collect();
        Self::with_fixed_dofs(node_count, &fixed)
    }

    /// Everything free: the stiffness is then singular and serves for products only.
    ///
    /// # Errors
    /// [`FeError::NothingFree`] for a model without nodes; [`FeError::TooLarge`].
    pub fn all_free(node_count: usize) -> Result<Self, FeError> {
        Self::with_fixed_dofs(node_count, &[])
    }

    /// Number of free unknowns, those of the reference points included: the size of K.
    pub fn free_count(&self) -> usize {
        self.free_count
    }

    /// Number of unknowns that are displacements of single nodes; those of the reference points follow.
    pub fn nodal_free_count(&self) -> usize {
        self.full_of_free.len()
    }

    /// Number of all degrees of freedom.
    pub fn dof_count(&self) -> usize {
        self.free_of_full.len()
    }

    /// Number of nodes.
    pub fn node_count(&self) -> usize {
        self.free_of_full.len() / 3
    }

    /// Free number of a degree of freedom; `None` where it is fixed, rigid or does not exist.
    pub fn free_of(&self, dof: usize) -> Option<usize> {
        self.free_of_full
            .get(dof)
            .filter(|f| **f != NOT_FREE)
            .map(|f| *f as usize)
    }

    /// Degree of freedom of a free number.
    ///
    /// # Panics
    /// If `free` is not below [`DofMap::nodal_free_count`].
    pub fn full_of(&self, free: usize) -> usize {
        self.full_of_free[free] as usize
    }

    /// Free number of a degree of freedom (x, y, z, rotations about x, y, z) of the reference point of a group; `None`
    /// where it is fixed.
    ///
    /// # Panics
    /// If there is no such group or `component` is not below 6.
    pub fn free_of_reference(&self, group: usize, component: usize) -> Option<usize> {
        self.reference_free[group][component]
    }

    /// The free degrees of freedom of a node, as pairs (axis, free number); none for a rigid node.
    pub fn free_of_node(&self, node: usize) -> impl Iterator<Item = (usize, usize)> + '_ {
        (0..3).filter_map(move |axis| self.free_of(3 * node + axis).map(|free| (axis, free)))
    }

    /// Number of free degrees of freedom of a node, 0 to 3.
    pub fn free_count_of_node(&self, node: usize) -> usize {
        self.free_of_node(node).count()
    }

    /// Whether a node belongs to a rigid group.
    pub(crate) fn is_rigid(&self, node: u32) -> bool {
        self.rigid_nodes
            .binary_search_by_key(&node, |r| r.node)
            .is_ok()
    }

    /// The row of T of a degree of freedom: (free number, factor), empty where it is fixed.
    pub(crate) fn row(&self, dof: usize) -> Vec<(usize, f64)> {
        if let Some(free) = self.free_of(dof) {
            return vec![(free, 1.0)];
        }
        let node = (dof / 3) as u32;
        match self.rigid_nodes.binary_search_by_key(&node, |r| r.node) {
            Ok(place) => self.rigid_row(&self.rigid_nodes[place], dof % 3).collect(),
            Err(_) => Vec::new(),
        }
    }

    fn rigid_row(
        &self,
        rigid: &RigidNode,
        axis: usize,
    ) -> impl Iterator<Item = (usize, f64)> + use<> {
        let free = self.reference_free[rigid.group as usize];
        let factors = rigid_group::row(rigid.arm_m, axis);
        (0..6)
            .filter_map(move |q| Some((free[q]?, factors[q])).filter(|(_, factor)| *factor != 0.0))
    }

    /// u = T q: displacements of all degrees of freedom, zero where fixed, from the free unknowns.
    ///
    /// # Panics
    /// If `free` does not have [`DofMap::free_count`] entries.
    pub fn expand(&self, free: &[f64]) -> Vec<f64> {
        assert_eq!(
            free.len(),
            self.free_count(),
            "length of a vector over the free degrees of freedom"
        );
        let mut full = vec![0.0; self.dof_count()];
        for (value, dof) in free.iter().zip(&self.full_of_free) {
            full[*dof as usize] = *value;
        }
        for rigid in &self.rigid_nodes {
            for axis in 0..3 {
                let row = self.rigid_row(rigid, axis);
                full[3 * rigid.node as usize + axis] =
                    row.map(|(q, factor)| factor * free[q]).sum();
            }
        }
        full
    }

    /// Tᵀ f: generalised forces on the free unknowns from the forces on all degrees of freedom. On a node's own degree
    /// of freedom it is the force there, on a reference point force and moment of its group; what acts on fixed ones
    /// goes into the support.
    ///
    /// # Panics
    /// If `full` does not have [`DofMap::dof_count`] entries.
    pub fn restrict(&self, full: &[f64]) -> Vec<f64> {
        assert_eq!(
            full.len(),
            self.dof_count(),
            "length of a vector over all degrees of freedom"
        );
        let mut free = vec![0.0; self.free_count()];
        for (value, dof) in free.iter_mut().zip(&self.full_of_free) {
            *value = full[*dof as usize];
        }
        for rigid in &self.rigid_nodes {
            for axis in 0..3 {
                for (q, factor) in self.rigid_row(rigid, axis) {
                    free[q] += factor * full[3 * rigid.node as usize + axis];
                }
            }
        }
        free
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn restrict_undoes_expand() {
        let map = DofMap::with_fixed_dofs(3, &[0, 4, 4, 8]).unwrap();
        assert_eq!(map.free_count(), 6);
        let free = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0];
        let full = map.expand(&free);
        assert_eq!(full, [0.0, 1.0, 2.0, 3.0, 0.0, 4.0, 5.0, 6.0, 0.0]);
        assert_eq!(map.restrict(&full), free);
        assert_eq!(map.free_of(4), None);
        assert_eq!(map.full_of(3), 5);
        assert_eq!(map.free_of_node(1).collect::<Vec<_>>(), [(0, 2), (2, 3)]);
    }

    #[test]
    fn bad_constraints_are_refused() {
        assert_eq!(
            DofMap::with_fixed_dofs(1, &[3]),
            Err(FeError::DofOutOfRange {
                dof: 3,
                dof_count: 3
            })
        );
        assert_eq!(
            DofMap::with_fixed_nodes(1, &[0]),
            Err(FeError::NothingFree { dof_count: 3 })
        );
    }
}
