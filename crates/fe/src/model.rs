//! The finite element model: nodes, hexahedra, material and element, checked once.

use rayon::prelude::*;

use crate::element::{HexElement, StrainOperator};
use crate::element_matrix::ElementMatrix;
use crate::error::FeError;
use crate::material::Material;

/// Nodes, hexahedra, one material, one element formulation. Valid by construction.
#[derive(Debug, Clone, PartialEq)]
pub struct FeModel {
    nodes: Vec<[f64; 3]>,
    /// Node indices, element by element; their number an element is that of the formulation.
    connectivity: Vec<u32>,
    material: Material,
    element: HexElement,
}

impl FeModel {
    /// Checks and keeps a mesh.
    ///
    /// `nodes`: coordinates (m). `hexes`: node indices in VTK order (bottom 0-3 counter-clockwise, top 4-7, then for
    /// twenty nodes the edges), `[u32; 8]` or `[u32; 20]` as the element demands.
    ///
    /// # Errors
    /// [`FeError::NodesPerElement`] and those of [`FeModel::from_connectivity`].
    pub fn new<const N: usize>(
        nodes: Vec<[f64; 3]>,
        hexes: Vec<[u32; N]>,
        material: Material,
        element: HexElement,
    ) -> Result<Self, FeError> {
        if N != element.node_count() {
            return Err(FeError::NodesPerElement {
                element: element.name(),
                found: N,
                expected: element.node_count(),
            });
        }
        Self::from_connectivity(nodes, hexes.into_flattened(), material, element)
    }

    /// Checks and keeps a mesh whose node indices stand one element after the other in a flat list.
    ///
    /// # Errors
    /// [`FeError::SizeMismatch`] when the list does not hold whole elements, [`FeError::NoElements`], [`FeError::TooLarge`],
    /// [`FeError::CoordinateNotFinite`], [`FeError::NodeOutOfRange`], [`FeError::NodeWithoutElement`], and
    /// [`FeError::Element`] naming the first element whose Jacobian is not positive at all Gauss points, nodes and the centre.
    pub fn from_connectivity(
        nodes: Vec<[f64; 3]>,
        connectivity: Vec<u32>,
        material: Material,
        element: HexElement,
    ) -> Result<Self, FeError> {
        if connectivity.is_empty() {
            return Err(FeError::NoElements { nodes: nodes.len() });
        }
        let per_element = element.node_count();
        if !connectivity.len().is_multiple_of(per_element) {
            return Err(FeError::SizeMismatch {
                what: "the connectivity",
                found: connectivity.len(),
                expected: connectivity.len().next_multiple_of(per_element),
            });
        }
        let element_count = connectivity.len() / per_element;
        // METIS counts in 32 bits; a third of that leaves room for three degrees of freedom per node.
        let allowed = i32::MAX as usize / 3;
        if nodes.len().max(element_count) > allowed {
            return Err(FeError::TooLarge {
                found: nodes.len().max(element_count),
                allowed,
            });
        }
        for (node, coordinates) in nodes.iter().enumerate() {
            if !coordinates.iter().all(|v| v.is_finite()) {
                return Err(FeError::CoordinateNotFinite {
                    node,
                    coordinates_m: *coordinates,
                });
            }
        }
        let mut used = vec![false; nodes.len()];
        for (element, own) in connectivity.chunks_exact(per_element).enumerate() {
            for &node in own {
                match used.get_mut(node as usize) {
                    Some(flag) => *flag = true,
                    None => {
                        return Err(FeError::NodeOutOfRange {
                            element,
                            node,
                            node_count: nodes.len(),
                        });
                    }
                }
            }
        }
        if let Some(node) = used.iter().position(|u| !u) {
            return Err(FeError::NodeWithoutElement { node });
        }
        let model = Self {
            nodes,
            connectivity,
            material,
            element,
        };
        let broken = (0..model.element_count())
            .into_par_iter()
            .find_map_first(|e| {
                let checked = element.check_shape(&model.gather(e));
                checked.err().map(|source| (e, source))
            });
        match broken {
            Some((element, source)) => Err(FeError::Element { element, source }),
            None => Ok(model),
        }
    }

    /// The same mesh with another formulation of as many nodes.
    ///
    /// # Errors
    /// [`FeError::NodesPerElement`].
    pub fn with_element(self, element: HexElement) -> Result<Self, FeError> {
        if element.node_count() != self.element.node_count() {
            return Err(FeError::NodesPerElement {
                element: element.name(),
                found: self.element.node_count(),
                expected: element.node_count(),
            });
        }
        Ok(Self { element, ..self })
    }

