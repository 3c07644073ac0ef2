//! Total mass, static moments and moments of inertia of the mass matrix, with and without a rigid group.

use crate::common;

use common::{ELEMENTS, distorted_cube, nodes_where, steel};
use faer::Col;
use gearmesh_fe::{
    DofMap, Element, FeError, FeModel, RigidGroup, assemble_mass, assemble_stiffness, chord_middle,
};

const DENSITY: f64 = 7800.0;

/// The unit cube, elements distorted, edges straight.
fn cube(element: Element) -> FeModel {
    distorted_cube(3)
        .into_model(steel(), element, |_, ends| chord_middle(ends))
        .unwrap()
}

/// Displacements of a motion with unit velocity along or about an axis through the origin: x, y, z, rotations.
fn rigid_motion(model: &FeModel, component: usize) -> Vec<f64> {
    let axis = component % 3;
    let velocity = |x: [f64; 3]| -> [f64; 3] {
        let mut v = [0.0; 3];
        if component < 3 {
            v[axis] = 1.0;
        } else {
            let (a, b) = ((axis + 1) % 3, (axis + 2) % 3);
            (v[a], v[b]) = (-x[b], x[a]);
        }
        v
    };
    model.nodes().iter().flat_map(|x| velocity(*x)).collect()
}

/// The mass matrix over the six rigid motions of the unit cube in [0, 1]³.
fn exact(i: usize, j: usize) -> f64 {
    let (a, b) = (i % 3, j % 3);
    DENSITY
        * match (i < 3, j < 3) {
            (true, true) => f64::from(u8::from(a == b)),
            // J_aa = ∫ (x_b² + x_c²) = 2/3, J_ab = −∫ x_a x_b = −1/4.
            (false, false) if a == b => 2.0 / 3.0,
            (false, false) => -0.25,
            // ∫ e_a · (e_b × x): ±1/2 by the sign of the permutation.
            (true, false) => 0.5 * sign(a, b),
            (false, true) => 0.5 * sign(b, a),
        }
}

/// Component a of e_b × (1, 1, 1).
fn sign(a: usize, b: usize) -> f64 {
    match (3 + a - b) % 3 {
        1 => -1.0,
        2 => 1.0,
        _ => 0.0,
    }
}

#[test]
fn mass_and_inertia_of_a_cube() {
    for element in ELEMENTS {
        let model = cube(element);
        let dofs = DofMap::all_free(model.node_count()).unwrap();
        let m = assemble_mass(&model, &dofs, DENSITY).unwrap();
        for i in 0..6 {
            let motion = rigid_motion(&model, i);
            let momentum = &m * Col::from_fn(m.ncols(), |k| motion[k]);
            for j in 0..6 {
                let other = rigid_motion(&model, j);
                let found: f64 = other.iter().zip(momentum.iter()).map(|(a, b)| a * b).sum();
                assert!(
                    (found - exact(i, j)).abs() < 1e-12 * DENSITY,
                    "{element:?} {i} {j}: {found} {}",
                    exact(i, j)
                );
            }
        }
        // The pattern is that of the stiffness.
        let k = assemble_stiffness(&model, &dofs).unwrap();
        assert_eq!(k.symbolic().row_idx(), m.symbolic().row_idx());
    }
}

/// Positive definite on bent elements of every kind: no motion without mass.
#[test]
fn mass_is_positive_definite() {
    for element in ELEMENTS {
        let model = common::model(distorted_cube(2), element);
        let dofs = DofMap::all_free(model.node_count()).unwrap();
        let m = assemble_mass(&model, &dofs, 1.0).unwrap().to_dense();
        let eigenvalues = m.self_adjoint_eigenvalues(faer::Side::Lower).unwrap();
        assert!(eigenvalues[0] > 1e-3 * eigenvalues[eigenvalues.len() - 1]);
    }
}

/// The rigid motions of q have the same mass when a part of the nodes follows a reference point.
#[test]
fn a_rigid_group_keeps_the_mass() {
    let model = cube(Element::Hex20);
    let reference = [0.2, -0.4, 0.7];
    let group = RigidGroup {
        nodes: nodes_where(&model, |x| x[2] == 0.0),
        reference_m: reference,
        fixed: [false; 6],
    };
    let dofs = DofMap::with_rigid_groups(model.nodes(), &[], &[group]).unwrap();
    let m = assemble_mass(&model, &dofs, DENSITY).unwrap();
    for i in 0..6 {
        let u = rigid_motion(&model, i);
        let mut q: Vec<f64> = (0..dofs.nodal_free_count())
            .map(|f| u[dofs.full_of(f)])
            .collect();
        // The reference point moves with the body: the same velocity field, and its rotation.
        let axis = i % 3;
        let mut reference_q = [0.0; 6];
        if i < 3 {
            reference_q[axis] = 1.0;
        } else {
            let (a, b) = ((axis + 1) % 3, (axis + 2) % 3);
            (reference_q[a], reference_q[b]) = (-reference[b], reference[a]);
            reference_q[3 + axis] = 1.0;
        }
        q.extend(reference_q);
        for (found, expected) in dofs.expand(&q).iter().zip(&u) {
            assert!((found - expected).abs() < 1e-14);
        }
        let q = Col::from_fn(q.len(), |k| q[k]);
        let found = q.transpose() * (&m * &q);
        assert!(
            (found - exact(i, i)).abs() < 1e-12 * DENSITY,
            "{i}: {found}"
        );
    }
}

#[test]
fn a_density_that_is_not_positive_is_refused() {
    let model = cube(Element::Hex8);
    let dofs = DofMap::all_free(model.node_count()).unwrap();
    for density in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(
            assemble_mass(&model, &dofs, density),
            Err(FeError::DensityOutOfRange { .. })
        ));
    }
}
