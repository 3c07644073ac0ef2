//! What is to be run, free of how the scene file says it.

use std::path::Path;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

use gearmesh_dynamics::{Params, StepControl, System};
use gearmesh_geometry::BaseCircles;
use gearmesh_model::bytes_digest;
use gearmesh_specification::system::solver::Start;

use crate::system::planetary::PlanetarySet;
use crate::system::{RatingJob, StageSummary};

use super::error::SystemRunError;
use super::recorder::Selection;
use super::result_kind::ResultKind;
use super::speed_plan::Window;

/// One of a series of equilibria.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StaticPoint {
    /// Angle of the varied motion \[rad\], if there is one.
    pub angle_rad: Option<f64>,
    /// Time at which loads and prescribed motions are taken \[s\].
    pub time_s: f64,
    /// Share of the scene's loads.
    pub load_factor: f64,
    /// Steps of the way there from the point before, at least.
    pub steps: usize,
}

/// Makes the system that a point of a series needs.
pub type SystemAt<P> = Box<dyn Fn(P) -> Result<System, SystemRunError>>;

/// A series of equilibria.
pub struct StaticJob {
    /// The points; those of one load factor stand together.
    pub points: Vec<StaticPoint>,
    /// Makes the system for a load factor.
    pub system_at: SystemAt<f64>,
}

/// An operating point whose natural frequencies are sought.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct EigenPoint {
    /// Speed of the varied motion \[rad/s\], if there is one.
    pub speed_rad_per_s: Option<f64>,
    /// Share of the scene's loads.
    pub load_factor: f64,
}

/// A motion that settles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settling {
    /// For so long \[s\].
    pub time_s: f64,
    /// Parameters of the integrator.
    pub params: Params,
    /// Where it begins.
    pub start: Start,
}

/// Natural frequencies at some operating points.
pub struct EigenJob {
    /// The points.
    pub points: Vec<EigenPoint>,
    /// The operating point is where the motion stands after this time \[s\]; the static equilibrium where not given.
    pub settle: Option<Settling>,
    /// Highest frequency that is kept \[Hz\].
    pub most_frequency_hz: Option<f64>,
    /// Loads that are torques, whose stiffness is not symmetric.
    pub torques: Vec<String>,
    /// Makes the system for a point.
    pub system_at: SystemAt<EigenPoint>,
}

/// A run in time from t = 0.
#[derive(Debug, Clone, PartialEq)]
pub struct InTime {
    /// Parameters of the integrator.
    pub params: Params,
    /// Where it begins.
    pub start: Start,
    /// End \[s\].
    pub end_s: f64,
    /// Output interval \[s\].
    pub interval_s: f64,
    /// Statistics of a recorded motion begin here \[s\]: what the start has shaken has died out.
    pub statistics_from_s: f64,
    /// What a sweep measures, in the order of time. Without windows all rows are kept.
    pub windows: Vec<Window>,
}

/// Looks between two rows at most, which bounds the memory of the filter.
const MOST_SAMPLES_PER_ROW: f64 = 64.0;

impl InTime {
    /// How often the motion is looked at for each row: about once a step, of adaptive ones the longest.
    #[must_use]
    pub fn samples_per_row(&self) -> usize {
        let step_s = match self.params.step {
            StepControl::Fixed { step_s } => step_s,
            StepControl::Adaptive(limits) => limits.largest_step_s,
        };
        let samples = (self.interval_s / step_s - 1e-9).ceil();
        samples.clamp(1.0, MOST_SAMPLES_PER_ROW) as usize
    }
}

/// What a run computes.
pub enum RunKind {
    /// A motion, recorded.
    Transient(InTime),
    /// A motion whose prescribed speed goes through the windows, measured in each.
    SpeedSweep(InTime),
    /// Equilibria, each found from the one before.
    Static(StaticJob),
    /// Natural frequencies.
    Eigen(EigenJob),
}

