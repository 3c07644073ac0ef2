//! From the largest normal force to nominal stresses.

use gearmesh_geometry::input::TableKeys;
use gearmesh_geometry::{GearDefinition, InputError};
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
    let mut values = vec![
        ("largest_force_N", force_n),
        ("lewis_factor_gear1", rating.lewis_factors[0]),
        ("lewis_factor_gear2", rating.lewis_factors[1]),
        ("lewis_stress_gear1_Pa", found.lewis_pa[0]),
        ("lewis_stress_gear2_Pa", found.lewis_pa[1]),
        ("hertz_pressure_Pa", found.flank_pressure_pa),
        ("iso_contact_stress_Pa", found.iso_pressure_pa),
        ("iso_Z_H", rating.iso_pressure.zone_factor),
        ("iso_Z_epsilon", rating.iso_pressure.contact_ratio_factor),
        ("iso_Z_beta", rating.iso_pressure.helix_factor),
    ];
    let names = [
        [
            "iso_root_stress_gear1_Pa",
            "iso_Y_F_gear1",
            "iso_Y_S_gear1",
            "iso_Y_beta_gear1",
            "iso_Y_B_gear1",
            "iso_Y_DT_gear1",
        ],
        [
            "iso_root_stress_gear2_Pa",
            "iso_Y_F_gear2",
            "iso_Y_S_gear2",
            "iso_Y_beta_gear2",
            "iso_Y_B_gear2",
            "iso_Y_DT_gear2",
        ],
    ];
    for (names, (factors, stress_pa)) in names
        .iter()
        .zip(rating.iso_roots.iter().zip(found.iso_root_pa))
    {
        if let (Some(factors), Some(stress_pa)) = (factors, stress_pa) {
            let of_gear = [
                stress_pa,
                factors.form_factor,
                factors.stress_correction_factor,
                factors.helix_factor,
                factors.rim_factor,
                factors.deep_tooth_factor,
            ];
            values.extend(names.iter().copied().zip(of_gear));
        }
    }
    Ok(figures(&values))
}

/// What the figures leave open: σ_F0 of deep teeth whose tolerance class is not stated.
#[must_use]
pub fn nominal_remark(rating: &NominalRating) -> Option<String> {
    let root = rating.iso_roots.iter().flatten();
    let open = { root }.find_map(|root| Some((root, root.share_of_fine_classes()?)));
    open.map(|(root, share)| {
        format!(
            "contact ratio {:.3} of the virtual spur gears is above 2.05: Y_DT = 1 is taken, as for tolerance classes above 4 or unknown ones; with class 4 or \
             better (rating.tolerance_class) Y_DT = {share:.3}",
            root.virtual_contact_ratio
        )
    })
}

/// Thickness of a gear's rim below its root circle \[m\]; none of a solid gear.
#[must_use]
pub fn rim_m(gear: &GearDefinition) -> Option<f64> {
    let web = gear.blank.web()?;
    Some(gear.profile.root_radius_m - web.rim_inner_radius_m)
}

/// How it is judged, in words.
#[must_use]
pub fn nominal_method(load: LoadPoint) -> String {
    let point = match load {
        LoadPoint::HighestSingleContact => "highest point of single contact",
        LoadPoint::Tip => "tip",
    };
    format!(
        "Lewis's root stress (load at the {point}) and Hertz's flank pressure under the largest normal force; beside them the nominal \
         stresses of ISO 6336-2 (pitch point) and 6336-3 (method B), all K = 1"
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
