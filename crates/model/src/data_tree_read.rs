//! Reading a [`DataTree`] from an HDF5 file.

use std::path::Path;

use hdf5::types::{TypeDescriptor, VarLenUnicode};
use hdf5::{File, Group, H5Type, Location, LocationType};

use crate::data_tree::{DataArray, DataTree, FileFormat, Values};
use crate::data_tree_file::{OWN_ATTRIBUTES, hdf5_error, missing, wrong_type};
use crate::file_error::FileError;
use crate::own_storage::check_own_storage;
use crate::seal::verify_seal;

impl DataTree {
    /// Reads a sealed HDF5 file of the given format.
    ///
    /// # Errors
    /// Every kind of [`FileError`] except those about the contents of reduced gears and meshes.
    pub fn read(path: &Path, format: &FileFormat) -> Result<Self, FileError> {
        Self::read_with_version(path, format).map(|(tree, _)| tree)
    }

    /// The same with the version of the format that the file has.
    ///
    /// # Errors
    /// As [`DataTree::read`].
    pub fn read_with_version(path: &Path, format: &FileFormat) -> Result<(Self, u32), FileError> {
        let (file, version) = open_tree(path, format)?;
        Ok((Reader { path }.tree(&file, None)?, version))
    }
}

/// What a gearmesh file is: the [`FileFormat::name`] it was written with.
///
/// # Errors
/// As [`DataTree::read`], except that any format and version will do.
pub fn format_of(path: &Path) -> Result<String, FileError> {
    let (file, _) = open_sealed_tree(path)?;
    Reader { path }.text_attribute(&file, "format")
}

/// Checks the seal; returns the open file and its length.
fn open_sealed_tree(path: &Path) -> Result<(File, u64), FileError> {
    let file_bytes = verify_seal(path)?;
    let file = File::with_options()
        .with_fapl(|access| access.file_locking(false))
        .open(path)
        .map_err(hdf5_error(path, "open"))?;
    Ok((file, file_bytes))
}

/// Checks seal, format, version and where the arrays are; returns the open file and its version.
pub(crate) fn open_tree(path: &Path, format: &FileFormat) -> Result<(File, u32), FileError> {
    let (file, file_bytes) = open_sealed_tree(path)?;
    let reader = Reader { path };
    let found = reader.text_attribute(&file, "format")?;
    if found != format.name {
        return Err(FileError::WrongFormat {
            path: path.to_owned(),
            found,
            expected: format.name,
        });
    }
    let version = reader.number_attribute::<u32>(&file, "formatVersion")?;
    if version == 0 || version > format.version {
        return Err(FileError::UnknownVersion {
            path: path.to_owned(),
            format: format.name,
            found: version,
            newest: format.version,
        });
    }
    check_own_storage(path, &file, file_bytes)?;
    Ok((file, version))
}

/// Most axes of an array, HDF5's own limit: memory for their labels is asked for before they are read.
const MOST_AXES: usize = 32;

pub(crate) struct Reader<'a> {
    pub path: &'a Path,
}

