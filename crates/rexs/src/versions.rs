//! Names of older versions in those of version 2.0.0, after the change logs of the format. A name is brought up to date
//! wherever it stands: programs write names of one version under the number of another.

use crate::error::{Result, RexsError};
use crate::ledger::{About, Ledger};
use crate::model::{Component, Model};
use std::collections::HashMap;

/// Types that were renamed: old, new, version of the new one.
const KINDS: [(&str, &str, &str); 3] = [
    ("fixed_coupling", "coupling", "1.1"),
    ("flank_geometry", "cylindrical_gear_flank", "1.3"),
    ("stage_gear_data", "cylindrical_stage_gear_data", "1.3"),
];

/// Attributes that were renamed, version by version: part of the type's name, old name, new name.
#[rustfmt::skip] // a table, a row a line
const ATTRIBUTES: [[&str; 3]; 42] = [
    // Version 1.1.
    ["rolling_bearing_with", "name", "catalogue_designation"],
    ["rolling_bearing_with", "dynamic_capacity", "radial_dynamic_load_rating"],
    ["rolling_bearing_with", "static_capacity", "radial_static_load_rating"],
    ["rolling_bearing_with", "axial_backlash", "operating_axial_bearing_clearance"],
    ["rolling_bearing_with", "radial_backlash", "operating_radial_bearing_clearance"],
    ["rolling_bearing_with", "minimum_bearing_clearance", "minimum_radial_bearing_clearance"],
    ["rolling_bearing_with", "maximum_bearing_clearance", "maximum_radial_bearing_clearance"],
    ["rolling_bearing_with", "minimum_outer_diameter", "minimum_bearing_outer_diameter"],
    ["rolling_bearing_with", "maximum_outer_diameter", "maximum_bearing_outer_diameter"],
    ["rolling_bearing_with", "minimum_pin_diameter", "minimum_shaft_diameter"],
    ["rolling_bearing_with", "maximum_pin_diameter", "maximum_shaft_diameter"],
    ["rolling_bearing_with", "minimum_bore_diameter", "minimum_casing_bore_diameter"],
    ["rolling_bearing_with", "maximum_bore_diameter", "maximum_casing_bore_diameter"],
    ["rolling_bearing_with", "decisive_housing_outer_diameter", "casing_outer_diameter"],
    ["rolling_bearing_with", "decisive_pin_diameter", "shaft_inner_diameter"],
    ["rolling_bearing_with", "clearance_class", "radial_clearance_class"],
    ["rolling_bearing_with", "boring_tolerance_class", "casing_bore_tolerance_class"],
    ["rolling_bearing_with", "pin_tolerance_class", "shaft_tolerance_class"],
    ["bearing", "initial_load", "preload_force"],
    ["bearing", "initial_load_shift", "preload_distance"],
    ["rolling_bearing_row", "significant_width_inner", "significant_contact_length_inner_ring"],
    ["rolling_bearing_row", "significant_width_outer", "significant_contact_length_outer_ring"],
    ["rolling_bearing_row", "running_path_radius_of_inner_ring", "raceway_radius_of_inner_ring"],
    ["rolling_bearing_row", "running_path_radius_of_outer_ring", "raceway_radius_of_outer_ring"],
    ["rolling_element", "roller_shell_radius", "roller_crowning_radius"],
    ["gear", "din_3967_deviation_tolerance_series", "tooth_thickness_deviation_tolerance_series_din_3967_1978"],
    ["stage", "din_3964_center_distance_tolerance_field", "center_distance_tolerance_field_din_3964_1980"],
    // Version 1.3.
    ["gear_unit", "load_duration", "operating_time"],
    ["gear_unit", "load_duration_fraction", "operating_time_fraction"],
    ["gear_unit", "custom_load_duration_fraction", "operating_time_fraction"],
    // Version 1.5.
    ["gear", "normal_tooth_thickness_at_pitch_diameter", "normal_tooth_thickness_at_reference_diameter"],
    // Version 2.0.0.
    ["rolling_bearing_row", "reference_diameter", "reference_diameter_rolling_bearing"],
    ["tool", "tip_radius", "tip_corner_radius_reference_profile"],
    ["tool", "tip_radius_factor", "tip_corner_radius_factor_reference_profile"],
    ["bevel_gear", "basic_addendum_coefficient", "basic_crown_gear_addendum_factor"],
    ["bevel_gear", "basic_dedendum_coefficient", "basic_crown_gear_dedendum_factor"],
    ["bevel_stage", "generated_pressure_angle_drive", "generated_pressure_angle_on_drive_side"],
    ["bevel_stage", "generated_pressure_angle_coast", "generated_pressure_angle_on_coast_side"],
    ["bevel_stage", "nominal_design_pressure_angle_drive", "nominal_design_pressure_angle_on_drive_side"],
    ["bevel_stage", "nominal_design_pressure_angle_coast", "nominal_design_pressure_angle_on_coast_side"],
    ["bevel_stage", "effective_pressure_angle_drive", "effective_pressure_angle_on_drive_side"],
    ["bevel_stage", "effective_pressure_angle_coast", "effective_pressure_angle_on_coast_side"],
];

