//! Rows of numbers appended to a plain file while a run goes on.
//!
//! 64-bit floats, little-endian, row after row, nothing else: a file that is cut in the midst of a row by a crash loses
//! that row only, and a run that resumes cuts it to the rows that its checkpoint counts. The log has no seal of its
//! own: its digest so far stands in the checkpoint ([`RowLog::digest`]), and rows are compared with it when a run
//! resumes and when they become columns. HDF5 comes at the end ([`write_columns`](crate::write_columns)): libhdf5 may
//! leave a file unreadable that it had open when the process was killed.

use std::fs::{File, TryLockError};
use std::io::{Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use crate::atomic_file::{folder_of, open_growing};
use crate::file_error::{FileError, io_error};

const NUMBER_BYTES: usize = size_of::<f64>();

/// Bytes collected before they are handed to the system.
const BUFFER_BYTES: usize = 1 << 16;

/// The file of a log, locked: no other process can lock it, and nothing of it has changed yet.
#[derive(Debug)]
pub struct LockedLog {
    path: PathBuf,
    file: File,
}

impl LockedLog {
    /// Opens the file, or makes an empty one, and locks it.
    ///
    /// # Errors
    /// [`FileError::InUse`] if another process has it locked, [`FileError::OutputIsALink`],
    /// [`FileError::NotARegularFile`], [`FileError::Io`].
    pub fn open(path: &Path) -> Result<Self, FileError> {
        let io = |action| io_error(path, action);
        let file = open_growing(path)?;
        match file.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => {
                return Err(FileError::InUse {
                    path: path.to_owned(),
                });
            }
            Err(TryLockError::Error(source)) => return Err(io("lock")(source)),
        }
        let path = path.to_owned();
        Ok(Self { path, file })
    }

    /// Whether the file that is locked still stands under its name. The process that had it before may have removed
    /// it between its being opened and locked here.
    pub fn has_its_name(&self) -> bool {
        #[cfg(unix)]
        {
            use std::os::unix::fs::MetadataExt;
            match (self.file.metadata(), self.path.symlink_metadata()) {
                (Ok(open), Ok(named)) => (open.dev(), open.ino()) == (named.dev(), named.ino()),
                _ => false,
            }
        }
        // Elsewhere an open file cannot be removed.
        #[cfg(not(unix))]
        {
            self.path.exists()
        }
    }

    /// Begins an empty log; what the file held is cut off.
    ///
    /// # Errors
    /// [`FileError::Io`].
    pub fn create(self, columns: usize) -> Result<RowLog, FileError> {
        RowLog::cut(self, columns, 0)
    }

    /// Goes on after `rows` rows, whose [`RowLog::digest`] must be `digest`; what was written later is cut off.
    ///
    /// # Errors
    /// [`FileError::ShortLog`] if the file has fewer rows, [`FileError::Altered`] if they are not those that were
    /// written, [`FileError::Io`].
    pub fn resume(self, columns: usize, rows: u64, digest: &str) -> Result<RowLog, FileError> {
        let mut log = RowLog::cut(self, columns, rows)?;
        log.hasher = log.hash_rows()?;
        log.must_have(digest, &log.hasher)?;
        Ok(log)
    }
}

/// A locked file with its buffer.
#[derive(Debug)]
pub struct RowLog {
    path: PathBuf,
    file: File,
    columns: usize,
    rows: u64,
    buffer: Vec<u8>,
    /// Digest of what was handed to the system.
    hasher: blake3::Hasher,
}

impl RowLog {
    /// Locks the file and begins an empty log; an older one is emptied.
    ///
    /// # Errors
    /// [`FileError::InUse`] if another process has it locked, [`FileError::Io`].
    pub fn create(path: &Path, columns: usize) -> Result<Self, FileError> {
        LockedLog::open(path)?.create(columns)
    }

    /// The log with its first rows; what follows them is cut off.
    fn cut(locked: LockedLog, columns: usize, rows: u64) -> Result<Self, FileError> {
        let LockedLog { path, file } = locked;
        let io = |action| io_error(&path, action);
        // The count comes from a file.
        let needed = rows.saturating_mul((columns * NUMBER_BYTES) as u64);
        let found = file.metadata().map_err(io("inspect"))?.len();
        if found < needed {
            return Err(FileError::ShortLog {
                path,
                found_bytes: found,
                expected_bytes: needed,
            });
        }
        file.set_len(needed).map_err(io("cut"))?;
        let mut log = Self {
            path,
            file,
            columns,
            rows,
            buffer: Vec::with_capacity(BUFFER_BYTES + columns * NUMBER_BYTES),
            hasher: blake3::Hasher::new(),
        };
        log.seek(needed)?;
        Ok(log)
    }

