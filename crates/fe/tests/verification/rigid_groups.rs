//! Nodes rigid on a reference point: held they are fixed nodes, free they carry force and moment.

use crate::common;

use common::{ELEMENTS, distorted_cube, model, nodes_where};
use faer::{Col, Mat};
use gearmesh_fe::{
    DofMap, Element, Factor, FeError, FeModel, Material, RigidGroup, StructuredMesh,
    assemble_stiffness,
};

const REFERENCE: [f64; 3] = [0.3, 0.6, -0.2];

fn bottom(model: &FeModel) -> Vec<usize> {
    nodes_where(model, |x| x[2] == 0.0)
}

fn top_dofs(model: &FeModel) -> Vec<usize> {
    let top = nodes_where(model, |x| x[2] == 1.0);
    top.iter().flat_map(|n| 3 * n..3 * n + 3).collect()
}

fn group(model: &FeModel, fixed: [bool; 6]) -> RigidGroup {
    RigidGroup {
        nodes: bottom(model),
        reference_m: REFERENCE,
        fixed,
    }
}

/// Six unit loads on the reference point of the bottom, the top fixed: displacement of all degrees of freedom.
fn six_loads(model: &FeModel) -> (DofMap, Vec<Vec<f64>>, Mat<f64>) {
    let free = group(model, [false; 6]);
    let dofs = DofMap::with_rigid_groups(model.nodes(), &top_dofs(model), &[free]).unwrap();
    let k = assemble_stiffness(model, &dofs).unwrap();
    let factor = Factor::of_model(model, &dofs, &k).unwrap();
    let reference = |component| dofs.free_of_reference(0, component).unwrap();
    let mut u = Mat::zeros(dofs.free_count(), 6);
    for load in 0..6 {
        u[(reference(load), load)] = 1.0;
    }
    factor.solve_in_place(u.as_mut());
    let compliance = Mat::from_fn(6, 6, |i, j| u[(reference(i), j)]);
    let full = (0..6)
        .map(|j| dofs.expand(&u.col(j).iter().copied().collect::<Vec<_>>()))
        .collect();
    (dofs, full, compliance)
}

#[test]
fn a_held_reference_point_equals_fixed_nodes() {
    for element in ELEMENTS {
        let model = model(distorted_cube(3), element);
        let fixed = DofMap::with_fixed_nodes(model.node_count(), &bottom(&model)).unwrap();
        let held =
            DofMap::with_rigid_groups(model.nodes(), &[], &[group(&model, [true; 6])]).unwrap();
        let [a, b] = [&fixed, &held].map(|dofs| assemble_stiffness(&model, dofs).unwrap());
        assert_eq!(a.val(), b.val());
        assert_eq!(a.symbolic().row_idx(), b.symbolic().row_idx());
        let q: Vec<f64> = (0..fixed.free_count()).map(|i| (i as f64).sin()).collect();
        assert_eq!(fixed.expand(&q), held.expand(&q));
    }
}

/// Tᵀ is the transpose of T: the same work on either side.
#[test]
fn forces_and_displacements_do_the_same_work() {
    let model = model(distorted_cube(2), Element::Hex20);
    let some = [false, true, false, false, true, false];
    let dofs = DofMap::with_rigid_groups(model.nodes(), &top_dofs(&model), &[group(&model, some)])
        .unwrap();
    assert_eq!(dofs.free_count(), dofs.nodal_free_count() + 4);
    let q: Vec<f64> = (0..dofs.free_count())
        .map(|i| (1.3 * i as f64).sin())
        .collect();
    let f: Vec<f64> = (0..dofs.dof_count())
        .map(|i| (0.7 * i as f64).cos())
        .collect();
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
    let (left, right) = (dot(&f, &dofs.expand(&q)), dot(&dofs.restrict(&f), &q));
    assert!((left - right).abs() < 1e-12 * left.abs().max(1.0));
}

