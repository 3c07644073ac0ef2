//! `gearmesh init`: commented files to start from.

use crate::arguments::{InitArguments, InitKind};
use crate::console;
use gearmesh_model::write_folder;
use gearmesh_operations::Failure;
use serde_json::json;

const PINION: (&str, &str) = ("pinion.toml", include_str!("../../templates/pinion.toml"));
const WHEEL: (&str, &str) = ("wheel.toml", include_str!("../../templates/wheel.toml"));
const PAIR: (&str, &str) = ("pair.toml", include_str!("../../templates/pair.toml"));
const DRIVE: (&str, &str) = ("drive.toml", include_str!("../../templates/drive.toml"));
const GEARBOX: (&str, &str) = ("gearbox.toml", include_str!("../../templates/gearbox.toml"));

const BEVEL_PAIR: (&str, &str) = (
    "bevel_pair.toml",
    include_str!("../../templates/bevel_pair.toml"),
);
const BEVEL_PINION: (&str, &str) = (
    "bevel_pinion.toml",
    include_str!("../../templates/bevel_pinion.toml"),
);
const BEVEL_GEAR: (&str, &str) = (
    "bevel_gear.toml",
    include_str!("../../templates/bevel_gear.toml"),
);
const BEVEL_DRIVE: (&str, &str) = (
    "bevel_drive.toml",
    include_str!("../../templates/bevel_drive.toml"),
);

const PLANETARY: (&str, &str) = (
    "planetary.toml",
    include_str!("../../templates/planetary.toml"),
);
const PLANETARY_SUN: (&str, &str) = (
    "planetary_sun.toml",
    include_str!("../../templates/planetary_sun.toml"),
);
const PLANETARY_PLANET: (&str, &str) = (
    "planetary_planet.toml",
    include_str!("../../templates/planetary_planet.toml"),
);
const PLANETARY_RING: (&str, &str) = (
    "planetary_ring.toml",
    include_str!("../../templates/planetary_ring.toml"),
);

/// Runs the command.
pub fn run(a: &InitArguments) -> Result<(), Failure> {
    let (files, next): (&[(&str, &str)], &str) = match a.kind {
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
        .map(|f| f.0)
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
        .map(|(name, text)| ((*name).to_owned(), (*text).to_owned()))
        .collect();
    write_folder(&a.output, &named)?;
    if !a.json {
        for (name, _) in files {
            console::data(a.output.join(name).display());
        }
    }
    if a.json {
        let paths: Vec<_> = files.iter().map(|f| a.output.join(f.0)).collect();
        console::json(&json!({ "files": paths }));
    }
    console::note(format!("next, in that folder: {next}"));
    Ok(())
}
