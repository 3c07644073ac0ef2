//! Gear files for the offline stage: cylindrical or bevel, and what is found wrong before anything is meshed.

use crate::failure::{Failure, Result};
use crate::watch::Watch;
use gearmesh_bevel::BevelGear;
use gearmesh_geometry::GearDefinition;
use gearmesh_geometry::input::{InputDocument, MOST_MESH_BYTES, demand_readable};
use std::path::Path;

/// A gear file that was read.
#[derive(Debug)]
pub struct GearFile {
    /// The file as the user named it.
    pub file: String,
    /// The gear.
    pub gear: AnyGear,
}

/// A gear of either family.
#[derive(Debug)]
pub enum AnyGear {
    /// On parallel axes.
    Cylindrical(Box<GearDefinition>),
    /// On axes that meet or cross.
    Bevel(Box<BevelGear>),
}

impl GearFile {
    /// Reads a file.
    ///
    /// # Errors
    /// [`Failure`] with the place of what is wrong.
    pub fn read(path: &Path, watch: &Watch<'_>) -> Result<Self> {
        Self::of(&InputDocument::read(path)?, watch)
    }

    /// The gear of a text; files that it names lie beside the file that it calls itself.
    ///
    /// # Errors
    /// As [`GearFile::read`].
    pub fn of(document: &InputDocument, watch: &Watch<'_>) -> Result<Self> {
        let gear = if BevelGear::recognises(document)? {
            AnyGear::Bevel(Box::new(BevelGear::from_document(
                document,
                document.folder(),
            )?))
        } else {
            let gear = GearDefinition::from_document(document)?;
            demand_body_file(&gear, document)?;
            AnyGear::Cylindrical(Box::new(gear))
        };
        watch.unit_slips(document.unit_slips());
        Ok(Self {
            file: document.file.clone(),
            gear,
        })
    }

    /// The gear where it is cylindrical.
    ///
    /// # Errors
    /// [`Failure`] for a bevel gear.
    pub fn cylindrical(self) -> Result<GearDefinition> {
        match self.gear {
            AnyGear::Cylindrical(gear) => Ok(*gear),
            AnyGear::Bevel(_) => Err(Failure::input(format!(
                "{}: this is a bevel gear; `mesh`, `reduce` and `check` take bevel gears, this command cylindrical ones only",
                self.file
            ))),
        }
    }
}

/// Demands the mesh file that a gear names.
///
/// # Errors
/// [`Failure`] where it is not there or cannot be read.
pub fn demand_body_file(gear: &GearDefinition, document: &InputDocument) -> Result<()> {
    if let Some(body) = gear.blank.meshed() {
        let shown = body.file.display();
        if !body.file.exists() {
            let problem = format!("the mesh file {shown} does not exist");
            return Err(document.error("blank.file", problem).into());
        }
        demand_readable(&body.file, MOST_MESH_BYTES)
            .map_err(|error| document.error("blank.file", format!("{shown} {error}")))?;
    }
    Ok(())
}

/// Says which element was chosen and why, where the gear file leaves it open and the usual one does not do.
pub(crate) fn note_element(gear: &GearDefinition, watch: &Watch<'_>) {
    if let Some(reason) = gear.mesh.chosen_because {
        watch.note(format!(
            "tetrahedra of ten nodes (mesh.element = \"tet10\"): {reason}"
        ));
    }
}

/// Says that a gear's crack is not in what is made of it.
pub(crate) fn note_sound(gear: &GearDefinition, what: &str, watch: &Watch<'_>) {
    if gear.crack.is_some() {
        watch.note(format!("{what} those of the gear without its [crack]"));
    }
}
