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

/// Columns that a reader asks for first: channels of force elements, and speeds about the bodies' own axes.
pub fn is_prominent(name: &str) -> bool {
    name.starts_with("elements/") || name.ends_with("/angular_velocity_z_rad_per_s")
}

/// Which columns vary by more than rounding, measured by the largest value that has their unit. A column is its name with its least and
/// largest value.
pub fn varying<'a>(columns: impl Iterator<Item = (&'a str, f64, f64)> + Clone) -> Vec<bool> {
    let mut largest: BTreeMap<&str, f64> = BTreeMap::new();
    for (name, least, most) in columns.clone() {
        let scale = largest.entry(split_unit(name).1).or_default();
        *scale = scale.max(least.abs()).max(most.abs());
    }
    columns
        .map(|(name, least, most)| most - least > ROUNDING * largest[split_unit(name).1])
        .collect()
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
    fn rounding_does_not_vary() {
        let columns = [
            ("x_m", 0.1, 0.3),
            ("y_m", -1e-17, 1e-17),
            ("n", 1.0, 2.0),
            ("z_N", -1e-17, 1e-17),
        ];
        assert_eq!(varying(columns.into_iter()), [true, false, true, true]);
    }
}
