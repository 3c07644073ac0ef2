//! Meshes of helical gears: every section is the spur mesh turned, the volume stays, openings and bore stay straight.
//! And of gears of any numbers, spur and helical.

mod random_gears;

use gearmesh_geometry::input::InputDocument;
use gearmesh_geometry::{Flank, GearDefinition, ProfileCurve};
use gearmesh_mesh::GearMesh;
use gearmesh_mesh::python::PythonEnvironment;
use std::f64::consts::TAU;

const TEETH: &str = "
name = \"helical\"
[material]
young_GPa = 210.0
poisson = 0.3
[mesh]
flank_mm = 1.5
fillet_mm = 0.6
body_mm = 4.0
axial_mm = 2.5
[tooth]
teeth = 24
module_mm = 3.0
profile_shift = 0.1
face_width_mm = 20.0
";
const SOLID: &str = "[blank]\nkind = \"solid\"\nbore_diameter_mm = 24.0\n";
const DRILLED: &str = "[blank]
kind = \"solid\"
bore_diameter_mm = 14.0
[blank.holes]
count = 6
pitch_circle_diameter_mm = 34.0
diameter_mm = 9.0
phase_deg = 7.5
";

/// A gear, its helix signed: positive for a right hand.
fn mesh(helix_deg: f64, blank: &str) -> (GearDefinition, GearMesh) {
    let helix = if helix_deg == 0.0 {
        String::new()
    } else {
        let hand = if helix_deg > 0.0 { "right" } else { "left" };
        format!("helix_angle_deg = {}\nhand = \"{hand}\"\n", helix_deg.abs())
    };
    let text = format!("{TEETH}{helix}{blank}");
    let gear = GearDefinition::from_document(&InputDocument::new("g.toml", text)).unwrap();
    let mesh = GearMesh::new(&gear, &PythonEnvironment::find().unwrap()).unwrap();
    println!("{helix_deg} deg: {:?}", mesh.quality);
    (gear, mesh)
}

/// Volume of trilinear hexahedra, 3×3×3 Gauss: exact. No element may be folded anywhere.
fn volume(mesh: &GearMesh) -> f64 {
    let gauss = [
        (-(0.6f64.sqrt()), 5.0 / 9.0),
        (0.0, 8.0 / 9.0),
        (0.6f64.sqrt(), 5.0 / 9.0),
    ];
    let sign = [
        [-1.0, -1.0, -1.0],
        [1.0, -1.0, -1.0],
        [1.0, 1.0, -1.0],
        [-1.0, 1.0, -1.0],
        [-1.0, -1.0, 1.0],
        [1.0, -1.0, 1.0],
        [1.0, 1.0, 1.0],
        [-1.0, 1.0, 1.0],
    ];
    let mut sum = 0.0;
    for hex in mesh.elements.iter() {
        let p: Vec<[f64; 3]> = hex.iter().map(|&n| mesh.nodes[n as usize]).collect();
        for (x, wx) in gauss {
            for (y, wy) in gauss {
                for (z, wz) in gauss {
                    let mut j = [[0.0; 3]; 3];
                    for (p, s) in p.iter().zip(sign) {
                        let f = [1.0 + s[0] * x, 1.0 + s[1] * y, 1.0 + s[2] * z];
                        let d = [s[0] * f[1] * f[2], s[1] * f[0] * f[2], s[2] * f[0] * f[1]];
                        for a in 0..3 {
                            for b in 0..3 {
                                j[a][b] += 0.125 * d[a] * p[b];
                            }
                        }
                    }
                    let det = j[0][0] * (j[1][1] * j[2][2] - j[1][2] * j[2][1])
                        - j[0][1] * (j[1][0] * j[2][2] - j[1][2] * j[2][0])
                        + j[0][2] * (j[1][0] * j[2][1] - j[1][1] * j[2][0]);
                    assert!(det > 0.0, "a folded element: {p:?}");
                    sum += wx * wy * wz * det;
                }
            }
        }
    }
    sum
}

fn section_area(mesh: &GearMesh) -> f64 {
    let p = |n: usize| mesh.section.nodes[n];
    mesh.section
        .quads
        .iter()
        .map(|q| {
            let [a, b, c, d] = q.map(p);
            0.5 * ((c[0] - a[0]) * (d[1] - b[1]) - (d[0] - b[0]) * (c[1] - a[1]))
        })
        .sum()
}

