//! A thin cantilever, one element thick, under an end load: the incompatible modes find the beam, the plain
//! brick locks.
//!
//! Timoshenko beam: w = F L³/(3 E I) + F L/(κ G A), κ = 10 (1 + ν)/(12 + 11 ν) for a rectangle
//! (G. R. Cowper, J. Appl. Mech. 33 (1966) 335-340). ν = 0 takes the plate effect of the clamp away.

use gearmesh_fe::{DofMap, Element, Factor, FeModel, Material, StructuredMesh, assemble_stiffness};

const LENGTH: f64 = 0.1;
const WIDTH: f64 = 0.002;
const THICKNESS: f64 = 0.002;
const YOUNG: f64 = 210e9;
const FORCE: f64 = 1.0;

/// Mean end deflection, and strain xx at the top near the clamp at mid-element.
fn cantilever(element: Element, along: usize, skew: f64) -> (f64, f64) {
    let mesh = StructuredMesh::mapped([along, 1, 1], |[x, y, z]| {
        // Skewed cross-sections inside, plane ends.
        let shift = skew * THICKNESS * (z - 0.5) * (std::f64::consts::PI * x).sin();
        [LENGTH * x + shift, WIDTH * y, THICKNESS * z]
    });
    let held = mesh.nodes_where(|x| x[0] == 0.0);
    let end = mesh.nodes_where(|x| (x[0] - LENGTH).abs() < 1e-9);
    assert_eq!(end.len(), 4);
    let model = FeModel::new(
        mesh.nodes,
        mesh.hexes,
        Material::new(YOUNG, 0.0).unwrap(),
        element,
    )
    .unwrap();
    let dofs = DofMap::with_fixed_nodes(model.node_count(), &held).unwrap();
    let k = assemble_stiffness(&model, &dofs).unwrap();
    let mut u = vec![0.0; dofs.free_count()];
    for node in &end {
        u[dofs.free_of(3 * node + 2).unwrap()] = FORCE / 4.0;
    }
    Factor::of_model(&model, &dofs, &k)
        .unwrap()
        .solve_slice_in_place(&mut u);
    let full = dofs.expand(&u);
    let deflection = end.iter().map(|n| full[3 * n + 2]).sum::<f64>() / 4.0;
    (
        deflection,
        model.strain(0, [0.0, 0.0, 1.0], &full).unwrap()[0],
    )
}

fn timoshenko() -> f64 {
    let (inertia, area) = (WIDTH * THICKNESS.powi(3) / 12.0, WIDTH * THICKNESS);
    let (shear_modulus, kappa) = (YOUNG / 2.0, 10.0 / 12.0);
    FORCE * LENGTH.powi(3) / (3.0 * YOUNG * inertia)
        + FORCE * LENGTH / (kappa * shear_modulus * area)
}

#[test]
fn incompatible_modes_find_the_beam_where_the_plain_brick_locks() {
    let along = 20; // elements 5 mm long, 2 mm thick
    let beam = timoshenko();
    let (plain, _) = cantilever(Element::Hex8, along, 0.0);
    let (modes, _) = cantilever(Element::Hex8Incompatible, along, 0.0);
    // A plain brick of length l and thickness t in bending is too stiff by 1 + (G/E)(l/t)², here with
    // G/E = 1/2: 4.125, thus 0.242 of the beam.
    let locked = 1.0 / (1.0 + 0.5 * (LENGTH / along as f64 / THICKNESS).powi(2));
    assert!(
        (plain / beam - locked).abs() < 1e-3,
        "plain brick: {} of the beam",
        plain / beam
    );
    // Piecewise constant curvature: the deflection falls short by 1/(4 n²) = 0.06 %. The shear part differs a
    // little more (constant instead of parabolic shear), but is 0.02 % of the whole.
    let constant_curvature = 1.0 - 0.25 / (along as f64).powi(2);
    assert!(
        (modes / beam - constant_curvature).abs() < 2e-4,
        "incompatible modes: {} of the beam",
        modes / beam
    );
}

#[test]
fn bending_strain_at_the_surface_is_that_of_the_beam() {
    let along = 20;
    let (_, strain) = cantilever(Element::Hex8Incompatible, along, 0.0);
    // Load up: the top is compressed. Moment at the middle of the first element.
    let moment = FORCE * LENGTH * (1.0 - 0.5 / along as f64);
    let expected = -moment * (THICKNESS / 2.0) / (YOUNG * WIDTH * THICKNESS.powi(3) / 12.0);
    assert!(
        (strain / expected - 1.0).abs() < 1e-6,
        "{strain} {expected}"
    );
}

/// Skewed elements lose part of the gain but stay far from locking.
#[test]
fn skewed_elements_still_bend() {
    let (modes, _) = cantilever(Element::Hex8Incompatible, 20, 0.5);
    let ratio = modes / timoshenko();
    assert!(ratio > 0.99 && ratio < 1.01, "{ratio} of the beam");
}
