//! What stands between two parts: bearings, couplings, brakes, joints of shaft and hub.

use crate::error::RexsError;
use crate::ledger::About;
use crate::loose_gears;
use crate::placement::frame;
use crate::power_flow::Link;
use crate::source::Source;
use crate::structure::Structure;
use crate::text::{Names, file_stem};
use crate::train::Train;
use crate::{bearing, coupling, loads};

/// Reads bearings and couplings, and the brakes among them.
///
/// # Errors
/// Those of [`Source`].
pub fn bearings_and_couplings(
    source: &Source<'_>,
    structure: &Structure,
    train: &mut Train,
    names: &mut Names,
    files: &mut Names,
) -> Result<(), RexsError> {
    let shift_index = coupling::shift_index(source)?;
    for component in source.model.of_kind(&bearing::KINDS) {
        let name = names.unique(&component.name, component.id);
        let file = files.unique(&format!("bearing_{}", file_stem(&name)), component.id);
        let found = bearing::read(
            source,
            structure,
            component,
            name,
            format!("{}.toml", file_stem(&file)),
        )?;
        let Some(mut found) = found else { continue };
        let own = frame(source, component)?;
        if !loose_gears::stand_on_hubs(source, train, component, &mut found.sides, &mut found.u_mm)
        {
            continue;
        }
        let mut on_shaft = false;
        for side in 0..2 {
            let Some(shaft) = train.shaft(found.sides[side]) else {
                let kind = source
                    .model
                    .component(found.sides[side])
                    .map_or("", |c| c.kind.as_str());
                on_shaft |= kind == "shaft";
                if !["shaft", "gear_casing", "gear_unit", ""].contains(&kind) {
                    let what = format!("its part {kind} is not in the scene: taken as the ground");
                    source.assume(component, About::Support, what);
                }
                if kind != "shaft" {
                    found.u_mm[side] = None;
                }
                continue;
            };
            if found.u_mm[side].is_none() {
                let by_vector = own.and_then(|own| Some(shaft.frame?.u_of(own.origin_mm)));
                let about = by_vector.map_or(About::Place, |_| About::Small);
                source.assume(
                    component,
                    about,
                    format!(
                        "no place on {} given: {}",
                        shaft.name,
                        by_vector.map_or("u = 0".to_owned(), |u| format!(
                            "u = {u} mm, from its support vector"
                        ))
                    ),
                );
                found.u_mm[side] = Some(by_vector.unwrap_or(0.0));
            }
        }
        if on_shaft {
            // Shafts of the file that the scene does not have are those of planets.
            let of_planet = found
                .sides
                .map(|id| train.shaft(id).is_none().then_some(id));
            for side in of_planet.into_iter().flatten() {
                let own = train.of_planets.entry(side).or_default();
                own.push(found.clone());
            }
        } else if found.u_mm == [None, None] {
            source.leave_out(component, About::Lost, "on no shaft of the scene");
        } else {
            train.bearings.push(found);
        }
    }
    for component in source.model.of_kind(&coupling::KINDS) {
        let name = names.unique(&component.name, component.id);
        let Some(mut found) = coupling::read(source, structure, component, name, shift_index)?
        else {
            continue;
        };
        if found.sides.iter().any(|&id| train.gear(id).is_some()) {
            let what = "joins a gear to its shaft: the gear is fixed there, rigidly";
            source.assume(component, About::Stiffness, what);
            continue;
        }
        let casing = |id: i64| {
            source
                .model
                .component(id)
                .is_some_and(|c| c.kind == "gear_casing")
        };
        let [a, b] = found.sides;
        let braked = [(a, b, 0), (b, a, 1)].into_iter();
        let braked = braked.filter(|&(_, other, _)| casing(other));
        if let Some((shaft, _, side)) = { braked }.find(|&(id, ..)| train.shaft(id).is_some()) {
            let what = "engaged between a shaft and the casing: a brake, which carries the torque that the loads leave over; the shaft stands";
            source.assume(component, About::Nothing, what);
            let u_mm = found.u_mm[side].unwrap_or(0.0);
            let load = loads::brake(component.id, found.name, shaft, u_mm);
            train.loads.push(load);
            continue;
        }
        if found.sides.iter().any(|&id| train.shaft(id).is_none()) {
            source.leave_out(
                component,
                About::Lost,
                "does not join two shafts of the scene: nothing is held by it",
            );
            continue;
        }
        found.u_mm = found.u_mm.map(|u| Some(u.unwrap_or(0.0)));
        train.links.push(Link {
            shafts: found.sides,
            ratio: 1.0,
        });
        train.couplings.push(found);
    }
    loose_gears::hold_hubs(source, train);
    for component in source.model.of_kind(&coupling::JOINTS) {
        source.leave_out(
            component,
            About::Small,
            "joints of shaft and hub are rigid in the scene",
        );
    }
    Ok(())
}
