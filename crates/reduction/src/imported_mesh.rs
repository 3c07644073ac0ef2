//! A gear that was meshed elsewhere: its bore, its teeth and the faces of their outlines.
//!
//! Node sets say which nodes lie on the bore and on each flank. Everything else follows from where nodes are: a face of the
//! boundary whose nodes all lie on the exact profile of a tooth belongs to its outline, and its place there, arc length and z of
//! each node, is that of the profile point at the same radius. So root fillets need no set.
//!
//! The tooth-only submodel is cut where the definition's own mesh would be cut ([`CutLine`]): elements with a corner above the
//! line belong to it, and their nodes on or below the line are held. In a mesh that has the line among its edges this is the
//! submodel of the tooth's own mesh; otherwise the cut is a staircase one element deep.

use crate::ReductionError;
use crate::imported_error::ImportedMeshError;
use crate::toothed_mesh::ToothedMesh;
use gearmesh_fe::{Element, ElementBlock, FeModel, Material};
use gearmesh_geometry::{ElementKind, FlankSide, GearDefinition, MeshedBody, ProfileCurve};
use gearmesh_mesh::{CutLine, FaceShape, OutlineFace};
use gearmesh_model::{CellKind, MeshData};
use std::collections::{BTreeMap, HashMap};
use std::f64::consts::{PI, TAU};

/// Distance to the bore or to the profile that is forgiven, as a share of the module.
const TOLERANCE: f64 = 2e-3;
/// Share of a flank that the faces of its set must cover.
const COVERAGE: f64 = 0.99;
/// Margin \[modules\] by which a node on the cut counts as below it.
const CUT_MARGIN: f64 = 1e-6;

/// A face of the mesh's boundary.
struct BoundaryFace {
    element: u32,
    shape: FaceShape,
    nodes: Vec<u32>,
}

/// A gear that was meshed elsewhere.
pub struct ImportedMesh {
    /// The finite element model.
    pub model: FeModel,
    /// Nodes of the bore.
    pub bore: Vec<u32>,
    /// Where the tooth-only submodels are cut.
    pub cut: CutLine,
    /// Outline faces by tooth and side (right, left), by growing arc length.
    outlines: Vec<[Vec<OutlineFace>; 2]>,
    /// Elements of each tooth above the cut.
    tooth_elements: Vec<Vec<u32>>,
    /// Their nodes on or below the cut.
    cut_nodes: Vec<Vec<u32>>,
    /// Their nodes on the outline above the cut, by side.
    side_nodes: Vec<[Vec<u32>; 2]>,
}

impl ImportedMesh {
    /// Checks a mesh against the definition and finds its teeth.
    ///
    /// # Errors
    /// [`ReductionError::Imported`] that says what is missing or in the wrong place; [`ReductionError::Fe`] naming an element
    /// that is inside out.
    pub fn new(
        gear: &GearDefinition,
        body: &MeshedBody,
        mesh: MeshData,
    ) -> Result<Self, ReductionError> {
        let check = Check {
            gear,
            body,
            curve: ProfileCurve::new(&gear.profile),
            mesh: &mesh,
        };
        check.parts()?;
        let bore = check.bore()?;
        let flanks = check.flanks()?;
        let model = check.model()?;
        let faces = boundary_faces(&model);
        let outlines = check.outlines(&model, &faces);
        check.coverage(&outlines, &flanks)?;
        let mut imported = Self {
            model,
            bore,
            cut: CutLine::new(gear),
            outlines,
            tooth_elements: Vec::new(),
            cut_nodes: Vec::new(),
            side_nodes: Vec::new(),
        };
        imported.find_teeth(gear);
        Ok(imported)
    }

