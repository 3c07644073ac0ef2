//! What a multibody scene will compute, before it is computed.

use gearmesh_dynamics::scheme::StepControl;
use gearmesh_dynamics::{DynamicsError, natural_modes};
use gearmesh_geometry::InputError;
use gearmesh_specification::system::run::{Direction, Run, Schedule};

use super::built::{BuiltBody, BuiltMesh, BuiltPart, BuiltSystem};
use super::scene::SystemScene;
use super::stage_summary::StageSummary;

/// Degrees of freedom up to which the plan seeks the highest natural frequency: a second or less.
const MOST_FOR_MODES: usize = 120;

/// Steps a period of the highest natural frequency below which the plan says so: the scheme damps what it does not
/// resolve.
const RESOLVED: f64 = 10.0;

/// Size and effects of a scene, and what its run costs.
#[derive(Debug, Clone, PartialEq)]
pub struct SystemPlan {
    /// Lines for people.
    pub lines: Vec<String>,
    /// Stages of cylindrical gears, by the names of their meshes.
    pub stages: Vec<(String, StageSummary)>,
    /// Degrees of freedom of all bodies, joints not counted.
    pub degrees_of_freedom: usize,
    /// Joint equations, redundant ones included.
    pub equations: usize,
    /// Degrees of freedom that the joints leave.
    pub mobility: usize,
    /// Highest natural frequency at the start \[Hz\].
    pub highest_frequency_hz: Option<f64>,
    /// Steps of a run that steps through time, if its cost is known.
    pub steps: Option<f64>,
    /// Wall time of one step on this machine \[s\], the mean of the trials.
    pub step_cost_s: Option<f64>,
}

impl SystemPlan {
    /// Derives the plan, without the cost.
    ///
    /// # Errors
    /// [`InputError`] when the equations at the start cannot be solved: the run would fail, too.
    pub fn new(scene: &SystemScene, built: BuiltSystem) -> Result<Self, InputError> {
        Self::derive(scene, built).map_err(|error| scene.complaint(&error))
    }

    fn derive(scene: &SystemScene, mut built: BuiltSystem) -> Result<Self, DynamicsError> {
        let mut lines = Vec::new();
        let mut line = |head: &str, words: String| lines.push(format!("{head:<10} {words}"));
        line("scene", scene.title.clone());
        line("run", run_in_words(&scene.run));
        for set in &scene.sets {
            line("planetary", format!("{}: {}", set.name, set.words()));
        }
        let system = &built.system;
        let (degrees_of_freedom, equations, mobility) = (
            system.degrees_of_freedom(),
            system.equations(),
            system.mobility(),
        );
        for BuiltBody { name, source, .. } in &built.bodies {
            let body = system.bodies().iter().find(|other| other.name == *name);
            let mass = body.map_or(0.0, |body| body.mass_kg);
            line("body", format!("{name}: {mass:.6} kg, {source}"));
        }
        let bodies = built.bodies.len();
        line(
            "size",
            format!(
                "{bodies} bodies, {degrees_of_freedom} degrees of freedom, {equations} joint equations, {mobility} degrees of freedom left"
            ),
        );
        for (head, parts) in [("joint", &built.joints), ("force", &built.elements)] {
            for BuiltPart { name, kind, bodies } in parts {
                line(head, format!("{name}: {kind}, on {}", bodies.join(" and ")));
            }
        }
        for mesh in &built.meshes {
            let (name, model, [z1, z2], [gear_1, gear_2]) =
                (&mesh.name, mesh.model, mesh.teeth, &mesh.gears);
            let (ratio, often) = (mesh.ratio(), mesh.frequency_in_words());
            line(
                "mesh",
                format!(
                    "{name}: `{model}`, {gear_1} z {z1} with {gear_2} z {z2}, ratio {ratio:.6}, {often}"
                ),
            );
            if let Some(stage) = &mesh.stage {
                line("stage", format!("{name}: {}", stage.words()));
            }
        }
        for gauge in &built.gauges {
            line("gauge", format!("{} of {}", gauge.name, gauge.body));
        }
        for rating in &built.ratings {
            line("rating", format!("{}: {}", rating.name, rating.method));
        }
        for effect in &built.effects {
            let how = effect.computed.as_deref().unwrap_or("not computed");
            line("effect", format!("{}: {how}", effect.name));
        }
        for note in &built.notes {
            line("note", note.clone());
        }
        let highest_frequency_hz = highest_frequency(&mut built)?;
        if let Some(highest) = highest_frequency_hz {
            let words = format!("highest natural frequency at the start {highest:.3} Hz");
            line("frequency", words);
        }
        let of_mesh = |mesh: &BuiltMesh| Some((mesh.name.clone(), mesh.stage?));
        let mut plan = Self {
            lines,
            stages: built.meshes.iter().filter_map(of_mesh).collect(),
            degrees_of_freedom,
            equations,
            mobility,
            highest_frequency_hz,
            steps: None,
            step_cost_s: None,
        };
        plan.add_resolution(scene);
        Ok(plan)
    }

