//! The calibration in plane strain: order of convergence, interpolation between the places, and the law of the load
//! width.

use gearmesh_fe::FeModel;
use gearmesh_geometry::input::InputDocument;
use gearmesh_geometry::{Flank, GearDefinition};
use gearmesh_mesh::GearMesh;
use gearmesh_mesh::python::PythonEnvironment;
use gearmesh_reduction::contact_problem::ContactProblem;
use gearmesh_reduction::flank_loads::flank_grid;
use gearmesh_reduction::gear_body::model_of;
use gearmesh_reduction::near_field::{
    HALF_WIDTH_IN_MODULES, calibrate, extrapolated, grading, mesh_compliance,
};
use std::f64::consts::PI;

const YOUNG: f64 = 206e9;
const POISSON: f64 = 0.3;

fn gear(mesh: &str) -> GearDefinition {
    let text = format!(
        "name = \"plane\"\n[tooth]\nteeth = 50\nmodule_mm = 3.0\nface_width_mm = 10.0\n[blank]\nkind = \"solid\"\n\
         bore_diameter_mm = 60.0\n[material]\nyoung_GPa = 206.0\npoisson = {POISSON}\n[mesh]\naxial_mm = 10.0\n{mesh}"
    );
    GearDefinition::from_document(&InputDocument::new("plane.toml", text)).unwrap()
}

fn meshed(gear: &GearDefinition) -> (GearMesh, FeModel) {
    let mesh = GearMesh::new(gear, &PythonEnvironment::find().unwrap()).unwrap();
    let model = model_of(gear, &mesh).unwrap();
    (mesh, model)
}

/// Roll angles from the lowest to a tenth of a module below the tip.
const ROLLS: [f64; 5] = [0.25, 0.33, 0.40, 0.44, 0.469];

/// The error of c₀ falls with the square of the element length, so that the value extrapolated from the two gradings is
/// within 0.1 % of what gradings twice as fine extrapolate to.
#[test]
fn the_contact_deflection_converges() {
    let gear = gear("");
    let (mesh, model) = meshed(&gear);
    let problem = ContactProblem::new(&gear, mesh.section.cell.cut_line(), *model.material());
    let module = gear.tooth.module_m;
    let at = |roll: f64, factor: f64| {
        problem
            .deflection(
                roll,
                HALF_WIDTH_IN_MODULES * module,
                grading(module, factor),
            )
            .unwrap()
    };
    for roll in ROLLS {
        let [c2, c1, c05] = [2.0, 1.0, 0.5].map(|factor| at(roll, factor));
        let order = ((c2 - c1) / (c1 - c05)).log2();
        let (used, finer) = (extrapolated(c1, c2), extrapolated(c05, c1));
        println!(
            "roll {roll:.3}: c0 {used:.5e} m2/N, order {order:.2}, fine {:+.3} %, extrapolated {:+.4} %",
            100.0 * (c1 / finer - 1.0),
            100.0 * (used / finer - 1.0)
        );
        assert!((1.5..2.5).contains(&order), "order {order}");
        assert!((used / finer - 1.0).abs() < 5e-4);
    }
}

/// Between the places the interpolated c₀ is the computed one to 0.1 %; within a₀ of the edge, where the pressure is
/// cut off and c₀ itself says little, to 0.5 %.
#[test]
fn the_places_are_dense_enough() {
    let gear = gear("");
    let (mesh, model) = meshed(&gear);
    let field = calibrate(&gear, &mesh, &model, &flank_grid(&gear)).unwrap();
    println!("residual {:.2e}", field.residual);
    assert!(field.residual < 2e-3);
    let problem = ContactProblem::new(&gear, mesh.section.cell.cut_line(), *model.material());
    let module = gear.tooth.module_m;
    let (r_b, end) = (gear.profile.base_radius_m, gear.profile.flank_end_roll_rad);
    let mut worst = [0.0f64; 2];
    for pair in field.roll_angles_rad.windows(2) {
        let roll = 0.5 * (pair[0] + pair[1]);
        let [fine, coarse] = [1.0, 2.0].map(|factor| {
            problem
                .deflection(roll, field.half_width_m, grading(module, factor))
                .unwrap()
        });
        let error = field.contact_at(roll, r_b) / extrapolated(fine, coarse) - 1.0;
        let distance = 0.5 * r_b * (end * end - roll * roll) / field.half_width_m;
        println!(
            "roll {roll:.4}, {distance:.2} a0 from the edge: interpolation {:+.4} %",
            100.0 * error
        );
        let at_edge = usize::from(distance < 1.0);
        worst[at_edge] = worst[at_edge].max(error.abs());
    }
    assert!(worst[0] < 1e-3 && worst[1] < 5e-3, "{worst:?}");
}

/// c₀(a) − c₀(a₀) = −k ln(a/a₀), k = 2(1−ν²)/(πE): the law that carries the calibration to other load widths.
#[test]
fn the_load_width_enters_by_its_logarithm() {
    let gear = gear("");
    let (mesh, model) = meshed(&gear);
    let problem = ContactProblem::new(&gear, mesh.section.cell.cut_line(), *model.material());
    let module = gear.tooth.module_m;
    let a0 = HALF_WIDTH_IN_MODULES * module;
    let k = 2.0 * (1.0 - POISSON * POISSON) / (PI * YOUNG);
    for roll in &ROLLS[..4] {
        let at = |a: f64| {
            let values = [1.0, 2.0].map(|factor| {
                let mut grading = grading(module, factor);
                grading.smallest_m *= a / a0;
                grading.plateau_m *= a / a0;
                problem.deflection(*roll, a, grading).unwrap()
            });
            extrapolated(values[0], values[1])
        };
        let reference = at(a0);
        for ratio in [0.5, 2.0, 3.0] {
            let expected = reference - k * f64::ln(ratio);
            let error = at(ratio * a0) / expected - 1.0;
            println!("roll {roll:.3}, a/a0 {ratio}: {:+.4} %", 100.0 * error);
            // (a/h)² with a = 3 a₀ and the smallest h is 0.02.
            assert!(error.abs() < 4e-3, "{error}");
        }
    }
}

/// W is symmetric, the same for both mirror-image flanks, and the energy of a load spread over hats is below that of
/// the narrow pressure.
#[test]
fn the_mesh_part_is_a_compliance() {
    let gear = gear("flank_mm = 0.8\n");
    let (mesh, model) = meshed(&gear);
    let grid = flank_grid(&gear);
    let n = grid.roll_angles_rad.len();
    let [right, left] = [Flank::Right, Flank::Left]
        .map(|side| mesh_compliance(&gear, &mesh, &model, &grid, side).unwrap());
    let field = calibrate(&gear, &mesh, &model, &grid).unwrap();
    assert_eq!(&field.mesh_m2_per_n[..n * n], &right);
    let largest = right.iter().copied().fold(0.0, f64::max);
    let mut worst: f64 = 0.0;
    for i in 0..n {
        for j in 0..n {
            assert!((right[i * n + j] - right[j * n + i]).abs() < 1e-10 * largest);
            worst = worst.max((right[i * n + j] / left[i * n + j] - 1.0).abs());
        }
        let own = right[i * n + i];
        assert!(
            own > 0.0
                && own < field.contact_at(grid.roll_angles_rad[i], gear.profile.base_radius_m)
        );
    }
    println!("flanks differ by {worst:e}");
}
