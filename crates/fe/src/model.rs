//! The finite element model: nodes, elements in blocks of one kind, material, checked once.

use rayon::prelude::*;

use crate::element::ElementFormulas;
use crate::element_matrix::ElementMatrix;
use crate::error::FeError;
use crate::material::Material;
use crate::stiffness_block::StrainOperator;
use gearmesh_elements::Element;

/// Elements of one kind.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ElementBlock {
    /// Kind and formulation.
    pub element: Element,
    /// Node indices, element by element in VTK order; as many an element as it has nodes.
    pub nodes: Vec<u32>,
}

impl ElementBlock {
    /// Number of elements.
    pub fn len(&self) -> usize {
        self.nodes.len() / self.element.node_count()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }
}

/// Nodes, elements, one material. Valid by construction. Elements are numbered through all blocks.
#[derive(Debug, Clone, PartialEq)]
pub struct FeModel {
    nodes: Vec<[f64; 3]>,
    blocks: Vec<ElementBlock>,
    /// Number of the first element of each block, and the number of all.
    first: Vec<usize>,
    material: Material,
}

impl FeModel {
    /// Checks and keeps a mesh of one kind of element.
    ///
    /// `nodes`: coordinates (m). `elements`: node indices in VTK order, as many as the element has, for example
    /// `[u32; 8]` or `[u32; 20]`.
    ///
    /// # Errors
    /// [`FeError::NodesPerElement`], and as [`FeModel::from_blocks`].
    pub fn new<const N: usize>(
        nodes: Vec<[f64; 3]>,
        elements: Vec<[u32; N]>,
        material: Material,
        element: Element,
    ) -> Result<Self, FeError> {
        if N != element.node_count() {
            return Err(FeError::NodesPerElement {
                element: element.name(),
                found: N,
                expected: element.node_count(),
            });
        }
        Self::from_connectivity(nodes, elements.into_flattened(), material, element)
    }

    /// As [`FeModel::new`], with the node indices of all elements one after another.
    ///
    /// # Errors
    /// As [`FeModel::from_blocks`].
    pub fn from_connectivity(
        nodes: Vec<[f64; 3]>,
        connectivity: Vec<u32>,
        material: Material,
        element: Element,
    ) -> Result<Self, FeError> {
        let block = ElementBlock {
            element,
            nodes: connectivity,
        };
        Self::from_blocks(nodes, vec![block], material)
    }

    /// Checks and keeps a mesh of one or several kinds of elements; empty blocks are left out. Elements that share a
    /// face must agree on its nodes (hex8 with wedge6, hex20 with wedge15); that is not checked here.
    ///
    /// # Errors
    /// [`FeError::ConnectivityLength`], [`FeError::NoElements`], [`FeError::TooLarge`],
    /// [`FeError::CoordinateNotFinite`], [`FeError::NodeOutOfRange`], [`FeError::NodeWithoutElement`], and
    /// [`FeError::Element`] naming the first element whose Jacobian is not positive at all integration points, nodes
    /// and the centre.
    pub fn from_blocks(
        nodes: Vec<[f64; 3]>,
        mut blocks: Vec<ElementBlock>,
        material: Material,
    ) -> Result<Self, FeError> {
        blocks.retain(|block| !block.is_empty());
        for block in &blocks {
            let per_element = block.element.node_count();
            if !block.nodes.len().is_multiple_of(per_element) {
                return Err(FeError::ConnectivityLength {
                    element: block.element.name(),
                    found: block.nodes.len(),
                    per_element,
                });
            }
        }
        let model = Self {
            nodes,
            first: first_elements(&blocks),
            blocks,
            material,
        };
        model.check_numbers()?;
        let broken = (0..model.element_count())
            .into_par_iter()
            .find_map_first(|e| {
                let checked = model.element_of(e).check_shape(&model.gather(e));
                checked.err().map(|source| (e, source))
            });
        match broken {
            Some((element, source)) => Err(FeError::Element { element, source }),
            None => Ok(model),
        }
    }