    /// Elements above the cut, which of their nodes hold them.
    fn find_teeth(&mut self, gear: &GearDefinition) {
        let (teeth, nodes) = (gear.tooth.teeth, self.model.nodes());
        let margin = CUT_MARGIN * gear.tooth.module_m;
        // The tooth above whose cut a node lies, if any.
        let above: Vec<Option<usize>> = nodes
            .iter()
            .map(|x| {
                let tooth = nearest_tooth(*x, teeth);
                let point = in_tooth(*x, tooth, teeth, FlankSide::Right);
                (!self.cut.is_below(point, margin)).then_some(tooth)
            })
            .collect();
        let mut elements = vec![Vec::new(); teeth];
        for e in 0..self.model.element_count() {
            let mut own = self.model.element_nodes(e).iter();
            if let Some(tooth) = own.find_map(|n| above[*n as usize]) {
                elements[tooth].push(e as u32);
            }
        }
        for (tooth, elements) in elements.into_iter().enumerate() {
            let of_tooth = elements
                .iter()
                .flat_map(|&e| self.model.element_nodes(e as usize));
            let mut below: Vec<u32> = of_tooth
                .copied()
                .filter(|n| above[*n as usize].is_none())
                .collect();
            below.sort_unstable();
            below.dedup();
            let sides = [FlankSide::Right, FlankSide::Left].map(|side| {
                let faces = &self.outlines[tooth][side_index(side)];
                let mut on_side: Vec<u32> = faces
                    .iter()
                    .flat_map(|face| face.nodes.iter().copied())
                    .filter(|n| above[*n as usize].is_some())
                    .collect();
                on_side.sort_unstable();
                on_side.dedup();
                on_side
            });
            self.tooth_elements.push(elements);
            self.cut_nodes.push(below);
            self.side_nodes.push(sides);
        }
    }
}

impl ToothedMesh for ImportedMesh {
    fn outline_faces(&self, tooth: usize, side: FlankSide, arc_m: [f64; 2]) -> Vec<OutlineFace> {
        let faces = self.outlines[tooth][side_index(side)].iter();
        let inside = |face: &&OutlineFace| {
            let [from, to] = face.range_m(0);
            to > arc_m[0] && from < arc_m[1]
        };
        faces.filter(inside).cloned().collect()
    }

    fn twist_rad_per_m(&self) -> f64 {
        0.0
    }

    fn tooth_elements(&self, tooth: usize) -> Vec<u32> {
        self.tooth_elements[tooth].clone()
    }

    fn tooth_supports(&self, tooth: usize, loaded: FlankSide) -> Vec<u32> {
        let opposite = &self.side_nodes[tooth][side_index(loaded.opposite())];
        let mut nodes = [&self.cut_nodes[tooth][..], &opposite[..]].concat();
        nodes.sort_unstable();
        nodes.dedup();
        nodes
    }
}

const fn side_index(side: FlankSide) -> usize {
    match side {
        FlankSide::Right => 0,
        FlankSide::Left => 1,
    }
}

/// The tooth in whose pitch a point lies.
fn nearest_tooth([x, y, _]: [f64; 3], teeth: usize) -> usize {
    let pitch = TAU / teeth as f64;
    (y.atan2(x) / pitch).round().rem_euclid(teeth as f64) as usize
}

/// A point \[x, y\] in the frame of a tooth's right half: turned back to +x, and mirrored for the left side.
fn in_tooth([x, y, _]: [f64; 3], tooth: usize, teeth: usize, side: FlankSide) -> [f64; 2] {
    let (sin, cos) = (TAU * tooth as f64 / teeth as f64).sin_cos();
    let turned = [cos * x + sin * y, cos * y - sin * x];
    [turned[0], side.mirror() * turned[1]]
}

/// Faces that belong to one element only.
fn boundary_faces(model: &FeModel) -> Vec<BoundaryFace> {
    let mut open: HashMap<[u32; 4], (u32, usize)> = HashMap::new();
    for e in 0..model.element_count() {
        let nodes = model.element_nodes(e);
        for (f, face) in model.element_of(e).faces().iter().enumerate() {
            let corners = if face.len() % 3 == 0 { 3 } else { 4 };
            let mut key = [u32::MAX; 4];
            for (slot, &k) in key.iter_mut().zip(&face[..corners]) {
                *slot = nodes[k];
            }
            key.sort_unstable();
            if open.remove(&key).is_none() {
                open.insert(key, (e as u32, f));
            }
        }
    }
    let mut faces: Vec<(u32, usize)> = open.into_values().collect();
    faces.sort_unstable();
    faces
        .into_iter()
        .map(|(element, f)| {
            let nodes = model.element_nodes(element as usize);
            let face = model.element_of(element as usize).faces()[f];
            BoundaryFace {
                element,
                shape: match face.len() {
                    3 => FaceShape::Triangle3,
                    4 => FaceShape::Quad4,
                    6 => FaceShape::Triangle6,
                    _ => FaceShape::Quad8,
                },
                nodes: face.iter().map(|&k| nodes[k]).collect(),
            }
        })
        .collect()
}

/// A mesh beside the definition that it must fit.
struct Check<'a> {
    gear: &'a GearDefinition,
    body: &'a MeshedBody,
    curve: ProfileCurve,
    mesh: &'a MeshData,
}

