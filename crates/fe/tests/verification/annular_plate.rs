//! Bending of an annular plate, bore clamped and outside free, against Mindlin's exact solution; made by
//! tools/reference/annular_plate.py.

use crate::common;

use common::{nodes_where, steel};
use gearmesh_fe::{
    DofMap, Element, Factor, FeModel, ModeSettings, QuadraticMesh, StructuredMesh, arc_middle,
    assemble_mass, assemble_stiffness, natural_modes,
};

const RADII_M: [f64; 2] = [0.03, 0.1];
const DENSITY: f64 = 7800.0;

const THICKNESS_M: f64 = 2e-3;

/// Lowest frequency (Hz) for 0 to 4 nodal diameters by Mindlin's theory, shear factor 5/6. Kirchhoff's are 332.89,
/// 327.49, 397.67, 663.53, 1103.26: Leissa's λ² 6.66, 6.55, 7.96, 13.28, 22.07.
const EXACT_HZ: [f64; 5] = [332.5941, 326.8794, 396.2136, 660.9022, 1098.3280];

/// Frequencies (Hz), lowest first, of the plate with two layers of quadratic elements.
///
/// Clamped as a plate is: no displacement in the plane anywhere on the bore, no deflection of its middle line. Its
/// faces may grow thicker and thinner there, as in the theory.
fn frequencies_hz(counts: [usize; 3], modes: usize) -> Vec<f64> {
    let ring = StructuredMesh::ring(counts, RADII_M, THICKNESS_M);
    let mesh = QuadraticMesh::new(ring.nodes, &ring.hexes, |_, ends| arc_middle(ends));
    let model = FeModel::new(mesh.nodes, mesh.elements, steel(), Element::Hex20).unwrap();
    let on_bore = |x: [f64; 3]| x[0].hypot(x[1]) < RADII_M[0] * 1.000_001;
    let bore = nodes_where(&model, on_bore);
    let middle = nodes_where(&model, |x| on_bore(x) && x[2].abs() < 1e-9);
    let held: Vec<usize> = bore
        .iter()
        .flat_map(|n| [3 * n, 3 * n + 1])
        .chain(middle.iter().map(|n| 3 * n + 2))
        .collect();
    let dofs = DofMap::with_fixed_dofs(model.node_count(), &held).unwrap();
    let k = assemble_stiffness(&model, &dofs).unwrap();
    let m = assemble_mass(&model, &dofs, DENSITY).unwrap();
    let factor = Factor::of_model(&model, &dofs, &k).unwrap();
    natural_modes(&k, &m, &factor, &ModeSettings::new(modes))
        .unwrap()
        .frequencies_hz()
}

/// The list with pairs for all nodal diameters but 0, in the order of the frequencies: 1, 1, 0, 2, 2, 3, 3, 4, 4.
fn with_pairs(by_diameter: [f64; 5]) -> Vec<f64> {
    let [zero, pairs @ ..] = by_diameter;
    let mut all: Vec<f64> = pairs.iter().flat_map(|f| [*f; 2]).collect();
    all.push(zero);
    all.sort_by(f64::total_cmp);
    all
}

/// A plate theory leaves out terms of the order of (h/a)² = 4e-4; the rest is the mesh's, and falls by more than the
/// square of the element length. The more nodal diameters, the shorter the waves.
#[test]
fn clamped_at_the_bore_and_free_outside() {
    let errors = |counts: [usize; 3]| -> Vec<f64> {
        let found = frequencies_hz(counts, 9);
        for (a, b) in [(0, 1), (3, 4), (5, 6), (7, 8)] {
            assert!((found[a] / found[b] - 1.0).abs() < 1e-8, "{found:?}");
        }
        let pairs = found.iter().zip(with_pairs(EXACT_HZ));
        pairs.map(|(f, e)| f / e - 1.0).collect()
    };
    let (coarse, fine) = (errors([32, 8, 2]), errors([64, 16, 2]));
    for mode in 0..9 {
        assert!(
            fine[mode] > 0.0 && coarse[mode] > 5.0 * fine[mode],
            "{coarse:?} {fine:?}"
        );
        let allowed = if mode < 5 { 1.2e-3 } else { 4.5e-3 };
        assert!(fine[mode] < allowed, "{mode}: {fine:?}");
    }
}
