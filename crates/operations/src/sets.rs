//! The planetary sets of a run: how their planets share the load. A block of lines for the console, figures of the
//! JSON.

use gearmesh_report::short;
use gearmesh_scene::system_run::{MeshShares, SetFigures, SystemResult};
use serde_json::{Map, Value, json};

use crate::failure::Failure;

/// A line a planet; nothing of a scene without planetary sets.
pub fn lines(result: &SystemResult) -> Result<Vec<String>, Failure> {
    let sets = result.sets().map_err(Failure::work)?;
    Ok(sets.iter().flat_map(of_set).collect())
}

fn of_set(found: &SetFigures) -> Vec<String> {
    let mut lines = vec![format!("planetary set {}, {}:", found.set.name, found.over)];
    let factor = |shares: &Option<MeshShares>| {
        let factor = shares.as_ref().map(MeshShares::mesh_load_factor);
        factor.map_or_else(|| "-".to_owned(), short)
    };
    lines.push(format!(
        "K_gamma {} of the sun meshes, {} of the ring meshes",
        factor(&found.sun),
        factor(&found.ring)
    ));
    let row = |cells: [String; 7]| {
        let [name, rest @ ..] = cells;
        let rest = rest.iter().map(|cell| format!(" {cell:>13}"));
        format!("{name:<10}{}", rest.collect::<String>())
    };
    let heads = [
        "planet",
        "sun share",
        "largest",
        "sun force N",
        "ring share",
        "ring force N",
        "pin force N",
    ];
    lines.push(row(heads.map(str::to_owned)));
    for planet in 0..found.set.planets.len() {
        let of = |shares: &Option<MeshShares>, part: fn(&MeshShares) -> &Vec<f64>| {
            let value = shares.as_ref().and_then(|shares| part(shares).get(planet));
            value.map_or_else(|| "-".to_owned(), |value| short(*value))
        };
        let pin = found
            .pin_force_n
            .as_ref()
            .map(|forces| short(forces[planet]));
        lines.push(row([
            (planet + 1).to_string(),
            of(&found.sun, |s| &s.mean),
            of(&found.sun, |s| &s.largest),
            of(&found.sun, |s| &s.normal_force_n),
            of(&found.ring, |s| &s.mean),
            of(&found.ring, |s| &s.normal_force_n),
            pin.unwrap_or_else(|| "-".to_owned()),
        ]));
    }
    let orbit = found
        .sun_orbit_m
        // Rounding of a sun on a fixed axis is no orbit.
        .map(|r| if r < 1e-15 { 0.0 } else { 1e6 * r })
        .map(|um| format!("sun within {} um of its mean place", short(um)));
    let te = found.transmission_error_rad;
    let te = te.map(|te| {
        format!(
            "transmission error of the carrier {} urad peak to peak",
            short(1e6 * te)
        )
    });
    let both: Vec<String> = orbit.into_iter().chain(te).collect();
    if !both.is_empty() {
        lines.push(both.join(", "));
    }
    lines
}

/// For `--json`: the figures of each set by its name; null of a scene without.
pub fn json(result: &SystemResult) -> Result<Value, Failure> {
    let sets = result.sets().map_err(Failure::work)?;
    if sets.is_empty() {
        return Ok(Value::Null);
    }
    let shares = |shares: &Option<MeshShares>| {
        shares.as_ref().map(|shares| {
            json!({
                "mesh_load_factor": shares.mesh_load_factor(), "share_mean": shares.mean, "share_largest": shares.largest,
                "normal_force_N": shares.normal_force_n,
            })
        })
    };
    let of_set = |found: &SetFigures| {
        let value = json!({
            "over": found.over, "planets": found.set.planets, "sun": shares(&found.sun), "ring": shares(&found.ring),
            "pin_force_N": found.pin_force_n, "sun_orbit_um": found.sun_orbit_m.map(|r| 1e6 * r),
            "transmission_error_urad": found.transmission_error_rad.map(|te| 1e6 * te),
        });
        (found.set.name.clone(), value)
    };
    Ok(Value::Object(
        sets.iter().map(of_set).collect::<Map<_, _>>(),
    ))
}
