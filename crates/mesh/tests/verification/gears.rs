//! Meshes of the gears of pairs A and B (seed 004 in docs/sources.md) and of a drilled one: counts, sets, volume and
//! quality.

use gearmesh_geometry::input::InputDocument;
use gearmesh_geometry::{Flank, GearDefinition, ProfileCurve};
use gearmesh_mesh::GearMesh;
use gearmesh_mesh::python::PythonEnvironment;
use std::f64::consts::{PI, TAU};
use std::path::Path;

fn source(name: &str) -> String {
    std::fs::read_to_string(
        Path::new(env!("CARGO_MANIFEST_DIR"))
            .join("../../fe_models")
            .join(name),
    )
    .unwrap()
}

fn mesh(text: &str) -> (GearDefinition, GearMesh) {
    mesh_of(text, "body_mm = 2.6\n")
}

fn mesh_of(text: &str, further: &str) -> (GearDefinition, GearMesh) {
    let coarse =
        format!("{text}\n[mesh]\nflank_mm = 1.2\nfillet_mm = 0.5\naxial_mm = 4.0\n{further}");
    let gear = GearDefinition::from_document(&InputDocument::new("gear.toml", coarse)).unwrap();
    let mesh = GearMesh::new(&gear, &PythonEnvironment::find().unwrap()).unwrap();
    (gear, mesh)
}

fn volume(mesh: &GearMesh) -> f64 {
    // Prisms on plane quads: exact.
    let mut sum = 0.0;
    for hex in mesh.elements.iter() {
        let p: Vec<[f64; 3]> = hex.iter().map(|&n| mesh.nodes[n as usize]).collect();
        let area = 0.5
            * ((p[2][0] - p[0][0]) * (p[3][1] - p[1][1])
                - (p[3][0] - p[1][0]) * (p[2][1] - p[0][1]));
        sum += area * (p[4][2] - p[0][2]);
    }
    sum
}

/// Area of the teeth and the ring above `radius`, by the outline's polygon.
fn outline_area(gear: &GearDefinition) -> f64 {
    let curve = ProfileCurve::new(&gear.profile);
    let n = 4000;
    let mut half = 0.0;
    for k in 0..n {
        let p = curve.point_at(curve.length_m() * f64::from(k) / f64::from(n));
        let q = curve.point_at(curve.length_m() * f64::from(k + 1) / f64::from(n));
        half += 0.5 * (p[0] * q[1] - p[1] * q[0]);
    }
    2.0 * half * gear.tooth.teeth as f64
}

