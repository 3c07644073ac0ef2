//! A pinion cut into its shaft, with stubs of the shaft on its faces in one finite element model, against the reduced
//! pinion between beams.

use crate::computed;
use crate::pinion_with_stubs::{CASES, Case, WIDTH_M, with_stubs};
use crate::small_gears::body;
use faer::Mat;
use gearmesh_fe::{DofMap, Factor, RigidGroup, assemble_stiffness};
use gearmesh_geometry::{Flank, GearDefinition};
use gearmesh_reduction::flank_loads::{SparseVector, flank_grid, flank_loads};
use gearmesh_reduction::shaft_faces::HeldFaces;
use gearmesh_reduction::{GearBody, Silent};
use nalgebra::{DMatrix, DVector, Matrix6};
use std::f64::consts::PI;

/// Deflection at each load under each, and the force that the bearing behind the back stub takes of it, across the
/// axis.
struct Answers {
    deflections: DMatrix<f64>,
    bearing: Vec<[f64; 2]>,
    /// The deflections of a pinion whose faces cannot move against each other, one frame joining both beams: its flanks
    /// as with the back face alone held, and with both.
    on_one_frame: Option<[DMatrix<f64>; 2]>,
}

/// K_Hβ: the largest line load over the mean, where a straight rigid flank that stays parallel presses on the stations
/// `loads` of the face at `z_m`. Loads are hats, half as wide at the ends.
fn face_load_factor(deflections: &DMatrix<f64>, loads: &[usize], z_m: &[f64]) -> f64 {
    let n = z_m.len();
    let width = |i: usize| 0.5 * (z_m[(i + 1).min(n - 1)] - z_m[i.saturating_sub(1)]);
    let mut pressed: Vec<usize> = (0..n).collect();
    loop {
        let count = pressed.len();
        let c = DMatrix::from_fn(count, count, |i, j| {
            deflections[(loads[pressed[i]], loads[pressed[j]])]
        });
        let forces = c.lu().solve(&DVector::repeat(count, 1.0)).unwrap();
        // Stations that would have to be pulled are left.
        if let Some(pulled) = (0..count).find(|&i| forces[i] < 0.0) {
            pressed.remove(pulled);
            continue;
        }
        let mean = forces.sum() / (z_m[n - 1] - z_m[0]);
        let line_loads = pressed.iter().zip(forces.iter());
        return line_loads.fold(0.0, |most, (&i, force)| most.max(force / width(i) / mean));
    }
}

/// Stiffness at the end of a cantilever of the shaft; `towards` is the sign of z from there to its clamp.
fn cantilever(radius: f64, length: f64, towards: f64) -> Matrix6<f64> {
    let (young, poisson) = (210e9, 0.3);
    let shear = young / (2.0 * (1.0 + poisson));
    let area = PI * radius * radius;
    let second = 0.25 * PI * radius.powi(4);
    let kappa = 6.0 * (1.0 + poisson) / (7.0 + 6.0 * poisson);
    let across = length.powi(3) / (3.0 * young * second) + length / (kappa * shear * area);
    let mixed = towards * length * length / (2.0 * young * second);
    let turn = length / (young * second);
    let mut h = Matrix6::zeros();
    (h[(0, 0)], h[(1, 1)], h[(2, 2)]) = (across, across, length / (young * area));
    (h[(3, 3)], h[(4, 4)], h[(5, 5)]) = (turn, turn, length / (2.0 * shear * second));
    (h[(0, 4)], h[(4, 0)]) = (-mixed, -mixed);
    (h[(1, 3)], h[(3, 1)]) = (mixed, mixed);
    h.try_inverse().unwrap()
}

