//! Meshes of the shipped bevel pairs.

use gearmesh_bevel::BevelGear;
use gearmesh_geometry::Flank;
use gearmesh_geometry::input::InputDocument;
use gearmesh_mesh::bevel_level::Levels;
use gearmesh_mesh::{BevelMesh, BodyGrid};
use std::collections::BTreeSet;
use std::f64::consts::TAU;
use std::path::Path;

fn gear(pair: &str, member: &str, bore_mm: f64, more: &str) -> BevelGear {
    let text = format!(
        "name = \"made up\"\n[bevel_gear]\npair = \"{pair}\"\nmember = \"{member}\"\n[blank]\nbore_diameter_mm = {bore_mm}\nBLANK\n[material]\n\
         young_GPa = 206.0\npoisson = 0.3\ndensity_kg_per_m3 = 7850.0\nTABLES\n"
    );
    let (blank, tables) = if more.starts_with('[') {
        ("", more)
    } else {
        (more, "")
    };
    let text = text.replace("BLANK", blank).replace("TABLES", tables);
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fe_models");
    BevelGear::from_document(&InputDocument::new("made up", text), &folder).unwrap()
}

/// Webs with steep walls.
const STEEP_13: &str = "rim_mm = 4.0\nhub_z_mm = [72.0, 104.0]\nweb = [{ diameter_mm = 14.0, z_mm = [72.0, 104.0] }, { diameter_mm = 15.0, z_mm = [84.0, 92.0] }, { diameter_mm = 25.0, z_mm = [84.0, 92.0] }]";
const STEEP_20: &str = "rim_mm = 3.0\nhub_z_mm = [26.0, 42.0]\nweb = [{ diameter_mm = 26.0, z_mm = [26.0, 42.0] }, { diameter_mm = 27.0, z_mm = [31.0, 36.0] }, { diameter_mm = 39.0, z_mm = [31.0, 36.0] }]";

/// Members of the shipped pairs with default lengths, and the pinion of 13 teeth in quadratic elements.
#[test]
fn shipped_pairs_are_meshed() {
    let quadratic = "[mesh]\nelement = \"hex20\"\nalong_mm = 6.0\n[reduction]\nslices = 5\n";
    for (pair, member, bore, more) in [
        ("bevel_20_20.toml", "gear", 20.0, ""),
        ("bevel_20_20.toml", "pinion", 20.0, ""),
        ("bevel_13_35.toml", "pinion", 8.0, ""),
        ("bevel_13_35.toml", "pinion", 8.0, quadratic),
        ("bevel_13_35.toml", "gear", 30.0, ""),
        ("bevel_31_36.toml", "pinion", 30.0, ""),
        ("bevel_31_36.toml", "gear", 30.0, ""),
    ] {
        let gear = gear(pair, member, bore, more);
        let mesh = BevelMesh::new(&gear).unwrap();
        assert!(mesh.quality.smallest > 0.2 && mesh.quality.mean > 0.6);
        // Every node belongs to an element, and all flank nodes lie on the flanks.
        let mut used = vec![false; mesh.nodes.len()];
        mesh.elements
            .connectivity()
            .iter()
            .for_each(|n| used[*n as usize] = true);
        assert!(used.into_iter().all(|used| used));
        for side in [Flank::Right, Flank::Left] {
            let patch = gear.patch(side).unwrap();
            let blank = gear.blank();
            let mut on_flank = 0;
            for node in mesh.flank_nodes(0, side) {
                let [x, y, z] = mesh.nodes[node as usize];
                let [cone, height] = blank.cone_place(z, x.hypot(y));
                let s = (cone - patch.cones_m[0]) / blank.face_width_m;
                let [low, high] = [0.0, 1.0].map(|v| patch.place_m([s, v])[1]);
                let v = (height - low) / (high - low);
                if v > 0.15 {
                    on_flank += 1;
                    let angle = y.atan2(x) - patch.azimuth_rad([s, v]);
                    assert!((angle * x.hypot(y)).abs() < 2e-9, "{angle:e}");
                }
            }
            assert!(on_flank > 50);
        }
    }
}

