//! A neutral mesh of volume elements: plain arrays for exchange between programs.

use std::collections::BTreeMap;

use thiserror::Error;

use gearmesh_elements::CellKind;

/// Endings of the formats of other programs in which meshes are written: those whose files such programs were seen to
/// read (tests/python/test_exports.py). Not .med: meshio writes its elements inside out for Salome and gmsh; not .cgns,
/// .ugrid and others that meshio itself cannot read back.
pub const EXPORT_ENDINGS: [&str; 8] = [
    ".bdf", ".inp", ".msh", ".nas", ".vtk", ".vtu", ".xdmf", ".xmf",
];

/// A mesh of volume elements with node sets and fields.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct MeshData {
    /// Coordinates of the nodes in metres.
    pub points: Vec<[f64; 3]>,
    /// Node indices of the elements, kind by kind, element by element. Elements are numbered in this order.
    pub cells: BTreeMap<CellKind, Vec<u32>>,
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
    /// A list of nodes is not a whole number of elements long.
    #[error(
        "the {kind} elements of the mesh list {found} nodes, which is no multiple of {per_element}"
    )]
    CellLength {
        /// Kind of the elements.
        kind: &'static str,
        /// Length of the list.
        found: usize,
        /// Nodes of an element.
        per_element: usize,
    },
    /// Linear and quadratic elements in one mesh: on a common face the quadratic one would have nodes that hang.
    #[error(
        "the mesh has both {linear} and {quadratic} elements, whose faces do not fit together; mesh all of the body with \
         linear (hex8, wedge6) or all with quadratic elements (hex20, tet10, wedge15)"
    )]
    MixedOrder {
        /// A linear kind found.
        linear: &'static str,
        /// A quadratic kind found.
        quadratic: &'static str,
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
        "element {element} of the mesh ({kind}) has a corner with Jacobian {jacobian_m3:.3e} m3 at its node {corner}, x {:.3} y \
         {:.3} z {:.3} mm; it must be positive: number its nodes as VTK does, turn a mirrored mesh round, or repair it",
        at_m[0] * 1e3, at_m[1] * 1e3, at_m[2] * 1e3
    )]
    BadCell {
        /// The element.
        element: usize,
        /// Its kind.
        kind: &'static str,
        /// The corner.
        corner: usize,
        /// Triple product of the three edges that leave the corner.
        jacobian_m3: f64,
        /// Where the corner is.
        at_m: [f64; 3],
    },
}

impl MeshData {
    /// Number of elements.
    pub fn cell_count(&self) -> usize {
        let blocks = self.cells.iter();
        blocks
            .map(|(kind, nodes)| nodes.len() / kind.node_count())
            .sum()
    }

    /// Kind and nodes of each element.
    pub fn iter_cells(&self) -> impl Iterator<Item = (CellKind, &[u32])> {
        self.cells.iter().flat_map(|(&kind, nodes)| {
            let elements = nodes.chunks_exact(kind.node_count());
            elements.map(move |element| (kind, element))
        })
    }

    /// Removes the nodes that belong to no element, from sets and fields too, and returns how many there were. The
    /// others keep their order.
    ///
    /// # Panics
    /// If an index or the length of a field is out of range; see [`MeshData::validate`].
    pub fn remove_loose_points(&mut self) -> usize {
        let mut used = vec![false; self.points.len()];
        for &node in self.cells.values().flatten() {
            used[node as usize] = true;
        }
        let mut next = 0;
        let number: Vec<Option<u32>> = used
            .iter()
            .map(|used| {
                used.then(|| {
                    next += 1;
                    next - 1
                })
            })
            .collect();
        let loose = self.points.len() - next as usize;
        if loose == 0 {
            return 0;
        }
        let kept = |row: &usize| used[*row];
        let rows = 0..self.points.len();
        self.points = rows.clone().filter(kept).map(|n| self.points[n]).collect();
        for node in self.cells.values_mut().flatten() {
            *node = number[*node as usize].unwrap_or(0);
        }
        for set in self.point_sets.values_mut() {
            *set = set.iter().filter_map(|n| number[*n as usize]).collect();
        }
        for field in self.point_fields.values_mut() {
            let of_row = |n: usize| &field.values[n * field.components..(n + 1) * field.components];
            field.values = rows
                .clone()
                .filter(kept)
                .flat_map(of_row)
                .copied()
                .collect();
        }
        loose
    }

