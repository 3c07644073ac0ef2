//! What operations come to that are printed as they are.

use serde_json::Value;

/// What an operation came to.
#[derive(Debug, Clone)]
pub struct Answer {
    /// For other programs.
    pub figures: Value,
    /// For people.
    pub lines: Vec<String>,
}

impl From<Value> for Answer {
    /// Figures alone: nothing more is printed for people.
    fn from(figures: Value) -> Self {
        let lines = Vec::new();
        Self { figures, lines }
    }
}