/// Sectors fit: the left side of each is the right side of the next, turned, and nodes are nowhere doubled.
#[test]
fn cuts_match_under_rotation() {
    for more in ["", STEEP_13] {
        sectors_fit(&BevelMesh::new(&gear("bevel_13_35.toml", "pinion", 8.0, more)).unwrap());
    }
}

fn sectors_fit(mesh: &BevelMesh) {
    let step = TAU / mesh.teeth() as f64;
    for (a, b) in [
        (mesh.cut_nodes(0), mesh.cut_nodes(1)),
        (mesh.cell_nodes(2), mesh.cell_nodes(3)),
        (mesh.body_nodes(12), mesh.body_nodes(0)),
    ] {
        assert_eq!(a.len(), b.len());
        for (a, b) in a.iter().zip(&b) {
            let [p, q] = [a, b].map(|n| mesh.nodes[*n as usize]);
            let (sin, cos) = step.sin_cos();
            let turned = [cos * p[0] - sin * p[1], sin * p[0] + cos * p[1], p[2]];
            assert!((0..3).all(|k| (turned[k] - q[k]).abs() < 1e-12));
        }
    }
    // Next to each other: the cell of a tooth and that of the next one share the cut's nodes.
    let own: BTreeSet<u32> = mesh.cell_nodes(0).into_iter().collect();
    let next: BTreeSet<u32> = mesh.cell_nodes(1).into_iter().collect();
    let shared: BTreeSet<u32> = own.intersection(&next).copied().collect();
    let cut: BTreeSet<u32> = mesh.cut_nodes(1).into_iter().collect();
    assert!(!shared.is_empty() && shared.is_subset(&cut));
    let places: BTreeSet<[i64; 3]> = mesh
        .nodes
        .iter()
        .map(|p| p.map(|x| (x * 1e9).round() as i64))
        .collect();
    assert_eq!(places.len(), mesh.nodes.len());
}

/// A web between rim and hub; a mesh poorer than demanded is refused with the place.
#[test]
fn webs_are_meshed_and_poor_meshes_refused() {
    let web = "hub_z_mm = [24.0, 42.0]\nweb = [{ diameter_mm = 28.0, z_mm = [30.0, 37.0] }, { diameter_mm = 33.0, z_mm = [30.0, 37.0] }]";
    let with_web = gear("bevel_20_20.toml", "gear", 20.0, web);
    let solid = gear("bevel_20_20.toml", "gear", 20.0, "");
    assert!(BevelMesh::new(&with_web).unwrap().quality.smallest > 0.2);
    assert_eq!(
        (with_web.body.contour.len(), solid.body.contour.len()),
        (3, 1)
    );
    let mut demanding = solid;
    demanding.mesh.min_scaled_jacobian = 0.8;
    let message = BevelMesh::new(&demanding).unwrap_err().to_string();
    assert!(
        message.contains("scaled Jacobian") && message.contains("min_scaled_jacobian"),
        "{message}"
    );
}

/// Elements between neighbouring teeth, by the signed volumes of their corners' tetrahedra.
fn volume(mesh: &BevelMesh) -> f64 {
    // The faces of a brick from outside, by their corners.
    let faces = [
        [0, 3, 2, 1],
        [4, 5, 6, 7],
        [0, 1, 5, 4],
        [1, 2, 6, 5],
        [2, 3, 7, 6],
        [3, 0, 4, 7],
    ];
    let mut six = 0.0;
    for element in mesh.elements.iter() {
        for face in faces {
            let at = face.map(|k| nalgebra::Vector3::from(mesh.nodes[element[k] as usize]));
            // Both ways of cutting it, in the mean.
            for [a, b, c] in [[0, 1, 2], [0, 2, 3], [0, 1, 3], [1, 2, 3]] {
                six += 0.5 * at[a].dot(&at[b].cross(&at[c]));
            }
        }
    }
    six / 6.0
}

