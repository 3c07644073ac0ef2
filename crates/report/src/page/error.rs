//! Why a page cannot be made.

/// Why a page cannot be made. `block` is the title of the chart, table or picture.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PageError {
    /// A chart or picture without data.
    #[error("'{block}': {what} is empty; leave the block out where there is nothing to show")]
    Empty {
        /// Title of the block.
        block: String,
        /// What is empty.
        what: &'static str,
    },
    /// Numbers of different counts that belong together.
    #[error("'{block}': {what} has {found} entries; {expected} are expected")]
    Count {
        /// Title of the block.
        block: String,
        /// Name of the series, row or array.
        what: String,
        /// Entries found.
        found: usize,
        /// Entries expected.
        expected: usize,
    },
    /// Abscissas that do not increase.
    #[error(
        "'{block}': abscissa {index} is {found}, not above {before}; abscissas must increase and be finite"
    )]
    NotIncreasing {
        /// Title of the block.
        block: String,
        /// Index from 0.
        index: usize,
        /// The value there.
        found: f64,
        /// The value before.
        before: f64,
    },
    /// NaN or infinity where a number is needed (in line charts NaN is a gap and allowed).
    #[error("'{block}': {what} holds {found} at index {index}; a finite number is needed")]
    NotFinite {
        /// Title of the block.
        block: String,
        /// Name of the series or array.
        what: String,
        /// Index from 0.
        index: usize,
        /// The value.
        found: f64,
    },
    /// A quad that names a node that does not exist.
    #[error("'{block}': quad {quad} uses node {node}, but there are {nodes} nodes")]
    NoSuchNode {
        /// Title of the block.
        block: String,
        /// Index of the quad.
        quad: usize,
        /// The node it names.
        node: u32,
        /// Number of nodes.
        nodes: usize,
    },
    /// A colour scale or window without extent.
    #[error(
        "'{block}': {what} runs from {low} to {high}; it needs finite ends, the first below the second"
    )]
    Range {
        /// Title of the block.
        block: String,
        /// What it is.
        what: &'static str,
        /// Lower end.
        low: f64,
        /// Upper end.
        high: f64,
    },
    /// The data could not be written as JSON.
    #[error("'{block}': its data could not be written: {reason}")]
    Data {
        /// Title of the block.
        block: String,
        /// What the writer said.
        reason: String,
    },
}
