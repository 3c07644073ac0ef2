//! Nodes and hexahedra of the whole gear, with the sets that the reduction needs.

use crate::MeshError;
use crate::layers::Layers;
use crate::python::PythonEnvironment;
use crate::quality::{self, QualityReport};
use crate::section::Section;
use crate::twist::Twist;
use gearmesh_geometry::{FlankSide, GearDefinition, ProfileCurve};
use std::collections::BTreeMap;

const NONE: u32 = u32::MAX;

/// A meshed gear.
#[derive(Debug, Clone)]
pub struct GearMesh {
    /// \[x, y, z\] \[m\].
    pub nodes: Vec<[f64; 3]>,
    /// Node numbers in VTK order.
    pub hexes: Vec<[u32; 8]>,
    /// Cross-section.
    pub section: Section,
    /// Layers.
    pub layers: Layers,
    /// How the sections turn along the axis; `section` is the one at z = 0.
    pub twist: Twist,
    /// Quality.
    pub quality: QualityReport,
    node_of: Vec<u32>,
    hex_of: Vec<u32>,
}

/// A face of a tooth's outline: one piece of the outline in one layer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OutlineFace {
    /// Nodes: (start, lower plane), (end, lower), (end, upper), (start, upper).
    pub nodes: [u32; 4],
    /// Element behind the face.
    pub hex: u32,
    /// Arc lengths of start and end, from the centre of the tooth space of the side asked for \[m\].
    pub arc_m: [f64; 2],
    /// Axial range \[m\]. The face of a helical tooth is turned from z = 0 by [`GearMesh::twist`].
    pub z_m: [f64; 2],
}

impl GearMesh {
    /// Meshes a gear.
    ///
    /// # Errors
    /// [`MeshError`] when gmsh is missing or fails, or when the mesh is poorer than `min_scaled_jacobian`.
    pub fn new(gear: &GearDefinition, python: &PythonEnvironment) -> Result<Self, MeshError> {
        Self::extruded(
            Section::new(gear, python)?,
            Layers::new(gear),
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
            Twist::default(),
            0.0,
        )
    }

    fn extruded(
        section: Section,
        layers: Layers,
        twist: Twist,
        min_scaled_jacobian: f64,
    ) -> Result<Self, MeshError> {
        let (n_planes, n_layers) = (layers.planes_m.len(), layers.count());
        let in_layer =
            |quad: usize, layer: usize| !section.web_only[quad] || layers.web.contains(&layer);

        let mut node_of = vec![NONE; section.nodes.len() * n_planes];
        for (q, quad) in section.quads.iter().enumerate() {
            for layer in (0..n_layers).filter(|&l| in_layer(q, l)) {
                for &n in quad {
                    node_of[n * n_planes + layer] = 0;
                    node_of[n * n_planes + layer + 1] = 0;
                }
            }
        }
        let mut nodes = Vec::new();
        for (n, p) in section.nodes.iter().enumerate() {
            for (plane, &z) in layers.planes_m.iter().enumerate() {
                let slot = &mut node_of[n * n_planes + plane];
                if *slot != NONE {
                    *slot = nodes.len() as u32;
                    nodes.push(twist.point_m(*p, z));
                }
            }
        }
        let mut hex_of = vec![NONE; section.quads.len() * n_layers];
        let mut hexes = Vec::new();
        for (q, quad) in section.quads.iter().enumerate() {
            for layer in (0..n_layers).filter(|&l| in_layer(q, l)) {
                hex_of[q * n_layers + layer] = hexes.len() as u32;
                hexes.push(std::array::from_fn(|i| {
                    node_of[quad[i % 4] * n_planes + layer + i / 4]
                }));
            }
        }
        let quality = quality::report(&nodes, &hexes);
        if quality.smallest < min_scaled_jacobian {
            let [x, y, z] = quality.worst_m.map(|v| v * 1e3);
            return Err(MeshError::Quality {
                found: quality.smallest,
                demanded: min_scaled_jacobian,
                x_mm: x,
                y_mm: y,
                z_mm: z,
            });
        }
        Ok(Self {
            nodes,
            hexes,
            section,
            layers,
            twist,
            quality,
            node_of,
            hex_of,
        })
    }

    /// Node of the cross-section node `n` on `plane`, where it exists.
    pub fn node(&self, n: usize, plane: usize) -> Option<u32> {
        Some(self.node_of[n * self.layers.planes_m.len() + plane]).filter(|&id| id != NONE)
    }

    /// Element of the cross-section quad `quad` in `layer`, where it exists.
    pub fn hex(&self, quad: usize, layer: usize) -> Option<u32> {
        Some(self.hex_of[quad * self.layers.count() + layer]).filter(|&id| id != NONE)
    }

    /// Nodes of the bore.
    pub fn bore(&self) -> Vec<u32> {
        let planes = 0..self.layers.planes_m.len();
        self.section
            .bore
            .iter()
            .flat_map(|&n| planes.clone().filter_map(move |p| self.node(n, p)))
            .collect()
    }

    /// Nodes of one tooth on its outline pieces `range` (numbers along [`crate::tooth_cell::ToothCell::outline`]).
    fn outline_nodes(&self, tooth: usize, range: std::ops::RangeInclusive<usize>) -> Vec<u32> {
        let planes = 0..self.layers.planes_m.len();
        range
            .flat_map(|i| {
                let n = self.section.cell_nodes[tooth][self.section.cell.outline[i]];
                planes.clone().filter_map(move |p| self.node(n, p))
            })
            .collect()
    }