/// Versions with a published schema.
const PUBLISHED: [&str; 9] = [
    "1.0", "1.1", "1.2", "1.3", "1.4", "1.5", "1.6", "1.7", "2.0.0",
];

/// Demands a version that is known and brings all names up to date.
///
/// # Errors
/// [`RexsError::Version`].
pub fn bring_up_to_date(model: &mut Model, ledger: &mut Ledger) -> Result<()> {
    let stated = model
        .version
        .trim()
        .trim_start_matches(['v', 'V'])
        .to_owned();
    if stated.is_empty() {
        ledger.assume(
            "the file",
            About::Nothing,
            "states no version of REXS: read as 1.0 to 2.0.0, names of all of them are known",
        );
    } else {
        let mut parts = stated.split('.').map(|part| part.parse::<u32>());
        let unknown = || RexsError::Version {
            found: model.version.clone(),
        };
        let major = parts.next().and_then(Result::ok).ok_or_else(unknown)?;
        let minor = parts.next().unwrap_or(Ok(0)).map_err(|_| unknown())?;
        if parts.any(|part| part.is_err()) || !(major == 2 || (major == 1 && minor <= 7)) {
            return Err(unknown());
        }
        let known = PUBLISHED.contains(&stated.as_str()) || (major, minor) == (2, 0);
        if !known {
            ledger.assume(
                "the file",
                About::Nothing,
                format!("version {stated} is newer than those that are known: read as 2.0.0"),
            );
        }
    }
    let spectra = model.spectra.iter_mut().flat_map(|s| {
        let cases = s.cases.iter_mut().flat_map(|c| c.components.iter_mut());
        cases.chain(s.accumulation.iter_mut())
    });
    let kinds: HashMap<i64, String> = model
        .components
        .iter()
        .rev()
        .map(|c| (c.id, c.kind.clone()))
        .collect();
    for component in spectra {
        // In a load case the type may be left out: the number says which component it is.
        if component.kind.is_empty() {
            component.kind = kinds.get(&component.id).cloned().unwrap_or_default();
        }
        rename(component);
    }
    model.components.iter_mut().for_each(rename);
    Ok(())
}

fn rename(component: &mut Component) {
    if let Some((_, new, _)) = KINDS.iter().find(|(old, ..)| *old == component.kind) {
        (*new).clone_into(&mut component.kind);
    }
    for [kind, old, new] in ATTRIBUTES {
        if !component.kind.contains(kind)
            || component.attribute(old).is_none()
            || component.attribute(new).is_some()
        {
            continue;
        }
        for attribute in component.attributes.iter_mut().filter(|a| a.id == old) {
            new.clone_into(&mut attribute.id);
        }
    }
}
