//! What can be wrong with a REXS file.

/// What is read of a REXS file.
pub type Result<T, E = RexsError> = std::result::Result<T, E>;

/// A REXS file that cannot be read. The messages leave out the file's name, which the caller knows.
#[derive(Debug, thiserror::Error)]
pub enum RexsError {
    /// Neither XML nor JSON nor a zip of one.
    #[error(
        "no REXS file: {found}; allowed are XML (.rexs), JSON (.rexsj) or a zip file of one (.rexsz)"
    )]
    Container {
        /// What was found.
        found: String,
    },
    /// Larger than is read.
    #[error(
        "{what} is larger than {most_mb} MB, unpacked; gearbox files are not: this one is not read"
    )]
    TooLarge {
        /// The file or the member of the zip file.
        what: String,
        /// The limit.
        most_mb: u64,
    },
    /// Broken XML or JSON, or elements that are not as the format says.
    #[error("{}{what}", line.map_or_else(String::new, |line| format!("line {line}: ")))]
    Syntax {
        /// Line in the (unpacked) text, from 1.
        line: Option<u32>,
        /// What was found and what is allowed.
        what: String,
    },
    /// A version that is not known.
    #[error("version `{found}` of REXS is not known; allowed are 1.0 to 1.7 and 2.x")]
    Version {
        /// The text of the file.
        found: String,
    },
    /// Two components with one number.
    #[error("two components have the id {id}: {first} and {second}; every id stands once")]
    Duplicate {
        /// The number.
        id: i64,
        /// The first component.
        first: String,
        /// The second one.
        second: String,
    },
    /// Components that contain each other, or whose places follow from each other.
    #[error("{what} go round in a circle: {chain}")]
    Cycle {
        /// What goes round.
        what: &'static str,
        /// The components.
        chain: String,
    },
    /// A value that cannot be used.
    #[error("{}{component}: {attribute}: {found}; {allowed}", line.map_or_else(String::new, |line| format!("line {line}: ")))]
    Attribute {
        /// Line of the attribute, where known.
        line: Option<u32>,
        /// Component.
        component: String,
        /// Attribute.
        attribute: String,
        /// What was found.
        found: String,
        /// What is allowed.
        allowed: String,
    },
    /// Something that a gearbox cannot do without.
    #[error("{component}: {what}")]
    Missing {
        /// Component.
        component: String,
        /// What is missing and what to do.
        what: String,
    },
}

impl RexsError {
    /// Wrong text at a line.
    pub(crate) fn syntax(line: Option<u32>, what: impl Into<String>) -> Self {
        Self::Syntax {
            line,
            what: what.into(),
        }
    }
}
