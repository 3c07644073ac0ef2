//! Times of assembly, factorisation and solve on small blocks. Run with `cargo bench -p gearmesh-fe`.
#![allow(clippy::unwrap_used, missing_docs)]

use divan::{Bencher, black_box};
use faer::Mat;
use gearmesh_fe::{
    DofMap, Element, Factor, FeModel, Material, StiffnessMatrix, StructuredMesh,
    assemble_stiffness, chord_middle,
};

fn main() {
    divan::main();
}

fn block(elements: usize, element: Element) -> (FeModel, DofMap) {
    let mesh = StructuredMesh::block([elements; 3], [1.0; 3]);
    let steel = Material::new(210e9, 0.3).unwrap();
    let model = mesh
        .into_model(steel, element, |_, ends| chord_middle(ends))
        .unwrap();
    let held: Vec<usize> = (0..model.node_count())
        .filter(|n| model.nodes()[*n][0] == 0.0)
        .collect();
    let dofs = DofMap::with_fixed_nodes(model.node_count(), &held).unwrap();
    (model, dofs)
}

fn system(elements: usize) -> (FeModel, DofMap, StiffnessMatrix) {
    let (model, dofs) = block(elements, Element::Hex8Incompatible);
    let k = assemble_stiffness(&model, &dofs).unwrap();
    (model, dofs, k)
}

#[divan::bench(args = [8, 16], sample_count = 10)]
fn assemble_hex8(bencher: Bencher, elements: usize) {
    let (model, dofs) = block(elements, Element::Hex8);
    bencher.bench(|| assemble_stiffness(black_box(&model), &dofs).unwrap());
}

#[divan::bench(args = [8, 16], sample_count = 10)]
fn assemble_hex8_incompatible(bencher: Bencher, elements: usize) {
    let (model, dofs) = block(elements, Element::Hex8Incompatible);
    bencher.bench(|| assemble_stiffness(black_box(&model), &dofs).unwrap());
}

#[divan::bench(args = [4, 8], sample_count = 10)]
fn assemble_hex20(bencher: Bencher, elements: usize) {
    let (model, dofs) = block(elements, Element::Hex20);
    bencher.bench(|| assemble_stiffness(black_box(&model), &dofs).unwrap());
}

#[divan::bench(args = [8, 16], sample_count = 5)]
fn order_and_factor(bencher: Bencher, elements: usize) {
    let (model, dofs, k) = system(elements);
    bencher.bench(|| Factor::of_model(&model, &dofs, black_box(&k)).unwrap());
}

#[divan::bench(args = [8, 16], sample_count = 10)]
fn solve_64(bencher: Bencher, elements: usize) {
    let (model, dofs, k) = system(elements);
    let factor = Factor::of_model(&model, &dofs, &k).unwrap();
    bencher
        .with_inputs(|| Mat::<f64>::from_fn(factor.size(), 64, |i, j| ((i + 7 * j) % 11) as f64))
        .bench_values(|mut rhs| factor.solve_in_place(rhs.as_mut()));
}
