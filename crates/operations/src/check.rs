//! Reads a file of any kind and says what it is, or what is wrong with it.

use crate::bevel_pair::{thickness_figures, thickness_words};
use crate::failure::{Failure, Result};
use crate::gear_file::demand_body_file;
use crate::tca_sides::edge_words;
use crate::{reduce, system_table};
use gearmesh_bearings::QuasiStaticBearing;
use gearmesh_bearings::bearing_file::BearingFromFile;
use gearmesh_bevel::{BevelError, BevelGear, PairFile};
use gearmesh_geometry::InputError;
use gearmesh_geometry::input::InputDocument;
use gearmesh_geometry::{GearDefinition, Gearing, InternalRoot};
use gearmesh_model::{REDUCED_GEAR_FORMAT, format_of, read_reduced_gear};
use gearmesh_report::ReferenceRecord;
use gearmesh_scene::optimise::Evaluator;
use gearmesh_scene::pair::BevelScene;
use gearmesh_scene::rating::sn_curve;
use gearmesh_scene::study::{RestCases, Scratch, StudyScenes};
use gearmesh_scene::system_run::RunJob;
use gearmesh_scene::{InputKind, ResultFile, SceneFile, load};
use gearmesh_specification::optimise::Optimisation;
use gearmesh_specification::study::Study;
use serde_json::{Map, Value, json};
use std::path::Path;
use std::sync::atomic::AtomicBool;

/// What a sound file is.
#[derive(Debug)]
pub struct Finding {
    /// Kind of file, as a word.
    kind: &'static str,
    /// What it calls itself; none where it has no name.
    name: Option<String>,
    /// What is said behind `sound`.
    size: Option<String>,
    /// Counts and the like by name.
    facts: Map<String, Value>,
    /// Further lines for people.
    lines: Vec<String>,
    /// What is wrong with a file that can be read all the same.
    pub problem: Option<String>,
    /// Remarks.
    pub notes: Vec<String>,
    /// Numbers that look like those of another unit.
    pub slips: Vec<InputError>,
}

impl Finding {
    fn new(kind: &'static str, name: Option<&str>) -> Self {
        Self {
            kind,
            name: name.map(str::to_owned),
            size: None,
            facts: Map::new(),
            lines: Vec::new(),
            problem: None,
            notes: Vec::new(),
            slips: Vec::new(),
        }
    }

    /// Adds what is said behind `sound`, and the same as values by name.
    fn sized(mut self, size: String, facts: Value) -> Self {
        self.size = Some(size);
        if let Value::Object(facts) = facts {
            self.facts.extend(facts);
        }
        self
    }

    /// For people: the first line names the file.
    #[must_use]
    pub fn lines(&self, path: &Path) -> Vec<String> {
        let of = if self.kind == "result" { " of" } else { "" };
        let name = (self.name.as_ref()).map_or(String::new(), |name| format!("{of} `{name}`"));
        let verdict = self.problem.as_ref().map_or("sound", |_| "not sound");
        let size = (self.size.as_ref()).map_or(String::new(), |size| format!(": {size}"));
        let (path, kind) = (path.display(), self.kind);
        let mut lines = vec![format!("{path}: {kind}{name}, {verdict}{size}")];
        lines.extend(self.lines.iter().cloned());
        lines
    }

    /// For other programs.
    #[must_use]
    pub fn figures(&self, path: &Path) -> Value {
        let mut all = json!({
            "file": path,
            "kind": self.kind,
            "name": self.name,
            "sound": self.problem.is_none(),
            "warnings": self.notes.iter().cloned().chain(self.slips.iter().map(ToString::to_string)).collect::<Vec<_>>(),
        });
        if let Value::Object(all) = &mut all {
            all.extend(self.facts.clone());
        }
        all
    }
}

/// Demands that a file can be used. Numbers that look like those of another unit.
///
/// # Errors
/// What is wrong with it.
pub fn demand(path: &Path) -> Result<Vec<InputError>> {
    let found = check(path)?;
    match found.problem {
        Some(problem) => Err(Failure::work(problem)),
        None => Ok(found.slips),
    }
}

