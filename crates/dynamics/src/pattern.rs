//! Which places of a sparse matrix may hold a value: known from the bodies that joints and elements connect, the same
//! for a whole run.

/// Places of a matrix, column after column, rows rising.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Pattern {
    rows: usize,
    starts: Vec<usize>,
    indices: Vec<usize>,
}

impl Pattern {
    /// From the rows of each column, in any order and with repetitions.
    pub(crate) fn from_columns(rows: usize, columns: Vec<Vec<usize>>) -> Self {
        let mut pattern = Self {
            rows,
            starts: vec![0],
            indices: Vec::new(),
        };
        for mut column in columns {
            column.sort_unstable();
            column.dedup();
            pattern.indices.append(&mut column);
            pattern.starts.push(pattern.indices.len());
        }
        pattern
    }

    /// Of a square matrix: everything in a group meets everything in it, and each place itself.
    pub(crate) fn of_groups<'a>(size: usize, groups: impl Iterator<Item = &'a [usize]>) -> Self {
        let mut columns: Vec<Vec<usize>> = (0..size).map(|i| vec![i]).collect();
        for group in groups {
            for &member in group {
                columns[member].extend_from_slice(group);
            }
        }
        Self::from_columns(size, columns)
    }

    pub(crate) fn rows(&self) -> usize {
        self.rows
    }

    pub(crate) fn columns(&self) -> usize {
        self.starts.len() - 1
    }

    /// Number of places.
    pub(crate) fn len(&self) -> usize {
        self.indices.len()
    }

    /// Where the places of a column stand among all.
    pub(crate) fn range(&self, column: usize) -> std::ops::Range<usize> {
        self.starts[column]..self.starts[column + 1]
    }

    /// Rows of a column.
    pub(crate) fn column(&self, column: usize) -> &[usize] {
        &self.indices[self.range(column)]
    }

    /// Beginnings of the columns, the end of the last one behind them.
    pub(crate) fn starts(&self) -> &[usize] {
        &self.starts
    }

    /// Rows of all columns, one column after the other.
    pub(crate) fn indices(&self) -> &[usize] {
        &self.indices
    }

    /// Where an entry stands among all; `None` if the pattern leaves it out. Most columns have no gaps, which are then
    /// not searched.
    #[inline]
    pub(crate) fn place(&self, row: usize, column: usize) -> Option<usize> {
        let start = self.starts[column];
        let rows = &self.indices[start..self.starts[column + 1]];
        let guess = row.wrapping_sub(*rows.first()?);
        if rows.get(guess) == Some(&row) {
            return Some(start + guess);
        }
        rows.binary_search(&row).ok().map(|place| start + place)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_found_and_others_are_not() {
        let pattern = Pattern::of_groups(6, [&[0, 1][..], &[1, 4, 2]].into_iter());
        assert_eq!(pattern.column(1), [0, 1, 2, 4]);
        assert_eq!(pattern.column(5), [5]);
        assert_eq!(pattern.len(), 2 + 4 + 3 + 1 + 3 + 1);
        let dense: Vec<(usize, usize)> = (0..6)
            .flat_map(|column| (0..6).map(move |row| (row, column)))
            .filter(|&(row, column)| pattern.place(row, column).is_some())
            .collect();
        let listed: Vec<(usize, usize)> = (0..6)
            .flat_map(|column| pattern.column(column).iter().map(move |&row| (row, column)))
            .collect();
        assert_eq!(dense, listed);
        for (k, &(row, column)) in listed.iter().enumerate() {
            assert_eq!(pattern.place(row, column), Some(k));
        }
    }
}
