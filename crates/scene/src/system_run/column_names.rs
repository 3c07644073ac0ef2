//! What the names of columns say: which ones a reader asks for first, and how they read without their unit.

use std::collections::BTreeMap;

/// What is smaller, over the largest value of its unit, is rounding and what solvers leave: they end at shares of 1e-8
/// and below. Lengths have a finer limit: a place of a metre stands beside a transmission error of nanometres.
#[must_use]
pub fn rounding(unit: &str) -> f64 {
    if unit == "m" { 1e-9 } else { 1e-7 }
}

/// How units are written behind a name, longer ones before those that end them.
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

/// A column's name without the unit that stands behind it, if its unit is that one.
pub fn stem<'a>(name: &'a str, unit: &str) -> &'a str {
    let written = UNITS.iter().find(|(_, known)| *known == unit);
    let stem = written.and_then(|(suffix, _)| name.strip_suffix(suffix));
    stem.unwrap_or(name)
}

/// The unit that a column's name ends in; `1` for plain numbers. Results of version 1 state it nowhere else.
#[must_use]
pub fn unit_in_name(name: &str) -> &'static str {
    let found = UNITS.iter().find(|(suffix, _)| name.ends_with(suffix));
    found.map_or("1", |(_, unit)| unit)
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
            "moment_1_Nm" | "moment_2_Nm" => 1,
            "force_radial_N" | "force_shaft_z_N" => 2,
            pair if is_of_pair(pair) => 9,
            strain if strain.starts_with("strain_") => 3,
            slice if slice.starts_with("line_load_slice_") => 4,
            _ if owners.first().is_some_and(|owner| is_beam(owner)) => 8,
            _ => 6,
        },
        "bodies" if *channel == "angular_velocity_z_rad_per_s" => 5,
        "joints" if channel.starts_with("force_") || channel.starts_with("moment_") => 7,
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

/// Whether a channel tells of one of the pairs of teeth that carry, whose number changes from row to row:
/// `pair_2_force_N`.
pub fn is_of_pair(channel: &str) -> bool {
    let number = channel
        .strip_prefix("pair_")
        .and_then(|rest| rest.split_once('_'));
    number.is_some_and(|(number, _)| number.parse::<usize>().is_ok())
}

/// Columns that a reader asks for first: channels of force elements but those of single pairs of teeth, and speeds
/// about the bodies' own axes.
pub fn is_prominent(name: &str) -> bool {
    let of_element =
        name.starts_with("elements/") && !name.rsplit('/').next().is_some_and(is_of_pair);
    of_element || name.ends_with("/angular_velocity_z_rad_per_s")
}

/// Which columns are other than zero by more than rounding, measured by the largest value that has their unit. A column
/// is its unit with its least and largest value.
pub fn noticeable<'a>(columns: impl Iterator<Item = (&'a str, f64, f64)> + Clone) -> Vec<bool> {
    let scales = scales(columns.clone());
    columns
        .map(|(unit, least, most)| least.abs().max(most.abs()) > rounding(unit) * scales[unit])
        .collect()
}

/// Which columns vary by more than rounding, measured by the largest value that has their unit. A column is its unit
/// with its least and largest value.
pub fn varying<'a>(columns: impl Iterator<Item = (&'a str, f64, f64)> + Clone) -> Vec<bool> {
    let scales = scales(columns.clone());
    columns
        .map(|(unit, least, most)| most - least > rounding(unit) * scales[unit])
        .collect()
}

/// Largest magnitude of each unit.
fn scales<'a>(columns: impl Iterator<Item = (&'a str, f64, f64)>) -> BTreeMap<&'a str, f64> {
    let mut largest = BTreeMap::new();
    for (unit, least, most) in columns {
        let scale: &mut f64 = largest.entry(unit).or_default();
        *scale = scale.max(least.abs()).max(most.abs());
    }
    largest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_read_without_the_unit_that_they_have() {
        assert_eq!(stem("a/force_x_N", "N"), "a/force_x");
        assert_eq!(stem("moment_z_Nm", "N·m"), "moment_z");
        // A gauge whose name ends like a unit.
        assert_eq!(stem("gauge_m", "1"), "gauge_m");
        assert_eq!(stem("gauge_m", "µε"), "gauge_m");
    }

    #[test]
    fn files_of_version_1_have_their_units_in_the_names() {
        for (name, unit) in [
            ("a/force_x_N", "N"),
            ("moment_z_Nm", "N·m"),
            ("acceleration_x_m_per_s2", "m/s²"),
            ("loaded_pairs", "1"),
        ] {
            assert_eq!(unit_in_name(name), unit);
        }
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
            ("m", 0.1, 0.3),
            ("m", -1e-17, 1e-17),
            ("1", 1.0, 2.0),
            ("N", -1e-17, 1e-17),
        ];
        assert_eq!(varying(columns.into_iter()), [true, false, true, true]);
        // An axial force of spur gears is what their solver leaves; a transmission error of nanometres is none of that.
        let forces = [("N", 900.0, 2566.0), ("N", -4.9e-6, 1.5e-5)];
        assert_eq!(varying(forces.into_iter()), [true, false]);
        let lengths = [("m", 0.0, 0.1), ("m", -6e-9, -5e-9)];
        assert_eq!(varying(lengths.into_iter()), [true, true]);
        let still = [("m", 0.3, 0.3), ("m", -1e-17, 1e-17), ("1", 0.0, 0.0)];
        assert_eq!(noticeable(still.into_iter()), [true, false, false]);
    }
}
