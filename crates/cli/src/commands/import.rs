//! `gearmesh import`: a gearbox from a REXS file.

use crate::arguments::ImportArguments;
use crate::commands::import_trial::{SceneRow, Trial};
use crate::console;
use crate::failure::Failure;
use crate::overwriting::apart;
use gearmesh_geometry::input::read_bytes;
use gearmesh_model::write_folder;
use gearmesh_report::{column_width, short};
use gearmesh_rexs::container::MOST_MB;
use gearmesh_rexs::{Entry, Import, Meshes, Running, Weight, import_to_run, model_file};
use serde_json::{Value, json};
use std::path::Path;

/// Lines of one sort on the console; all are in the list.
const MOST_LINES: usize = 20;

/// Runs the command.
pub fn run(a: &ImportArguments) -> Result<(), Failure> {
    let shown = a.model.display();
    let bytes = read_bytes(&a.model, MOST_MB << 20)
        .map_err(|cause| Failure::input(format!("{shown}: {cause}")))?;
    let stem = a.model.file_stem().unwrap_or_default().to_string_lossy();
    let made = |bytes, with, running| {
        import_to_run(bytes, &stem, with, running)
            .map_err(|cause| Failure::input(format!("{shown}: {cause}")))
    };
    let other = (a.reduced || a.transient).then(|| bytes.clone());
    let with = if a.reduced {
        Meshes::Hybrid
    } else {
        Meshes::Iso6336
    };
    let running = if a.transient {
        Running::InTime
    } else {
        Running::AtRest
    };
    let found = made(bytes, with, running)?;
    let list = (
        "import.md".to_owned(),
        found.ledger.page(
            &format!(
                "Import of {}",
                a.model.file_name().unwrap_or_default().to_string_lossy()
            ),
            with,
        ),
    );
    write(&found, &a.output, Some(list), &a.model)?;
    let mut trial = Trial::default();
    if !a.no_run {
        trial.check(&found, &a.output, !a.reduced);
        match other {
            None => trial.run(&found, &a.output)?,
            // The models of the gears are not there yet, motion takes its time: the loads are those of the same scene
            // with springs, at rest.
            Some(bytes) => {
                let scratch = tempfile::tempdir().map_err(Failure::work)?;
                let springs = made(bytes, Meshes::Iso6336, Running::AtRest)?;
                write(&springs, scratch.path(), None, &a.model)?;
                trial.run(&springs, scratch.path())?;
            }
        }
    }
    let alarms = alarms(&found, with, &trial);
    told(&alarms, |text| console::warning(text));
    if let Some((last, others)) = trial.refused.split_first() {
        let words =
            |(file, cause): &(String, Failure)| cause.clone().about(&a.output.join(file)).message;
        told(&others.iter().map(words).collect::<Vec<_>>(), |text| {
            console::error(text);
        });
        return Err(Failure {
            fault: last.1.fault,
            message: format!(
                "{shown}: its files are written, {} cannot be used: {}",
                match trial.refused.len() {
                    1 => "but one of them".to_owned(),
                    n => format!("but {n} of them"),
                },
                words(last)
            ),
        });
    }
    if a.json {
        console::json(&figures(&found, with, &alarms, &trial));
    } else {
        table(&found, with, &alarms, &trial, a);
    }
    Ok(())
}

fn write(
    made: &Import,
    folder: &Path,
    list: Option<(String, String)>,
    model: &Path,
) -> Result<(), Failure> {
    let files = made.files.iter().map(|f| (f.name.clone(), f.text.clone()));
    let files: Vec<(String, String)> = files.chain(list).collect();
    for (name, _) in &files {
        apart(&folder.join(name), &[model.to_owned()])?;
    }
    Ok(write_folder(folder, &files)?)
}

fn line(entry: &Entry) -> String {
    format!("{}: {}", entry.subject, entry.text)
}

/// What makes the scenes another gearbox than that of the file.
fn alarms(made: &Import, with: Meshes, trial: &Trial) -> Vec<String> {
    let entries = made.ledger.of_weight(Weight::Warning, with).map(line);
    entries.chain(trial.warnings.iter().cloned()).collect()
}

/// So many lines as a reader reads.
fn told(lines: &[String], say: impl Fn(&str)) {
    for line in lines.iter().take(MOST_LINES) {
        say(line);
    }
    if lines.len() > MOST_LINES {
        say(&format!(
            "and {} more of this sort in import.md",
            lines.len() - MOST_LINES
        ));
    }
}

