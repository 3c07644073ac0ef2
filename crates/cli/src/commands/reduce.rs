//! `gearmesh reduce`: the offline stage.

use crate::arguments::ReduceArguments;
use crate::console;
use gearmesh_operations::gear_file::GearFile;
use gearmesh_operations::reduce::{Reduction, figures, reduce_to, summary};
use gearmesh_operations::{Failure, output_name, overwriting};

/// Runs the command.
pub fn run(a: &ReduceArguments) -> Result<(), Failure> {
    overwriting::refuse(vec![a.gear.clone()], std::slice::from_ref(&a.output))?;
    output_name::demand_hdf5(&a.output)?;
    let watch = console::watch();
    let gear = GearFile::read(&a.gear, &watch)?;
    let how = Reduction {
        estimate_error: !a.no_error_estimate,
        even_if_memory_is_short: a.even_if_memory_is_short,
    };
    let model = reduce_to(&gear, how, &a.output, &watch)?;
    console::found(a.json, || figures(&model), || summary(&model));
    Ok(())
}
