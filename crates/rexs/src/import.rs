//! A REXS file into gear files, bearing files, bevel pair files, scenes and the list of what became of it.

use crate::bevel;
use crate::container::{Unpacked, unpack};
use crate::effort;
use crate::error::{Result, RexsError};
use crate::gear_text::gear_file;
use crate::ledger::{About, Ledger};
use crate::mesh_model::Meshes;
use crate::model::{Component, LoadCase, Model};
use crate::running::Running;
use crate::scene_text::scene;
use crate::sheet::Sheet;
use crate::source::{Part, Source};
use crate::structure::Structure;
use crate::text::file_stem;
use crate::train;
use crate::units::{HOUR, M_PER_S2, ONE};
use crate::{json, unjoined, versions, xml};
use std::cell::RefCell;
use std::collections::{BTreeSet, HashSet};

/// A file that was made.
#[derive(Debug, Clone)]
pub struct ImportedFile {
    /// Name.
    pub name: String,
    /// Text.
    pub text: String,
}

/// What was made of a REXS file.
#[derive(Debug)]
pub struct Import {
    /// Version as stated.
    pub version: String,
    /// Program that wrote it.
    pub application: String,
    /// Files, scenes first.
    pub files: Vec<ImportedFile>,
    /// Names of the scenes among them.
    pub scenes: Vec<String>,
    /// Names of the gear files among them.
    pub gears: Vec<String>,
    /// What each scene must show when it runs.
    pub sheets: Vec<Sheet>,
    /// What became of it.
    pub ledger: Ledger,
    /// How often components, attributes, references of relations, shafts and gears were looked at.
    pub visits: u64,
}

/// Types that the import knows; what others hold is listed, with their names.
const KNOWN: [&str; 40] = [
    "gear_unit",
    "gear_casing",
    "shaft",
    "shaft_section",
    "cylindrical_gear",
    "ring_gear",
    "worm_gear",
    "worm_wheel",
    "bevel_gear",
    "gear_body",
    "cylindrical_gear_flank",
    "bevel_gear_flank",
    "rack_shaped_tool",
    "cutter_wheel_tool",
    "profile_tool",
    "cylindrical_stage",
    "bevel_stage",
    "planetary_stage",
    "worm_stage",
    "cylindrical_stage_gear_data",
    "bevel_stage_gear_data",
    "concept_bearing",
    "rolling_bearing_with_catalog_geometry",
    "rolling_bearing_with_detailed_geometry",
    "hydrodynamic_radial_plain_bearing",
    "coupling",
    "switchable_coupling",
    "external_load",
    "additional_mass",
    "material",
    "tip_relief",
    "root_relief",
    "profile_crowning",
    "profile_slope",
    "profile_twist",
    "helix_crowning",
    "helix_slope",
    "end_relief_datum_face",
    "end_relief_non_datum_face",
    "topographical_modification",
];

/// Imports a file to scenes at rest. `stem` begins the names of the files that are made; `with` is what the scene
/// computes its gear meshes with.
///
/// # Errors
/// [`RexsError`] for files that are no REXS or lack what a gearbox cannot do without.
pub fn import(bytes: Vec<u8>, stem: &str, with: Meshes) -> Result<Import> {
    import_to_run(bytes, stem, with, Running::AtRest)
}

