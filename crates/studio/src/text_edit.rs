//! A key of a TOML text set or taken away; comments and everything else stay as they are.

use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// Sets the key at a dotted path; a table that is missing is put at the end.
///
/// # Errors
/// What is wrong with the text, or with the path.
pub fn set(text: &str, path: &str, value: &toml::Value) -> Result<String, String> {
    if value.is_table() || value.is_datetime() {
        return Err(format!("{path}: tables are set key by key"));
    }
    let root = DeTable::parse(text).map_err(|error| error.to_string())?;
    let (tables, key) = path.rsplit_once('.').unwrap_or(("", path));
    let line = format!("{key} = {value}");
    let mut place = Place::Top(root.get_ref());
    for name in tables.split('.').filter(|name| !name.is_empty()) {
        match place.table().get(name) {
            Some(found) => place = Place::of(text, path, found)?,
            None if matches!(place, Place::Inline(..)) => return Err(elsewhere(path)),
            // Behind all tables that are there, whose keys it does not take.
            None => return Ok(format!("{}\n\n[{tables}]\n{line}\n", text.trim_end())),
        }
    }
    if let Some(found) = place.table().get(key) {
        if matches!(found.get_ref(), DeValue::Table(_)) {
            return Err(format!("{path}: is a table in this text"));
        }
        return Ok(replaced(text, found.span(), &value.to_string()));
    }
    let at = match place {
        Place::Inline(_, end) => {
            let inner = text[..end].trim_end();
            let comma = if inner.ends_with('{') { " " } else { ", " };
            let whole = format!("{inner}{comma}{line} {}", &text[end..]);
            return Ok(whole);
        }
        // Behind the last of its own keys, or its head.
        Place::Top(table) | Place::Head(table, _) => {
            let values = table.iter().filter(|(_, value)| is_own(text, value));
            let last = values.map(|(_, value)| value.span().end).max();
            last.or(place.head()).unwrap_or(0)
        }
    };
    let end = text[at..].find('\n').map_or(text.len(), |n| at + n);
    let begins = if end == 0 { "" } else { "\n" };
    Ok(replaced(text, end..end, &format!("{begins}{line}")))
}

/// Takes away the line of the key at a dotted path, if it is there.
///
/// # Errors
/// What is wrong with the text, and for a key that shares its line.
pub fn remove(text: &str, path: &str) -> Result<String, String> {
    let root = DeTable::parse(text).map_err(|error| error.to_string())?;
    let (tables, key) = path.rsplit_once('.').unwrap_or(("", path));
    let mut place = Place::Top(root.get_ref());
    for name in tables.split('.').filter(|name| !name.is_empty()) {
        match place.table().get(name) {
            Some(found) => place = Place::of(text, path, found)?,
            None => return Ok(text.to_owned()),
        }
    }
    let Some(found) = place.table().get(key) else {
        return Ok(text.to_owned());
    };
    if matches!(place, Place::Inline(..)) {
        return Err(elsewhere(path));
    }
    let span = found.span();
    let begin = text[..span.start].rfind('\n').map_or(0, |n| n + 1);
    let end = text[span.end..].find('\n');
    let end = end.map_or(text.len(), |n| span.end + n + 1);
    Ok(replaced(text, begin..end, ""))
}

/// Where a table of a text stands.
enum Place<'a> {
    /// The text itself.
    Top(&'a DeTable<'a>),
    /// Below a head in brackets, which ends there.
    Head(&'a DeTable<'a>, usize),
    /// In braces, the closing one of which stands there.
    Inline(&'a DeTable<'a>, usize),
}

impl<'a> Place<'a> {
    fn of(text: &str, path: &str, found: &'a Spanned<DeValue<'a>>) -> Result<Self, String> {
        let span = found.span();
        let DeValue::Table(table) = found.get_ref() else {
            return Err(format!(
                "{path}: goes through what is no table in this text"
            ));
        };
        match text[span.start..].chars().next() {
            Some('{') => Ok(Self::Inline(table, span.end - 1)),
            Some('[') => Ok(Self::Head(table, span.end)),
            _ => Err(elsewhere(path)),
        }
    }

    fn table(&self) -> &'a DeTable<'a> {
        match self {
            Self::Top(table) | Self::Head(table, _) | Self::Inline(table, _) => table,
        }
    }

    fn head(&self) -> Option<usize> {
        match self {
            Self::Head(_, end) => Some(*end),
            _ => None,
        }
    }
}

/// Whether a value stands among the keys of its table, and not below a head of its own.
fn is_own(text: &str, value: &Spanned<DeValue<'_>>) -> bool {
    match value.get_ref() {
        DeValue::Table(_) => text[value.span().start..].starts_with('{'),
        DeValue::Array(items) => !items.iter().any(|item| !is_own(text, item)),
        _ => true,
    }
}

fn elsewhere(path: &str) -> String {
    format!("{path}: shares its line with other keys here; change the text")
}

fn replaced(text: &str, range: std::ops::Range<usize>, by: &str) -> String {
    format!("{}{by}{}", &text[..range.start], &text[range.end..])
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    const TEXT: &str = "# A gear.\nname = \"a\" # its name\n\n[tooth]   # teeth\nmodule_mm = 3.0  # normal\n\n[mesh]\nmodel = { kind = \"hybrid\" }\n";

    #[test]
    fn comments_stay() {
        let value = toml::Value::Float(2.5);
        let changed = set(TEXT, "tooth.module_mm", &value).unwrap();
        assert_eq!(changed, TEXT.replace("3.0", "2.5"));
        let inline = set(TEXT, "mesh.model.local", &"none".into()).unwrap();
        assert!(inline.contains("kind = \"hybrid\"") && inline.contains("local = \"none\""));
        let list = toml::Value::Array(vec![1.0.into(), 2.0.into()]);
        let added = set(TEXT, "run.torques_Nm", &list).unwrap();
        assert!(added.starts_with(TEXT.trim_end()), "{added}");
        let table: toml::Table = added.parse().unwrap();
        assert_eq!(table["run"]["torques_Nm"], list);
        assert_eq!(remove(&changed, "nothing.there").unwrap(), changed);
        // Beside its own table's keys, before the next table.
        let beside = set(TEXT, "tooth.teeth", &toml::Value::Integer(23)).unwrap();
        assert!(
            beside.contains("# normal\nteeth = 23\n\n[mesh]"),
            "{beside}"
        );
        assert!(set("", "a", &1.0.into()).unwrap().starts_with("a = 1.0"));
        let empty = set("[a]\n\n[b]\nx = 1\n", "a.y", &2.5.into()).unwrap();
        assert_eq!(empty, "[a]\ny = 2.5\n\n[b]\nx = 1\n");
        assert!(
            !remove(TEXT, "tooth.module_mm")
                .unwrap()
                .contains("module_mm")
        );
    }

    #[test]
    fn what_is_no_toml_or_no_table_is_said() {
        let one = toml::Value::Integer(1);
        assert!(set("a = ", "b", &one).is_err());
        assert!(
            set(TEXT, "name.inner", &one)
                .unwrap_err()
                .contains("no table")
        );
        assert!(
            set("a.b = 1", "a.c", &one)
                .unwrap_err()
                .contains("change the text")
        );
        assert!(set(TEXT, "tooth", &one).unwrap_err().contains("is a table"));
    }
}
