//! Writing a [`DataTree`] as an HDF5 file.

use std::path::Path;

use hdf5::types::VarLenUnicode;
use hdf5::{Dataset, File, H5Type, Location};

use crate::atomic_file::write_atomically;
use crate::data_tree::{DataArray, DataTree, FileFormat, Values};
use crate::data_tree_file::{DEEPEST_GROUP, OWN_ATTRIBUTES, hdf5_error};
use crate::file_error::FileError;
use crate::seal::{SEAL_BYTES, write_seal};
use crate::timestamp::utc_now;

impl DataTree {
    /// Writes the tree as a sealed HDF5 file, atomically.
    ///
    /// # Errors
    /// [`FileError::InvalidName`], [`FileError::NotANumber`], [`FileError::NulInText`], [`FileError::NotARegularFile`],
    /// and where the disk or libhdf5 refuses [`FileError::Io`] or [`FileError::Hdf5`]; an older file of that name is
    /// then untouched.
    pub fn write(&self, path: &Path, format: &FileFormat) -> Result<(), FileError> {
        self.check_names(path)?;
        self.check_numbers(path)?;
        write_atomically(path, |temporary, handle| {
            self.fill(path, temporary, format, |_| Ok(()))?;
            write_seal(handle, path)
        })
    }

    /// A file that is complete holds numbers only: what could not be computed is reported before it is written.
    pub(crate) fn check_numbers(&self, path: &Path) -> Result<(), FileError> {
        match self.first_not_a_number() {
            None => Ok(()),
            Some((name, index)) => Err(FileError::NotANumber {
                path: path.to_owned(),
                item: name.to_owned(),
                index,
            }),
        }
    }

    pub(crate) fn check_names(&self, path: &Path) -> Result<(), FileError> {
        let invalid = |item, name: &str, allowed| FileError::InvalidName {
            path: path.to_owned(),
            item,
            name: name.to_owned(),
            allowed,
        };
        for name in self.arrays.keys().chain(self.texts.keys()) {
            if name
                .split('/')
                .any(|part| part.is_empty() || part == "." || part == ".." || part.contains('\0'))
            {
                return Err(invalid(
                    "an array or text",
                    name,
                    "parts between slashes must not be empty, \".\" or \"..\"",
                ));
            }
            if name.split('/').count() > DEEPEST_GROUP {
                return Err(invalid(
                    "an array or text",
                    name,
                    "at most eight levels of groups are allowed",
                ));
            }
            // A name that is an array and also a text, or a group, cannot be stored.
            let as_group = format!("{name}/");
            let mut others = self.arrays.keys().chain(self.texts.keys());
            if others.any(|other| other.starts_with(&as_group))
                || (self.arrays.contains_key(name) && self.texts.contains_key(name))
            {
                return Err(invalid(
                    "an array or text",
                    name,
                    "it is taken by another array, text or group",
                ));
            }
        }
        for name in self.attributes.keys() {
            if OWN_ATTRIBUTES.contains(&name.as_str()) || name.is_empty() || name.contains('\0') {
                return Err(invalid(
                    "an attribute",
                    name,
                    "it must not be empty or one that every file has",
                ));
            }
        }
        Ok(())
    }

    /// Fills a new HDF5 file; `more` adds what is not in the tree.
    pub(crate) fn fill(
        &self,
        path: &Path,
        temporary: &Path,
        format: &FileFormat,
        more: impl FnOnce(&File) -> Result<(), FileError>,
    ) -> Result<(), FileError> {
        let failed = |action| hdf5_error(path, action);
        let file = File::with_options()
            .with_fcpl(|create| create.userblock(SEAL_BYTES))
            .with_fapl(|access| access.file_locking(false))
            .create(temporary)
            .map_err(failed("create"))?;
        // The handle is closed on every way out; a refusal in between has precedence over one of closing.
        let written = self
            .fill_open(path, &file, format)
            .and_then(|()| more(&file));
        let flushed = file.flush().map_err(failed("write"));
        let closed = file.close().map_err(failed("close"));
        written.and(flushed).and(closed)
    }