    /// Faces of one side of a tooth between two arc lengths (from the centre of that side's tooth space), including
    /// those that are partly outside.
    pub fn outline_faces(
        &self,
        tooth: usize,
        side: FlankSide,
        arc_m: [f64; 2],
    ) -> Vec<OutlineFace> {
        let cell = &self.section.cell;
        let total = cell.outline_arc_m[cell.outline_arc_m.len() - 1];
        let mut faces = Vec::new();
        for i in 0..cell.outline_quads.len() {
            // On the left side arc length runs the other way, start and end change places.
            let (start, end) = match side {
                FlankSide::Right => (i, i + 1),
                FlankSide::Left => (i + 1, i),
            };
            let from_space = |k: usize| match side {
                FlankSide::Right => cell.outline_arc_m[k],
                FlankSide::Left => total - cell.outline_arc_m[k],
            };
            let arcs = [from_space(start), from_space(end)];
            if arcs[1] <= arc_m[0] || arcs[0] >= arc_m[1] {
                continue;
            }
            let map = &self.section.cell_nodes[tooth];
            let (a, b) = (map[cell.outline[start]], map[cell.outline[end]]);
            let quad = self.section.cell_first_quad[tooth] + cell.outline_quads[i];
            for layer in 0..self.layers.count() {
                let hex = self.hex_of[quad * self.layers.count() + layer];
                let corner = |n: usize, plane: usize| self.node(n, plane).unwrap_or(NONE);
                faces.push(OutlineFace {
                    nodes: [
                        corner(a, layer),
                        corner(b, layer),
                        corner(b, layer + 1),
                        corner(a, layer + 1),
                    ],
                    hex,
                    arc_m: arcs,
                    z_m: [self.layers.planes_m[layer], self.layers.planes_m[layer + 1]],
                });
            }
        }
        faces
    }

    /// Elements of the tooth-only submodel: the tooth above the cut.
    pub fn tooth_hexes(&self, tooth: usize) -> Vec<u32> {
        let cell = &self.section.cell;
        let first = self.section.cell_first_quad[tooth];
        (0..cell.quads.len())
            .filter(|&q| cell.above_cut[q])
            .flat_map(|q| (0..self.layers.count()).map(move |layer| (first + q, layer)))
            .map(|(q, layer)| self.hex_of[q * self.layers.count() + layer])
            .filter(|&h| h != NONE)
            .collect()
    }

    /// Nodes that hold the tooth-only submodel for loads on `loaded`: the cut, and the opposite side of the tooth
    /// above it (fillet and flank up to the tip corner).
    pub fn tooth_supports(&self, tooth: usize, loaded: FlankSide) -> Vec<u32> {
        let cell = &self.section.cell;
        let planes = 0..self.layers.planes_m.len();
        let mut nodes: Vec<u32> = cell
            .cut
            .iter()
            .flat_map(|&local| {
                let n = self.section.cell_nodes[tooth][local];
                planes.clone().filter_map(move |p| self.node(n, p))
            })
            .collect();
        let last = cell.outline.len() - 1;
        let tip = self.tip_corner_index();
        let cut = cell
            .outline
            .iter()
            .position(|n| Some(n) == cell.cut.first())
            .unwrap_or(0);
        nodes.extend(match loaded {
            FlankSide::Left => self.outline_nodes(tooth, cut..=tip),
            FlankSide::Right => self.outline_nodes(tooth, last - tip..=last - cut),
        });
        nodes.sort_unstable();
        nodes.dedup();
        nodes
    }

    /// Number, along the outline, of the corner between right flank (or chamfer) and tip land.
    fn tip_corner_index(&self) -> usize {
        let cell = &self.section.cell;
        let tip_radius =
            |n: usize| self.section.cell.nodes[n][0].hypot(self.section.cell.nodes[n][1]);
        let top = cell
            .outline
            .iter()
            .map(|&n| tip_radius(n))
            .fold(0.0, f64::max);
        cell.outline
            .iter()
            .position(|&n| tip_radius(n) > top * (1.0 - 1e-9))
            .unwrap_or(0)
    }

    /// Named node sets for files: `bore`, and for each tooth `tooth<k>_right_flank`, `_left_flank`, `_root`.
    pub fn node_sets(&self, gear: &GearDefinition) -> BTreeMap<String, Vec<u32>> {
        let curve = ProfileCurve::new(&gear.profile);
        let (start, end) = (curve.flank_start_m(), curve.flank_end_m());
        let cell = &self.section.cell;
        let last = cell.outline.len() - 1;
        let tolerance = 1e-9;
        let first_flank = cell
            .outline_arc_m
            .iter()
            .position(|&s| s >= start - tolerance)
            .unwrap_or(0);
        let last_flank = cell
            .outline_arc_m
            .iter()
            .rposition(|&s| s <= end + tolerance)
            .unwrap_or(last);
        let mut sets = BTreeMap::from([("bore".to_string(), self.bore())]);
        for tooth in 0..gear.tooth.teeth {
            sets.insert(
                format!("tooth{tooth}_right_flank"),
                self.outline_nodes(tooth, first_flank..=last_flank),
            );
            sets.insert(
                format!("tooth{tooth}_left_flank"),
                self.outline_nodes(tooth, last - last_flank..=last - first_flank),
            );
            let mut root = self.outline_nodes(tooth, 0..=first_flank);
            root.extend(self.outline_nodes(tooth, last - first_flank..=last));
            sets.insert(format!("tooth{tooth}_root"), root);
        }
        sets
    }

    /// Degrees of freedom before anything is fixed.
    pub fn dofs(&self) -> usize {
        3 * self.nodes.len()
    }
}
