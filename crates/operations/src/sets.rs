//! The planetary sets of a run: how their planets share the load. A block of lines for the console, figures of the
//! JSON.

use gearmesh_report::short;
use gearmesh_scene::system_run::{MeshShares, SetFigures, SystemResult};
use serde_json::{Map, Value, json};

use crate::failure::{Failure, Result};

/// A line a planet; nothing of a scene without planetary sets.
pub fn lines(result: &SystemResult) -> Result<Vec<String>> {
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
    let row = |cells: Vec<String>| {
        let (name, rest) = cells.split_first().map_or(("", &[][..]), |(n, r)| (n, r));
        let rest = rest.iter().map(|cell| format!(" {cell:>13}"));
        format!("{name:<10}{}", rest.collect::<String>())
    };
    let is_meshed = found.set.teeth.is_meshed;
    let mut heads = vec![
        "planet",
        "sun share",
        "largest",
        "sun force N",
        "ring share",
        "ring force N",
        "pin force N",
    ];
    if is_meshed {
        heads.extend(["pair share", "pair force N", "partner pin N"]);
    }
    lines.push(row(heads.into_iter().map(str::to_owned).collect()));
    let cell = |value: Option<f64>| value.map_or_else(|| "-".to_owned(), short);
    for planet in 0..found.set.planets.len() {
        let of = |shares: &Option<MeshShares>, part: fn(&MeshShares) -> &Vec<f64>| {
            cell(
                shares
                    .as_ref()
                    .and_then(|shares| part(shares).get(planet).copied()),
            )
        };
        let pin = |forces: &Option<Vec<f64>>| cell(forces.as_ref().map(|forces| forces[planet]));
        let mut cells = vec![
            (planet + 1).to_string(),
            of(&found.sun, |s| &s.mean),
            of(&found.sun, |s| &s.largest),
            of(&found.sun, |s| &s.normal_force_n),
            of(&found.ring, |s| &s.mean),
            of(&found.ring, |s| &s.normal_force_n),
            pin(&found.pin_force_n),
        ];
        if is_meshed {
            cells.extend([
                of(&found.pair, |s| &s.mean),
                of(&found.pair, |s| &s.normal_force_n),
                pin(&found.partner_pin_force_n),
            ]);
        }
        lines.push(row(cells));
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
pub fn json(result: &SystemResult) -> Result<Value> {
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
        let mut value = json!({
            "over": found.over, "planets": found.set.planets, "sun": shares(&found.sun), "ring": shares(&found.ring),
            "pin_force_N": found.pin_force_n, "sun_orbit_um": found.sun_orbit_m.map(|r| 1e6 * r),
            "transmission_error_urad": found.transmission_error_rad.map(|te| 1e6 * te),
        });
        if found.set.teeth.is_meshed {
            value["partners"] = json!(found.set.partners.bodies);
            value["pair"] = json!(shares(&found.pair));
            value["partner_pin_force_N"] = json!(found.partner_pin_force_n);
        }
        (found.set.name.clone(), value)
    };
    Ok(Value::Object(
        sets.iter().map(of_set).collect::<Map<_, _>>(),
    ))
}
