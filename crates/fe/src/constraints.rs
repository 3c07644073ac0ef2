//! Fixed degrees of freedom: numbering of the free ones, and the way between both numberings.

use crate::error::FeError;

/// Marks a fixed degree of freedom in the map from full to free.
const FIXED: u32 = u32::MAX;

/// The free degrees of freedom in ascending order. Fixed ones have zero displacement.
///
/// Degree of freedom 3 n + a is the displacement of node n along axis a.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct DofMap {
    /// Free number of each degree of freedom, or [`FIXED`].
    free_of_full: Vec<u32>,
    /// Degree of freedom of each free number.
    full_of_free: Vec<u32>,
}

impl DofMap {
    /// Fixes the listed degrees of freedom (repeats allowed) of a model with `node_count` nodes.
    ///
    /// # Errors
    /// [`FeError::TooLarge`], [`FeError::DofOutOfRange`], [`FeError::NothingFree`].
    pub fn with_fixed_dofs(node_count: usize, fixed: &[usize]) -> Result<Self, FeError> {
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
                .ok_or(FeError::DofOutOfRange { dof, dof_count })? = FIXED;
        }
        let mut full_of_free = Vec::with_capacity(dof_count);
        for (dof, free) in free_of_full.iter_mut().enumerate() {
            if *free != FIXED {
                *free = full_of_free.len() as u32;
                full_of_free.push(dof as u32);
            }
        }
        if full_of_free.is_empty() {
            return Err(FeError::NothingFree { dof_count });
        }
        Ok(Self {
            free_of_full,
            full_of_free,
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

    /// Number of free degrees of freedom.
    pub fn free_count(&self) -> usize {
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

    /// Free number of a degree of freedom; `None` where it is fixed or does not exist.
    pub fn free_of(&self, dof: usize) -> Option<usize> {
        self.free_of_full
            .get(dof)
            .filter(|f| **f != FIXED)
            .map(|f| *f as usize)
    }

    /// Degree of freedom of a free number.
    ///
    /// # Panics
    /// If `free` is not below [`DofMap::free_count`].
    pub fn full_of(&self, free: usize) -> usize {
        self.full_of_free[free] as usize
    }

    /// The free degrees of freedom of a node, as pairs (axis, free number).
    pub fn free_of_node(&self, node: usize) -> impl Iterator<Item = (usize, usize)> + '_ {
        (0..3).filter_map(move |axis| self.free_of(3 * node + axis).map(|free| (axis, free)))
    }

    /// Number of free degrees of freedom of a node, 0 to 3.
    pub fn free_count_of_node(&self, node: usize) -> usize {
        self.free_of_node(node).count()
    }

    /// A vector over all degrees of freedom, zero where fixed, from one over the free ones.
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
        full
    }

    /// The entries of the free degrees of freedom of a vector over all of them.
    ///
    /// # Panics
    /// If `full` does not have [`DofMap::dof_count`] entries.
    pub fn restrict(&self, full: &[f64]) -> Vec<f64> {
        assert_eq!(
            full.len(),
            self.dof_count(),
            "length of a vector over all degrees of freedom"
        );
        self.full_of_free
            .iter()
            .map(|dof| full[*dof as usize])
            .collect()
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