/// TᵀKT against the plain triple product with dense matrices.
#[test]
fn stiffness_is_the_congruent_transform() {
    for element in ELEMENTS {
        let model = model(distorted_cube(2), element);
        let some = [false, false, true, false, false, false];
        let dofs = DofMap::with_rigid_groups(
            model.nodes(),
            &top_dofs(&model)[..4],
            &[group(&model, some)],
        )
        .unwrap();
        let all = DofMap::all_free(model.node_count()).unwrap();
        let full = assemble_stiffness(&model, &all).unwrap().to_dense();
        let columns: Vec<Vec<f64>> = (0..dofs.free_count())
            .map(|j| {
                let mut unit = vec![0.0; dofs.free_count()];
                unit[j] = 1.0;
                dofs.expand(&unit)
            })
            .collect();
        let t = Mat::from_fn(dofs.dof_count(), dofs.free_count(), |i, j| columns[j][i]);
        let expected = t.transpose() * &full * &t;
        let found = assemble_stiffness(&model, &dofs).unwrap().to_dense();
        assert!((&found - &expected).norm_max() < 1e-13 * expected.norm_max());
        for i in 0..found.nrows() {
            for j in 0..i {
                assert_eq!(found[(i, j)].to_bits(), found[(j, i)].to_bits());
            }
        }
    }
}

/// Compliance of the reference point times its stiffness is the identity; the stiffness comes from prescribed rigid
/// displacements of fixed nodes and their reactions, which shares no line with the rigid group.
#[test]
fn pulling_the_reference_point_is_the_rigid_body_stiffness() {
    for element in ELEMENTS {
        let model = model(distorted_cube(3), element);
        let (_, _, compliance) = six_loads(&model);
        let n = model.node_count();
        let all = DofMap::all_free(n).unwrap();
        let full = assemble_stiffness(&model, &all).unwrap();
        let both: Vec<usize> = bottom(&model)
            .into_iter()
            .chain(nodes_where(&model, |x| x[2] == 1.0))
            .collect();
        let inner = DofMap::with_fixed_nodes(n, &both).unwrap();
        let k = assemble_stiffness(&model, &inner).unwrap();
        let factor = Factor::of_model(&model, &inner, &k).unwrap();
        // u = t + θ × r on the bottom.
        let prescribed = |component: usize| {
            let mut u = vec![0.0; 3 * n];
            for node in bottom(&model) {
                let x = model.nodes()[node];
                let r: [f64; 3] = std::array::from_fn(|a| x[a] - REFERENCE[a]);
                let (a, b) = ((component + 1) % 3, (component + 2) % 3);
                match component {
                    0..3 => u[3 * node + component] = 1.0,
                    _ => (u[3 * node + a], u[3 * node + b]) = (-r[b], r[a]),
                }
            }
            u
        };
        let stiffness = Mat::from_fn(6, 6, |i, j| {
            let mut u = prescribed(j);
            let force = &full * Col::from_fn(3 * n, |d| u[d]);
            let mut q: Vec<f64> = (0..inner.free_count())
                .map(|f| -force[inner.full_of(f)])
                .collect();
            factor.solve_slice_in_place(&mut q);
            u.iter_mut()
                .zip(inner.expand(&q))
                .for_each(|(u, inside)| *u += inside);
            let reaction = &full * Col::from_fn(3 * n, |d| u[d]);
            prescribed(i)
                .iter()
                .zip(reaction.iter())
                .map(|(a, b)| a * b)
                .sum::<f64>()
        });
        let product = &compliance * &stiffness;
        for i in 0..6 {
            for j in 0..6 {
                let identity = f64::from(u8::from(i == j));
                assert!(
                    (product[(i, j)] - identity).abs() < 1e-10,
                    "{element:?} {i} {j}"
                );
            }
        }
    }
}

