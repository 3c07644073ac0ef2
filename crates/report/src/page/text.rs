//! Paragraphs, notes, lists and preformatted text.

use super::markup::escape;
use super::typography::html;
use std::fmt::Write as _;

/// A piece of running text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Text {
    kind: Kind,
    text: String,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Paragraph,
    Note,
    List,
    Preformatted,
}

impl Text {
    /// A paragraph.
    pub fn paragraph(text: impl Into<String>) -> Self {
        Self {
            kind: Kind::Paragraph,
            text: text.into(),
        }
    }

    /// A paragraph that stands out: an assumption, a limit, a warning.
    pub fn note(text: impl Into<String>) -> Self {
        Self {
            kind: Kind::Note,
            text: text.into(),
        }
    }

    /// Sentences one below the other; none may have line breaks of its own.
    pub fn list<S: AsRef<str>>(items: impl IntoIterator<Item = S>) -> Self {
        let items = items
            .into_iter()
            .map(|item| item.as_ref().replace('\n', " "));
        Self {
            kind: Kind::List,
            text: items.collect::<Vec<_>>().join("\n"),
        }
    }

    /// Text with its own line breaks and fixed-width letters, as it is: a file.
    pub fn preformatted(text: impl Into<String>) -> Self {
        Self {
            kind: Kind::Preformatted,
            text: text.into(),
        }
    }

    pub(super) fn render(&self, page: &mut String) {
        let text = &self.text;
        let _ = match self.kind {
            Kind::Paragraph => writeln!(page, "<p>{}</p>", html(text)),
            Kind::Note => writeln!(page, "<p class=\"note\" role=\"note\">{}</p>", html(text)),
            Kind::List => {
                let items = text.lines().map(|line| format!("<li>{}</li>", html(line)));
                writeln!(page, "<ul>{}</ul>", items.collect::<String>())
            }
            Kind::Preformatted => writeln!(page, "<pre tabindex=\"0\">{}</pre>", escape(text)),
        };
    }
}