/// The reduced pinion: its faces joined by K_bb, the front one clamped behind its stub, the back one on its stub in a
/// bearing that holds it across the axis.
fn on_beams(
    case: &Case,
    gear: &GearDefinition,
    body: &GearBody,
    loads: &[SparseVector],
) -> Answers {
    let faces = HeldFaces::new(gear, body, (&[], &[]), &Silent)
        .unwrap()
        .unwrap();
    println!("a rigid motion leaves {:e}", faces.rigid_residual);
    assert!(faces.rigid_residual < 1e-9);
    let between = DMatrix::from_fn(12, 12, |i, j| faces.stiffness[(i, j)]);
    let mut stiffness = between.clone();
    let mut front = stiffness.view_mut((6, 6), (6, 6));
    front += cantilever(case.radius_m(1), case.stub_m[1], 1.0);
    let stub = cantilever(case.radius_m(0), case.stub_m[0], 1.0)
        .try_inverse()
        .unwrap();
    let spring = 1.0 / stub[(0, 0)];
    let mut rows = Vec::new();
    for (axis, turn, sign) in [(0, 4, 1.0), (1, 3, -1.0)] {
        let mut row = DVector::zeros(12);
        (row[axis], row[turn]) = (1.0, -sign * case.stub_m[0]);
        stiffness += spring * &row * row.transpose();
        rows.push(row);
    }
    // Both faces as one rigid frame about the back one's centre: u_B = u_A + θ × (0, 0, b).
    let mut rigid = DMatrix::zeros(12, 6);
    for face in 0..2 {
        rigid.view_mut((6 * face, 0), (6, 6)).fill_with_identity();
    }
    (rigid[(6, 4)], rigid[(7, 3)]) = (WIDTH_M, -WIDTH_M);
    let of_frame = (rigid.tr_mul(&(&stiffness * &rigid)))
        .try_inverse()
        .unwrap();
    let of_frame = &rigid * of_frame * rigid.transpose();
    let of_front = (between.view((6, 6), (6, 6)).into_owned())
        .try_inverse()
        .unwrap();
    let compliance = stiffness.try_inverse().unwrap();
    let vectors: Vec<&SparseVector> = loads.iter().collect();
    let own = body.compliance(1, &vectors, &Silent);
    let row = gear.tooth.teeth * loads.len();
    let seen = faces.read(loads);
    let at = DMatrix::from_fn(12, loads.len(), |q, load| seen[(load, q)]);
    let moved = &compliance * &at;
    let excess = faces.excess(seen.as_ref(), seen.as_ref());
    let held = DMatrix::from_fn(loads.len(), loads.len(), |i, j| {
        own[i * row + j] - excess[(i, j)]
    });
    let bearing = moved.column_iter().map(|moved| {
        let moved = moved.into_owned();
        [0, 1].map(|axis| spring * rows[axis].dot(&moved))
    });
    let bearing = bearing.collect();
    let both = &held + at.tr_mul(&(of_frame * &at));
    let at_front = at.rows(6, 6);
    Answers {
        deflections: held + at.transpose() * &moved,
        bearing,
        on_one_frame: Some([&both + at_front.tr_mul(&(of_front * at_front)), both]),
    }
}

/// The same by finite elements of pinion and stubs.
fn in_one_model(case: &Case, body: &GearBody, loads: &[SparseVector]) -> Answers {
    let (model, [back, front]) = with_stubs(case, body);
    let group = RigidGroup {
        nodes: back.clone(),
        reference_m: [0.0, 0.0, -0.5 * WIDTH_M - case.stub_m[0]],
        fixed: [false; 6],
    };
    let fixed: Vec<usize> = front
        .iter()
        .flat_map(|&n| [3 * n, 3 * n + 1, 3 * n + 2])
        .collect();
    let dofs = DofMap::with_rigid_groups(model.nodes(), &fixed, &[group]).unwrap();
    let k = assemble_stiffness(&model, &dofs).unwrap();
    let factor = Factor::of_model(&model, &dofs, &k).unwrap();
    let mut right = Mat::zeros(dofs.free_count(), 2 + loads.len());
    for axis in 0..2 {
        // A force on the bearing's reference point.
        right[(dofs.free_of_reference(0, axis).unwrap(), axis)] = 1.0;
    }
    for (column, load) in loads.iter().enumerate() {
        let mut full = vec![0.0; dofs.dof_count()];
        for &(dof, value) in load {
            full[dof] = value;
        }
        for (free, value) in dofs.restrict(&full).into_iter().enumerate() {
            right[(free, 2 + column)] = value;
        }
    }
    let mut solved = right.clone();
    factor.solve_in_place(solved.as_mut());
    let free = right.transpose() * &solved;
    // The bearing takes what brings its place back.
    let held = nalgebra::Matrix2::from_fn(|i, j| free[(i, j)])
        .try_inverse()
        .unwrap();
    let moved = |load: usize| nalgebra::Vector2::new(free[(0, 2 + load)], free[(1, 2 + load)]);
    let force = |load: usize| held * moved(load);
    Answers {
        deflections: DMatrix::from_fn(loads.len(), loads.len(), |i, j| {
            free[(2 + i, 2 + j)] - moved(i).dot(&force(j))
        }),
        bearing: (0..loads.len()).map(|load| force(load).into()).collect(),
        on_one_frame: None,
    }
}

