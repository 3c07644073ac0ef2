//! Gauges in the roots of bevel teeth against a direct solution of the whole gear, against turned and mirrored ones.

use gearmesh_bevel::BevelGear;
use gearmesh_fe::{Factor, assemble_stiffness};
use gearmesh_geometry::input::InputDocument;
use gearmesh_mesh::BevelMesh;
use gearmesh_model::{Flank, ReducedGear};
use gearmesh_reduction::bevel::gauge::bevel_gauge_row;
use gearmesh_reduction::bevel::loads::{bevel_grid, bevel_loads};
use gearmesh_reduction::bevel::reduce_bevel;
use gearmesh_reduction::flank_loads::dot;
use gearmesh_reduction::{GearBody, ReductionOptions, Silent};
use nalgebra::Vector3;
use std::path::Path;

const TANGENT_DEG: f64 = 30.0;
const WIDTH_MM: f64 = 8.0;

fn gauge(name: &str, tooth: usize, side: &str) -> String {
    format!(
        "[[gauge]]\nname = \"{name}\"\ntooth = {tooth}\nside = \"{side}\"\ntangent_deg = {TANGENT_DEG}\nlength_mm = 0.2\nwidth_mm = {WIDTH_MM}\n"
    )
}

/// The pinion of 20/20, of either hand.
fn reduced(hand: &str, mesh: &str, gauges: &str) -> (BevelGear, ReducedGear, GearBody<BevelMesh>) {
    let folder = tempfile::tempdir().unwrap();
    let pair = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fe_models/bevel_20_20.toml");
    let text = std::fs::read_to_string(pair).unwrap();
    let named = "pinion_hand = \"right\"";
    assert!(text.contains(named));
    let text = text.replace(named, &format!("pinion_hand = \"{hand}\""));
    std::fs::write(folder.path().join("pair.toml"), text).unwrap();
    let text = format!(
        "name = \"made up\"\n[bevel_gear]\npair = \"pair.toml\"\nmember = \"pinion\"\n[blank]\nbore_diameter_mm = 34.0\n\
         [material]\nyoung_GPa = 206.0\npoisson = 0.3\n{gauges}\n[mesh]\n{mesh}\n[reduction]\nprofile_stations = 4\nslices = 2\n"
    );
    let gear =
        BevelGear::from_document(&InputDocument::new("made up", text), folder.path()).unwrap();
    let options = ReductionOptions {
        estimate_error: false,
    };
    let (model, body) = reduce_bevel(&gear, options, &Silent).unwrap();
    (gear, model, body)
}

const COARSE: &str = "flank_mm = 1.5\nfillet_mm = 0.4\nbody_mm = 6.0\nalong_mm = 3.75\n";

/// Reading of a gauge by method 2 of a load's component on a tooth's flank.
fn adjoint(
    model: &ReducedGear,
    gauge: usize,
    (tooth, flank, load, component): (usize, Flank, usize, usize),
) -> f64 {
    let f = model.flank_index(flank).unwrap();
    let at = (tooth * model.flanks.len() + f) * model.grid.len() + load;
    model.gauges[gauge].adjoint[3 * at + component]
}

/// Strain across the tooth where the fillet's tangent makes the asked angle with the tooth's centre line, averaged over
/// the gauge's width: from the displacements of nodes in the root alone.
fn strain_in_the_root(gear: &BevelGear, body: &GearBody<BevelMesh>, u: &[f64]) -> f64 {
    let mesh = &body.mesh;
    let (sin, cos) = gear.blank().pitch_angle_rad.sin_cos();
    let faces = mesh.outline_faces(0, Flank::Right, |k, l| [k as f64, mesh.along[l]]);
    // Angle and strain at the middle of each face, strip by strip along the tooth.
    let mut strips: Vec<(f64, Vec<[f64; 2]>)> = Vec::new();
    for face in &faces {
        let (mut r, mut by) = (Vector3::zeros(), [Vector3::zeros(); 2]);
        let mut of_u = [Vector3::zeros(); 2];
        for (&node, [n, d_xi, d_eta]) in face.nodes.iter().zip(face.shape.shapes([0.0, 0.0])) {
            let x = Vector3::from(mesh.nodes[node as usize]);
            let first = 3 * node as usize;
            let moved = Vector3::new(u[first], u[first + 1], u[first + 2]);
            r += x * n;
            for (k, d) in [d_xi, d_eta].into_iter().enumerate() {
                by[k] += x * d;
                of_u[k] += moved * d;
            }
        }
        let along = by[1].normalize();
        let across = (by[0] - along * along.dot(&by[0])).normalize();
        // across = a ∂r/∂ξ + b ∂r/∂η
        let a = 1.0 / across.dot(&by[0]);
        let b = -a * by[0].dot(&along) / by[1].norm();
        let strain = across.dot(&(of_u[0] * a + of_u[1] * b));
        let radius = r.x.hypot(r.y);
        let up = Vector3::new(cos * r.x / radius, cos * r.y / radius, -sin);
        let centre = (up - along * along.dot(&up)).normalize();
        let angle = across.cross(&along).dot(&centre).abs().asin();
        let [low, high] = face.range_m(1);
        let middle = 0.5 * (low + high);
        match strips.iter_mut().find(|(s, _)| (s - middle).abs() < 1e-9) {
            Some((_, strip)) => strip.push([angle, strain]),
            None => strips.push((middle, vec![[angle, strain]])),
        }
    }
    let asked = TANGENT_DEG.to_radians();
    let width = WIDTH_MM * 1e-3 / gear.blank().face_width_m * 35.0_f64.to_radians().cos();
    let (mut sum, mut count) = (0.0, 0);
    for (_, strip) in strips.iter().filter(|(s, _)| (s - 0.5).abs() < 0.5 * width) {
        // From the bottom of the space up the fillet the angle falls to that of the flank.
        let two = strip
            .windows(2)
            .find(|w| (w[0][0] - asked) * (w[1][0] - asked) <= 0.0)
            .unwrap();
        let share = (asked - two[0][0]) / (two[1][0] - two[0][0]);
        sum += two[0][1] + share * (two[1][1] - two[0][1]);
        count += 1;
    }
    assert!(count >= 3, "{count} strips under the gauge");
    sum / f64::from(count)
}

