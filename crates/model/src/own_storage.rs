//! Everything that a file claims to hold is in the file itself, and no more than its length.
//!
//! HDF5 can keep an array in another file (external and virtual datasets, external links) and can name one array many
//! times (soft and hard links). The seal covers the bytes of one file only, so what lies elsewhere would be read
//! unchecked, from any place of the machine; and many names of one array would take many times the file's length in
//! memory. gearmesh's writer uses none of this. All of it is looked for before the first array is read.

use std::io::{Read, Seek, SeekFrom};
use std::path::Path;

use hdf5::plist::dataset_create::Layout;
use hdf5::types::TypeDescriptor;
use hdf5::{Dataset, File, Group, LinkType, LocationType};

use crate::data_tree_file::{DEEPEST_GROUP, hdf5_error};
use crate::file_error::{FileError, io_error};

/// Walks through all groups and datasets of an open file of the given length.
///
/// # Errors
/// [`FileError::StoredElsewhere`] for links and for datasets kept in other files, [`FileError::TooLarge`] if one array
/// or all arrays together claim more bytes than the file has, [`FileError::InvalidName`] for groups nested too deeply
/// or in a circle, [`FileError::Hdf5`].
pub(crate) fn check_own_storage(
    path: &Path,
    file: &File,
    file_bytes: u64,
) -> Result<(), FileError> {
    let mut walk = Walk {
        path,
        raw: std::fs::File::open(path).map_err(io_error(path, "open"))?,
        file_bytes,
        claimed_bytes: 0,
    };
    walk.group(file, "")
}

struct Walk<'a> {
    path: &'a Path,
    /// The same file, byte by byte.
    raw: std::fs::File,
    file_bytes: u64,
    /// Sum over the arrays and links seen so far.
    claimed_bytes: u64,
}

/// A link is at least the eight bytes of an address; counted so that groups which contain each other end the walk.
const LINK_BYTES: u64 = 8;

impl Walk<'_> {
    fn group(&mut self, group: &Group, prefix: &str) -> Result<(), FileError> {
        if prefix.matches('/').count() > DEEPEST_GROUP {
            return Err(FileError::InvalidName {
                path: self.path.to_owned(),
                item: "a group",
                name: prefix.to_owned(),
                allowed: "at most eight levels of groups are allowed",
            });
        }
        let failed = hdf5_error(self.path, "list the contents of");
        let mut links = Vec::new();
        group
            .iter_visit_default(|name, info| {
                links.push((name.to_owned(), info.link_type));
                Ok(())
            })
            .map_err(&failed)?;
        for (link, link_type) in links {
            let name = format!("{prefix}{link}");
            self.claim(&name, Vec::new(), LINK_BYTES)?;
            // Before anything follows the link.
            if link_type != LinkType::Hard {
                return Err(self.elsewhere(&name, "is a link to another place"));
            }
            match group.loc_info_by_name(&link).map_err(&failed)?.loc_type {
                LocationType::Group => {
                    let child = group.group(&link).map_err(&failed)?;
                    self.group(&child, &format!("{name}/"))?;
                }
                LocationType::Dataset => {
                    let dataset = group.dataset(&link).map_err(&failed)?;
                    self.dataset(&dataset, &name)?;
                }
                // Stored types are never read.
                _ => {}
            }
        }
        Ok(())
    }

    fn dataset(&mut self, dataset: &Dataset, name: &str) -> Result<(), FileError> {
        let failed = |error| hdf5_error(self.path, &format!("inspect \"{name}\" of"))(error);
        if dataset.layout() == Layout::Virtual {
            return Err(self.elsewhere(name, "is a view of other datasets"));
        }
        let properties = dataset.dcpl().map_err(failed)?;
        if properties
            .get_external()
            .is_ok_and(|files| files.is_empty())
        {
            let stored_type = dataset.dtype().map_err(failed)?;
            self.claim(name, dataset.shape(), stored_type.size() as u64)?;
            match stored_type.to_descriptor() {
                Ok(TypeDescriptor::VarLenUnicode) => self.text(dataset, name),
                _ => Ok(()),
            }
        } else {
            Err(self.elsewhere(name, "is kept in another file"))
        }
    }

    /// Counts the length that a text states: libhdf5 takes so much memory before it looks for the text. In the file a
    /// text is its length (4 bytes) and where it lies ("HDF5 File Format Specification Version 3.0", VIII.B); texts
    /// kept otherwise than in one piece are none of gearmesh's.
    fn text(&mut self, dataset: &Dataset, name: &str) -> Result<(), FileError> {
        let Some(place) = dataset.offset().filter(|_| dataset.is_scalar()) else {
            return Err(self.elsewhere(name, "is a text that is not kept in one piece"));
        };
        let mut length = [0; 4];
        let read = self.raw.seek(SeekFrom::Start(place));
        let read = read.and_then(|_| self.raw.read_exact(&mut length));
        read.map_err(io_error(self.path, "read"))?;
        let length = u32::from_le_bytes(length);
        self.claim(name, vec![length as usize], 1)
    }

    /// Counts an array's bytes.
    fn claim(&mut self, name: &str, shape: Vec<usize>, number_bytes: u64) -> Result<(), FileError> {
        let bytes = shape
            .iter()
            .try_fold(number_bytes, |bytes, &length| {
                bytes.checked_mul(length as u64)
            })
            .and_then(|bytes| bytes.checked_add(self.claimed_bytes))
            .filter(|&bytes| bytes <= self.file_bytes);
        match bytes {
            Some(bytes) => {
                self.claimed_bytes = bytes;
                Ok(())
            }
            None => Err(FileError::TooLarge {
                path: self.path.to_owned(),
                item: format!("\"{name}\""),
                shape,
                before_bytes: self.claimed_bytes,
                file_bytes: self.file_bytes,
            }),
        }
    }

    fn elsewhere(&self, name: &str, how: &'static str) -> FileError {
        FileError::StoredElsewhere {
            path: self.path.to_owned(),
            name: name.to_owned(),
            how,
        }
    }
}
