//! Why a multibody scene could not be run.

use std::path::PathBuf;

use gearmesh_dynamics::DynamicsError;
use gearmesh_model::FileError;
use gearmesh_signal::SeriesError;
use gearmesh_specification::system::output::MOST_ROWS;

use crate::system::{STEPS_A_PERIOD, floored};

/// Why a multibody scene could not be run.
#[derive(Debug, thiserror::Error)]
pub enum SystemRunError {
    /// The equations could not be solved.
    #[error(transparent)]
    Dynamics(#[from] DynamicsError),
    /// A file could not be written or read.
    #[error(transparent)]
    File(#[from] FileError),
    /// A series of a result cannot be processed.
    #[error(transparent)]
    Signal(#[from] SeriesError),
    /// A folder could not be made or removed.
    #[error("cannot {action} {}: {source}", path.display())]
    Folder {
        /// The folder.
        path: PathBuf,
        /// What was attempted.
        action: &'static str,
        /// The system's reason.
        source: std::io::Error,
    },
    /// An unfinished run of something else is beside the output.
    #[error(
        "{} is an unfinished run of another scene, other input files or another version of the program: finish it with those, give \
         another output file, or discard it with --restart",
        path.display()
    )]
    OtherRun {
        /// The folder of the unfinished run.
        path: PathBuf,
    },
    /// The checkpoint of an unfinished run is damaged.
    #[error("the checkpoint cannot be used ({source}); discard the unfinished run with --restart")]
    Checkpoint {
        /// What is wrong with it.
        source: FileError,
    },
    /// An output interval that gives no rows, or too many.
    #[error(
        "output interval {interval_s} s for a run of {end_s} s: {problem}; allowed is more than zero, at most the length of the run, and at \
         most {MOST_ROWS} rows"
    )]
    Interval {
        /// Interval \[s\].
        interval_s: f64,
        /// Length of the run \[s\].
        end_s: f64,
        /// What is wrong.
        problem: &'static str,
    },
    /// A step is too long for a mesh.
    #[error(
        "at t = {time_s} s mesh `{mesh}` runs at {frequency_hz:.3} Hz: a step of {step_s:.3e} s is {:.3} of its period, allowed is an \
         eighth; take steps of at most {:.2e} s (solver.step_s, or solver.adaptive.largest_step_s)",
        step_s * frequency_hz, floored(1.0 / (STEPS_A_PERIOD * frequency_hz))
    )]
    StepPassesTeeth {
        /// The mesh.
        mesh: String,
        /// When \[s\].
        time_s: f64,
        /// Its frequency \[Hz\].
        frequency_hz: f64,
        /// The step \[s\].
        step_s: f64,
    },
    /// A column of a row is not finite.
    #[error(
        "column `{column}` is {value} at {abscissa} = {at}: the run ends here, no result is written; look at what the part does just before"
    )]
    NotFinite {
        /// The column.
        column: String,
        /// Its value.
        value: f64,
        /// First column.
        abscissa: String,
        /// Its value.
        at: f64,
    },
    /// A scene asks for something that its kind of run cannot give.
    #[error("{0}")]
    Input(#[from] gearmesh_geometry::InputError),
}

impl SystemRunError {
    /// True when the input is to blame, not the computation.
    pub fn is_input(&self) -> bool {
        match self {
            Self::Dynamics(error) => !matches!(
                error,
                DynamicsError::StepTooLarge { .. }
                    | DynamicsError::Singular { .. }
                    | DynamicsError::NoEquilibrium { .. }
                    | DynamicsError::LeftOnTheWay { .. }
                    | DynamicsError::Element { .. }
                    | DynamicsError::Eigen { .. }
            ),
            Self::OtherRun { .. } | Self::Interval { .. } | Self::Input(_) => true,
            _ => false,
        }
    }
}
