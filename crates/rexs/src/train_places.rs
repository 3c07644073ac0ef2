//! Where shafts stand, and gears on them.

use crate::by_number::grouped;
use crate::error::Result;
use crate::gearbox::Train;
use crate::ledger::About;
use crate::placement::frame;
use crate::source::{Part, Source};
use crate::units::{DEG, MM};
use crate::vectors::{Frame, add};
use std::collections::{BTreeMap, HashMap, VecDeque};

/// Places of shafts without vectors, from those of their mates: centre distance and angle of the stage.
///
/// # Errors
/// Those of [`Part`].
pub fn place_shafts(source: &Source<'_>, train: &mut Train) -> Result<()> {
    let stages: HashMap<[i64; 2], i64> = (source.structure.stages().iter().rev())
        .map(|s| (s.gears, s.id))
        .collect();
    if let Some(first) = train.shafts.first_mut().filter(|s| s.frame.is_none()) {
        first.frame = Some(Frame::WORLD);
        let what = "no support_vector given: the origin, along x";
        source.assume_of(first.id, About::Nothing, what);
    }
    let meshes_of: HashMap<i64, Vec<usize>> =
        grouped((train.meshes_of_gears()).map(|(gear, mesh)| (train.gears[gear].shaft, mesh)));
    let hubs_of: HashMap<i64, Vec<i64>> =
        grouped(train.shafts.iter().filter_map(|s| Some((s.hub_on?, s.id))));
    let known = train.shafts.iter().filter(|s| s.frame.is_some());
    let mut queue: VecDeque<i64> = known.map(|s| s.id).collect();
    let mut open = 0;
    loop {
        let Some(placed) = queue.pop_front() else {
            // The next one of which nothing tells a place.
            let rest = &mut train.shafts[open..];
            let Some(next) = rest.iter().position(|s| s.frame.is_none()) else {
                return Ok(());
            };
            open += next;
            train.shafts[open].frame = Some(Frame::WORLD);
            let id = train.shafts[open].id;
            queue.push_back(id);
            let what =
                "neither a support_vector nor a stage that tells its place: the origin, along x";
            source.assume_of(id, About::Place, what);
            continue;
        };
        follow_hubs(train, &hubs_of, placed, &mut queue);
        for &mesh in meshes_of.get(&placed).into_iter().flatten() {
            let gears = train.meshes[mesh].gears;
            let ids = gears.map(|g| train.gears[g].gear.id);
            let stage = stages.get(&ids).and_then(|&id| source.part(id));
            if let Some(stage) = stage {
                queue.extend(place_mate(source, train, stage, gears)?);
            }
        }
    }
}

/// Places the shaft of one gear of a stage by that of the other, where one of them alone has a place.
fn place_mate(
    source: &Source<'_>,
    train: &mut Train,
    stage: Part<'_>,
    gears: [usize; 2],
) -> Result<Option<i64>> {
    let gears = gears.map(|g| &train.gears[g]);
    let (frame, from) = match gears.map(|g| train.shaft(g.shaft).and_then(|s| s.frame)) {
        [Some(known), None] => (known, 0),
        [None, Some(known)] => (known, 1),
        _ => return Ok(None),
    };
    let sum = gears[0].gear.reference_diameter_mm() + gears[1].gear.reference_diameter_mm();
    let distance = stage.number("center_distance", MM)?;
    let distance = distance.unwrap_or(0.5 * sum);
    let angle = stage.number("rotating_angle_around_neg_u_axis", DEG)?;
    let angle = angle.unwrap_or(0.0);
    // From gear 1 to gear 2: the w axis, turned about -u.
    let (sin, cos) = angle.to_radians().sin_cos();
    let towards = if from == 0 { 1.0 } else { -1.0 };
    let across = frame.direction([0.0, towards * distance * sin, towards * distance * cos]);
    let along = [from, 1 - from].map(|i| gears[i].mid_mm);
    let shift = if along.iter().all(|m| m.is_finite()) {
        along[0] - along[1]
    } else {
        0.0
    };
    let origin_mm = add(add(frame.origin_mm, across, 1.0), frame.axes[0], shift);
    let id = gears[1 - from].shaft;
    let placed = train.shaft_mut(id).map(|shaft| {
        let axes = frame.axes;
        shaft.frame = Some(Frame { origin_mm, axes });
        id
    });
    let what = format!(
        "no support_vector given: {distance} mm from its mate at {angle} deg, faces in the middle of each other"
    );
    source.assume_of(id, About::Place, what);
    Ok(placed)
}

