//! Time of one warm solve: the separations move a little from call to call, as in a simulation.
//!
//! Run on a quiet machine: `cargo bench -p gearmesh-contact --bench nlcp --profile dev`; on a busy one only the fastest
//! column says something.
#![allow(clippy::unwrap_used)] // bench code

use divan::Bencher;
use gearmesh_contact::nlcp::{
    ContactBody, LineContact, LocalLaw, Params, Problem, Workspace, solve_load, solve_position,
};

fn main() {
    divan::main();
}

/// Slices of three tooth pairs of which the middle two thirds touch: about two active pairs.
struct Mesh {
    compliance: Vec<f64>,
    local: Vec<LocalLaw>,
    ones: Vec<f64>,
    lever: Vec<f64>,
    separations: Vec<Vec<f64>>,
}

const LOAD: f64 = 300.0;

fn mesh(n: usize) -> Mesh {
    let per_pair = n / 3;
    let mut compliance = vec![0.0; n * n];
    for i in 0..n {
        for j in 0..n {
            let same = if i / per_pair == j / per_pair {
                (-(i.abs_diff(j) as f64) / 1.5).exp()
            } else {
                0.0
            };
            compliance[i * n + j] = 1e-8 * (same + 0.1);
        }
    }
    let body = ContactBody {
        youngs_modulus_pa: 210e9,
        poisson_ratio: 0.3,
        depth_m: 4e-3,
    };
    let contact = LineContact {
        width_m: 23e-3 / per_pair as f64,
        relative_radius_m: 13e-3,
        bodies: [body; 2],
    };
    let law = LocalLaw::weber_banaschek(&contact, 1e-6 * 4e3 / n as f64).unwrap();
    // The third pair is 0.1 mm away, the first two roll: 200 positions of a smooth gap.
    let separations = (0..200)
        .map(|step| {
            (0..n)
                .map(|i| {
                    let across = (i % per_pair) as f64 / per_pair as f64 - 0.5;
                    let roll = (0.03 * f64::from(step) + (i / per_pair) as f64).sin();
                    4e-6 * across * across
                        + 1e-6 * roll
                        + if i / per_pair == 2 { 1e-4 } else { 0.0 }
                })
                .collect()
        })
        .collect();
    Mesh {
        compliance,
        local: vec![law; n],
        ones: vec![1.0; n],
        lever: vec![0.07; n],
        separations,
    }
}

#[divan::bench(args = [15, 30, 60, 150], sample_size = 20)]
fn warm_load(bencher: Bencher, n: usize) {
    let mesh = mesh(n);
    let mut work = Workspace::new(n);
    let params = Params::default();
    let mut step = 0;
    bencher.bench_local(|| {
        step = (step + 1) % mesh.separations.len();
        let problem = Problem::new(
            &mesh.compliance,
            &mesh.local,
            &mesh.separations[step],
            &mesh.ones,
            &mesh.lever,
        )
        .unwrap();
        solve_load(&problem, LOAD, &params, &mut work).unwrap()
    });
}

#[divan::bench(args = [15, 30, 60, 150], sample_size = 20)]
fn warm_position(bencher: Bencher, n: usize) {
    let mesh = mesh(n);
    let mut work = Workspace::new(n);
    let params = Params::default();
    let mut step = 0;
    bencher.bench_local(|| {
        step = (step + 1) % mesh.separations.len();
        let problem = Problem::new(
            &mesh.compliance,
            &mesh.local,
            &mesh.separations[step],
            &mesh.ones,
            &mesh.lever,
        )
        .unwrap();
        solve_position(&problem, 1.5e-5, &params, &mut work).unwrap()
    });
}

#[divan::bench(args = [15, 150], sample_size = 20)]
fn cold_load(bencher: Bencher, n: usize) {
    let mesh = mesh(n);
    let mut work = Workspace::new(n);
    let params = Params::default();
    let problem = Problem::new(
        &mesh.compliance,
        &mesh.local,
        &mesh.separations[0],
        &mesh.ones,
        &mesh.lever,
    )
    .unwrap();
    bencher.bench_local(|| {
        work.reset();
        solve_load(&problem, LOAD, &params, &mut work).unwrap()
    });
}
