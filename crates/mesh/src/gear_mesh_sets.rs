//! Sets of nodes and elements of a meshed gear: where it is held, its teeth, cells and bodies, faces along the outline.

use crate::face::{OutlineFace, outline_face};
use crate::gear_mesh::{GearMesh, SAME_RADIUS};
use gearmesh_elements::CellKind;
use gearmesh_geometry::{Blank, Flank, GearDefinition, ProfileCurve};
use std::collections::BTreeMap;
use std::ops::RangeInclusive;

impl GearMesh {
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
            let middle = cell.outline_mid_sides.get(i).map(|&c| map[c]);
            for layer in 0..self.layers.count() {
                let Some(element) = self.element(quad, layer) else {
                    continue;
                };
                if let (Some(m), CellKind::Tet10) = (middle, self.elements.shape()) {
                    faces.extend(self.split_faces([a, m, b], arcs, layer, element));
                    continue;
                }
                let along = match middle {
                    None => vec![(a, arcs[0]), (b, arcs[1])],
                    Some(m) => vec![(a, arcs[0]), (m, 0.5 * (arcs[0] + arcs[1])), (b, arcs[1])],
                };
                let order = along.len() - 1;
                let (shape, places) = outline_face(order, (0, order * layer));
                faces.push(OutlineFace {
                    shape,
                    nodes: (places.iter())
                        .filter_map(|&(k, level)| self.node(along[k].0, level))
                        .collect(),
                    element,
                    places_m: (places.iter())
                        .map(|&(k, level)| [along[k].1, self.levels_m[level]])
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

    /// Named node sets for files: `bore` (of a gear cut into its shaft `shaft`, of a ring `outside`), and for each
    /// tooth `tooth<k>_right_flank`, `_left_flank`, `_root`.
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
}