/// As [`import`], to scenes at rest or in time.
///
/// # Errors
/// As [`import`], and [`RexsError::Missing`] for scenes in time of a gearbox whose gears do not turn.
pub fn import_to_run(bytes: Vec<u8>, stem: &str, with: Meshes, running: Running) -> Result<Import> {
    let before = effort::visits();
    let unpacked = unpack(bytes)?;
    let mut ledger = Ledger::default();
    let mut model = parse(&unpacked)?;
    for further in &unpacked.further {
        ledger.leave_out("the zip file", About::Nothing, format!("member {further}"));
    }
    versions::bring_up_to_date(&mut model, &mut ledger)?;
    for unknown in &model.unknown {
        ledger.leave_out("the file", About::Nothing, unknown.clone());
    }
    let structure = Structure::new(&model, &mut ledger)?;
    let ledger = RefCell::new(ledger);
    let used = RefCell::new(BTreeSet::new());
    let stem = file_stem(stem);
    let cases: Vec<&LoadCase> = model.spectra.iter().flat_map(|s| &s.cases).collect();
    list_strangers(&model, &cases, &mut ledger.borrow_mut());
    let mut made = Made {
        with,
        running,
        ..Made::default()
    };
    if cases.is_empty() {
        let source = Source::new(&model, &structure, &ledger, &used);
        made.case(&source, &stem, &model, None)?;
    }
    for (i, case) in cases.iter().enumerate() {
        let in_case = model.in_case(case);
        let source = Source::new(&in_case, &structure, &ledger, &used);
        let mut name = match i {
            0 => stem.clone(),
            _ => format!("{stem}_case_{}", case.id),
        };
        // Cases of several spectra may have the same numbers.
        if made.scenes.contains(&format!("{name}.toml")) {
            name = format!("{stem}_case_{}_{}", i + 1, case.id);
        }
        made.case(&source, &name, &model, Some(case))?;
        if i + 1 == cases.len() {
            source.list_unused();
        }
    }
    if cases.len() > 1 && running == Running::AtRest {
        match study(&made, &stem) {
            Some(text) => made.add(format!("{stem}_study.toml"), text),
            None => ledger.borrow_mut().assume(
                "the load spectrum",
                About::Nothing,
                "its cases differ in more than one torque: a scene for each case, no study",
            ),
        }
    }
    list_accumulated(&model, &mut ledger.borrow_mut());
    let source = Source::new(&model, &structure, &ledger, &used);
    unjoined::list(&source);
    if cases.is_empty() {
        source.list_unused();
    }
    let unknown = |c: &&Component| !KNOWN.contains(&c.kind.as_str());
    for component in model.components.iter().filter(unknown) {
        let what = "components of this type have no counterpart";
        Part::new(&source, component).leave_out(About::Nothing, what);
    }
    Ok(Import {
        version: model.version.clone(),
        application: model.application.clone(),
        files: made.files,
        scenes: made.scenes,
        gears: made.gears,
        sheets: made.sheets,
        ledger: ledger.into_inner(),
        visits: effort::visits() - before,
    })
}

/// Lists what load cases say of components that the file does not have.
fn list_strangers(model: &Model, cases: &[&LoadCase], ledger: &mut Ledger) {
    for case in cases {
        let subject = format!("load case {}", case.id);
        for id in case.components.iter().map(|c| c.id) {
            if model.component(id).is_none() {
                let what = format!("values of component {id}, which is not in the file");
                ledger.leave_out(&subject, About::Lost, what);
            }
        }
    }
}

/// Lists the results of the other program over all load cases.
fn list_accumulated(model: &Model, ledger: &mut Ledger) {
    for component in model.spectra.iter().flat_map(|s| &s.accumulation) {
        let (count, words) = (component.attributes.len(), component.words());
        if count > 0 {
            let what = format!("{count} values of {words}: results of the other program");
            ledger.leave_out("accumulation of the load spectrum", About::Nothing, what);
        }
    }
}

fn parse(unpacked: &Unpacked) -> Result<Model> {
    match unpacked.text.trim_start().chars().next() {
        Some('<') => xml::read(&unpacked.text),
        Some('{') => json::read(&unpacked.text),
        Some(c) => Err(RexsError::Container {
            found: format!("text that begins with `{c}`"),
        }),
        None => Err(RexsError::Container {
            found: "nothing".to_owned(),
        }),
    }
}

#[derive(Default)]
struct Made {
    with: Meshes,
    running: Running,
    files: Vec<ImportedFile>,
    scenes: Vec<String>,
    gears: Vec<String>,
    sheets: Vec<Sheet>,
    /// Names of files, and of gear files.
    names: HashSet<String>,
    gear_names: HashSet<String>,
}

impl Made {
    fn add(&mut self, name: String, text: String) {
        if self.names.insert(name.clone()) {
            self.files.push(ImportedFile { name, text });
        }
    }

    /// Scene, gears and bearings of a load case; gears and bearings are the same in all.
    fn case(
        &mut self,
        source: &Source<'_>,
        name: &str,
        base: &Model,
        case: Option<&LoadCase>,
    ) -> Result<()> {
        let stem = name.split("_case_").next().unwrap_or(name);
        let train = train::read(source, stem)?;
        let (mut head, gravity) = unit_values(source, base, case)?;
        if !train.shafts.is_empty() {
            let unit = source.of_kind(&["gear_unit"]).next();
            let title = unit.map_or(name, |unit| unit.component.name_or(name));
            let title = case.map_or(title.to_owned(), |c| format!("{title}, load case {}", c.id));
            head.push(
                "What was taken, assumed and not represented stands in the list beside this file."
                    .to_owned(),
            );
            let file = format!("{name}.toml");
            let (text, held) = scene(
                source,
                &train,
                (&title, &head),
                gravity,
                (self.with, self.running),
            )?;
            self.sheets.push(Sheet::new(&file, &train, held));
            self.add(file.clone(), text);
            self.scenes.push(file);
        } else {
            source.ledger().assume(
                "the file",
                About::Lost,
                "no scene: no shaft of it carries anything (relations of type assembly join gears, bearings and loads to shafts)",
            );
        }
        let origin = head.first().cloned().unwrap_or_default();
        for seated in train.gears.iter() {
            let file = seated.gear.file.clone();
            self.add(file.clone(), gear_file(&seated.gear, &origin));
            if self.gear_names.insert(file.clone()) {
                self.gears.push(file);
            }
        }
        for (file, text) in train.bearings.iter().filter_map(|b| b.file.clone()) {
            self.add(file, text);
        }
        for (i, stage) in source.structure.stages().iter().enumerate() {
            let found = [stage.id, stage.gears[0], stage.gears[1]].map(|id| source.part(id));
            let [Some(component), Some(g1), Some(g2)] = found else {
                continue;
            };
            if component.kind == "bevel_stage"
                && let Some(text) = bevel::pair_file(component, [g1, g2])?
            {
                self.add(format!("{stem}_bevel_{}.toml", i + 1), text);
            }
        }
        if self.files.is_empty() {
            return Err(RexsError::Missing {
                component: "the file".to_owned(),
                what: "holds no shaft with anything on it, no cylindrical gear and no bevel pair: nothing to import"
                    .to_owned(),
            });
        }
        Ok(())
    }
}

