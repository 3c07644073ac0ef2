//! What the names of columns say: unit, and which ones a reader asks for first.

use std::collections::BTreeMap;

/// What varies by less, over the largest value of its unit, is rounding.
const ROUNDING: f64 = 1e-9;

/// Suffixes of column names, longer ones before those that end them, and their units.
const UNITS: [(&str, &str); 15] = [
    ("_rad_per_s2", "rad/s²"),
    ("_rad_per_s", "rad/s"),
    ("_m_per_s2", "m/s²"),
    ("_m_per_s", "m/s"),
    ("_sqrt_kg_m", "√kg·m"),
    ("_N_per_m", "N/m"),
    ("_ustrain", "µε"),
    ("_Nm", "N·m"),
    ("_N", "N"),
    ("_Pa", "Pa"),
    ("_J", "J"),
    ("_W", "W"),
    ("_rad", "rad"),
    ("_m", "m"),
    ("_s", "s"),
];

/// A column's name without its unit, and the unit; empty for plain numbers.
pub fn split_unit(name: &str) -> (&str, &'static str) {
    let found = UNITS
        .iter()
        .find_map(|(suffix, unit)| Some((name.strip_suffix(suffix)?, *unit)));
    found.unwrap_or((name, ""))
}

/// How soon a reader asks for a column, soonest first: transmission error, forces of meshes, radial and axial forces of
/// bearings, root strain, line loads, speeds, other force elements and joints, beams of shafts, all else.
pub fn rank(name: &str) -> u8 {
    let parts: Vec<&str> = name.split('/').collect();
    let [kind, owners @ .., channel] = &parts[..] else {
        return 9;
    };
    match *kind {
        "elements" => match *channel {
            "transmission_error_m" => 0,
            "loaded_pairs" | "apart" => 1,
            mesh if mesh.starts_with("normal_force_") || mesh.ends_with("_force_1_N") => 1,
            "force_radial_N" | "force_shaft_z_N" => 2,
            strain if strain.starts_with("strain_") => 3,
            slice if slice.starts_with("line_load_slice_") => 4,
            _ if owners.first().is_some_and(|owner| is_beam(owner)) => 8,
            _ => 6,
        },
        "bodies" if *channel == "angular_velocity_z_rad_per_s" => 5,
        "joints" if matches!(split_unit(channel).1, "N" | "N·m") => 7,
        _ => 9,
    }
}

/// Whether an element is a beam between stations of a shaft: `shaft_0-1`.
fn is_beam(owner: &str) -> bool {
    let Some((_, stations)) = owner.rsplit_once('_') else {
        return false;
    };
    let number = |text: &str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
    stations
        .split_once('-')
        .is_some_and(|(a, b)| number(a) && number(b))
}

/// Columns that a reader asks for first: channels of force elements, and speeds about the bodies' own axes.
pub fn is_prominent(name: &str) -> bool {
    name.starts_with("elements/") || name.ends_with("/angular_velocity_z_rad_per_s")
}

/// Which columns are other than zero by more than rounding, measured by the largest value that has their unit. A column
/// is its name with its least and largest value.
pub fn noticeable<'a>(columns: impl Iterator<Item = (&'a str, f64, f64)> + Clone) -> Vec<bool> {
    let scales = scales(columns.clone());
    columns
        .map(|(name, least, most)| {
            least.abs().max(most.abs()) > ROUNDING * scales[split_unit(name).1]
        })
        .collect()
}

/// Which columns vary by more than rounding, measured by the largest value that has their unit. A column is its name
/// with its least and largest value.
pub fn varying<'a>(columns: impl Iterator<Item = (&'a str, f64, f64)> + Clone) -> Vec<bool> {
    let scales = scales(columns.clone());
    columns
        .map(|(name, least, most)| most - least > ROUNDING * scales[split_unit(name).1])
        .collect()
}

/// Largest magnitude of each unit.
fn scales<'a>(columns: impl Iterator<Item = (&'a str, f64, f64)>) -> BTreeMap<&'a str, f64> {
    let mut largest = BTreeMap::new();
    for (name, least, most) in columns {
        let scale: &mut f64 = largest.entry(split_unit(name).1).or_default();
        *scale = scale.max(least.abs()).max(most.abs());
    }
    largest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_those_of_the_names() {
        assert_eq!(split_unit("a/force_x_N"), ("a/force_x", "N"));
        assert_eq!(split_unit("moment_z_Nm"), ("moment_z", "N·m"));
        assert_eq!(
            split_unit("acceleration_x_m_per_s2"),
            ("acceleration_x", "m/s²")
        );
        assert_eq!(split_unit("loaded_pairs"), ("loaded_pairs", ""));
    }

    #[test]
    fn meshes_and_bearings_come_before_beams() {
        let names = [
            "elements/first stage/transmission_error_m",
            "elements/first stage/normal_force_left_N",
            "elements/front bearing/force_radial_N",
            "elements/first stage/strain_gear1_root_method2_ustrain",
            "elements/first stage/line_load_slice_3_N_per_m",
            "bodies/pinion/angular_velocity_z_rad_per_s",
            "elements/coupling/moment_z_Nm",
            "joints/axis/force_x_N",
            "elements/low shaft_0-1/force_x_N",
            "bodies/pinion/x_m",
        ];
        let ranks = names.map(rank);
        assert!(ranks.is_sorted() && ranks[7] < ranks[8], "{ranks:?}");
        assert_eq!(rank("time_s"), 9);
    }

    #[test]
    fn rounding_does_not_vary() {
        let columns = [
            ("x_m", 0.1, 0.3),
            ("y_m", -1e-17, 1e-17),
            ("n", 1.0, 2.0),
            ("z_N", -1e-17, 1e-17),
        ];
        assert_eq!(varying(columns.into_iter()), [true, false, true, true]);
        let still = [("x_m", 0.3, 0.3), ("y_m", -1e-17, 1e-17), ("n", 0.0, 0.0)];
        assert_eq!(noticeable(still.into_iter()), [true, false, false]);
    }
}
