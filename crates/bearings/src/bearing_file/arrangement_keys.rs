//! Keys of rows and preload.

use gearmesh_geometry::InputError;
use gearmesh_geometry::input::TableKeys;

use super::{ArrangementWord, BearingFile, MM, UM};
use crate::definition::{Arrangement, Preload};

/// Rows side by side.
pub(super) fn arrangement(
    file: &BearingFile,
    keys: &TableKeys<'_>,
) -> Result<Arrangement, InputError> {
    let Some(word) = file.arrangement else {
        if file.row_distance_mm.is_some() {
            return Err(keys.error(
                "row_distance_mm",
                "is not used by a single row; remove it, or give the arrangement",
            ));
        }
        return Ok(Arrangement::Single);
    };
    let distance = keys.needed("row_distance_mm", file.row_distance_mm, "a pair of rows")?;
    let distance_m = MM * distance;
    Ok(match word {
        ArrangementWord::O => Arrangement::O { distance_m },
        ArrangementWord::X => Arrangement::X { distance_m },
        ArrangementWord::Tandem => Arrangement::Tandem { distance_m },
    })
}

/// Rows of a bearing that has two in one pair of rings.
pub(super) fn of_double_row(
    file: &BearingFile,
    keys: &TableKeys<'_>,
    distance_m: f64,
) -> Result<Arrangement, InputError> {
    match file.arrangement {
        None | Some(ArrangementWord::O) => Ok(Arrangement::O { distance_m }),
        Some(ArrangementWord::X) => Ok(Arrangement::X { distance_m }),
        Some(ArrangementWord::Tandem) => Err(keys.error(
            "arrangement",
            "found \"tandem\", allowed are \"O\" and \"X\": the rows of a double-row bearing carry axial loads both ways",
        )),
    }
}

/// How rows are preloaded.
pub(super) fn preload(file: &BearingFile, keys: &TableKeys<'_>) -> Result<Preload, InputError> {
    match (file.preload_N, file.preload_um) {
        (None, None) => Ok(Preload::None),
        (Some(_), Some(_)) => Err(keys.error(
            "preload_um",
            "is given together with preload_N; remove one of the two",
        )),
        (Some(force), None) => Ok(if *force > 0.0 {
            Preload::Force(*force)
        } else {
            Preload::None
        }),
        (None, Some(shift)) => Ok(Preload::Displacement(UM * shift)),
    }
}
