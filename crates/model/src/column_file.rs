//! A sealed file with long columns: written from a [`RowLog`] block by block, read column by column. Neither holds all
//! of it in memory.
//!
//! Besides the columns, which are the one-dimensional datasets under `columns/`, the file is an ordinary [`DataTree`].

use std::ops::Range;
use std::path::{Path, PathBuf};

use hdf5::{Dataset, File};

use crate::atomic_file::{TEMPORARY_SUFFIX, write_atomically_from};
use crate::data_tree::{DataArray, DataTree, FileFormat, Values};
use crate::data_tree_file::{hdf5_error, missing};
use crate::data_tree_read::{Reader, open_tree};
use crate::data_tree_write::Writer;
use crate::file_error::FileError;
use crate::row_log::RowLog;
use crate::seal::write_seal;

/// Group of the columns.
const GROUP: &str = "columns";

/// Text with the names of the columns, one a line, in the order of the row.
const ORDER: &str = "column_order";

/// Numbers held in memory while rows become columns: 16 MB.
const BLOCK_NUMBERS: usize = 1 << 21;

/// What a column is.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Column {
    /// Name with unit; `/` makes groups: `"bodies/wheel/x_m"`.
    pub name: String,
    /// Unit as an attribute: `"m"`.
    pub unit: String,
    /// What the numbers are, with their sign.
    pub description: String,
}

impl Column {
    /// What a column holds.
    pub fn new(name: impl Into<String>, unit: &str, description: &str) -> Self {
        Self {
            name: name.into(),
            unit: unit.to_owned(),
            description: description.to_owned(),
        }
    }
}

/// Writes a tree and all rows of a log as a sealed HDF5 file, atomically. `axis` says what the rows count.
///
/// The file is written in the folder of the log and then moved to `path`, which must be on the same file system: a
/// process killed meanwhile leaves its half file where the log is, and nothing beside `path`.
///
/// # Errors
/// As [`DataTree::write`], and those of reading the log; [`FileError::Altered`] if its rows are not those that were
/// appended.
///
/// # Panics
/// If there are not as many columns as the log has.
pub fn write_columns(
    path: &Path,
    format: &FileFormat,
    tree: &DataTree,
    (axis, columns): (&str, &[Column]),
    log: &mut RowLog,
) -> Result<(), FileError> {
    assert_eq!(columns.len(), log.columns(), "number of columns");
    log.verify()?;
    let rows = log.rows() as usize;
    let mut tree = tree.clone();
    let names: Vec<&str> = columns.iter().map(|c| c.name.as_str()).collect();
    tree.put_text(ORDER, names.join("\n"));
    let mut named = tree.clone();
    for name in &names {
        let place = DataArray::scalar(0.0, "1", "");
        named.put(format!("{GROUP}/{name}"), place);
    }
    named.check_names(path)?;
    tree.check_numbers(path)?;
    let staging = log.folder().to_owned();
    let staging = (staging.as_path(), TEMPORARY_SUFFIX);
    write_atomically_from(staging, path, |temporary, handle| {
        tree.fill(path, temporary, format, |file| {
            let mut datasets = Vec::with_capacity(columns.len());
            for column in columns {
                let head = DataArray {
                    shape: vec![rows],
                    values: Values::F64(Vec::new()),
                    axis_labels: vec![axis.to_owned()],
                    unit: column.unit.clone(),
                    unit_si: 1.0,
                    description: column.description.clone(),
                    frame: String::new(),
                };
                let name = format!("{GROUP}/{}", column.name);
                datasets.push(Writer { path }.array::<f64>(file, &name, &head, &[])?);
            }
            fill_columns(path, &datasets, log)
        })?;
        write_seal(handle, path)
    })
}

fn fill_columns(path: &Path, datasets: &[Dataset], log: &mut RowLog) -> Result<(), FileError> {
    let count = datasets.len();
    let block = (BLOCK_NUMBERS / count.max(1)).max(1);
    let (mut rows, mut column) = (Vec::new(), Vec::<f64>::with_capacity(block));
    let mut first = 0;
    while first < log.rows() {
        log.read(first, block, &mut rows)?;
        let read = rows.len() / count;
        let range = first as usize..first as usize + read;
        for (place, dataset) in datasets.iter().enumerate() {
            column.clear();
            column.extend(rows.iter().skip(place).step_by(count));
            dataset
                .write_slice::<_, f64, _, _>(&column, range.clone())
                .map_err(|error| hdf5_error(path, "write a column to")(error))?;
        }
        first += read as u64;
    }
    Ok(())
}

/// A file with columns, opened for reading.
#[derive(Debug)]
pub struct ColumnFile {
    path: PathBuf,
    file: File,
    version: u32,
    columns: Vec<Column>,
    beside: Vec<Column>,
    rows: usize,
}

