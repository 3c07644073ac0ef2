//! Shafts that nothing holds: files of teeth alone have no bearings, pins and carriers of planetary stages stand on
//! parts that scenes do not have.

use crate::bearing::{self, AxialSupport, Bearing};
use crate::coupling::RIGID;
use crate::gearbox::Train;
use crate::ledger::About;
use crate::source::Source;
use std::collections::{HashMap, HashSet};

/// No component: the ground.
const GROUND: i64 = i64::MIN;

/// Leaves out shafts on which nothing stands: no gear, bearing, coupling, load or mass of the scene.
pub fn leave_out_bare(source: &Source<'_>, train: &mut Train) {
    let mut used: HashSet<i64> = HashSet::new();
    used.extend(train.gears.iter().map(|g| g.shaft));
    used.extend(train.bevels.iter().map(|b| b.seat.shaft));
    // A brake alone holds nothing that turns.
    let loads = train.loads.iter().filter(|l| !l.is_brake);
    used.extend(loads.map(|l| l.shaft));
    used.extend(train.masses.iter().map(|m| m.shaft));
    used.extend(train.bearings.iter().flat_map(|b| b.sides));
    used.extend(train.couplings.iter().flat_map(|c| c.sides));
    let bare = train.shafts.iter().filter(|s| !used.contains(&s.id));
    for component in bare.filter_map(|s| source.part(s.id)) {
        let what =
            "no gear, bearing, coupling, load or mass of the scene stands on it: not in the scene";
        component.leave_out(About::Nothing, what);
    }
    train.shafts.retain(|s| used.contains(&s.id));
    train.loads.retain(|l| used.contains(&l.shaft));
}

/// Bearings nearer to each other than this stand at one place \[mm\].
const SAME_PLACE_MM: f64 = 0.1;

/// Couplings of which the file says nothing hold shafts that lack bearings, and shafts that nothing holds across their
/// axis are held at both ends.
pub fn hold(source: &Source<'_>, train: &mut Train) {
    let bearings = train.bearings.clone();
    let carriers = train.shafts.iter();
    let hubs: HashMap<i64, i64> = carriers.filter_map(|s| Some((s.id, s.hub_on?))).collect();
    let on = train.bearings_of();
    let places = |shaft: i64| -> usize {
        // What a shaft carries does not hold it.
        let carries = |b: &&Bearing| b.sides.iter().any(|side| hubs.get(side) == Some(&shaft));
        let mine = on.get(&shaft).into_iter().flatten().map(|&i| &bearings[i]);
        let mine = mine.filter(|b| !carries(b));
        let radial: Vec<&Bearing> = mine.filter(|b| b.radial_n_per_mm > 0.0).collect();
        if radial.iter().any(|b| b.tilt_nm_per_rad > 0.0) {
            return 2;
        }
        let place = |b: &&Bearing| b.u_mm[usize::from(b.sides[0] != shaft)].unwrap_or(0.0);
        let mut places: Vec<f64> = radial.iter().map(place).collect();
        places.sort_by(f64::total_cmp);
        // Two bearings at one place do not keep a shaft from tilting.
        places.dedup_by(|a, b| (*a - *b).abs() < SAME_PLACE_MM);
        places.len()
    };
    for coupling in &mut train.couplings {
        if coupling.is_bare && coupling.sides.iter().any(|&shaft| places(shaft) < 2) {
            coupling.stiffness = RIGID;
            let what = "no stiffness given, and a shaft at it has not two bearings of its own: rigid in all directions";
            source.assume_of(coupling.id, About::Stiffness, what);
        }
    }
    let couplings = train.couplings.iter();
    let holding = couplings.filter(|c| c.stiffness[1] > 0.0);
    let held: HashSet<i64> = holding.flat_map(|c| c.sides).collect();
    let gears_of = train.gears_of();
    for i in 0..train.shafts.len() {
        let shaft = &train.shafts[i];
        let (id, name) = (shaft.id, shaft.name.clone());
        let count = places(id);
        if count > 1 || held.contains(&id) || shaft.hub_on.is_some() {
            continue;
        }
        if count == 1 {
            let radial = |i: &&usize| bearings[**i].radial_n_per_mm > 0.0;
            let only = on.get(&id).into_iter().flatten().find(radial);
            if let Some(only) = only.map(|&i| &mut train.bearings[i]) {
                only.tilt_nm_per_rad = bearing::RIGID_TILT;
                let what = format!(
                    "the only place that holds {name} across its axis: the bearing holds the shaft against tilting, too, by {:e} N m/rad",
                    bearing::RIGID_TILT
                );
                source.assume_of(only.id, About::Support, what);
            }
            continue;
        }
        let [start, end] = ends(train, i, &gears_of);
        for (k, u) in [start, end].into_iter().enumerate() {
            train.bearings.push(Bearing::rigid(
                id,
                format!("{name} held {}", k + 1),
                [id, GROUND],
                u,
                if k == 0 {
                    AxialSupport::Both
                } else {
                    AxialSupport::None
                },
            ));
        }
        let what = format!(
            "no bearing and no coupling holds it across its axis: held at u = {start} and {end} mm by {:e} N/mm, along the axis at the first",
            bearing::RIGID
        );
        source.assume_of(id, About::Support, what);
    }
}

/// Both ends of a shaft; without sections a face width beyond its gears \[mm\].
fn ends(train: &Train, shaft: usize, gears_of: &HashMap<i64, Vec<usize>>) -> [f64; 2] {
    let shaft = &train.shafts[shaft];
    let stated = shaft.ends_mm();
    if stated[0] < stated[1] {
        return stated;
    }
    let gears = gears_of.get(&shaft.id).into_iter().flatten();
    let gears = gears.map(|&i| &train.gears[i]);
    let reach = gears.map(|g| (g.mid_mm, g.gear.face_width_mm));
    let [start, end] = reach.fold([f64::MAX, f64::MIN], |[a, b], (mid, width)| {
        [a.min(mid - width), b.max(mid + width)]
    });
    if start < end {
        [start, end]
    } else {
        [0.0, 100.0]
    }
}
