//! Nodes and elements of the whole gear; `gear_mesh_sets.rs` has the sets that the reduction needs.
//!
//! A quadratic mesh has the same section and layers; the section then has nodes in the middle of its edges too, and
//! between two planes there is a level of nodes half way up, above the quads' corners only. Where elements are
//! tetrahedra only the teeth are made of layers, each brick of them split (`tet_mesh.rs`); the body is a free mesh.

use crate::MeshError;
use crate::elements::{ElementList, brick};
use crate::heights::Heights;
use crate::layers::Layers;
use crate::python::PythonEnvironment;
use crate::quality::{self, QualityReport};
use crate::section::Section;
use crate::solid_body::SolidBody;
use crate::tet_split;
use crate::twist::Twist;
use gearmesh_elements::CellKind;
use gearmesh_geometry::{Element, GearDefinition};
use std::ops::Range;

const NONE: u32 = u32::MAX;
/// Elements in the body over those asked for, tried where gmsh finds poor quads beside openings.
const SHORTER: [f64; 3] = [0.95, 0.9, 0.85];
/// Rounding of radii.
pub(crate) const SAME_RADIUS: f64 = 1e-6;

/// A meshed gear.
#[derive(Debug, Clone)]
pub struct GearMesh {
    /// \[x, y, z\] \[m\].
    pub nodes: Vec<[f64; 3]>,
    /// Elements.
    pub elements: ElementList,
    /// Cross-section.
    pub section: Section,
    /// Layers.
    pub layers: Layers,
    /// How the sections turn along the axis; `section` is the one at z = 0.
    pub twist: Twist,
    /// Quality.
    pub quality: QualityReport,
    /// Where the body is no part of the layers: its nodes and elements.
    pub(crate) solid: Option<SolidBody>,
    /// Heights of the nodes \[m\]: the planes between the layers and, with quadratic elements, the middles of the
    /// layers.
    pub(crate) levels_m: Vec<f64>,
    /// Node by section node and level.
    pub(crate) node_of: Vec<u32>,
    /// Element by section quad and layer, the first of several where the brick is split.
    pub(crate) element_of: Vec<u32>,
}

impl GearMesh {
    /// Meshes a gear. Where gmsh finds poor quads, elements in the body are up to 15 % shorter than asked for.
    ///
    /// # Errors
    /// [`MeshError`] when gmsh is missing or fails, or when the mesh is poorer than `min_scaled_jacobian`.
    pub fn new(gear: &GearDefinition, python: &PythonEnvironment) -> Result<Self, MeshError> {
        let made = Self::made(gear, python);
        let is_poor = matches!(made, Err(MeshError::Quality { .. }));
        if is_poor && gear.mesh.element != Element::Tet10 {
            for share in SHORTER {
                let mut shorter = gear.clone();
                shorter.mesh.body_m *= share;
                if let Ok(mesh) = Self::made(&shorter, python) {
                    return Ok(mesh);
                }
            }
        }
        made.map_err(|error| error.with_lengths(gear))
    }

    fn made(gear: &GearDefinition, python: &PythonEnvironment) -> Result<Self, MeshError> {
        if gear.mesh.element == Element::Tet10 && gear.blank.meshed().is_none() {
            return Self::in_tetrahedra(gear, python);
        }
        if let Some(body) = gear.blank.meshed() {
            return Err(MeshError::MeshedElsewhere {
                file: body.file.display().to_string(),
            });
        }
        let section = Section::new(gear, python)?;
        let layers = Layers::new(gear);
        let heights = Heights::new(gear, &layers);
        Self::extruded(
            section,
            layers,
            &heights,
            Twist::new(gear),
            gear.mesh.min_scaled_jacobian,
        )
    }

    /// The same cross-section in one layer, web and rim alike, not twisted: for problems of plane strain.
    ///
    /// # Errors
    /// None in fact: the quads were accepted before. [`MeshError::Quality`] for a section of no worth at all.
    pub fn single_layer(&self, width_m: f64) -> Result<Self, MeshError> {
        Self::extruded(
            self.section.clone(),
            Layers::single(width_m),
            &Heights::default(),
            Twist::default(),
            0.0,
        )
    }

