//! `gearmesh init`: commented files to start from.

use crate::arguments::{InitArguments, InitKind};
use crate::console;
use gearmesh_model::write_folder;
use gearmesh_operations::Failure;
use gearmesh_operations::templates::{
    BEVEL_DRIVE, BEVEL_GEAR, BEVEL_PAIR, BEVEL_PINION, DRIVE, GEARBOX, PAIR, PINION, PLANETARY,
    PLANETARY_PLANET, PLANETARY_RING, PLANETARY_SUN, Template, WHEEL,
};
use serde_json::json;

/// Runs the command.
pub fn run(a: &InitArguments) -> Result<(), Failure> {
    let (files, next): (&[Template], &str) = match a.kind {
        InitKind::Gear => (&[PINION], "gearmesh reduce pinion.toml -o pinion.h5"),
        InitKind::Pair => (
            &[PINION, WHEEL, PAIR, DRIVE],
            "gearmesh run drive.toml -o drive.h5",
        ),
        InitKind::Gearbox => (
            &[PINION, WHEEL, GEARBOX],
            "gearmesh run gearbox.toml -o gearbox.h5",
        ),
        InitKind::Planetary => (
            &[PLANETARY_SUN, PLANETARY_PLANET, PLANETARY_RING, PLANETARY],
            "gearmesh run planetary.toml -o planetary.h5",
        ),
        InitKind::Bevel => (
            &[BEVEL_PAIR, BEVEL_PINION, BEVEL_GEAR, BEVEL_DRIVE],
            "gearmesh tca bevel_pair.toml --report bevel_pair.html",
        ),
    };
    let there: Vec<&str> = files
        .iter()
        .map(|f| f.name)
        .filter(|name| a.output.join(name).symlink_metadata().is_ok())
        .collect();
    if !there.is_empty() {
        return Err(Failure::input(format!(
            "{}: {} there already and left as it is; name another folder with -o",
            a.output.display(),
            if there.len() == 1 {
                format!("{} is", there[0])
            } else {
                format!("{} are", there.join(", "))
            }
        )));
    }
    let named: Vec<(String, String)> = files
        .iter()
        .map(|f| (f.name.to_owned(), f.text.to_owned()))
        .collect();
    write_folder(&a.output, &named)?;
    if !a.json {
        for file in files {
            console::data(a.output.join(file.name).display());
        }
    }
    if a.json {
        let paths: Vec<_> = files.iter().map(|f| a.output.join(f.name)).collect();
        console::json(&json!({ "files": paths }));
    }
    console::note(format!("next, in that folder: {next}"));
    Ok(())
}
