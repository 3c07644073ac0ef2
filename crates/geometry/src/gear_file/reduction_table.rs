//! `[reduction]`: what the offline stage computes.

use super::TableKeys;
use crate::definition::{Flank, ReductionSettings, Symmetry};
use crate::input::{InputDocument, InputError};
use schemars::JsonSchema;
use serde::Deserialize;

/// The keys of `[reduction]`.
#[derive(Deserialize, JsonSchema, Default)]
#[serde(deny_unknown_fields)]
pub(super) struct ReductionTable {
    /// Stations of the flank grid along the profile; 9 where not given.
    roll_stations: Option<usize>,
    /// Slices over the face width; 5 where not given, 1 in plane strain.
    slices: Option<usize>,
    /// Flanks that carry loads; both where not given.
    flanks: Option<Vec<Flank>>,
    /// "auto" uses that the gear repeats, "off" factorises all of it for comparison; "auto" where not given.
    #[serde(default)]
    symmetry: Symmetry,
}

impl ReductionTable {
    /// The reduction settings.
    pub(super) fn check(
        self,
        document: &InputDocument,
        plane_strain: bool,
    ) -> Result<ReductionSettings, InputError> {
        let keys = TableKeys::new(document, "reduction");
        let roll_stations = self.roll_stations.unwrap_or(9);
        let (default, most, allowed) = if plane_strain {
            (1, 1, "1 in plane strain")
        } else {
            (5, 100, "1 to 100")
        };
        let slices = self.slices.unwrap_or(default);
        keys.require(
            "roll_stations",
            roll_stations as f64,
            (3..=65).contains(&roll_stations),
            "3 to 65",
        )?;
        keys.require(
            "slices",
            slices as f64,
            (1..=most).contains(&slices),
            allowed,
        )?;
        let flanks = self
            .flanks
            .unwrap_or_else(|| vec![Flank::Right, Flank::Left]);
        if flanks.is_empty() || (flanks.len() == 2 && flanks[0] == flanks[1]) || flanks.len() > 2 {
            return Err(keys.error(
                "flanks",
                "name each loaded flank once: [\"right\"], [\"left\"] or [\"right\", \"left\"]",
            ));
        }
        Ok(ReductionSettings {
            symmetry: self.symmetry,
            roll_stations,
            slices,
            flanks,
        })
    }
}