    /// Numbers in a row.
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// Rows so far.
    pub fn rows(&self) -> u64 {
        self.rows
    }

    /// Appends a row. Allocates nothing.
    ///
    /// # Errors
    /// [`FileError::Io`].
    ///
    /// # Panics
    /// If the row has another length than the log's.
    pub fn append(&mut self, row: &[f64]) -> Result<(), FileError> {
        assert_eq!(row.len(), self.columns, "length of a row");
        for number in row {
            self.buffer.extend_from_slice(&number.to_le_bytes());
        }
        self.rows += 1;
        if self.buffer.len() >= BUFFER_BYTES {
            self.flush()?;
        }
        Ok(())
    }

    /// Forces all rows to the disk: they are there even if the machine stops now.
    ///
    /// # Errors
    /// [`FileError::Io`].
    pub fn sync(&mut self) -> Result<(), FileError> {
        self.flush()?;
        self.file
            .sync_data()
            .map_err(io_error(&self.path, "force to the disk"))
    }

    /// Rows from `first` on, at most `count`, into `out`.
    ///
    /// # Errors
    /// [`FileError::Io`].
    pub fn read(&mut self, first: u64, count: usize, out: &mut Vec<f64>) -> Result<(), FileError> {
        self.flush()?;
        let count = (self.rows.saturating_sub(first)).min(count as u64) as usize;
        let row_bytes = self.columns * NUMBER_BYTES;
        let mut bytes = vec![0; count * row_bytes];
        self.seek(first * row_bytes as u64)?;
        self.file
            .read_exact(&mut bytes)
            .map_err(io_error(&self.path, "read"))?;
        out.clear();
        let (numbers, _) = bytes.as_chunks::<NUMBER_BYTES>();
        out.extend(numbers.iter().map(|b| f64::from_le_bytes(*b)));
        self.seek(self.rows * row_bytes as u64)
    }

    /// BLAKE3 digest of all rows so far as they were appended, 64 hexadecimal digits.
    ///
    /// # Errors
    /// [`FileError::Io`].
    pub fn digest(&mut self) -> Result<String, FileError> {
        self.flush()?;
        Ok(self.hasher.finalize().to_hex().to_string())
    }

    /// Reads all rows again and compares them with those that were appended.
    ///
    /// # Errors
    /// [`FileError::Altered`], [`FileError::Io`].
    pub(crate) fn verify(&mut self) -> Result<(), FileError> {
        let written = self.digest()?;
        let found = self.hash_rows()?;
        self.must_have(&written, &found)
    }

    /// Digest of the file's first rows as they are on the disk.
    fn hash_rows(&mut self) -> Result<blake3::Hasher, FileError> {
        let length = self.rows * (self.columns * NUMBER_BYTES) as u64;
        self.seek(0)?;
        let mut hasher = blake3::Hasher::new();
        let mut rest = length;
        let mut block = vec![0; 1 << 20];
        while rest > 0 {
            let count = rest.min(block.len() as u64) as usize;
            self.file
                .read_exact(&mut block[..count])
                .map_err(io_error(&self.path, "read"))?;
            hasher.update(&block[..count]);
            rest -= count as u64;
        }
        self.seek(length)?;
        Ok(hasher)
    }

    fn must_have(&self, digest: &str, found: &blake3::Hasher) -> Result<(), FileError> {
        let found = found.finalize().to_hex();
        if found.as_str() == digest {
            return Ok(());
        }
        Err(FileError::Altered {
            path: self.path.clone(),
            difference: format!(
                "the digest of its {} rows is {found}, was {digest}",
                self.rows
            ),
        })
    }

    fn flush(&mut self) -> Result<(), FileError> {
        self.file
            .write_all(&self.buffer)
            .map_err(io_error(&self.path, "write"))?;
        self.hasher.update(&self.buffer);
        self.buffer.clear();
        Ok(())
    }

    fn seek(&mut self, place: u64) -> Result<(), FileError> {
        self.file
            .seek(SeekFrom::Start(place))
            .map_err(io_error(&self.path, "read"))?;
        Ok(())
    }