fn check(text: &str, volume_m3: impl Fn(&GearDefinition) -> f64) {
    let (gear, mesh) = mesh(text);
    println!(
        "{}: {} nodes, {} elements, quality {:?}",
        gear.name,
        mesh.nodes.len(),
        mesh.elements.len(),
        mesh.quality
    );
    let expected = volume_m3(&gear);
    let found = volume(&mesh);
    assert!(
        (found / expected - 1.0).abs() < 0.006,
        "volume {found} against {expected}: chords of a coarse mesh"
    );
    assert!(mesh.quality.smallest > 0.2);
    // Every node is used, every interior face is shared by exactly two elements.
    let mut used = vec![false; mesh.nodes.len()];
    mesh.elements
        .connectivity()
        .iter()
        .for_each(|&n| used[n as usize] = true);
    assert!(used.iter().all(|u| *u));
    // No two nodes at the same place: sectors are joined, not only side by side.
    let mut keys: Vec<[i64; 3]> = mesh
        .nodes
        .iter()
        .map(|p| p.map(|v| (v * 1e9).round() as i64))
        .collect();
    keys.sort_unstable();
    assert!(keys.windows(2).all(|w| w[0] != w[1]));
    let bore = mesh.bore();
    assert!(bore.iter().all(|&n| {
        let p = mesh.nodes[n as usize];
        (p[0].hypot(p[1]) - gear.blank.bore_radius_m()).abs() < 1e-12
    }));
    // Flank nodes lie on the involute; supports of the submodel are disjoint from the loaded flank.
    let sets = mesh.node_sets(&gear);
    for tooth in [0, gear.tooth.teeth - 1] {
        for side in [Flank::Right, Flank::Left] {
            let centre = TAU * tooth as f64 / gear.tooth.teeth as f64;
            let flank = &sets[&format!("tooth{tooth}_{}_flank", side.name())];
            assert!(flank.len() >= 4 * mesh.layers.planes_m.len());
            for &n in flank {
                let [x, y, _] = mesh.nodes[n as usize];
                let (r, polar) = (x.hypot(y), y.atan2(x) - centre);
                let roll =
                    gearmesh_geometry::involute::roll_angle_rad(r, gear.profile.base_radius_m);
                let half = gear.profile.half_angle_rad(roll);
                let wrapped = (polar + PI).rem_euclid(TAU) - PI;
                assert!(
                    (wrapped + side.mirror() * half).abs() < 1e-12,
                    "{wrapped} {half}"
                );
            }
            let supports = mesh.tooth_supports(tooth, side);
            assert!(flank.iter().all(|n| !supports.contains(n)));
            let opposite = &sets[&format!("tooth{tooth}_{}_flank", side.opposite().name())];
            assert!(opposite.iter().all(|n| supports.contains(n)));
            assert!(!mesh.tooth_elements(tooth).is_empty());
        }
    }
    let total: f64 = mesh
        .outline_faces(1, Flank::Left, [0.0, f64::INFINITY])
        .iter()
        .filter(|f| f.range_m(1)[0] == mesh.layers.planes_m[0])
        .map(|f| f.range_m(0)[1] - f.range_m(0)[0])
        .sum();
    assert!((total - 2.0 * ProfileCurve::new(&gear.profile).length_m()).abs() < 1e-12);
}

#[test]
fn solid_gear() {
    check(&source("gear1.toml"), |g| {
        (outline_area(g) - PI * g.blank.bore_radius_m().powi(2)) * g.tooth.face_width_m
    });
}

fn thin_rim_volume(g: &GearDefinition) -> f64 {
    let web = g.blank.web().unwrap();
    let annulus = |a: f64, b: f64| PI * (b * b - a * a);
    (outline_area(g) - PI * web.rim_inner_radius_m.powi(2)) * g.tooth.face_width_m
        + annulus(web.hub_radius_m, web.rim_inner_radius_m) * web.thickness_m
        + annulus(g.blank.bore_radius_m(), web.hub_radius_m) * g.tooth.face_width_m
}

#[test]
fn thin_rim() {
    check(&source("gear2.toml"), thin_rim_volume);
}

#[test]
fn thin_rim_with_offset_web_and_chamfer() {
    let text = source("gear2.toml")
        .replace(
            "web_thickness_mm = 5.0",
            "web_thickness_mm = 5.0\nweb_offset_mm = 4.0",
        )
        .replace(
            "face_width_mm = 23.0",
            "face_width_mm = 23.0\ntip_chamfer_mm = 0.2",
        );
    check(&text, thin_rim_volume);
}

#[test]
fn three_slots() {
    check(&source("gear3.toml"), |g| {
        let web = g.blank.web().unwrap();
        // Corners: each of the four takes (1 − π/4) c² from the slot.
        let slot = 0.5 * 80f64.to_radians() * (0.060f64.powi(2) - 0.042f64.powi(2))
            - (4.0 - PI) * 0.003f64.powi(2);
        thin_rim_volume(g) - 3.0 * slot * web.thickness_m
    });
}

/// Corners of 0.3 mm cost a sixth of nodes more than corners of 3 mm: elements grow along the slot's edges with the
/// distance from them.
#[test]
fn small_corners_of_slots_are_graded() {
    let large = source("gear3.toml");
    let small = large.replace("corner_radius_mm = 3.0", "corner_radius_mm = 0.3");
    assert_ne!(large, small);
    check(&small, |g| {
        let web = g.blank.web().unwrap();
        let slot = 0.5 * 80f64.to_radians() * (0.060f64.powi(2) - 0.042f64.powi(2))
            - (4.0 - PI) * 0.0003f64.powi(2);
        thin_rim_volume(g) - 3.0 * slot * web.thickness_m
    });
    let nodes = [&large, &small].map(|text| mesh(text).1.nodes.len());
    assert!(nodes[1] < nodes[0] * 5 / 4, "{nodes:?}");
}

