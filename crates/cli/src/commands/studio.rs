//! `gearmesh studio`: a page in the browser for a gear pair, a result, or something new.

use std::process::{Command, Stdio};

use gearmesh_operations::Failure;
use gearmesh_studio::{Opened, Problem, ServeOptions, serve};

use crate::arguments::StudioArguments;
use crate::console;
use crate::interrupt;

/// Programs that open an address in the user's browser.
const OPENERS: [&str; 3] = ["xdg-open", "open", "wslview"];

/// Runs the command: until Ctrl-C, or until the page ends it.
pub fn run(arguments: &StudioArguments) -> Result<(), Failure> {
    let opened = match &arguments.file {
        Some(file) => Opened::named(file).map_err(failure)?,
        None => Opened::New(None),
    };
    let opened = match &arguments.beside {
        Some(other) => opened.beside(other).map_err(failure)?,
        None => opened,
    };
    let demand = interrupt::on_demand();
    let options = ServeOptions {
        port: arguments.port,
        stop: demand.asked.clone(),
    };
    serve(opened, &options, |url| {
        console::data(url);
        if !arguments.no_open && !open(url) {
            console::note("no browser was found; open the address above");
        }
        console::note("Ctrl-C ends it");
    })
    .map_err(failure)
}

/// Opens the address in a browser; false where none of the openers is there.
fn open(url: &str) -> bool {
    OPENERS.iter().any(|opener| {
        let mut command = Command::new(opener);
        let silent = [Stdio::null(), Stdio::null(), Stdio::null()];
        let [input, output, errors] = silent;
        command.arg(url).stdin(input).stdout(output).stderr(errors);
        command.spawn().is_ok()
    })
}

/// What the page's server ends with.
fn failure(problem: Problem) -> Failure {
    match problem.is_input() {
        true => Failure::input(problem),
        false => Failure::work(problem),
    }
}
