//! `gearmesh mesh`: a gear's mesh for other programs.

use crate::arguments::Printed;
use crate::console;
use gearmesh_operations::{Failure, mesh::MeshRequest, mesh::mesh};

/// Runs the command.
pub fn run(a: &Printed<MeshRequest>) -> Result<(), Failure> {
    let found = mesh(&a.request, &console::watch())?;
    let lines = || {
        vec![
            format!(
                "{}: {} nodes, {} {}, {} degrees of freedom, {} repeating sectors",
                found.name, found.nodes, found.elements, found.shapes, found.dofs, found.sectors
            ),
            format!(
                "scaled Jacobian: smallest {:.3}, mean {:.3} (demanded {:.3})",
                found.quality.smallest, found.quality.mean, found.demanded
            ),
        ]
    };
    console::found(a.json, || found.figures(), lines);
    Ok(())
}
