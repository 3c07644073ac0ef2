//! Parts of a record in groups: of their own, missing as a whole, or numbered.

use super::{Fields, Way};
use crate::file_error::FileError;

impl Fields<'_> {
    /// Parts in a group of their own.
    ///
    /// # Errors
    /// Those of the parts.
    pub fn group(
        &mut self,
        group: &str,
        parts: impl FnOnce(&mut Self) -> Result<(), FileError>,
    ) -> Result<(), FileError> {
        let outer = self.group.len();
        self.group.push_str(group);
        self.group.push('/');
        let done = parts(self);
        self.group.truncate(outer);
        done
    }

    /// Parts that need not be there: their group is then missing as a whole.
    ///
    /// # Errors
    /// Those of the parts.
    pub fn optional<R: Default>(
        &mut self,
        group: &str,
        record: &mut Option<R>,
        parts: impl FnOnce(&mut R, &mut Self) -> Result<(), FileError>,
    ) -> Result<(), FileError> {
        let there = match &self.way {
            Way::Write(_) => record.is_some(),
            Way::Read(tree, _) => !tree.children(&self.at(group)).is_empty(),
            Way::List(_) => true,
        };
        if !there {
            *record = None;
            return Ok(());
        }
        let record = record.get_or_insert_default();
        self.group(group, |fields| parts(record, fields))
    }

    /// Records that are numbered from 0, each in a group of its own; `I` in the documentation.
    ///
    /// # Errors
    /// Those of their parts.
    pub fn list<R: Default>(
        &mut self,
        group: &str,
        records: &mut Vec<R>,
        parts: impl FnMut(&mut R, &mut Self) -> Result<(), FileError>,
    ) -> Result<(), FileError> {
        self.numbered((group, "I", 1), records, |_| true, parts)
    }

    /// The same in groups whose names are numbers of four digits, `NNNN` in the documentation, beside other parts.
    ///
    /// # Errors
    /// Those of their parts.
    pub fn numbered_list<R: Default>(
        &mut self,
        group: &str,
        records: &mut Vec<R>,
        parts: impl FnMut(&mut R, &mut Self) -> Result<(), FileError>,
    ) -> Result<(), FileError> {
        let is_number = |name: &String| name.bytes().all(|byte| byte.is_ascii_digit());
        self.numbered((group, "NNNN", 4), records, is_number, parts)
    }

    /// Numbers have so many digits at least; `is_record` tells the records among the parts of the group.
    fn numbered<R: Default>(
        &mut self,
        (group, listed, digits): (&str, &str, usize),
        records: &mut Vec<R>,
        is_record: impl Fn(&String) -> bool,
        mut parts: impl FnMut(&mut R, &mut Self) -> Result<(), FileError>,
    ) -> Result<(), FileError> {
        match &self.way {
            Way::Write(_) => {}
            Way::Read(tree, _) => {
                let names = tree.children(&self.at(group));
                let count = names.into_iter().filter(is_record).count();
                records.resize_with(count, R::default);
            }
            Way::List(_) => {
                let mut one = R::default();
                let name = format!("{group}/{listed}");
                return self.group(&name, |fields| parts(&mut one, fields));
            }
        }
        for (i, record) in records.iter_mut().enumerate() {
            let name = format!("{group}/{i:0digits$}");
            self.group(&name, |fields| parts(record, fields))?;
        }
        Ok(())
    }
}
