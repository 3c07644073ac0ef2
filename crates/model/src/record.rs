//! What is in a file is declared once: [`Record::fields`] lists the parts of a record, and writing, reading and
//! documenting all go through that list.
//!
//! The parts are visited in the order of the list. A length that an array leaves [`OPEN`] is taken from the file; the
//! arrays after it state it as known, so that all lengths are checked against the first that has them.

mod axes;
mod groups;

use std::path::Path;

use crate::data_tree::{DataTree, Values};
use crate::data_tree_file::wrong_type;
use crate::file_error::FileError;
use axes::{array, form, shape};

/// Length of an axis that the array itself decides.
pub const OPEN: usize = usize::MAX;

/// Parts of a file under common names. Before it is read a record is empty: its [`Default`].
pub trait Record {
    /// Visits every part: name, value, unit, meaning.
    ///
    /// # Errors
    /// When reading, [`FileError`] for a part that is missing or of another type or shape.
    fn fields(&mut self, fields: &mut Fields<'_>) -> Result<(), FileError>;
}

/// An enum that is stored by name. The names are those of the files: they stay when keys or variants are renamed.
pub trait Named: Copy + PartialEq + 'static {
    /// Every value with its name.
    const NAMES: &'static [(Self, &'static str)];

    /// The name of this value.
    fn name_in_files(self) -> &'static str {
        let found = Self::NAMES.iter().find(|(value, _)| *value == self);
        found.map_or("", |(_, name)| name)
    }
}

/// A part of a file, as the documentation lists it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ListedField {
    /// Name, groups and numbers of a list (`I`) included.
    pub name: String,
    /// `text`, `number`, `count`, or the axes of an array in brackets.
    pub form: String,
    /// Unit; empty for texts.
    pub unit: String,
    /// What it is.
    pub description: String,
}

/// The way a record is gone through, and where in the file.
pub struct Fields<'a> {
    way: Way<'a>,
    /// Path of the group with `/` behind it; empty at the root.
    group: String,
    /// Frame of the next array.
    frame: &'static str,
    version: u32,
}