#[test]
fn slots_that_do_not_divide_the_teeth_and_drilled_holes() {
    let two = source("gear3.toml").replace("count = 3", "count = 2");
    check(&two, |g| {
        let slot = 0.5 * 80f64.to_radians() * (0.060f64.powi(2) - 0.042f64.powi(2))
            - (4.0 - PI) * 0.003f64.powi(2);
        thin_rim_volume(g) - 2.0 * slot * 0.005
    });
    let drilled = source("gear2.toml").replace(
        "web_thickness_mm = 5.0",
        "web_thickness_mm = 5.0\nholes = { count = 19, pitch_circle_diameter_mm = 104.0, diameter_mm = 10.0, phase_deg = 3.0 }",
    );
    check(&drilled, |g| {
        thin_rim_volume(g) - 19.0 * PI * 0.005f64.powi(2) * 0.005
    });
}

/// The sector of one tooth narrows to less than an element at the bore. With elements as long as elsewhere these
/// wheels had a corner with a scaled Jacobian of 0.196 and 0.180, and were refused.
#[test]
fn sectors_that_become_narrow_towards_the_bore_are_meshed() {
    for teeth in [71, 75] {
        let text = source("train_71.toml").replace("teeth = 71", &format!("teeth = {teeth}"));
        let text = format!("{text}[mesh]\naxial_mm = 12.5\n");
        let gear = GearDefinition::from_document(&InputDocument::new("gear.toml", text)).unwrap();
        assert_eq!(
            (gear.mesh.min_scaled_jacobian, gear.sectors()),
            (0.2, teeth)
        );
        let mesh = GearMesh::new(&gear, &PythonEnvironment::find().unwrap()).unwrap();
        println!("{teeth} teeth: {:?}", mesh.quality);
        assert!(mesh.quality.smallest > 0.2);
    }
}

/// The estimate made before meshing: how far off it is. Blocks of teeth are counted, the free mesh of the body is
/// guessed.
#[test]
fn the_size_of_a_mesh_is_known_before_it_is_made() {
    let holes = "[blank.holes]\ncount = 6\npitch_circle_diameter_mm = 88.0\ndiameter_mm = 20.0\n";
    let drilled = source("wheel_47_drilled.toml");
    for (name, text) in [
        ("solid", source("gear1.toml")),
        ("thin rim", source("gear2.toml")),
        ("slots", source("gear3.toml")),
        ("helical", source("gearbox_67.toml")),
        (
            "six holes",
            drilled.split("[mesh]").next().unwrap().to_owned(),
        ),
        ("quadratic", source("gear2.toml") + "#hex20"),
    ] {
        assert!(name != "six holes" || text.contains(&holes[..21]));
        let element = if text.ends_with("#hex20") {
            "element = \"hex20\"\n"
        } else {
            ""
        };
        let (gear, mesh) = mesh_of(&text, &format!("{element}body_mm = 6.0\n"));
        let size = gearmesh_mesh::MeshSize::estimate(&gear).unwrap();
        let off = |found: f64, true_one: usize| found / true_one as f64 - 1.0;
        let mut sector: std::collections::BTreeSet<u32> = mesh
            .body_elements(0)
            .iter()
            .flat_map(|&e| mesh.elements.nodes(e).to_vec())
            .collect();
        // Nodes of the other cut are the next sector's.
        if gear.sectors() > 1 {
            let cut = mesh.cut_nodes(0);
            sector.retain(|node| !cut.contains(node));
        }
        let of_sector = size.body_nodes + size.circle_nodes / gear.sectors() as f64;
        let all = [
            ("nodes", off(size.nodes, mesh.nodes.len())),
            ("elements", off(size.elements, mesh.elements.len())),
            ("tooth", off(size.tooth_nodes, mesh.cell_nodes(0).len())),
            (
                "cut",
                if gear.sectors() == 1 {
                    0.0
                } else {
                    off(size.cut_nodes, mesh.cut_nodes(0).len())
                },
            ),
            ("body", off(of_sector, sector.len())),
        ];
        println!("{name}: {all:.3?} of {}", mesh.nodes.len());
        // Blocks are counted (quadratic ones by the nodes a corner has in the mean). The free mesh of the body leaves
        // open half of its sector (50.2 % too few between slots, on a sector of few elements) and a fifth of the gear:
        // a third of the memory, by the power of 4/3. Below the ring the cells of teeth that do not repeat with the
        // holes are a free mesh, a seventh of their nodes, of which half may be missing as in the body.
        let tooth = match name {
            "quadratic" => 0.06,
            "six holes" => 0.5 / 7.0,
            _ => 1e-9,
        };
        for ((what, off), within) in all.into_iter().zip([0.2, 0.25, tooth, 0.35, 0.55]) {
            assert!(off.abs() < within, "{name}, {what}: {off}");
        }
    }
}

