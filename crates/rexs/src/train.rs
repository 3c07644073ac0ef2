//! Reads the gearbox of a model: shafts, gears, stages, what stands between parts, loads.

use crate::bearings_and_couplings::bearings_and_couplings;
use crate::bevel;
use crate::coupling;
use crate::cylindrical::Gear;
use crate::error::{Result, RexsError};
use crate::gear;
pub use crate::gearbox::{BevelSeat, Mesh, SeatedGear, TorqueSeat, Train};
use crate::ledger::About;
use crate::loads;
use crate::loose_gears::{self, Seat};
use crate::microgeometry;
use crate::placement::frame;
use crate::planetary;
use crate::planetary_set;
use crate::power_flow::Link;
use crate::shaft_sections;
use crate::source::{Part, Source};
use crate::structure::Stage;
use crate::supports::{hold, leave_out_bare};
use crate::text::{Names, file_stem};
use crate::train_finish::{finish_gears, finish_shafts, point_shafts_one_way};
use crate::train_places::{place_shafts, settle_middles};
use crate::train_power::power;
use crate::units::MM;
use std::collections::HashMap;

/// Reads the gearbox.
///
/// # Errors
/// Those of [`Part`], and what a gearbox cannot do without.
pub fn read(source: &Source<'_>, stem: &str) -> Result<Train> {
    let mut names = Names::default();
    let mut files = Names::default();
    let mut train = Train::default();
    for component in source.of_kind(&["shaft"]) {
        // Planets of the scene have no shafts.
        let role = source.structure.planetary_role(component.id);
        if role.is_some_and(|r| r != "planet_carrier_shaft") {
            continue;
        }
        let place = frame(component)?;
        let name = names.unique(&component.name, component.id);
        train
            .shafts
            .push(shaft_sections::read(component, name, place)?);
    }
    seat_gears(source, &mut train, &mut names, &mut files, stem)?;
    join_stages(source, &mut train, &mut names)?;
    place_shafts(source, &mut train)?;
    settle_middles(source, &mut train)?;
    bearings_and_couplings(source, &mut train, &mut names, &mut files)?;
    on_shafts(source, &mut train, &mut names)?;
    leave_out_bare(source, &mut train);
    point_shafts_one_way(&mut train);
    planetary::join(source, &mut train);
    hold(source, &mut train);
    finish_shafts(source, &mut train);
    finish_gears(source, &mut train);
    microgeometry::of_train(source, &mut train)?;
    planetary_set::tell_unlike_planets(source, &train);
    train.flow = power(source, &train);
    Ok(train)
}

fn seat_gears(
    source: &Source<'_>,
    train: &mut Train,
    names: &mut Names,
    files: &mut Names,
    stem: &str,
) -> Result<()> {
    for component in source.of_kind(&["worm_gear", "worm_wheel"]) {
        let what = format!("{}s have no model", component.kind.replace('_', " "));
        component.leave_out(About::Nothing, what);
    }
    let shift_index = coupling::shift_index(source)?;
    for component in source.of_kind(&["cylindrical_gear", "ring_gear"]) {
        let name = names.unique(&component.name, component.id);
        let file = files.unique(&format!("{stem}_{}", file_stem(&name)), component.id);
        let file = format!("{}.toml", file_stem(&file));
        let gear = match gear::read(component, name, file) {
            // Sets go without planets where files say little of their rings.
            Err(error @ RexsError::Missing { .. }) if component.kind == "ring_gear" => {
                component.leave_out(About::Lost, error.to_string());
                continue;
            }
            read => read?,
        };
        // Rings are seated with their planetary stage.
        let seat = (!gear.internal)
            .then(|| loose_gears::seat(train, component, shift_index))
            .flatten();
        let start = component.number("u_coordinate_on_shaft", MM)?;
        let shaft = match seat {
            Some(Seat::Fixed(id)) => id,
            Some(Seat::Loose(id)) => {
                let carrier = train.shaft(id);
                let hub = carrier.map(|s| s.hub(component.id, &gear.name));
                hub.into_iter().for_each(|hub| train.shafts.push(hub));
                component.id
            }
            None => -1,
        };
        let mid_mm = start.map_or(f64::NAN, |u| u + 0.5 * gear.face_width_mm);
        // A gear that sits on nothing is a file all the same.
        train.gears.push(SeatedGear {
            gear,
            shaft,
            mid_mm,
        });
    }
    Ok(())
}

fn join_stages(source: &Source<'_>, train: &mut Train, names: &mut Names) -> Result<()> {
    let mut pairs: HashMap<[usize; 2], usize> = HashMap::new();
    for &Stage { id, gears } in source.structure.stages() {
        let [Some(stage), Some(g1), Some(g2)] = [id, gears[0], gears[1]].map(|id| source.part(id))
        else {
            continue;
        };
        match stage.kind.as_str() {
            "cylindrical_stage" => {
                let mates = (stage, [g1, g2]);
                join_cylindrical((train, &mut pairs), names, mates)?;
            }
            "bevel_stage" => bevel_stage(train, stage, [g1, g2])?,
            _ => stage.leave_out(
                About::Lost,
                format!(
                    "{}s have no model in scenes: speeds and torques do not pass",
                    stage.kind.replace('_', " ")
                ),
            ),
        }
    }
    Ok(())
}

