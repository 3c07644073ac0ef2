//! A row must not allocate: counted by the global allocator of this test program.
#![allow(clippy::unwrap_used)] // test code

#[path = "../../../tests/support/counting_allocator.rs"]
mod counting_allocator;
mod system_runs;

use counting_allocator::allocations;
use std::ops::ControlFlow;

use std::sync::atomic::AtomicBool;
use std::time::Duration;

use gearmesh_dynamics::{OutputGrid, Params, Simulation};
use gearmesh_geometry::input::InputDocument;
use gearmesh_model::{Column, RowLog};
use gearmesh_scene::SceneFile;
use gearmesh_scene::system_run::{
    ColumnStatistics, Course, Moment, Recorder, RunJob, RunOptions, Selection, SystemResult, run,
};

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
                after_warm_up = allocations();
            }
            ControlFlow::Continue(())
        })
        .unwrap();
    assert_eq!(allocations(), after_warm_up);
    assert!(log.rows() >= 3000);
}

/// A run whose rows are filtered from all steps takes one sample a step, and allocates for its rows, not for its steps
/// nor for its samples: twice as many steps, ten and twenty a row, ask for no more memory blocks.
#[test]
fn samples_between_rows_allocate_nothing() {
    let wheel = include_str!("../../../tests/support/wheel.toml");
    let allocated = |steps_per_row: usize| {
        let folder = tempfile::tempdir().unwrap();
        let step = format!("step_s = {}", 1e-2 / steps_per_row as f64);
        let text = wheel.replace("step_s = 1e-2", &step);
        let document = InputDocument::new("scene.toml", text);
        let SceneFile::System(scene) = SceneFile::from_document(document, folder.path()).unwrap()
        else {
            panic!("a multibody scene");
        };
        let job = RunJob::from_scene(scene.load().unwrap()).unwrap();
        let output = folder.path().join("result.h5");
        let options = RunOptions {
            output: &output,
            restart: true,
            checkpoint_interval: Duration::from_secs(3600),
            stop: &AtomicBool::new(false),
            progress: &|_| (),
        };
        let before = allocations();
        run(job, &options).unwrap();
        let allocated = allocations() - before;
        let result = SystemResult::open(&output).unwrap();
        assert_eq!(result.samples_per_row, steps_per_row);
        assert_eq!(result.rows.rows(), 101);
        let record = result.record.unwrap();
        assert_eq!(record.steps, (100 * steps_per_row) as f64);
        allocated
    };
    // Files and folders are named once before.
    allocated(10);
    assert_eq!(allocated(20), allocated(10));
}
