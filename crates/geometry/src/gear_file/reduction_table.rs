//! `[reduction]`: what the offline stage computes.

use super::TableKeys;
use crate::definition::{BoreMotions, Flank, ReductionSettings, Symmetry};
use crate::input::{Count, InputDocument, InputError};
use schemars::JsonSchema;
use serde::Deserialize;

/// The keys of `[reduction]`.
#[derive(Deserialize, JsonSchema, Default)]
#[serde(deny_unknown_fields)]
pub(super) struct ReductionTable {
    /// Stations of the flank grid along the profile; 9 where not given.
    roll_stations: Option<Count<3, 65>>,
    /// Slices over the face width; 5 where not given, 1 in plane strain.
    slices: Option<Count<1, 100>>,
    /// Flanks that carry loads; both where not given.
    flanks: Option<Vec<Flank>>,
    /// "auto" uses that the gear repeats, "off" factorises all of it for comparison; "auto" where not given.
    #[serde(default)]
    symmetry: Symmetry,
    /// Motions of the bore, for bodies whose bore slides on a pin or is carried by rollers; none where not given.
    bore: Option<BoreTable>,
}

/// The keys of `[reduction.bore]`.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct BoreTable {
    /// Highest harmonic around the bore: radial, tangential and axial motions of it are solved for.
    harmonics: Count<2, 200>,
    /// Polynomials along the bore: 1 constant, 2 linear, too, and so on; 3 where not given, 1 in plane strain.
    along: Option<Count<1, 9>>,
}

impl BoreTable {
    fn check(&self, keys: &TableKeys<'_>, plane_strain: bool) -> Result<BoreMotions, InputError> {
        let default = if plane_strain { 1 } else { 3 };
        let along = self.along.map_or(default, Count::get);
        // A body that moves in space tilts, which is linear along its bore.
        let (ok, allowed) = match plane_strain {
            true => (along == 1, "1 in plane strain"),
            false => (along > 1, "2 or more: the bore tilts"),
        };
        keys.require("bore.along", along as f64, ok, allowed)?;
        Ok(BoreMotions {
            harmonics: self.harmonics.get(),
            along,
        })
    }
}

impl ReductionTable {
    /// The reduction settings.
    pub(super) fn check(
        self,
        document: &InputDocument,
        plane_strain: bool,
    ) -> Result<ReductionSettings, InputError> {
        let keys = TableKeys::new(document, "reduction");
        let default = if plane_strain { 1 } else { 5 };
        let slices = self.slices.map_or(default, Count::get);
        let ok = slices == 1 || !plane_strain;
        keys.require("slices", slices as f64, ok, "1 in plane strain")?;
        Ok(ReductionSettings {
            symmetry: self.symmetry,
            roll_stations: self.roll_stations.map_or(9, Count::get),
            slices,
            flanks: loaded_flanks(self.flanks, &keys)?,
            bore: (self.bore.as_ref())
                .map(|bore| bore.check(&keys, plane_strain))
                .transpose()?,
        })
    }
}

/// `flanks` of a reduction: those that carry loads, both where not given.
///
/// # Errors
/// [`InputError`] where it names none, or one twice.
pub fn loaded_flanks(
    flanks: Option<Vec<Flank>>,
    keys: &TableKeys<'_>,
) -> Result<Vec<Flank>, InputError> {
    let flanks = flanks.unwrap_or_else(|| vec![Flank::Right, Flank::Left]);
    if flanks.is_empty() || (flanks.len() == 2 && flanks[0] == flanks[1]) || flanks.len() > 2 {
        let problem =
            "name each loaded flank once: [\"right\"], [\"left\"] or [\"right\", \"left\"]";
        return Err(keys.error("flanks", problem));
    }
    Ok(flanks)
}
