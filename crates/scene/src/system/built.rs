//! What a scene becomes: a multibody system with the names of its parts.

use std::sync::Arc;

use gearmesh_drivetrain::FoundTogether;
use gearmesh_dynamics::{BodyId, System};
use gearmesh_model::ReducedGear;

use super::assembly::{PlacedCage, TangentSeat};
use super::stage_summary::StageSummary;
pub use crate::rating::rule::RatingRule;

/// A system that is ready to run.
pub struct BuiltSystem {
    /// Bodies, joints, force elements.
    pub system: System,
    /// Bodies, in the order of their numbers in the system.
    pub bodies: Vec<BuiltBody>,
    /// Joints and motions, in the order of the system.
    pub joints: Vec<BuiltPart>,
    /// Force elements, in the order of the system.
    pub elements: Vec<BuiltPart>,
    /// Gear meshes.
    pub meshes: Vec<BuiltMesh>,
    /// Pitches that the fastest toothed mesh goes through for a radian of the motion that a static series varies.
    pub pitches_per_rad: f64,
    /// Speed that the scene states for the motion that the run varies \[rad/s\]; 0 where there is none.
    pub varied_rad_per_s: f64,
    /// Meshes that are solved together.
    pub together: Vec<BuiltTogether>,
    /// Gauges to read.
    pub gauges: Vec<BuiltGauge>,
    /// What is judged after the run.
    pub ratings: Vec<RatingJob>,
    /// What was assumed or found: phases, redundant joint equations, speeds that follow from a mesh.
    pub notes: Vec<String>,
    /// Effects that are computed, and those that could be and are not.
    pub effects: Vec<Effect>,
    /// Cages of bearings among the bodies.
    pub(super) cages: Vec<PlacedCage>,
    /// Bearings whose tangent is taken.
    pub(super) tangents: Vec<TangentSeat>,
}

/// Meshes that are solved together.
pub struct BuiltTogether {
    /// Name of the force element.
    pub element: String,
    /// Names of the meshes, in its order.
    pub meshes: Vec<String>,
    /// What they are found as.
    pub found: FoundTogether,
}

/// A body.
#[derive(Debug, Clone)]
pub struct BuiltBody {
    /// Name.
    pub name: String,
    /// Number in the system.
    pub id: BodyId,
    /// Where mass and inertia come from: "stated", "gear file …", "model file …", "station of shaft …".
    pub source: String,
    /// The reduced gear, where the body is one.
    pub model: Option<Arc<ReducedGear>>,
}

/// A joint, motion or force element.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct BuiltPart {
    /// Name.
    pub name: String,
    /// Kind as in the scene: "revolute", "motion", "torsion spring", "impact mesh", …
    pub kind: &'static str,
    /// Names of the bodies, "ground" among them.
    pub bodies: Vec<String>,
}

/// A gear mesh.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct BuiltMesh {
    /// Name of the force element, or of the joint for `kinematic`.
    pub name: String,
    /// Names of the bodies of gear 1 and gear 2.
    pub gears: [String; 2],
    /// Numbers of teeth.
    pub teeth: [usize; 2],
    /// Base radii \[m\], negative of a ring.
    pub base_radii_m: [f64; 2],
    /// Model as in the scene.
    pub model: &'static str,
    /// Frequency of the mesh at the start \[Hz\]: teeth of gear 1 times its speed about its axis against the line of
    /// centres.
    pub frequency_hz: f64,
    /// The highest frequency of the mesh \[Hz\] at the speeds of the start and those to which motions go in a run in
    /// time.
    pub highest_hz: f64,
    /// The frequency of the mesh \[Hz\] at speeds that motions keep from the time on from which statistics of a
    /// recorded motion count; none where they change, or no motion drives the mesh.
    pub steady_hz: Option<f64>,
    /// Speeds of gear 1 and gear 2 about their z at the start \[rad/s\].
    pub speeds_rad_per_s: [f64; 2],
    /// The stage at a glance; none of bevel pairs.
    pub stage: Option<StageSummary>,
    /// Of bevel pairs the corners of a flank of gear 1, then gear 2 \[m\]: cone distance and height above the pitch
    /// cone of lower line and tip at the toe, tip and lower line at the heel; empty for others.
    pub flank_corners_m: Vec<f64>,
}

impl BuiltMesh {
    /// How often teeth come into mesh, for a line of a plan.
    pub(crate) fn frequency_in_words(&self) -> String {
        let at_start = self.frequency_hz;
        if at_start > 0.0 {
            format!("mesh frequency at the start {at_start:.3} Hz")
        } else if self.highest_hz > 0.0 {
            format!(
                "at rest at the start, mesh frequency up to {:.3} Hz at the speeds that motions reach",
                self.highest_hz
            )
        } else {
            "at rest at the start".to_owned()
        }
    }

    /// u: teeth of gear 2 over those of gear 1, negative with a ring.
    #[must_use]
    pub fn ratio(&self) -> f64 {
        let [z1, z2] = self.teeth.map(|teeth| teeth as f64);
        let [r1, r2] = self.base_radii_m;
        (z2 / z1).copysign(r1 * r2)
    }
}

/// A gauge on a reduced gear. Each of its meshes has it as two channels: `strain_gear1_NAME_method1_ustrain` and
/// `…_method2_ustrain`.
#[derive(Debug, Clone)]
pub struct BuiltGauge {
    /// Name as in the model.
    pub name: String,
    /// Name of the body.
    pub body: String,
    /// Number among the model's gauges.
    pub index: usize,
    /// The model.
    pub model: Arc<ReducedGear>,
    /// The `hybrid` meshes that load the gear: name of the force element, and whether the body is its gear 1 or 2.
    pub meshes: Vec<(String, usize)>,
}

/// A rating, made of columns of the result.
#[derive(Debug, Clone, PartialEq)]
pub struct RatingJob {
    /// What is rated, in words.
    pub name: String,
    /// How, in words.
    pub method: String,
    /// Time from which rows count \[s\].
    pub from_s: f64,
    /// Columns that it reads.
    pub columns: Vec<String>,
    /// Column of the turns of the gauge's gear, which say whether the history is a revolution; used where it is
    /// written.
    pub turn_column: Option<String>,
    /// What is made of them.
    pub rule: RatingRule,
}

/// An effect that a scene may name.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Effect {
    /// What.
    pub name: String,
    /// How it is computed; none where it is not.
    pub computed: Option<String>,
}
