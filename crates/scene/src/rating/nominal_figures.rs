//! From the largest normal force to nominal stresses.

use gearmesh_geometry::InputError;
use gearmesh_geometry::input::TableKeys;
use gearmesh_rating::{LoadPoint, NominalError, NominalRating, RootSectionError};

use super::result::{RatingFigure, figures};

/// Figures of a pair under its largest normal force \[N\].
///
/// # Errors
/// [`NominalError::Force`] for a force that is none.
pub fn nominal_figures(
    rating: &NominalRating,
    force_n: f64,
) -> Result<Vec<RatingFigure>, NominalError> {
    let found = rating.under(force_n)?;
    Ok(figures(&[
        ("largest_force_N", force_n),
        ("lewis_factor_gear1", rating.lewis_factors[0]),
        ("lewis_factor_gear2", rating.lewis_factors[1]),
        ("lewis_stress_gear1_Pa", found.lewis_pa[0]),
        ("lewis_stress_gear2_Pa", found.lewis_pa[1]),
        ("hertz_pressure_Pa", found.flank_pressure_pa),
    ]))
}

/// How it is judged, in words.
#[must_use]
pub fn nominal_method(load: LoadPoint) -> String {
    let point = match load {
        LoadPoint::HighestSingleContact => "highest point of single contact",
        LoadPoint::Tip => "tip",
    };
    format!(
        "Lewis's root stress (load at the {point}) and Hertz's flank pressure under the largest normal force"
    )
}

/// The complaint about a pair that cannot be rated, at the load point where that is the reason and else at `key`.
#[must_use]
pub fn nominal_error(error: &NominalError, key: &str, keys: &TableKeys<'_>) -> InputError {
    match error {
        NominalError::Root(RootSectionError::NoSingleContact { .. }) => {
            keys.error("load_point", error)
        }
        _ => keys.error(key, error),
    }
}
