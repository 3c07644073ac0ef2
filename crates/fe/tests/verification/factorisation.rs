//! Factor and solve: residual, determinism, columns that do not influence each other, node renumbering.

use crate::common;

use common::{distorted_cube, model};
use faer::Mat;
use gearmesh_fe::{
    DofMap, DofOrdering, Element, ElementFormulas, Factor, FeError, FeModel, StructuredMesh,
    assemble_stiffness,
};
use proptest::prelude::*;

fn held_cube(n: usize) -> (FeModel, DofMap) {
    let mesh = distorted_cube(n);
    let held = mesh.nodes_where(|x| x[2] == 0.0);
    let model = model(mesh, Element::Hex8Incompatible);
    let dofs = DofMap::with_fixed_nodes(model.node_count(), &held).unwrap();
    (model, dofs)
}

fn right_hand_sides(rows: usize, columns: usize) -> Mat<f64> {
    Mat::from_fn(rows, columns, |i, j| ((i * 31 + j * 17) % 23) as f64 - 11.0)
}

#[test]
fn residual_is_rounding() {
    let (model, dofs) = held_cube(6);
    let k = assemble_stiffness(&model, &dofs).unwrap();
    let b = right_hand_sides(dofs.free_count(), 70);
    for ordering in [
        DofOrdering::natural(dofs.free_count()),
        DofOrdering::nested_dissection(&gearmesh_fe::NodeGraph::new(&model, &dofs).unwrap(), &dofs)
            .unwrap(),
    ] {
        let mut x = b.clone();
        Factor::new(&k, ordering)
            .unwrap()
            .solve_in_place(x.as_mut());
        assert!((&k * &x - &b).norm_l2() < 1e-12 * b.norm_l2());
    }
}

#[test]
fn solution_equals_that_of_a_dense_solver() {
    use faer::prelude::Solve;
    let (model, dofs) = held_cube(3);
    let k = assemble_stiffness(&model, &dofs).unwrap();
    let b = right_hand_sides(dofs.free_count(), 3);
    let mut x = b.clone();
    Factor::of_model(&model, &dofs, &k)
        .unwrap()
        .solve_in_place(x.as_mut());
    let dense = k.to_dense().partial_piv_lu().solve(&b);
    assert!((&x - &dense).norm_l2() < 1e-12 * dense.norm_l2());
}

#[test]
fn dissection_fills_less_than_the_natural_order() {
    let (model, dofs) = held_cube(10);
    let k = assemble_stiffness(&model, &dofs).unwrap();
    let dissected = Factor::of_model(&model, &dofs, &k).unwrap().info();
    let natural = Factor::new(&k, DofOrdering::natural(dofs.free_count()))
        .unwrap()
        .info();
    assert!(dissected.nnz_l < natural.nnz_l);
    assert!(dissected.flops < natural.flops);
    // L holds at least the lower triangle of K.
    assert!(dissected.nnz_l >= (dissected.nnz_k + dissected.dofs) / 2);
    assert!(dissected.smallest_relative_pivot > 1e-6 && dissected.smallest_relative_pivot <= 1.0);
}

#[test]
fn a_column_depends_neither_on_threads_nor_on_its_neighbours() {
    let (model, dofs) = held_cube(6);
    let k = assemble_stiffness(&model, &dofs).unwrap();
    let factor = Factor::of_model(&model, &dofs, &k).unwrap();
    let b = right_hand_sides(dofs.free_count(), 96);
    let in_pool = |threads: usize| {
        rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap()
            .install(|| {
                let mut x = b.clone();
                factor.solve_in_place(x.as_mut());
                x
            })
    };
    let (one, three) = (in_pool(1), in_pool(3));
    assert_eq!(one, three);
    // The same load in another place among 32 columns.
    let mut swapped = Mat::from_fn(dofs.free_count(), 32, |i, j| b[(i, 31 - j)]);
    factor.solve_in_place(swapped.as_mut());
    let scale = one.norm_max();
    for j in 0..32 {
        for i in 0..dofs.free_count() {
            assert!((swapped[(i, j)] - one[(i, 31 - j)]).abs() < 1e-14 * scale);
        }
    }
}

#[test]
fn symbolic_part_serves_another_material_and_element_only_of_the_same_pattern() {
    let (model, dofs) = held_cube(4);
    let k = assemble_stiffness(&model, &dofs).unwrap();
    let symbolic = Factor::of_model(&model, &dofs, &k)
        .unwrap()
        .symbolic()
        .clone();
    let plain = model.with_element(Element::Hex8).unwrap();
    let k_plain = assemble_stiffness(&plain, &dofs).unwrap();
    let b = right_hand_sides(dofs.free_count(), 1);
    let mut x = b.clone();
    Factor::from_symbolic(symbolic.clone(), &k_plain)
        .unwrap()
        .solve_in_place(x.as_mut());
    assert!((&k_plain * &x - &b).norm_l2() < 1e-12 * b.norm_l2());

    let (other, other_dofs) = held_cube(3);
    let k_other = assemble_stiffness(&other, &other_dofs).unwrap();
    assert!(matches!(
        Factor::from_symbolic(symbolic, &k_other),
        Err(FeError::PatternChanged { .. })
    ));
    assert!(matches!(
        Factor::new(&k_other, DofOrdering::natural(5)),
        Err(FeError::SizeMismatch { .. })
    ));
}