/// Sections turn without change of area; between two planes a node runs along a chord, so that the section in between
/// is the turned one made smaller: by |1 − t + t e^{iΔ}|² = 1 − 2t(1 − t)(1 − cos Δ), in the mean by (1 − cos Δ)/3.
#[test]
fn the_volume_is_that_of_the_spur_mesh_but_for_the_chords() {
    for helix_deg in [25.0, -25.0] {
        let (gear, mesh) = mesh(helix_deg, SOLID);
        let prism = section_area(&mesh) * gear.tooth.face_width_m;
        let layer = mesh.layers.planes_m[1] - mesh.layers.planes_m[0];
        let turn = gear.profile.twist_rad_per_m() * layer;
        let expected = 1.0 - (1.0 - turn.cos()) / 3.0;
        assert!((volume(&mesh) / prism - expected).abs() < 1e-12);
        assert!(1.0 - expected < 4e-4, "the chords are a small error");
        assert!(mesh.quality.smallest > 0.25);
    }
}

#[test]
fn flanks_are_helicoids_and_hands_are_mirror_images() {
    let (gear, right) = mesh(20.0, SOLID);
    let (_, left) = mesh(-20.0, SOLID);
    let curve = ProfileCurve::new(&gear.profile);
    for (mesh, hand) in [(&right, 1.0), (&left, -1.0)] {
        for tooth in [0, 5] {
            for face in mesh.outline_faces(tooth, Flank::Right, [0.0, curve.length_m()]) {
                for (&node, &[arc, z]) in face.nodes.iter().zip(&face.places_m) {
                    if arc > curve.length_m() {
                        continue;
                    }
                    let [x, y] = curve.point_at(arc);
                    let angle = TAU * tooth as f64 / 24.0
                        + hand * z * gear.tooth.helix_angle_rad.tan()
                            / gear.profile.reference_radius_m;
                    let p = mesh.nodes[node as usize];
                    let (s, c) = angle.sin_cos();
                    let off = (p[0] - c * x + s * y).hypot(p[1] - s * x - c * y);
                    assert!(off < 1e-9 && p[2] == z, "{off}");
                }
            }
        }
    }
    // The section is symmetric about x, but its mesh need not be: turn over the axis instead, z to −z.
    for (n, p) in right.section.nodes.iter().enumerate() {
        for (plane, z) in right.layers.planes_m.iter().enumerate() {
            let angle = right.twist.angle_rad(p[0].hypot(p[1]), *z);
            assert_eq!(angle, -left.twist.angle_rad(p[0].hypot(p[1]), *z));
            let at = |m: &GearMesh, plane| m.nodes[m.node(n, plane).unwrap() as usize];
            let last = right.layers.planes_m.len() - 1;
            let (a, b) = (at(&right, plane), at(&left, last - plane));
            assert!((a[0] - b[0]).hypot(a[1] - b[1]) < 1e-12 && (a[2] + b[2]).abs() < 1e-12);
        }
    }
}

#[test]
fn holes_stay_straight_and_sectors_repeat() {
    let (gear, mesh) = mesh(12.0, DRILLED);
    let [inner, _] = mesh.twist.fade_m.unwrap();
    assert_eq!(gear.sectors(), 6);
    let planes = &mesh.layers.planes_m;
    for (n, p) in mesh.section.nodes.iter().enumerate() {
        for (plane, &z) in planes.iter().enumerate() {
            let q = mesh.nodes[mesh.node(n, plane).unwrap() as usize];
            if p[0].hypot(p[1]) <= inner {
                assert!(q[0] == p[0] && q[1] == p[1] && q[2] == z);
            }
            // The turn depends on the radius only: a sector turned by 60 degrees is the next one.
            assert!((q[0].hypot(q[1]) - p[0].hypot(p[1])).abs() < 1e-15);
        }
    }
    // Faded elements bulge a little; the body's volume is still that of the prism.
    let prism = section_area(&mesh) * gear.tooth.face_width_m;
    assert!((volume(&mesh) / prism - 1.0).abs() < 1e-3);
    assert!(mesh.quality.smallest > 0.2);
}
