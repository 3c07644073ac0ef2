//! A neutral hexahedral mesh: plain arrays for exchange between programs.

use std::collections::BTreeMap;

use thiserror::Error;

/// A mesh of 8- or 20-node hexahedra with node sets and fields.
///
/// Node order of a hexahedron as in VTK: 0-3 around its bottom face, counter-clockwise seen from the top; 4-7 above
/// them. A 20-node hexahedron has a further node on every edge, in the order 0-1, 1-2, 2-3, 3-0, the same above, then
/// 0-4, 1-5, 2-6, 3-7.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct MeshData {
    /// Coordinates of the nodes in metres.
    pub points: Vec<[f64; 3]>,
    /// Node indices of each element's corners.
    pub hexes: Vec<[u32; 8]>,
    /// Node indices on each element's edges; empty where all elements have eight nodes.
    pub mid_edges: Vec<[u32; 12]>,
    /// Named sets of nodes.
    pub point_sets: BTreeMap<String, Vec<u32>>,
    /// Named fields, one row a node.
    pub point_fields: BTreeMap<String, Field>,
    /// Named fields, one row an element.
    pub cell_fields: BTreeMap<String, Field>,
}

/// Numbers on the nodes or elements of a mesh.
#[derive(Debug, Clone, PartialEq)]
pub struct Field {
    /// How many numbers each node or element has: 1 for a scalar, 3 for a vector, 6 for a stress.
    pub components: usize,
    /// The numbers, all of node (element) 0 first.
    pub values: Vec<f64>,
    /// Their unit, for example `"m"`.
    pub unit: String,
}

/// What is wrong with a mesh.
#[derive(Debug, Error, PartialEq)]
pub enum MeshDataError {
    /// A coordinate is not a finite number.
    #[error("node {node} of the mesh has coordinates {coordinates_m:?}; all must be finite")]
    NotFinitePoint {
        /// The node.
        node: usize,
        /// Its coordinates.
        coordinates_m: [f64; 3],
    },
    /// Some elements have mid-edge nodes and others have none.
    #[error(
        "{found} elements of the mesh have mid-edge nodes, but there are {elements} elements; all or none must have them"
    )]
    MidEdgeCount {
        /// How many rows of mid-edge nodes there are.
        found: usize,
        /// How many elements there are.
        elements: usize,
    },
    /// An element or a set refers to a node that does not exist.
    #[error(
        "{item} of the mesh refers to node {found}, but there are {nodes} nodes (0 to {nodes} - 1)"
    )]
    NodeOutOfRange {
        /// The element or set.
        item: String,
        /// The index.
        found: u32,
        /// How many nodes there are.
        nodes: usize,
    },
    /// A field has the wrong number of values, or a value that is not finite.
    #[error(
        "{item} of the mesh has {found} finite values, but {expected} are needed ({components} a row)"
    )]
    FieldLength {
        /// The field.
        item: String,
        /// How many values it has.
        found: usize,
        /// How many it must have.
        expected: usize,
        /// Components a row; at least 1.
        components: usize,
    },
    /// An element is turned inside out, collapsed, or its nodes are in another order.
    #[error(
        "element {element} of the mesh has a corner with Jacobian {jacobian_m3:.3e} m3 at its node {corner}; it must \
        be positive: number its nodes as VTK does, or repair the mesh"
    )]
    BadHexahedron {
        /// The element.
        element: usize,
        /// The corner, 0 to 7.
        corner: usize,
        /// Triple product of the three edges that leave the corner.
        jacobian_m3: f64,
    },
}

/// Neighbours of each corner along the three natural directions, in right-handed order.
const CORNER_EDGES: [[usize; 3]; 8] = [
    [1, 3, 4],
    [2, 0, 5],
    [3, 1, 6],
    [0, 2, 7],
    [7, 5, 0],
    [4, 6, 1],
    [5, 7, 2],
    [6, 4, 3],
];

impl MeshData {
    /// The twenty nodes of each element; `None` where elements have eight.
    pub fn hexes_of_20(&self) -> Option<Vec<[u32; 20]>> {
        let rows = self.hexes.iter().zip(&self.mid_edges);
        (!self.mid_edges.is_empty()).then(|| {
            rows.map(|(corners, edges)| {
                let mut hex = [0; 20];
                hex[..8].copy_from_slice(corners);
                hex[8..].copy_from_slice(edges);
                hex
            })
            .collect()
        })
    }

    /// Splits twenty-node hexahedra into corners and mid-edge nodes, in place of all elements.
    pub fn set_hexes_of_20(&mut self, hexes: &[[u32; 20]]) {
        self.hexes = hexes
            .iter()
            .map(|h| std::array::from_fn(|i| h[i]))
            .collect();
        self.mid_edges = hexes
            .iter()
            .map(|h| std::array::from_fn(|i| h[8 + i]))
            .collect();
    }

