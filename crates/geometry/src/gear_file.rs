//! The gear file: TOML with units in the keys, checked key by key, turned into a [`GearDefinition`] in SI units.
//!
//! One file per table, each with the table's keys and a `check` that turns it into its definition. A check may ask
//! for what the tables before it have settled, so the order in [`GearDefinition::from_document`] matters.

mod blank_table;
mod contour_table;
mod crack_table;
mod cutter_table;
mod gauge_table;
mod hub_table;
mod material_table;
mod mesh_table;
mod microgeometry_table;
mod modes_table;
mod openings_table;
mod reduction_table;
mod tooth_table;
mod topography_table;

pub use hub_table::HubTable;
pub use material_table::{MaterialTable, PoissonRatio};
pub use mesh_table::{DEFAULT_LEAST_QUALITY, LeastQuality};
pub use microgeometry_table::{MicrogeometryTable, ReliefWord};
pub use modes_table::ModesTable;
pub use reduction_table::loaded_flanks;
pub use topography_table::TopographyTable;

use crate::blank::Blank;
use crate::definition::{GearDefinition, HubSupport};
use crate::input::{InputDocument, InputError, TableKeys};
use crate::tooth::ToothGeometry;
use schemars::JsonSchema;
use serde::Deserialize;
use std::path::Path;

/// A millimetre in metres.
const MM: f64 = 1e-3;
/// A micrometre in metres.
const UM: f64 = 1e-6;

/// JSON Schema (draft 2020-12) of gear files. What depends on other keys is checked when the file is read.
pub fn schema() -> schemars::Schema {
    crate::input::file_schema::<GearFile>()
}

/// A gear file.
#[derive(Deserialize, JsonSchema)]
#[schemars(title = "gearmesh gear")]
#[serde(deny_unknown_fields)]
struct GearFile {
    /// Name in prints and files.
    name: String,
    /// The teeth.
    tooth: tooth_table::ToothTable,
    /// The body below them.
    blank: blank_table::BlankTable,
    /// Material.
    material: material_table::MaterialTable,
    /// Material removed from the flanks; none where not given.
    #[serde(default)]
    microgeometry: microgeometry_table::MicrogeometryTable,
    /// Element and element lengths.
    #[serde(default)]
    mesh: mesh_table::MeshTable,
    /// What the reduction computes.
    #[serde(default)]
    reduction: reduction_table::ReductionTable,
    /// Which natural modes the reduced gear keeps; none where not given.
    modes: Option<modes_table::ModesTable>,
    /// How the bore is held.
    #[serde(default)]
    hub: hub_table::HubTable,
    /// Strain gauges in the tooth roots.
    #[serde(default)]
    gauge: Vec<gauge_table::GaugeTable>,
    /// Crack in a tooth root; none where not given.
    crack: Option<crack_table::CrackTable>,
}

impl GearDefinition {
    /// Reads and checks a gear file.
    ///
    /// # Errors
    /// [`InputError`] for an unreadable file, a key or value that is not allowed, or a gear that cannot exist.
    pub fn read(path: &Path) -> Result<Self, InputError> {
        Self::from_document(&InputDocument::read(path)?)
    }

    /// Checks a gear file that is already in memory.
    ///
    /// # Errors
    /// As [`GearDefinition::read`].
    pub fn from_document(document: &InputDocument) -> Result<Self, InputError> {
        let file: GearFile = document.parse()?;
        let tooth = file.tooth.check(document)?;
        let profile = ToothGeometry::new(&tooth).map_err(|e| document.error("tooth", e))?;
        let blank = file.blank.check(document, &tooth, &profile)?;
        let material = file.material.material();
        let microgeometry = file.microgeometry.check(
            (document, "microgeometry"),
            (&profile, tooth.face_width_m),
            None,
        )?;
        let mesh = file.mesh.check(document, &tooth, &blank)?;
        let reduction = file.reduction.check(document, mesh.plane_strain)?;
        let hub_support = file.hub.support();
        if blank.meshed().is_some() {
            let unused = [
                (
                    "material.density_kg_per_m3",
                    material.density_kg_per_m3.is_some(),
                ),
                ("modes", file.modes.is_some()),
                ("hub.support", hub_support != HubSupport::Fixed),
            ];
            TableKeys::new(document, "").refuse(
                &unused,
                "blank.kind = \"mesh\" is reduced at rest with its bore fixed and does not use it; remove it",
            )?;
        }
        let without = match &blank {
            Blank::Solid { .. } | Blank::Webbed { .. } => {
                (file.crack.is_some()).then_some("a gear with a [crack], whose bore is held,")
            }
            Blank::CutIntoShaft(_) => Some("a gear that is cut into its shaft, which has no bore,"),
            Blank::Ring(_) => Some("blank.kind = \"ring\", which is held outside,"),
            Blank::Meshed { .. } => Some("blank.kind = \"mesh\", whose bore is fixed,"),
        };
        if let (Some(body), Some(_)) = (without, reduction.bore) {
            let problem = format!("{body} does not use it; remove the table");
            return Err(document.error("reduction.bore", problem));
        }
        let modes = file.modes;
        let modes = modes
            .map(|table| table.check(document, &material, mesh.plane_strain))
            .transpose()?;
        if blank.rim().is_some() && hub_support != HubSupport::Fixed {
            return Err(document.error(
                "hub.support",
                "a ring is fixed where it is held, blank.held_band_mm or its whole outside; remove it",
            ));
        }
        let hub = file.hub.check(document, &material, mesh.plane_strain)?;
        let gauges = gauge_table::check_all(file.gauge, document, &tooth, &profile)?;
        let crack = file.crack;
        let crack = crack
            .map(|table| table.check(document, &tooth, &profile, &reduction))
            .transpose()?;
        let gear = Self {
            name: file.name,
            tooth,
            blank,
            material,
            microgeometry,
            mesh,
            reduction,
            modes,
            hub,
            gauges,
            crack,
            profile,
            source: document.text.clone(),
        };
        crack_table::check_mesh(&gear, document)?;
        Ok(gear)
    }
}
