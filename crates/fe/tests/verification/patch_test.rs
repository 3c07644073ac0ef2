//! Patch test: a linear displacement prescribed on the boundary of a distorted mesh is reproduced inside, with
//! the exact constant strain, to rounding. Source: B. Irons; Hughes 1987, section 4.6.

use crate::common;

use common::{ELEMENTS, distorted_cube, model, nodes_where};
use gearmesh_fe::{
    DofMap, DofOrdering, Element, ElementBlock, ElementFormulas, Factor, FeError, FeModel,
    assemble_stiffness,
};

const GRADIENT: [[f64; 3]; 3] = [[1.0, 0.3, -0.2], [0.5, -0.7, 0.4], [-0.1, 0.6, 0.8]];

fn linear_field(x: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| 0.1 + (0..3).map(|j| GRADIENT[i][j] * x[j]).sum::<f64>())
}

#[test]
fn linear_field_is_exact_on_a_distorted_mesh() {
    for element in ELEMENTS {
        let model = model(distorted_cube(3), element);
        let inner = model
            .nodes()
            .iter()
            .filter(|x| x.iter().all(|v| *v > 0.0 && *v < 1.0))
            .count();
        // A mesh of 3³ cubes has 2³ inner corners and 3·3·2² inner edges. Wedges add 9·2 diagonals of inner squares
        // across z, tetrahedra those across all three axes and one in each cube.
        let expected = match element {
            Element::Hex8 | Element::Hex8Incompatible | Element::Wedge6 => 8,
            Element::Hex20 => 8 + 36,
            Element::Wedge15 => 8 + 36 + 18,
            Element::Tet10 => 8 + 36 + 54 + 27,
        };
        assert_eq!(inner, expected, "{element:?}");
        check(&model, element.name());
    }
}

fn check(model: &FeModel, name: &str) {
    let boundary = nodes_where(model, |x| x.iter().any(|v| *v == 0.0 || *v == 1.0));
    let n = model.node_count();
    let exact: Vec<f64> = model
        .nodes()
        .iter()
        .flat_map(|x| linear_field(*x))
        .collect();

    // Prescribed boundary: K_ff u_f = −K_fb u_b, with the product taken by the unconstrained K.
    let all = DofMap::all_free(n).unwrap();
    let free = DofMap::with_fixed_nodes(n, &boundary).unwrap();
    let mut prescribed = exact.clone();
    for f in 0..free.free_count() {
        prescribed[free.full_of(f)] = 0.0;
    }
    let full = assemble_stiffness(model, &all).unwrap();
    let reaction = &full * faer::Col::from_fn(3 * n, |i| prescribed[i]);
    let mut u: Vec<f64> = (0..free.free_count())
        .map(|f| -reaction[free.full_of(f)])
        .collect();
    let k = assemble_stiffness(model, &free).unwrap();
    Factor::new(&k, DofOrdering::natural(free.free_count()))
        .unwrap()
        .solve_slice_in_place(&mut u);

    for (f, value) in u.iter().enumerate() {
        let expected = exact[free.full_of(f)];
        assert!(
            (value - expected).abs() < 1e-12,
            "{name}: {value} {expected}"
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
        for point in model
            .element_of(e)
            .natural_nodes()
            .iter()
            .chain(&[[0.2, 0.3, 0.4]])
        {
            let strain = model.strain(e, *point, &solved).unwrap();
            for (value, expected) in strain.iter().zip(strain_exact) {
                assert!(
                    (value - expected).abs() < 1e-11,
                    "{name} element {e}: {value} {expected}"
                );
            }
        }
    }
}

/// Half of the cube in hexahedra, half cut in wedges, as two blocks: nodes at one place are one node.
fn hexahedra_and_wedges(hex: Element, wedge: Element) -> FeModel {
    let (mut nodes, mut blocks) = (Vec::new(), Vec::new());
    let mut number = std::collections::HashMap::new();
    for (element, keep) in [(hex, 0), (wedge, 1)] {
        let mut mesh = distorted_cube(4);
        let corners = mesh.nodes.clone();
        mesh.hexes.retain(|h| {
            let centre: f64 = h.iter().map(|n| corners[*n as usize][0]).sum::<f64>() / 8.0;
            usize::from(centre > 0.5) == keep
        });
        let mut used: Vec<u32> = mesh.hexes.as_flattened().to_vec();
        used.sort_unstable();
        used.dedup();
        let place = |n: &mut u32| *n = used.binary_search(n).unwrap() as u32;
        mesh.hexes.as_flattened_mut().iter_mut().for_each(place);
        mesh.nodes = used.iter().map(|n| corners[*n as usize]).collect();
        let half = model(mesh, element);
        let elements = (0..half.element_count()).flat_map(|e| half.element_nodes(e));
        let of_whole = elements.map(|n| {
            let x = half.nodes()[*n as usize];
            *number
                .entry(x.map(|v| (v * 1e9).round() as i64))
                .or_insert_with(|| {
                    nodes.push(x);
                    nodes.len() as u32 - 1
                })
        });
        blocks.push(ElementBlock {
            element,
            nodes: of_whole.collect(),
        });
    }
    FeModel::from_blocks(nodes, blocks, common::steel()).unwrap()
}

#[test]
fn hexahedra_and_wedges_in_one_model() {
    for (hex, wedge) in [
        (Element::Hex8, Element::Wedge6),
        (Element::Hex20, Element::Wedge15),
    ] {
        let model = hexahedra_and_wedges(hex, wedge);
        assert_eq!(model.element_count(), 32 + 64);
        assert_eq!((model.element_of(31), model.element_of(32)), (hex, wedge));
        assert!((model.volume().unwrap() - 1.0).abs() < 1e-13);
        check(&model, &format!("{hex:?} and {wedge:?}"));
        // A part keeps the kinds of its elements.
        let (nodes, part) = model.part(&[3, 31, 32, 90]).unwrap();
        assert_eq!(part.blocks().len(), 2);
        for (i, e) in [3, 31, 32, 90].into_iter().enumerate() {
            let of_whole: Vec<u32> = part
                .element_nodes(i)
                .iter()
                .map(|n| nodes[*n as usize])
                .collect();
            assert_eq!(of_whole, model.element_nodes(e));
        }
    }
}

#[test]
fn a_block_that_is_not_whole_is_refused() {
    let block = ElementBlock {
        element: Element::Tet10,
        nodes: vec![0; 15],
    };
    assert_eq!(
        FeModel::from_blocks(vec![[0.0; 3]], vec![block], common::steel()),
        Err(FeError::ConnectivityLength {
            element: "tet10",
            found: 15,
            per_element: 10
        })
    );
}