    /// Folder that the log is in.
    pub(crate) fn folder(&self) -> &Path {
        folder_of(&self.path)
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use std::fs::OpenOptions;

    fn resume(path: &Path, columns: usize, rows: u64, digest: &str) -> Result<RowLog, FileError> {
        LockedLog::open(path)?.resume(columns, rows, digest)
    }

    #[cfg(unix)]
    #[test]
    fn a_log_behind_a_link_is_refused_and_what_it_points_to_stays() {
        let folder = tempfile::tempdir().unwrap();
        let (path, other) = (folder.path().join("rows.log"), folder.path().join("other"));
        std::os::unix::fs::symlink(&other, &path).unwrap();
        let refused = || RowLog::create(&path, 3).err();
        assert!(matches!(refused(), Some(FileError::OutputIsALink { .. })));
        assert!(!other.exists());
        std::fs::write(&other, "mine").unwrap();
        assert!(matches!(refused(), Some(FileError::OutputIsALink { .. })));
        assert_eq!(std::fs::read(&other).unwrap(), b"mine");
    }

    #[test]
    fn a_log_resumes_at_the_row_it_is_told() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("rows.log");
        let mut log = RowLog::create(&path, 3).unwrap();
        for i in 0..10_000 {
            log.append(&[f64::from(i), -0.0, f64::NAN]).unwrap();
        }
        log.sync().unwrap();
        drop(log);
        let mut first = RowLog::create(&folder.path().join("first.log"), 3).unwrap();
        for i in 0..9_000 {
            first.append(&[f64::from(i), -0.0, f64::NAN]).unwrap();
        }
        let digest = first.digest().unwrap();
        // Half a row more, as a crash may leave it.
        let mut file = OpenOptions::new().append(true).open(&path).unwrap();
        file.write_all(&[1; 13]).unwrap();
        drop(file);
        let mut log = resume(&path, 3, 9_000, &digest).unwrap();
        log.append(&[7.0, 8.0, 9.0]).unwrap();
        let mut rows = Vec::new();
        log.read(8_999, 100, &mut rows).unwrap();
        assert_eq!(rows.len(), 6);
        assert_eq!((rows[0], rows[3]), (8999.0, 7.0));
        assert!(rows[2].is_nan() && rows[1].to_bits() == (-0.0_f64).to_bits());
        assert_eq!(log.rows(), 9_001);
        log.append(&[1.0, 2.0, 3.0]).unwrap();
        log.sync().unwrap();
        assert_eq!(std::fs::metadata(&path).unwrap().len(), 9_002 * 24);
        log.verify().unwrap();
    }

    #[test]
    fn a_flipped_bit_is_found_when_the_log_is_resumed_and_when_it_is_read_to_the_end() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("rows.log");
        let flip = |place: u64| {
            let mut file = OpenOptions::new()
                .read(true)
                .write(true)
                .open(&path)
                .unwrap();
            let mut byte = [0];
            file.seek(SeekFrom::Start(place)).unwrap();
            file.read_exact(&mut byte).unwrap();
            file.seek(SeekFrom::Start(place)).unwrap();
            file.write_all(&[byte[0] ^ 4]).unwrap();
        };
        let mut log = RowLog::create(&path, 2).unwrap();
        for i in 0..100 {
            log.append(&[f64::from(i), 1.0]).unwrap();
        }
        log.sync().unwrap();
        let digest = log.digest().unwrap();
        flip(800);
        assert!(matches!(log.verify(), Err(FileError::Altered { .. })));
        drop(log);
        assert!(matches!(
            resume(&path, 2, 100, &digest),
            Err(FileError::Altered { .. })
        ));
        flip(800);
        resume(&path, 2, 100, &digest).unwrap().verify().unwrap();
    }

    #[test]
    fn a_log_that_is_too_short_or_in_use_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("rows.log");
        let mut log = RowLog::create(&path, 1).unwrap();
        log.append(&[1.0]).unwrap();
        log.sync().unwrap();
        assert!(matches!(
            RowLog::create(&path, 1),
            Err(FileError::InUse { .. })
        ));
        drop(log);
        let error = resume(&path, 1, 2, "").unwrap_err().to_string();
        assert!(error.contains("8 bytes") && error.contains("16"), "{error}");
    }
}
