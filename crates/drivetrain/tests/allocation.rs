//! A mesh must not allocate once it is warm: counted by the global allocator of this test program.
#![allow(clippy::unwrap_used)]
#![allow(unsafe_code)] // a global allocator is an unsafe trait; this one only counts and hands on

mod mesh_common;

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

use gearmesh_drivetrain::*;
use gearmesh_geometry::FlankSide;
use mesh_common::*;
use nalgebra::Vector3;

struct Counting;

thread_local! {
    static ALLOCATIONS: Cell<usize> = const { Cell::new(0) };
}

fn count() {
    // The test harness allocates on other threads; only this one counts.
    let _ = ALLOCATIONS.try_with(|n| n.set(n.get() + 1));
}

// SAFETY: every call goes unchanged to the system allocator.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count();
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        unsafe { System.dealloc(pointer, layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count();
        unsafe { System.realloc(pointer, layout, size) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

#[test]
fn evaluations_do_not_allocate() {
    let pair = spur_pair();
    let damping = Damping::StiffnessProportional {
        time_s: 1e-6,
        full_depth_m: 1e-6,
    };
    let friction = Friction::new([0.1, 0.05], [1e-3, 1e-2]).unwrap();
    for name in CONFORMING {
        let of = |side| Damped::new(model(name, &pair, side), damping, SLICES).unwrap();
        let mut mesh = GearMesh::new(kinematics(&pair), FlankSide::Right, of(FlankSide::Right))
            .unwrap()
            .with_side(FlankSide::Left, of(FlankSide::Left))
            .unwrap()
            .with_friction(friction);
        // From the pressed right flanks through the backlash to the left ones, around a whole pitch.
        let poses: Vec<Pose> = (0..200)
            .map(|k| {
                let k = f64::from(k);
                let phi = angles(&pair, FlankSide::Right, 0.0021 * k, -10e-6 + 1.5e-6 * k);
                pose(&pair, phi, Vector3::zeros(), Vector3::zeros())
            })
            .collect();
        for at in &poses {
            mesh.evaluate(at, true).unwrap();
            mesh.remember();
        }
        let before = ALLOCATIONS.with(Cell::get);
        for at in &poses {
            mesh.evaluate(at, true).unwrap();
            mesh.remember();
        }
        assert_eq!(ALLOCATIONS.with(Cell::get) - before, 0, "{name}");
    }
}

/// Whole steps of a system, output with gauges included.
#[test]
fn steps_and_output_do_not_allocate() {
    use mesh_common::running_pair::*;
    let pair = pair_a();
    let system = running_pair(&pair, running_mesh("hybrid", &pair), 8);
    let mut run = gearmesh_dynamics::Simulation::new(system.build().unwrap(), params()).unwrap();
    let names = run.system().channels();
    let of = |name: &str| names.iter().filter(|(element, _)| element == name).count();
    let counts: Vec<usize> = run.system().elements().map(of).collect();
    let mut out = vec![0.0; names.len()];
    let (mut before, mut steps) = (0, 0);
    run.run(200.0 * STEP_S, |step| {
        step.system.sample(step.to, &counts, &mut out);
        steps += 1;
        // One mesh period warms everything up.
        if steps == 60 {
            before = ALLOCATIONS.with(Cell::get);
        }
        std::ops::ControlFlow::Continue(())
    })
    .unwrap();
    assert!(steps > 190);
    assert_eq!(ALLOCATIONS.with(Cell::get) - before, 0);
}
