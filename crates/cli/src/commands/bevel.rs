//! `gearmesh bevel`: blank, machine settings and checks of a bevel pair.

use crate::arguments::BevelArguments;
use crate::console;
use gearmesh_operations::Failure;
use gearmesh_operations::bevel_pair::{BevelRequest, design};

/// Runs the command.
pub fn run(a: &BevelArguments) -> Result<(), Failure> {
    let request = BevelRequest {
        pair: a.pair.clone(),
        grid: a.grid.clone(),
        grid_size: [0, 1].map(|i: usize| a.grid_size[i]),
    };
    let found = design(&request, &console::watch())?;
    if a.json {
        console::json(&found.figures);
    } else {
        found.lines.into_iter().for_each(console::data);
    }
    Ok(())
}
