//! Orders of convergence with a manufactured solution on distorted refinements: energy norm 1 and L2 norm 2 for linear
//! elements, 2 and 3 for quadratic ones.
//!
//! u = s (1, −0.5, 0.7) with s = sin πx sin πy sin πz on the unit cube, zero on the boundary. The body force
//! f = −(λ + μ) ∇(div u) − μ Δu is integrated against the shape functions with the points of the mass.
//! The cube is bent smoothly (same map for every refinement) so that elements are not bricks.

use crate::common;

use std::f64::consts::PI;

use common::{ELEMENTS, nodes_where, steel};
use gearmesh_fe::{
    DofMap, Element, ElementFormulas, Factor, FeModel, Material, StructuredMesh,
    assemble_stiffness, chord_middle,
};

const AMPLITUDE: [f64; 3] = [1.0, -0.5, 0.7];

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

fn bend(x: [f64; 3]) -> [f64; 3] {
    let bubble = x.iter().map(|v| (PI * v).sin()).product::<f64>();
    [
        x[0] + 0.10 * bubble,
        x[1] - 0.08 * bubble,
        x[2] + 0.06 * bubble,
    ]
}

/// The bent cube; mid-edge nodes lie on the bent edges.
fn model(n: usize, element: Element) -> FeModel {
    let mut mesh = StructuredMesh::mapped([n; 3], |x| x);
    let straight = mesh.nodes.clone();
    mesh.nodes = mesh.nodes.into_iter().map(bend).collect();
    let on_bent_edge =
        |ends: [u32; 2], _| bend(chord_middle(ends.map(|node| straight[node as usize])));
    mesh.into_model(steel(), element, on_bent_edge).unwrap()
}

/// (energy norm error, L2 error), relative to the norms of the exact solution.
fn errors(n: usize, element: Element) -> (f64, f64) {
    let model = model(n, element);
    let on_boundary = |v: &f64| v.abs() < 1e-12 || (v - 1.0).abs() < 1e-12;
    let boundary = nodes_where(&model, |x| x.iter().any(on_boundary));
    let material = steel();
    let dofs = DofMap::with_fixed_nodes(model.node_count(), &boundary).unwrap();
    let mut load = vec![0.0; model.dof_count()];
    for e in 0..model.element_count() {
        let x = model.element_coordinates(e).unwrap();
        for &(point, weight) in element.mass_points() {
            let f = body_force(element.position_at(&x, point), &material);
            let w = weight * element.jacobian_determinant(&x, point).unwrap();
            let shape = element.shape_functions(point);
            for (i, node) in model.element_nodes(e).iter().enumerate() {
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
    for e in 0..model.element_count() {
        let x = model.element_coordinates(e).unwrap();
        let hex = model.element_nodes(e);
        for &(point, weight) in element.mass_points() {
            let at = element.position_at(&x, point);
            let w = weight * element.jacobian_determinant(&x, point).unwrap();
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
            let shape = element.shape_functions(point);
            let exact = displacement(at);
            for axis in 0..3 {
                let found: f64 = (0..hex.len())
                    .map(|i| shape[i] * u[3 * hex[i] as usize + axis])
                    .sum();
                l2 += w * (found - exact[axis]).powi(2);
                l2_exact += w * exact[axis].powi(2);
            }
        }
    }
    ((energy / energy_exact).sqrt(), (l2 / l2_exact).sqrt())
}

/// What an element must show.
struct Expected {
    energy_order: i32,
    l2_order: i32,
    /// Two meshes each, the second twice as fine. Quadratic elements need six over the wave before the leading term of
    /// the error stands alone: from 4 to 8 their order is still 2.18.
    elements_per_side: &'static [[usize; 2]],
}

fn expected(element: Element) -> Expected {
    match element {
        Element::Hex8 | Element::Hex8Incompatible => Expected {
            energy_order: 1,
            l2_order: 2,
            elements_per_side: &[[4, 8], [8, 16]],
        },
        Element::Wedge6 => Expected {
            energy_order: 1,
            l2_order: 2,
            elements_per_side: &[[8, 16]],
        },
        Element::Hex20 => Expected {
            energy_order: 2,
            l2_order: 3,
            elements_per_side: &[[6, 12], [7, 14]],
        },
        Element::Tet10 | Element::Wedge15 => Expected {
            energy_order: 2,
            l2_order: 3,
            elements_per_side: &[[6, 12]],
        },
    }
}

#[test]
fn orders_are_those_of_the_polynomials() {
    for element in ELEMENTS {
        let expected = expected(element);
        for sizes in expected.elements_per_side {
            let [a, b] = sizes.map(|n| errors(n, element));
            for (name, coarse, fine, order) in [
                ("energy norm", a.0, b.0, expected.energy_order),
                ("L2", a.1, b.1, expected.l2_order),
            ] {
                let rate = (coarse / fine).log2();
                // A band of 0.08 about the limit: the coarse mesh has only a few elements over half a wave.
                assert!(
                    (rate - f64::from(order)).abs() < 0.08,
                    "{element:?}: {name} order {rate}"
                );
                assert!(coarse < 0.3, "{element:?}: {name} error {coarse}");
            }
        }
    }
}
