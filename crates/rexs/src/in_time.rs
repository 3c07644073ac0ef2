//! What a scene needs to run in time: steps that follow the teeth, damping, and a driven body in place of what holds a
//! train at rest.

use crate::gearbox::Train;
pub use crate::running::{DAMPING_S, Running};
use crate::text::{number, numbers, quoted};

/// Steps in a period of the fastest mesh: the solver asks for ten at least.
const STEPS_A_PERIOD: f64 = 20.0;
/// The same of planetary sets: planets swing between sun and ring much faster than their teeth come, and lose them in
/// steps that do not follow.
const STEPS_OF_SETS: f64 = 100.0;
/// Periods of the slowest mesh that are run.
const PERIODS: f64 = 10.0;
/// Output times, at most.
const MOST_ROWS: f64 = 5000.0;

/// `[run]`, `[solver]` and `[output]` of a train; none where no mesh turns. It starts from the equilibrium under its
/// loads: what loads set off at a start without it is vibration, most of which no step follows.
pub fn run_tables(train: &Train) -> Option<String> {
    let rpm = |shaft: i64| train.flow.speed_rpm.get(&shaft).copied();
    let meshes = train.meshes.iter().filter_map(|mesh| {
        let seated = &train.gears[mesh.gears[0]];
        Some(f64::from(seated.gear.teeth) * rpm(seated.shaft)?.abs() / 60.0)
    });
    // The sun's teeth pass those of the planets by its speed against the carrier.
    let sets = train.sets.iter().filter_map(|set| {
        let sun = &train.gears[set.sun];
        let carrier = set.carriers.first().and_then(|(shaft, _)| rpm(*shaft));
        let against = rpm(sun.shaft)? - carrier.unwrap_or(0.0);
        Some(f64::from(sun.gear.teeth) * against.abs() / 60.0)
    });
    let frequencies = meshes.chain(sets).filter(|hz| *hz > 0.0);
    let [slowest, fastest] = frequencies.fold([f64::INFINITY, 0.0], |[low, high], hz| {
        [hz.min(low), hz.max(high)]
    });
    if fastest == 0.0 {
        return None;
    }
    let steps_a_period = match train.sets.is_empty() {
        true => STEPS_A_PERIOD,
        false => STEPS_OF_SETS,
    };
    let step_s = 1.0 / (steps_a_period * fastest);
    let steps = (PERIODS / slowest / step_s).ceil();
    let interval_s = step_s * (steps / MOST_ROWS).ceil();
    Some(format!(
        "\n[run]\nkind = \"transient\"\nend_s = {}    # {PERIODS} periods of the slowest mesh\n\n[solver]\nstart = \"equilibrium\"\nstep_s = {}    # a \
         {steps_a_period}th of a period of the fastest mesh\n\n[output]\ninterval_s = {}\n",
        number(steps * step_s),
        number(step_s),
        number(interval_s)
    ))
}

/// A body that is driven at a speed about an axis through a point, over a spring to a body of the train: its joint,
/// motion and spring.
pub fn driven_body(
    (name, body): (&str, &str),
    (origin_mm, axis): ([f64; 3], [f64; 3]),
    speed_rpm: f64,
    stiffness_nm_per_rad: f64,
) -> String {
    let (drive, turns) = (format!("drive at {name}"), format!("axis of {name}"));
    format!(
        "\n# Drives the train where its power goes in, in place of a spring to the ground; what it weighs does not count.\n[[body]]\nname = {drive}\n\
         mass_kg = 1.0\ninertia_kg_m2 = [1e-3, 1e-3, 1e-3]\nposition_mm = {origin}\n\n[[joint]]\nname = {turns}\nkind = \"revolute\"\nbody_2 = {drive}\naxis = {axis}\n\n\
         [[motion]]\njoint = {turns}\nspeed_rpm = {speed}\n\n[[torsion_spring]]\nname = {spring}\nbody_1 = {drive}\nbody_2 = {body}\nstiffness_Nm_per_rad = {stiffness}\n\
         damping_Nm_s_per_rad = {damping}\n",
        drive = quoted(&drive),
        turns = quoted(&turns),
        origin = numbers(&origin_mm),
        axis = numbers(&axis),
        speed = number(speed_rpm),
        spring = quoted(&format!("driven at {name}")),
        body = quoted(body),
        stiffness = number(stiffness_nm_per_rad),
        damping = number(stiffness_nm_per_rad * DAMPING_S),
    )
}
