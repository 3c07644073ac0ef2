//! Patch test: a linear displacement prescribed on the boundary of a distorted mesh is reproduced inside, with
//! the exact constant strain, to rounding. Source: B. Irons; Hughes 1987, section 4.6.
#![allow(clippy::unwrap_used)]

mod common;

use common::{ELEMENTS, distorted_cube, model, nodes_where};
use gearmesh_fe::{CORNERS, DofMap, DofOrdering, Factor, assemble_stiffness};

const GRADIENT: [[f64; 3]; 3] = [[1.0, 0.3, -0.2], [0.5, -0.7, 0.4], [-0.1, 0.6, 0.8]];

fn linear_field(x: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| 0.1 + (0..3).map(|j| GRADIENT[i][j] * x[j]).sum::<f64>())
}

#[test]
fn linear_field_is_exact_on_a_distorted_mesh() {
    for element in ELEMENTS {
        let model = model(distorted_cube(3), element);
        let boundary = nodes_where(&model, |x| x.iter().any(|v| *v == 0.0 || *v == 1.0));
        let n = model.node_count();
        let exact: Vec<f64> = model
            .nodes()
            .iter()
            .flat_map(|x| linear_field(*x))
            .collect();

        // Prescribed boundary: K_ff u_f = −K_fb u_b, with the product taken by the unconstrained K.
        let all = DofMap::all_free(n).unwrap();
        let free = DofMap::with_fixed_nodes(n, &boundary).unwrap();
        // A 3x3x3 mesh has 2³ inner corners and 3·3·2² inner edges.
        let inner = if element.node_count() == 8 { 8 } else { 8 + 36 };
        assert_eq!(free.free_count(), 3 * inner);
        let mut prescribed = exact.clone();
        for f in 0..free.free_count() {
            prescribed[free.full_of(f)] = 0.0;
        }
        let full = assemble_stiffness(&model, &all).unwrap();
        let reaction = &full * faer::Col::from_fn(3 * n, |i| prescribed[i]);
        let mut u: Vec<f64> = (0..free.free_count())
            .map(|f| -reaction[free.full_of(f)])
            .collect();
        let k = assemble_stiffness(&model, &free).unwrap();
        Factor::new(&k, DofOrdering::natural(free.free_count()))
            .unwrap()
            .solve_slice_in_place(&mut u);

        for (f, value) in u.iter().enumerate() {
            let expected = exact[free.full_of(f)];
            assert!(
                (value - expected).abs() < 1e-12,
                "{element:?}: {value} {expected}"
            );
        }
        let mut solved = prescribed;
        for (f, value) in u.iter().enumerate() {
            solved[free.full_of(f)] = *value;
        }
        let strain_exact: [f64; 6] = [
            GRADIENT[0][0],
            GRADIENT[1][1],
            GRADIENT[2][2],
            GRADIENT[0][1] + GRADIENT[1][0],
            GRADIENT[1][2] + GRADIENT[2][1],
            GRADIENT[0][2] + GRADIENT[2][0],
        ];
        for e in 0..model.element_count() {
            for point in CORNERS.iter().chain(&[[0.0; 3], [0.3, -0.6, 0.9]]) {
                let strain = model.strain(e, *point, &solved).unwrap();
                for (value, expected) in strain.iter().zip(strain_exact) {
                    assert!(
                        (value - expected).abs() < 1e-11,
                        "{element:?} element {e}: {value} {expected}"
                    );
                }
            }
        }
    }
}