/// Holes so near to the rim that the teeth are condensed down to the rim's own circle: nothing lies between the two.
#[test]
fn the_size_is_known_where_the_teeth_end_at_the_rim() {
    let text = "name = \"rim\"\n[tooth]\nteeth = 29\nmodule_mm = 4\nface_width_mm = 25\n[blank]\nkind = \"thin-rim\"\nbore_diameter_mm = 20.5\n\
        hub_diameter_mm = 33.8\nrim_inner_diameter_mm = 72.91\nweb_thickness_mm = 13.1\n[blank.holes]\ncount = 7\n\
        pitch_circle_diameter_mm = 53.4\ndiameter_mm = 13.7\nphase_deg = 7.5\n[material]\nyoung_GPa = 206.0\npoisson = 0.3\n";
    let gear = GearDefinition::from_document(&InputDocument::new("rim.toml", text)).unwrap();
    let size = gearmesh_mesh::MeshSize::estimate(&gear).unwrap();
    // 512 thousand are made; a third, as is asked of the memory that follows from them.
    assert!((size.nodes / 512e3 - 1.0).abs() < 0.3, "{size:?}");
}

/// Lengths by default, with which gmsh finds no good quads beside the first circle that would end the cells of the
/// teeth. The hub is paved in rows: wherever its circles are, they have the same nodes.
#[test]
fn where_a_circle_outside_the_holes_gives_poor_quads_another_is_taken() {
    let text = source("wheel_47_drilled.toml");
    let (before, rest) = text.split_once("[mesh]").unwrap();
    let (_, after) = rest.split_once("[reduction]").unwrap();
    let text = format!("{before}[reduction]{after}");
    let gear = GearDefinition::from_document(&InputDocument::new("gear.toml", text)).unwrap();
    let mesh = GearMesh::new(&gear, &PythonEnvironment::find().unwrap()).unwrap();
    let radius_mm = |node: &u32| {
        let [x, y, _] = mesh.nodes[*node as usize];
        1e3 * x.hypot(y)
    };
    // The rim's inner radius is 59 mm, the holes reach out to 54 mm.
    let cell = mesh.cell_nodes(0);
    let deepest = cell.iter().map(radius_mm).fold(f64::INFINITY, f64::min);
    assert!((55.0..58.0).contains(&deepest), "{deepest}");
    let middle = mesh.nodes.iter().filter(|[_, _, z]| z.abs() < 1e-9);
    let mut on_circles = std::collections::BTreeMap::new();
    for [x, y, _] in middle.filter(|[x, y, _]| x.hypot(*y) < 30e-3 + 1e-9) {
        let radius_um = (1e6 * x.hypot(*y)).round() as u64;
        *on_circles.entry(radius_um).or_insert(0) += 1;
    }
    let counts: Vec<i32> = on_circles.into_values().collect();
    assert!((3..9).contains(&counts.len()), "{counts:?}");
    assert!(counts.iter().all(|count| *count == counts[0]), "{counts:?}");
}
