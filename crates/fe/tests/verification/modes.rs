//! Natural modes against closed forms, with the order of convergence, and against dense eigenvalues.

use crate::common;

use std::f64::consts::PI;

use common::{ELEMENTS, distorted_cube, model, nodes_where, steel};
use faer::{Mat, Side};
use gearmesh_fe::{
    DofMap, Element, Factor, FeError, FeModel, Material, ModeSettings, NaturalModes, RigidGroup,
    SparseMatrix, StructuredMesh, arc_middle, assemble_mass, assemble_stiffness, chord_middle,
    natural_modes, shifted_stiffness,
};

const DENSITY: f64 = 7800.0;

struct System {
    k: SparseMatrix,
    m: SparseMatrix,
}

fn system(model: &FeModel, dofs: &DofMap) -> System {
    System {
        k: assemble_stiffness(model, dofs).unwrap(),
        m: assemble_mass(model, dofs, DENSITY).unwrap(),
    }
}

fn solve(model: &FeModel, dofs: &DofMap, settings: &ModeSettings) -> (System, NaturalModes) {
    let system = system(model, dofs);
    let shifted = shifted_stiffness(&system.k, &system.m, settings.shift_rad2_per_s2).unwrap();
    let factor = Factor::of_model(model, dofs, &shifted).unwrap();
    let modes = natural_modes(&system.k, &system.m, &factor, settings).unwrap();
    (system, modes)
}

/// The generalised problem reduced with M = C Cᵀ to C⁻¹ K C⁻ᵀ and solved by dense matrices.
fn dense_omega_squared(system: &System) -> Vec<f64> {
    let c = system.m.to_dense().llt(Side::Lower).unwrap().L().to_owned();
    let mut half = system.k.to_dense();
    let par = faer::Par::Seq;
    faer::linalg::triangular_solve::solve_lower_triangular_in_place(c.as_ref(), half.as_mut(), par);
    let mut whole = half.transpose().to_owned();
    faer::linalg::triangular_solve::solve_lower_triangular_in_place(
        c.as_ref(),
        whole.as_mut(),
        par,
    );
    whole.self_adjoint_eigenvalues(Side::Lower).unwrap()
}

fn straight_block(
    counts: [usize; 3],
    size: [f64; 3],
    material: Material,
    element: Element,
) -> FeModel {
    StructuredMesh::block(counts, size)
        .into_model(material, element, |_, ends| chord_middle(ends))
        .unwrap()
}

#[test]
fn modes_equal_those_of_a_dense_solver_and_are_normalised() {
    for element in ELEMENTS {
        let model = model(distorted_cube(3), element);
        let held = nodes_where(&model, |x| x[2] == 0.0);
        let dofs = DofMap::with_fixed_nodes(model.node_count(), &held).unwrap();
        let count = 12;
        let (system, modes) = solve(&model, &dofs, &ModeSettings::new(count));
        let dense = dense_omega_squared(&system);
        assert_eq!(modes.omega_squared.len(), count);
        for (found, expected) in modes.omega_squared.iter().zip(&dense) {
            assert!(
                (found / expected - 1.0).abs() < 1e-10,
                "{element:?} {found} {expected}"
            );
        }
        let gram = modes.shapes.transpose() * (&system.m * &modes.shapes);
        let stiffness = modes.shapes.transpose() * (&system.k * &modes.shapes);
        let largest = modes.omega_squared[count - 1];
        for i in 0..count {
            for j in 0..count {
                let unit = f64::from(u8::from(i == j));
                assert!((gram[(i, j)] - unit).abs() < 1e-11);
                assert!((stiffness[(i, j)] - unit * modes.omega_squared[i]).abs() < 1e-9 * largest);
            }
            assert!(modes.krylov_residuals[i] <= 1e-10);
            assert!(
                modes.relative_residuals[i] < 1e-8,
                "{:?}",
                modes.relative_residuals
            );
        }
        // Effort: 20 blocks of 8 at most, where subspace iteration with 20 vectors would take some 40 times 20 solves.
        assert!(modes.solves <= 160, "{} solves", modes.solves);
    }
}