    /// Checks sizes, coordinates and node indices.
    fn check_numbers(&self) -> Result<(), FeError> {
        let node_count = self.nodes.len();
        if self.element_count() == 0 {
            return Err(FeError::NoElements { nodes: node_count });
        }
        // METIS counts in 32 bits; a third of that leaves room for three degrees of freedom per node.
        let allowed = i32::MAX as usize / 3;
        let found = node_count.max(self.element_count());
        if found > allowed {
            return Err(FeError::TooLarge { found, allowed });
        }
        for (node, coordinates) in self.nodes.iter().enumerate() {
            if !coordinates.iter().all(|v| v.is_finite()) {
                return Err(FeError::CoordinateNotFinite {
                    node,
                    coordinates_m: *coordinates,
                });
            }
        }
        let mut used = vec![false; node_count];
        for element in 0..self.element_count() {
            for &node in self.element_nodes(element) {
                let flag = used.get_mut(node as usize);
                *flag.ok_or(FeError::NodeOutOfRange {
                    element,
                    node,
                    node_count,
                })? = true;
            }
        }
        match used.iter().position(|u| !u) {
            Some(node) => Err(FeError::NodeWithoutElement { node }),
            None => Ok(()),
        }
    }

    /// The same mesh with another formulation of as many nodes, all elements alike.
    ///
    /// # Errors
    /// [`FeError::NodesPerElement`].
    pub fn with_element(mut self, element: Element) -> Result<Self, FeError> {
        for block in &mut self.blocks {
            if element.node_count() != block.element.node_count() {
                return Err(FeError::NodesPerElement {
                    element: element.name(),
                    found: block.element.node_count(),
                    expected: element.node_count(),
                });
            }
            block.element = element;
        }
        Ok(self)
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
        let mut blocks: Vec<ElementBlock> = Vec::new();
        for e in elements {
            let element = self.element_of(*e as usize);
            if blocks.last().is_none_or(|block| block.element != element) {
                blocks.push(ElementBlock {
                    element,
                    nodes: Vec::new(),
                });
            }
            if let Some(block) = blocks.last_mut() {
                block.nodes.extend(of_element(e).map(place));
            }
        }
        let model = Self {
            nodes: nodes.iter().map(|&n| self.nodes[n as usize]).collect(),
            first: first_elements(&blocks),
            blocks,
            material: self.material,
        };
        Ok((nodes, model))
    }

    /// Node coordinates (m).
    pub fn nodes(&self) -> &[[f64; 3]] {
        &self.nodes
    }

    /// Number of elements.
    pub fn element_count(&self) -> usize {
        self.first.last().copied().unwrap_or(0)
    }

    /// The block that an element belongs to, and its place in it.
    fn block_of(&self, element: usize) -> (&ElementBlock, usize) {
        // One kind is the usual case, and this is asked for every element in every loop.
        let block = match self.blocks.len() {
            1 => 0,
            _ => self.first.partition_point(|&first| first <= element) - 1,
        };
        (&self.blocks[block], element - self.first[block])
    }

    /// The elements, by kind.
    pub fn blocks(&self) -> &[ElementBlock] {
        &self.blocks
    }

    /// Node indices of an element, VTK order.
    ///
    /// # Panics
    /// If `element` is not below [`FeModel::element_count`].
    pub fn element_nodes(&self, element: usize) -> &[u32] {
        let (block, place) = self.block_of(element);
        let n = block.element.node_count();
        &block.nodes[n * place..n * (place + 1)]
    }

    /// The material.
    pub fn material(&self) -> &Material {
        &self.material
    }

    /// Kind and formulation of an element.
    ///
    /// # Panics
    /// If `element` is not below [`FeModel::element_count`].
    pub fn element_of(&self, element: usize) -> Element {
        self.block_of(element).0.element
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
        self.element_of(element)
            .stiffness(&coordinates, &self.material)
            .map_err(|source| FeError::Element { element, source })
    }

    /// Strain operator (1/m) of one element at a natural point, modes included; see
    /// [`ElementFormulas::strain_operator`]. Columns follow [`FeModel::element_dofs`].
    ///
    /// # Errors
    /// [`FeError::ElementOutOfRange`]; [`FeError::Element`].
    pub fn strain_operator(
        &self,
        element: usize,
        natural: [f64; 3],
    ) -> Result<StrainOperator, FeError> {
        let coordinates = self.element_coordinates(element)?;
        self.element_of(element)
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
        FeError::check_size(
            "the displacement vector",
            displacement.len(),
            self.dof_count(),
        )?;
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
        self.check_element(element)?;
        self.element_of(element)
            .volume(&self.gather(element))
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

/// Number of the first element of each block, and the number of all.
fn first_elements(blocks: &[ElementBlock]) -> Vec<usize> {
    let mut first = vec![0];
    for block in blocks {
        first.push(first[first.len() - 1] + block.len());
    }
    first
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
            Element::Hex8,
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
        assert_eq!(eight.with_element(Element::Hex20), Err(refused.clone()));
        let steel = Material::new(210e9, 0.3).unwrap();
        assert_eq!(
            FeModel::new(mesh.nodes, mesh.hexes, steel, Element::Hex20),
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