    /// Checks that indices, field lengths and coordinates make sense; says nothing about the shape of the elements.
    ///
    /// # Errors
    /// [`MeshDataError`], except `BadCell` and `MixedOrder`.
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
        for (kind, list) in &self.cells {
            if !list.len().is_multiple_of(kind.node_count()) {
                return Err(MeshDataError::CellLength {
                    kind: kind.name(),
                    found: list.len(),
                    per_element: kind.node_count(),
                });
            }
        }
        for (element, (_, cell)) in self.iter_cells().enumerate() {
            if let Some(found) = outside(cell) {
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
            (&self.cell_fields, self.cell_count(), "cell"),
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

    /// Checks that faces fit together and that the Jacobian of the straight element is positive at every corner: no
    /// element is inside out, collapsed or numbered in another order. What mid-edge nodes do to it is the finite
    /// element model's to check.
    ///
    /// # Errors
    /// [`MeshDataError::BadCell`], [`MeshDataError::MixedOrder`], and all of [`MeshData::validate`].
    pub fn check_cells(&self) -> Result<(), MeshDataError> {
        self.validate()?;
        let of_order = |quadratic: bool| {
            let mut blocks = self.cells.iter();
            let found =
                blocks.find(|(kind, list)| kind.is_quadratic() == quadratic && !list.is_empty());
            found.map(|(kind, _)| kind.name())
        };
        if let (Some(linear), Some(quadratic)) = (of_order(false), of_order(true)) {
            return Err(MeshDataError::MixedOrder { linear, quadratic });
        }
        for (element, (kind, cell)) in self.iter_cells().enumerate() {
            for corner in 0..kind.corner_edges().len() {
                let jacobian_m3 = self.corner_jacobian_m3(kind, cell, corner);
                if jacobian_m3 <= 0.0 {
                    return Err(MeshDataError::BadCell {
                        element,
                        kind: kind.name(),
                        corner,
                        jacobian_m3,
                        at_m: self.points[cell[corner] as usize],
                    });
                }
            }
        }
        Ok(())
    }

    /// Triple product of the straight edges that leave a corner.
    ///
    /// # Panics
    /// If the element has no such corner, or names a node that does not exist.
    pub fn corner_jacobian_m3(&self, kind: CellKind, cell: &[u32], corner: usize) -> f64 {
        let point = |k: usize| self.points[cell[k] as usize];
        let origin = point(corner);
        let [a, b, c] = kind.corner_edges()[corner]
            .map(|k| std::array::from_fn::<f64, 3, _>(|axis| point(k)[axis] - origin[axis]));
        a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0])
            + a[2] * (b[0] * c[1] - b[1] * c[0])
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::made_up_models::block_mesh;

    #[test]
    fn a_block_is_sound_and_its_mirror_image_is_not() {
        let mut mesh = block_mesh();
        mesh.check_cells().unwrap();
        for point in &mut mesh.points {
            point[2] = -point[2];
        }
        assert!(matches!(
            mesh.check_cells(),
            Err(MeshDataError::BadCell {
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
        mesh.check_cells().unwrap();
        // Two corners exchanged on one face break it.
        mesh.cells
            .get_mut(&CellKind::Hex8)
            .unwrap()
            .swap(8 + 5, 8 + 6);
        assert!(matches!(
            mesh.check_cells(),
            Err(MeshDataError::BadCell { element: 1, .. })
        ));
    }

    #[test]
    fn wrong_indices_and_lengths_are_named() {
        let mut mesh = block_mesh();
        mesh.cells.get_mut(&CellKind::Hex8).unwrap().pop();
        assert!(matches!(
            mesh.validate(),
            Err(MeshDataError::CellLength {
                kind: "hex8",
                found: 15,
                per_element: 8
            })
        ));
        let mut mesh = block_mesh();
        mesh.cells.get_mut(&CellKind::Hex8).unwrap()[8] = 77;
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

    /// Every corner of the reference shape of every kind is right-handed; the mirror image is at none.
    #[test]
    fn corners_of_all_kinds_are_right_handed() {
        let prism = |z: f64| [[0.0, 0.0, z], [1.0, 0.0, z], [0.0, 1.0, z]];
        let square = |z: f64| [[0.0, 0.0, z], [1.0, 0.0, z], [1.0, 1.0, z], [0.0, 1.0, z]];
        for kind in CellKind::ALL {
            let mut points = match kind {
                CellKind::Hex8 | CellKind::Hex20 => [square(0.0), square(1.0)].concat(),
                CellKind::Tet10 => [&prism(0.0)[..], &[[0.0, 0.0, 1.0]]].concat(),
                CellKind::Wedge6 | CellKind::Wedge15 => [prism(0.0), prism(1.0)].concat(),
            };
            assert_eq!(points.len(), kind.corner_edges().len());
            points.resize(kind.node_count(), [0.5; 3]);
            let mut mesh = MeshData {
                cells: BTreeMap::from([(kind, (0..points.len() as u32).collect())]),
                points,
                ..MeshData::default()
            };
            mesh.check_cells().unwrap();
            mesh.points.iter_mut().for_each(|p| p[0] = -p[0]);
            let (kind, cell) = mesh.iter_cells().next().unwrap();
            for corner in 0..kind.corner_edges().len() {
                assert!(mesh.corner_jacobian_m3(kind, cell, corner) < 0.0);
            }
        }
    }

    #[test]
    fn loose_points_are_removed_everywhere() {
        let mut mesh = block_mesh();
        let expected = mesh.clone();
        assert_eq!(mesh.remove_loose_points(), 0);
        // One node more in front and one in the middle: every number shifts.
        for place in [0, 5] {
            mesh.points.insert(place, [9.0; 3]);
            let shift = |n: &mut u32| *n += u32::from(*n as usize >= place);
            mesh.cells.values_mut().flatten().for_each(shift);
            mesh.point_sets.values_mut().flatten().for_each(shift);
            for field in mesh.point_fields.values_mut() {
                let at = place * field.components;
                field
                    .values
                    .splice(at..at, std::iter::repeat_n(7.0, field.components));
            }
        }
        mesh.point_sets.get_mut("bore").unwrap().push(5);
        mesh.validate().unwrap();
        assert_eq!(mesh.remove_loose_points(), 2);
        assert_eq!(mesh, expected);
    }

    #[test]
    fn faces_that_do_not_fit_together_are_refused() {
        let mut mesh = block_mesh();
        mesh.cells.insert(CellKind::Tet10, (0..10).collect());
        assert_eq!(
            mesh.check_cells(),
            Err(MeshDataError::MixedOrder {
                linear: "hex8",
                quadratic: "tet10"
            })
        );
    }
}