    fn extruded(
        section: Section,
        layers: Layers,
        heights: &Heights,
        twist: Twist,
        min_scaled_jacobian: f64,
    ) -> Result<Self, MeshError> {
        let shape = section.element_shape();
        let levels_m = if shape.is_quadratic() {
            layers.planes_and_middles_m()
        } else {
            layers.planes_m.clone()
        };
        let (n_levels, n_layers) = (levels_m.len(), layers.count());
        let reach = |quad: usize| {
            let radii = section.quads[quad].map(|n| section.nodes[n][0].hypot(section.nodes[n][1]));
            radii.into_iter().fold(0.0, f64::max)
        };
        let in_layer = |quad: usize, layer: usize| match layers.stub_radius_m(layer) {
            None => !section.web_only[quad] || layers.web.contains(&layer),
            Some(radius) => reach(quad) <= radius * (1.0 + SAME_RADIUS),
        };
        let mut node_of = vec![NONE; section.nodes.len() * n_levels];
        let mut element_of = vec![NONE; section.quads.len() * n_layers];
        for quad in 0..section.quads.len() {
            for layer in (0..n_layers).filter(|&l| in_layer(quad, l)) {
                for (n, level) in places(&section, quad, layer) {
                    node_of[n * n_levels + level] = 0;
                }
            }
        }
        let mut nodes = Vec::new();
        for (n, p) in section.nodes.iter().enumerate() {
            for (level, &z) in levels_m.iter().enumerate() {
                let slot = &mut node_of[n * n_levels + level];
                if *slot != NONE {
                    *slot = nodes.len() as u32;
                    nodes.push(twist.point_m(*p, heights.z_m(p[0].hypot(p[1]), z)));
                }
            }
        }
        let mut elements = ElementList::new(shape);
        for quad in 0..section.quads.len() {
            for layer in (0..n_layers).filter(|&l| in_layer(quad, l)) {
                let places = places(&section, quad, layer).into_iter();
                element_of[quad * n_layers + layer] =
                    elements.push(places.map(|(n, level)| node_of[n * n_levels + level]));
            }
        }
        let quality = quality::report(&nodes, &elements);
        quality.demand(min_scaled_jacobian)?;
        Ok(Self {
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
        })
    }

    /// Node of the cross-section node `n` on a level, where it exists. Levels are the planes between the layers; with
    /// quadratic elements the even ones are, and the odd ones lie half way between.
    pub fn node(&self, n: usize, level: usize) -> Option<u32> {
        Some(self.node_of[n * self.levels_m.len() + level]).filter(|&id| id != NONE)
    }

    /// Element of the cross-section quad `quad` in `layer`, where it exists.
    pub fn element(&self, quad: usize, layer: usize) -> Option<u32> {
        Some(self.element_of[quad * self.layers.count() + layer]).filter(|&id| id != NONE)
    }

    /// Nodes above and below some nodes of the cross-section: those of the first, from −z to +z, then those of the
    /// second, ...
    pub(crate) fn columns(&self, section_nodes: impl IntoIterator<Item = usize>) -> Vec<u32> {
        self.columns_between(0..self.levels_m.len(), section_nodes)
    }

    /// As [`GearMesh::columns`], on some levels.
    pub(crate) fn columns_between(
        &self,
        levels: Range<usize>,
        section_nodes: impl IntoIterator<Item = usize>,
    ) -> Vec<u32> {
        section_nodes
            .into_iter()
            .flat_map(|n| levels.clone().filter_map(move |level| self.node(n, level)))
            .collect()
    }

    /// Elements of some quads of the cross-section in all layers.
    pub(crate) fn elements_of(&self, quads: impl IntoIterator<Item = usize>) -> Vec<u32> {
        let layers = 0..self.layers.count();
        quads
            .into_iter()
            .flat_map(|q| {
                layers
                    .clone()
                    .filter_map(move |layer| self.element(q, layer))
                    .flat_map(|first| first..first + self.in_brick())
            })
            .collect()
    }

    /// Elements that a quad has in a layer.
    pub(crate) fn in_brick(&self) -> u32 {
        match self.elements.shape() {
            CellKind::Tet10 => tet_split::TETRAHEDRA as u32,
            _ => 1,
        }
    }

    /// Degrees of freedom before anything is fixed.
    pub fn dofs(&self) -> usize {
        3 * self.nodes.len()
    }
}

/// Section node and level of the nodes of a quad's element in a layer, VTK order.
fn places(section: &Section, quad: usize, layer: usize) -> Vec<(usize, usize)> {
    let middles = section.mid_sides.get(quad).copied();
    let step = if middles.is_some() { 2 } else { 1 };
    brick(section.quads[quad], middles, step * layer)
}
