//! Zero-energy modes and invariance: what a solid must not feel.

use crate::common;

use common::{
    ELEMENTS, distorted_cube, distorted_element, model, nodes_where, rotate, rotation, steel,
};
use faer::{Mat, Side};
use gearmesh_fe::{DofMap, Element, ElementFormulas, Factor, FeError, assemble_stiffness};

fn stiffness(element: Element, x: &[[f64; 3]]) -> Mat<f64> {
    let k = element.stiffness(x, &steel()).unwrap();
    Mat::from_fn(k.size(), k.size(), |i, j| k[(i, j)])
}

/// Number of eigenvalues below 1e-10 of the largest; asserts none is negative and the others are well above.
fn zero_modes(k: &Mat<f64>) -> usize {
    let eigenvalues = k.self_adjoint_eigenvalues(Side::Lower).unwrap();
    let largest = eigenvalues.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    assert!(eigenvalues.iter().all(|v| *v > -1e-12 * largest));
    // The zero ones are rounding, near 1e-16; the lowest elastic one of these bodies is above 1e-4.
    assert!(
        eigenvalues
            .iter()
            .all(|v| *v < 1e-12 * largest || *v > 1e-5 * largest)
    );
    eigenvalues.iter().filter(|v| **v < 1e-10 * largest).count()
}

#[test]
fn one_distorted_element_has_six_zero_modes() {
    for element in ELEMENTS {
        let k = stiffness(element, &distorted_element(element, 0.5));
        assert_eq!(zero_modes(&k), 6, "{element:?}");
    }
}

#[test]
fn a_free_mesh_has_six_zero_modes() {
    for element in ELEMENTS {
        let model = model(distorted_cube(3), element);
        let k = assemble_stiffness(&model, &DofMap::all_free(model.node_count()).unwrap()).unwrap();
        assert_eq!(zero_modes(&k.to_dense()), 6, "{element:?}");
    }
}

/// A body held too little is refused, not solved: free, and pinned at one edge only (still free to turn).
#[test]
fn a_body_that_is_not_held_is_named() {
    for element in ELEMENTS {
        let model = model(distorted_cube(4), element);
        let edge = nodes_where(&model, |x| x[0] == 0.0 && x[1] == 0.0);
        for held in [vec![], edge] {
            let dofs = DofMap::with_fixed_nodes(model.node_count(), &held).unwrap();
            let k = assemble_stiffness(&model, &dofs).unwrap();
            let error = Factor::of_model(&model, &dofs, &k).unwrap_err();
            assert!(matches!(error, FeError::NotPositiveDefinite { .. }));
            assert!(error.to_string().contains("not held"));
        }
    }
}

/// K of the rotated element is the rotated K: R K Rᵀ.
#[test]
fn stiffness_turns_with_the_element() {
    let r = rotation([1.0, -2.0, 0.5], 0.9);
    for element in ELEMENTS {
        let x = distorted_element(element, 0.5);
        let k = stiffness(element, &x);
        let turned: Vec<_> = x.iter().map(|x| rotate(&r, *x)).collect();
        let turned = stiffness(element, &turned);
        let n = k.nrows();
        let big = Mat::from_fn(
            n,
            n,
            |i, j| if i / 3 == j / 3 { r[i % 3][j % 3] } else { 0.0 },
        );
        let difference = turned - &big * &k * big.transpose();
        assert!(difference.norm_max() < 1e-13 * k.norm_max(), "{element:?}");
    }
}

/// Rigid motion, linearised rotation included, gives no strain anywhere in the element.
#[test]
fn rigid_motion_gives_no_strain() {
    for element in ELEMENTS {
        let x = distorted_element(element, 0.5);
        let operator = element
            .strain_operator(&x, &steel(), [0.3, 0.2, 0.4])
            .unwrap();
        for axis in 0..3 {
            let turn = |p: [f64; 3]| -> [f64; 3] {
                let (a, b) = ((axis + 1) % 3, (axis + 2) % 3);
                let mut u = [0.0; 3];
                u[a] = -p[b];
                u[b] = p[a];
                u
            };
            let shift = std::array::from_fn(|i| f64::from(u8::from(i == axis)));
            let turned: Vec<_> = x.iter().map(|p| turn(*p)).collect();
            for field in [turned, vec![shift; x.len()]] {
                for row in &operator {
                    let strain: f64 = row
                        .iter()
                        .zip(field.as_flattened())
                        .map(|(b, u)| b * u)
                        .sum();
                    assert!(strain.abs() < 1e-13, "{element:?}");
                }
            }
        }
    }
}

/// Displacement of a loaded body is inversely proportional to Young's modulus, by the exact factor 2.
#[test]
fn half_the_modulus_gives_twice_the_displacement() {
    let solve = |young: f64| {
        let mesh = distorted_cube(2);
        let held = mesh.nodes_where(|x| x[2] == 0.0);
        let material = gearmesh_fe::Material::new(young, 0.3).unwrap();
        let model = gearmesh_fe::FeModel::new(mesh.nodes, mesh.hexes, material, Element::default())
            .unwrap();
        let dofs = DofMap::with_fixed_nodes(model.node_count(), &held).unwrap();
        let k = assemble_stiffness(&model, &dofs).unwrap();
        let mut u = vec![0.0; dofs.free_count()];
        u[dofs.free_count() - 2] = 1000.0;
        Factor::of_model(&model, &dofs, &k)
            .unwrap()
            .solve_slice_in_place(&mut u);
        u
    };
    let (stiff, soft) = (solve(200e9), solve(100e9));
    let scale = soft.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    for (a, b) in stiff.iter().zip(&soft) {
        assert!((2.0 * a - b).abs() < 1e-12 * scale);
    }
}