    /// Checks that indices, field lengths and coordinates make sense; says nothing about the shape of the elements.
    ///
    /// # Errors
    /// [`MeshDataError`], except `BadHexahedron`.
    pub fn validate(&self) -> Result<(), MeshDataError> {
        let nodes = self.points.len();
        if let Some(node) = self
            .points
            .iter()
            .position(|point| !point.iter().all(|x| x.is_finite()))
        {
            return Err(MeshDataError::NotFinitePoint {
                node,
                coordinates_m: self.points[node],
            });
        }
        let outside = |indices: &[u32]| {
            indices
                .iter()
                .copied()
                .find(|&index| index as usize >= nodes)
        };
        if !self.mid_edges.is_empty() && self.mid_edges.len() != self.hexes.len() {
            return Err(MeshDataError::MidEdgeCount {
                found: self.mid_edges.len(),
                elements: self.hexes.len(),
            });
        }
        for (element, hex) in self.hexes.iter().enumerate() {
            let mid_edges = self.mid_edges.get(element).map_or(&[][..], |m| m);
            if let Some(found) = outside(hex).or_else(|| outside(mid_edges)) {
                return Err(MeshDataError::NodeOutOfRange {
                    item: format!("element {element}"),
                    found,
                    nodes,
                });
            }
        }
        for (name, set) in &self.point_sets {
            if let Some(found) = outside(set) {
                return Err(MeshDataError::NodeOutOfRange {
                    item: format!("node set \"{name}\""),
                    found,
                    nodes,
                });
            }
        }
        let rows = [
            (&self.point_fields, nodes, "point"),
            (&self.cell_fields, self.hexes.len(), "cell"),
        ];
        for (fields, rows, kind) in rows {
            for (name, field) in fields {
                let expected = rows * field.components.max(1);
                let finite = field
                    .values
                    .iter()
                    .filter(|value| value.is_finite())
                    .count();
                if finite != expected || field.values.len() != expected || field.components == 0 {
                    return Err(MeshDataError::FieldLength {
                        item: format!("{kind} field \"{name}\""),
                        found: finite,
                        expected,
                        components: field.components,
                    });
                }
            }
        }
        Ok(())
    }

    /// Checks that the Jacobian is positive at every corner of every element: no element is inside out, collapsed or
    /// numbered in another order.
    ///
    /// # Errors
    /// [`MeshDataError::BadHexahedron`], and all of [`MeshData::validate`].
    pub fn check_hexahedra(&self) -> Result<(), MeshDataError> {
        self.validate()?;
        for (element, hex) in self.hexes.iter().enumerate() {
            let point = |corner: usize| self.points[hex[corner] as usize];
            for (corner, edges) in CORNER_EDGES.iter().enumerate() {
                let origin = point(corner);
                let [a, b, c] = edges.map(|other| {
                    let end = point(other);
                    [end[0] - origin[0], end[1] - origin[1], end[2] - origin[2]]
                });
                let jacobian_m3 = a[0] * (b[1] * c[2] - b[2] * c[1])
                    - a[1] * (b[0] * c[2] - b[2] * c[0])
                    + a[2] * (b[0] * c[1] - b[1] * c[0]);
                if jacobian_m3 <= 0.0 {
                    return Err(MeshDataError::BadHexahedron {
                        element,
                        corner,
                        jacobian_m3,
                    });
                }
            }
        }
        Ok(())
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::synthetic::block_mesh;

    #[test]
    fn a_block_is_sound_and_its_mirror_image_is_not() {
        let mut mesh = block_mesh();
        mesh.check_hexahedra().unwrap();
        for point in &mut mesh.points {
            point[2] = -point[2];
        }
        assert!(matches!(
            mesh.check_hexahedra(),
            Err(MeshDataError::BadHexahedron {
                element: 0,
                corner: 0,
                ..
            })
        ));
    }

    /// The unit cube has Jacobian 1 at each corner: the table of edges is right-handed everywhere.
    #[test]
    fn all_corners_of_a_turned_cube_are_right_handed() {
        let mut mesh = block_mesh();
        let (sin, cos) = 0.7_f64.sin_cos();
        for p in &mut mesh.points {
            *p = [cos * p[0] - sin * p[1], sin * p[0] + cos * p[1], p[2]];
        }
        mesh.check_hexahedra().unwrap();
        // Two corners exchanged on one face break it.
        mesh.hexes[1].swap(5, 6);
        assert!(matches!(
            mesh.check_hexahedra(),
            Err(MeshDataError::BadHexahedron { element: 1, .. })
        ));
    }

    #[test]
    fn wrong_indices_and_lengths_are_named() {
        let mut mesh = block_mesh();
        mesh.mid_edges = vec![[0; 12]; mesh.hexes.len() - 1];
        assert!(matches!(
            mesh.validate(),
            Err(MeshDataError::MidEdgeCount {
                found: 1,
                elements: 2
            })
        ));
        mesh.mid_edges.push([77; 12]);
        let message = mesh.validate().unwrap_err().to_string();
        assert!(
            message.contains("element 1") && message.contains("77"),
            "{message}"
        );

        let mut mesh = block_mesh();
        mesh.point_sets.insert("bore".to_owned(), vec![0, 99]);
        let message = mesh.validate().unwrap_err().to_string();
        assert!(
            message.contains("\"bore\"") && message.contains("99"),
            "{message}"
        );

        let mut mesh = block_mesh();
        mesh.cell_fields.insert(
            "s".to_owned(),
            Field {
                components: 6,
                values: vec![0.0; 11],
                unit: "Pa".to_owned(),
            },
        );
        assert!(matches!(
            mesh.validate(),
            Err(MeshDataError::FieldLength {
                found: 11,
                expected: 12,
                ..
            })
        ));

        let mut mesh = block_mesh();
        mesh.points[3][1] = f64::NAN;
        assert!(matches!(
            mesh.validate(),
            Err(MeshDataError::NotFinitePoint { node: 3, .. })
        ));
    }
}
