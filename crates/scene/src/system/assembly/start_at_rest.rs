//! `solver.start = "equilibrium"` where balls move: bodies start where they rest with the balls in equilibrium, balls
//! in that equilibrium, cages in the middle of their outer rings.

use gearmesh_dynamics::{BodyMotion, DynamicsError, StaticParams, equilibrium};

use crate::system::built::BuiltSystem;

/// Moves the start of a system to the rest of its twin whose balls are in equilibrium and which has no cages.
pub(super) fn start_in_equilibrium(
    built: &mut BuiltSystem,
    mut resting: BuiltSystem,
) -> Result<(), DynamicsError> {
    let given = resting.system.start().clone();
    let found = equilibrium(&mut resting.system, &given, &StaticParams::default())?;
    for motion in found.held {
        built.notes.push(format!(
            "static equilibrium at the start: nothing resists {motion}, held where it was"
        ));
    }
    let mut start = built.system.start().clone();
    let before = start.clone();
    let ids: Vec<_> = built.system.body_ids().collect();
    let count = found.state.positions_m.len();
    start.positions_m[..count].copy_from_slice(&found.state.positions_m);
    start.orientations[..count].copy_from_slice(&found.state.orientations);
    start.modal.clone_from(&found.state.modal);
    for cage in &built.cages {
        let Some(outer) = cage.outer else {
            continue;
        };
        let [from, to]: [BodyMotion; 2] =
            [&before, &start].map(|state| built.system.body_motion(state, ids[outer]));
        let turn = to.orientation * from.orientation.inverse();
        let place = start.positions_m[cage.body] - from.position_m;
        start.positions_m[cage.body] = to.position_m + turn * place;
        start.orientations[cage.body] = turn * start.orientations[cage.body];
    }
    built.system.start_at(start);
    Ok(())
}