enum Way<'a> {
    Write(&'a mut DataTree),
    Read(&'a mut DataTree, &'a Path),
    List(&'a mut Vec<ListedField>),
}

/// Puts a record into a tree. Large arrays are moved out of it.
pub fn write_record(record: &mut impl Record, tree: &mut DataTree) {
    // Only reading can fail.
    let _ = record.fields(&mut Fields::new(Way::Write(tree), u32::MAX));
}

/// Takes a record out of a tree that was read from a file of that version of its format.
///
/// # Errors
/// [`FileError`] for a part that is missing or of another type or shape.
pub fn read_record<R: Record + Default>(
    tree: &mut DataTree,
    path: &Path,
    version: u32,
) -> Result<R, FileError> {
    let mut record = R::default();
    record.fields(&mut Fields::new(Way::Read(tree, path), version))?;
    Ok(record)
}

/// The parts of a record, for the documentation.
pub fn list_record<R: Record + Default>() -> Vec<ListedField> {
    let mut list = Vec::new();
    // Only reading can fail.
    let _ = R::default().fields(&mut Fields::new(Way::List(&mut list), u32::MAX));
    list
}

impl<'a> Fields<'a> {
    fn new(way: Way<'a>, version: u32) -> Self {
        Self {
            way,
            group: String::new(),
            frame: "",
            version,
        }
    }

    /// Version of the format that is read; the newest there can be where a record is written or listed.
    pub fn version(&self) -> u32 {
        self.version
    }

    /// Whether a record is listed for the documentation.
    pub fn is_listing(&self) -> bool {
        matches!(self.way, Way::List(_))
    }

    /// Whether a record is read.
    pub fn is_reading(&self) -> bool {
        matches!(self.way, Way::Read(..))
    }

    /// The same, the next array in a frame.
    pub fn in_frame(&mut self, frame: &'static str) -> &mut Self {
        self.frame = frame;
        self
    }

    /// A text.
    ///
    /// # Errors
    /// [`FileError::Missing`].
    pub fn text(&mut self, name: &str, value: &mut String, what: &str) -> Result<(), FileError> {
        let name = self.at(name);
        match &mut self.way {
            Way::Write(tree) => tree.put_text(name, value.as_str()),
            Way::Read(tree, path) => *value = tree.take_text(path, &name)?,
            Way::List(list) => list.push(listed(name, "text", "", what)),
        }
        Ok(())
    }

    /// Texts without line breaks, one a line.
    ///
    /// # Errors
    /// As [`Fields::text`].
    pub fn lines(
        &mut self,
        name: &str,
        values: &mut Vec<String>,
        what: &str,
    ) -> Result<(), FileError> {
        let mut text = values.join("\n");
        self.text(name, &mut text, &format!("{what}, one a line"))?;
        if self.is_reading() {
            *values = text.lines().map(str::to_owned).collect();
        }
        Ok(())
    }

    /// A choice, stored by its name.
    ///
    /// # Errors
    /// [`FileError::Missing`]; [`FileError::UnknownName`] with the names that are known.
    pub fn choice<T: Named>(
        &mut self,
        name: &str,
        value: &mut T,
        what: &str,
    ) -> Result<(), FileError> {
        let known: Vec<&str> = T::NAMES.iter().map(|(_, name)| *name).collect();
        let mut text = value.name_in_files().to_owned();
        self.text(name, &mut text, &format!("{what}: {}", known.join(", ")))?;
        if let Way::Read(_, path) = &self.way {
            let found = T::NAMES.iter().find(|(_, name)| *name == text);
            let (found, _) = found.ok_or_else(|| FileError::UnknownName {
                path: path.to_path_buf(),
                item: format!("{}{name}", self.group),
                found: text,
                known: known.join(", "),
            })?;
            *value = *found;
        }
        Ok(())
    }

    /// A single number.
    ///
    /// # Errors
    /// [`FileError::Missing`], [`FileError::WrongType`], [`FileError::WrongShape`].
    pub fn number(
        &mut self,
        name: &str,
        value: &mut f64,
        unit: &str,
        what: &str,
    ) -> Result<(), FileError> {
        self.fixed(name, std::slice::from_mut(value), &[], unit, what)
    }

    /// A number that need not be given: an array of one number or none.
    ///
    /// # Errors
    /// As [`Fields::number`].
    pub fn optional_number(
        &mut self,
        name: &str,
        value: &mut Option<f64>,
        unit: &str,
        what: &str,
    ) -> Result<(), FileError> {
        let mut given: Vec<f64> = value.iter().copied().collect();
        let axes = [("given: 0 or 1", OPEN)];
        self.numbers(name, &mut given, &axes, unit, what)?;
        if given.len() > 1 {
            return Err(self.contradiction(name, "it may hold one number or none"));
        }
        *value = given.first().copied();
        Ok(())
    }

    /// A number that is missing in the file where there is none.
    ///
    /// # Errors
    /// As [`Fields::number`].
    pub fn number_if_there(
        &mut self,
        name: &str,
        value: &mut Option<f64>,
        unit: &str,
        what: &str,
    ) -> Result<(), FileError> {
        let there = match &self.way {
            Way::Write(_) => value.is_some(),
            Way::Read(..) | Way::List(_) => self.has(name),
        };
        if !there {
            *value = None;
            return Ok(());
        }
        self.number(name, value.get_or_insert_default(), unit, what)
    }

    /// A single count. Beyond 32 bits it saturates.
    ///
    /// # Errors
    /// As [`Fields::number`].
    pub fn count(&mut self, name: &str, value: &mut usize, what: &str) -> Result<(), FileError> {
        let mut values = vec![saturated(*value)];
        self.counts(name, &mut values, &[], what)?;
        *value = values.first().map_or(0, |count| *count as usize);
        Ok(())
    }

    /// Whether something holds: the count 1 or 0.
    ///
    /// # Errors
    /// As [`Fields::number`].
    pub fn flag(&mut self, name: &str, value: &mut bool, what: &str) -> Result<(), FileError> {
        let mut count = usize::from(*value);
        self.count(name, &mut count, &format!("1: {what}; 0: not"))?;
        *value = count != 0;
        Ok(())
    }

    /// As many numbers as there is room for.
    ///
    /// # Errors
    /// As [`Fields::number`].
    pub fn fixed(
        &mut self,
        name: &str,
        values: &mut [f64],
        axes: &[(&str, usize)],
        unit: &str,
        what: &str,
    ) -> Result<(), FileError> {
        let mut array = values.to_vec();
        self.numbers(name, &mut array, axes, unit, what)?;
        if self.is_reading() {
            values.copy_from_slice(&array);
        }
        Ok(())
    }

    /// An array of numbers; of its axes one may be [`OPEN`].
    ///
    /// # Errors
    /// As [`Fields::number`].
    pub fn numbers(
        &mut self,
        name: &str,
        values: &mut Vec<f64>,
        axes: &[(&str, usize)],
        unit: &str,
        what: &str,
    ) -> Result<(), FileError> {
        if matches!(self.way, Way::Write(_)) {
            return self.bulk(name, &mut values.clone(), axes, unit, what);
        }
        self.bulk(name, values, axes, unit, what)
    }

    /// A large array of numbers: as [`Fields::numbers`], but moved when it is written, so that it is not held twice.
    ///
    /// # Errors
    /// As [`Fields::number`].
    pub fn bulk(
        &mut self,
        name: &str,
        values: &mut Vec<f64>,
        axes: &[(&str, usize)],
        unit: &str,
        what: &str,
    ) -> Result<(), FileError> {
        let frame = std::mem::take(&mut self.frame);
        let name = self.at(name);
        match &mut self.way {
            Way::Write(tree) => {
                let array = array(Values::F64(std::mem::take(values)), axes, unit, what);
                tree.put(name, array.in_frame(frame));
            }
            Way::Read(tree, path) => {
                let shape = shape(tree, path, &name, axes)?;
                *values = tree.take_f64(path, &name, &shape)?;
            }
            Way::List(list) => list.push(listed(name, &form(axes, "number"), unit, what)),
        }
        Ok(())
    }

    /// An array of counts; of its axes one may be [`OPEN`].
    ///
    /// # Errors
    /// As [`Fields::number`].
    pub fn counts(
        &mut self,
        name: &str,
        values: &mut Vec<u32>,
        axes: &[(&str, usize)],
        what: &str,
    ) -> Result<(), FileError> {
        let name = self.at(name);
        match &mut self.way {
            Way::Write(tree) => tree.put(name, array(Values::U32(values.clone()), axes, "1", what)),
            Way::Read(tree, path) => {
                let shape = shape(tree, path, &name, axes)?;
                *values = tree.take_u32(path, &name, &shape)?;
            }
            Way::List(list) => list.push(listed(name, &form(axes, "count"), "1", what)),
        }
        Ok(())
    }

    /// Whether a part of this group is in the file that is read; always where a record is written or listed.
    pub fn has(&self, name: &str) -> bool {
        let name = self.at(name);
        match &self.way {
            Way::Read(tree, _) => tree.arrays.contains_key(&name) || tree.texts.contains_key(&name),
            _ => true,
        }
    }

    /// Whether a part of this group that may be missing is in the file that is read; of a record that is written
    /// whether it has it, `is_kept`.
    pub fn keeps(&self, name: &str, is_kept: bool) -> bool {
        match self.way {
            Way::Read(..) => self.has(name),
            Way::List(_) => true,
            _ => is_kept,
        }
    }

    /// The error of parts that do not go together.
    pub fn contradiction(&self, name: &str, problem: &str) -> FileError {
        FileError::Contradiction {
            path: self.path().to_owned(),
            item: self.at(name),
            problem: problem.to_owned(),
        }
    }

    /// The error of something that is not there.
    pub fn missing(&self, item: &str) -> FileError {
        FileError::Missing {
            path: self.path().to_owned(),
            item: item.to_owned(),
        }
    }

    /// The error of a value that means nothing.
    pub fn wrong_type(&self, name: &str, found: &str, expected: &'static str) -> FileError {
        wrong_type(self.path(), &self.at(name), found, expected)
    }

    /// The file that is read; nothing where none is.
    fn path(&self) -> &Path {
        match &self.way {
            Way::Read(_, path) => path,
            _ => Path::new(""),
        }
    }

    fn at(&self, name: &str) -> String {
        format!("{}{name}", self.group)
    }
}

fn saturated(count: usize) -> u32 {
    u32::try_from(count).unwrap_or(u32::MAX)
}

fn listed(name: String, form: &str, unit: &str, what: &str) -> ListedField {
    ListedField {
        name,
        form: form.to_owned(),
        unit: unit.to_owned(),
        description: what.to_owned(),
    }
}
