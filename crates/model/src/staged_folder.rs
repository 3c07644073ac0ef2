//! A folder of files that belong together, written beside and renamed: a process killed meanwhile leaves all or none.

use std::fs::{File, OpenOptions};
use std::path::Path;

use crate::atomic_file::{
    TEMPORARY_SUFFIX, demand_output, folder_of, remove_abandoned, temporary_builder,
    temporary_prefix, wait_for_writes,
};
use crate::file_error::{FileError, io_error};

/// Writes text files by name into a folder, which is made where it is not there.
///
/// A new folder gets its name when all of its files are whole. Into one that is there already the files are moved one
/// after the other, in the order given, when the last of them is whole; what else it holds stays.
///
/// # Errors
/// [`FileError::NotARegularFile`], [`FileError::OutputIsALink`], [`FileError::Io`].
pub fn write_folder(folder: &Path, files: &[(String, String)]) -> Result<(), FileError> {
    let io = |action| io_error(folder, action);
    for (name, _) in files {
        demand_output(&folder.join(name))?;
    }
    let parent = folder_of(folder);
    std::fs::create_dir_all(parent).map_err(io("make the folder of"))?;
    let prefix = temporary_prefix(folder);
    remove_abandoned(parent, &prefix, TEMPORARY_SUFFIX);
    let staged = temporary_builder(&prefix, TEMPORARY_SUFFIX, 0o777).tempdir_in(parent);
    let staged = staged.map_err(io("make a temporary folder beside"))?;
    // Locked while it is written: one without a lock belongs to a process that was killed.
    let lock = File::open(staged.path())
        .and_then(|open| open.try_lock().map(|()| open).map_err(Into::into))
        .ok();
    let _held = wait_for_writes();
    let paths = || files.iter().map(|(name, _)| staged.path().join(name));
    // Plainly: a temporary name for each would look through the folder, which grows with them. All are written before
    // the first is waited for.
    for (path, (_, text)) in paths().zip(files) {
        std::fs::write(path, text).map_err(io("write the files of"))?;
    }
    for path in paths() {
        OpenOptions::new()
            .write(true)
            .open(path)
            .and_then(|file| file.sync_all())
            .map_err(io("force to the disk the files of"))?;
    }
    // A rename takes the place of an empty folder, but not of a link to one.
    if folder.symlink_metadata().is_err() && std::fs::rename(staged.path(), folder).is_ok() {
        // What had to be removed has another name now.
        let _ = staged.keep();
    } else {
        std::fs::create_dir_all(folder).map_err(io("make the folder"))?;
        for (name, _) in files {
            std::fs::rename(staged.path().join(name), folder.join(name))
                .map_err(io("move the new files to"))?;
        }
    }
    drop(lock);
    // The new names are on the disk only when their folder is. Where folders cannot be opened, the renames still hold.
    for changed in [folder, parent] {
        if let Ok(open) = File::open(changed) {
            open.sync_all().map_err(io("force to the disk"))?;
        }
    }
    Ok(())
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::atomic_file::LOOKS;
    use crate::atomic_file::tests::names;

    fn files(text: &str) -> [(String, String); 2] {
        ["a.csv", "b.toml"].map(|name| (name.to_owned(), text.to_owned()))
    }

    #[test]
    fn a_new_folder_and_one_that_is_there_get_all_files_and_nothing_is_left_beside() {
        let desk = tempfile::tempdir().unwrap();
        let folder = desk.path().join("deep/record");
        write_folder(&folder, &files("old")).unwrap();
        std::fs::write(folder.join("mine.txt"), "mine").unwrap();
        write_folder(&folder, &files("new")).unwrap();
        assert_eq!(names(&folder), ["a.csv", "b.toml", "mine.txt"]);
        assert_eq!(std::fs::read(folder.join("b.toml")).unwrap(), b"new");
        assert_eq!(names(&desk.path().join("deep")), ["record"]);
    }

    /// A gearbox of 100 000 components has 18 000 files: were the folder searched for each, it took 38 s.
    #[test]
    fn the_folder_is_not_searched_for_each_file() {
        let desk = tempfile::tempdir().unwrap();
        let many: Vec<(String, String)> = (0..300)
            .map(|i| (format!("{i}.toml"), "gear".to_owned()))
            .collect();
        let before = LOOKS.get();
        write_folder(&desk.path().join("new"), &many).unwrap();
        assert_eq!(LOOKS.get() - before, 0);
        write_folder(&desk.path().join("new"), &many).unwrap();
        assert_eq!(
            LOOKS.get() - before,
            1,
            "the folder itself, among its neighbours"
        );
        assert_eq!(names(&desk.path().join("new")).len(), 300);
    }

    #[test]
    fn what_a_killed_write_left_goes_with_the_next_one_and_what_is_at_work_stays() {
        let desk = tempfile::tempdir().unwrap();
        let folder = desk.path().join("record");
        let prefix = temporary_prefix(&folder);
        let left = |number: usize| {
            let path = desk.path().join(format!("{prefix}{number}.tmp"));
            std::fs::create_dir(&path).unwrap();
            std::fs::write(path.join("a.csv"), "half").unwrap();
            path
        };
        let (abandoned, at_work) = (left(1), left(2));
        let open = File::open(&at_work).unwrap();
        open.try_lock().unwrap();
        write_folder(&folder, &files("new")).unwrap();
        assert!(!abandoned.exists() && at_work.exists());
    }

    #[cfg(unix)]
    #[test]
    fn nothing_is_written_where_a_file_is_a_link() {
        let desk = tempfile::tempdir().unwrap();
        let folder = desk.path().join("record");
        std::fs::create_dir(&folder).unwrap();
        let other = desk.path().join("other");
        std::fs::write(&other, "old").unwrap();
        std::os::unix::fs::symlink(&other, folder.join("b.toml")).unwrap();
        let refused = write_folder(&folder, &files("new"));
        assert!(matches!(refused, Err(FileError::OutputIsALink { .. })));
        assert_eq!(names(&folder), ["b.toml"]);
        assert_eq!(std::fs::read(&other).unwrap(), b"old");
    }
}