impl Check<'_> {
    fn file(&self) -> String {
        self.body.file.display().to_string()
    }

    fn at_mm(&self, node: u32) -> [f64; 3] {
        self.mesh.points[node as usize].map(|v| v * 1e3)
    }

    fn tolerance_m(&self) -> f64 {
        TOLERANCE * self.gear.tooth.module_m
    }

    /// All elements hang together.
    fn parts(&self) -> Result<(), Box<ImportedMeshError>> {
        let mut parent: Vec<u32> = (0..self.mesh.points.len() as u32).collect();
        fn root(parent: &mut [u32], mut n: u32) -> u32 {
            while parent[n as usize] != n {
                parent[n as usize] = parent[parent[n as usize] as usize];
                n = parent[n as usize];
            }
            n
        }
        for (_, cell) in self.mesh.iter_cells() {
            let first = root(&mut parent, cell[0]);
            for &n in &cell[1..] {
                let other = root(&mut parent, n);
                parent[other as usize] = first;
            }
        }
        let mut sizes: BTreeMap<u32, usize> = BTreeMap::new();
        for n in 0..parent.len() as u32 {
            *sizes.entry(root(&mut parent, n)).or_default() += 1;
        }
        match sizes.iter().min_by_key(|(_, size)| **size) {
            Some((&node, &nodes)) if sizes.len() > 1 => Err(Box::new(ImportedMeshError::Parts {
                file: self.file(),
                parts: sizes.len(),
                nodes,
                at_mm: self.at_mm(node),
            })),
            _ => Ok(()),
        }
    }

    fn set(&self, name: &str) -> Option<&[u32]> {
        let set = self.mesh.point_sets.get(name).map(Vec::as_slice);
        set.filter(|nodes| !nodes.is_empty())
    }

    fn missing(&self, wanted: String, more: usize, use_of: &'static str) -> Box<ImportedMeshError> {
        const SHOWN: usize = 8;
        let names = &self.mesh.point_sets;
        let mut found: Vec<String> = names
            .keys()
            .take(SHOWN)
            .map(|n| format!("\"{n}\""))
            .collect();
        if names.len() > SHOWN {
            found.push(format!("and {} more", names.len() - SHOWN));
        }
        Box::new(ImportedMeshError::SetMissing {
            file: self.file(),
            wanted,
            more,
            use_of,
            found: found.join(", "),
        })
    }

    /// Nodes of the bore, all on its cylinder.
    fn bore(&self) -> Result<Vec<u32>, Box<ImportedMeshError>> {
        let name = &self.body.bore_set;
        let nodes = self
            .set(name)
            .ok_or_else(|| self.missing(name.clone(), 0, "where the gear is held"))?;
        let expected = self.gear.blank.bore_radius_m;
        let radius = |n: u32| {
            let [x, y, _] = self.mesh.points[n as usize];
            x.hypot(y)
        };
        let off = |n: &u32| (radius(*n) - expected).abs();
        let worst = nodes
            .iter()
            .copied()
            .max_by(|a, b| off(a).total_cmp(&off(b)));
        match worst {
            Some(node) if off(&node) > self.tolerance_m() => {
                Err(Box::new(ImportedMeshError::Bore {
                    file: self.file(),
                    set: name.clone(),
                    node,
                    at_mm: self.at_mm(node),
                    found_mm: radius(node) * 1e3,
                    expected_mm: expected * 1e3,
                    allowed_um: self.tolerance_m() * 1e6,
                }))
            }
            _ => Ok(nodes.to_vec()),
        }
    }

    /// Distance of a node from a flank's involute \[m\], positive into the tooth.
    fn off_flank_m(&self, node: u32, tooth: usize, side: FlankSide) -> f64 {
        let teeth = self.gear.tooth.teeth;
        let profile = &self.gear.profile;
        let point = in_tooth(self.mesh.points[node as usize], tooth, teeth, side);
        let radius = point[0].hypot(point[1]);
        let roll = (radius / profile.base_radius_m).powi(2) - 1.0;
        let roll = roll.max(0.0).sqrt();
        // Turned involutes are parallel: r_b times the angle apart. Beyond the flank's ends, how far beyond.
        let angle = point[1].atan2(point[0]) + profile.half_angle_rad(roll);
        let wrapped = (angle + PI).rem_euclid(TAU) - PI;
        let aside = wrapped * profile.base_radius_m;
        let ends = [profile.form_roll_rad, profile.flank_end_roll_rad]
            .map(|xi| profile.base_radius_m * (1.0 + xi * xi).sqrt());
        let beyond = (ends[0] - radius).max(radius - ends[1]).max(0.0);
        if beyond > aside.abs() { beyond } else { aside }
    }

    /// Names of the sets of the loaded flanks; all their nodes lie on them.
    fn flanks(&self) -> Result<Vec<(usize, FlankSide, String)>, Box<ImportedMeshError>> {
        let sides = &self.gear.reduction.flanks;
        let all: Vec<(usize, FlankSide, String)> = (0..self.gear.tooth.teeth)
            .flat_map(|tooth| sides.iter().map(move |&side| (tooth, side)))
            .map(|(tooth, side)| (tooth, side, self.body.flank_set(tooth, side)))
            .collect();
        let missing: Vec<&String> = all
            .iter()
            .map(|(_, _, name)| name)
            .filter(|name| self.set(name).is_none())
            .collect();
        if let Some(first) = missing.first() {
            let wanted = (*first).clone();
            return Err(self.missing(wanted, missing.len() - 1, "a loaded flank"));
        }
        for (tooth, side, name) in &all {
            let off = |n: &u32| self.off_flank_m(*n, *tooth, *side).abs();
            let nodes = self.set(name).unwrap_or(&[]).iter().copied();
            let worst = nodes.max_by(|a, b| off(a).total_cmp(&off(b)));
            if let Some(node) = worst.filter(|n| off(n) > self.tolerance_m()) {
                return Err(Box::new(ImportedMeshError::Flank {
                    file: self.file(),
                    set: name.clone(),
                    node,
                    at_mm: self.at_mm(node),
                    distance_um: off(&node) * 1e6,
                    side: side.name(),
                    tooth: *tooth,
                    allowed_um: self.tolerance_m() * 1e6,
                    hint: self.hint(name, *tooth, *side),
                }));
            }
        }
        Ok(all)
    }

    /// What a flank in the wrong place looks like: another unit, another phase, the mirror image.
    fn hint(&self, name: &str, tooth: usize, side: FlankSide) -> String {
        let nodes = self.set(name).unwrap_or(&[]);
        let mean = |f: &dyn Fn(u32) -> f64| {
            nodes.iter().map(|n| f(*n)).sum::<f64>() / nodes.len().max(1) as f64
        };
        let radius =
            mean(&|n| self.mesh.points[n as usize][0].hypot(self.mesh.points[n as usize][1]));
        let ratio = radius / self.gear.profile.reference_radius_m;
        if !(0.2..5.0).contains(&ratio) {
            return format!(
                "Its nodes have a mean radius of {:.4} mm, the reference circle {:.4} mm: check blank.length_unit",
                radius * 1e3,
                self.gear.profile.reference_radius_m * 1e3
            );
        }
        let fits = |other: FlankSide, at: usize| {
            nodes
                .iter()
                .all(|n| self.off_flank_m(*n, at, other).abs() <= self.tolerance_m())
        };
        let teeth = self.gear.tooth.teeth;
        if fits(side.opposite(), tooth) || fits(side.opposite(), (teeth - tooth) % teeth) {
            return format!(
                "It is where the {} flank lies: the mesh is a mirror image, or the sets are named from the other end",
                side.opposite().name()
            );
        }
        let aside = mean(&|n| self.off_flank_m(n, tooth, side));
        let spread = mean(&|n| (self.off_flank_m(n, tooth, side) - aside).abs());
        if spread < 0.1 * aside.abs() {
            let degrees = (aside / self.gear.profile.base_radius_m).to_degrees();
            return format!(
                "All of it is turned by {:.4} deg: tooth 0 must be centred on +x, teeth counted counter-clockwise seen from +z",
                side.mirror() * degrees
            );
        }
        "Check module, pressure angle, profile shift, thickness allowance and the diameters of [tooth]".into()
    }

    /// The finite element model; eight-node hexahedra take the formulation of the definition.
    fn model(&self) -> Result<FeModel, ReductionError> {
        let named = self.gear.mesh.element;
        let has = |kind| self.mesh.cells.contains_key(&kind);
        let fits = match named {
            ElementKind::Hex8 => has(CellKind::Hex8),
            ElementKind::Hex20 => has(CellKind::Hex20),
            ElementKind::Tet10 => has(CellKind::Tet10),
            // The default, which says nothing.
            ElementKind::Hex8Incompatible => true,
        };
        if !fits {
            let found: Vec<&str> = self.mesh.cells.keys().map(|kind| kind.name()).collect();
            return Err(ReductionError::Imported(Box::new(
                ImportedMeshError::Element {
                    file: self.file(),
                    element: crate::gear_body::element_of(named).name(),
                    found: found.join(" and "),
                },
            )));
        }
        let blocks = self.mesh.cells.iter().map(|(kind, nodes)| ElementBlock {
            element: match (kind, named) {
                (CellKind::Hex8, ElementKind::Hex8) => Element::Hex8,
                (CellKind::Hex8, _) => Element::Hex8Incompatible,
                (CellKind::Hex20, _) => Element::Hex20,
                (CellKind::Tet10, _) => Element::Tet10,
                (CellKind::Wedge6, _) => Element::Wedge6,
                (CellKind::Wedge15, _) => Element::Wedge15,
            },
            nodes: nodes.clone(),
        });
        let material = &self.gear.material;
        Ok(FeModel::from_blocks(
            self.mesh.points.clone(),
            blocks.collect(),
            Material::new(material.young_pa, material.poisson)?,
        )?)
    }

    /// Outline faces by tooth and side, and where their nodes lie.
    fn outlines(&self, model: &FeModel, faces: &[BoundaryFace]) -> Vec<[Vec<OutlineFace>; 2]> {
        let teeth = self.gear.tooth.teeth;
        let tolerance = self.tolerance_m();
        let inner = self.gear.profile.root_radius_m - tolerance;
        let mut outlines: Vec<[Vec<OutlineFace>; 2]> = vec![Default::default(); teeth];
        for face in faces {
            let corners: Vec<[f64; 3]> = face
                .nodes
                .iter()
                .map(|n| model.nodes()[*n as usize])
                .collect();
            if corners.iter().any(|x| x[0].hypot(x[1]) < inner) {
                continue;
            }
            let count = corners.len() as f64;
            let centre = std::array::from_fn(|k| corners.iter().map(|x| x[k]).sum::<f64>() / count);
            let tooth = nearest_tooth(centre, teeth);
            for side in [FlankSide::Right, FlankSide::Left] {
                // The centre says which half the face is in; a node on the border belongs to both.
                if in_tooth(centre, tooth, teeth, side)[1] > 0.0 {
                    continue;
                }
                let places: Option<Vec<[f64; 2]>> = corners
                    .iter()
                    .map(|x| {
                        let (arc, off) = self.curve.place_of(in_tooth(*x, tooth, teeth, side));
                        (off.abs() <= tolerance).then_some([arc, x[2]])
                    })
                    .collect();
                if let Some(places_m) = places {
                    outlines[tooth][side_index(side)].push(OutlineFace {
                        shape: face.shape,
                        nodes: face.nodes.clone(),
                        element: face.element,
                        places_m,
                    });
                }
            }
        }
        for faces in outlines.as_flattened_mut() {
            faces.sort_by(|a, b| a.range_m(0)[0].total_cmp(&b.range_m(0)[0]));
        }
        outlines
    }

    /// The faces found cover the flanks.
    fn coverage(
        &self,
        outlines: &[[Vec<OutlineFace>; 2]],
        flanks: &[(usize, FlankSide, String)],
    ) -> Result<(), Box<ImportedMeshError>> {
        let profile = &self.gear.profile;
        let half = 0.5 * self.gear.tooth.face_width_m;
        let arcs = [self.curve.flank_start_m(), self.curve.flank_end_m()];
        let whole = 2.0 * half * (arcs[1] - arcs[0]);
        for (tooth, side, name) in flanks {
            let faces = &outlines[*tooth][side_index(*side)];
            let covered: f64 = faces
                .iter()
                .flat_map(|face| crate::face_overlap::overlap_points(face, arcs, [-half, half]))
                .map(|point| point.area_m2)
                .sum();
            if covered < COVERAGE * whole {
                let radius = |xi: f64| profile.base_radius_m * (1.0 + xi * xi).sqrt() * 1e3;
                return Err(Box::new(ImportedMeshError::Coverage {
                    file: self.file(),
                    set: name.clone(),
                    covered_percent: 100.0 * covered / whole,
                    side: side.name(),
                    tooth: *tooth,
                    from_mm: radius(profile.form_roll_rad),
                    to_mm: radius(profile.flank_end_roll_rad),
                    width_mm: 2e3 * half,
                }));
            }
        }
        Ok(())
    }
}
