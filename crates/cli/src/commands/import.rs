//! `gearmesh import`: a gearbox from a REXS file.

use crate::arguments::Printed;
use crate::console;
use gearmesh_operations::Failure;
use gearmesh_operations::import::{ImportRequest, import, line};
use gearmesh_operations::import_trial::{SceneRow, Trial};
use gearmesh_report::{column_width, short};
use gearmesh_rexs::{Entry, Import, Meshes, Weight, model_file};

/// Lines of one sort on the console; all are in the list.
const MOST_LINES: usize = 20;

/// Runs the command.
pub fn run(a: &Printed<ImportRequest>) -> Result<(), Failure> {
    let found = import(&a.request, &console::watch())?;
    told(&found.alarms, |text| console::warning(text));
    if let Some((others, first)) = found.refusal(&a.request) {
        told(&others, |text| console::error(text));
        return Err(first);
    }
    if a.json {
        console::json(&found.figures());
    } else {
        table(
            &found.made,
            found.with,
            &found.alarms,
            &found.trial,
            &a.request,
        );
    }
    Ok(())
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

fn table(made: &Import, with: Meshes, alarms: &[String], trial: &Trial, a: &ImportRequest) {
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
fn next(made: &Import, trial: &Trial, a: &ImportRequest) {
    let folder = &a.output;
    if a.reduced {
        // Of the planets of a set the scene has the first one's model.
        let scenes = made
            .files
            .iter()
            .filter(|file| made.scenes.contains(&file.name));
        let scenes: Vec<&str> = scenes.map(|file| file.text.as_str()).collect();
        let is_used = |gear: &str| {
            let model = format!("\"{}\"", model_file(gear));
            scenes.iter().any(|text| text.contains(&model))
        };
        for gear in made
            .gears
            .iter()
            .filter(|gear| trial.works(gear) && is_used(gear))
        {
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
