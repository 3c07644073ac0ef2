//! Keys that stood elsewhere in earlier files: before a document is read they are moved to their present places, with
//! their spans, so that old files are read and complaints still point to their lines.

use std::borrow::Cow;
use std::ops::Range;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// A table, or list of tables, that had another form.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FormerTable {
    /// Its key at the top of the file.
    pub table: &'static str,
    /// What has moved.
    pub moves: &'static [Move],
}

/// A key of a table and where it stands now. A table on the way is made where there is none; where something else
/// stands there, the former key is left to the reader, which refuses it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Move {
    /// Former dotted path within the table.
    pub from: &'static str,
    /// Present one.
    pub to: &'static str,
}

/// Former keys that now stand below one key.
#[derive(Debug)]
pub(super) struct Renewed {
    /// Dotted path of that key.
    pub key: String,
    /// Places of the former keys in the text.
    pub places: Vec<Range<usize>>,
    /// The key and its value as they are written now.
    pub present: String,
}

type Value<'t> = Spanned<DeValue<'t>>;

impl FormerTable {
    /// Moves the keys of a document; `text` is what it was made from.
    pub(super) fn renew(&self, document: &mut DeTable<'_>, text: &str) -> Vec<Renewed> {
        match document.get_mut(self.table).map(Spanned::get_mut) {
            Some(DeValue::Table(table)) => self.renew_table(self.table, table, text),
            Some(DeValue::Array(items)) => {
                let mut renewed = Vec::new();
                for (i, item) in items.iter_mut().enumerate() {
                    if let DeValue::Table(table) = item.get_mut() {
                        let path = format!("{}.{i}", self.table);
                        renewed.extend(self.renew_table(&path, table, text));
                    }
                }
                renewed
            }
            _ => Vec::new(),
        }
    }

    fn renew_table(&self, path: &str, table: &mut DeTable<'_>, text: &str) -> Vec<Renewed> {
        let mut heads: Vec<(&str, Vec<Range<usize>>)> = Vec::new();
        for step in self.moves {
            let Some(place) = step.apply(table) else {
                continue;
            };
            let head = first_part(step.to).0;
            match heads.iter_mut().find(|(known, _)| *known == head) {
                Some((_, places)) => places.push(place),
                None => heads.push((head, vec![place])),
            }
        }
        let renewed = heads.into_iter().filter_map(|(head, places)| {
            Some(Renewed {
                key: format!("{path}.{head}"),
                places,
                present: format!("{head} = {}", inline(table.get(head)?, text)),
            })
        });
        renewed.collect()
    }

    /// Present path of a key that a former file names by its dotted path, items of lists by number.
    pub(super) fn present_path(&self, path: &str) -> Option<String> {
        let rest = path.strip_prefix(self.table)?.strip_prefix('.')?;
        let (number, rest) = match rest.split_once('.') {
            Some((number, rest)) if number.parse::<usize>().is_ok() => (Some(number), rest),
            _ => (None, rest),
        };
        let (step, below) = self.moves.iter().find_map(|step| {
            let below = rest.strip_prefix(step.from)?;
            // Below `model` stand keys of today.
            let inside = below.starts_with('.') && !step.beneath_itself();
            (below.is_empty() || inside).then_some((step, below))
        })?;
        let number = number.map_or(String::new(), |number| format!("{number}."));
        Some(format!("{}.{number}{}{below}", self.table, step.to))
    }
}

impl Move {
    /// Whether the key names the table now into which it moved: `model` and `model.kind`.
    fn beneath_itself(&self) -> bool {
        first_part(self.to).0 == self.from
    }

    /// Moves the key; tells its place in the text where it was there.
    fn apply(&self, table: &mut DeTable<'_>) -> Option<Range<usize>> {
        let (key, value) = take(table, self.from)?;
        let place = key.span().start..value.span().end.max(key.span().end);
        // `model` names a table now: where it does, nothing has to move.
        if self.beneath_itself() && matches!(value.get_ref(), DeValue::Table(_)) {
            table.insert(key, value);
            return None;
        }
        match put(table, self.to, (&key.span(), value)) {
            Ok(()) => Some(place),
            Err(value) => {
                // Back to where it was: its parents are still there.
                let _ = put(table, self.from, (&key.span(), value));
                None
            }
        }
    }
}

/// First part of a dotted path and the rest.
fn first_part(path: &str) -> (&str, &str) {
    path.split_once('.').unwrap_or((path, ""))
}

/// Takes a value out of a table.
fn take<'t>(table: &mut DeTable<'t>, path: &str) -> Option<(Spanned<Cow<'t, str>>, Value<'t>)> {
    let (first, rest) = first_part(path);
    if rest.is_empty() {
        return table.remove_entry(first);
    }
    match table.get_mut(first)?.get_mut() {
        DeValue::Table(inner) => take(inner, rest),
        _ => None,
    }
}

/// Puts a value to its path, with tables on the way at the same place of the text; gives it back where something is
/// there.
fn put<'t>(
    table: &mut DeTable<'t>,
    path: &'static str,
    (place, value): (&Range<usize>, Value<'t>),
) -> Result<(), Value<'t>> {
    let (first, rest) = first_part(path);
    if rest.is_empty() {
        if table.contains_key(first) {
            return Err(value);
        }
        let key = Spanned::new(place.clone(), Cow::Borrowed(first));
        table.insert(key, value);
        return Ok(());
    }
    if !table.contains_key(first) {
        let key = Spanned::new(place.clone(), Cow::Borrowed(first));
        let made = Spanned::new(place.clone(), DeValue::Table(DeTable::new()));
        table.insert(key, made);
    }
    match table.get_mut(first).map(Spanned::get_mut) {
        Some(DeValue::Table(inner)) => put(inner, rest, (place, value)),
        _ => Err(value),
    }
}

/// A value as it can stand behind a key, in one line: as the text has it, if there is one.
fn inline(value: &Value<'_>, text: &str) -> String {
    match value.get_ref() {
        DeValue::Table(table) => {
            let mut entries: Vec<_> = table.iter().collect();
            entries.sort_by_key(|(key, _)| key.span().start);
            let entries: Vec<String> = entries
                .iter()
                .map(|(key, value)| format!("{} = {}", key.get_ref(), inline(value, text)))
                .collect();
            match entries.is_empty() {
                true => "{}".to_owned(),
                false => format!("{{ {} }}", entries.join(", ")),
            }
        }
        DeValue::Array(items) => {
            let items: Vec<String> = items.iter().map(|item| inline(item, text)).collect();
            format!("[{}]", items.join(", "))
        }
        DeValue::String(words) if text.is_empty() => format!("{words:?}"),
        DeValue::Integer(number) if text.is_empty() => number.to_string(),
        DeValue::Float(number) if text.is_empty() => number.to_string(),
        DeValue::Boolean(truth) if text.is_empty() => truth.to_string(),
        _ => text.get(value.span()).unwrap_or_default().to_owned(),
    }
}