impl Reader<'_> {
    /// Everything in the file, but for one group of the root. No array of the writer holds what is not a number.
    pub(crate) fn tree(&self, file: &File, skip: Option<&str>) -> Result<DataTree, FileError> {
        let mut tree = DataTree::default();
        for name in file
            .attr_names()
            .map_err(hdf5_error(self.path, "list the attributes of"))?
        {
            if !OWN_ATTRIBUTES.contains(&name.as_str()) {
                let text = self.text_attribute(file, &name)?;
                tree.attributes.insert(name, text);
            }
        }
        self.group(file, "", skip, &mut tree)?;
        match tree.first_not_a_number() {
            None => Ok(tree),
            Some((name, index)) => Err(FileError::Contradiction {
                path: self.path.to_owned(),
                item: name.to_owned(),
                problem: format!("entry {index} is not a number"),
            }),
        }
    }

    fn group(
        &self,
        group: &Group,
        prefix: &str,
        skip: Option<&str>,
        tree: &mut DataTree,
    ) -> Result<(), FileError> {
        // By their names: that of an object that is open already libhdf5 looks for in the whole file.
        let failed = hdf5_error(self.path, "list the contents of");
        for local in group.member_names().map_err(&failed)? {
            let name = format!("{prefix}{local}");
            match group.loc_info_by_name(&local).map_err(&failed)?.loc_type {
                LocationType::Dataset => {
                    let dataset = group.dataset(&local).map_err(&failed)?;
                    self.dataset(&dataset, name, tree)?;
                }
                LocationType::Group if skip != Some(local.as_str()) => {
                    let child = group.group(&local).map_err(&failed)?;
                    self.group(&child, &format!("{name}/"), None, tree)?;
                }
                _ => {}
            }
        }
        Ok(())
    }

    pub(crate) fn dataset(
        &self,
        dataset: &hdf5::Dataset,
        name: String,
        tree: &mut DataTree,
    ) -> Result<(), FileError> {
        let failed = |error| hdf5_error(self.path, &format!("read \"{name}\" of"))(error);
        let stored_type = dataset
            .dtype()
            .and_then(|stored| stored.to_descriptor())
            .map_err(failed)?;
        let shape = dataset.shape();
        let values = if stored_type == f64::type_descriptor() {
            Values::F64(dataset.read_raw().map_err(failed)?)
        } else if stored_type == u32::type_descriptor() {
            Values::U32(dataset.read_raw().map_err(failed)?)
        } else if stored_type == TypeDescriptor::VarLenUnicode && shape.is_empty() {
            let text = dataset.read_scalar::<VarLenUnicode>().map_err(failed)?;
            let text = self.utf8(&text, || format!("text \"{name}\""))?;
            tree.texts.insert(name, text);
            return Ok(());
        } else {
            let expected = "64-bit floating point, 32-bit counts or one text";
            return Err(wrong_type(
                self.path,
                &name,
                &format!("{stored_type}"),
                expected,
            ));
        };
        let array = DataArray {
            shape,
            values,
            axis_labels: self.axis_labels(dataset)?,
            unit: self.text_attribute(dataset, "unit")?,
            unit_si: self.number_attribute(dataset, "unitSI")?,
            description: self.text_attribute(dataset, "description")?,
            frame: self.text_attribute(dataset, "frame")?,
        };
        tree.arrays.insert(name, array);
        Ok(())
    }

    /// Demands that a dataset holds 64-bit floating point numbers.
    pub(crate) fn demand_numbers(
        &self,
        dataset: &hdf5::Dataset,
        name: &str,
    ) -> Result<(), FileError> {
        let failed = |error| hdf5_error(self.path, &format!("read \"{name}\" of"))(error);
        let stored = dataset.dtype().and_then(|stored| stored.to_descriptor());
        let stored = stored.map_err(failed)?;
        if stored == f64::type_descriptor() {
            return Ok(());
        }
        let found = format!("{stored}");
        Err(wrong_type(self.path, name, &found, "64-bit floating point"))
    }

    fn axis_labels(&self, dataset: &hdf5::Dataset) -> Result<Vec<String>, FileError> {
        if dataset.is_scalar() {
            return Ok(Vec::new());
        }
        let labels = dataset.attr("axisLabels");
        let labels = labels
            .ok()
            .filter(|labels| labels.size() <= MOST_AXES)
            .and_then(|labels| labels.read_raw::<VarLenUnicode>().ok());
        let labels = labels.ok_or_else(|| self.bad_attribute(dataset, "axisLabels"))?;
        labels
            .iter()
            .map(|label| self.utf8(label, || format!("axisLabels of \"{}\"", dataset.name())))
            .collect()
    }

    pub(crate) fn text_attribute(
        &self,
        object: &Location,
        name: &str,
    ) -> Result<String, FileError> {
        let text = self.number_attribute::<VarLenUnicode>(object, name)?;
        self.utf8(&text, || format!("{name} of \"{}\"", object.name()))
    }

    fn number_attribute<T: H5Type>(&self, object: &Location, name: &str) -> Result<T, FileError> {
        let value = object
            .attr(name)
            .and_then(|attribute| attribute.read_scalar::<T>());
        value.map_err(|_| self.bad_attribute(object, name))
    }

    /// A text of the file. libhdf5 does not check what a file calls UTF-8, and `VarLenUnicode::as_str` relies on it.
    fn utf8(
        &self,
        text: &VarLenUnicode,
        item: impl FnOnce() -> String,
    ) -> Result<String, FileError> {
        match std::str::from_utf8(text.as_bytes()) {
            Ok(text) => Ok(text.to_owned()),
            Err(error) => Err(FileError::NotUtf8 {
                path: self.path.to_owned(),
                item: item(),
                byte: error.valid_up_to(),
            }),
        }
    }

    fn bad_attribute(&self, object: &Location, name: &str) -> FileError {
        missing(
            self.path,
            "readable attribute",
            &format!("{name}\" of \"{}", object.name()),
        )
    }
}