/// [`in_one_model`], recorded: pinion and shaft in one factorisation.
fn recorded(
    case: &Case,
    gear: &GearDefinition,
    body: &GearBody,
    loads: &[SparseVector],
) -> Answers {
    let [back_m, front_m] = case.stub_m;
    let from = format!("stubs of {back_m} and {front_m} m, {}", gear.source);
    let name = format!("pinion_with_stubs_of_{}_mm", case.shaft_mm[0]);
    let numbers = computed::numbers(&name, &from, || {
        let answers = in_one_model(case, body, loads);
        let deflections = answers.deflections.iter().copied();
        deflections
            .chain(answers.bearing.into_flattened())
            .collect()
    });
    let (deflections, bearing) = numbers.split_at(loads.len() * loads.len());
    Answers {
        deflections: DMatrix::from_column_slice(loads.len(), loads.len(), deflections),
        bearing: bearing
            .chunks(2)
            .map(|force| [force[0], force[1]])
            .collect(),
        on_one_frame: None,
    }
}

/// Deflection along the flank's normal at every load point under each load, the force of the bearing, and K_Hβ against
/// a straight rigid flank, at three proportions of shaft and root, with unequal faces, within 2 %. Faces that cannot
/// move against each other come less near to K_Hβ: the teeth are too free over the front face, or both are held too
/// well.
#[test]
fn a_pinion_between_beams_deflects_as_one_with_its_shaft() {
    let mut all = Vec::new();
    for case in &CASES {
        let gear = case.gear([0.8 * case.module_mm, 0.4 * case.module_mm, 6.0, 6.0], "");
        let body = body(&gear);
        let grid = flank_grid(&gear);
        let loads = flank_loads(&gear, &body.mesh, &grid, 0, Flank::Right);
        let loads: Vec<SparseVector> = loads.into_iter().map(|load| load.normal).collect();
        let found = on_beams(case, &gear, &body, &loads);
        // The smallest model is solved each time.
        let expected = if case.shaft_mm == CASES[0].shaft_mm {
            in_one_model(case, &body, &loads)
        } else {
            recorded(case, &gear, &body, &loads)
        };
        let root_mm = 2e3 * gear.profile.root_radius_m;
        let own = expected.deflections.diagonal();
        let off = DMatrix::from_fn(loads.len(), loads.len(), |i, j| {
            (found.deflections[(i, j)] - expected.deflections[(i, j)]) / (own[i] * own[j]).sqrt()
        });
        let (mean, worst) = (off.diagonal().mean(), off.amax());
        let reactions = (found.bearing.iter().zip(&expected.bearing)).map(|(a, b)| {
            let left = (a[0] - b[0]).hypot(a[1] - b[1]);
            left / b[0].hypot(b[1])
        });
        let reaction = reactions.fold(0.0, f64::max);
        let stations: Vec<usize> = (0..grid.z_m.len()).map(|i| grid.load(1, i)).collect();
        let factor = |c: &DMatrix<f64>| face_load_factor(c, &stations, &grid.z_m);
        let [of_back, of_both] = found.on_one_frame.as_ref().unwrap().each_ref().map(factor);
        let (of_two, of_whole) = (factor(&found.deflections), factor(&expected.deflections));
        println!(
            "K_Hbeta {of_whole:.3} in one model; {of_two:.3} by two faces, {of_back:.3} with one frame on the back face, {of_both:.3} on both"
        );
        let factor_off = (of_two / of_whole - 1.0).abs();
        for single in [of_back, of_both] {
            assert!(factor_off < (single / of_whole - 1.0).abs());
        }
        println!(
            "shaft {:?} of root {root_mm:.1} mm: deflections {:+.2} % in the mean, {:.2} % at most; bearing {:.2} %",
            case.shaft_mm,
            1e2 * mean,
            1e2 * worst,
            1e2 * reaction
        );
        all.push(worst.max(reaction).max(factor_off));
    }
    assert!(all.iter().all(|off| *off < 0.02), "{all:?}");
}

