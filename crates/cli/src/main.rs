//! The `gearmesh` program: parses arguments, calls the crates, prints. Data go to standard output, progress to
//! standard error; exit code 0, 1 (the work failed) or 2 (the input is wrong).

mod arguments;
mod commands;
mod console;
mod interrupt;
mod overwriting;
mod progress_lines;

use arguments::{Arguments, Command};
use clap::Parser;
use gearmesh_operations::{Failure, Fault};
use std::process::ExitCode;

fn main() -> ExitCode {
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(told) => return ExitCode::from(console::usage(&told)),
    };
    gearmesh_fe::split_alike();
    let sound = gearmesh_geometry::input::demand_threads().map_err(Failure::from);
    let sound = sound.and_then(|()| interrupt::install());
    let sound = sound.and_then(|()| overwriting::refuse(&arguments.command));
    let outcome = sound.and_then(|()| match &arguments.command {
        Command::Mesh(a) => commands::mesh::run(a),
        Command::Reduce(a) => commands::reduce::run(a),
        Command::Modes(a) => commands::modes::run(a),
        Command::Compliance(a) => commands::compliance::run(a),
        Command::Plan(a) => commands::plan(a),
        Command::Run(a) => commands::run::run(a),
        Command::Recover(a) => commands::recover::run(a),
        Command::Compare(a) => commands::compare::run(a),
        Command::Export(a) => commands::export(a),
        Command::Record(a) => commands::record::run(a),
        Command::Report(a) => commands::report(a),
        Command::Studio(a) => commands::studio::run(a),
        Command::Signal(a) => commands::signal::run(a),
        Command::Check(a) => commands::check::run(a),
        Command::Accuracy(a) => commands::accuracy::run(a),
        Command::Study(a) => commands::study::run(a),
        Command::Optimise(a) => commands::optimise::run(a),
        Command::Schema(a) => commands::schema::run(a),
        Command::Bearing(a) => commands::bearing::run(a),
        Command::BearingFrequencies(a) => commands::bearing_frequencies::run(a),
        Command::Bevel(a) => commands::bevel(a),
        Command::Tca(a) => commands::tca(a),
        Command::Import(a) => commands::import::run(a),
        Command::Init(a) => commands::init::run(a),
        Command::Doctor(a) => commands::doctor::run(a),
        Command::Completions(a) => commands::completions::completions(a),
        Command::Man(a) => commands::completions::man(a),
        Command::Demo(a) => commands::demo::run(a),
    });
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            console::error(&failure.message);
            match failure.fault {
                Fault::Work => ExitCode::from(1),
                Fault::Input => ExitCode::from(2),
                Fault::Stopped => ExitCode::from(interrupt::EXIT_CODE),
            }
        }
    }
}
