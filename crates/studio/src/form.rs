//! The keys of files that the page may set. Names, meanings, kinds, words and ranges come from the JSON Schemas that
//! `gearmesh schema` prints. What names a file is left out: the page reads nothing that the command line has not named.

use gearmesh_geometry::InputError;
use gearmesh_operations::changed_pair::GEARS;
use gearmesh_operations::schema::{TextKind, schema};
use gearmesh_scene::study::BaseScene;
use serde::Serialize;
use serde_json::Map;

use crate::form_field::{Field, Gears, refused};
use crate::form_walk::Walk;

/// Parts of a scene that name files, and those that belong to one side of the flanks or to what comes after a run.
const NOT_OF_SCENES: [&str; 8] = [
    "pair.gear_1",
    "pair.gear_2",
    "pair.misalignment_from",
    "topography",
    "left",
    "right",
    "rating",
    "title",
];

/// Parts of a gear file that name files, that scenes state, and those that no slider suits.
const NOT_OF_GEARS: [&str; 11] = [
    "name",
    "blank.file",
    "blank.length_unit",
    "microgeometry",
    "mesh",
    "reduction",
    "modes",
    "hub",
    "gauge",
    "crack",
    "tooth.cutter",
];

/// The fields of a file.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(transparent)]
pub struct Form {
    /// In the order of the schema.
    pub fields: Vec<Field>,
}

impl Form {
    /// The fields of a pair scene of these gears, and those of the gears' bodies.
    pub fn of_pair(base: &BaseScene, gears: Gears<'_>) -> Self {
        let of_scene = schema(TextKind::Scene);
        let stated = |key: &str| base.value(key);
        let mut walk = Walk::new(&of_scene, &stated, &NOT_OF_SCENES);
        walk.gears = Some(gears);
        walk.table("", &of_scene["$defs"]["PairTables"], &Map::new());
        let mut fields = walk.fields;
        let of_gear = schema(TextKind::Gear);
        for (number, key) in GEARS.iter().enumerate() {
            let stated = |key: &str| found_at(gears.files[number], key).cloned();
            let mut walk = Walk::new(&of_gear, &stated, &NOT_OF_GEARS);
            walk.gear = Some(gears.definitions[number]);
            walk.table("", &of_gear, &Map::new());
            fields.extend(walk.fields.into_iter().map(|field| {
                Field {
                    key: format!("{key}:{}", field.key),
                    group: format!("{}_body.{}", &key["pair.".len()..], field.group),
                    with: (field.with.into_iter())
                        .map(|(second, value)| (format!("{key}:{second}"), value))
                        .collect(),
                    reduces: true,
                    ..field
                }
            }));
        }
        Self { fields }
    }

    /// The fields of a text of a kind; none of a text that is no TOML.
    pub fn of_text(kind: TextKind, text: &str) -> Self {
        let root = toml::from_str(text).unwrap_or(toml::Value::Table(toml::Table::new()));
        let whole = schema(kind);
        let stated = |key: &str| found_at(&root, key).cloned();
        let left_out: &[&str] = match kind {
            TextKind::Scene => &NOT_OF_SCENES,
            TextKind::Gear => &NOT_OF_GEARS,
            _ => &["file", "title", "name"],
        };
        let mut walk = Walk::new(&whole, &stated, left_out);
        let top = match kind {
            TextKind::Scene => &whole["$defs"]["PairTables"],
            _ => &whole,
        };
        walk.table("", top, &Map::new());
        Self {
            fields: walk.fields,
        }
    }

    /// The field of a key.
    ///
    /// # Errors
    /// What to say of a key that is none.
    pub fn field(&self, key: &str) -> Result<&Field, InputError> {
        let found = self.fields.iter().find(|field| field.key == key);
        found.ok_or_else(|| refused(key, "is no key that the page may set"))
    }
}

/// What stands at a dotted path.
pub fn found_at<'a>(root: &'a toml::Value, key: &str) -> Option<&'a toml::Value> {
    key.split('.').try_fold(root, |place, part| place.get(part))
}
