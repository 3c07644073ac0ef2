//! Paragraphs, notes and preformatted text.

use super::markup::escape;
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

    /// Text with its own line breaks and fixed-width letters.
    pub fn preformatted(text: impl Into<String>) -> Self {
        Self {
            kind: Kind::Preformatted,
            text: text.into(),
        }
    }

    pub(super) fn render(&self, html: &mut String) {
        let text = escape(&self.text);
        let _ = match self.kind {
            Kind::Paragraph => writeln!(html, "<p>{text}</p>"),
            Kind::Note => writeln!(html, "<p class=\"note\" role=\"note\">{text}</p>"),
            Kind::Preformatted => writeln!(html, "<pre tabindex=\"0\">{text}</pre>"),
        };
    }
}