    fn add_resolution(&mut self, scene: &SystemScene) {
        let (Some(params), Some(highest)) = (scene.solver.params, self.highest_frequency_hz) else {
            return;
        };
        let step_s = params.step.longest_s();
        if scene.run.simulated_s().is_some() && highest * step_s * RESOLVED > 1.0 {
            self.lines.push(format!(
                "note       a step of {step_s} s has {:.1} steps in a period of the highest natural frequency: what is above {:.1} Hz is damped by the scheme, not resolved",
                1.0 / (highest * step_s),
                1.0 / (RESOLVED * step_s)
            ));
        }
    }
}

/// The step, for adaptive ones the longest, and how to call it.
pub(crate) fn step_in_words(step: StepControl) -> (f64, &'static str) {
    let how = match step {
        StepControl::Fixed { .. } => "fixed",
        StepControl::Adaptive(_) => "adaptive, at most",
    };
    (step.longest_s(), how)
}

fn highest_frequency(built: &mut BuiltSystem) -> Result<Option<f64>, DynamicsError> {
    if built.system.degrees_of_freedom() > MOST_FOR_MODES {
        return Ok(None);
    }
    let start = built.system.start().clone();
    let modes = natural_modes(&mut built.system, &start)?;
    let frequencies = modes.iter().map(|mode| mode.frequency_hz());
    Ok(frequencies.filter(|f| *f > 0.0).reduce(f64::max))
}

fn run_in_words(run: &Run) -> String {
    match run {
        Run::Transient { end_s } => format!("transient to {end_s} s"),
        Run::Static {
            load_factors,
            angles_rad,
        } => {
            let angles = angles_rad.as_ref().map_or(String::new(), |angles| {
                format!(" x {} angles of `{}`", angles.values.len(), angles.motion)
            });
            format!("static, {} load factors{angles}", load_factors.len())
        }
        Run::Eigen {
            settle_s,
            load_factors,
            speeds_rad_per_s,
            ..
        } => {
            let about = settle_s.map_or("the static equilibrium".to_string(), |settle| {
                format!("the motion after {settle} s")
            });
            let speeds = speeds_rad_per_s.as_ref().map_or(String::new(), |speeds| {
                format!(" x {} speeds of `{}`", speeds.values.len(), speeds.motion)
            });
            format!(
                "eigen about {about}, {} load factors{speeds}",
                load_factors.len()
            )
        }
        Run::SpeedSweep(sweep) => {
            let rpm = |speed: f64| speed * 60.0 / std::f64::consts::TAU;
            let way = match sweep.direction {
                Direction::Up => "up",
                Direction::Down => "down",
                Direction::UpDown => "up and down",
            };
            let how = match sweep.schedule {
                Schedule::Stepped {
                    speeds,
                    settle_s,
                    measure_s,
                } => format!(
                    "{speeds} speeds, each {settle_s} s to settle and {measure_s} s measured"
                ),
                Schedule::Ramped { ramp_s } => format!("ramps of {ramp_s} s"),
            };
            format!(
                "speed-sweep of `{}` {way} between {:.6} and {:.6} rpm, {how}",
                sweep.motion,
                rpm(sweep.from_rad_per_s),
                rpm(sweep.to_rad_per_s)
            )
        }
    }
}