impl RunKind {
    /// Kind of the result.
    pub fn of_result(&self) -> ResultKind {
        match self {
            Self::Transient(_) => ResultKind::Transient,
            Self::SpeedSweep(_) => ResultKind::SpeedSweep,
            Self::Static(_) => ResultKind::Static,
            Self::Eigen(_) => ResultKind::Eigen,
        }
    }

    /// Whether an unfinished run can go on.
    pub fn resumes(&self) -> bool {
        matches!(self, Self::Transient(_) | Self::SpeedSweep(_))
    }
}

/// A gear mesh, for the frequencies that a reader looks for.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct MeshRecord {
    /// Force element.
    pub name: String,
    /// Bodies of gear 1 and 2.
    pub bodies: [String; 2],
    /// Teeth of gear 1 and 2.
    pub teeth: [usize; 2],
    /// As in [`crate::system::BuiltMesh`]; empty in files of older programs.
    pub flank_corners_m: Vec<f64>,
    /// The stage without load; none of bevel pairs and in files of older programs.
    pub stage: Option<StageSummary>,
    /// Speeds of gear 1 and 2 about their z at the start \[rad/s\]; none in files of older programs.
    pub speeds_rad_per_s: Option<[f64; 2]>,
}

impl MeshRecord {
    /// u: teeth of gear 2 over those of gear 1, negative with a ring.
    #[must_use]
    pub fn ratio(&self) -> f64 {
        let of_teeth = self.teeth[1] as f64 / self.teeth[0] as f64;
        self.stage.map_or(of_teeth, |stage| stage.ratio)
    }

    /// Base circles of both, in parts of what one tooth has of the radius. A ring is the gear with more teeth.
    #[must_use]
    pub fn circles(&self) -> BaseCircles {
        let mut radii_m = self.teeth.map(|teeth| teeth as f64);
        if self.ratio() < 0.0 {
            radii_m[usize::from(radii_m[1] > radii_m[0])] *= -1.0;
        }
        BaseCircles { radii_m }
    }
}

/// Where a result comes from; kept in it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct RunHead {
    /// Title of the scene.
    pub title: String,
    /// The scene file, verbatim.
    pub scene_toml: String,
    /// Digests of all other files that the system was made from.
    pub inputs: Vec<String>,
    /// Assumptions and warnings.
    pub notes: Vec<String>,
    /// Gear meshes.
    pub meshes: Vec<MeshRecord>,
    /// Planetary sets.
    pub sets: Vec<PlanetarySet>,
}

impl RunHead {
    /// Digest of scene, input files and program version: an unfinished run may go on if it has the same.
    pub fn identity(&self) -> String {
        let own = [&self.scene_toml[..], env!("CARGO_PKG_VERSION")];
        let inputs = self.inputs.iter().map(String::as_str);
        let parts: Vec<&str> = own.into_iter().chain(inputs).collect();
        bytes_digest(parts.join("\0").as_bytes())
    }
}

/// Everything that a run needs.
pub struct RunJob {
    /// Where it comes from.
    pub head: RunHead,
    /// The system.
    pub system: System,
    /// What is recorded.
    pub selection: Selection,
    /// What is judged after the run.
    pub ratings: Vec<RatingJob>,
    /// What is computed.
    pub kind: RunKind,
}

/// How far a run is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Advance {
    /// Done, as a share of `total`: time \[s\] or points.
    pub done: f64,
    /// All of it.
    pub total: f64,
    /// Whether the run goes on from a checkpoint; told once.
    pub resumed: bool,
}

/// How to run.
pub struct RunOptions<'a> {
    /// Result file.
    pub output: &'a Path,
    /// Discard an unfinished run.
    pub restart: bool,
    /// Wall time between checkpoints.
    pub checkpoint_interval: Duration,
    /// Set from outside: write a checkpoint and stop.
    pub stop: &'a AtomicBool,
    /// Told now and then.
    pub progress: &'a dyn Fn(Advance),
}

/// How a run ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    /// The result is written.
    Finished,
    /// Stopped on demand; the same command goes on.
    Stopped,
}
