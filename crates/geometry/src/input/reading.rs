//! Structures read from values of TOML.
//!
//! Derived readers are compiled for each kind of deserializer that they meet, and tables of scenes are many: that was a tenth of the program. Here they all see one, behind a
//! pointer (erased_serde). It passes messages on, not the spans of toml's errors: lines are found by the path of the key.

use serde::Deserialize;
use serde::de::Deserializer;
use serde_path_to_error::{Path, Segment, Track};

/// What a reader did not like.
pub(super) struct Misread {
    /// Keys from the root of the values to the place.
    pub keys: Vec<String>,
    /// In serde's words.
    pub message: String,
}

/// A deserializer of any kind, behind a pointer.
pub(super) type Erased<'a, 'de> = dyn erased_serde::Deserializer<'de> + 'a;

/// Reads a structure, and says where it fails.
///
/// # Errors
/// [`Misread`], the reader's complaint.
pub(super) fn read<'de, T: Deserialize<'de>>(values: impl Deserializer<'de>) -> Result<T, Misread> {
    read_by(values, |erased| T::deserialize(erased))
}

/// As [`read`], with a reader that is not the structure's own.
///
/// # Errors
/// As [`read`].
pub(super) fn read_by<'de, T>(
    values: impl Deserializer<'de>,
    reader: impl FnOnce(&mut Erased<'_, 'de>) -> Result<T, erased_serde::Error>,
) -> Result<T, Misread> {
    let mut track = Track::new();
    let tracked = serde_path_to_error::Deserializer::new(values, &mut track);
    let read = reader(&mut <Erased<'_, 'de>>::erase(tracked));
    read.map_err(|error| Misread {
        keys: keys_of(&track.path()),
        message: without_context(&error.to_string()).to_owned(),
    })
}

/// A message as it was before it came through tables: each adds a line with its key, which the path tells.
fn without_context(message: &str) -> &str {
    let end = message.find("\nin `").unwrap_or(message.len());
    message[..end].trim()
}

fn keys_of(path: &Path) -> Vec<String> {
    path.iter()
        .filter_map(|segment| match segment {
            Segment::Map { key } => Some(key.clone()),
            Segment::Seq { index } => Some(index.to_string()),
            Segment::Enum { .. } | Segment::Unknown => None,
        })
        .collect()
}