/// One factorisation of the whole gear under loads of both components, on both flanks: the gauge's row reads of it what
/// the model foretells (to rounding), and so does a strain from displacements of root nodes alone (within what a
/// gauge's length and the elements leave).
#[test]
fn a_direct_solution_has_the_strain_that_gauges_read() {
    let mesh = "flank_mm = 2.0\nfillet_mm = 0.25\nbody_mm = 12.0\nalong_mm = 2.0\n";
    let gauges = gauge("root", 0, "right");
    let (gear, model, body) = reduced("right", mesh, &gauges);
    let stiffness = assemble_stiffness(&body.model, &body.dofs).unwrap();
    let factor = Factor::of_model(&body.model, &body.dofs, &stiffness).unwrap();
    let grid = bevel_grid(&gear);
    let row = bevel_gauge_row(&gear, &body.mesh, &body.model, &gear.gauges[0], 0).unwrap();
    for (case, flank) in [Flank::Right, Flank::Left].into_iter().enumerate() {
        let patch = gear.patch(flank).unwrap();
        let loads = bevel_loads(&body.mesh, &patch, flank, &grid);
        let mut full = vec![0.0; 3 * body.mesh.nodes.len()];
        let mut foretold = 0.0;
        for (i, j, normal_n, tangential_n) in [
            (3, 1, 300.0, 20.0),
            (2, 2, 500.0, -30.0),
            (1, 3, 200.0, 0.0),
        ] {
            let load = grid.load(i, j);
            for (component, force_n, part) in [
                (0, normal_n, &loads[load].normal),
                (1, tangential_n, &loads[load].tangential),
            ] {
                for (dof, value) in part {
                    full[*dof] += force_n * value;
                }
                foretold += force_n * adjoint(&model, 0, (0, flank, load, component));
            }
        }
        let mut free = body.dofs.restrict(&full);
        factor.solve_slice_in_place(&mut free);
        let u = body.dofs.expand(&free);
        let read = dot(&row, &u);
        assert!(
            (read / foretold - 1.0).abs() < 1e-8,
            "{read:e} {foretold:e}"
        );
        let seen = strain_in_the_root(&gear, &body, &u);
        assert!(
            (seen / read - 1.0).abs() < 0.03,
            "{case}: {seen:e} {read:e}"
        );
        // Tension on the loaded side.
        assert_eq!(read > 0.0, flank == Flank::Right);
    }
}

/// A gauge on tooth 7 reads of tooth t what one on tooth 0 reads of tooth t − 7, by both methods.
#[test]
fn gauges_on_other_teeth_read_the_same() {
    let gauges = gauge("first", 0, "right") + &gauge("other", 7, "right");
    let (_, model, _) = reduced("right", COARSE, &gauges);
    let largest = model.gauges[0]
        .adjoint
        .iter()
        .fold(0.0_f64, |most, x| most.max(x.abs()));
    for tooth in 0..20 {
        for flank in [Flank::Right, Flank::Left] {
            for load in 0..model.grid.len() {
                for component in 0..3 {
                    let first = adjoint(&model, 0, (tooth, flank, load, component));
                    let other = adjoint(&model, 1, ((tooth + 7) % 20, flank, load, component));
                    assert!((first - other).abs() < 1e-9 * largest);
                }
            }
        }
    }
    let [first, other] = [0, 1].map(|g: usize| &model.gauges[g].own_tooth);
    assert!((first.iter().zip(other)).all(|(a, b)| (a - b).abs() < 1e-9 * largest));
}

/// On the gear of the other hand the gauge in the left root reads what the one in the right root reads: loads along the
/// normal and up the profile are mirrored, those along the tooth too, towards the heel.
#[test]
fn gauges_of_the_other_hand_are_mirrored() {
    let (_, one, _) = reduced("right", COARSE, &gauge("root", 0, "right"));
    let (_, other, _) = reduced("left", COARSE, &gauge("root", 0, "left"));
    let largest = one.gauges[0]
        .adjoint
        .iter()
        .fold(0.0_f64, |most, x| most.max(x.abs()));
    for tooth in 0..20 {
        for flank in [Flank::Right, Flank::Left] {
            for load in 0..one.grid.len() {
                for component in 0..3 {
                    let a = adjoint(&one, 0, (tooth, flank, load, component));
                    let mirrored = ((20 - tooth) % 20, flank.opposite(), load, component);
                    let b = adjoint(&other, 0, mirrored);
                    assert!(
                        (a - b).abs() < 1e-8 * largest,
                        "{tooth} {component}: {a:e} {b:e}"
                    );
                }
            }
        }
    }
}
