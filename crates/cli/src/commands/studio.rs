//! `gearmesh studio`: a page in the browser for a gear pair or a result.

use std::process::{Command, Stdio};

use gearmesh_studio::{Opened, Problem, ServeOptions, serve};

use crate::arguments::StudioArguments;
use crate::console;
use crate::failure::Failure;
use crate::interrupt;

/// Programs that open an address in the user's browser.
const OPENERS: [&str; 3] = ["xdg-open", "open", "wslview"];

/// Runs the command: until Ctrl-C, or until the page ends it.
pub fn run(arguments: &StudioArguments) -> Result<(), Failure> {
    let opened = Opened::named(&arguments.file)?;
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
    })?;
    Ok(())
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

impl From<Problem> for Failure {
    fn from(problem: Problem) -> Self {
        if problem.is_input() {
            Self::input(problem)
        } else {
            Self::work(problem)
        }
    }
}
