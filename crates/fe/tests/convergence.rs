//! Orders of convergence with a manufactured solution on distorted refinements: energy norm 1, L2 norm 2.
//!
//! u = s (1, −0.5, 0.7) with s = sin πx sin πy sin πz on the unit cube, zero on the boundary. The body force
//! f = −(λ + μ) ∇(div u) − μ Δu is integrated against the trilinear functions with 3x3x3 Gauss points.
//! The cube is bent smoothly (same map for every refinement) so that elements are not bricks.
#![allow(clippy::unwrap_used)]

mod common;

use std::f64::consts::PI;

use common::{ELEMENTS, model, steel};
use gearmesh_fe::{
    DofMap, Factor, FeModel, HexElement, Material, StructuredMesh, assemble_stiffness,
    point_gradients, position_at, shape_functions,
};

const AMPLITUDE: [f64; 3] = [1.0, -0.5, 0.7];
const GAUSS_3: [(f64, f64); 3] = [
    (-0.774_596_669_241_483_4, 5.0 / 9.0),
    (0.0, 8.0 / 9.0),
    (0.774_596_669_241_483_4, 5.0 / 9.0),
];

fn rule() -> Vec<([f64; 3], f64)> {
    let mut points = Vec::new();
    for (x, wx) in GAUSS_3 {
        for (y, wy) in GAUSS_3 {
            for (z, wz) in GAUSS_3 {
                points.push(([x, y, z], wx * wy * wz));
            }
        }
    }
    points
}

fn displacement(x: [f64; 3]) -> [f64; 3] {
    let s: f64 = x.iter().map(|v| (PI * v).sin()).product();
    AMPLITUDE.map(|a| a * s)
}

/// ∂s/∂x_i.
fn gradient(x: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| {
        (0..3)
            .map(|k| {
                if k == i {
                    PI * (PI * x[k]).cos()
                } else {
                    (PI * x[k]).sin()
                }
            })
            .product()
    })
}

fn strain(x: [f64; 3]) -> [f64; 6] {
    let g = gradient(x);
    let a = AMPLITUDE;
    [
        a[0] * g[0],
        a[1] * g[1],
        a[2] * g[2],
        a[0] * g[1] + a[1] * g[0],
        a[1] * g[2] + a[2] * g[1],
        a[0] * g[2] + a[2] * g[0],
    ]
}

fn body_force(x: [f64; 3], material: &Material) -> [f64; 3] {
    let lame = material.lame();
    let second = |i: usize, j: usize| -> f64 {
        if i == j {
            return -PI * PI * x.iter().map(|v| (PI * v).sin()).product::<f64>();
        }
        (0..3)
            .map(|k| {
                if k == i || k == j {
                    PI * (PI * x[k]).cos()
                } else {
                    (PI * x[k]).sin()
                }
            })
            .product()
    };
    std::array::from_fn(|i| {
        let grad_div: f64 = (0..3).map(|j| AMPLITUDE[j] * second(i, j)).sum();
        let laplace: f64 = AMPLITUDE[i] * (0..3).map(|j| second(j, j)).sum::<f64>();
        -(lame.lambda_pa + lame.mu_pa) * grad_div - lame.mu_pa * laplace
    })
}

fn mesh(n: usize) -> StructuredMesh {
    StructuredMesh::mapped([n; 3], |x| {
        let bubble = x.iter().map(|v| (PI * v).sin()).product::<f64>();
        [
            x[0] + 0.10 * bubble,
            x[1] - 0.08 * bubble,
            x[2] + 0.06 * bubble,
        ]
    })
}

/// (energy norm error, L2 error), relative to the norms of the exact solution.
fn errors(n: usize, element: HexElement) -> (f64, f64) {
    let mesh = mesh(n);
    let on_boundary = |v: &f64| v.abs() < 1e-12 || (v - 1.0).abs() < 1e-12;
    let boundary = mesh.nodes_where(|x| x.iter().any(on_boundary));
    let model: FeModel = model(mesh, element);
    let material = steel();
    let dofs = DofMap::with_fixed_nodes(model.node_count(), &boundary).unwrap();
    let mut load = vec![0.0; model.dof_count()];
    for e in 0..model.hexes().len() {
        let x = model.element_coordinates(e).unwrap();
        for (point, weight) in rule() {
            let f = body_force(position_at(&x, point), &material);
            let w = weight * point_gradients(&x, point).unwrap().determinant;
            let shape = shape_functions(point);
            for (i, node) in model.hexes()[e].iter().enumerate() {
                for axis in 0..3 {
                    load[3 * *node as usize + axis] += w * shape[i] * f[axis];
                }
            }
        }
    }
    let k = assemble_stiffness(&model, &dofs).unwrap();
    let mut u = dofs.restrict(&load);
    Factor::of_model(&model, &dofs, &k)
        .unwrap()
        .solve_slice_in_place(&mut u);
    let u = dofs.expand(&u);

    let (mut energy, mut energy_exact, mut l2, mut l2_exact) = (0.0, 0.0, 0.0, 0.0);
    for e in 0..model.hexes().len() {
        let x = model.element_coordinates(e).unwrap();
        let hex = model.hexes()[e];
        for (point, weight) in rule() {
            let at = position_at(&x, point);
            let w = weight * point_gradients(&x, point).unwrap().determinant;
            let (exact, found) = (strain(at), model.strain(e, point, &u).unwrap());
            let difference: [f64; 6] = std::array::from_fn(|i| found[i] - exact[i]);
            let work = |s: &[f64; 6]| {
                material
                    .stress(s)
                    .iter()
                    .zip(s)
                    .map(|(a, b)| a * b)
                    .sum::<f64>()
            };
            energy += w * work(&difference);
            energy_exact += w * work(&exact);
            let shape = shape_functions(point);
            let exact = displacement(at);
            for axis in 0..3 {
                let found: f64 = (0..8)
                    .map(|i| shape[i] * u[3 * hex[i] as usize + axis])
                    .sum();
                l2 += w * (found - exact[axis]).powi(2);
                l2_exact += w * exact[axis].powi(2);
            }
        }
    }
    ((energy / energy_exact).sqrt(), (l2 / l2_exact).sqrt())
}

#[test]
fn orders_are_one_in_energy_and_two_in_l2() {
    for element in ELEMENTS {
        let [coarse, middle, fine] = [4, 8, 16].map(|n| errors(n, element));
        // A band of 0.08 about the limit: the first mesh has only four elements over half a wave.
        for (a, b) in [(coarse, middle), (middle, fine)] {
            let (energy_rate, l2_rate) = ((a.0 / b.0).log2(), (a.1 / b.1).log2());
            assert!(
                (energy_rate - 1.0).abs() < 0.08,
                "{element:?}: energy norm order {energy_rate}"
            );
            assert!(
                (l2_rate - 2.0).abs() < 0.08,
                "{element:?}: L2 order {l2_rate}"
            );
        }
        assert!(fine.0 < 0.1 && fine.1 < 0.01, "{element:?}: {fine:?}");
    }
}
