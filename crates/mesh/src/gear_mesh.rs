//! Nodes and elements of the whole gear, with the sets that the reduction needs.
//!
//! A quadratic mesh has the same section and layers; the section then has nodes in the middle of its edges too, and
//! between two planes there is a level of nodes half way up, above the quads' corners only. Where elements are
//! tetrahedra only the teeth are made of layers, each brick of them split (`tet_mesh.rs`); the body is a free mesh.

use crate::MeshError;
use crate::elements::ElementList;
use crate::face::{FaceShape, OutlineFace};
use crate::heights::Heights;
use crate::layers::Layers;
use crate::python::PythonEnvironment;
use crate::quality::{self, QualityReport};
use crate::section::Section;
use crate::solid_body::SolidBody;
use crate::tet_split;
use crate::twist::Twist;
use gearmesh_elements::CellKind;
use gearmesh_geometry::{Blank, Element, Flank, GearDefinition, ProfileCurve};
use std::collections::BTreeMap;
use std::ops::{Range, RangeInclusive};

const NONE: u32 = u32::MAX;
/// Rounding of radii.
const SAME_RADIUS: f64 = 1e-6;

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
    /// Meshes a gear.
    ///
    /// # Errors
    /// [`MeshError`] when gmsh is missing or fails, or when the mesh is poorer than `min_scaled_jacobian`.
    pub fn new(gear: &GearDefinition, python: &PythonEnvironment) -> Result<Self, MeshError> {
        Self::made(gear, python).map_err(|error| error.with_lengths(gear))
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
        Self::in_layers(gear, Section::new(gear, python)?)
    }

    /// A gear's layers over a cross-section that is at hand: that of a mesh which differs along the axis only.
    ///
    /// # Errors
    /// [`MeshError::Quality`].
    pub fn in_layers(gear: &GearDefinition, section: Section) -> Result<Self, MeshError> {
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
        // Section node and level of the nodes of a quad's element, VTK order.
        let places = |quad: usize, layer: usize| -> Vec<(usize, usize)> {
            let corners = section.quads[quad];
            let at = |nodes: [usize; 4], level: usize| nodes.map(|n| (n, level));
            match section.mid_sides.get(quad) {
                None => [at(corners, layer), at(corners, layer + 1)].concat(),
                Some(&middles) => {
                    let (low, high) = (2 * layer, 2 * layer + 2);
                    [
                        at(corners, low),
                        at(corners, high),
                        at(middles, low),
                        at(middles, high),
                        at(corners, low + 1),
                    ]
                    .concat()
                }
            }
        };

        let mut node_of = vec![NONE; section.nodes.len() * n_levels];
        let mut element_of = vec![NONE; section.quads.len() * n_layers];
        for quad in 0..section.quads.len() {
            for layer in (0..n_layers).filter(|&l| in_layer(quad, l)) {
                for (n, level) in places(quad, layer) {
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
                let places = places(quad, layer).into_iter();
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
    fn columns(&self, section_nodes: impl IntoIterator<Item = usize>) -> Vec<u32> {
        self.columns_between(0..self.levels_m.len(), section_nodes)
    }

    /// As [`GearMesh::columns`], on some levels.
    fn columns_between(
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
    fn elements_of(&self, quads: impl IntoIterator<Item = usize>) -> Vec<u32> {
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

    /// Nodes at which the gear is held: those of the bore, of a gear cut into its shaft those at the ends of the
    /// shaft's stubs, of a ring those on the outside, or on the band and the lugs of it that are held.
    pub fn held(&self, blank: &Blank) -> Vec<u32> {
        if blank.cut_into_shaft().is_some() {
            return self.stub_ends().concat();
        }
        let mut held = self.bore();
        if let Some([from, to]) = blank.rim().and_then(|rim| rim.held_z_m) {
            let slack = SAME_RADIUS * (to - from);
            let band = from - slack..=to + slack;
            held.retain(|&node| band.contains(&self.nodes[node as usize][2]));
        }
        if let Some(lugs) = blank.rim().and_then(|rim| rim.lugs) {
            let reach = 0.5 * lugs.width_rad * (1.0 + SAME_RADIUS);
            held.retain(|&node| {
                let [x, y, _] = self.nodes[node as usize];
                lugs.from_middle_rad(y.atan2(x)) <= reach
            });
        }
        held
    }

    /// Nodes at the ends of the shaft's stubs on the back and the front face; none where the shaft does not go on.
    pub fn stub_ends(&self) -> [Vec<u32>; 2] {
        let levels = [0, self.levels_m.len() - 1];
        [0, 1].map(|face| {
            if self.layers.stub_radii_m[face] == 0.0 {
                return Vec::new();
            }
            let mut nodes: Vec<u32> = (0..self.section.nodes.len())
                .filter_map(|n| self.node(n, levels[face]))
                .collect();
            nodes.sort_unstable();
            nodes
        })
    }

    /// Elements of the shaft's stubs, whose mass is the shaft's; none of a gear with a bore.
    pub fn stub_elements(&self) -> Vec<u32> {
        let quads = 0..self.section.quads.len();
        let stubs = (0..self.layers.count()).filter(|layer| !self.layers.face.contains(layer));
        quads
            .flat_map(|quad| {
                stubs
                    .clone()
                    .filter_map(move |layer| self.element(quad, layer))
            })
            .collect()
    }

    /// Nodes of the bore, of a ring those of its outside.
    pub fn bore(&self) -> Vec<u32> {
        if let Some(solid) = &self.solid {
            return solid.bore.clone();
        }
        self.columns(self.section.bore.iter().copied())
    }

    /// Number of teeth.
    pub fn teeth(&self) -> usize {
        self.section.cell_nodes.len()
    }

    /// Number of repeating sectors.
    pub fn sectors(&self) -> usize {
        self.section.body_quads.len()
    }

    /// First tooth of sector 0; sector s begins teeth/sectors teeth further on for each sector.
    pub fn first_tooth(&self) -> usize {
        self.section.first_tooth
    }

    /// Nodes of a tooth with the ring below it, the i-th of each tooth the image of the i-th of tooth 0.
    pub fn cell_nodes(&self, tooth: usize) -> Vec<u32> {
        // A shaft as thick as the ring goes on below it: what is beyond the faces is no part of the teeth.
        let step = (self.levels_m.len() - 1) / self.layers.count();
        let face = &self.layers.face;
        self.columns_between(
            step * face.start..step * face.end + 1,
            self.section.cell_nodes[tooth].iter().copied(),
        )
    }

    /// Elements of a tooth with the ring below it.
    pub fn cell_elements(&self, tooth: usize) -> Vec<u32> {
        let first = self.section.cell_first_quad[tooth];
        self.elements_of(first..first + self.section.cell.quads.len())
    }

    /// Nodes of a sector's part of hub, web and rim, with what it shares with the teeth, the i-th of each sector the
    /// image of the i-th of sector 0. Outside the web's layers the shared ones are the teeth's alone.
    pub fn body_nodes(&self, sector: usize) -> Vec<u32> {
        if let Some(solid) = &self.solid {
            return solid.nodes[sector].clone();
        }
        self.columns(self.section.body_nodes[sector].iter().copied())
    }

    /// Elements of a sector's part of hub, web and rim.
    pub fn body_elements(&self, sector: usize) -> Vec<u32> {
        if let Some(solid) = &self.solid {
            return solid.elements[sector].clone().collect();
        }
        self.elements_of(self.section.body_quads[sector].clone())
    }

    /// Nodes that a crack doubles on a tooth, and the elements on the side of the tooth's tip that get the doubles;
    /// none without a crack.
    pub fn crack(&self, tooth: usize) -> Option<(Vec<u32>, Vec<u32>)> {
        let crack = self.section.crack.as_ref()?;
        let map = &self.section.cell_nodes[tooth];
        let first = self.section.cell_first_quad[tooth];
        Some((
            self.columns(crack.doubled.iter().map(|&c| map[c])),
            self.elements_of(crack.beyond.iter().map(|&q| first + q)),
        ))
    }

    /// Nodes of the cut before the first tooth of a sector, the i-th of each sector the image of the i-th of sector 0.
    pub fn cut_nodes(&self, sector: usize) -> Vec<u32> {
        let (teeth, sectors) = (self.teeth(), self.sectors());
        let cell =
            &self.section.cell_nodes[(self.first_tooth() + sector * teeth / sectors) % teeth];
        let body = &self.section.body_nodes[sector];
        let in_cell = self.section.cell.right_side.iter().map(|&c| cell[c]);
        let in_body = self.section.body_right_side.iter().map(|&c| body[c]);
        let mut nodes = self.columns(in_cell.chain(in_body));
        if let Some(solid) = &self.solid {
            let side = solid.right_side.iter();
            nodes.extend(side.map(|&local| solid.nodes[sector][local]));
        }
        nodes
    }

    /// Nodes of one tooth on its outline between two of the outline's corners (numbers along
    /// [`crate::tooth_cell::ToothCell::outline`]).
    fn outline_nodes(&self, tooth: usize, range: RangeInclusive<usize>) -> Vec<u32> {
        let cell = &self.section.cell;
        let map = &self.section.cell_nodes[tooth];
        let (first, last) = (*range.start(), *range.end());
        let middles = cell.outline_mid_sides.iter().take(last).skip(first);
        self.columns(cell.outline[range].iter().chain(middles).map(|&c| map[c]))
    }

    /// Faces of one side of a tooth between two arc lengths (from the centre of that side's tooth space), including
    /// those that are partly outside.
    pub fn outline_faces(&self, tooth: usize, side: Flank, arc_m: [f64; 2]) -> Vec<OutlineFace> {
        let cell = &self.section.cell;
        let total = cell.outline_arc_m[cell.outline_arc_m.len() - 1];
        let map = &self.section.cell_nodes[tooth];
        let mut faces = Vec::new();
        for i in 0..cell.outline_quads.len() {
            // On the left side arc length runs the other way, start and end change places.
            let (start, end) = match side {
                Flank::Right => (i, i + 1),
                Flank::Left => (i + 1, i),
            };
            let from_space = |k: usize| match side {
                Flank::Right => cell.outline_arc_m[k],
                Flank::Left => total - cell.outline_arc_m[k],
            };
            let arcs = [from_space(start), from_space(end)];
            if arcs[1] <= arc_m[0] || arcs[0] >= arc_m[1] {
                continue;
            }
            let (a, b) = (map[cell.outline[start]], map[cell.outline[end]]);
            let quad = self.section.cell_first_quad[tooth] + cell.outline_quads[i];
            // Section node, arc length and level of each node of the face.
            let middle = cell.outline_mid_sides.get(i).map(|&c| map[c]);
            for layer in 0..self.layers.count() {
                let Some(element) = self.element(quad, layer) else {
                    continue;
                };
                let step = if middle.is_some() { 2 } else { 1 };
                let (low, high) = (step * layer, step * (layer + 1));
                if let (Some(m), CellKind::Tet10) = (middle, self.elements.shape()) {
                    faces.extend(self.split_faces([a, m, b], arcs, layer, element));
                    continue;
                }
                let mut places = vec![
                    (a, arcs[0], low),
                    (b, arcs[1], low),
                    (b, arcs[1], high),
                    (a, arcs[0], high),
                ];
                if let Some(m) = middle {
                    let arc = 0.5 * (arcs[0] + arcs[1]);
                    places.extend([
                        (m, arc, low),
                        (b, arcs[1], low + 1),
                        (m, arc, high),
                        (a, arcs[0], low + 1),
                    ]);
                }
                faces.push(OutlineFace {
                    shape: match middle {
                        None => FaceShape::Quad4,
                        Some(_) => FaceShape::Quad8,
                    },
                    nodes: places
                        .iter()
                        .filter_map(|&(n, _, level)| self.node(n, level))
                        .collect(),
                    element,
                    places_m: places
                        .iter()
                        .map(|&(_, arc, level)| [arc, self.levels_m[level]])
                        .collect(),
                });
            }
        }
        faces
    }

    /// Elements of the tooth-only submodel: the tooth above the cut.
    pub fn tooth_elements(&self, tooth: usize) -> Vec<u32> {
        let cell = &self.section.cell;
        let first = self.section.cell_first_quad[tooth];
        let above = (0..cell.quads.len()).filter(|&q| cell.above_cut[q]);
        self.elements_of(above.map(|q| first + q))
    }

    /// Nodes of the cut below a tooth's submodel.
    pub fn tooth_cut(&self, tooth: usize) -> Vec<u32> {
        let map = &self.section.cell_nodes[tooth];
        self.columns(self.section.cell.cut.iter().map(|&c| map[c]))
    }

    /// Nodes that hold the tooth-only submodel for loads on `loaded`: the cut, and the opposite side of the tooth
    /// above it (fillet and flank up to the tip corner).
    pub fn tooth_supports(&self, tooth: usize, loaded: Flank) -> Vec<u32> {
        let cell = &self.section.cell;
        let mut nodes = self.tooth_cut(tooth);
        let last = cell.outline.len() - 1;
        let tip = self.tip_corner_index();
        let cut = cell
            .outline
            .iter()
            .position(|n| Some(n) == cell.cut.first())
            .unwrap_or(0);
        nodes.extend(match loaded {
            Flank::Left => self.outline_nodes(tooth, cut..=tip),
            Flank::Right => self.outline_nodes(tooth, last - tip..=last - cut),
        });
        nodes.sort_unstable();
        nodes.dedup();
        nodes
    }

    /// Number, along the outline, of the corner between right flank (or chamfer) and tip land.
    fn tip_corner_index(&self) -> usize {
        let cell = &self.section.cell;
        let radius = |n: usize| self.section.cell.nodes[n][0].hypot(self.section.cell.nodes[n][1]);
        // The middle of the outline is the middle of the tip land.
        let tip = radius(cell.outline[cell.outline.len() / 2]);
        cell.outline
            .iter()
            .position(|&n| (radius(n) / tip - 1.0).abs() < 1e-9)
            .unwrap_or(0)
    }

    /// Named node sets for files: `bore` (of a gear cut into its shaft `shaft`, of a ring `outside`), and for each tooth
    /// `tooth<k>_right_flank`, `_left_flank`, `_root`.
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
        let name = match &gear.blank {
            Blank::CutIntoShaft(_) => "shaft",
            Blank::Ring(_) => "outside",
            _ => "bore",
        };
        let mut sets = BTreeMap::from([(name.to_string(), self.held(&gear.blank))]);
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
