//! The seal: length and digest of a file, kept in the HDF5 user block.
//!
//! HDF5 leaves the first 512 bytes of a file to the application when asked to; every HDF5 tool skips them. Checking the
//! seal needs no HDF5 call, so that libhdf5 (a C library that trusts what it parses) sees sound bytes only, and covers
//! everything: arrays, attributes, names, structure.
//!
//! The digest is BLAKE3: 1 GB/s on one core without special instructions, where SHA-256 does a tenth of that and would
//! take longer than everything else in reading a model of 100 MB.

use std::fs::File;
use std::io::{Read, Seek, SeekFrom, Write};
use std::path::Path;

use crate::file_error::{FileError, io_error};
use crate::text_heap::{HeapFinder, first_broken};

/// Length of the user block; the smallest that HDF5 allows.
pub(crate) const SEAL_BYTES: u64 = 512;

const MAGIC: &str = "gearmesh seal 1\n";

/// Writes the seal into the first 512 bytes of a closed HDF5 file that was created with a user block of that length.
/// `path` is named in errors.
///
/// # Errors
/// [`FileError::Io`].
pub(crate) fn write_seal(file: &mut File, path: &Path) -> Result<(), FileError> {
    let io = |action| io_error(path, action);
    let length = file.metadata().map_err(io("inspect"))?.len();
    let digest = digest_of_body(file, |_| ()).map_err(io("read back"))?;
    let mut block = seal_text(length, &digest).into_bytes();
    block.resize(SEAL_BYTES as usize, 0);
    file.seek(SeekFrom::Start(0))
        .and_then(|_| file.write_all(&block))
        .map_err(io("write"))
}

/// Checks length and content of a file against its seal, and that libhdf5 can walk through its texts; returns the
/// length.
///
/// # Errors
/// [`FileError::Io`], [`FileError::NotReadable`], [`FileError::NotAGearmeshFile`], [`FileError::Truncated`],
/// [`FileError::Altered`], [`FileError::BrokenTexts`].
pub(crate) fn verify_seal(path: &Path) -> Result<u64, FileError> {
    let (mut file, stored) = open_sealed(path)?;
    let io = || io_error(path, "read");
    let mut heaps = HeapFinder::new(SEAL_BYTES);
    let digest = digest_of_body(&mut file, |block| heaps.pass(block)).map_err(io())?;
    if digest != stored.digest {
        return Err(FileError::Altered {
            path: path.to_owned(),
            difference: format!("its digest is {digest}, was {}", stored.digest),
        });
    }
    if !has_usual_sizes(&mut file).map_err(io())? {
        return Err(FileError::NotAGearmeshFile {
            path: path.to_owned(),
            found: "its HDF5 head is not that of gearmesh's writer",
        });
    }
    if let Some(place) = first_broken(&mut file, &heaps.places, stored.length).map_err(io())? {
        return Err(FileError::BrokenTexts {
            path: path.to_owned(),
            place,
        });
    }
    Ok(stored.length)
}

/// The digest of a gearmesh file's content as its seal states it, 64 hexadecimal digits; names the model a result was
/// made from. Does not read the content.
///
/// # Errors
/// As for reading the file, except that an altered content is not noticed.
pub fn file_digest(path: &Path) -> Result<String, FileError> {
    open_sealed(path).map(|(_, stored)| stored.digest)
}

/// BLAKE3 digest of some bytes, 64 hexadecimal digits.
pub fn bytes_digest(bytes: &[u8]) -> String {
    blake3::hash(bytes).to_hex().to_string()
}

struct Seal {
    length: u64,
    digest: String,
}

/// Opens a file, reads its seal and compares the length.
fn open_sealed(path: &Path) -> Result<(File, Seal), FileError> {
    let io = |action| io_error(path, action);
    // Looked at before it is opened: to open a pipe is to wait for its other end.
    if !path.metadata().map_err(io("open"))?.is_file() {
        return Err(FileError::NotReadable {
            path: path.to_owned(),
        });
    }
    let mut file = File::open(path).map_err(io("open"))?;
    let found_bytes = file.metadata().map_err(io("inspect"))?.len();
    let mut block = Vec::new();
    (&mut file)
        .take(SEAL_BYTES)
        .read_to_end(&mut block)
        .map_err(io("read"))?;

    let seen = block.len().min(MAGIC.len());
    if seen == 0 || block[..seen] != MAGIC.as_bytes()[..seen] {
        let found = match &block[..] {
            [] => "it is empty",
            [0x89, b'H', b'D', b'F', ..] => "an HDF5 file of another origin",
            _ => "not HDF5 with a gearmesh seal",
        };
        return Err(FileError::NotAGearmeshFile {
            path: path.to_owned(),
            found,
        });
    }
    if (block.len() as u64) < SEAL_BYTES {
        return Err(FileError::Truncated {
            path: path.to_owned(),
            found_bytes,
            expected_bytes: None,
        });
    }
    let stored = parse_seal(&block).ok_or_else(|| FileError::Altered {
        path: path.to_owned(),
        difference: "the seal in its first 512 bytes is unreadable".to_owned(),
    })?;
    if found_bytes < stored.length {
        let expected_bytes = Some(stored.length);
        return Err(FileError::Truncated {
            path: path.to_owned(),
            found_bytes,
            expected_bytes,
        });
    }
    if found_bytes > stored.length {
        return Err(FileError::Altered {
            path: path.to_owned(),
            difference: format!("{found_bytes} bytes long, was {}", stored.length),
        });
    }
    Ok((file, stored))
}

fn seal_text(length: u64, digest: &str) -> String {
    format!("{MAGIC}bytes {length}\nblake3 {digest}\n")
}

/// Reads a seal back; `None` unless writing it again gives the same 512 bytes.
fn parse_seal(block: &[u8]) -> Option<Seal> {
    let text = std::str::from_utf8(block).ok()?.trim_end_matches('\0');
    let mut lines = text.strip_prefix(MAGIC)?.lines();
    let length = lines.next()?.strip_prefix("bytes ")?.parse().ok()?;
    let digest = lines.next()?.strip_prefix("blake3 ")?.to_owned();
    (seal_text(length, &digest) == text).then_some(Seal { length, digest })
}

/// Whether the HDF5 superblock follows the seal and says that addresses and lengths have eight bytes, as the walk
/// through the texts takes them.
fn has_usual_sizes(file: &mut File) -> std::io::Result<bool> {
    let mut head = Vec::new();
    file.seek(SeekFrom::Start(SEAL_BYTES))?;
    file.take(16).read_to_end(&mut head)?;
    // Versions 0 and 1 have the two sizes from byte 13 on, later ones from byte 9 on.
    let sizes = match head.get(8) {
        Some(0 | 1) => head.get(13..15),
        _ => head.get(9..11),
    };
    Ok(head.starts_with(b"\x89HDF\r\n\x1a\n") && sizes == Some(&[8, 8]))
}

/// Digest of everything after the seal, in hexadecimal; `pass` sees every block.
fn digest_of_body(file: &mut File, mut pass: impl FnMut(&[u8])) -> std::io::Result<String> {
    file.seek(SeekFrom::Start(SEAL_BYTES))?;
    let mut hasher = blake3::Hasher::new();
    let mut buffer = vec![0; 1 << 20];
    loop {
        match file.read(&mut buffer)? {
            0 => return Ok(hasher.finalize().to_hex().to_string()),
            count => {
                hasher.update(&buffer[..count]);
                pass(&buffer[..count]);
            }
        }
    }
}