    pub(crate) fn fill_open(
        &self,
        path: &Path,
        file: &File,
        format: &FileFormat,
    ) -> Result<(), FileError> {
        let writer = Writer { path };
        writer.text_attribute(file, "format", format.name)?;
        writer.number_attribute(file, "formatVersion", &format.version)?;
        writer.text_attribute(file, "software", "gearmesh")?;
        writer.text_attribute(file, "softwareVersion", env!("CARGO_PKG_VERSION"))?;
        writer.text_attribute(file, "date", &utc_now())?;
        for (name, text) in &self.attributes {
            writer.text_attribute(file, name, text)?;
        }
        for (name, text) in &self.texts {
            writer.text(file, name, text)?;
        }
        for (name, array) in &self.arrays {
            match &array.values {
                Values::F64(values) => writer.array(file, name, array, values)?,
                Values::U32(values) => writer.array(file, name, array, values)?,
            };
        }
        Ok(())
    }
}

pub(crate) struct Writer<'a> {
    pub path: &'a Path,
}

impl Writer<'_> {
    /// Creates an array with its attributes. Without values it is filled later.
    pub(crate) fn array<T: H5Type>(
        &self,
        file: &File,
        name: &str,
        array: &DataArray,
        values: &[T],
    ) -> Result<Dataset, FileError> {
        let failed = |error| hdf5_error(self.path, &format!("write array \"{name}\" to"))(error);
        let builder = file.new_dataset::<T>().create_intermediate_group(true);
        let dataset = if array.shape.is_empty() {
            builder.create(name)
        } else {
            builder.shape(array.shape.clone()).create(name)
        };
        let dataset = dataset.map_err(failed)?;
        if !values.is_empty() {
            if array.shape.is_empty() {
                dataset.write_scalar(&values[0]).map_err(failed)?;
            } else {
                dataset.write_raw(values).map_err(failed)?;
            }
        }
        self.text_attribute(&dataset, "unit", &array.unit)?;
        self.number_attribute(&dataset, "unitSI", &array.unit_si)?;
        self.text_attribute(&dataset, "description", &array.description)?;
        self.text_attribute(&dataset, "frame", &array.frame)?;
        if !array.axis_labels.is_empty() {
            let labels = array
                .axis_labels
                .iter()
                .map(|label| self.unicode(name, label));
            let labels = labels.collect::<Result<Vec<_>, _>>()?;
            let attribute = dataset
                .new_attr::<VarLenUnicode>()
                .shape(labels.len())
                .create("axisLabels");
            attribute
                .and_then(|attribute| attribute.write_raw(&labels))
                .map_err(failed)?;
        }
        Ok(dataset)
    }

    fn text(&self, file: &File, name: &str, text: &str) -> Result<(), FileError> {
        let value = self.unicode(name, text)?;
        let dataset = file
            .new_dataset::<VarLenUnicode>()
            .create_intermediate_group(true)
            .create(name);
        dataset
            .and_then(|dataset| dataset.write_scalar(&value))
            .map_err(|error| hdf5_error(self.path, &format!("write text \"{name}\" to"))(error))
    }

    fn text_attribute(&self, object: &Location, name: &str, text: &str) -> Result<(), FileError> {
        let value = self.unicode(name, text)?;
        self.number_attribute(object, name, &value)
    }

    fn number_attribute<T: H5Type>(
        &self,
        object: &Location,
        name: &str,
        value: &T,
    ) -> Result<(), FileError> {
        let attribute = object.new_attr::<T>().create(name);
        attribute
            .and_then(|attribute| attribute.write_scalar(value))
            .map_err(|error| {
                hdf5_error(self.path, &format!("write attribute \"{name}\" to"))(error)
            })
    }

    fn unicode(&self, name: &str, text: &str) -> Result<VarLenUnicode, FileError> {
        text.parse().map_err(|_| FileError::NulInText {
            path: self.path.to_owned(),
            item: name.to_owned(),
        })
    }
}