/// The fixed top takes up what is put on the reference point, force and moment.
#[test]
fn forces_balance() {
    let model = model(distorted_cube(3), Element::Hex20);
    let (_, displacements, _) = six_loads(&model);
    let all = DofMap::all_free(model.node_count()).unwrap();
    let full = assemble_stiffness(&model, &all).unwrap();
    let top = nodes_where(&model, |x| x[2] == 1.0);
    for (load, u) in displacements.iter().enumerate() {
        let force = &full * Col::from_fn(u.len(), |d| u[d]);
        let mut sum = [0.0; 6];
        for &node in &top {
            let f: [f64; 3] = std::array::from_fn(|a| force[3 * node + a]);
            let r: [f64; 3] = std::array::from_fn(|a| model.nodes()[node][a] - REFERENCE[a]);
            for a in 0..3 {
                let (b, c) = ((a + 1) % 3, (a + 2) % 3);
                sum[a] += f[a];
                sum[3 + a] += r[b] * f[c] - r[c] * f[b];
            }
        }
        for (component, found) in sum.iter().enumerate() {
            let expected = -f64::from(u8::from(component == load));
            assert!(
                (found - expected).abs() < 1e-10,
                "{load} {component}: {found}"
            );
        }
    }
}

/// A rod with ν = 0 pulled at a rigid end: F = (E A/L) u to rounding.
#[test]
fn a_rod_pulled_at_its_rigid_end() {
    let (length, side, young) = (0.5, 0.1, 210e9);
    let mesh = StructuredMesh::block([2, 2, 4], [side, side, length]);
    let end = mesh.nodes_where(|x| x[2] == 0.0);
    let held: Vec<usize> = mesh
        .nodes_where(|x| x[2] == length)
        .iter()
        .flat_map(|n| 3 * n..3 * n + 3)
        .collect();
    let material = Material::new(young, 0.0).unwrap();
    let model = FeModel::new(mesh.nodes, mesh.hexes, material, Element::Hex8).unwrap();
    let group = RigidGroup {
        nodes: end,
        reference_m: [0.5 * side, 0.5 * side, 0.0],
        fixed: [false; 6],
    };
    let dofs = DofMap::with_rigid_groups(model.nodes(), &held, &[group]).unwrap();
    let k = assemble_stiffness(&model, &dofs).unwrap();
    let mut u = vec![0.0; dofs.free_count()];
    let along = dofs.free_of_reference(0, 2).unwrap();
    u[along] = 1000.0;
    Factor::of_model(&model, &dofs, &k)
        .unwrap()
        .solve_slice_in_place(&mut u);
    let exact = 1000.0 * length / (young * side * side);
    assert!((u[along] / exact - 1.0).abs() < 1e-11);
}

#[test]
fn a_free_reference_point_holds_nothing() {
    let model = model(distorted_cube(3), Element::Hex8);
    let dofs = DofMap::with_rigid_groups(model.nodes(), &[], &[group(&model, [false; 6])]).unwrap();
    let k = assemble_stiffness(&model, &dofs).unwrap();
    assert!(matches!(
        Factor::of_model(&model, &dofs, &k),
        Err(FeError::NotPositiveDefinite { .. })
    ));
}

#[test]
fn a_node_that_is_tied_twice_is_named() {
    let model = model(distorted_cube(2), Element::Hex8);
    let node = bottom(&model)[1];
    let once = group(&model, [false; 6]);
    for (fixed, groups) in [
        (vec![3 * node + 1], vec![once.clone()]),
        (vec![], vec![once.clone(), once.clone()]),
    ] {
        let error = DofMap::with_rigid_groups(model.nodes(), &fixed, &groups).unwrap_err();
        assert!(matches!(error, FeError::RigidNodeTwice { .. }), "{error}");
    }
    let mut outside = once;
    outside.nodes = vec![1000];
    assert!(matches!(
        DofMap::with_rigid_groups(model.nodes(), &[], &[outside]),
        Err(FeError::DofOutOfRange { .. })
    ));
}
