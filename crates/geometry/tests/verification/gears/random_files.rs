//! Gear files with damaged text: read or refused, never a panic.

use crate::gears::model;
use crate::property_cases::cases;
use gearmesh_geometry::GearDefinition;
use gearmesh_geometry::input::InputDocument;
use proptest::prelude::*;
use proptest::sample::{Index, select};

/// Values that keys get in place of theirs.
const VALUES: [&str; 16] = [
    "0",
    "-1",
    "1e-300",
    "1e300",
    "nan",
    "inf",
    "-0.0",
    "9223372036854775807",
    "\"\"",
    "\"right\"",
    "true",
    "[]",
    "{}",
    "5",
    "0.38",
    "[1.0, -1.0]",
];

/// A file with one line changed: its value replaced, the line removed or doubled, or a piece of text cut out.
#[derive(Debug, Clone)]
enum Damage {
    Value(Index, &'static str),
    Remove(Index),
    Double(Index),
    Cut(Index, Index),
}

impl Damage {
    fn of(&self, text: &str) -> String {
        let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
        match self {
            Self::Value(line, value) => {
                let line = line.index(lines.len());
                if let Some((key, _)) = lines[line].clone().split_once('=') {
                    lines[line] = format!("{key}= {value}");
                }
            }
            Self::Remove(line) => {
                let line = line.index(lines.len());
                lines.remove(line);
            }
            Self::Double(line) => {
                let line = line.index(lines.len());
                lines.insert(line, lines[line].clone());
            }
            Self::Cut(from, length) => {
                let characters: Vec<char> = text.chars().collect();
                let from = from.index(characters.len());
                let to = (from + 1 + length.index(40)).min(characters.len());
                return characters[..from].iter().chain(&characters[to..]).collect();
            }
        }
        lines.join("\n")
    }
}

fn damages() -> impl Strategy<Value = Vec<Damage>> {
    let one = prop_oneof![
        4 => (any::<Index>(), select(&VALUES[..])).prop_map(|(line, value)| Damage::Value(line, value)),
        1 => any::<Index>().prop_map(Damage::Remove),
        1 => any::<Index>().prop_map(Damage::Double),
        1 => (any::<Index>(), any::<Index>()).prop_map(|(from, length)| Damage::Cut(from, length)),
    ];
    proptest::collection::vec(one, 1..4)
}

proptest! {
    #![proptest_config(cases(400))]

    #[test]
    fn a_damaged_gear_file_is_read_or_refused_in_words(
        name in select(&["gear1.toml", "gear3.toml", "contour_filleted.toml", "imported.toml"][..]),
        damages in damages(),
    ) {
        let text = damages.iter().fold(model(name).source, |text, damage| damage.of(&text));
        match GearDefinition::from_document(&InputDocument::new("gear.toml", text.as_str())) {
            // What is read is a gear: its figures are numbers.
            Ok(gear) => {
                let g = &gear.profile;
                prop_assert!(g.form_roll_rad.is_finite() && g.tip_half_angle_rad() > 0.0 && gear.sectors() >= 1);
            }
            Err(e) => {
                let message = e.to_string();
                prop_assert!(message.starts_with("gear.toml"), "{message}");
                prop_assert!(!message.contains("NaN") || text.contains("nan"), "{message}");
            }
        }
    }
}