/// Says what a file is.
///
/// # Errors
/// What is wrong with it.
pub fn check(path: &Path) -> Result<Finding> {
    let ends_in = |ending: &str| {
        path.extension()
            .is_some_and(|e| e.eq_ignore_ascii_case(ending))
    };
    if ends_in("h5") || ends_in("hdf5") {
        return if format_of(path).map_err(Failure::input)? == REDUCED_GEAR_FORMAT.name {
            model(path)
        } else {
            result(path)
        };
    }
    if path.join("record.toml").is_file() {
        return record(path);
    }
    let document = InputDocument::read(path)?;
    let folder = path.parent().unwrap_or(Path::new(""));
    match InputKind::of(&document)? {
        InputKind::Scene => scene(SceneFile::from_document(document, folder)?),
        InputKind::Study => study(&Study::from_document(document, folder)?),
        InputKind::Optimisation => optimisation(&Optimisation::from_document(document, folder)?),
        InputKind::SnTable => sn_table(&document),
        InputKind::Record => record(folder),
        InputKind::Gear if PairFile::recognises(&document)? => {
            bevel_pair(&BevelScene::from_document(document)?)
        }
        InputKind::Gear if BevelGear::recognises(&document)? => bevel_gear(&document, folder),
        InputKind::Gear if BearingFromFile::recognises(&document)? => bearing(&document),
        InputKind::Gear => gear(&document),
    }
}

/// What is found in a bevel pair, assembled without load.
///
/// # Errors
/// [`Failure`] for flanks that cannot be made, do not touch or jam.
pub fn bevel_pair(scene: &BevelScene) -> Result<Finding> {
    let (file, design) = (&scene.file, scene.design()?);
    let pair = scene.assembled().map_err(Failure::work)?;
    let coast = pair.coast.as_ref().ok().and_then(Option::as_ref);
    let edges = [
        edge_words(file.pinion_flank, pair.driving.as_ref()),
        edge_words(file.pinion_flank.mate(), coast),
    ];
    let edges = edges.into_iter().flatten();
    let mut finding = Finding::new("bevel pair", Some(&file.title));
    finding.notes = (pair.jam.iter())
        .map(BevelError::to_string)
        .chain(edges)
        .map(|words| format!("warning: {words}"))
        .collect();
    finding.lines = thickness_words(design, file);
    (finding.facts).insert(
        "backlash_mm".into(),
        json!(1e3 * design.backlash_m(&file.blank)),
    );
    for (i, tooth) in design.teeth.iter().enumerate() {
        let thickness = thickness_figures(tooth, design.settings[i].as_ref(), file);
        (finding.facts).insert(format!("{}_thickness", tooth.blank.name), thickness);
    }
    Ok(finding)
}

fn bevel_gear(document: &InputDocument, folder: &Path) -> Result<Finding> {
    let gear = BevelGear::from_document(document, folder)?;
    let mut finding = Finding::new("bevel gear", Some(&gear.name));
    finding.slips = document.unit_slips();
    Ok(finding)
}

fn bearing(document: &InputDocument) -> Result<Finding> {
    let found = BearingFromFile::from_document(document)?;
    QuasiStaticBearing::new(&found.definition).map_err(Failure::work)?;
    let mut finding = Finding::new("bearing", Some(&found.definition.name));
    let warnings = found.warnings.iter();
    let warnings = warnings.map(|text| format!("warning: {text}"));
    let slips = found.unit_slips.iter();
    let warnings = warnings.chain(slips.map(|slip| format!("warning: {slip}")));
    finding.notes = found.notes.iter().cloned().chain(warnings).collect();
    Ok(finding)
}

fn model(path: &Path) -> Result<Finding> {
    let model = read_reduced_gear(path).map_err(Failure::input)?;
    let mut finding = Finding::new("reduced gear", None);
    finding.lines = reduce::summary(&model);
    Ok(finding)
}