/// The load cases as a study of the first one's scene, where they differ in one torque only.
fn study(made: &Made, stem: &str) -> Option<String> {
    let texts: Vec<Vec<&str>> = made
        .scenes
        .iter()
        .filter_map(|name| made.files.iter().find(|f| f.name == *name))
        .map(|f| {
            f.text
                .lines()
                .filter(|l| !l.starts_with(['#']) && !l.starts_with("title"))
                .collect()
        })
        .collect();
    let first = texts.first()?;
    let mut place = None;
    for other in &texts[1..] {
        if other.len() != first.len() {
            return None;
        }
        for (i, _) in first
            .iter()
            .zip(other)
            .enumerate()
            .filter(|(_, (a, b))| a != b)
        {
            if place.is_some_and(|p| p != i) || !first[i].starts_with("torque_Nm = ") {
                return None;
            }
            place = Some(i);
        }
    }
    let place = place?;
    let load = first[..place].iter().filter(|l| **l == "[[load]]").count() - 1;
    let values: Vec<&str> = texts
        .iter()
        .map(|t| t[place].trim_start_matches("torque_Nm = "))
        .collect();
    let bearings: Vec<String> = (0..first.len().saturating_sub(1))
        .filter(|&i| first[i] == "[[bearing]]")
        .filter_map(|i| first[i + 1].strip_prefix("name = \"")?.strip_suffix('"'))
        .map(|name| format!("\"elements/{name}/force_radial_N\""))
        .collect();
    Some(format!(
        "# The load cases, by the torque in which they differ: `gearmesh study {stem}_study.toml -o DIR`.\n\
         title = \"Load cases\"\nscene = \"{stem}.toml\"\ndesign = \"grid\"\ncolumns = [{}]\n\n\
         [[parameter]]\nname = \"torque N m\"\nkeys = [\"load.{load}.torque_Nm\"]\nvalues = [{}]\n",
        bearings.join(", "),
        values.join(", ")
    ))
}

/// Head lines and gravity of the scene.
fn unit_values(
    source: &Source<'_>,
    base: &Model,
    case: Option<&LoadCase>,
) -> Result<(Vec<String>, Option<[f64; 3]>)> {
    let mut head = vec![format!(
        "Imported from REXS {}{}",
        base.version,
        if base.application.is_empty() {
            String::new()
        } else {
            format!(", written by {}", base.application)
        }
    )];
    let mut gravity = None;
    for unit in source.of_kind(&["gear_unit"]) {
        let share = unit.number("operating_time_fraction", ONE)?;
        let hours = unit.number("operating_time", HOUR)?;
        if let Some(case) = case {
            let mut words = format!("Load case {}", case.id);
            if let Some(share) = share {
                words.push_str(&format!(", {:.4} % of the time", 100.0 * share));
            }
            if let Some(hours) = hours {
                words.push_str(&format!(", {hours} h"));
            }
            head.push(words);
        }
        if unit.flag("account_for_gravity")? == Some(true) {
            let size = unit
                .number("gravitational_acceleration", M_PER_S2)?
                .unwrap_or(9.81);
            let mut direction = [0.0; 3];
            for (value, axis) in direction.iter_mut().zip(["u", "v", "w"]) {
                *value = unit
                    .number(&format!("direction_vector_gravity_{axis}"), ONE)?
                    .unwrap_or(0.0);
            }
            match crate::vectors::unit(direction) {
                Some(direction) => gravity = Some(direction.map(|x| size * x)),
                None => unit.leave_out(About::Lost, "gravity without a direction"),
            }
        }
    }
    Ok((head, gravity))
}
