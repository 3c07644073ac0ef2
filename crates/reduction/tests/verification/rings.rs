//! Rings: the mesh, the two ways to solve, reciprocity and mirror images, torsion of the rim in closed form.

use crate::small_gears::{COARSE, difference, reduced, without_symmetry};
use gearmesh_geometry::input::InputDocument;
use gearmesh_geometry::{Flank, GearDefinition, ProfileCurve};
use gearmesh_mesh::GearMesh;
use gearmesh_mesh::python::PythonEnvironment;
use gearmesh_model::ReducedGear;
use std::f64::consts::PI;

const TEETH: usize = 36;

/// A ring of 36 teeth, module 3 mm, 12 mm wide, with a gauge; its root circle has a diameter of 115.5 mm.
fn ring(blank: &str, mesh: &str, tooth: &str) -> GearDefinition {
    let text = format!(
        "name = \"ring\"\n[tooth]\nteeth = -{TEETH}\nmodule_mm = 3.0\naddendum = 0.7\nface_width_mm = 12.0\n{tooth}\
         [blank]\nkind = \"ring\"\n{blank}[material]\nyoung_GPa = 210.0\npoisson = 0.3\ndensity_kg_per_m3 = 7800.0\n[mesh]\n{mesh}\
         [reduction]\nroll_stations = 4\nslices = {}\nflanks = [\"right\", \"left\"]\n\
         [[gauge]]\nname = \"root\"\ntooth = 3\nside = \"right\"\ntangent_deg = 45.0\nlength_mm = 0.9\nwidth_mm = 4.0\nz_mm = 1.0\n",
        if mesh.contains("plane_strain") { 1 } else { 2 }
    );
    GearDefinition::from_document(&InputDocument::new("ring.toml", text)).unwrap()
}

const ROUND: &str = "root = \"full-round\"\n";

/// Area between the outline of the teeth and the outside \[m²\].
fn area_m2(gear: &GearDefinition) -> f64 {
    let curve = ProfileCurve::new(&gear.profile);
    let steps = 2000;
    let half: f64 = (0..steps)
        .map(|k| {
            let at = |k: i32| curve.point_at(curve.length_m() * f64::from(k) / f64::from(steps));
            let (p, q) = (at(k), at(k + 1));
            0.5 * (p[0] * q[1] - p[1] * q[0])
        })
        .sum();
    PI * gear.blank.edge_radius_m().powi(2) - 2.0 * half * TEETH as f64
}

/// Elements fill the ring, its outside is held, and flank nodes lie on the involute of a tooth that points inwards.
#[test]
fn the_mesh_fills_the_ring() {
    for (blank, tooth) in [
        ("outer_diameter_mm = 132.0\n", ROUND),
        ("outer_diameter_mm = 118.6\n", ""),
        (
            "outer_diameter_mm = 160.0\nheld_band_mm = [-4.0, 2.0]\n",
            "helix_angle_deg = 15.0\nhand = \"left\"\n",
        ),
    ] {
        let mesh = if tooth.contains("helix") {
            COARSE
        } else {
            "plane_strain = true\n"
        };
        let gear = ring(blank, mesh, tooth);
        let made = GearMesh::new(&gear, &PythonEnvironment::find().unwrap()).unwrap();
        assert!(made.quality.smallest > 0.2, "{:?}", made.quality);
        let outside = gear.blank.edge_radius_m();
        let held = made.held(&gear.blank);
        let band = gear.blank.rim().unwrap().held_z_m;
        assert!(held.iter().all(|&n| {
            let [x, y, z] = made.nodes[n as usize];
            let on_band = band.is_none_or(|[from, to]| z >= from - 1e-9 && z <= to + 1e-9);
            (x.hypot(y) - outside).abs() < 1e-12 && on_band
        }));
        if let Some(band) = band {
            let at = |z: f64| {
                held.iter()
                    .any(|&n| (made.nodes[n as usize][2] - z).abs() < 1e-12)
            };
            assert!(at(band[0]) && at(band[1]));
        }
        let area = area_m2(&gear);
        let of_quads: f64 = made
            .section
            .quads
            .iter()
            .map(|q| {
                let p = q.map(|n| made.section.nodes[n]);
                0.5 * ((p[2][0] - p[0][0]) * (p[3][1] - p[1][1])
                    - (p[3][0] - p[1][0]) * (p[2][1] - p[0][1]))
            })
            .sum();
        // Chords of arcs: a percent of a module or so.
        assert!(
            (of_quads / area - 1.0).abs() < 0.006,
            "{of_quads:e} {area:e}"
        );
        let sets = made.node_sets(&gear);
        for side in Flank::ALL {
            for &n in &sets[&format!("tooth0_{}_flank", side.name())] {
                let [x, y, z] = made.nodes[n as usize];
                let turned = gear.profile.twist_rad_per_m() * z;
                let roll = gearmesh_geometry::involute::roll_angle_rad(
                    x.hypot(y),
                    gear.profile.base_radius_m,
                );
                let off = y.atan2(x) - turned + side.mirror() * gear.profile.half_angle_rad(roll);
                assert!(off.abs() < 1e-12, "{off:e}");
            }
            let supports = made.tooth_supports(0, side);
            let flank = &sets[&format!("tooth0_{}_flank", side.name())];
            assert!(flank.iter().all(|n| !supports.contains(n)));
        }
        assert!(sets.contains_key("outside") && !made.tooth_elements(0).is_empty());
    }
}

