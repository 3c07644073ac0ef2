//! What is looked at before an input file is read: a device never ends, a pipe waits for ever, and a file of many
//! gigabytes fills the memory.

use std::fs::{File, Metadata};
use std::io::Read;
use std::path::Path;

/// Most bytes of a text file that is read: gear, scene, study, table, record.
pub const MOST_TEXT_BYTES: u64 = 64 << 20;

/// Most bytes of a mesh from another program.
pub const MOST_MESH_BYTES: u64 = 4 << 30;

/// Why a file is not read.
#[derive(Debug, thiserror::Error)]
pub enum UnreadableFile {
    /// The operating system refused.
    #[error("cannot read the file: {0}")]
    Io(#[from] std::io::Error),
    /// A folder, a device, a pipe or a socket.
    #[error("is {found}; give a regular file")]
    NotAFile {
        /// What it is.
        found: &'static str,
    },
    /// Too long.
    #[error("has {} MB, more than the {} MB that are read; give a shorter file", bytes >> 20, most >> 20)]
    TooLarge {
        /// Length of the file, or what was read of it.
        bytes: u64,
        /// What is allowed.
        most: u64,
    },
}

/// Demands a regular file of at most `most` bytes, through symbolic links.
///
/// # Errors
/// [`UnreadableFile`].
pub fn demand_readable(path: &Path, most: u64) -> Result<(), UnreadableFile> {
    let found = path.metadata()?;
    if !found.is_file() {
        return Err(UnreadableFile::NotAFile {
            found: kind(&found),
        });
    }
    if found.len() > most {
        return Err(UnreadableFile::TooLarge {
            bytes: found.len(),
            most,
        });
    }
    Ok(())
}

/// The bytes of a regular file of at most `most` bytes.
///
/// # Errors
/// [`UnreadableFile`], before anything is read.
pub fn read_bytes(path: &Path, most: u64) -> Result<Vec<u8>, UnreadableFile> {
    demand_readable(path, most)?;
    let mut bytes = Vec::new();
    // Files of /proc say that they are empty and are not.
    File::open(path)?.take(most + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > most {
        return Err(UnreadableFile::TooLarge {
            bytes: bytes.len() as u64,
            most,
        });
    }
    Ok(bytes)
}

fn kind(found: &Metadata) -> &'static str {
    if found.is_dir() {
        "a folder"
    } else {
        "a device, pipe or socket"
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_read_up_to_its_most_bytes() {
        let path = std::env::temp_dir().join(format!("gearmesh-readable-{}", std::process::id()));
        std::fs::write(&path, b"12345").unwrap();
        assert_eq!(read_bytes(&path, 5).unwrap(), b"12345");
        let error = read_bytes(&path, 4).unwrap_err();
        std::fs::remove_file(&path).unwrap();
        assert!(matches!(
            error,
            UnreadableFile::TooLarge { bytes: 5, most: 4 }
        ));
    }

    #[test]
    fn what_is_no_file_is_refused() {
        let folder = read_bytes(&std::env::temp_dir(), 9).unwrap_err();
        assert_eq!(folder.to_string(), "is a folder; give a regular file");
        #[cfg(unix)]
        {
            let device = read_bytes(Path::new("/dev/zero"), 9).unwrap_err();
            assert!(device.to_string().starts_with("is a device"), "{device}");
        }
    }
}
