//! What every element must do: nodal shape functions, their derivatives, closed faces, stiffness, volume.

use gearmesh_fe::{CORNERS, Element, ElementError, ElementFormulas, Material, WeightedPoint};

/// A distorted element; its edges are bent where it has nodes on them.
fn distorted(element: Element) -> Vec<[f64; 3]> {
    let moved = |k: usize| 0.06 * (1.7 * k as f64 + 0.4).sin();
    let nodes = element.natural_nodes().iter().enumerate();
    nodes
        .map(|(i, x)| std::array::from_fn(|axis| 0.01 * (x[axis] + moved(3 * i + axis))))
        .collect()
}

/// Conformance of every element: N_i is 1 at node i and 0 at the others, the N sum to 1, and the corners' mean is
/// the centre.
#[test]
fn shape_functions_are_nodal_and_sum_to_one() {
    for element in Element::ALL {
        for (i, node) in element.natural_nodes().iter().enumerate() {
            for (j, value) in element.shape_functions(*node).iter().enumerate() {
                assert!(
                    (value - f64::from(u8::from(i == j))).abs() < 1e-15,
                    "{element:?}"
                );
            }
        }
        let sum: f64 = element.shape_functions([0.3, 0.1, -0.7]).iter().sum();
        assert!((sum - 1.0).abs() < 1e-14);
        let corners = element.cell().corner_count();
        for axis in 0..3 {
            let nodes = &element.natural_nodes()[..corners];
            let mean = nodes.iter().map(|x| x[axis]).sum::<f64>() / corners as f64;
            assert!((mean - element.centre()[axis]).abs() < 1e-15);
        }
    }
}

/// Every quadratic of the three coordinates, and ξ²η besides, is a sum of shape functions.
#[test]
fn quadratics_are_reproduced() {
    let functions: [fn([f64; 3]) -> f64; 11] = [
        |_| 1.0,
        |x| x[0],
        |x| x[1],
        |x| x[2],
        |x| x[0] * x[0],
        |x| x[1] * x[1],
        |x| x[2] * x[2],
        |x| x[0] * x[1],
        |x| x[1] * x[2],
        |x| x[0] * x[2],
        |x| x[0] * x[0] * x[1],
    ];
    let at = [0.3, -0.7, 0.1];
    let n = Element::Hex20.shape_functions(at);
    for f in functions {
        let nodes = Element::Hex20.natural_nodes().iter();
        let sum: f64 = n.iter().zip(nodes).map(|(n, x)| n * f(*x)).sum();
        assert!((sum - f(at)).abs() < 1e-14);
    }
}

/// No shape function has a third derivative along one axis: rounding only, about 1e-16/step.
#[test]
fn natural_gradients_equal_central_differences() {
    let (at, step) = ([0.2, 0.3, 0.25], 1e-5);
    for element in Element::ALL {
        let gradients = element.natural_gradients(at);
        for k in 0..3 {
            let (mut plus, mut minus) = (at, at);
            plus[k] += step;
            minus[k] -= step;
            let values = [plus, minus].map(|at| element.shape_functions(at));
            for (i, gradient) in gradients.iter().enumerate() {
                let difference = (values[0][i] - values[1][i]) / (2.0 * step);
                assert!((gradient[k] - difference).abs() < 1e-10, "{element:?}");
            }
        }
    }
}

/// Zero eigenvalues of Σ w |J| Bᵀ D B over the points of a rule.
fn zero_modes(element: Element, rule: &[WeightedPoint]) -> usize {
    let material = Material::new(210e9, 0.3).unwrap();
    let x = distorted(element);
    let k = energy(element, &x, &material, rule);
    let n = 3 * element.node_count();
    let dense = faer::Mat::from_fn(n, n, |i, j| k[i * n + j]);
    let eigenvalues = dense.self_adjoint_eigenvalues(faer::Side::Lower).unwrap();
    let largest = eigenvalues.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    let zeros = eigenvalues.iter().filter(|v| v.abs() < 1e-10 * largest);
    zeros.count()
}

/// The test of six zero modes can fail. One point in a trilinear hexahedron adds twelve hourglass modes; 2×2×2 points
/// in a quadratic one give 48 strains for 60 − 6 deformations: six too many. The full rules have none.
#[test]
fn reduced_quadrature_has_zero_modes_too_many() {
    let (eight, full) = (
        Element::Hex8.integration_points(),
        Element::Hex20.integration_points(),
    );
    assert_eq!(zero_modes(Element::Hex8, &[([0.0; 3], 8.0)]), 18);
    assert_eq!(zero_modes(Element::Hex8, eight), 6);
    assert_eq!(zero_modes(Element::Hex20, eight), 12);
    assert_eq!(zero_modes(Element::Hex20, full), 6);
}

#[test]
fn an_inside_out_element_is_refused() {
    let mut x = CORNERS;
    x.rotate_left(4);
    assert!(matches!(
        Element::Hex8.jacobian_determinant(&x, [0.0; 3]),
        Err(ElementError::JacobianNotPositive { .. })
    ));
}

