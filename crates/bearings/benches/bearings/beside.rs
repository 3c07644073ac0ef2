//! The same bearing as tools/bench/bearing_exudyn.py has it: what both programs can, to compare their errors and steps.
//!
//! A deep-groove bearing, whose balls stay in one plane: the contact of Exudyn 1.13.6 has a wrong gap where a ball
//! stands aside of the plane of the torus.

use super::machine::{
    BALL_M, BALLS, Machine, PITCH_RADIUS_M, RADIAL_N, SHAFT_KG, SHAFT_KG_M2, SPEED_RAD_PER_S,
    WIDENED_M, fitted, pose, rolling_rad_per_s,
};
use super::recorded::timed;
use gearmesh_dynamics::{Params, Simulation};

pub const CAGE_KG: f64 = 0.02;
const CAGE_WIDTH_M: f64 = 0.01;
const CAGE_HEIGHT_M: f64 = 0.002;
pub const POCKET_N_PER_M: f64 = 1e5;
/// About Hertz' of these balls.
pub const CONTACT_N_PER_M15: f64 = 8e9;
pub const DAMPING_N_S_PER_M: f64 = 30.0;
pub const FRICTION: f64 = 0.06;
pub const ZONE_M_PER_S: f64 = 0.05;
const END_S: f64 = 0.02;
const INTERVAL_S: f64 = 1e-4;
/// The last is what the others are compared with.
const STEPS_S: [f64; 5] = [1e-5, 5e-6, 2.5e-6, 1.25e-6, 3.125e-7];

/// Inertia of a hollow cylinder about x, y and z.
fn cage_kg_m2() -> [f64; 3] {
    let [outer, inner] = [0.5, -0.5].map(|side| (PITCH_RADIUS_M + side * CAGE_HEIGHT_M).powi(2));
    let across = CAGE_KG / 12.0 * (3.0 * (outer + inner) + CAGE_WIDTH_M.powi(2));
    [across, across, 0.5 * CAGE_KG * (outer + inner)]
}

pub fn measure() {
    // Where all of it begins, and what it is made of.
    let machine = Machine::plain(cage_kg_m2());
    let start = Simulation::new(machine.system, Params::fixed(1e-5)).unwrap();
    let state = start.state();
    let first = start.system().layout().first_unknown();
    let bearing = fitted();
    let pose = pose(&bearing, 0.0);
    let height = pose.centre_m;
    let balls: Vec<String> = (0..BALLS)
        .map(|ball| {
            let place = &state.unknowns[6 * ball..6 * ball + 3];
            let rates = &state.velocity[first + 6 * ball..first + 6 * ball + 6];
            format!(
                "{{\"place_m\": {place:?}, \"velocity_m_per_s\": {:?}, \"spin_rad_per_s\": {:?}}}",
                &rates[..3],
                &rates[3..]
            )
        })
        .collect();
    println!(
        "{{\"case\": \"start\", \"ball_m\": {BALL_M}, \"pitch_radius_m\": {PITCH_RADIUS_M}, \"conformity\": 0.52, \"widened_m\": {WIDENED_M}, \
         \"density_kg_per_m3\": 7850.0, \"shaft_kg\": {SHAFT_KG}, \"shaft_kg_m2\": {SHAFT_KG_M2:?}, \"shaft_m\": [{}, {}, {}], \
         \"shaft_rad_per_s\": {SPEED_RAD_PER_S}, \"radial_N\": {RADIAL_N}, \"cage_kg\": {CAGE_KG}, \"cage_width_m\": {CAGE_WIDTH_M}, \
         \"cage_height_m\": {CAGE_HEIGHT_M}, \"cage_rad_per_s\": {}, \"pocket_N_per_m\": {POCKET_N_PER_M}, \"contact_N_per_m15\": {CONTACT_N_PER_M15}, \
         \"damping_N_s_per_m\": {DAMPING_N_S_PER_M}, \"friction\": {FRICTION}, \"zone_m_per_s\": {ZONE_M_PER_S}, \"end_s\": {END_S}, \
         \"interval_s\": {INTERVAL_S}, \"steps_s\": {STEPS_S:?}, \"balls\": [{}]}}",
        height.x,
        height.y,
        height.z,
        rolling_rad_per_s(&bearing, &pose),
        balls.join(", ")
    );
    for step_s in STEPS_S {
        let run = timed(Machine::plain(cage_kg_m2()), step_s, END_S, INTERVAL_S);
        let loads: Vec<String> = run
            .inner_n
            .iter()
            .map(|balls| format!("{balls:?}"))
            .collect();
        println!(
            "{{\"case\": \"beside\", \"step_s\": {step_s:e}, \"steps\": {}, \"wall_s\": {}, \"cpu_s\": {}, \"iterations\": {}, \"factorisations\": {}, \"inner_N\": [{}], \"cage_rad_per_s\": {:?}}}",
            run.steps,
            run.wall_s,
            run.cpu_s,
            run.iterations,
            run.factorisations,
            loads.join(", "),
            run.cage_rad_per_s
        );
    }
}
