//! A solve must not allocate: counted by the global allocator of this test program.
#![allow(clippy::unwrap_used, clippy::needless_range_loop)] // test code in index notation
#![allow(unsafe_code)] // a global allocator is an unsafe trait; this one only counts and hands on

mod nlcp_common;
mod pair_common;

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

use gearmesh_contact::nlcp::{Params, Problem, Workspace, solve_load, solve_position};
use gearmesh_contact::static_contact::Drive;
use nlcp_common::random::{Random, case};

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

fn allocations() -> usize {
    ALLOCATIONS.with(Cell::get)
}

#[test]
fn the_counter_counts() {
    let before = allocations();
    let boxed = std::hint::black_box(Box::new(1));
    assert_eq!(allocations() - before, 1);
    drop(boxed);
}

#[test]
fn solves_do_not_allocate() {
    let mut random = Random::new(31);
    let mut work = Workspace::new(20);
    let params = Params::default();
    let mut change = [0.0; 20];
    for _ in 0..2000 {
        let case = case(20, &mut random);
        let data = &case.data;
        let n = data.size();
        let before = allocations();
        let problem = Problem::new(
            &data.compliance,
            &data.local,
            &data.separation,
            &data.closing,
            &data.lever,
        )
        .unwrap();
        let info = solve_load(&problem, case.load, &params, &mut work).unwrap();
        work.apply_tangent(&data.separation, &mut change[..n]);
        solve_position(&problem, info.approach_m, &params, &mut work).unwrap();
        solve_position(&problem, problem.first_contact() - 1e-6, &params, &mut work).unwrap();
        work.reset();
        solve_position(&problem, info.approach_m, &params, &mut work).unwrap();
        // A single correction allowed: the descent must do the work.
        let hasty = Params {
            max_corrections: 1,
            ..params
        };
        work.reset();
        solve_load(&problem, case.load, &hasty, &mut work).unwrap();
        assert_eq!(allocations() - before, 0);
    }
}

#[test]
fn positions_with_tip_edges_do_not_allocate() {
    let gears = [
        pair_common::tooth(40, 0.0, 0.0),
        pair_common::tooth(50, 0.0, 0.0),
    ];
    let lines = pair_common::extended(pair_common::pair(&gears[0], &gears[1]), 100e-6);
    let mut contact = pair_common::contact(&lines, pair_common::FRICTIONLESS, 3);
    let before = allocations();
    for k in 0..300 {
        contact
            .solve(1e-3 * f64::from(k), Drive::Torque(300.0))
            .unwrap();
    }
    assert_eq!(allocations() - before, 0);
}