/// Webs with steep walls: rows would be too poor, the meridian is meshed freely instead. The teeth stay as they are,
/// the volume is the same, the bore is round.
#[test]
fn steep_webs_are_meshed_freely() {
    for (pair, member, bore, web) in [
        ("bevel_20_20.toml", "gear", 20.0, STEEP_20),
        ("bevel_13_35.toml", "pinion", 8.0, STEEP_13),
    ] {
        let gear = gear(pair, member, bore, web);
        let rows = BevelMesh::of_grid(&gear, BodyGrid::Rows).unwrap();
        assert!(rows.quality.smallest < 0.2, "{}", rows.quality.smallest);
        let free = BevelMesh::new(&gear).unwrap();
        assert_eq!(free.body_grid(), BodyGrid::Free);
        assert!(free.quality.smallest > 0.2 && free.quality.mean > 0.6);
        // No element of the body is the worst.
        let [_, height] = {
            let [x, y, z] = free.quality.worst_m;
            gear.blank().cone_place(z, x.hypot(y))
        };
        assert!(height > -gear.blank().outer_dedendum_m - gear.mean_module_m());
        let ratio = volume(&free) / volume(&rows);
        assert!((ratio - 1.0).abs() < 2e-4, "{ratio}");
        for node in free.bore() {
            let [x, y, _] = free.nodes[node as usize];
            assert!((x.hypot(y) - 0.5e-3 * bore).abs() < 1e-12);
        }
        // Quadratic elements have the same corners.
        let mut quadratic = gear.clone();
        quadratic.mesh.element = gearmesh_geometry::Element::Hex20;
        quadratic.mesh.axial_m *= 2.0;
        let mesh = BevelMesh::of_grid(&quadratic, BodyGrid::Free).unwrap();
        assert!(mesh.quality.smallest > 0.2, "{}", mesh.quality.smallest);
    }
}

/// Lines that cross are refused with the place, not handed to gmsh.
#[test]
fn crossed_lines_are_refused() {
    let web = "rim_mm = 3.0\nhub_z_mm = [24.0, 42.0]\nweb = [{ diameter_mm = 36.0, z_mm = [20.0, 24.0] }]";
    let gear = gear("bevel_20_20.toml", "gear", 20.0, web);
    let message = BevelMesh::of_grid(&gear, BodyGrid::Free)
        .unwrap_err()
        .to_string();
    assert!(
        message.contains("cross at diameter") && message.contains("hub_z_mm"),
        "{message}"
    );
}

#[test]
#[ignore = "writes the points that tools/reference/bevel_tooth.py reads; needed once"]
fn write_tooth_surface() {
    let gear = gear("bevel_20_20.toml", "gear", 34.0, "");
    let levels = Levels::new(&gear, 1).unwrap().with_pieces([8, 40]);
    let patches = [Flank::Right, Flank::Left].map(|side| gear.patch(side).unwrap());
    let mut text = String::from(
        "# Points of the tooth of the gear of fe_models/bevel_20_20.toml, from the middle of the space to the tip, by sections from toe to heel; u: share of the way up the flank\nsection,side,s,u,x_m,y_m,z_m\n",
    );
    for section in 0..=24 {
        let s = f64::from(section) / 24.0;
        let level = levels.level(s).unwrap();
        for (side, patch) in patches.iter().enumerate() {
            for (place, point) in level.outline_m[side]
                .iter()
                .zip(&level.outline_points_m[side])
            {
                let [low, high] = [0.0, 1.0].map(|v| patch.place_m([s, v])[1]);
                let u = (place[1] - low) / (high - low);
                let [x, y, z] = point;
                text.push_str(&format!(
                    "{section},{side},{s},{u:.9},{x:.9},{y:.9},{z:.9}\n"
                ));
            }
        }
    }
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../reference/bevel_tooth");
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::write(folder.join("surface.csv"), text).unwrap();
}