fn table(made: &Import, with: Meshes, alarms: &[String], trial: &Trial, a: &ImportArguments) {
    let folder = &a.output;
    let ledger = &made.ledger;
    if let Some(row) = trial.scenes.first() {
        scene(row, a.reduced);
    }
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
    trial.notes.iter().for_each(console::note);
    let heavy: Vec<String> = ledger.of_weight(Weight::Heavy, with).map(line).collect();
    if !heavy.is_empty() {
        console::note(format!(
            "assumptions that may change a torque, a force or a stiffness by more than 1 %: {}",
            heavy.len()
        ));
        told(&heavy, |text| console::note(text));
    }
    let light = ledger.of_weight(Weight::Light, with);
    let values = { light }.partition::<Vec<&Entry>, _>(|e| e.is_value);
    console::note(format!(
        "{} further assumptions and omissions of less than 1 %, and {} values that nothing asked for: {}",
        values.1.len(),
        values.0.len(),
        folder.join("import.md").display()
    ));
    if alarms.is_empty() {
        next(made, trial, a);
    } else {
        console::note(format!(
            "next: put right in {} what the warnings say, and import it again",
            a.model.display()
        ));
    }
}

/// What works after this.
fn next(made: &Import, trial: &Trial, a: &ImportArguments) {
    let folder = &a.output;
    if a.reduced {
        for gear in made.gears.iter().filter(|gear| trial.works(gear)) {
            console::note(format!(
                "next: gearmesh reduce {} -o {}",
                folder.join(gear).display(),
                folder.join(model_file(gear)).display()
            ));
        }
    }
    if let Some(scene) = made.scenes.first()
        && trial.works(scene)
        && made.gears.iter().all(|gear| trial.works(gear))
    {
        console::note(format!(
            "next: gearmesh run {} -o result.h5",
            folder.join(scene).display()
        ));
    }
}

/// The figures of a scene at rest.
fn scene(row: &SceneRow, reduced: bool) {
    let springs = if reduced {
        ", with springs of ISO 6336 for the reduced gears that are not there yet"
    } else {
        ""
    };
    console::data(format!("{} at rest under its loads{springs}:", row.scene));
    let names = (row.ports.iter().map(|p| &p.name))
        .chain(row.shafts.iter().map(|s| &s.0))
        .chain(row.bearings.iter().map(|b| &b.0))
        .chain(row.meshes.iter().map(|m| &m.0));
    let width = column_width(names, 8);
    let print = |name: &str, cells: &[String]| {
        let cells = cells.iter().map(|c| format!(" {c:>14}"));
        console::data(format!("{name:width$}{}", cells.collect::<String>()));
    };
    let heads = |name: &str, heads: &[&str]| {
        print(
            name,
            &heads.iter().map(|h| (*h).to_owned()).collect::<Vec<_>>(),
        );
    };
    heads("load", &["speed 1/min", "torque N m", "power W"]);
    for p in &row.ports {
        print(
            &p.name,
            &[short(p.speed_rpm), short(p.torque_nm), short(p.power_w)],
        );
    }
    let [input, output] = row.power_w();
    console::data(format!(
        "power in {} W, out {} W",
        short(input),
        short(output)
    ));
    heads("shaft", &["speed 1/min", "torque N m"]);
    for (name, speed, torque) in row.shafts.iter().take(MOST_LINES) {
        print(name, &[short(*speed), short(*torque)]);
    }
    heads("bearing", &["radial N", "axial N"]);
    for (name, radial, axial) in row.bearings.iter().take(2 * MOST_LINES) {
        print(name, &[short(*radial), short(*axial)]);
    }
    if !row.meshes.is_empty() {
        heads("mesh", &["normal force N", "K_Hbeta"]);
    }
    for (name, force, k_h_beta) in row.meshes.iter().take(MOST_LINES) {
        let k_h_beta = k_h_beta.map_or("-".to_owned(), |k| format!("{k:.4}"));
        print(name, &[short(*force), k_h_beta]);
    }
}

fn figures(made: &Import, with: Meshes, alarms: &[String], trial: &Trial) -> Value {
    let list = |entries: &[Entry]| -> Value {
        entries
            .iter()
            .map(|e| {
                let weight = match e.about.weight(with) {
                    Weight::Warning => "warning",
                    Weight::Heavy => "more than 1 %",
                    Weight::Light => "less than 1 %",
                };
                json!({ "subject": e.subject, "text": e.text, "weight": weight })
            })
            .collect()
    };
    json!({
        "version": made.version,
        "application": made.application,
        "warnings": alarms,
        "at_rest": trial.json(),
        "files": made.files.iter().map(|f| &f.name).collect::<Vec<_>>(),
        "scenes": made.scenes,
        "gears": made.gears,
        "taken": list(&made.ledger.taken),
        "assumed": list(&made.ledger.assumed),
        "not_represented": list(&made.ledger.not_represented),
    })
}