impl ColumnFile {
    /// Checks the seal and reads everything but the columns, which are listed. A file without columns is read, too.
    ///
    /// # Errors
    /// As [`DataTree::read`].
    pub fn open(path: &Path, format: &FileFormat) -> Result<(Self, DataTree), FileError> {
        let (file, version) = open_tree(path, format)?;
        let reader = Reader { path };
        let mut tree = reader.tree(&file, Some(GROUP))?;
        let order = tree.texts.remove(ORDER).unwrap_or_default();
        let mut opened = Self {
            path: path.to_owned(),
            file,
            version,
            columns: Vec::new(),
            beside: Vec::new(),
            rows: 0,
        };
        for (place, name) in order.lines().enumerate() {
            let dataset = opened.dataset(name)?;
            let rows = dataset.size();
            if place == 0 {
                opened.rows = rows;
            }
            reader.demand_numbers(&dataset, name)?;
            if dataset.shape() != [opened.rows] {
                return Err(FileError::WrongShape {
                    path: path.to_owned(),
                    item: format!("column \"{name}\""),
                    found: dataset.shape(),
                    expected: vec![opened.rows],
                });
            }
            opened.columns.push(Column {
                name: name.to_owned(),
                unit: reader.text_attribute(&dataset, "unit")?,
                description: reader.text_attribute(&dataset, "description")?,
            });
        }
        Ok((opened, tree))
    }

    /// Version of the format that the file has.
    pub fn version(&self) -> u32 {
        self.version
    }

    /// The same file, the units of its columns by their names: of formats that did not state them.
    pub fn with_units_of(mut self, unit: impl Fn(&str) -> &'static str) -> Self {
        for column in &mut self.columns {
            unit(&column.name).clone_into(&mut column.unit);
        }
        self
    }

    /// The same file; the columns whose names begin so stand beside the others.
    pub fn with_beside(mut self, start: &str) -> Self {
        let all = std::mem::take(&mut self.columns);
        (self.beside, self.columns) = all.into_iter().partition(|c| c.name.starts_with(start));
        self
    }

    /// The columns that stand beside the others; all are read alike.
    pub fn beside(&self) -> &[Column] {
        &self.beside
    }

    /// The columns, in the order of the rows they came from.
    pub fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// Numbers in each column.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// A whole column.
    ///
    /// # Errors
    /// [`FileError::Missing`], [`FileError::WrongType`], [`FileError::TooLarge`], [`FileError::Hdf5`].
    pub fn read(&self, name: &str) -> Result<Vec<f64>, FileError> {
        let mut tree = DataTree::default();
        let reader = Reader { path: &self.path };
        reader.dataset(&self.dataset(name)?, name.to_owned(), &mut tree)?;
        tree.take_f64(&self.path, name, &[self.rows])
    }

    /// Some rows of a column.
    ///
    /// # Errors
    /// [`FileError::Missing`], [`FileError::WrongType`], [`FileError::Hdf5`].
    ///
    /// # Panics
    /// If there are not so many rows.
    pub fn read_rows(&self, name: &str, rows: Range<usize>) -> Result<Vec<f64>, FileError> {
        assert!(rows.end <= self.rows, "{rows:?} of {} rows", self.rows);
        let dataset = self.dataset(name)?;
        let reader = Reader { path: &self.path };
        reader.demand_numbers(&dataset, name)?;
        let read = dataset.read_slice_1d::<f64, _>(rows);
        let failed = |error| hdf5_error(&self.path, &format!("read \"{name}\" of"))(error);
        Ok(read.map_err(failed)?.to_vec())
    }

    fn dataset(&self, name: &str) -> Result<Dataset, FileError> {
        self.file
            .dataset(&format!("{GROUP}/{name}"))
            .map_err(|_| missing(&self.path, "column", name))
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    const FORMAT: FileFormat = FileFormat {
        name: "test",
        version: 1,
    };

    fn column(name: &str) -> Column {
        Column {
            name: name.to_owned(),
            unit: "m".to_owned(),
            description: "a column".to_owned(),
        }
    }

    #[test]
    fn columns_come_back_in_their_order_over_several_blocks() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("result.h5");
        let mut log = RowLog::create(&folder.path().join("log"), 3).unwrap();
        let rows = BLOCK_NUMBERS / 3 + 17;
        for i in 0..rows {
            let x = i as f64;
            log.append(&[x, 2.0 * x, -x]).unwrap();
        }
        let columns = [column("z/b_m"), column("a_m"), column("z/a_m")];
        let mut tree = DataTree::default();
        tree.put_text("title", "columns");
        write_columns(&path, &FORMAT, &tree, ("time", &columns), &mut log).unwrap();
        let (file, rest) = ColumnFile::open(&path, &FORMAT).unwrap();
        assert_eq!(rest, tree);
        assert_eq!((file.columns(), file.rows()), (&columns[..], rows));
        for (name, factor) in [("z/b_m", 1.0), ("a_m", 2.0), ("z/a_m", -1.0)] {
            let values = file.read(name).unwrap();
            let expected: Vec<f64> = (0..rows).map(|i| factor * i as f64).collect();
            assert_eq!(values, expected);
            assert_eq!(file.read_rows(name, 5..9).unwrap(), expected[5..9]);
            assert!(file.read_rows(name, rows..rows).unwrap().is_empty());
        }
        assert!(matches!(file.read("b"), Err(FileError::Missing { .. })));
    }

    #[test]
    fn names_that_hdf5_cannot_hold_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("result.h5");
        let mut log = RowLog::create(&folder.path().join("log"), 2).unwrap();
        log.append(&[1.0, 2.0]).unwrap();
        let columns = [column("a"), column("a/b")];
        let tree = DataTree::default();
        let written = write_columns(&path, &FORMAT, &tree, ("time", &columns), &mut log);
        assert!(matches!(written, Err(FileError::InvalidName { .. })));
        assert!(!path.exists());
    }
}
