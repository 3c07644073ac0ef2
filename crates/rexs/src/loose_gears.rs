//! Gears that turn loose on their shafts: idlers on bearings, and gears of gearboxes with several speeds whose clutch
//! is open. Each has a shaft of its own in the train, its hub, along the line of the shaft that carries it; in the
//! scene this is the gear's body.

use crate::bearing::{self, AxialSupport, Bearing};
use crate::coupling;
use crate::gearbox::Train;
use crate::ledger::About;
use crate::source::{Part, Source};

/// Where a gear sits.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Seat {
    /// Fixed to a shaft.
    Fixed(i64),
    /// Loose on a shaft.
    Loose(i64),
}

/// The other side of a component that stands between a gear and a shaft of the scene.
fn other_side(train: &Train, between: Part<'_>, gear: i64) -> Option<i64> {
    let sides = between.sides()?;
    let own = sides.iter().position(|&side| side == gear)?;
    let other = sides[1 - own];
    train.shaft(other).map(|_| other)
}

/// The shaft on which a gear sits, and whether it turns loose on it: all clutches between the two are open, or there
/// are bearings between them and nothing else that joins them.
pub fn seat(train: &Train, gear: Part<'_>, shift_index: i64) -> Option<Seat> {
    let between = |kinds: &[&str]| -> Vec<(Part<'_>, i64)> {
        gear.parts(kinds)
            .filter_map(|c| Some((c, other_side(train, c, gear.id)?)))
            .collect()
    };
    let couplings = between(&coupling::KINDS);
    let is_open = |c: &Part<'_>| coupling::is_open(*c, shift_index);
    if let Some((_, shaft)) = couplings.iter().find(|(c, _)| !is_open(c)) {
        return Some(Seat::Fixed(*shaft));
    }
    let shaft = train.shaft_at(gear)?;
    let is_joined = !between(&coupling::JOINTS).is_empty();
    let has_bearing = !between(&bearing::KINDS).is_empty();
    let is_loose = !couplings.is_empty() || (has_bearing && !is_joined);
    Some(if is_loose {
        Seat::Loose(shaft)
    } else {
        Seat::Fixed(shaft)
    })
}

/// Bearings between a shaft and a gear: on the hub of one that turns loose, at the same place as on the shaft where
/// none is given. False for a bearing inside of a gear that is fixed to the shaft, which carries nothing.
pub fn stand_on_hubs(
    train: &Train,
    component: Part<'_>,
    sides: &mut [i64; 2],
    u_mm: &mut [Option<f64>; 2],
) -> bool {
    for side in 0..2 {
        let own = sides[side];
        let Some(gear) = train.gear(own) else {
            continue;
        };
        if gear.shaft == sides[1 - side] {
            let what = "between a shaft and a gear that is fixed to it: carries nothing";
            component.leave_out(About::Small, what);
            return false;
        }
        sides[side] = gear.shaft;
        u_mm[side] = u_mm[side].or(u_mm[1 - side]);
    }
    true
}

/// Hubs without bearings are held on their shafts, free about the axis; those with one of them do not tilt on it.
pub fn hold_hubs(source: &Source<'_>, train: &mut Train) {
    let on = train.bearings_of();
    for i in 0..train.gears.len() {
        let seated = &train.gears[i];
        let (id, mid_mm, name) = (seated.gear.id, seated.mid_mm, seated.gear.name.clone());
        let Some(carrier) = train.shaft(id).and_then(|hub| hub.hub_on) else {
            continue;
        };
        let carries = train
            .shaft(carrier)
            .map_or(String::new(), |s| s.name.clone());
        let radial = |i: &usize| train.bearings[*i].radial_n_per_mm > 0.0;
        let mine = on.get(&id).into_iter().flatten().copied();
        let mine: Vec<usize> = mine.filter(radial).collect();
        let is_bare = mine.is_empty();
        let words = match mine[..] {
            [] => "nothing else holds it there: rigid across and along the axis, free about it",
            [only] if train.bearings[only].tilt_nm_per_rad == 0.0 => {
                train.bearings[only].tilt_nm_per_rad = bearing::RIGID_TILT;
                "its one bearing there holds it against tilting, too"
            }
            _ => "on its bearings there",
        };
        let what = format!("turns loose on {carries}: {words}");
        source.assume_of(id, About::Support, what);
        if is_bare {
            let sides = [carrier, id];
            let name = format!("{name} on {carries}");
            let mut held = Bearing::rigid(id, name, sides, mid_mm, AxialSupport::Both);
            held.u_mm[1] = Some(mid_mm);
            held.tilt_nm_per_rad = bearing::RIGID_TILT;
            train.bearings.push(held);
        }
    }
}