/// Joins two gears of the scene, once.
fn join_cylindrical(
    (train, pairs): (&mut Train, &mut HashMap<[usize; 2], usize>),
    names: &mut Names,
    (stage, gears): (Part<'_>, [Part<'_>; 2]),
) -> Result<()> {
    let place = |gear: Part<'_>| {
        let place = train.gears.place(gear.id);
        place.filter(|&place| train.gears[place].shaft >= 0)
    };
    let [Some(a), Some(b)] = gears.map(place) else {
        // Stages of planets are reported with the planetary stage.
        let planetary = stage.partners(&["planetary_stage"]);
        if planetary.is_empty() {
            let [g1, g2] = gears.map(|gear| gear.words());
            let what = format!("between {g1} and {g2}, of which the scene does not have both");
            stage.leave_out(About::Lost, what);
        }
        return Ok(());
    };
    if let Some(&first) = pairs.get(&[a.min(b), a.max(b)]) {
        let name = &train.meshes[first].name;
        let what = format!("its gears are in mesh already in {name}");
        stage.leave_out(About::Nothing, what);
        return Ok(());
    }
    let [first, second] = [&train.gears[a], &train.gears[b]];
    demand_mates(stage, [&first.gear, &second.gear])?;
    train.links.push(Link {
        shafts: [first.shaft, second.shaft],
        ratio: -f64::from(first.gear.teeth) / f64::from(second.gear.teeth),
    });
    pairs.insert([a.min(b), a.max(b)], train.meshes.len());
    train.meshes.push(Mesh {
        stage: stage.id,
        name: names.unique(stage.name_or("stage"), stage.id),
        gears: [a, b],
        link: train.links.len() - 1,
    });
    Ok(())
}

fn demand_mates(stage: Part<'_>, [a, b]: [&Gear; 2]) -> Result<()> {
    let angles = [a, b].map(|gear| gear.pressure_angle_deg);
    let modules = [a, b].map(|gear| gear.module_mm);
    let helices = [a, b].map(|gear| gear.helix_deg);
    let words = "helix angles (which must be opposite)";
    for (what, [x, y], off, most) in [
        ("modules", modules, modules[0] - modules[1], modules[0]),
        (words, helices, helices[0] + helices[1], 1.0),
        ("pressure angles", angles, angles[0] - angles[1], 1.0),
    ] {
        if off.abs() > 1e-6 * most {
            let names = format!("{what} of {} and {}", a.name, b.name);
            return Err(stage.lacks(format!("{names} do not go together: {x} and {y}")));
        }
    }
    Ok(())
}

fn bevel_stage(train: &mut Train, stage: Part<'_>, gears: [Part<'_>; 2]) -> Result<()> {
    let teeth = [bevel::teeth(gears[0])?, bevel::teeth(gears[1])?];
    let mut seats = Vec::new();
    let mut sense = 1.0;
    for gear in gears {
        let Some(shaft) = train.shaft_at(gear) else {
            continue;
        };
        // The apex at +u turns the cone round.
        // Version 1.0 has a whole number for it.
        let orientation = gear.text("bevel_cone_orientation").unwrap_or_default();
        if ["positive", "1", "+1", "1.0"].contains(&orientation.as_str()) {
            sense = -sense;
        }
        let start = gear.number("u_coordinate_on_shaft", MM)?.unwrap_or(0.0);
        let width = gear.number("face_width", MM)?.unwrap_or(0.0);
        seats.push((gear.id, shaft, start + 0.5 * width, gear.name.clone()));
    }
    let [(_, a, ..), (_, b, ..)] = seats.as_slice() else {
        stage.leave_out(About::Lost, "its gears sit on no shafts of the scene");
        return Ok(());
    };
    // Equal speeds of the pitch cones in their common line, seen from apex to heel.
    train.links.push(Link {
        shafts: [*a, *b],
        ratio: -sense * teeth[0] as f64 / teeth[1] as f64,
    });
    let link = train.links.len() - 1;
    let found = bevel::read(stage, gears)?;
    for (side, (gear, shaft, u_mm, name)) in seats.into_iter().enumerate() {
        let seat = TorqueSeat {
            shaft,
            u_mm,
            link: (link, side),
            name,
        };
        let stage = found.clone();
        train.bevels.push(BevelSeat { gear, seat, stage });
    }
    Ok(())
}

fn on_shafts(source: &Source<'_>, train: &mut Train, names: &mut Names) -> Result<()> {
    for component in source.of_kind(&["external_load", "additional_mass"]) {
        let Some(shaft) = train.shaft_at(component) else {
            component.leave_out(About::Lost, "on no shaft of the scene");
            continue;
        };
        if component.kind == "external_load" {
            let name = names.unique(&component.name, component.id);
            train.loads.push(loads::read(component, name, shaft)?);
        } else if let Some(mass) = loads::added_mass(component, shaft)? {
            train.masses.push(mass);
        }
    }
    Ok(())
}
