//! `gearmesh completions` and `gearmesh man`: made from the arguments, so that they never lag behind.

use super::Arguments;
use crate::arguments::{CompletionsArguments, ManArguments};
use crate::console;
use clap::CommandFactory;
use gearmesh_model::write_bytes;
use gearmesh_operations::Failure;

/// Runs `gearmesh completions`.
pub fn completions(a: &CompletionsArguments) -> Result<(), Failure> {
    let mut script = Vec::new();
    clap_complete::generate(a.shell, &mut Arguments::command(), "gearmesh", &mut script);
    console::data(String::from_utf8_lossy(&script).trim_end());
    Ok(())
}

/// Runs `gearmesh man`.
pub fn man(a: &ManArguments) -> Result<(), Failure> {
    let failed = |cause: std::io::Error| Failure::work(format!("{}: {cause}", a.output.display()));
    std::fs::create_dir_all(&a.output).map_err(failed)?;
    // They are generated as plain files, which would follow links; outputs do not.
    let scratch = tempfile::tempdir().map_err(Failure::work)?;
    clap_mangen::generate_to(Arguments::command(), scratch.path()).map_err(failed)?;
    for page in std::fs::read_dir(scratch.path()).map_err(Failure::work)? {
        let page = page.map_err(Failure::work)?;
        let text = std::fs::read(page.path()).map_err(Failure::work)?;
        write_bytes(&a.output.join(page.file_name()), &text)?;
    }
    console::data(a.output.join("gearmesh.1").display());
    Ok(())
}
