//! One evaluation of a mesh with five slices and tangents: two loaded pairs and one.
#![allow(clippy::unwrap_used, missing_docs)]

#[path = "../tests/mesh_common/mod.rs"]
mod mesh_common;

use divan::Bencher;
use gearmesh_drivetrain::*;
use gearmesh_geometry::Flank;
use mesh_common::*;
use nalgebra::Vector3;

fn main() {
    divan::main();
}

/// Driver angle of one loaded pair, and of two.
const PAIRS: [usize; 2] = [1, 2];

fn bench(bencher: Bencher<'_, '_>, name: &str, pairs: usize) {
    let pair = spur_pair();
    let model = model(name, &pair, Flank::Right);
    let mut mesh = GearMesh::new(kinematics(&pair), Flank::Right, model).unwrap();
    let mut k = 0.0;
    let steps: Vec<Pose> = (0..64)
        .map(|_| {
            k += 1.0;
            let theta = if pairs == 1 { 0.0 } else { 0.1 } + 1e-4 * k;
            let phi = angles(&pair, Flank::Right, theta, -9e-6 - 1e-8 * k);
            pose(&pair, phi, Vector3::zeros(), Vector3::zeros())
        })
        .collect();
    let mut next = 0;
    bencher.bench_local(move || {
        next = (next + 1) % steps.len();
        mesh.evaluate(&steps[next], true).unwrap()
    });
}

#[divan::bench(args = PAIRS)]
fn impact(bencher: Bencher<'_, '_>, pairs: usize) {
    bench(bencher, "impact", pairs);
}

#[divan::bench(args = PAIRS)]
fn iso6336(bencher: Bencher<'_, '_>, pairs: usize) {
    bench(bencher, "iso6336", pairs);
}

#[divan::bench(args = PAIRS)]
fn analytic(bencher: Bencher<'_, '_>, pairs: usize) {
    bench(bencher, "analytic", pairs);
}

#[divan::bench(args = PAIRS)]
fn hybrid(bencher: Bencher<'_, '_>, pairs: usize) {
    bench(bencher, "hybrid", pairs);
}
