//! Measured curves into a reference record: `gearmesh record`. For users: docs/records.md.
//!
//! | what | file |
//! | --- | --- |
//! | channels, and what may be wrong with them | this one |
//! | channels of a CSV file with units | `measured/csv_channels.rs` |
//! | units of measured channels | `measured/unit.rs` |
//! | the two files of a record | `measured/record_files.rs` |

mod csv_channels;
mod record_files;
mod unit;

pub use csv_channels::{csv_channels, decoded};
pub use record_files::{RecordFiles, RecordRequest, record_files};

use crate::export::Function;
use gearmesh_geometry::input::nearest;

/// One measured channel over its axis.
#[derive(Debug, Clone, PartialEq)]
pub struct Channel {
    /// Name without the unit.
    pub name: String,
    /// Unit as written; empty where none is.
    pub unit: String,
    /// Name of the axis.
    pub axis: String,
    /// Its unit as written; empty where none is.
    pub axis_unit: String,
    /// Places on the axis.
    pub x: Vec<f64>,
    /// Values.
    pub y: Vec<f64>,
}

impl From<Function> for Channel {
    /// A function of a universal file; what tells it from others of its name becomes part of the name.
    fn from(function: Function) -> Self {
        let Function {
            name,
            condition,
            unit,
            axis,
            axis_unit,
            x,
            y,
        } = function;
        let name = if condition.is_empty() {
            name
        } else {
            format!("{name} ({condition})")
        };
        Self {
            name,
            unit,
            axis,
            axis_unit,
            x,
            y,
        }
    }
}

/// Why no record is made. Lines count from 1.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum MeasuredError {
    /// A CSV file that is no table.
    #[error("{line}: {problem}")]
    Table {
        /// Line.
        line: u64,
        /// What is wrong there.
        problem: String,
    },
    /// A name that no channel has.
    #[error("no channel `{wanted}`{near}; there are: {known}", near = near(wanted, known))]
    NoChannel {
        /// Name asked for.
        wanted: String,
        /// All names, separated by `; `.
        known: String,
    },
    /// Two channels of one name.
    #[error("{count} channels are called `{name}`; give them names of their own")]
    SameNames {
        /// The name.
        name: String,
        /// How many.
        count: usize,
    },
    /// A head of data.csv that is not understood.
    #[error(
        "--column: `{found}` is no head of data.csv; allowed is te_um_<T>Nm or strain_<gauge>_ustrain_<T>Nm, such as te_um_200Nm"
    )]
    Head {
        /// Head found.
        found: String,
    },
    /// A channel whose unit is missing or of another quantity.
    #[error(
        "channel `{name}` has the unit `{found}`; {what} needs {allowed} (--unit \"{name}=UNIT\" states it)"
    )]
    Unit {
        /// The channel.
        name: String,
        /// Unit as written.
        found: String,
        /// Which quantity it is to be.
        what: &'static str,
        /// Units of that quantity.
        allowed: String,
    },
    /// An option that is needed, or that has no use.
    #[error("{0}")]
    Option(String),
    /// Channels that do not have the same places on the axis.
    #[error(
        "channels `{first}` and `{second}` are not measured at the same places of the axis; bring them to one axis first"
    )]
    OtherAxis {
        /// A channel.
        first: String,
        /// Another.
        second: String,
    },
    /// The angle goes to and fro.
    #[error(
        "the angle goes to and fro: {before_deg} deg, then {found_deg} deg (value {place}); it must rise or fall all along"
    )]
    AngleOrder {
        /// Which value, from 1.
        place: usize,
        /// Angle before, degrees.
        before_deg: f64,
        /// Angle, degrees.
        found_deg: f64,
    },
    /// Less than the revolutions.
    #[error(
        "{covered_deg:.2} deg from {from_deg:.2} deg on are measured; {revolutions} revolution(s) are {needed_deg} deg"
    )]
    TooShort {
        /// Degrees covered.
        covered_deg: f64,
        /// Begin.
        from_deg: f64,
        /// Revolutions asked for.
        revolutions: usize,
        /// Their degrees.
        needed_deg: f64,
    },
}

fn near(wanted: &str, known: &str) -> String {
    let names: Vec<&str> = known.split("; ").collect();
    nearest(wanted, &names).map_or_else(String::new, |name| format!(", did you mean `{name}`?"))
}

/// The channel of a name.
///
/// # Errors
/// [`MeasuredError::NoChannel`], [`MeasuredError::SameNames`].
pub(crate) fn channel<'a>(
    channels: &'a [Channel],
    name: &str,
) -> Result<&'a Channel, MeasuredError> {
    let found: Vec<&Channel> = channels.iter().filter(|c| c.name == name).collect();
    match found[..] {
        [one] => Ok(one),
        [] => {
            let names: Vec<&str> = channels.iter().map(|c| &*c.name).collect();
            Err(MeasuredError::NoChannel {
                wanted: name.to_owned(),
                known: names.join("; "),
            })
        }
        _ => Err(MeasuredError::SameNames {
            name: name.to_owned(),
            count: found.len(),
        }),
    }
}
