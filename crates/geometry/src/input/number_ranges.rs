//! The range of every number of an input file. Keys carry their unit, so the unit at the end of a key says how large
//! its numbers may be: far beyond any machine, but small enough that no square or product of two of them leaves the
//! range of the processor's numbers. What a single key allows beyond that is said where the key is read.

/// What is allowed of the numbers of a key.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NumberRange {
    /// Unit as in the key, empty for numbers without one.
    unit: &'static str,
    /// Largest magnitude.
    largest: f64,
}

/// Smallest magnitude but zero: below it a number is the result of a slip or of a division by infinity, not rounding.
const SMALLEST: f64 = 1e-30;

/// Units at the ends of keys and the largest magnitudes.
const UNITS: [(&str, f64); 26] = [
    ("mm", 1e6),
    ("um", 1e6),
    ("deg", 1e6),
    ("mrad", 1e4),
    ("urad", 1e7),
    ("rpm", 1e7),
    ("rad_per_s", 1e6),
    ("mm_per_s", 1e9),
    ("m_per_s2", 1e6),
    ("Hz", 1e9),
    ("s", 1e9),
    ("N", 1e12),
    ("Nm", 1e12),
    ("kg", 1e9),
    ("kg_m2", 1e12),
    ("kg_per_m3", 1e6),
    ("GPa", 1e6),
    ("MPa", 1e9),
    ("N_per_mm", 1e15),
    ("N_per_mm_um", 1e12),
    ("N_per_mm_e", 1e15),
    ("Nm_per_rad", 1e15),
    ("N_s_per_mm", 1e12),
    ("Nm_s_per_rad", 1e12),
    ("ustrain", 1e7),
    ("SI", 1e18),
];

/// Keys whose numbers have no unit and a wider range than others: load cycles, and the values of a study, whose range
/// is that of the key they are put into.
const WIDE: [&str; 2] = ["cycles", "values"];

/// Range of numbers without a unit.
const PLAIN: NumberRange = NumberRange {
    unit: "",
    largest: 1e12,
};

impl NumberRange {
    /// The range by a key's own unit; none where it ends in no unit.
    fn of_unit(key: &str) -> Option<Self> {
        let ends = |unit: &str| key.strip_suffix(unit).is_some_and(|s| s.ends_with('_'));
        UNITS
            .iter()
            .filter(|(unit, _)| ends(unit))
            .max_by_key(|(unit, _)| unit.len())
            .map(|&(unit, largest)| Self { unit, largest })
    }

    /// The range of the numbers of a key or of a column's head.
    pub fn of(key: &str) -> Self {
        let wide = WIDE.contains(&key).then_some(Self {
            largest: 1e30,
            ..PLAIN
        });
        Self::of_unit(key).or(wide).unwrap_or(PLAIN)
    }

    /// The unit, empty for a key without one.
    pub fn unit(self) -> &'static str {
        self.unit
    }

    /// The largest magnitude, in the unit.
    pub fn largest(self) -> f64 {
        self.largest
    }

    /// The range of a key within the value of another: its own, or that of the value where it has no unit, as in
    /// `torque_Nm = { step = { from = 0.0, … } }`.
    fn within(self, key: &str) -> Self {
        match Self::of(key) {
            PLAIN => self,
            own => own,
        }
    }

    /// What is wrong with a number; none where it is within the range.
    pub fn problem(self, value: f64) -> Option<String> {
        let size = value.abs();
        if value == 0.0 || (SMALLEST..=self.largest).contains(&size) {
            return None;
        }
        let Self { unit, largest } = self;
        let unit = if unit.is_empty() {
            String::new()
        } else {
            format!(" {unit}")
        };
        Some(if size < SMALLEST {
            format!(
                "found {value:e}, allowed is 0, or {SMALLEST:e} to {largest:e}{unit} of either sign"
            )
        } else {
            format!(
                "found {value}, allowed is a finite number from -{largest:e} to {largest:e}{unit}"
            )
        })
    }
}

/// The first number of a document that is out of its range, or text that holds a control character: dotted key and what
/// is wrong.
pub(super) fn first_problem(table: &toml::Table) -> Option<(String, String)> {
    let (key, mut problem) = table
        .iter()
        .find_map(|(key, value)| problem_below(value, key, NumberRange::of(key)))?;
    // Programs that know no joints write 1e23 N/m for a rigid support.
    if key.contains("stiffness") {
        problem.push_str("; a rigid support is a [[joint]], not a stiffness");
    }
    Some((key, problem))
}