/// One tooth and the harmonics of the ring against one factorisation of everything, to rounding; reciprocity; patterns.
#[test]
fn both_ways_to_solve_a_ring_agree() {
    for (blank, tooth) in [
        ("outer_diameter_mm = 132.0\n", ROUND),
        (
            "outer_diameter_mm = 132.0\nheld_band_mm = [-6.0, 0.0]\n",
            "helix_angle_deg = 10.0\nhand = \"right\"\n",
        ),
        (
            "outer_diameter_mm = 132.0\n[blank.lugs]\ncount = 9\nwidth_deg = 13.0\nphase_deg = 7.0\n",
            ROUND,
        ),
    ] {
        let gear = ring(blank, COARSE, tooth);
        let (cyclic, _) = reduced(&gear, false);
        let (whole, _) = reduced(&without_symmetry(&gear), false);
        let lugs = gear.blank.rim().unwrap().lugs;
        assert_eq!(gear.sectors(), lugs.map_or(TEETH, |lugs| lugs.count));
        assert!(difference(&whole.c_hub, &cyclic.c_hub) < 1e-9);
        assert!(difference(&whole.gauges[0].adjoint, &cyclic.gauges[0].adjoint) < 1e-9);
        for model in [&cyclic, &whole] {
            assert!(model.checks.symmetry < 1e-9, "{:e}", model.checks.symmetry);
            assert!(model.checks.pattern_identity < 1e-9);
            let rolls = &model.grid.roll_angles_rad;
            assert!(rolls.windows(2).all(|w| w[1] > w[0]));
            assert!((rolls[0] - gear.profile.flank_end_roll_rad).abs() < 1e-15);
        }
    }
}

/// Of a ring that is its own mirror image left flanks deflect as right ones do, and teeth before as teeth after.
#[test]
fn left_and_right_flanks_of_a_ring_are_mirror_images() {
    let gear = ring("outer_diameter_mm = 132.0\n", COARSE, ROUND);
    let (model, _) = reduced(&gear, false);
    for tooth in [0, 1, 2] {
        let right = model.c_hub_block(0, Flank::Right, tooth, Flank::Right);
        let left = model.c_hub_block(0, Flank::Left, (TEETH - tooth) % TEETH, Flank::Left);
        // gmsh's quads in the body are not exact mirror images: the bound is their effect on a coarse mesh.
        let off = difference(&right, &left);
        assert!(off < 5e-3, "{tooth} {off:e}");
    }
}

