//! Widths of the columns of printed tables.

/// Widest column \[characters\]; a longer cell moves the rest of its own line only. (Formatting takes no width above
/// 65 535, and names come from files.)
const WIDEST: usize = 200;

/// Width of a column that holds these cells, at least `least` characters.
pub fn column_width<S: AsRef<str>>(cells: impl IntoIterator<Item = S>, least: usize) -> usize {
    let widths = cells.into_iter().map(|cell| cell.as_ref().chars().count());
    widths.max().unwrap_or(0).max(least).min(WIDEST)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_cell_makes_a_column_too_wide_to_print() {
        assert_eq!(column_width(["é", "abc"], 2), 3);
        assert_eq!(column_width::<&str>([], 6), 6);
        let long = "x".repeat(70_000);
        let width = column_width([&long], 6);
        assert_eq!(format!("{:>width$}|", "a").len(), WIDEST + 1);
    }
}
