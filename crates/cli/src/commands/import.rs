//! `gearmesh import`: a gearbox from a REXS file.

use crate::arguments::ImportArguments;
use crate::console;
use crate::failure::Failure;
use crate::overwriting::apart;
use gearmesh_geometry::input::read_bytes;
use gearmesh_model::write_text;
use gearmesh_rexs::container::MOST_MB;
use gearmesh_rexs::{Entry, Import, Meshes, import, model_file};
use serde_json::{Value, json};
use std::path::Path;

/// Runs the command.
pub fn run(a: &ImportArguments) -> Result<(), Failure> {
    let shown = a.model.display();
    let bytes = read_bytes(&a.model, MOST_MB << 20)
        .map_err(|cause| Failure::input(format!("{shown}: {cause}")))?;
    let stem = a.model.file_stem().unwrap_or_default().to_string_lossy();
    let with = if a.reduced {
        Meshes::Hybrid
    } else {
        Meshes::Iso6336
    };
    let made =
        import(bytes, &stem, with).map_err(|cause| Failure::input(format!("{shown}: {cause}")))?;
    let list = (
        "import.md".to_owned(),
        made.ledger.page(&format!(
            "Import of {}",
            a.model.file_name().unwrap_or_default().to_string_lossy()
        )),
    );
    std::fs::create_dir_all(&a.output)
        .map_err(|cause| Failure::work(format!("{}: {cause}", a.output.display())))?;
    let files = made.files.iter().map(|f| (f.name.clone(), f.text.clone()));
    for (name, text) in files.chain([list]) {
        write(&a.output.join(name), &text, &a.model)?;
    }
    if a.json {
        console::json(&figures(&made));
    } else {
        table(&made, a);
    }
    Ok(())
}

fn write(path: &Path, text: &str, model: &Path) -> Result<(), Failure> {
    apart(path, &[model.to_owned()])?;
    Ok(write_text(path, text)?)
}

fn table(made: &Import, a: &ImportArguments) {
    let folder = &a.output;
    let ledger = &made.ledger;
    console::data(format!(
        "REXS {}, {}: {} values taken, {} assumed, {} not represented ({})",
        made.version,
        made.application,
        ledger.taken.len(),
        ledger.assumed.len(),
        ledger.not_represented.len(),
        folder.join("import.md").display()
    ));
    for file in &made.files {
        console::data(folder.join(&file.name).display());
    }
    let parts = ledger.not_represented.iter().filter(|e| !e.is_value);
    for entry in parts {
        console::note(format!(
            "not represented: {}: {}",
            entry.subject, entry.text
        ));
    }
    for entry in &ledger.assumed {
        console::note(format!("assumed: {}: {}", entry.subject, entry.text));
    }
    if a.reduced {
        for gear in &made.gears {
            console::note(format!(
                "next: gearmesh reduce {} -o {}",
                folder.join(gear).display(),
                folder.join(model_file(gear)).display()
            ));
        }
    }
    if let Some(scene) = made.scenes.first() {
        console::note(format!(
            "next: gearmesh run {} -o result.h5",
            folder.join(scene).display()
        ));
    }
}

fn figures(made: &Import) -> Value {
    let list = |entries: &[Entry]| -> Value {
        entries
            .iter()
            .map(|e| json!({ "subject": e.subject, "text": e.text }))
            .collect()
    };
    json!({
        "version": made.version,
        "application": made.application,
        "files": made.files.iter().map(|f| &f.name).collect::<Vec<_>>(),
        "scenes": made.scenes,
        "gears": made.gears,
        "taken": list(&made.ledger.taken),
        "assumed": list(&made.ledger.assumed),
        "not_represented": list(&made.ledger.not_represented),
    })
}
