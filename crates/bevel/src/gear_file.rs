//! The bevel gear file: one member of a pair as a body. TOML with units in the keys.

mod body_table;
mod gauge_table;
mod solver_tables;

use std::path::Path;

use gearmesh_geometry::InputError;
use gearmesh_geometry::gear_file::{HubTable, MaterialTable, ModesTable};
use gearmesh_geometry::input::{InputDocument, TableKeys};
use schemars::JsonSchema;
use serde::Deserialize;

use crate::bevel_gear::BevelGear;
use crate::blank::ToothForm;
use crate::pair_file::PairFile;

const MM: f64 = 1e-3;

/// JSON Schema (draft 2020-12) of bevel gear files.
pub fn gear_schema() -> schemars::Schema {
    gearmesh_geometry::input::file_schema::<BevelGearFile>()
}

/// A bevel gear file.
#[derive(Deserialize, JsonSchema)]
#[schemars(title = "gearmesh bevel gear")]
#[serde(deny_unknown_fields)]
struct BevelGearFile {
    /// Name in prints and files.
    name: String,
    /// Which member of which pair.
    bevel_gear: MemberTable,
    /// The body below the teeth.
    blank: body_table::BodyTable,
    /// Material.
    material: MaterialTable,
    /// Element and element lengths.
    #[serde(default)]
    mesh: solver_tables::MeshTable,
    /// What the reduction computes.
    #[serde(default)]
    reduction: solver_tables::ReductionTable,
    /// How the bore is held.
    #[serde(default)]
    hub: HubTable,
    /// Natural modes with the bore held, for the dynamics; none where not given.
    modes: Option<ModesTable>,
    /// Strain gauges in the tooth roots.
    #[serde(default)]
    gauge: Vec<gauge_table::GaugeTable>,
}

/// The keys of `[bevel_gear]`.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct MemberTable {
    /// Bevel pair file, beside this file.
    pair: String,
    /// Member of the pair.
    member: MemberWord,
}

/// `member`.
#[derive(Debug, Clone, Copy, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
enum MemberWord {
    /// The member that the pair file names first.
    Pinion,
    /// Its mate.
    Gear,
}

impl BevelGear {
    /// Whether a document is meant as a bevel gear.
    ///
    /// # Errors
    /// [`InputError`] for a document that is no TOML.
    pub fn recognises(document: &InputDocument) -> Result<bool, InputError> {
        Ok(document.top_keys()?.contains("bevel_gear"))
    }

    /// Reads and checks a bevel gear file and the pair file that it names.
    ///
    /// # Errors
    /// [`InputError`] for an unreadable file, a key or value that is not allowed, or teeth that cannot be cut.
    pub fn read(path: &Path) -> Result<Self, InputError> {
        let folder = path.parent().unwrap_or(Path::new(""));
        Self::from_document(&InputDocument::read(path)?, folder)
    }

    /// Checks a bevel gear file that is already in memory; `folder`: where its pair file lies.
    ///
    /// # Errors
    /// As [`Self::read`].
    pub fn from_document(document: &InputDocument, folder: &Path) -> Result<Self, InputError> {
        let file: BevelGearFile = document.parse()?;
        let pair_document = InputDocument::read(&folder.join(&file.bevel_gear.pair))
            .map_err(|e| document.error("bevel_gear.pair", e))?;
        Self::of_files(document, file, &pair_document)
    }

    /// A gear from the texts of its file and its pair's, as a reduced gear keeps them; `name` stands for them in
    /// messages.
    ///
    /// # Errors
    /// As [`Self::read`].
    pub fn from_texts(name: &str, text: &str, pair_text: &str) -> Result<Self, InputError> {
        let document = InputDocument::new(format!("gear inside {name}"), text);
        let pair_document = InputDocument::new(format!("pair inside {name}"), pair_text);
        Self::of_files(&document, document.parse()?, &pair_document)
    }

    fn of_files(
        document: &InputDocument,
        file: BevelGearFile,
        pair_document: &InputDocument,
    ) -> Result<Self, InputError> {
        let pair = PairFile::from_document(pair_document)?;
        let (design, _) = (pair.checked_design(pair_document))
            .map_err(|e| document.error("bevel_gear.pair", e))?;
        let member = match file.bevel_gear.member {
            MemberWord::Pinion => 0,
            MemberWord::Gear => 1,
        };
        let tooth = design.teeth[member].clone();
        if tooth
            .flanks
            .iter()
            .any(|flank| flank.cut_surface().is_none())
        {
            let problem = "its flanks are given by points, which say nothing of the root; allowed for a body are flanks that are cut: another form of `settings` in the pair file";
            return Err(document.error("bevel_gear.member", problem));
        }
        if pair.blank.data.form == ToothForm::Straight {
            let problem = "straight teeth are cut by a plane tool without an edge radius, so that the root has a sharp corner; bodies are made of \"spiral\" and \"zerol\" teeth";
            return Err(document.error("bevel_gear.member", problem));
        }
        let mut mills = tooth.flanks.iter().map(|flank| {
            let mill = flank.cut_surface().and_then(|cut| cut.settings.face_mill());
            mill.is_some_and(|mill| mill.edge_radius_m > 0.0)
        });
        if !mills.all(|has_edge_radius| has_edge_radius) {
            let problem = "its blades have no edge radius, so that the root has a sharp corner: a body needs a fillet; give the member edge_radius_mm in the pair file";
            return Err(document.error("bevel_gear.member", problem));
        }
        let material = file.material.material();
        let mate = pair.blank.members[1 - member].clone();
        let body = file.blank.check(document, &tooth)?;
        let reduction = file.reduction.check(document)?;
        let mut gear = Self {
            name: file.name,
            mesh: file.mesh.check(document, &tooth, reduction.slices)?,
            reduction,
            hub: file.hub.check(document, &material, false)?,
            modes: (file.modes)
                .map(|table| table.check(document, &material, false))
                .transpose()?,
            gauges: Vec::new(),
            source: document.text.clone(),
            pair_text: pair_document.text.clone(),
            pair,
            member,
            tooth,
            mate,
            body,
            material,
        };
        for (k, table) in file.gauge.into_iter().enumerate() {
            let path = format!("gauge.{k}");
            let gauge = table.check(&TableKeys::new(document, &path), &gear)?;
            gear.gauges.push(gauge);
        }
        Ok(gear)
    }
}
