//! Blanks by axial contour: the plate as a special case, and the volume of cones.

use gearmesh_geometry::input::InputDocument;
use gearmesh_geometry::{GearDefinition, ProfileCurve};
use gearmesh_mesh::GearMesh;
use gearmesh_mesh::python::PythonEnvironment;
use std::f64::consts::PI;

const TEETH: &str = "name = \"small\"
[tooth]
teeth = 18
module_mm = 3.0
profile_shift = 0.1
face_width_mm = 12.0
[material]
young_GPa = 210.0
poisson = 0.3
";

fn gear(size: f64, blank: &str) -> GearDefinition {
    let mesh = format!(
        "[mesh]\nflank_mm = {}\nfillet_mm = {}\nbody_mm = {}\naxial_mm = 3.0\n",
        1.5 * size,
        0.6 * size,
        4.0 * size
    );
    let text = format!("{TEETH}{mesh}[blank]\n{blank}");
    GearDefinition::from_document(&InputDocument::new("small.toml", text)).unwrap()
}

fn mesh(gear: &GearDefinition) -> GearMesh {
    GearMesh::new(gear, &PythonEnvironment::find().unwrap()).unwrap()
}

const PLATE: &str = "kind = \"thin-rim\"
bore_diameter_mm = 14.0
hub_diameter_mm = 20.0
rim_inner_diameter_mm = 38.0
web_thickness_mm = 4.0
web_offset_mm = 1.0
";

/// Faces that do not vary: the same nodes and elements as those of a thin rim, and so the same gear.
#[test]
fn a_contour_of_planes_is_a_thin_rim() {
    let contour = "kind = \"contour\"
bore_diameter_mm = 14.0
hub_z_mm = [-6.0, 6.0]
web = [{ diameter_mm = 20.0, z_mm = [-1.0, 3.0] }, { diameter_mm = 38.0, z_mm = [-1.0, 3.0] }]
";
    let [plate, contour] = [PLATE, contour].map(|blank| mesh(&gear(1.0, blank)));
    assert_eq!(plate.elements, contour.elements);
    for (a, b) in plate.nodes.iter().zip(&contour.nodes) {
        assert!((0..3).all(|k| (a[k] - b[k]).abs() < 1e-16), "{a:?} {b:?}");
    }
}

/// Cones between circles: ∫ 2πr t dr with t linear in r, and hub faces beyond those of the rim. Chords for circles lose
/// volume with the square of the element length.
#[test]
fn volume_of_a_conical_web_and_a_stepped_hub() {
    let blank = "kind = \"contour\"
bore_diameter_mm = 14.0
hub_z_mm = [-8.0, 5.0]
web = [
  { diameter_mm = 20.0, z_mm = [-4.0, 1.0] },
  { diameter_mm = 28.0, z_mm = [-2.5, 1.5] },
  { diameter_mm = 38.0, z_mm = [-1.0, 2.0] },
]
";
    let error = |size: f64| {
        let gear = gear(size, blank);
        let mesh = mesh(&gear);
        let curve = ProfileCurve::new(&gear.profile);
        let n = 4000;
        let at = |k: i32| curve.point_at(curve.length_m() * f64::from(k) / f64::from(n));
        let half: f64 = (0..n)
            .map(|k| (at(k), at(k + 1)))
            .map(|(p, q)| 0.5 * (p[0] * q[1] - p[1] * q[0]))
            .sum();
        let cone = |r: [f64; 2], t: [f64; 2]| {
            let slope = (t[1] - t[0]) / (r[1] - r[0]);
            let constant = t[0] - slope * r[0];
            PI * constant * (r[1].powi(2) - r[0].powi(2))
                + 2.0 / 3.0 * PI * slope * (r[1].powi(3) - r[0].powi(3))
        };
        let exact = (2.0 * 18.0 * half - PI * 0.019_f64.powi(2)) * 0.012
            + cone([0.014, 0.019], [0.004, 0.003])
            + cone([0.010, 0.014], [0.005, 0.004])
            + PI * (0.010_f64.powi(2) - 0.007_f64.powi(2)) * 0.013;
        let mut volume = 0.0;
        for hex in mesh.elements.iter() {
            let x: Vec<[f64; 3]> = hex.iter().map(|n| mesh.nodes[*n as usize]).collect();
            // Lower and upper face may be bent: six tetrahedra about a diagonal.
            for [a, b, c, d] in [
                [0, 1, 2, 6],
                [0, 5, 1, 6],
                [0, 2, 3, 6],
                [0, 3, 7, 6],
                [0, 4, 5, 6],
                [0, 7, 4, 6],
            ] {
                let edge = |k: usize| -> [f64; 3] { std::array::from_fn(|i| x[k][i] - x[a][i]) };
                let (u, v, w) = (edge(b), edge(c), edge(d));
                volume += (u[0] * (v[1] * w[2] - v[2] * w[1]) - u[1] * (v[0] * w[2] - v[2] * w[0])
                    + u[2] * (v[0] * w[1] - v[1] * w[0]))
                    / 6.0;
            }
        }
        (volume / exact - 1.0).abs()
    };
    let [coarse, fine] = [1.0, 0.5].map(error);
    assert!(coarse < 0.01, "{coarse}");
    assert!(fine < 0.4 * coarse, "{coarse} {fine}");
}
