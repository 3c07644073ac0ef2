//! A gear in ten-node tetrahedra: the teeth as layers of split bricks, the body below them as a free mesh.
//!
//! The teeth have nodes on the true profile and equal meshes, as those of hexahedra have: a brick of 27 nodes has one in the middle
//! of every edge of its six tetrahedra, on the outline those of the face diagonals too.

use crate::MeshError;
use crate::elements::{ElementList, ElementShape};
use crate::gear_mesh::GearMesh;
use crate::layers::Layers;
use crate::python::PythonEnvironment;
use crate::quality::{self, TET_EDGES};
use crate::section::Section;
use crate::solid_body::{Foot, SolidBody, edge};
use crate::tet_split::{BrickCorner, node_order, tetrahedra};
use crate::twist::Twist;
use gearmesh_geometry::GearDefinition;
use std::collections::{HashMap, HashSet};

impl GearMesh {
    /// Meshes a gear in tetrahedra.
    ///
    /// # Errors
    /// [`MeshError`] when gmsh is missing or fails, or when elements are more distorted than `min_scaled_jacobian` allows.
    pub(crate) fn in_tetrahedra(
        gear: &GearDefinition,
        python: &PythonEnvironment,
    ) -> Result<Self, MeshError> {
        let section = Section::new(gear, python)?;
        let layers = Layers::new(gear);
        let twist = Twist::new(gear);
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
        let mut elements = ElementList::new(ElementShape::Tet10);
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

        let ring: Vec<Vec<Vec<u32>>> = section
            .cell_nodes
            .iter()
            .map(|map| {
                let corners = cell.bottom.iter().step_by(2);
                let planes = |&c: &usize| (0..=n_layers).map(|k| at(map[c], 2 * k)).collect();
                corners.map(planes).collect()
            })
            .collect();
        let foot = Foot {
            middles: middles_between(&elements, ring.iter().flatten().flatten().copied()),
            ring,
            planes_m: layers.planes_m.clone(),
        };
        let solid = SolidBody::new(gear, python, &foot, &twist, &mut nodes, &mut elements)?;
        // gmsh's bore is one to its own tolerance.
        for &n in &solid.bore {
            let [x, y, z] = nodes[n as usize];
            let scale = gear.blank.bore_radius_m / x.hypot(y);
            nodes[n as usize] = [scale * x, scale * y, z];
        }
        let quality = quality::report(&nodes, &elements);
        quality.demand(gear.mesh.min_scaled_jacobian)?;
        Ok(Self {
            nodes,
            elements,
            section,
            layers,
            twist,
            quality,
            solid: Some(solid),
            levels_m,
            node_of,
            element_of,
        })
    }
}

/// The node in the middle of every edge between two of the given nodes.
fn middles_between(
    elements: &ElementList,
    among: impl Iterator<Item = u32>,
) -> HashMap<[u32; 2], u32> {
    let among: HashSet<u32> = among.collect();
    let mut middles = HashMap::new();
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
