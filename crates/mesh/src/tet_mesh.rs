//! A gear in ten-node tetrahedra: the teeth as layers of split bricks, the body below them as a free mesh.
//!
//! The teeth have nodes on the true profile and equal meshes, as those of hexahedra have: a brick of 27 nodes has one
//! in the middle of every edge of its six tetrahedra, on the outline those of the face diagonals too.

use crate::MeshError;
use crate::elements::ElementList;
use crate::face::{FaceShape, OutlineFace};
use crate::gear_mesh::GearMesh;
use crate::layers::Layers;
use crate::mesh_size::demand_few_tetrahedra;
use crate::python::PythonEnvironment;
use crate::quality;
use crate::section::Section;
use crate::solid_body::{Foot, SolidBody, edge};
use crate::tet_split::{BrickCorner, node_order, tetrahedra};
use crate::twist::Twist;
use gearmesh_elements::CellKind;
use gearmesh_elements::TET_EDGES;
use gearmesh_geometry::GearDefinition;
use std::collections::{BTreeMap, HashSet};

/// The triangles in a rectangle of nine nodes, three on each level, for either diagonal: corners, then middles of
/// sides.
const OUTLINE_TRIANGLES: [[usize; 6]; 4] = [
    [0, 2, 8, 1, 5, 4],
    [0, 8, 6, 4, 7, 3],
    [0, 2, 6, 1, 4, 3],
    [2, 8, 6, 5, 7, 4],
];

impl GearMesh {
    /// Meshes a gear in tetrahedra.
    ///
    /// # Errors
    /// [`MeshError`] when gmsh is missing or fails, or when elements are more distorted than `min_scaled_jacobian`
    /// allows.
    pub(crate) fn in_tetrahedra(
        gear: &GearDefinition,
        python: &PythonEnvironment,
    ) -> Result<Self, MeshError> {
        demand_few_tetrahedra(gear)?;
        let section = Section::new(gear, python)?;
        let mut mesh = Self::of_teeth(section, Layers::new(gear), Twist::new(gear));
        let foot = mesh.foot();
        let solid = SolidBody::new(
            gear,
            python,
            &foot,
            &mesh.twist,
            &mut mesh.nodes,
            &mut mesh.elements,
        )?;
        // gmsh's bore is one to its own tolerance.
        for &n in &solid.bore {
            let [x, y, z] = mesh.nodes[n as usize];
            let scale = gear.blank.bore_radius_m() / x.hypot(y);
            mesh.nodes[n as usize] = [scale * x, scale * y, z];
        }
        mesh.solid = Some(solid);
        mesh.quality = quality::report(&mesh.nodes, &mesh.elements);
        mesh.quality.demand(gear.mesh.min_scaled_jacobian)?;
        Ok(mesh)
    }

    /// The same teeth without a body and not twisted: for problems of plane strain.
    pub fn straight_teeth(&self) -> Self {
        Self::of_teeth(self.section.clone(), self.layers.clone(), Twist::default())
    }

    /// All teeth, without a body.
    fn of_teeth(section: Section, layers: Layers, twist: Twist) -> Self {
        let levels_m = layers.planes_and_middles_m();
        let (n_levels, n_layers) = (levels_m.len(), layers.count());
        let at = |n: usize, level: usize| (n * n_levels + level) as u32;
        let mut nodes: Vec<[f64; 3]> = Vec::with_capacity(section.nodes.len() * n_levels);
        for p in &section.nodes {
            nodes.extend(levels_m.iter().map(|&z| twist.point_m(*p, z)));
        }
        let node_of = (0..nodes.len() as u32).collect();

        let cell = &section.cell;
        let order = node_order(cell);
        let splits: Vec<_> = cell
            .quads
            .iter()
            .map(|q| tetrahedra(q.map(|n| order[n]), q.map(|n| cell.nodes[n])))
            .collect();
        let mut elements = ElementList::new(CellKind::Tet10);
        let mut element_of = Vec::with_capacity(section.quads.len() * n_layers);
        for (quad, corners) in section.quads.iter().enumerate() {
            let (sides, centre) = (section.mid_sides[quad], section.centres[quad]);
            let between = |a: usize, b: usize| match (a.min(b), a.max(b)) {
                (a, b) if a == b => corners[a],
                (0, 3) => sides[3],
                (a, b) if b == a + 1 => sides[a],
                _ => centre,
            };
            for layer in 0..n_layers {
                element_of.push(elements.len() as u32);
                let level = |(_, up): BrickCorner| 2 * (layer + up);
                for tetrahedron in &splits[quad % cell.quads.len()] {
                    let ends = tetrahedron.iter().map(|&c| at(corners[c.0], level(c)));
                    let middles = TET_EDGES.iter().map(|&[a, b]| {
                        let (a, b) = (tetrahedron[a], tetrahedron[b]);
                        at(between(a.0, b.0), (level(a) + level(b)) / 2)
                    });
                    elements.push(ends.chain(middles));
                }
            }
        }

        let quality = quality::report(&nodes, &elements);
        Self {
            nodes,
            elements,
            section,
            layers,
            twist,
            quality,
            solid: None,
            levels_m,
            node_of,
            element_of,
        }
    }