/// The Jacobian is the derivative of the position: its determinant equals that of central differences.
#[test]
fn gradients_equal_central_differences() {
    let step = 1e-5;
    for element in Element::ALL {
        let x = distorted(element);
        let at = [0.2, 0.3, 0.25];
        let column = |k: usize| -> [f64; 3] {
            let (mut plus, mut minus) = (at, at);
            plus[k] += step;
            minus[k] -= step;
            let (p, m) = (
                element.position_at(&x, plus),
                element.position_at(&x, minus),
            );
            std::array::from_fn(|i| (p[i] - m[i]) / (2.0 * step))
        };
        let [a, b, c] = [column(0), column(1), column(2)];
        let determinant = a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0])
            + a[2] * (b[0] * c[1] - b[1] * c[0]);
        let found = element.jacobian_determinant(&x, at).unwrap();
        // No third derivative along one axis: rounding only, about 1e-16/step.
        assert!((found / determinant - 1.0).abs() < 1e-9, "{element:?}");
        let material = Material::new(210e9, 0.3).unwrap();
        // Each column of the strain operator is the gradient of its shape function: read from the field x_j.
        let b = element.strain_operator(&x, &material, at).unwrap();
        for axis in 0..3 {
            let stretch: f64 = (0..x.len())
                .map(|i| b[axis][3 * i + axis] * x[i][axis])
                .sum();
            assert!((stretch - 1.0).abs() < 1e-12);
        }
    }
}

/// The faces close the element and face outwards: the volume is ∮ x·n dA/3, here by the corners' polygons.
#[test]
fn faces_are_closed_and_face_outwards() {
    for element in Element::ALL {
        let x = element.natural_nodes();
        let mut flux = 0.0;
        let mut edges = std::collections::BTreeMap::<[usize; 2], i32>::new();
        for face in element.faces() {
            let corners = if matches!(face.len(), 3 | 6) { 3 } else { 4 };
            for k in 0..corners {
                let (a, b) = (face[k], face[(k + 1) % corners]);
                *edges.entry([a.min(b), a.max(b)]).or_default() += if a < b { 1 } else { -1 };
                if face.len() > corners {
                    let middle = x[face[corners + k]];
                    for axis in 0..3 {
                        assert!((middle[axis] - 0.5 * (x[a][axis] + x[b][axis])).abs() < 1e-15);
                    }
                }
            }
            for k in 1..corners - 1 {
                let [p, q, r] = [x[face[0]], x[face[k]], x[face[k + 1]]];
                flux += p[0] * (q[1] * r[2] - q[2] * r[1]) - p[1] * (q[0] * r[2] - q[2] * r[0])
                    + p[2] * (q[0] * r[1] - q[1] * r[0]);
            }
        }
        // Every edge is run through once in each direction.
        assert!(edges.values().all(|sum| *sum == 0), "{element:?}");
        let volume: f64 = element.integration_points().iter().map(|p| p.1).sum();
        assert!((flux / 6.0 - volume).abs() < 1e-14, "{element:?}");
    }
}

/// Σ w |J| Bᵀ D B over the points of a rule, row by row.
fn energy(
    element: Element,
    x: &[[f64; 3]],
    material: &Material,
    rule: &[WeightedPoint],
) -> Vec<f64> {
    let n = 3 * element.node_count();
    let mut energy = vec![0.0; n * n];
    for (point, weight) in rule {
        let b = element.strain_operator(x, material, *point).unwrap();
        let w = weight * element.jacobian_determinant(x, *point).unwrap();
        for j in 0..n {
            let stress = material.stress(&std::array::from_fn(|r| b[r][j]));
            for i in 0..n {
                energy[i * n + j] += w * (0..6).map(|r| b[r][i] * stress[r]).sum::<f64>();
            }
        }
    }
    energy
}

/// Conformance of every element: K = Σ |J| Bᵀ D B with its own strain operator. For the incompatible element this
/// ties strain recovery to the condensed stiffness.
#[test]
fn stiffness_is_the_energy_of_the_strain_operator() {
    let material = Material::new(210e9, 0.3).unwrap();
    for element in Element::ALL {
        let x = distorted(element);
        let k = element.stiffness(&x, &material).unwrap();
        let n = k.size();
        assert_eq!(n, 3 * element.node_count());
        let energy = energy(element, &x, &material, element.integration_points());
        let largest = energy.iter().fold(0.0_f64, |most, e| most.max(e.abs()));
        for i in 0..n {
            for j in 0..n {
                assert!(
                    (k[(i, j)] - energy[i * n + j]).abs() < 1e-13 * largest,
                    "{element:?} {i} {j}"
                );
            }
        }
    }
}

/// The modes only ever soften: K_hex8 − K_incompatible is positive semidefinite, here on the diagonal.
#[test]
fn incompatible_modes_soften() {
    let material = Material::new(210e9, 0.3).unwrap();
    let x = distorted(Element::Hex8);
    let plain = Element::Hex8.stiffness(&x, &material).unwrap();
    let soft = Element::Hex8Incompatible.stiffness(&x, &material).unwrap();
    for i in 0..24 {
        assert!(soft[(i, i)] < plain[(i, i)]);
    }
}

/// The frustum of the reference shape, its section scaled to one half from bottom to top: ∫ (3/4 − t/4)² dt over
/// −1 < t < 1 is 7/6 of a section for prisms. Straight edges: exact.
#[test]
fn volume_of_the_reference_shape_and_of_a_frustum() {
    for element in Element::ALL {
        let nodes = element.natural_nodes();
        let whole: f64 = element.mass_points().iter().map(|p| p.1).sum();
        assert!((element.volume(nodes).unwrap() / whole - 1.0).abs() < 1e-14);
        if element == Element::Tet10 {
            continue;
        }
        let frustum: Vec<_> = nodes
            .iter()
            .map(|c| {
                let scale = 0.75 - 0.25 * c[2];
                [scale * c[0], scale * c[1], c[2]]
            })
            .collect();
        let expected = 7.0 / 12.0 * whole;
        assert!((element.volume(&frustum).unwrap() / expected - 1.0).abs() < 1e-13);
    }
}

#[test]
fn another_number_of_nodes_is_refused() {
    assert_eq!(
        Element::Hex20.volume(&CORNERS),
        Err(ElementError::NodeCount {
            found: 8,
            expected: 20
        })
    );
}