fn result(path: &Path) -> Result<Finding> {
    let result = match ResultFile::open(path).map_err(Failure::input)? {
        ResultFile::Pair(result) => {
            let (torques, angles) = (result.torque_nm.len(), result.angles());
            return Ok(Finding::new("result", Some(&result.source.title)).sized(
                format!("{torques} torques x {angles} angles"),
                json!({ "torques": torques, "angles": angles }),
            ));
        }
        ResultFile::System(result) => result,
    };
    let (columns, rows) = (result.rows.columns().len(), result.rows.rows());
    let size = if rows > 0 {
        format!("{}, {columns} columns x {rows} rows", result.kind)
    } else {
        result.kind.to_string()
    };
    let run = result.kind.to_string();
    let mut finding = Finding::new("result", Some(&result.head.title)).sized(
        size,
        json!({ "run": run, "columns": columns, "rows": rows, "problem": result.problem() }),
    );
    finding.problem = result.problem();
    finding.lines = (system_table::table(&result)?.into_iter())
        .skip(1)
        .collect();
    Ok(finding)
}

fn scene(scene: SceneFile) -> Result<Finding> {
    match scene {
        SceneFile::Pair(scene) => {
            let loaded = load(*scene)?;
            let mut finding = Finding::new("scene", Some(&loaded.scene.title));
            finding.slips = loaded.unit_slips();
            finding.notes = loaded.scene.notes;
            Ok(finding)
        }
        SceneFile::Bevel(scene) => bevel_pair(&scene),
        SceneFile::System(scene) => {
            let loaded = scene.load()?;
            let built = loaded.build()?;
            RunJob::from_scene(loaded.clone())?;
            let (bodies, joints) = (built.bodies.len(), built.joints.len());
            let elements = built.elements.len();
            let mut finding = Finding::new("scene", Some(&loaded.scene.title)).sized(
                format!("{bodies} bodies, {joints} joints and motions, {elements} force elements"),
                json!({ "bodies": bodies, "joints": joints, "elements": elements }),
            );
            finding.slips = loaded.unit_slips();
            finding.notes = [loaded.scene.notes, built.notes].concat();
            Ok(finding)
        }
    }
}

/// The scene is loaded with the variables in the middle of their bounds.
fn optimisation(problem: &Optimisation) -> Result<Finding> {
    // Nothing is run.
    let stop = AtomicBool::new(false);
    Evaluator::new(problem, Scratch::new(Path::new(""), &stop))?;
    let tables = &problem.tables;
    let (variables, objectives) = (tables.variable.len(), tables.objective.len());
    let of = &tables.scene;
    Ok(Finding::new("optimisation", Some(&tables.title)).sized(
        format!(
            "{variables} variables, {objectives} objectives of {}",
            of.display()
        ),
        json!({ "variables": variables, "objectives": objectives, "scene": of }),
    ))
}

/// All scenes of a study are read; the scene as it is is built with its gears, whose columns are known then.
fn study(study: &Study) -> Result<Finding> {
    let made = StudyScenes::new(study, Path::new(""))?;
    made.check_columns(study, &RestCases::default())?;
    let (cases, columns) = (made.cases.len(), study.tables.columns.len());
    let of = &study.tables.scene;
    Ok(Finding::new("study", Some(&study.tables.title)).sized(
        format!("{cases} cases, {columns} columns of {}", of.display()),
        json!({ "cases": cases, "columns": columns, "scene": of }),
    ))
}

fn sn_table(document: &InputDocument) -> Result<Finding> {
    let curve = sn_curve(document)?;
    let points = curve.points();
    let [first, last] = [points.first(), points.last()].map(|point| {
        point.map_or(String::new(), |p| {
            format!("{} MPa at {:e} cycles", 1e-6 * p.amplitude_pa, p.cycles)
        })
    });
    let count = points.len();
    Ok(Finding::new("S-N table", None).sized(
        format!("{count} points, {first} to {last}"),
        json!({ "points": count }),
    ))
}