    /// Where the body meets the teeth.
    fn foot(&self) -> Foot {
        let planes = 0..=self.layers.count();
        let column = |n: usize| -> Vec<u32> {
            let levels = planes.clone().map(|k| 2 * k);
            levels.filter_map(|level| self.node(n, level)).collect()
        };
        let cells = self.section.cell_nodes.iter();
        let ring: Vec<Vec<Vec<u32>>> = cells
            .map(|map| {
                // Every other node is the middle of a side.
                let corners = self.section.cell.bottom.iter().step_by(2);
                corners.map(|&c| column(map[c])).collect()
            })
            .collect();
        Foot {
            middles: middles_between(&self.elements, ring.iter().flatten().flatten().copied()),
            ring,
            planes_m: self.layers.planes_m.clone(),
        }
    }

    /// The two triangles of the outline in front of a split brick: section nodes at the start, in the middle and at the
    /// end of its piece of the outline, arc lengths of start and end \[m\], layer, first element of the brick. The
    /// diagonal is the one that the elements have.
    pub(crate) fn split_faces(
        &self,
        [start, middle, end]: [usize; 3],
        arcs_m: [f64; 2],
        layer: usize,
        first: u32,
    ) -> Vec<OutlineFace> {
        let along = [
            (start, arcs_m[0]),
            (middle, 0.5 * (arcs_m[0] + arcs_m[1])),
            (end, arcs_m[1]),
        ];
        // The rectangle's nine nodes, from below.
        let places: Vec<(u32, [f64; 2])> = (2 * layer..=2 * layer + 2)
            .flat_map(|level| {
                let at = along.iter().map(move |&(n, arc)| (n, arc, level));
                at.filter_map(|(n, arc, level)| {
                    Some((self.node(n, level)?, [arc, self.levels_m[level]]))
                })
            })
            .collect();
        let behind = |corners: &[u32]| {
            (first..first + self.in_brick()).find(|&e| {
                let own = &self.elements.nodes(e)[..CellKind::Tet10.corner_count()];
                corners.iter().all(|n| own.contains(n))
            })
        };
        OUTLINE_TRIANGLES
            .iter()
            .filter_map(|triangle| {
                let nodes: Vec<u32> = triangle.iter().map(|&k| places[k].0).collect();
                Some(OutlineFace {
                    shape: FaceShape::Triangle6,
                    element: behind(&nodes[..3])?,
                    nodes,
                    places_m: triangle.iter().map(|&k| places[k].1).collect(),
                })
            })
            .collect()
    }
}

/// The node in the middle of every edge between two of the given nodes.
fn middles_between(
    elements: &ElementList,
    among: impl Iterator<Item = u32>,
) -> BTreeMap<[u32; 2], u32> {
    let among: HashSet<u32> = among.collect();
    let mut middles = BTreeMap::new();
    for element in elements.iter() {
        for (&[a, b], &middle) in TET_EDGES.iter().zip(&element[4..]) {
            let ends = [element[a], element[b]];
            if ends.iter().all(|n| among.contains(n)) {
                middles.insert(edge(ends[0], ends[1]), middle);
            }
        }
    }
    middles
}
