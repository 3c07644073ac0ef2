//! From bytes to the text of a model: plain XML or JSON, or one member of a zip file.

use crate::error::{Result, RexsError};
use std::io::{Cursor, Read};

/// Text of more than this is not read: gearbox files have a few megabytes, and a zip file of some kilobytes may unpack
/// to anything.
pub const MOST_MB: u64 = 256;

/// Text of a model.
#[derive(Debug)]
pub struct Unpacked {
    /// XML or JSON.
    pub text: String,
    /// Member of the zip file.
    pub member: Option<String>,
    /// Other members, which are not read.
    pub further: Vec<String>,
}

/// Endings of a model inside a zip file, best first.
const ENDINGS: [&str; 4] = [".rexs", ".rexsj", ".xml", ".json"];

/// Unpacks a file.
///
/// # Errors
/// [`RexsError::Container`] and [`RexsError::TooLarge`].
pub fn unpack(bytes: Vec<u8>) -> Result<Unpacked> {
    if bytes.len() as u64 > MOST_MB << 20 {
        return Err(too_large("the file"));
    }
    if !bytes.starts_with(b"PK\x03\x04") && !bytes.starts_with(b"PK\x05\x06") {
        return Ok(Unpacked {
            text: decode(bytes)?,
            member: None,
            further: Vec::new(),
        });
    }
    let broken = |cause: zip::result::ZipError| RexsError::Container {
        found: format!("a zip file that cannot be read ({cause})"),
    };
    let mut archive = zip::ZipArchive::new(Cursor::new(bytes)).map_err(broken)?;
    let names: Vec<String> = archive.file_names().map(str::to_owned).collect();
    let name = the_model(&names)?;
    let mut unpacked = Vec::new();
    // One byte more than is allowed tells that there is more, whatever size the archive claims.
    archive
        .by_name(name)
        .map_err(broken)?
        .take((MOST_MB << 20) + 1)
        .read_to_end(&mut unpacked)
        .map_err(|cause| RexsError::Container {
            found: format!("member {name} of the zip file cannot be unpacked ({cause})"),
        })?;
    if unpacked.len() as u64 > MOST_MB << 20 {
        return Err(too_large(name));
    }
    let further = names.iter().filter(|n| *n != name && !n.ends_with('/'));
    Ok(Unpacked {
        text: decode(unpacked)?,
        member: Some(name.clone()),
        further: further.cloned().collect(),
    })
}

/// The one member of an archive that is a model.
fn the_model(names: &[String]) -> Result<&String> {
    let container = |found: String| RexsError::Container { found };
    let rank = |name: &str| {
        let lower = name.to_lowercase();
        let hidden = lower.starts_with("__macosx") || lower.contains("/.");
        ENDINGS
            .iter()
            .position(|e| lower.ends_with(e) && !hidden && !leads_out(&lower))
    };
    // The model lies on top, what it refers to in folders.
    let depth = |name: &str| name.matches('/').count();
    let mut members: Vec<((usize, usize), &String)> = names
        .iter()
        .filter_map(|n| Some(((depth(n), rank(n)?), n)))
        .collect();
    members.sort();
    let Some(&(best, name)) = members.first() else {
        let outside = names.iter().find(|name| leads_out(name));
        return Err(container(match outside {
            Some(name) => format!(
                "a zip file whose member `{name}` stands outside of the archive's own folder, which models never do; pack the model again, \
                 without a folder"
            ),
            None => format!(
                "a zip file without a member that ends in {}",
                ENDINGS.join(", ")
            ),
        }));
    };
    let equals = members.iter().filter(|m| m.0 == best);
    let equals: Vec<&str> = equals.map(|m| &m.1[..]).collect();
    if equals.len() > 1 {
        return Err(container(format!(
            "a zip file of {} models ({}); unpack it and name one",
            equals.len(),
            equals.join(", ")
        )));
    }
    Ok(name)
}

/// Whether a member's path leads out of the folder in which the archive would be unpacked.
fn leads_out(name: &str) -> bool {
    let is_absolute = name.starts_with(['/', '\\']) || name.get(1..2) == Some(":");
    is_absolute || name.split(['/', '\\']).any(|part| part == "..")
}

fn too_large(what: &str) -> RexsError {
    RexsError::TooLarge {
        what: what.to_owned(),
        most_mb: MOST_MB,
    }
}

/// Text from UTF-8, UTF-16 with a byte order mark, or Latin-1 where an XML declaration says so.
fn decode(bytes: Vec<u8>) -> Result<String> {
    let utf16 = |read: fn([u8; 2]) -> u16| {
        let pairs = bytes[2..]
            .chunks_exact(2)
            .map(|pair| read([pair[0], pair[1]]));
        String::from_utf16(&pairs.collect::<Vec<_>>()).map_err(|_| no_text("UTF-16 that is broken"))
    };
    if bytes.starts_with(&[0xff, 0xfe]) {
        return utf16(u16::from_le_bytes);
    }
    if bytes.starts_with(&[0xfe, 0xff]) {
        return utf16(u16::from_be_bytes);
    }
    let head = String::from_utf8_lossy(&bytes[..bytes.len().min(200)]).to_lowercase();
    match String::from_utf8(bytes) {
        Ok(text) => Ok(text
            .strip_prefix('\u{feff}')
            .map_or(text.clone(), str::to_owned)),
        Err(cause) if head.contains("8859-1") || head.contains("windows-1252") => Ok(cause
            .as_bytes()
            .iter()
            .map(|&byte| char::from(byte))
            .collect()),
        Err(cause) => Err(no_text(&format!(
            "bytes that are no UTF-8 text, from byte {} on",
            cause.utf8_error().valid_up_to()
        ))),
    }
}

fn no_text(found: &str) -> RexsError {
    RexsError::Container {
        found: found.to_owned(),
    }
}
