//! Keys of rows and preload.

use gearmesh_geometry::InputError;
use gearmesh_geometry::input::{Bounded, NotNegative, Positive, TableKeys, Within};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{MM, UM};
use crate::definition::{Arrangement, Preload};

/// Rows side by side.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct RowKeys {
    /// Two rows: "O" (back to back), "X" (face to face) or "tandem"; one row where not given. "catalogue" with two rows
    /// in its rings: "O" where not given.
    pub arrangement: Option<ArrangementWord>,
    /// Distance of the two rows. "catalogue" with two rows in its rings: half the width where not given.
    pub row_distance_mm: Option<Bounded<Positive>>,
}

/// `arrangement`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
pub(super) enum ArrangementWord {
    /// Back to back.
    O,
    /// Face to face.
    X,
    /// Alike.
    #[serde(rename = "tandem")]
    Tandem,
}

impl RowKeys {
    /// Rows of bearings with one in their rings.
    pub fn arrangement(&self, keys: &TableKeys<'_>) -> Result<Arrangement, InputError> {
        let Some(word) = self.arrangement else {
            if self.row_distance_mm.is_some() {
                return Err(keys.error(
                    "row_distance_mm",
                    "is not used by a single row; remove it, or give the arrangement",
                ));
            }
            return Ok(Arrangement::Single);
        };
        let distance = keys.needed("row_distance_mm", self.row_distance_mm, "a pair of rows")?;
        let distance_m = MM * distance;
        Ok(match word {
            ArrangementWord::O => Arrangement::O { distance_m },
            ArrangementWord::X => Arrangement::X { distance_m },
            ArrangementWord::Tandem => Arrangement::Tandem { distance_m },
        })
    }

    /// Rows of a bearing that has two in one pair of rings.
    pub fn of_double_row(
        &self,
        keys: &TableKeys<'_>,
        distance_m: f64,
    ) -> Result<Arrangement, InputError> {
        match self.arrangement {
            None | Some(ArrangementWord::O) => Ok(Arrangement::O { distance_m }),
            Some(ArrangementWord::X) => Ok(Arrangement::X { distance_m }),
            Some(ArrangementWord::Tandem) => Err(keys.error(
                "arrangement",
                "found \"tandem\", allowed are \"O\" and \"X\": the rows of a double-row bearing carry axial loads both ways",
            )),
        }
    }
}

/// How rows are preloaded.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[allow(non_snake_case)]
pub(super) struct PreloadKeys {
    /// Axial force that the rows of a pair carry at rest without load; of a single row that which its place without
    /// load stands for.
    preload_N: Option<Bounded<NotNegative>>,
    /// Axial displacement by which each row's inner ring is pressed in; negative for play.
    preload_um: Option<Bounded<Within<-1000, 1000>>>,
}

impl PreloadKeys {
    /// As the file states it.
    pub fn preload(&self, keys: &TableKeys<'_>) -> Result<Preload, InputError> {
        match (self.preload_N, self.preload_um) {
            (None, None) => Ok(Preload::None),
            (Some(_), Some(_)) => Err(keys.error(
                "preload_um",
                "is given together with preload_N; remove one of the two",
            )),
            (Some(force), None) if *force == 0.0 => Ok(Preload::None),
            (Some(force), None) => Ok(Preload::Force(*force)),
            (None, Some(shift)) => Ok(Preload::Displacement(UM * shift)),
        }
    }
}
