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
    console::found(a.json, || found.figures(&a.file), || found.lines(&a.file));
    match found.problem {
        Some(problem) => Err(Failure::work(problem)),
        None => Ok(()),
    }
}
