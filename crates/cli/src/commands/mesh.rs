//! `gearmesh mesh`: a gear's mesh for other programs.

use crate::arguments::MeshArguments;
use crate::console;
use gearmesh_operations::{Failure, mesh::MeshRequest, mesh::mesh};

/// Runs the command.
pub fn run(a: &MeshArguments) -> Result<(), Failure> {
    let request = MeshRequest {
        gear: a.gear.clone(),
        output: a.output.clone(),
        length_unit: a.length_unit,
        even_if_memory_is_short: a.even_if_memory_is_short,
    };
    let found = mesh(&request, &console::watch())?;
    if a.json {
        console::json(&found.figures());
    } else {
        console::data(format!(
            "{}: {} nodes, {} {}, {} degrees of freedom, {} repeating sectors",
            found.name, found.nodes, found.elements, found.shapes, found.dofs, found.sectors
        ));
        console::data(format!(
            "scaled Jacobian: smallest {:.3}, mean {:.3} (demanded {:.3})",
            found.quality.smallest, found.quality.mean, found.demanded
        ));
    }
    Ok(())
}
