//! The pair file: TOML with units in the keys, checked key by key, in SI units from here on.

mod assembly_table;
mod blank_table;
mod given_check;
mod load_table;
mod member_table;
mod settings_table;

/// The tables of a pair file.
pub mod tables {
    pub use super::assembly_table::{AssemblyTable, MarkingThickness};
    pub use super::blank_table::{BlankTable, ThicknessShift};
    pub use super::load_table::{DrivingTorque, LoadTable};
    pub use super::member_table::{
        BladeTable, EaseOffTable, GivenTable, MemberTable, PointsTable, SynthesisTable,
    };
    pub use super::settings_table::{RootAngle, SettingsTable};
}

pub use load_table::LoadRequest;
pub use member_table::MemberRequest;
pub use settings_table::settings_toml;

use std::path::Path;

use gearmesh_geometry::InputError;
use gearmesh_geometry::input::InputDocument;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::blank::PairBlank;
use crate::error::BevelError;
use crate::hand::FlankSide;
use crate::pair_design::{Cutting, PairDesign};
use crate::tca::TcaRequest;
use crate::tooth::ToothCheck;
use assembly_table::AssemblyTable;
use blank_table::BlankTable;
use load_table::LoadTable;
use member_table::MemberTable;

/// JSON Schema (draft 2020-12) of bevel pair files.
pub fn schema() -> schemars::Schema {
    gearmesh_geometry::input::file_schema::<BevelFile>()
}

/// A bevel pair file.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[schemars(title = "gearmesh bevel pair")]
#[serde(deny_unknown_fields)]
pub struct BevelFile {
    /// Title in prints.
    pub title: String,
    /// Teeth and blank.
    pub bevel: BlankTable,
    /// How the pinion is cut.
    pub pinion: MemberTable,
    /// How the gear is cut.
    pub gear: MemberTable,
    /// Contact analysis and assembly.
    pub tca: Option<AssemblyTable>,
    /// Contact under load.
    pub load: Option<LoadTable>,
}

/// What a pair file holds.
#[derive(Debug, Clone, PartialEq)]
pub struct PairFile {
    /// Title in prints.
    pub title: String,
    /// Blank of both members.
    pub blank: PairBlank,
    /// How pinion and gear are cut.
    pub members: [MemberRequest; 2],
    /// Flank of the pinion whose contact is analysed.
    pub pinion_flank: FlankSide,
    /// Assembly and fineness of the contact analysis.
    pub tca: TcaRequest,
    /// Contact under load, where the file asks for it.
    pub load: Option<LoadRequest>,
}

impl PairFile {
    /// Whether a document is meant as a bevel pair.
    ///
    /// # Errors
    /// [`InputError`] for a document that is no TOML.
    pub fn recognises(document: &InputDocument) -> Result<bool, InputError> {
        Ok(document.top_keys()?.contains("bevel"))
    }

    /// Reads and checks a pair file.
    ///
    /// # Errors
    /// [`InputError`] for an unreadable file, or a key or value that is not allowed.
    pub fn read(path: &Path) -> Result<Self, InputError> {
        Self::from_document(&InputDocument::read(path)?)
    }

    /// Checks a pair file that is already in memory.
    ///
    /// # Errors
    /// As [`Self::read`].
    pub fn from_document(document: &InputDocument) -> Result<Self, InputError> {
        // Asked before the table is read, for all that is not in it would only be an unknown key.
        for key in ["bevel.offset_mm", "bevel.hypoid_offset_mm"] {
            if document.has(key) {
                let problem = "hypoid pairs, whose axes pass each other, are not computed: the axes of a bevel pair meet in the pitch apex; remove it (an error of assembly is tca.offset_um)";
                return Err(document.error(key, problem));
            }
        }
        let file: BevelFile = document.parse()?;
        let blank = file.bevel.blank(document)?;
        let members = [
            file.pinion.request(document, "pinion", &blank)?,
            file.gear.request(document, "gear", &blank)?,
        ];
        let (pinion_flank, tca) = file.tca.unwrap_or_default().request();
        let load = file.load.map(|table| table.request(document)).transpose()?;
        Ok(Self {
            title: file.title,
            blank,
            members,
            pinion_flank,
            tca,
            load,
        })
    }

    /// Settings and flanks of the pair.
    ///
    /// # Errors
    /// [`BevelError`] where they cannot be made.
    pub fn design(&self) -> Result<PairDesign, BevelError> {
        let [pinion, gear] = &self.members;
        PairDesign::new(
            &self.blank,
            &[pinion.cutting.clone(), gear.cutting.clone()],
            [pinion.edge_radius_m, gear.edge_radius_m],
        )
    }

    /// Whether the file states the settings of a member.
    fn has_given_settings(&self) -> bool {
        let given = |m: &MemberRequest| matches!(m.cutting, Cutting::Given(..));
        self.members.iter().any(given)
    }

    /// Settings and flanks of the pair, and what was found where both members' teeth were checked.
    ///
    /// # Errors
    /// What [`Self::design`] and the checks say, as a complaint of the file: `document` is what this was read from.
    pub fn checked_design(
        &self,
        document: &InputDocument,
    ) -> Result<(PairDesign, [ToothCheck; 2]), InputError> {
        let fault = |error: BevelError| error.in_file(document);
        let design = self.design().map_err(fault)?;
        let check = |i: usize| {
            let member = &self.members[i];
            let found = design.teeth[i].check(member.least_top_land_m, member.point_width_m);
            found.map_err(fault)
        };
        let checks = [check(0)?, check(1)?];
        // Derived flanks meet by what they are derived from, measured ones stand where they stand.
        if self.has_given_settings() {
            design.check_meeting(&self.blank).map_err(fault)?;
        }
        Ok((design, checks))
    }
}
