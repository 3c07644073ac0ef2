//! What can be wrong with a reduced gear.

use thiserror::Error;

use gearmesh_geometry::Flank;

/// A reduced gear that contradicts itself.
#[derive(Debug, Clone, Error, PartialEq)]
pub enum ReducedGearError {
    /// A count or quantity outside its range.
    #[error("{item} is {found}, but must be {allowed}; reduce the gear again")]
    OutOfRange {
        /// The quantity.
        item: String,
        /// Its value.
        found: String,
        /// What is allowed.
        allowed: &'static str,
    },
    /// An array has the wrong number of values.
    #[error(
        "{item} has {found} values, but {expected} are needed ({formula}); reduce the gear again"
    )]
    WrongLength {
        /// The array.
        item: String,
        /// How many values it has.
        found: usize,
        /// How many it must have.
        expected: usize,
        /// How that number comes about.
        formula: &'static str,
    },
    /// A value is not a finite number.
    #[error("{item} holds {value} at index {index}; all must be finite: reduce the gear again")]
    NotFinite {
        /// The array.
        item: String,
        /// Where.
        index: usize,
        /// What is there.
        value: f64,
    },
    /// The gear was reduced for the other hand of flank only.
    #[error(
        "gear \"{gear}\" was not reduced for loads on its {missing} flanks; add that hand to the gear's file and \
        reduce it again"
    )]
    FlankNotReduced {
        /// The gear.
        gear: String,
        /// The flank that carries no loads.
        missing: Flank,
    },
    /// A bevel gear where a cylindrical one is meant.
    #[error(
        "gear \"{gear}\" is a bevel gear, its flanks have no roll angles; allowed here is the model of a cylindrical gear"
    )]
    BevelGear {
        /// The gear.
        gear: String,
    },
    /// A cylindrical gear where a bevel gear is needed.
    #[error(
        "gear \"{gear}\" is a cylindrical gear; a bevel pair needs the models of its own members"
    )]
    NotBevel {
        /// The gear.
        gear: String,
    },
    /// The model carries no calibration of the near field.
    #[error(
        "gear \"{gear}\" carries no calibration of the near field, which local = \"calibrated\" needs: its file was \
        written by an older version; reduce it again, or set local = \"weber-banaschek\""
    )]
    NotCalibrated {
        /// The gear.
        gear: String,
    },
    /// The model carries no motions of its bore.
    #[error(
        "gear \"{gear}\" carries no motions of its bore, which bore = \"sliding\" and \"rollers\" need; add a table [reduction.bore] to the gear's file and reduce it again"
    )]
    NoBoreMotions {
        /// The gear.
        gear: String,
    },
    /// A stiffness of the bore's motions that no body has.
    #[error(
        "the stiffness of gear \"{gear}\" for tangential and axial motions of its bore is not positive; reduce the gear again"
    )]
    BoreStiffness {
        /// The gear.
        gear: String,
    },
    /// The model carries no natural modes.
    #[error(
        "gear \"{gear}\" carries no natural modes; add a table [modes] to the gear's file and reduce it again"
    )]
    NoModes {
        /// The gear.
        gear: String,
    },
}
