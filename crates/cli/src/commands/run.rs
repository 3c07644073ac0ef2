//! `gearmesh run`: a scene to a result file.

use crate::arguments::RunArguments;
use crate::{console, interrupt};
use gearmesh_operations::run::{Ran, RunHow, run as run_scene};
use gearmesh_operations::{Failure, Watch, output_name};
use gearmesh_scene::SceneFile;
use std::time::Duration;

/// Runs the command.
pub fn run(a: &RunArguments) -> Result<(), Failure> {
    output_name::demand_hdf5(&a.output)?;
    let how = RunHow {
        output: Some(&a.output),
        restart: a.restart,
        most_result_gb: a.most_result_gb,
        checkpoint_interval: Duration::from_secs_f64(a.checkpoint_s),
    };
    let scene = SceneFile::read(&a.scene)?;
    let stop = interrupt::on_demand();
    let watch = Watch {
        stop: &stop.asked,
        ..console::watch()
    };
    let ran = run_scene(scene, &how, &watch)?;
    drop(stop);
    print(&ran, a.json)?;
    match ran.problem() {
        Some(problem) => Err(Failure::work(problem)),
        None => Ok(()),
    }
}

fn print(ran: &Ran, as_json: bool) -> Result<(), Failure> {
    match as_json {
        true => console::json(&ran.figures()?),
        false => ran.lines()?.into_iter().for_each(console::data),
    }
    Ok(())
}
