//! Tables and key figures.

use super::PageError;
use super::checks::check_count;
use super::markup::escape;
use super::typography::{html, plain};
use std::fmt::Write as _;

/// How the cells of a column stand.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Align {
    /// For words.
    Left,
    /// For phrases of many words, which get room beside many numbers.
    Phrase,
    /// For numbers.
    Right,
}

/// A table; units belong in the heads.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Table {
    caption: String,
    columns: Vec<(String, Align)>,
    rows: Vec<Vec<String>>,
    folded: bool,
}

impl Table {
    /// A table without columns.
    pub fn new(caption: impl Into<String>) -> Self {
        Self {
            caption: caption.into(),
            columns: Vec::new(),
            rows: Vec::new(),
            folded: false,
        }
    }

    /// Shows the caption only, until the reader opens it.
    #[must_use]
    pub fn folded(mut self) -> Self {
        self.folded = true;
        self
    }

    /// Whether there are no rows.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// Adds a column.
    #[must_use]
    pub fn column(mut self, head: impl Into<String>, align: Align) -> Self {
        self.columns.push((head.into(), align));
        self
    }

    /// Adds columns that stand alike.
    #[must_use]
    pub fn columns<S: Into<String>>(
        self,
        align: Align,
        heads: impl IntoIterator<Item = S>,
    ) -> Self {
        let heads = heads.into_iter();
        heads.fold(self, |table, head| table.column(head, align))
    }

    /// Adds a row with one cell for each column.
    #[must_use]
    pub fn row<S: Into<String>>(mut self, cells: impl IntoIterator<Item = S>) -> Self {
        self.push_row(cells);
        self
    }

    /// The same in place.
    pub fn push_row<S: Into<String>>(&mut self, cells: impl IntoIterator<Item = S>) {
        self.rows.push(cells.into_iter().map(Into::into).collect());
    }

    pub(super) fn render(&self, page: &mut String) -> Result<(), PageError> {
        let class = |align| match align {
            Align::Left => "",
            Align::Phrase => " class=\"phrase\"",
            Align::Right => " class=\"number\"",
        };
        // The caption stands outside the part that scrolls: it is never cut.
        let caption = html(&self.caption);
        let _ = match self.folded {
            true => writeln!(
                page,
                "<details><summary>{caption} ({} rows)</summary>",
                self.rows.len()
            ),
            false => writeln!(page, "<p class=\"caption\">{caption}</p>"),
        };
        let _ = write!(
            page,
            "<div class=\"table\" tabindex=\"0\" role=\"group\" aria-label=\"{}\"><table>\n<thead><tr>",
            escape(&plain(&self.caption))
        );
        for (head, align) in &self.columns {
            let _ = write!(
                page,
                "<th scope=\"col\"{}>{}</th>",
                class(*align),
                html(head)
            );
        }
        page.push_str("</tr></thead>\n<tbody>\n");
        for (i, row) in self.rows.iter().enumerate() {
            let what = format!("row {i}");
            check_count(&self.caption, &what, row.len(), self.columns.len())?;
            page.push_str("<tr>");
            for (cell, (_, align)) in row.iter().zip(&self.columns) {
                let _ = write!(page, "<td{}>{}</td>", class(*align), html(cell));
            }
            page.push_str("</tr>\n");
        }
        page.push_str("</tbody></table></div>\n");
        if self.folded {
            page.push_str("</details>\n");
        }
        Ok(())
    }
}

/// A few figures that a reader should see first.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct KeyFigures {
    figures: Vec<[String; 3]>,
}

impl KeyFigures {
    /// No figure yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.figures.is_empty()
    }

    /// Adds a figure: what it is, its value, its unit.
    #[must_use]
    pub fn figure(
        mut self,
        label: impl Into<String>,
        value: impl Into<String>,
        unit: impl Into<String>,
    ) -> Self {
        self.figures.push([label.into(), value.into(), unit.into()]);
        self
    }

    pub(super) fn render(&self, page: &mut String) {
        page.push_str("<dl class=\"figures\">\n");
        for [label, value, unit] in &self.figures {
            let _ = writeln!(
                page,
                "<div><dt>{}</dt><dd>{} <span>{}</span></dd></div>",
                html(label),
                html(value),
                html(unit)
            );
        }
        page.push_str("</dl>\n");
    }
}
