//! Keys of `[[planetary]]` that need or exclude each other, beyond what their types say.

use gearmesh_geometry::input::{Beside, TableKeys};
use gearmesh_geometry::{InputError, given};
use gearmesh_specification::system::planetary::{
    MemberTable, PinnedKeys, PlanetaryTable, SetMeshTable, SupportWord,
};

/// The first contradiction.
///
/// # Errors
/// [`InputError`] at the key that is missing or not used.
pub(super) fn check(table: &PlanetaryTable, keys: &TableKeys<'_>) -> Result<(), InputError> {
    let (sun, ring) = (&table.sun, &table.ring);
    let Beside(pinned, planets) = &table.planets;
    if sun.is_none() && ring.is_none() {
        return Err(keys.error("", "has neither sun nor ring; give one of them or both"));
    }
    check_mesh(("sun", sun), ("sun_mesh", &table.sun_mesh), keys)?;
    check_mesh(("ring", ring), ("ring_mesh", &table.ring_mesh), keys)?;
    check_partner(table, keys)?;
    if ring.is_none() && table.ring_torque.is_some() {
        return Err(keys.error("ring_torque", "is not used without a ring; remove it"));
    }
    let has_waves = |member: &MemberTable| !member.out_of_round.is_empty();
    let waves = [
        ("sun.out_of_round", sun.as_ref().is_some_and(has_waves)),
        ("carrier.out_of_round", has_waves(&table.carrier)),
    ];
    keys.refuse(&waves, "belongs to the ring; remove it")?;
    let problem = "a carrier has no teeth of this set; remove it, and fix the gear's own [[body]] to the carrier by a [[joint]]";
    keys.refuse(&[("carrier.gear", table.carrier.gear.is_some())], problem)?;
    let problem = "is that of sun or ring; remove it";
    keys.refuse(&[("carrier.z_mm", table.carrier.z_mm.is_some())], problem)?;
    let without_ring = planets.second.is_some() && ring.is_none();
    let problem = "meshes with a ring, which the set has not; remove it";
    keys.refuse(&[("planets.second", without_ring)], problem)?;
    check_pinned("planets", pinned, keys)
}

/// How pins hold planets or partners.
fn check_pinned(at: &str, held: &PinnedKeys, keys: &TableKeys<'_>) -> Result<(), InputError> {
    let housing = held.bearings.iter().position(|b| b.housing.is_some());
    let is_other = matches!(held.support, Some(SupportWord::Held | SupportWord::Free));
    let problem =
        "found \"held\" or \"free\", allowed are \"turning\", \"floating\" and \"bearings\"";
    keys.refuse(&[(&format!("{at}.support"), is_other)], problem)?;
    let key = format!("{at}.bearings.{}.housing", housing.unwrap_or(0));
    let problem = "is not used by planets; remove it";
    keys.refuse(&[(&key, housing.is_some())], problem)
}

/// Partners of planets, and their mesh with them.
fn check_partner(table: &PlanetaryTable, keys: &TableKeys<'_>) -> Result<(), InputError> {
    let Some(Beside(pinned, partner)) = &table.planets.1.partner else {
        let problem = "is not used without planets.partner; remove it";
        return keys.refuse(&given!(table; pair_mesh), problem);
    };
    check_teeth(("pair_mesh", &table.pair_mesh), &[1, 2], keys)?;
    keys.needed("pair_mesh", table.pair_mesh.as_ref(), "`planets.partner`")?;
    let meshed = "a set whose planets have partners";
    keys.needed("sun", table.sun.as_ref(), meshed)?;
    if partner.planets_of.is_none() {
        keys.needed("ring", table.ring.as_ref(), meshed)?;
    }
    let problem = "is not used with partner: planets are stepped or meshed; remove one of the two";
    keys.refuse(
        &[("planets.second", table.planets.1.second.is_some())],
        problem,
    )?;
    if partner.planets_of.is_some() {
        let problem = "is not used with planets_of: the ring is that of the other set; remove it";
        keys.refuse(&given!(table; ring), problem)?;
    }
    check_pinned("planets.partner", pinned, keys)
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
    let of_planet: &[usize] = if key == "sun" { &[2] } else { &[1] };
    check_teeth((mesh_key, mesh), of_planet, keys)
}

/// Teeth of meshes: `of_planets` are the gears, 1 or 2, whose errors stand elsewhere.
fn check_teeth(
    (mesh_key, mesh): (&str, &Option<SetMeshTable>),
    of_planets: &[usize],
    keys: &TableKeys<'_>,
) -> Result<(), InputError> {
    let Some(teeth) = mesh.as_ref().and_then(|mesh| mesh.teeth.as_ref()) else {
        return Ok(());
    };
    let at = |name: &str| format!("{mesh_key}.teeth.{name}");
    let touching = teeth.touching_at_start.is_some();
    let follows = "follows from the torque on the sun; state sun_torque instead";
    keys.refuse(&[(&at("touching_at_start"), touching)], follows)?;
    for planet in of_planets {
        let (errors, eccentricity) = match planet {
            1 => (&teeth.errors_1, &teeth.eccentricity_1),
            _ => (&teeth.errors_2, &teeth.eccentricity_2),
        };
        let keys_of = ["errors", "eccentricity"].map(|key| at(&format!("{key}_{planet}")));
        let of_planet = [
            (&*keys_of[0], !errors.is_empty()),
            (&*keys_of[1], eccentricity.is_some()),
        ];
        let problem = "is that of planets: state it in planets.errors or planets.deviation";
        keys.refuse(&of_planet, problem)?;
    }
    Ok(())
}
