//! `gearmesh check`: reads a file of any kind and says what it is, or what is wrong with it.

use crate::arguments::CheckArguments;
use crate::console;
use gearmesh_operations::Failure;
use gearmesh_operations::check::check;

/// Runs the command.
pub fn run(a: &CheckArguments) -> Result<(), Failure> {
    let found = check(&a.file)?;
    found.notes.iter().for_each(console::note);
    found.slips.iter().for_each(console::warning);
    if a.json {
        console::json(&found.figures(&a.file));
    } else {
        found.lines(&a.file).into_iter().for_each(console::data);
    }
    match found.problem {
        Some(problem) => Err(Failure::work(problem)),
        None => Ok(()),
    }
}
