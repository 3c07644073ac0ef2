//! A row must not allocate: counted by the global allocator of this test program.
#![allow(clippy::unwrap_used)] // test code
#![allow(unsafe_code)] // a global allocator is an unsafe trait; this one only counts and hands on

mod system_runs;

use std::alloc::{GlobalAlloc, Layout, System as Allocator};
use std::cell::Cell;
use std::ops::ControlFlow;

use gearmesh_dynamics::{OutputGrid, Params, Simulation};
use gearmesh_model::{Column, RowLog};
use gearmesh_scene::system_run::{ColumnStatistics, Course, Moment, Recorder, Selection};

struct Counting;

thread_local! {
    static ALLOCATIONS: Cell<usize> = const { Cell::new(0) };
}

fn count() {
    let _ = ALLOCATIONS.try_with(|n| n.set(n.get() + 1));
}

// SAFETY: every call goes unchanged to the system allocator.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count();
        unsafe { Allocator.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        unsafe { Allocator.dealloc(pointer, layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count();
        unsafe { Allocator.realloc(pointer, layout, size) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

#[test]
fn rows_allocate_nothing() {
    let system = system_runs::driven_pendulum();
    let selection = Selection::all(&system);
    let time = Column {
        name: "time_s".to_owned(),
        unit: "s".to_owned(),
        description: "time".to_owned(),
    };
    let mut recorder = Recorder::new(
        &system,
        system.start(),
        &selection,
        vec![time],
        Course::InTime,
    );
    let folder = tempfile::tempdir().unwrap();
    let columns = recorder.columns().len();
    let mut log = RowLog::create(&folder.path().join("rows"), columns).unwrap();
    let mut statistics = ColumnStatistics::new(columns);
    let mut grid = OutputGrid::new(1e-3, system.start());
    let mut simulation = Simulation::new(system, Params::fixed(1e-3)).unwrap();
    let mut before = simulation.info().energy;
    let mut after_warm_up = usize::MAX;
    simulation
        .run(3.0, |step| {
            let (from, to, info) = (step.from.time_s, step.to, step.info);
            let lambda = [step.lambda_from, step.lambda];
            let acceleration = [step.acceleration_from, step.acceleration];
            grid.visit(step, |state, system| {
                let row = recorder.row(
                    system,
                    &Moment {
                        abscissas: &[state.time_s],
                        state,
                        lambda,
                        acceleration,
                        share: (state.time_s - from) / (to.time_s - from),
                        energy: [&before, &info.energy],
                        step_s: to.time_s - from,
                        largest_violation: info.largest_violation,
                    },
                );
                statistics.add(row);
                log.append(row).unwrap();
            });
            recorder.commit(step.system, to);
            before = info.energy;
            if info.steps == 100 {
                after_warm_up = ALLOCATIONS.with(Cell::get);
            }
            ControlFlow::Continue(())
        })
        .unwrap();
    assert_eq!(ALLOCATIONS.with(Cell::get), after_warm_up);
    assert!(log.rows() >= 3000);
}