/// Deflections under loads at five places along the face (nm/N) and force of the bearing (N/N):
/// tools/reference/pinion_shaft.py.
const INDEPENDENT: [&str; 3] = [
    include_str!("../../../../reference/pinion_shaft_slim/data.csv"),
    include_str!("../../../../reference/pinion_shaft/data.csv"),
    include_str!("../../../../reference/pinion_shaft_thick/data.csv"),
];

/// All three against finite elements that share no mesh, no element and no assembly with these.
#[test]
fn pinions_between_beams_deflect_as_an_independent_program_says() {
    for (case, independent) in CASES.iter().zip(INDEPENDENT) {
        let [flank, fillet] = [0.4, 0.2].map(|share| share * case.module_mm);
        let gear = case.gear([flank, fillet, 4.0, 3.0], "");
        let body = body(&gear);
        let grid = flank_grid(&gear);
        let loads = flank_loads(&gear, &body.mesh, &grid, 0, Flank::Right);
        let loads: Vec<SparseVector> = loads.into_iter().map(|load| load.normal).collect();
        let found = on_beams(case, &gear, &body, &loads);
        let rows: Vec<Vec<f64>> = (independent.lines().skip(1))
            .map(|row| row.split(',').map(|value| value.parse().unwrap()).collect())
            .collect();
        assert_eq!(rows.len(), grid.z_m.len());
        // K_Hβ within 2 %, as the deflections that it comes from.
        let stations: Vec<usize> = (0..grid.z_m.len()).map(|i| grid.load(1, i)).collect();
        let theirs = DMatrix::from_fn(rows.len(), rows.len(), |i, j| 1e-9 * rows[i][1 + j]);
        let every: Vec<usize> = (0..rows.len()).collect();
        let ours = face_load_factor(&found.deflections, &stations, &grid.z_m);
        let theirs = face_load_factor(&theirs, &every, &grid.z_m);
        let (mut deflection, mut bearing) = (0.0_f64, 0.0_f64);
        for (i, row) in rows.iter().enumerate() {
            let load = grid.load(1, i);
            assert!((row[0] - 1e3 * grid.z_m[i]).abs() < 1e-9);
            for j in 0..rows.len() {
                let off = 1e9 * found.deflections[(load, grid.load(1, j))] - row[1 + j];
                deflection = deflection.max(off.abs() / (row[1 + i] * rows[j][1 + j]).sqrt());
            }
            let [x, y] = [row[6], row[7]];
            let off = (found.bearing[load][0] - x).hypot(found.bearing[load][1] - y);
            bearing = bearing.max(off / x.hypot(y));
        }
        println!(
            "{:?} mm: deflections within {:.2} %, bearing {:.2} %, K_Hbeta {ours:.3}, theirs {theirs:.3}",
            case.shaft_mm,
            1e2 * deflection,
            1e2 * bearing
        );
        assert!((ours / theirs - 1.0).abs() < 0.02, "{ours} {theirs}");
        assert!(
            deflection < 0.02 && bearing < 0.02,
            "{deflection} {bearing}"
        );
    }
}
