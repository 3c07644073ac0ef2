//! The `gearmesh` program: parses arguments, calls the crates, prints. Data go to standard output, progress to
//! standard error; exit code 0, 1 (the work failed) or 2 (the input is wrong).

mod arguments;
mod commands;
mod console;
mod interrupt;
mod progress_lines;

use clap::Parser;
use commands::Arguments;
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
    let outcome = sound.and_then(|()| arguments.command.run());
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
