//! `gearmesh run`: a scene to a result file.

use crate::arguments::RunArguments;
use crate::{console, interrupt};
use gearmesh_operations::accuracy::AccuracyRequest;
use gearmesh_operations::run::{Ran, RunHow, run as run_scene};
use gearmesh_operations::run_within::{self, run_within};
use gearmesh_operations::{Failure, output_name, overwriting};
use gearmesh_scene::SceneFile;
use gearmesh_scene::accuracy::Chosen;
use std::time::Duration;

/// Runs the command.
pub fn run(a: &RunArguments) -> Result<(), Failure> {
    overwriting::refuse(vec![a.scene.clone()], std::slice::from_ref(&a.output))?;
    output_name::demand_hdf5(&a.output)?;
    let how = RunHow {
        output: Some(&a.output),
        restart: a.restart,
        most_result_gb: a.most_result_gb,
        checkpoint_interval: Duration::from_secs_f64(a.checkpoint_s),
    };
    let stop = interrupt::on_demand();
    let watch = stop.watch();
    let (ran, found) = match a.accuracy {
        None => (run_scene(SceneFile::read(&a.scene)?, &how, &watch)?, None),
        Some(goal) => {
            let request = AccuracyRequest {
                scene: a.scene.clone(),
                columns: a.columns.clone(),
                from_s: a.from_s,
                ..AccuracyRequest::default()
            };
            let (ran, found) = run_within(&request, goal, &how, &watch)?;
            (ran, Some(found))
        }
    };
    drop(stop);
    print(&ran, found.as_ref(), a.json)?;
    match ran.problem() {
        Some(problem) => Err(Failure::work(problem)),
        None => Ok(()),
    }
}

fn print(ran: &Ran, found: Option<&Chosen>, as_json: bool) -> Result<(), Failure> {
    if as_json {
        let mut figures = ran.figures()?;
        if let Some(found) = found {
            figures["accuracy"] = run_within::figures(found);
        }
        console::json(&figures);
        return Ok(());
    }
    ran.lines()?.into_iter().for_each(console::data);
    let setting = found.map_or_else(Vec::new, run_within::lines);
    setting.into_iter().for_each(console::data);
    Ok(())
}