    /// The part made of some elements, on its own; and the node of this model of each of its nodes, ascending.
    ///
    /// # Errors
    /// [`FeError::NoElements`] when `elements` is empty.
    ///
    /// # Panics
    /// If an element is not below [`FeModel::element_count`].
    pub fn part(&self, elements: &[u32]) -> Result<(Vec<u32>, Self), FeError> {
        if elements.is_empty() {
            return Err(FeError::NoElements {
                nodes: self.nodes.len(),
            });
        }
        let of_element = |&e: &u32| self.element_nodes(e as usize).iter().copied();
        let mut nodes: Vec<u32> = elements.iter().flat_map(of_element).collect();
        nodes.sort_unstable();
        nodes.dedup();
        let place = |n: u32| nodes.partition_point(|&other| other < n) as u32;
        let model = Self {
            nodes: nodes.iter().map(|&n| self.nodes[n as usize]).collect(),
            connectivity: elements.iter().flat_map(of_element).map(place).collect(),
            material: self.material,
            element: self.element,
        };
        Ok((nodes, model))
    }

    /// Node coordinates (m).
    pub fn nodes(&self) -> &[[f64; 3]] {
        &self.nodes
    }

    /// Number of elements.
    pub fn element_count(&self) -> usize {
        self.connectivity.len() / self.element.node_count()
    }

    /// Node indices of an element, VTK order.
    ///
    /// # Panics
    /// If `element` is not below [`FeModel::element_count`].
    pub fn element_nodes(&self, element: usize) -> &[u32] {
        let n = self.element.node_count();
        &self.connectivity[n * element..n * (element + 1)]
    }

    /// The material.
    pub fn material(&self) -> &Material {
        &self.material
    }

    /// The element formulation.
    pub fn element(&self) -> HexElement {
        self.element
    }

    /// Number of nodes.
    pub fn node_count(&self) -> usize {
        self.nodes.len()
    }

    /// Number of degrees of freedom, free and fixed: three per node, 3 n + a for node n along axis a.
    pub fn dof_count(&self) -> usize {
        3 * self.nodes.len()
    }

    /// Coordinates (m) of an element's nodes.
    ///
    /// # Errors
    /// [`FeError::ElementOutOfRange`].
    pub fn element_coordinates(&self, element: usize) -> Result<Vec<[f64; 3]>, FeError> {
        self.check_element(element)?;
        Ok(self.gather(element))
    }

    /// The degrees of freedom of an element, three per node, in the column order of its operators.
    ///
    /// # Errors
    /// [`FeError::ElementOutOfRange`].
    pub fn element_dofs(&self, element: usize) -> Result<Vec<usize>, FeError> {
        self.check_element(element)?;
        let nodes = self.element_nodes(element).iter();
        Ok(nodes
            .flat_map(|n| (0..3).map(move |axis| 3 * *n as usize + axis))
            .collect())
    }

    /// Stiffness of one element (N/m).
    ///
    /// # Errors
    /// [`FeError::ElementOutOfRange`]; [`FeError::Element`].
    pub fn element_stiffness(&self, element: usize) -> Result<ElementMatrix, FeError> {
        let coordinates = self.element_coordinates(element)?;
        self.element
            .stiffness(&coordinates, &self.material)
            .map_err(|source| FeError::Element { element, source })
    }

    /// Strain operator (1/m) of one element at a natural point, modes included; see
    /// [`HexElement::strain_operator`]. Columns follow [`FeModel::element_dofs`].
    ///
    /// # Errors
    /// [`FeError::ElementOutOfRange`]; [`FeError::Element`].
    pub fn strain_operator(
        &self,
        element: usize,
        natural: [f64; 3],
    ) -> Result<StrainOperator, FeError> {
        let coordinates = self.element_coordinates(element)?;
        self.element
            .strain_operator(&coordinates, &self.material, natural)
            .map_err(|source| FeError::Element { element, source })
    }

