//! What stands between two parts: bearings, couplings, brakes, joints of shaft and hub.

use crate::bearing::Bearing;
use crate::error::Result;
use crate::gearbox::Train;
use crate::ledger::About;
use crate::loose_gears;
use crate::placement::frame;
use crate::power_flow::Link;
use crate::source::{Part, Source};
use crate::text::{Names, file_stem};
use crate::vectors::Frame;
use crate::{bearing, coupling, loads};

/// Reads bearings and couplings, and the brakes among them.
///
/// # Errors
/// Those of [`Part`].
pub fn bearings_and_couplings(
    source: &Source<'_>,
    train: &mut Train,
    names: &mut Names,
    files: &mut Names,
) -> Result<()> {
    let shift_index = coupling::shift_index(source)?;
    bearings(source, train, names, files)?;
    couplings(source, train, names, shift_index)?;
    loose_gears::hold_hubs(source, train);
    for component in source.of_kind(&coupling::JOINTS) {
        let what = "joints of shaft and hub are rigid in the scene";
        component.leave_out(About::Small, what);
    }
    Ok(())
}

fn bearings(
    source: &Source<'_>,
    train: &mut Train,
    names: &mut Names,
    files: &mut Names,
) -> Result<()> {
    for component in source.of_kind(&bearing::KINDS) {
        let name = names.unique(&component.name, component.id);
        let file = files.unique(&format!("bearing_{}", file_stem(&name)), component.id);
        let found = bearing::read(component, name, format!("{}.toml", file_stem(&file)))?;
        let Some(mut found) = found else { continue };
        let own = frame(component)?;
        if !loose_gears::stand_on_hubs(train, component, &mut found.sides, &mut found.u_mm) {
            continue;
        }
        if place(source, train, component, own, &mut found) {
            // Shafts of the file that the scene does not have are those of planets.
            let of_planet = found
                .sides
                .map(|id| train.shaft(id).is_none().then_some(id));
            for side in of_planet.into_iter().flatten() {
                let own = train.of_planets.entry(side).or_default();
                own.push(found.clone());
            }
        } else if found.u_mm == [None, None] {
            component.leave_out(About::Lost, "on no shaft of the scene");
        } else {
            train.bearings.push(found);
        }
    }
    Ok(())
}

/// Puts the two sides of a bearing where they stand. Whether one is a shaft of the file that the scene does not have.
fn place(
    source: &Source<'_>,
    train: &Train,
    component: Part<'_>,
    own: Option<Frame>,
    found: &mut Bearing,
) -> bool {
    let mut on_shaft = false;
    for (id, u_mm) in found.sides.into_iter().zip(&mut found.u_mm) {
        let Some(shaft) = train.shaft(id) else {
            let part = source.part(id);
            let kind = part.map_or("", |c| &c.component.kind);
            on_shaft |= kind == "shaft";
            if !["shaft", "gear_casing", "gear_unit", ""].contains(&kind) {
                let what = format!("its part {kind} is not in the scene: taken as the ground");
                component.assume(About::Support, what);
            }
            if kind != "shaft" {
                *u_mm = None;
            }
            continue;
        };
        if u_mm.is_none() {
            let by_vector = own.and_then(|own| Some(shaft.frame?.u_of(own.origin_mm)));
            let (about, found) = match by_vector {
                Some(u) => (About::Small, format!("u = {u} mm, from its support vector")),
                None => (About::Place, "u = 0".to_owned()),
            };
            let what = format!("no place on {} given: {found}", shaft.name);
            component.assume(about, what);
            *u_mm = Some(by_vector.unwrap_or(0.0));
        }
    }
    on_shaft
}

fn couplings(
    source: &Source<'_>,
    train: &mut Train,
    names: &mut Names,
    shift_index: i64,
) -> Result<()> {
    let is_casing = |id: i64| {
        let component = source.part(id);
        component.is_some_and(|c| c.kind == "gear_casing")
    };
    for component in source.of_kind(&coupling::KINDS) {
        let name = names.unique(&component.name, component.id);
        let Some(mut found) = coupling::read(component, name, shift_index)? else {
            continue;
        };
        if found.sides.iter().any(|&id| train.gear(id).is_some()) {
            let what = "joins a gear to its shaft: the gear is fixed there, rigidly";
            component.assume(About::Stiffness, what);
            continue;
        }
        let [a, b] = found.sides;
        let braked = [(a, b, 0), (b, a, 1)].into_iter();
        let braked = braked.filter(|&(_, other, _)| is_casing(other));
        if let Some((shaft, _, side)) = { braked }.find(|&(id, ..)| train.shaft(id).is_some()) {
            let what = "engaged between a shaft and the casing: a brake, which carries the torque that the loads leave over; the shaft stands";
            component.assume(About::Nothing, what);
            let u_mm = found.u_mm[side].unwrap_or(0.0);
            let load = loads::brake(component.id, found.name, shaft, u_mm);
            train.loads.push(load);
            continue;
        }
        if found.sides.iter().any(|&id| train.shaft(id).is_none()) {
            let what = "does not join two shafts of the scene: nothing is held by it";
            component.leave_out(About::Lost, what);
            continue;
        }
        found.u_mm = found.u_mm.map(|u| Some(u.unwrap_or(0.0)));
        train.links.push(Link {
            shafts: found.sides,
            ratio: 1.0,
        });
        train.couplings.push(found);
    }
    Ok(())
}