fn problem_below(value: &toml::Value, path: &str, range: NumberRange) -> Option<(String, String)> {
    let below = |key: &str, value: &toml::Value, range| {
        problem_below(value, &format!("{path}.{key}"), range)
    };
    match value {
        toml::Value::Float(number) => Some((path.to_string(), range.problem(*number)?)),
        toml::Value::Integer(number) => Some((path.to_string(), range.problem(*number as f64)?)),
        toml::Value::Array(items) => {
            (items.iter().enumerate()).find_map(|(i, item)| below(&i.to_string(), item, range))
        }
        toml::Value::Table(table) => table
            .iter()
            .find_map(|(key, value)| below(key, value, range.within(key))),
        toml::Value::String(text) => Some((path.to_string(), control_character(text)?)),
        _ => None,
    }
}

/// What is wrong with a text that no terminal should be sent, and HDF5 cannot hold where it is NUL.
fn control_character(text: &str) -> Option<String> {
    let bad = |c: &char| c.is_control() && !matches!(c, '\n' | '\r' | '\t');
    let found = u32::from(text.chars().find(bad)?);
    Some(format!(
        "found the control character U+{found:04X}; allowed is text with spaces, tabs and line breaks"
    ))
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::input::InputDocument;

    fn complaint(text: &str) -> String {
        let document = InputDocument::new("g.toml", text);
        document.parse::<toml::Table>().unwrap_err().to_string()
    }

    #[test]
    fn control_characters_are_refused_wherever_they_stand() {
        for (text, place) in [
            (
                "title = \"a\\u0000b\"",
                "title: found the control character U+0000",
            ),
            (
                "[[body]]\nname = \"\\u001b[2J\"",
                "body.0.name: found the control character U+001B",
            ),
        ] {
            assert!(complaint(text).contains(place), "{}", complaint(text));
        }
    }

    #[test]
    fn the_unit_of_a_key_is_its_longest() {
        for (key, unit) in [
            ("speed_mm_per_s", "mm_per_s"),
            ("damping_N_s_per_mm", "N_s_per_mm"),
            ("tilt_damping_Nm_s_per_rad", "Nm_s_per_rad"),
            ("radial_stiffness_N_per_mm", "N_per_mm"),
            ("stiffness_N_per_mm_e", "N_per_mm_e"),
            ("end_s", "s"),
            ("poisson", ""),
            ("profile_shift", ""),
            ("pitches", ""),
        ] {
            assert_eq!(NumberRange::of(key).unit, unit, "{key}");
        }
    }

    #[test]
    fn every_number_is_finite_and_in_the_range_of_its_unit() {
        for (text, expected) in [
            (
                "[[gauge]]\nz_mm = inf",
                "g.toml:2: gauge.0.z_mm: found inf, allowed is a finite number from -1e6 to 1e6 mm",
            ),
            (
                "[tooth]\na_mm = 1.0\nface_width_mm = 1.8e19",
                "g.toml:3: tooth.face_width_mm: found 18000000000000000000, allowed is a finite number from -1e6 to 1e6 mm",
            ),
            (
                "crack.tangent_deg = nan",
                "g.toml:1: crack.tangent_deg: found NaN, allowed is a finite number from -1e6 to 1e6 deg",
            ),
            (
                "run.measure_s = 1e-300",
                "g.toml:1: run.measure_s: found 1e-300, allowed is 0, or 1e-30 to 1e9 s of either sign",
            ),
            (
                "[[load]]\ntorque_Nm = { step = { start_s = 0, from = 0, end_s = 1,\nto = -1e13 } }",
                "g.toml:3: load.0.torque_Nm.step.to: found -10000000000000, allowed is a finite number from -1e12 to 1e12 Nm",
            ),
            (
                "load_factors = [1.0,\n-inf]",
                "g.toml:2: load_factors.1: found -inf, allowed is a finite number from -1e12 to 1e12",
            ),
        ] {
            assert_eq!(complaint(text), expected);
        }
        let sound = "cycles = [1e15]\nx_mm = [0.0, -0.0, -1e6, 6.1e-17]\ncount = 3\nflag = true";
        assert!(
            InputDocument::new("g.toml", sound)
                .parse::<toml::Table>()
                .is_ok()
        );
    }

    /// Squares and products of two of the largest numbers stay finite, also in SI units.
    #[test]
    fn products_of_the_largest_numbers_are_finite() {
        for (unit, largest) in UNITS {
            assert!((1e12 * largest * largest).is_finite(), "{unit}");
        }
    }
}