/// Nothing held: six rigid motions at zero, then the elastic modes, by a factor of K + s M.
#[test]
fn a_free_body_has_six_rigid_motions() {
    let model = model(distorted_cube(3), Element::Hex20);
    for dofs in [
        DofMap::all_free(model.node_count()).unwrap(),
        // A reference point that is free as well.
        DofMap::with_rigid_groups(
            model.nodes(),
            &[],
            &[RigidGroup {
                nodes: nodes_where(&model, |x| x[2] == 0.0),
                reference_m: [0.5, 0.5, 0.0],
                fixed: [false; 6],
            }],
        )
        .unwrap(),
    ] {
        let settings = ModeSettings {
            shift_rad2_per_s2: 1e7,
            ..ModeSettings::new(10)
        };
        let (system, modes) = solve(&model, &dofs, &settings);
        let dense = dense_omega_squared(&system);
        let elastic = dense[6];
        for (i, (found, expected)) in modes.omega_squared.iter().zip(&dense).enumerate() {
            assert!(
                (found - expected).abs() < 1e-9 * elastic,
                "{i}: {found} {expected}"
            );
            assert_eq!(found.abs() < 1e-9 * elastic, i < 6);
        }
    }
}

/// A block on rollers (normal displacement zero on every face, no shear there) has the exact modes
/// P: u = ∇(cos ax cos by cos cz), ω = c_p |k|, and S: two polarisations across k, one where a component of k vanishes,
/// ω = c_s |k|; k = (iπ/L_x, jπ/L_y, lπ/L_z), with 2 polarisations for i, j, l > 0, 1 with one of them 0, none with
/// two.
fn roller_block_exact(size: [f64; 3], material: &Material, count: usize) -> Vec<f64> {
    let lame = material.lame();
    let (p, s) = (
        (lame.lambda_pa + 2.0 * lame.mu_pa) / DENSITY,
        lame.mu_pa / DENSITY,
    );
    let mut all = Vec::new();
    for i in 0..5_u8 {
        for j in 0..5_u8 {
            for l in 0..5_u8 {
                let index = [i, j, l];
                let k2: f64 = (0..3)
                    .map(|a| (PI * f64::from(index[a]) / size[a]).powi(2))
                    .sum();
                let nonzero = index.iter().filter(|v| **v > 0).count();
                if nonzero > 0 {
                    all.push(p * k2);
                    all.extend(std::iter::repeat_n(s * k2, nonzero - 1));
                }
            }
        }
    }
    all.sort_by(f64::total_cmp);
    all.truncate(count);
    all
}

#[test]
fn a_block_on_rollers_converges_with_twice_the_order_of_the_energy_norm() {
    // Sides such that no two of the first frequencies are close enough to change places on a coarse mesh.
    let (size, count) = ([1.0, 0.7, 0.55], 4);
    let exact = roller_block_exact(size, &steel(), count);
    for element in ELEMENTS {
        let errors = |n: usize| -> Vec<f64> {
            let model = straight_block([n; 3], size, steel(), element);
            let fixed: Vec<usize> = (0..3)
                .flat_map(|axis| {
                    let on = |v: f64| v.abs() < 1e-12 || (v - size[axis]).abs() < 1e-12;
                    let nodes = nodes_where(&model, |x| on(x[axis]));
                    nodes.into_iter().map(move |n| 3 * n + axis)
                })
                .collect();
            let dofs = DofMap::with_fixed_dofs(model.node_count(), &fixed).unwrap();
            let (_, modes) = solve(&model, &dofs, &ModeSettings::new(count));
            modes
                .omega_squared
                .iter()
                .zip(&exact)
                .map(|(a, b)| a / b - 1.0)
                .collect()
        };
        let (sizes, order) = match element {
            Element::Hex8 | Element::Hex8Incompatible => ([6, 12], 2.0),
            Element::Wedge6 => ([8, 16], 2.0),
            Element::Tet10 | Element::Wedge15 => ([5, 10], 4.0),
            _ => ([3, 6], 4.0),
        };
        let [coarse, fine] = sizes.map(errors);
        for mode in 0..count {
            let rate = (coarse[mode] / fine[mode]).abs().log2();
            assert!(
                (rate - order).abs() < 0.25,
                "{element:?} mode {mode}: order {rate}"
            );
            // Conforming elements are too stiff, with consistent mass every frequency is too high (Rayleigh).
            assert!(fine[mode] > 0.0 || element == Element::Hex8Incompatible);
            assert!(fine[mode].abs() < 0.03);
        }
    }
}