/// Files with a good seal that the writer would never make.
#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::seal::{SEAL_BYTES, write_seal};

    const FORMAT: FileFormat = FileFormat {
        name: "test",
        version: 1,
    };

    /// A text of the file, and what stands there when it is sealed.
    const NOT_UTF8: (&str, &[u8; 8]) = ("damaged.", b"damage\xff.");

    fn read_back(make: impl FnOnce(&File)) -> FileError {
        read_back_changed(make, |bytes| {
            for place in 0..bytes.len() {
                if bytes[place..].starts_with(NOT_UTF8.0.as_bytes()) {
                    bytes[place..place + NOT_UTF8.1.len()].copy_from_slice(NOT_UTF8.1);
                }
            }
        })
    }

    fn read_back_changed(make: impl FnOnce(&File), change: impl FnOnce(&mut [u8])) -> FileError {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("tree.h5");
        let file = File::with_options()
            .with_fcpl(|create| create.userblock(SEAL_BYTES))
            .create(&path)
            .unwrap();
        DataTree::default()
            .fill_open(&path, &file, &FORMAT)
            .unwrap();
        make(&file);
        file.close().unwrap();
        let mut bytes = std::fs::read(&path).unwrap();
        change(&mut bytes);
        std::fs::write(&path, bytes).unwrap();
        let mut handle = std::fs::OpenOptions::new()
            .read(true)
            .write(true)
            .open(&path)
            .unwrap();
        write_seal(&mut handle, &path).unwrap();
        DataTree::read(&path, &FORMAT).unwrap_err()
    }

    #[test]
    fn a_claimed_size_is_not_allocated() {
        // Eight terabytes, of which nothing was ever written.
        let error = read_back(|file| {
            drop(
                file.new_dataset::<f64>()
                    .shape(1_usize << 40)
                    .create("huge")
                    .unwrap(),
            )
        });
        assert!(
            matches!(&error, FileError::TooLarge { shape, .. } if *shape == [1 << 40]),
            "{error}"
        );
    }

    #[test]
    fn other_types_and_bare_arrays_are_named() {
        let error =
            read_back(|file| drop(file.new_dataset::<i64>().shape(3).create("signed").unwrap()));
        assert!(
            matches!(&error, FileError::WrongType { item, .. } if item.contains("signed")),
            "{error}"
        );
        let error =
            read_back(|file| drop(file.new_dataset::<f64>().shape(3).create("bare").unwrap()));
        assert!(
            matches!(&error, FileError::Missing { item, .. } if item.contains("axisLabels")),
            "{error}"
        );
    }

    /// An array as the writer makes it, under other properties.
    fn array_in(file: &File, name: &str, length: usize) {
        let dataset = file.new_dataset::<f64>().shape(length).create(name);
        dataset.unwrap().write(&vec![1.0; length]).unwrap();
    }

    #[test]
    fn arrays_and_links_that_lie_elsewhere_are_refused() {
        let refused = |error: FileError, name: &str, how: &str| {
            assert!(
                matches!(&error, FileError::StoredElsewhere { name: found, how: said, .. }
                    if found == name && said.contains(how)),
                "{error}"
            );
        };
        let error = read_back(|file| {
            let builder = file.new_dataset_builder();
            let builder = builder.with_dcpl(|create| create.external("/etc/hostname", 0, 8));
            drop(builder.empty::<f64>().shape(1).create("outside").unwrap());
        });
        refused(error, "outside", "another file");
        let error = read_back(|file| {
            let builder = file.new_dataset_builder();
            let builder = builder
                .with_dcpl(|create| create.virtual_map("other.h5", "c_hub", 8, 0..8, 8, 0..8));
            drop(builder.empty::<f64>().shape(8).create("seen").unwrap());
        });
        refused(error, "seen", "view");
        let error = read_back(|file| {
            file.link_external("/tmp/other.h5", "/c_hub", "a").unwrap();
        });
        refused(error, "a", "link");
        let error = read_back(|file| {
            array_in(file, "real", 1);
            file.create_group("columns").unwrap();
            file.link_soft("/real", "columns/again").unwrap();
        });
        refused(error, "columns/again", "link");
    }

    #[test]
    fn many_names_of_one_array_count_as_often() {
        let error = read_back(|file| {
            array_in(file, "first", 4096);
            for number in 0..64 {
                file.link_hard("first", &format!("again{number:02}"))
                    .unwrap();
            }
        });
        assert!(
            matches!(&error, FileError::TooLarge { before_bytes, .. } if *before_bytes >= 4096 * 8),
            "{error}"
        );
    }

    #[test]
    fn text_that_is_no_utf8_is_named() {
        let error = read_back(|file| {
            let text: VarLenUnicode = NOT_UTF8.0.parse().unwrap();
            let dataset = file.new_dataset::<VarLenUnicode>().create("title").unwrap();
            dataset.write_scalar(&text).unwrap();
        });
        assert!(
            matches!(&error, FileError::NotUtf8 { item, byte: 6, .. } if item.contains("title")),
            "{error}"
        );
    }

    /// Free space at the end of the texts that states a length of zero.
    #[test]
    fn texts_that_libhdf5_would_read_for_ever_are_refused() {
        let error = read_back_changed(
            |_| (),
            |bytes| {
                let heap = bytes.windows(5).rposition(|b| b == b"GCOL\x01").unwrap();
                let mut place = heap + 16;
                while bytes[place..place + 2] != [0, 0] {
                    let length =
                        u64::from_le_bytes(bytes[place + 8..place + 16].try_into().unwrap());
                    place += 16 + length.next_multiple_of(8) as usize;
                }
                bytes[place + 8..place + 16].fill(0);
            },
        );
        assert!(matches!(error, FileError::BrokenTexts { .. }), "{error}");
    }

    /// Three gigabytes were taken for a text of a few letters before its place was found to be none.
    #[test]
    fn a_text_that_states_a_huge_length_is_not_allocated() {
        let place = std::cell::Cell::new(0);
        let error = read_back_changed(
            |file| {
                let text: VarLenUnicode = "a title".parse().unwrap();
                let dataset = file.new_dataset::<VarLenUnicode>().create("title").unwrap();
                dataset.write_scalar(&text).unwrap();
                file.flush().unwrap();
                place.set(dataset.offset().unwrap() as usize);
            },
            |bytes| {
                let length = &mut bytes[place.get()..][..4];
                assert_eq!(length, 7_u32.to_le_bytes());
                length.copy_from_slice(&3_171_876_893_u32.to_le_bytes());
            },
        );
        assert!(
            matches!(&error, FileError::TooLarge { item, shape, .. } if item == "\"title\"" && *shape == [3_171_876_893]),
            "{error}"
        );
    }

    #[test]
    fn groups_in_a_circle_end() {
        let error = read_back(|file| {
            file.create_group("a").unwrap();
            file.link_hard("a", "a/a").unwrap();
        });
        assert!(
            matches!(
                error,
                FileError::InvalidName {
                    item: "a group",
                    ..
                }
            ),
            "{error}"
        );
    }
}
