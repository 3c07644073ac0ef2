//! Pinions cut into their shafts, at three proportions of shaft and root, and finite element models of them with their
//! shafts.

use gearmesh_fe::FeModel;
use gearmesh_geometry::GearDefinition;
use gearmesh_geometry::input::InputDocument;
use gearmesh_reduction::GearBody;

/// A pinion 30 mm wide between stubs of its shaft.
pub struct Case {
    pub teeth: usize,
    pub module_mm: f64,
    /// Diameters on back and front face.
    pub shaft_mm: [f64; 2],
    /// Lengths of the stubs there.
    pub stub_m: [f64; 2],
}

/// Half of the root diameter, seven tenths and nine tenths of it.
pub const CASES: [Case; 3] = [
    Case {
        teeth: 17,
        module_mm: 3.0,
        shaft_mm: [22.0, 24.0],
        stub_m: [40e-3, 50e-3],
    },
    Case {
        teeth: 17,
        module_mm: 3.0,
        shaft_mm: [32.0, 30.0],
        stub_m: [40e-3, 50e-3],
    },
    Case {
        teeth: 34,
        module_mm: 2.0,
        shaft_mm: [57.0, 54.0],
        stub_m: [80e-3, 100e-3],
    },
];
pub const WIDTH_M: f64 = 30e-3;

impl Case {
    /// With elements of these lengths on flank and fillet, in the body, along the axis; `more` tables behind.
    pub fn gear(&self, [flank, fillet, body, axial]: [f64; 4], more: &str) -> GearDefinition {
        let Self {
            teeth,
            module_mm,
            shaft_mm,
            ..
        } = self;
        let text = format!(
            "name = \"pinion\"\n[tooth]\nteeth = {teeth}\nmodule_mm = {module_mm}\nprofile_shift = 0.2\nface_width_mm = 30.0\n[material]\nyoung_GPa = 210.0\n\
             poisson = 0.3\ndensity_kg_per_m3 = 7850.0\n[reduction]\nroll_stations = 3\nslices = 2\nflanks = [\"right\"]\n[mesh]\n\
             flank_mm = {flank}\nfillet_mm = {fillet}\nbody_mm = {body}\naxial_mm = {axial}\n[blank]\nkind = \"solid\"\nbore_diameter_mm = 0\n\
             shaft_diameter_mm = {shaft_mm:?}\n{more}"
        );
        GearDefinition::from_document(&InputDocument::new("pinion.toml", text)).unwrap()
    }

    pub fn radius_m(&self, face: usize) -> f64 {
        0.5e-3 * self.shaft_mm[face]
    }
}

/// The pinion's model with its meshed stubs of shaft lengthened on back (0) and front (1), and the nodes at their far
/// ends.
pub fn with_stubs(case: &Case, body: &GearBody) -> (FeModel, [Vec<usize>; 2]) {
    let mesh = &body.mesh;
    let section = &mesh.section;
    let mut nodes = mesh.nodes.clone();
    let mut connectivity = mesh.elements.connectivity().to_vec();
    let planes = mesh.layers.planes_m.len();
    let ends = [0, 1].map(|side| {
        let radius = case.radius_m(side) * (1.0 + 1e-6);
        let inside = |n: usize| section.nodes[n][0].hypot(section.nodes[n][1]) <= radius;
        let quads: Vec<[usize; 4]> = (section.quads.iter().copied())
            .filter(|quad| quad.iter().all(|&n| inside(n)))
            .collect();
        let sign = [-1.0, 1.0][side];
        let face = [0, planes - 1][side];
        let from = mesh.layers.planes_m[face];
        let count = 12;
        let mut last: Vec<Option<u32>> = (0..section.nodes.len())
            .map(|n| mesh.node(n, face))
            .collect();
        for layer in 1..=count {
            let share = f64::from(layer) / f64::from(count);
            let z = from + share * (sign * (0.5 * WIDTH_M + case.stub_m[side]) - from);
            let mut next = vec![None; last.len()];
            for &n in quads.iter().flatten() {
                if next[n].is_none() {
                    next[n] = Some(nodes.len() as u32);
                    let [x, y] = section.nodes[n];
                    nodes.push([x, y, z]);
                }
            }
            for quad in &quads {
                let (low, high) = if side == 1 {
                    (&last, &next)
                } else {
                    (&next, &last)
                };
                connectivity.extend(quad.iter().map(|&n| low[n].unwrap()));
                connectivity.extend(quad.iter().map(|&n| high[n].unwrap()));
            }
            last = next;
        }
        last.into_iter().flatten().map(|n| n as usize).collect()
    });
    let (material, element) = (*body.model.material(), body.model.element_of(0));
    (
        FeModel::from_connectivity(nodes, connectivity, material, element).unwrap(),
        ends,
    )
}
