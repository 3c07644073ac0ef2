//! The tables of texts of an HDF5 file (global heap collections), walked before libhdf5 does.
//!
//! Every text is an object of a collection, and libhdf5 walks through a collection by adding up the lengths that its
//! objects state: an object that states a length of zero is an endless loop, one that states a huge length leads out of
//! the memory. Layout ("HDF5 File Format Specification Version 3.0", III.E "Global Heap"), numbers little-endian:
//!
//! ```text
//! collection   "GCOL"  version 1  3 bytes 0  length of the collection with this head (8 bytes)  objects
//! object       index (2)  references (2)  0 (4)  length (8)  content, filled up to a multiple of 8 bytes
//! ```
//!
//! The object with index 0 is the free space at the end; its length counts its own head. Less than one head at the end
//! is free, too.

use std::fs::File;
use std::io::{Read, Seek, SeekFrom};

use memchr::memmem::Finder;

/// What every collection begins with.
const HEAD: &[u8; 8] = b"GCOL\x01\0\0\0";

/// Length of a collection's head, and of an object's.
const HEAD_BYTES: usize = 16;

/// Finds the collections of a file that passes by block by block.
pub(crate) struct HeapFinder {
    finder: Finder<'static>,
    /// Offset of the next block in the file.
    offset: u64,
    /// The last bytes of the blocks before.
    before: Vec<u8>,
    /// Offsets of the collections.
    pub places: Vec<u64>,
}

impl HeapFinder {
    /// Begins at an offset of the file.
    pub(crate) fn new(offset: u64) -> Self {
        Self {
            finder: Finder::new(HEAD),
            offset,
            before: Vec::new(),
            places: Vec::new(),
        }
    }

    /// Looks through the next block.
    pub(crate) fn pass(&mut self, block: &[u8]) {
        let overlap = HEAD.len() - 1;
        // One that begins in the blocks before.
        let mut seam = std::mem::take(&mut self.before);
        let begins = self.offset - seam.len() as u64;
        seam.extend_from_slice(&block[..block.len().min(overlap)]);
        let across = self.finder.find_iter(&seam);
        self.places.extend(across.map(|at| begins + at as u64));
        let within = self.finder.find_iter(block);
        self.places.extend(within.map(|at| self.offset + at as u64));
        let joined = if block.len() >= overlap { block } else { &seam };
        self.before = joined[joined.len().saturating_sub(overlap)..].to_vec();
        self.offset += block.len() as u64;
    }
}

/// Walks through the collections at these places of a file; the first one that does not come to its end, if any.
///
/// # Errors
/// Of reading the file.
pub(crate) fn first_broken(
    file: &mut File,
    places: &[u64],
    file_bytes: u64,
) -> std::io::Result<Option<u64>> {
    let mut collection = Vec::new();
    for &place in places {
        let mut head = [0; HEAD_BYTES];
        file.seek(SeekFrom::Start(place))?;
        if place + HEAD_BYTES as u64 > file_bytes {
            return Ok(Some(place));
        }
        file.read_exact(&mut head)?;
        let length = number(&head[8..]);
        if length < HEAD_BYTES as u64 || length > file_bytes - place {
            return Ok(Some(place));
        }
        collection.resize(length as usize - HEAD_BYTES, 0);
        file.read_exact(&mut collection)?;
        if !comes_to_its_end(&collection) {
            return Ok(Some(place));
        }
    }
    Ok(None)
}

/// Whether the lengths of the objects add up to that of the collection.
fn comes_to_its_end(mut objects: &[u8]) -> bool {
    while objects.len() >= HEAD_BYTES {
        let is_free = objects[..2] == [0, 0];
        let length = number(&objects[8..]);
        let occupied = if is_free {
            Some(length)
        } else {
            let filled = length.checked_next_multiple_of(8);
            filled.and_then(|bytes| bytes.checked_add(HEAD_BYTES as u64))
        };
        match occupied {
            Some(bytes) if bytes >= HEAD_BYTES as u64 && bytes <= objects.len() as u64 => {
                objects = &objects[bytes as usize..];
            }
            _ => return false,
        }
    }
    true
}

fn number(bytes: &[u8]) -> u64 {
    let mut first = [0; 8];
    first.copy_from_slice(&bytes[..8]);
    u64::from_le_bytes(first)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn collections_are_found_wherever_blocks_are_cut() {
        let mut bytes = [b'G'; 100];
        for place in [0, 30, 41, 92] {
            bytes[place..place + 8].copy_from_slice(HEAD);
        }
        for length in 1..=100 {
            let mut finder = HeapFinder::new(512);
            bytes.chunks(length).for_each(|block| finder.pass(block));
            finder.places.sort_unstable();
            assert_eq!(finder.places, [512, 542, 553, 604], "blocks of {length}");
        }
    }

    fn object(index: u16, length: u64, content: usize) -> Vec<u8> {
        let mut bytes = Vec::new();
        bytes.extend(index.to_le_bytes());
        bytes.extend([1, 0, 0, 0, 0, 0]);
        bytes.extend(length.to_le_bytes());
        bytes.resize(HEAD_BYTES + content, 7);
        bytes
    }

    #[test]
    fn a_walk_that_stands_still_or_leaves_is_seen() {
        let sound = [object(1, 5, 8), object(2, 16, 16), object(0, 40, 24)].concat();
        assert!(comes_to_its_end(&sound));
        assert!(
            comes_to_its_end(&[sound.clone(), vec![0; 15]].concat()),
            "less than a head"
        );
        for last in [
            object(0, 0, 24),
            object(0, 48, 24),
            object(3, u64::MAX, 24),
            object(3, u64::MAX - 14, 24),
            object(3, 25, 24),
        ] {
            let broken = [object(1, 5, 8), last].concat();
            assert!(!comes_to_its_end(&broken), "{broken:?}");
        }
    }
}