    /// Strain (xx, yy, zz, xy, yz, xz; engineering shear) at a natural point of an element from the displacements
    /// of all degrees of freedom (m).
    ///
    /// # Errors
    /// [`FeError::SizeMismatch`] unless `displacement` has [`FeModel::dof_count`] entries;
    /// [`FeError::ElementOutOfRange`]; [`FeError::Element`].
    pub fn strain(
        &self,
        element: usize,
        natural: [f64; 3],
        displacement: &[f64],
    ) -> Result<[f64; 6], FeError> {
        if displacement.len() != self.dof_count() {
            return Err(FeError::SizeMismatch {
                what: "the displacement vector",
                found: displacement.len(),
                expected: self.dof_count(),
            });
        }
        let operator = self.strain_operator(element, natural)?;
        let dofs = self.element_dofs(element)?;
        Ok(operator.map(|row| {
            row.iter()
                .zip(&dofs)
                .map(|(b, dof)| b * displacement[*dof])
                .sum()
        }))
    }

    /// Volume (m³) of the body.
    ///
    /// # Errors
    /// [`FeError::Element`]; not for a model that was accepted.
    pub fn volume(&self) -> Result<f64, FeError> {
        let elements = 0..self.element_count();
        elements.map(|element| self.element_volume(element)).sum()
    }

    /// Volume (m³) of an element.
    ///
    /// # Errors
    /// [`FeError::ElementOutOfRange`]; [`FeError::Element`].
    pub fn element_volume(&self, element: usize) -> Result<f64, FeError> {
        self.element
            .volume(&self.element_coordinates(element)?)
            .map_err(|source| FeError::Element { element, source })
    }

    fn check_element(&self, element: usize) -> Result<(), FeError> {
        if element < self.element_count() {
            Ok(())
        } else {
            Err(FeError::ElementOutOfRange {
                element,
                element_count: self.element_count(),
            })
        }
    }

    /// Coordinates of an element that exists.
    pub(crate) fn gather(&self, element: usize) -> Vec<[f64; 3]> {
        self.element_nodes(element)
            .iter()
            .map(|node| self.nodes[*node as usize])
            .collect()
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::structured::StructuredMesh;

    fn build(mesh: StructuredMesh) -> Result<FeModel, FeError> {
        FeModel::new(
            mesh.nodes,
            mesh.hexes,
            Material::new(210e9, 0.3).unwrap(),
            HexElement::Hex8,
        )
    }

    #[test]
    fn broken_meshes_name_the_culprit() {
        let good = || StructuredMesh::block([2, 1, 1], [2.0, 1.0, 1.0]);
        assert!(build(good()).is_ok());

        let mut mesh = good();
        mesh.hexes[1].swap(0, 1);
        assert!(matches!(
            build(mesh),
            Err(FeError::Element { element: 1, .. })
        ));

        let mut mesh = good();
        mesh.hexes[1][3] = 99;
        assert_eq!(
            build(mesh),
            Err(FeError::NodeOutOfRange {
                element: 1,
                node: 99,
                node_count: 12
            })
        );

        let mut mesh = good();
        mesh.nodes.push([9.0; 3]);
        assert_eq!(build(mesh), Err(FeError::NodeWithoutElement { node: 12 }));

        let mut mesh = good();
        mesh.nodes[4][1] = f64::NAN;
        assert!(matches!(
            build(mesh),
            Err(FeError::CoordinateNotFinite { node: 4, .. })
        ));

        let mut mesh = good();
        mesh.hexes.clear();
        assert_eq!(build(mesh), Err(FeError::NoElements { nodes: 12 }));
    }

    #[test]
    fn an_element_takes_its_own_number_of_nodes() {
        let mesh = StructuredMesh::block([2, 1, 1], [2.0, 1.0, 1.0]);
        let eight = build(mesh.clone()).unwrap();
        let refused = FeError::NodesPerElement {
            element: "hex20",
            found: 8,
            expected: 20,
        };
        assert_eq!(eight.with_element(HexElement::Hex20), Err(refused.clone()));
        let steel = Material::new(210e9, 0.3).unwrap();
        assert_eq!(
            FeModel::new(mesh.nodes, mesh.hexes, steel, HexElement::Hex20),
            Err(refused)
        );
    }

    #[test]
    fn volume_of_a_block_and_of_a_ring() {
        let block = build(StructuredMesh::block([3, 2, 4], [0.3, 0.2, 0.1])).unwrap();
        assert!((block.volume().unwrap() - 0.006).abs() < 1e-15);
        // n chords instead of the circle: area n/2 sin(2 pi/n) (R² − r²), height 1.
        let n = 24.0_f64;
        let ring = build(StructuredMesh::ring([24, 3, 2], [1.0, 2.0], 1.0)).unwrap();
        let exact = 0.5 * n * (std::f64::consts::TAU / n).sin() * 3.0;
        assert!((ring.volume().unwrap() - exact).abs() < 1e-12);
    }
}
