//! The list of what became of a model: taken, assumed, not represented.

use std::collections::BTreeSet;

/// One line.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct Entry {
    /// The component, or the file.
    pub subject: String,
    /// What about it.
    pub text: String,
    /// Whether it is a single value that no part of the import asked for, rather than a component, a relation or a judgement.
    pub is_value: bool,
}

/// What became of a model.
#[derive(Debug, Clone, Default)]
pub struct Ledger {
    /// Values that stand in the files that were made.
    pub taken: Vec<Entry>,
    /// What the model does not say and the files need, or says in a way that had to be interpreted.
    pub assumed: Vec<Entry>,
    /// What the model says and the files do not.
    pub not_represented: Vec<Entry>,
    known: BTreeSet<(u8, Entry)>,
}

impl Ledger {
    fn add(&mut self, list: u8, subject: &str, text: String, is_value: bool) {
        let entry = Entry {
            subject: subject.to_owned(),
            text,
            is_value,
        };
        // Load cases read the same components again.
        if self.known.insert((list, entry.clone())) {
            match list {
                0 => self.taken.push(entry),
                1 => self.assumed.push(entry),
                _ => self.not_represented.push(entry),
            }
        }
    }

    /// A value was taken.
    pub fn take(&mut self, subject: &str, text: impl Into<String>) {
        self.add(0, subject, text.into(), false);
    }

    /// Something was assumed.
    pub fn assume(&mut self, subject: &str, text: impl Into<String>) {
        self.add(1, subject, text.into(), false);
    }

    /// Something is not represented.
    pub fn leave_out(&mut self, subject: &str, text: impl Into<String>) {
        self.add(2, subject, text.into(), false);
    }

    /// A value that no part of the import asked for.
    pub fn leave_out_value(&mut self, subject: &str, text: impl Into<String>) {
        self.add(2, subject, text.into(), true);
    }

    /// The list as a page (Markdown).
    pub fn page(&self, title: &str) -> String {
        let mut page = format!("# {title}\n");
        let parts = [
            (
                "Not represented",
                "What the file says and the files made of it do not.",
                &self.not_represented,
            ),
            (
                "Assumed",
                "What the file does not say, or says in a way that had to be interpreted.",
                &self.assumed,
            ),
            (
                "Taken",
                "Values of the file that stand in the files made of it.",
                &self.taken,
            ),
        ];
        for (head, words, entries) in parts {
            page.push_str(&format!("\n## {head} ({})\n\n{words}\n", entries.len()));
            let mut subjects: Vec<&str> = Vec::new();
            for entry in entries {
                if !subjects.contains(&entry.subject.as_str()) {
                    subjects.push(&entry.subject);
                }
            }
            for subject in subjects {
                page.push_str(&format!("\n**{subject}**\n\n"));
                for entry in entries.iter().filter(|e| e.subject == subject) {
                    page.push_str(&format!("- {}\n", entry.text));
                }
            }
        }
        page
    }
}
