//! Keys of `[[planetary]]` that need or exclude each other, beyond what their types say.

use gearmesh_geometry::InputError;
use gearmesh_geometry::input::TableKeys;

use crate::system::tables::planetary::{MemberTable, PlanetaryTable, SetMeshTable, SupportWord};

const OF_PLANETS: &str = "is that of planets: state it in planets.errors or planets.deviation";
const OF_RING: &str = "belongs to the ring; remove it";

/// The first contradiction.
///
/// # Errors
/// [`InputError`] at the key that is missing or not used.
pub(super) fn check(table: &PlanetaryTable, keys: &TableKeys<'_>) -> Result<(), InputError> {
    let (sun, ring, planets) = (&table.sun, &table.ring, &table.planets);
    if sun.is_none() && ring.is_none() {
        return Err(keys.error("", "has neither sun nor ring; give one of them or both"));
    }
    check_mesh(("sun", sun), ("sun_mesh", &table.sun_mesh), keys)?;
    check_mesh(("ring", ring), ("ring_mesh", &table.ring_mesh), keys)?;
    let has_waves = |member: &MemberTable| !member.out_of_round.is_empty();
    let housing = planets.bearings.iter().position(|b| b.housing.is_some());
    let housing_key = format!("planets.bearings.{}.housing", housing.unwrap_or(0));
    let faults = [
        (
            "sun.out_of_round",
            sun.as_ref().is_some_and(has_waves),
            OF_RING,
        ),
        ("carrier.out_of_round", has_waves(&table.carrier), OF_RING),
        (
            "carrier.gear",
            table.carrier.gear.is_some(),
            "a carrier has no teeth of this set; remove it, and fix the gear's own [[body]] to the carrier by a [[joint]]",
        ),
        (
            "planets.second",
            planets.second.is_some() && ring.is_none(),
            "meshes with a ring, which the set has not; remove it",
        ),
        (
            "planets.support",
            matches!(planets.support, Some(SupportWord::Held | SupportWord::Free)),
            "found \"held\" or \"free\", allowed are \"turning\", \"floating\" and \"bearings\"",
        ),
        (
            &housing_key,
            housing.is_some(),
            "is not used by planets; remove it",
        ),
    ];
    refuse(&faults, keys)
}

fn refuse(faults: &[(&str, bool, &str)], keys: &TableKeys<'_>) -> Result<(), InputError> {
    match faults.iter().find(|(_, is_so, _)| *is_so) {
        Some((key, _, problem)) => Err(keys.error(key, problem)),
        None => Ok(()),
    }
}

/// A member with teeth and its meshes; those of the sun have the planet as gear 2, those of the ring as gear 1.
fn check_mesh(
    (key, member): (&str, &Option<MemberTable>),
    (mesh_key, mesh): (&str, &Option<SetMeshTable>),
    keys: &TableKeys<'_>,
) -> Result<(), InputError> {
    match (member, mesh) {
        (Some(_), None) => return keys.needed(mesh_key, None, &format!("a set with a {key}")),
        (None, Some(_)) => {
            let problem = format!("is not used without a {key}; remove it");
            return Err(keys.error(mesh_key, problem));
        }
        _ => {}
    }
    let Some(teeth) = mesh.as_ref().and_then(|mesh| mesh.teeth.as_ref()) else {
        return Ok(());
    };
    let at = |name: &str| format!("{mesh_key}.teeth.{name}");
    let (planet, errors, eccentricity) = match key {
        "sun" => (2, &teeth.errors_2, &teeth.eccentricity_2),
        _ => (1, &teeth.errors_1, &teeth.eccentricity_1),
    };
    let faults = [
        (
            &*at(&format!("errors_{planet}")),
            !errors.is_empty(),
            OF_PLANETS,
        ),
        (
            &*at(&format!("eccentricity_{planet}")),
            eccentricity.is_some(),
            OF_PLANETS,
        ),
        (
            &*at("touching_at_start"),
            teeth.touching_at_start.is_some(),
            "follows from the torque on the sun; state sun_torque instead",
        ),
    ];
    refuse(&faults, keys)
}
