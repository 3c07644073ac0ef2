//! A `[[bearing]]` between its bodies, and the bearing file that its model names.

use std::borrow::Cow;
use std::path::Path;

use gearmesh_bearings::bearing_file::BearingFromFile;
use gearmesh_bearings::{BearingDefinition, QuasiStaticBearing};
use gearmesh_geometry::InputError;
use gearmesh_geometry::input::{InputDocument, TableKeys};
use gearmesh_specification::system::bearing::BearingTable;

use super::housing;
use crate::system::assembly::bodies::{Bodies, Seat};
use crate::system::scene::SystemScene;

/// A bearing between its bodies.
pub(in crate::system::assembly) struct PlacedBearing<'a> {
    pub number: usize,
    /// Its table as it sits: on its outer ring's body where it has one.
    pub table: Cow<'a, BearingTable>,
    pub keys: TableKeys<'a>,
    pub seat: Seat,
    folder: &'a Path,
}

impl<'a> PlacedBearing<'a> {
    /// A bearing of the scene.
    pub(in crate::system::assembly) fn new(
        scene: &'a SystemScene,
        number: usize,
        bodies: &Bodies,
    ) -> Result<Self, InputError> {
        let table = housing::seated(&scene.tables.bearing[number]);
        let keys = TableKeys::new(&scene.document, format!("bearing.{number}"));
        let (on, at) = ((&table.body_1, &*table.body_2), (table.at_mm, table.axis));
        Ok(Self {
            number,
            seat: bodies.seat(&keys, on, at)?,
            keys,
            folder: &scene.folder,
            table,
        })
    }

    /// What a bearing file says of the bearing; `key` names it.
    pub(in crate::system::assembly) fn definition(
        &self,
        key: &str,
        file: &str,
    ) -> Result<BearingDefinition, InputError> {
        Ok(read((key, file), self.folder, &self.keys)?.definition)
    }

    /// Its balls or rollers.
    pub(in crate::system::assembly) fn rolling(
        &self,
        definition: &BearingDefinition,
    ) -> Result<QuasiStaticBearing, InputError> {
        QuasiStaticBearing::new(definition).map_err(|e| self.keys.error("model", e))
    }
}

/// Everything that a bearing file says; `key` names it.
pub(in crate::system::assembly) fn read(
    (key, file): (&str, &str),
    folder: &Path,
    keys: &TableKeys<'_>,
) -> Result<BearingFromFile, InputError> {
    let path = folder.join(file);
    if !path.exists() {
        let problem = format!("the bearing file {} does not exist", path.display());
        return Err(keys.error(key, problem));
    }
    BearingFromFile::from_document(&InputDocument::read(&path)?)
}