/// Lugs that repeat with the teeth or not, across cuts and beside them, on straight and helical teeth: held are the
/// nodes between two edges, and nodes lie on both.
#[test]
fn lugs_are_held_from_edge_to_edge() {
    let helical = "helix_angle_deg = 15.0\nhand = \"left\"\n";
    for (count, width_deg, phase_deg, mesh, tooth) in [
        (6, 10.0, 0.0, "plane_strain = true\n", ROUND),
        (9, 13.0, 7.0, "plane_strain = true\n", ROUND),
        (7, 20.0, -3.0, "plane_strain = true\n", ROUND),
        (36, 4.0, 1.0, "plane_strain = true\n", ROUND),
        (4, 30.0, 2.0, COARSE, helical),
    ] {
        let blank = format!(
            "outer_diameter_mm = 140.0\n[blank.lugs]\ncount = {count}\nwidth_deg = {width_deg:?}\nphase_deg = {phase_deg:?}\n"
        );
        let gear = ring(&blank, mesh, tooth);
        let made = GearMesh::new(&gear, &PythonEnvironment::find().unwrap()).unwrap();
        assert!(made.quality.smallest > 0.2, "{count}: {:?}", made.quality);
        let repeat = 360.0 / f64::from(count);
        let from_middle = |node: u32| {
            let [x, y, _] = made.nodes[node as usize];
            let from: f64 = y.atan2(x).to_degrees() - phase_deg;
            from - repeat * (from / repeat).round()
        };
        let held = made.held(&gear.blank);
        for edge in [-0.5, 0.5] {
            let on_edge = held
                .iter()
                .filter(|&&n| (from_middle(n) - edge * width_deg).abs() < 1e-9);
            let levels = made.nodes.iter().map(|p| p[2].to_bits());
            let levels = levels.collect::<std::collections::BTreeSet<_>>().len();
            assert_eq!(on_edge.count(), count as usize * levels, "{count} {edge}");
        }
        assert!(
            held.iter()
                .all(|&n| from_middle(n).abs() < 0.5 * width_deg + 1e-9)
        );
        assert!(held.len() < made.bore().len());
    }
}

/// Right flanks of all teeth pressed and left ones pulled alike twist the rim. An annulus in plane strain under the
/// torque T, held outside at R, turns by T/(4πG b) (1/r² − 1/R²) at r (from τ = T/(2π r² b)): rings with two outsides
/// differ by T/(4πG b) (1/R_1² − 1/R_2²) and by nothing else once the ripple of the teeth has died away, (r_f/R)^z:
/// 1e-3 at the smaller one.
#[test]
fn all_teeth_together_twist_the_rim_as_an_annulus() {
    let fine = "plane_strain = true\nbody_mm = 1.5\n";
    let of = |outer_mm: f64| ring(&format!("outer_diameter_mm = {outer_mm}\n"), fine, ROUND);
    let [small, large]: [f64; 2] = [140.0, 200.0];
    let [near, far] = [small, large].map(|outer_mm| twist(&reduced(&of(outer_mm), false).0));
    // The lever of each of a tooth's two forces, and of each reading.
    let lever = of(small).profile.base_radius_m;
    let shear = 210e9 / 2.6;
    let per_width = TEETH as f64 * (2.0 * lever).powi(2) / (4.0 * PI * shear * 12e-3);
    let radii = [small, large].map(|d| 0.5e-3 * d);
    let expected = per_width * (radii[0].powi(-2) - radii[1].powi(-2));
    let found = far - near;
    assert!(
        (found / expected - 1.0).abs() < 0.005,
        "{found:e} {expected:e}"
    );
}

/// Deflection of tooth 0's right flank less that of its left one where all right flanks carry 1 N and all left ones −1
/// N, at one station of their grid \[m/N\].
fn twist(model: &ReducedGear) -> f64 {
    let grid = &model.grid;
    let load = grid.load(1, 1);
    let mut sum = 0.0;
    for tooth in 0..TEETH {
        for loaded in Flank::ALL {
            for read in Flank::ALL {
                let block = model.c_hub_block(tooth, loaded, 0, read);
                sum += loaded.mirror() * read.mirror() * block[load * grid.len() + load];
            }
        }
    }
    sum
}

/// A ring with density has mass, of the outline's area, and modes with its outside held.
#[test]
fn a_ring_has_modes() {
    let mut gear = ring("outer_diameter_mm = 132.0\n", COARSE, ROUND);
    gear.modes = Some(gearmesh_geometry::ModeRange::Count(4));
    let (model, solved) = reduced(&gear, false);
    assert_eq!(solved.mesh.teeth(), TEETH);
    let mass = model.rigid_body.as_ref().unwrap().mass_kg;
    // Chords of a coarse mesh.
    let expected = 7800.0 * 12e-3 * area_m2(&gear);
    assert!((mass / expected - 1.0).abs() < 0.01, "{mass} {expected}");
    let modes = model.modes.as_ref().unwrap();
    assert!(modes.omega_squared.len() >= 4 && modes.omega_squared[0] > 0.0);
}
