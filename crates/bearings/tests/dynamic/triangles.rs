//! Races as meshes of triangles: the force of the torus, however fine the mesh; derivatives; a run; sizes that do not
//! fit.

use std::ops::ControlFlow;

use gearmesh_bearings::RingPose;
use gearmesh_bearings::dynamic::{DynamicEffects, GrooveTriangles, TriangleSize};
use gearmesh_bearings::faults::Side;
use gearmesh_dynamics::{Params, Simulation};
use nalgebra::{Matrix3, Vector3, Vector5};

use crate::common::{B6205, bearing};
use crate::hard_cases::rolling;
use crate::rig::{Channels, Held, row, system};

fn size(across_um: f64, along_um: f64) -> TriangleSize {
    TriangleSize {
        across_m: 1e-6 * across_um,
        along_m: 1e-6 * along_um,
    }
}

fn mesh(side: Side, size: TriangleSize) -> GrooveTriangles {
    GrooveTriangles::new(row(&bearing(B6205)), side, size).unwrap()
}

const RADIUS_M: f64 = 0.5 * 7.938e-3;

/// Places of balls that are pressed in by 4 to 8 µm, round the ring and a little up its sides; with the approach and
/// the normal on the torus.
fn places(side: Side) -> Vec<(Vector3<f64>, f64, Vector3<f64>)> {
    let bearing = bearing(B6205);
    let groove = row(&bearing).groove(side);
    let out = if side == Side::Outer { 1.0 } else { -1.0 };
    let mut numbers = fastrand::Rng::with_seed(7);
    let places = (0..20).map(|_| {
        let (turned, angle) = (6.3 * numbers.f64(), 0.1 * (numbers.f64() - 0.5));
        let approach = 1e-6 * (4.0 + 4.0 * numbers.f64());
        let e = Vector3::new(turned.cos(), turned.sin(), 0.0);
        let normal = e * (out * angle.cos()) + Vector3::z() * angle.sin();
        let centre = e * groove.centre_radius_m + Vector3::z() * groove.centre_z_m;
        (
            centre + normal * (groove.arm_m + approach),
            approach,
            normal,
        )
    });
    places.collect()
}

/// Largest error of the approach, as a share, and of the direction.
fn errors(side: Side, size: TriangleSize) -> [f64; 2] {
    let mesh = mesh(side, size);
    let found = places(side).into_iter().map(|(w, approach, normal)| {
        let (here, n, _) = mesh.approach(&w, RADIUS_M).unwrap();
        [
            (here / approach - 1.0).abs(),
            (n.normalize() - normal).norm(),
        ]
    });
    found.fold([0.0_f64; 2], |most, e| {
        [most[0].max(e[0]), most[1].max(e[1])]
    })
}

/// Approach and direction tend to those of the torus, at least with the square of the edges; edges of a fifth of the
/// contact ellipse miss less than a percent.
#[test]
fn the_force_does_not_depend_on_the_mesh() {
    for side in [Side::Outer, Side::Inner] {
        let sizes = [(400.0, 200.0), (200.0, 100.0), (100.0, 50.0)];
        let [coarse, middle, fine] = sizes.map(|(across, along)| errors(side, size(across, along)));
        assert!(middle[0] < coarse[0] / 4.0 && middle[1] < coarse[1] / 4.0);
        assert!(fine[0] < middle[0] / 3.0 && fine[1] < middle[1] / 3.0);
        assert!(middle[0] < 5e-3 && fine[0] < 1e-3, "{middle:?}, {fine:?}");
    }
}

/// n and N are the derivatives of δ, so that the contact has a potential.
#[test]
fn directions_are_derivatives() {
    for side in [Side::Outer, Side::Inner] {
        let mesh = mesh(side, size(200.0, 100.0));
        for (w, _, _) in places(side) {
            let (_, normal, turning) = mesh.approach(&w, RADIUS_M).unwrap();
            let step = 2e-11;
            let at = |axis: usize, factor: f64| {
                let mut moved = w;
                moved[axis] += factor * step;
                let (approach, normal, _) = mesh.approach(&moved, RADIUS_M).unwrap();
                (approach, normal)
            };
            let (mut slope, mut bend) = (Vector3::zeros(), Matrix3::zeros());
            for axis in 0..3 {
                let [(a, n_a), (b, n_b)] = [at(axis, 1.0), at(axis, -1.0)];
                slope[axis] = (a - b) / (2.0 * step);
                bend.set_column(axis, &((n_a - n_b) / (2.0 * step)));
            }
            assert!((slope - normal).norm() < 1e-6, "{slope} {normal}");
            // N jumps where a point of the surface is covered or left, which steps as short as these do not meet.
            assert!(
                (bend - turning).norm() < 1e-4 * turning.norm(),
                "{bend} {turning}"
            );
        }
    }
}

/// Loads of the balls at the end of a run on triangles are those on the tori.
#[test]
fn a_run_on_triangles_is_one_on_tori() {
    let bearing = bearing(B6205);
    let pose = RingPose::from_five(&Vector5::new(0.0, 2e-6, 8e-5, 0.0, 0.0));
    let [tori, triangles] = [None, Some(size(200.0, 100.0))].map(|surface| {
        let effects = DynamicEffects {
            surface,
            ..rolling(10.0)
        };
        let system = system(&bearing, effects, &pose, 100.0, &Held::Fast);
        let mut run = Simulation::new(system, Params::fixed(1e-5)).unwrap();
        run.run(2e-3, |_| ControlFlow::Continue(())).unwrap();
        Channels::at_end(run)
    });
    for ball in 1..=9 {
        for race in ["inner", "outer"] {
            let name = format!("bearing.ball_{ball}_{race}_N");
            let (a, b) = (tori.get(&name), triangles.get(&name));
            assert!(a > 50.0 && (b / a - 1.0).abs() < 1e-2, "{name}: {a}, {b}");
        }
    }
}

#[test]
fn sizes_that_do_not_fit_are_refused() {
    let bearing = bearing(B6205);
    let row = row(&bearing);
    for (across_um, along_um, part) in [
        (0.0, 100.0, "across the groove"),
        (f64::NAN, 100.0, "across the groove"),
        (5000.0, 100.0, "across the groove"),
        (100.0, -1.0, "groove in m is"),
        (1.0, 1.0, "two million triangles"),
    ] {
        let made = GrooveTriangles::new(row, Side::Inner, size(across_um, along_um));
        let said = made.err().unwrap().to_string();
        assert!(said.contains(part), "{said}");
    }
}