/// Work of the load equals twice the strain energy.
#[test]
fn work_equals_twice_the_strain_energy() {
    for element in common::ELEMENTS {
        check_work(element);
    }
}

fn check_work(element: Element) {
    let model = model(distorted_cube(4), element);
    let held = common::nodes_where(&model, |x| x[2] == 0.0);
    let dofs = DofMap::with_fixed_nodes(model.node_count(), &held).unwrap();
    let k = assemble_stiffness(&model, &dofs).unwrap();
    let b: Vec<f64> = (0..dofs.free_count())
        .map(|i| ((i * 7) % 13) as f64 - 6.0)
        .collect();
    let mut x = b.clone();
    Factor::of_model(&model, &dofs, &k)
        .unwrap()
        .solve_slice_in_place(&mut x);
    let work: f64 = x.iter().zip(&b).map(|(u, f)| u * f).sum();
    let full = dofs.expand(&x);
    let mut twice_energy = 0.0;
    for e in 0..model.element_count() {
        let coordinates = model.element_coordinates(e).unwrap();
        for (point, weight) in element.integration_points() {
            let weight = weight * element.jacobian_determinant(&coordinates, *point).unwrap();
            let strain = model.strain(e, *point, &full).unwrap();
            let stress = model.material().stress(&strain);
            twice_energy += weight * strain.iter().zip(stress).map(|(a, b)| a * b).sum::<f64>();
        }
    }
    assert!((work - twice_energy).abs() < 1e-11 * work);
}

/// End displacements of a loaded block whose nodes carry the numbers `number[i]`.
fn solve_renumbered(mesh: &StructuredMesh, number: &[usize]) -> Vec<f64> {
    let mut nodes = vec![[0.0; 3]; number.len()];
    for (i, x) in mesh.nodes.iter().enumerate() {
        nodes[number[i]] = *x;
    }
    let hexes = mesh
        .hexes
        .iter()
        .map(|hex| hex.map(|n| number[n as usize] as u32))
        .collect();
    let held: Vec<usize> = mesh
        .nodes_where(|x| x[2] == 0.0)
        .into_iter()
        .map(|n| number[n])
        .collect();
    let model = FeModel::new(nodes, hexes, common::steel(), Element::Hex8Incompatible).unwrap();
    let dofs = DofMap::with_fixed_nodes(model.node_count(), &held).unwrap();
    let k = assemble_stiffness(&model, &dofs).unwrap();
    let mut load = vec![0.0; model.dof_count()];
    for (i, n) in number.iter().enumerate() {
        for axis in 0..3 {
            load[3 * n + axis] = ((3 * i + axis) % 7) as f64 - 3.0;
        }
    }
    let mut u = dofs.restrict(&load);
    Factor::of_model(&model, &dofs, &k)
        .unwrap()
        .solve_slice_in_place(&mut u);
    let full = dofs.expand(&u);
    number
        .iter()
        .flat_map(|n| full[3 * n..3 * n + 3].to_vec())
        .collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    #[test]
    fn node_numbers_do_not_matter(
        number in Just((0..125).collect::<Vec<usize>>()).prop_shuffle()
    ) {
        let mesh = distorted_cube(4);
        let natural: Vec<usize> = (0..125).collect();
        let (a, b) = (solve_renumbered(&mesh, &natural), solve_renumbered(&mesh, &number));
        let scale = a.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
        for (x, y) in a.iter().zip(&b) {
            // Other summation and elimination order: rounding times the condition of a small cube.
            prop_assert!((x - y).abs() < 1e-11 * scale);
        }
    }

    /// Any affinely stretched and sheared block passes the symmetric, positive solve: energy is positive.
    #[test]
    fn energy_is_positive_for_any_load(seed in 0u64..1000, stretch in 0.2f64..5.0, shear in -0.8f64..0.8) {
        let mesh = StructuredMesh::mapped([3, 2, 2], |[x, y, z]| [stretch * x + shear * z, y, z]);
        let held = mesh.nodes_where(|x| x[2] == 0.0);
        let model = model(mesh, Element::Hex8Incompatible);
        let dofs = DofMap::with_fixed_nodes(model.node_count(), &held).unwrap();
        let k = assemble_stiffness(&model, &dofs).unwrap();
        let factor = Factor::of_model(&model, &dofs, &k).unwrap();
        let f: Vec<f64> = (0..dofs.free_count()).map(|i| ((i as f64 + 1.0) * (seed as f64 + 0.5)).sin()).collect();
        let mut u = f.clone();
        factor.solve_slice_in_place(&mut u);
        prop_assert!(u.iter().zip(&f).map(|(a, b)| a * b).sum::<f64>() > 0.0);
    }
}
