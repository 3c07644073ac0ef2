//! The operating point of bearings that are linear about it (`tangent_of`), see `bearings/tangent.rs`.

use std::fmt::Display;

use gearmesh_dynamics::{State, StaticParams, System, equilibrium};
use gearmesh_geometry::InputError;

use super::bearings::tangent::{Tangent, TangentSeat, any};
use super::{LoadedSystem, Variation};

/// Turns after which the search is given up.
const MOST_TURNS: usize = 20;

/// The tangents of a scene and what to tell of them; none where no bearing asks for one.
pub(super) fn tangents(
    loaded: &LoadedSystem,
    variation: &Variation,
) -> Result<(Vec<Tangent>, Vec<String>), InputError> {
    let scene = &loaded.scene;
    if !any(&scene.tables.bearing) {
        return Ok(Default::default());
    }
    let mut found: Vec<Tangent> = Vec::new();
    for turn in 0..MOST_TURNS {
        let mut built = loaded.assemble(variation, true, &found)?;
        let start = built.system.start().clone();
        let rest = equilibrium(&mut built.system, &start, &StaticParams::default())
            .map_err(|e| scene.complaint(&e))?;
        let next = of(loaded, &built.tangents, &built.system, &rest.state)?;
        let mut pairs = next.iter().zip(&found);
        if next.len() == found.len() && pairs.all(|(next, found)| next.is_as(found)) {
            let name = |tangent: &Tangent| &*scene.tables.bearing[tangent.bearing].name;
            let notes = next.iter().map(|one| one.in_words(name(one), turn));
            return Ok((next.clone(), notes.collect()));
        }
        found = next;
    }
    let problem = format!(
        "the tangent at the operating point still changes after {MOST_TURNS} turns; take \"quasi-static\", or another load"
    );
    let number = found.first().map_or(0, |one| one.bearing);
    Err(fault(loaded, number, problem))
}

fn of(
    loaded: &LoadedSystem,
    seats: &[TangentSeat],
    system: &System,
    state: &State,
) -> Result<Vec<Tangent>, InputError> {
    let each = seats.iter().map(|seat| {
        let tangent = seat.tangent(system, state);
        tangent.map_err(|error| fault(loaded, seat.bearing, error))
    });
    each.collect()
}

fn fault(loaded: &LoadedSystem, bearing: usize, problem: impl Display) -> InputError {
    let key = format!("bearing.{bearing}.model.tangent_of");
    loaded.scene.document.error(&key, problem)
}