/// A record is a folder.
fn record(folder: &Path) -> Result<Finding> {
    let record = ReferenceRecord::read(folder).map_err(Failure::input)?;
    let columns: Vec<&str> = record.columns.iter().map(|c| &c.name[..]).collect();
    let angles = record.angle_rad.len();
    Ok(Finding::new("record", Some(&record.title)).sized(
        format!("{}, {angles} angles, {}", record.kind, columns.join(", ")),
        json!({ "of": record.kind.to_string(), "angles": angles, "columns": columns }),
    ))
}

/// What makes the root of a ring, in words and for machines; a cutter may be the program's choice.
fn root_of_ring(root: &InternalRoot) -> (String, Value) {
    match root {
        InternalRoot::FullRound => (
            "internal teeth: full root radius".into(),
            json!("full-round"),
        ),
        InternalRoot::Cutter(cutter) => (
            format!(
                "internal teeth: pinion cutter of {} teeth, in modules: profile shift {:.4}, addendum {:.4}, tip radius {:.4}",
                cutter.teeth, cutter.profile_shift, cutter.addendum, cutter.tip_radius
            ),
            json!({
                "cutter_teeth": cutter.teeth,
                "profile_shift": cutter.profile_shift,
                "addendum": cutter.addendum,
                "tip_radius": cutter.tip_radius,
            }),
        ),
    }
}

fn gear(document: &InputDocument) -> Result<Finding> {
    let gear = GearDefinition::from_document(document)?;
    demand_body_file(&gear, document)?;
    let p = &gear.profile;
    let form_radius_m = gearmesh_geometry::involute::radius_m(p.form_roll_rad, p.base_radius_m);
    let radii_mm = [
        ("tip", p.tip_radius_m),
        ("reference", p.reference_radius_m),
        ("base", p.base_radius_m),
        ("form", form_radius_m),
        ("root", p.root_radius_m),
    ]
    .map(|(name, radius_m)| (name, 1e3 * radius_m));
    let mut finding = Finding::new("gear", Some(&gear.name));
    finding.slips = document.unit_slips();
    let words = radii_mm.map(|(name, mm)| format!("{name} {mm:.4}"));
    let undercut = if p.undercut { "; undercut" } else { "" };
    (finding.lines).push(format!("radii mm: {}{undercut}", words.join(", ")));
    for (name, mm) in radii_mm {
        (finding.facts).insert(format!("{name}_radius_mm"), json!(mm));
    }
    (finding.facts).insert("undercut".into(), json!(p.undercut));
    if let Gearing::Internal(root) = gear.tooth.gearing {
        let (line, fact) = root_of_ring(&root);
        finding.lines.push(line);
        (finding.facts).insert("root".into(), fact);
    }
    if p.helix_angle_rad != 0.0 {
        let width = gear.tooth.face_width_m;
        finding.lines.push(format!(
            "helix: {} hand, {:.4} deg at the reference circle, {:.4} deg at the base circle; transverse module {:.5} mm, transverse pressure angle {:.4} deg, overlap ratio over the face width {:.4}, virtual teeth {:.2}",
            p.hand(),
            p.helix_angle_rad.abs().to_degrees(),
            p.base_helix_angle_rad().abs().to_degrees(),
            2e3 * p.reference_radius_m / p.teeth as f64,
            (p.base_radius_m / p.reference_radius_m).acos().to_degrees(),
            p.overlap_ratio(width),
            p.virtual_teeth()
        ));
        (finding.facts).insert(
            "helix".into(),
            json!({
                "hand": p.hand().to_string(),
                "reference_angle_deg": p.helix_angle_rad.abs().to_degrees(),
                "base_angle_deg": p.base_helix_angle_rad().abs().to_degrees(),
                "overlap_ratio": p.overlap_ratio(width),
                "virtual_teeth": p.virtual_teeth(),
            }),
        );
    }
    if gear.blank.openings().is_some() && gear.sectors() == 1 {
        finding.notes.push(
            "warning: the openings do not divide the teeth: the body does not repeat, and every tooth is solved"
                .to_owned(),
        );
    }
    Ok(finding)
}
