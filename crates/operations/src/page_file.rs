//! Pages as files.

use crate::failure::{Failure, Result};
use crate::watch::Watch;
use gearmesh_model::write_text;
use gearmesh_report::page::Page;
use std::path::Path;

/// Renders a page and writes it, beside and renamed; its size is reported.
///
/// # Errors
/// [`Failure`] for a page that cannot be rendered or written.
pub fn write(page: &Page, path: &Path, watch: &Watch<'_>) -> Result<()> {
    let html = page.render().map_err(Failure::work)?;
    write_text(path, &html).map_err(Failure::work)?;
    let megabytes = html.len() as f64 * 1e-6;
    watch.note(format!("{}: {megabytes:.1} MB", path.display()));
    Ok(())
}