/// Hubs of loose gears stand where the shafts do that carry them, and the other way round.
fn follow_hubs(
    train: &mut Train,
    hubs_of: &HashMap<i64, Vec<i64>>,
    placed: i64,
    queue: &mut VecDeque<i64>,
) {
    let Some(shaft) = train.shaft(placed) else {
        return;
    };
    let frame = shaft.frame;
    let others = hubs_of.get(&placed).into_iter().flatten().copied();
    for other in others.chain(shaft.hub_on).collect::<Vec<_>>() {
        if let Some(other) = train.shaft_mut(other).filter(|s| s.frame.is_none()) {
            other.frame = frame;
            queue.push_back(other.id);
        }
    }
}

/// Middles of the faces: programs write the start of the face or its middle as `u_coordinate_on_shaft`; the support
/// vector is the middle in all of them.
///
/// # Errors
/// Those of [`Part`].
pub fn settle_middles(source: &Source<'_>, train: &mut Train) -> Result<()> {
    let frames: BTreeMap<i64, Frame> = train
        .shafts
        .iter()
        .filter_map(|s| Some((s.id, s.frame?)))
        .collect();
    let mut open = Vec::new();
    for (i, seated) in train.gears.iter_mut().enumerate() {
        let Some(component) = source.part(seated.gear.id) else {
            continue;
        };
        let own = frame(component)?;
        let by_vector = match (own, frames.get(&seated.shaft)) {
            (Some(own), Some(shaft)) => Some(shaft.u_of(own.origin_mm)),
            _ => None,
        };
        let half = 0.5 * seated.gear.face_width_mm;
        match by_vector {
            Some(u) if !seated.mid_mm.is_finite() => {
                component.assume(About::Nothing, format!("no u_coordinate_on_shaft given: the middle of the face stands at the support vector, u = {u:.4} mm"));
                seated.mid_mm = u;
            }
            Some(u) if (u - (seated.mid_mm - half)).abs() < 1e-3 && half > 1e-3 => {
                component.assume(About::Place, format!("u_coordinate_on_shaft of {u:.4} mm is the middle of the face, where its support vector stands, not its start"));
                seated.mid_mm = u;
            }
            Some(u) if (u - seated.mid_mm).abs() > 1e-2 => {
                component.assume(About::Place, format!("its support vector stands at u = {u:.4} mm of the shaft, its u_coordinate_on_shaft means {:.4} mm: the latter", seated.mid_mm));
            }
            _ => {}
        }
        if !seated.mid_mm.is_finite() {
            open.push(i);
        }
    }
    let mut ends: HashMap<i64, f64> = HashMap::new();
    for seated in train.gears.iter().filter(|g| g.mid_mm.is_finite()) {
        let end = ends.entry(seated.shaft).or_insert(0.0);
        *end = end.max(seated.mid_mm + 0.5 * seated.gear.face_width_mm);
    }
    let meshes_of: HashMap<usize, Vec<usize>> = grouped(train.meshes_of_gears());
    for i in open {
        let mine = meshes_of.get(&i).map_or(&[][..], Vec::as_slice);
        let end = ends.entry(train.gears[i].shaft).or_insert(0.0);
        let (mid_mm, words) = free_place(train, &frames, i, mine, *end);
        *end = end.max(mid_mm + 0.5 * train.gears[i].gear.face_width_mm);
        train.gears[i].mid_mm = mid_mm;
        let what = format!(
            "no place on the shaft given: {words}, the middle of the face at u = {mid_mm:.4} mm"
        );
        source.assume_of(train.gears[i].gear.id, About::Place, what);
    }
    Ok(())
}

/// A place for a gear that has none: beside its mate, else behind the other gears of its shaft, from u = 0 on.
fn free_place(
    train: &Train,
    frames: &BTreeMap<i64, Frame>,
    i: usize,
    meshes: &[usize],
    end_mm: f64,
) -> (f64, &'static str) {
    let own = &train.gears[i];
    let mut known = meshes.iter().filter_map(|&mesh| {
        let gears = train.meshes[mesh].gears;
        let mate = &train.gears[gears[usize::from(gears[0] == i)]];
        let (there, here) = (frames.get(&mate.shaft)?, frames.get(&own.shaft)?);
        let point = there.point([mate.mid_mm, 0.0, 0.0]);
        mate.mid_mm.is_finite().then(|| here.u_of(point))
    });
    if let Some(u) = known.next() {
        return (u, "its face in the middle of its mate's");
    }
    let words = "its face behind those of the other gears there, or from u = 0 on";
    (end_mm + 0.5 * own.gear.face_width_mm, words)
}