/// k of the first torsion of an annulus that is held inside, f = u_θ(r), by integrating Bessel's equation
/// r² f″ + r f′ + (k² r² − 1) f = 0, f(a) = 0, and bisecting for a free outside, f′(b) = f(b)/b.
fn torsion_wave_number(a: f64, b: f64) -> f64 {
    let shear_outside = |k: f64| {
        let steps = 2000;
        let h = (b - a) / f64::from(steps);
        let slope = |r: f64, y: [f64; 2]| [y[1], -y[1] / r - (k * k - 1.0 / (r * r)) * y[0]];
        let plus = |y: [f64; 2], d: [f64; 2], h: f64| [y[0] + h * d[0], y[1] + h * d[1]];
        let mut y = [0.0, 1.0];
        for i in 0..steps {
            let r = a + h * f64::from(i);
            let d1 = slope(r, y);
            let d2 = slope(r + 0.5 * h, plus(y, d1, 0.5 * h));
            let d3 = slope(r + 0.5 * h, plus(y, d2, 0.5 * h));
            let d4 = slope(r + h, plus(y, d3, h));
            y = std::array::from_fn(|c| {
                y[c] + h / 6.0 * (d1[c] + 2.0 * d2[c] + 2.0 * d3[c] + d4[c])
            });
        }
        y[1] - y[0] / b
    };
    // Positive for k = 0 (f = r − a²/r), first root below that of a rod of the same length.
    let (mut low, mut high) = (0.0, 0.5 * PI / (b - a));
    assert!(shear_outside(low) > 0.0 && shear_outside(high) < 0.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if shear_outside(middle) > 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

/// A disc held at its bore: the torsional mode is exact in three dimensions, ω = c_s k.
#[test]
fn torsion_of_a_disc_held_at_its_bore() {
    let (inner, outer) = (0.02, 0.05);
    let exact = steel().lame().mu_pa / DENSITY * torsion_wave_number(inner, outer).powi(2);
    for (element, coarse, order) in [
        (Element::Hex8, [36, 6, 1], 2.0),
        (Element::Hex8Incompatible, [36, 6, 1], 2.0),
        (Element::Hex20, [24, 4, 1], 4.0),
    ] {
        let error = |counts: [usize; 3]| {
            let ring = StructuredMesh::ring(counts, [inner, outer], 0.01);
            let model = ring
                .into_model(steel(), element, |_, ends| arc_middle(ends))
                .unwrap();
            let bore = nodes_where(&model, |x| x[0].hypot(x[1]) < inner * 1.000_001);
            let fixed: Vec<usize> = bore.iter().flat_map(|n| [3 * n, 3 * n + 1]).collect();
            // Plane motion only: torsion has no displacement along z.
            let plane = (0..model.node_count()).map(|n| 3 * n + 2);
            let fixed: Vec<usize> = fixed.into_iter().chain(plane).collect();
            let dofs = DofMap::with_fixed_dofs(model.node_count(), &fixed).unwrap();
            let (system, modes) = solve(&model, &dofs, &ModeSettings::new(8));
            // The mode that turns with a field f(r) = r − a²/r about the axis.
            let turning: Vec<f64> = model
                .nodes()
                .iter()
                .flat_map(|x| {
                    let share = 1.0 - (inner / x[0].hypot(x[1])).powi(2);
                    [-x[1] * share, x[0] * share, 0.0]
                })
                .collect();
            let turning = dofs.restrict(&turning);
            let momentum = &system.m * faer::Col::from_fn(turning.len(), |i| turning[i]);
            let overlap = modes.shapes.transpose() * &momentum;
            let mode = (0..8)
                .max_by(|i, j| overlap[*i].abs().total_cmp(&overlap[*j].abs()))
                .unwrap();
            modes.omega_squared[mode] / exact - 1.0
        };
        let (first, second) = (error(coarse), error([2 * coarse[0], 2 * coarse[1], 1]));
        let rate = (first / second).abs().log2();
        assert!(
            (rate - order).abs() < 0.3,
            "{element:?}: order {rate}, {first} {second}"
        );
        assert!(second.abs() < 1e-2, "{element:?}: {second}");
    }
}

/// First bending of a slender cantilever: ω = 1.8751² √(E I/(ρ A L⁴)), twice, for a square section.
#[test]
fn bending_of_a_slender_cantilever() {
    let (length, side) = (1.0, 0.02);
    let material = Material::new(210e9, 0.0).unwrap();
    let model = straight_block([20, 1, 1], [length, side, side], material, Element::Hex20);
    let held = nodes_where(&model, |x| x[0] == 0.0);
    let dofs = DofMap::with_fixed_nodes(model.node_count(), &held).unwrap();
    let (_, modes) = solve(&model, &dofs, &ModeSettings::new(2));
    let radius_of_gyration = side / 12.0_f64.sqrt();
    let exact = 1.875_104_068_711_961_f64.powi(2) * radius_of_gyration / (length * length)
        * (210e9_f64 / DENSITY).sqrt();
    for (omega_squared, hz) in modes.omega_squared.iter().zip(modes.frequencies_hz()) {
        // Shear and rotary inertia take (h/L)² times order one, 4e-4; the mesh adds less.
        assert!((omega_squared.sqrt() / exact - 1.0).abs() < 1e-3, "{hz} Hz");
        assert!((hz * std::f64::consts::TAU / omega_squared.sqrt() - 1.0).abs() < 1e-14);
    }
    // A pair of equal frequencies: both members are found.
    assert!((modes.omega_squared[0] / modes.omega_squared[1] - 1.0).abs() < 1e-8);
}

#[test]
fn wrong_input_is_named() {
    let model = model(distorted_cube(2), Element::Hex8);
    let held = nodes_where(&model, |x| x[2] == 0.0);
    let dofs = DofMap::with_fixed_nodes(model.node_count(), &held).unwrap();
    let System { k, m } = system(&model, &dofs);
    let factor = Factor::of_model(&model, &dofs, &k).unwrap();
    let n = dofs.free_count();
    for count in [0, n + 1] {
        assert!(matches!(
            natural_modes(&k, &m, &factor, &ModeSettings::new(count)),
            Err(FeError::ModeCount { .. })
        ));
    }
    let hasty = ModeSettings {
        restarts: 0,
        tolerance: 1e-16,
        ..ModeSettings::new(3)
    };
    assert!(matches!(
        natural_modes(&k, &m, &factor, &hasty),
        Err(FeError::ModesNotConverged { wanted: 3, .. })
    ));
    let all = DofMap::all_free(model.node_count()).unwrap();
    let other = assemble_mass(&model, &all, DENSITY).unwrap();
    assert!(matches!(
        natural_modes(&k, &other, &factor, &ModeSettings::new(3)),
        Err(FeError::SizeMismatch { .. })
    ));
    assert!(matches!(
        shifted_stiffness(&k, &other, 1.0),
        Err(FeError::SizeMismatch { .. })
    ));
    // All modes of a small body.
    let every = natural_modes(&k, &m, &factor, &ModeSettings::new(n)).unwrap();
    let dense = dense_omega_squared(&System { k, m });
    for (found, expected) in every.omega_squared.iter().zip(&dense) {
        assert!((found / expected - 1.0).abs() < 1e-9);
    }
    assert_eq!(
        every.shapes,
        every.shapes.as_ref() * Mat::<f64>::identity(n, n)
    );
}
