//! Where shafts stand, and gears on them.

use crate::error::RexsError;
use crate::ledger::About;
use crate::placement::{Frame, add, frame};
use crate::source::Source;
use crate::structure::Structure;
use crate::train::Train;
use crate::units::{DEG, MM};
use std::collections::BTreeMap;

/// Places of shafts without vectors, from those of their mates: centre distance and angle of the stage.
///
/// # Errors
/// Those of [`Source`].
pub fn place_shafts(
    source: &Source<'_>,
    structure: &Structure,
    train: &mut Train,
) -> Result<(), RexsError> {
    let stages = structure.stages();
    if let Some(first) = train.shafts.first_mut().filter(|s| s.frame.is_none()) {
        first.frame = Some(Frame::WORLD);
        if let Some(component) = source.model.component(first.id) {
            source.assume(
                component,
                About::Nothing,
                "no support_vector given: the origin, along x",
            );
        }
    }
    let mut has_news = true;
    while has_news {
        has_news = follow_hubs(train);
        for mesh in 0..train.meshes.len() {
            let gears = train.meshes[mesh].gears.map(|g| train.gears[g].clone());
            let frames = [0, 1].map(|i| train.shaft(gears[i].shaft).and_then(|s| s.frame));
            let (known, open) = match frames {
                [Some(known), None] => ((known, 0), 1),
                [None, Some(known)] => ((known, 1), 0),
                _ => continue,
            };
            let ids = [gears[0].gear.id, gears[1].gear.id];
            let stage = stages
                .iter()
                .find(|s| s.gears == ids)
                .and_then(|s| source.model.component(s.id));
            let Some(stage) = stage else { continue };
            let sum = gears[0].gear.reference_diameter_mm() + gears[1].gear.reference_diameter_mm();
            let distance = source
                .number(stage, "center_distance", MM)?
                .unwrap_or(0.5 * sum);
            let angle = source
                .number(stage, "rotating_angle_around_neg_u_axis", DEG)?
                .unwrap_or(0.0);
            // From gear 1 to gear 2: the w axis, turned about -u.
            let (sin, cos) = angle.to_radians().sin_cos();
            let (frame, from) = known;
            let towards = if from == 0 { 1.0 } else { -1.0 };
            let across = frame.direction([0.0, towards * distance * sin, towards * distance * cos]);
            let along = [from, open].map(|i| gears[i].mid_mm);
            let shift = if along.iter().all(|m| m.is_finite()) {
                along[0] - along[1]
            } else {
                0.0
            };
            let origin = add(add(frame.origin_mm, across, 1.0), frame.axes[0], shift);
            let id = gears[open].shaft;
            if let Some(shaft) = train.shaft_mut(id) {
                shaft.frame = Some(Frame {
                    origin_mm: origin,
                    axes: frame.axes,
                });
                has_news = true;
            }
            if let Some(component) = source.model.component(id) {
                source.assume(component, About::Place, format!("no support_vector given: {distance} mm from its mate at {angle} deg, faces in the middle of each other"));
            }
        }
        if !has_news && let Some(open) = train.shafts.iter_mut().find(|s| s.frame.is_none()) {
            open.frame = Some(Frame::WORLD);
            if let Some(component) = source.model.component(open.id) {
                source.assume(component, About::Place, "neither a support_vector nor a stage that tells its place: the origin, along x");
            }
            has_news = true;
        }
    }
    Ok(())
}

/// Hubs of loose gears stand where the shafts do that carry them, and the other way round.
fn follow_hubs(train: &mut Train) -> bool {
    let mut has_news = false;
    for i in 0..train.shafts.len() {
        let Some(carrier) = train.shafts[i].hub_on else {
            continue;
        };
        let known = train.shafts[i].frame;
        let Some(on) = train.shaft_mut(carrier) else {
            continue;
        };
        match (known, on.frame) {
            (Some(frame), None) => on.frame = Some(frame),
            (None, Some(frame)) => train.shafts[i].frame = Some(frame),
            _ => continue,
        }
        has_news = true;
    }
    has_news
}

/// Middles of the faces: programs write the start of the face or its middle as `u_coordinate_on_shaft`; the support vector is
/// the middle in all of them.
///
/// # Errors
/// Those of [`Source`].
pub fn settle_middles(source: &Source<'_>, train: &mut Train) -> Result<(), RexsError> {
    let frames: BTreeMap<i64, Frame> = train
        .shafts
        .iter()
        .filter_map(|s| Some((s.id, s.frame?)))
        .collect();
    let mut open = Vec::new();
    for (i, seated) in train.gears.iter_mut().enumerate() {
        let Some(component) = source.model.component(seated.gear.id) else {
            continue;
        };
        let own = frame(source, component)?;
        let by_vector = match (own, frames.get(&seated.shaft)) {
            (Some(own), Some(shaft)) => Some(shaft.u_of(own.origin_mm)),
            _ => None,
        };
        let half = 0.5 * seated.gear.face_width_mm;
        match by_vector {
            Some(u) if !seated.mid_mm.is_finite() => {
                source.assume(component, About::Nothing, format!("no u_coordinate_on_shaft given: the middle of the face stands at the support vector, u = {u:.4} mm"));
                seated.mid_mm = u;
            }
            Some(u) if (u - (seated.mid_mm - half)).abs() < 1e-3 && half > 1e-3 => {
                source.assume(component, About::Place, format!("u_coordinate_on_shaft of {u:.4} mm is the middle of the face, where its support vector stands, not its start"));
                seated.mid_mm = u;
            }
            Some(u) if (u - seated.mid_mm).abs() > 1e-2 => {
                source.assume(component, About::Place, format!("its support vector stands at u = {u:.4} mm of the shaft, its u_coordinate_on_shaft means {:.4} mm: the latter", seated.mid_mm));
            }
            _ => {}
        }
        if !seated.mid_mm.is_finite() {
            open.push(i);
        }
    }
    for i in open {
        let (mid_mm, words) = free_place(train, &frames, i);
        train.gears[i].mid_mm = mid_mm;
        if let Some(component) = source.model.component(train.gears[i].gear.id) {
            let what = format!(
                "no place on the shaft given: {words}, the middle of the face at u = {mid_mm:.4} mm"
            );
            source.assume(component, About::Place, what);
        }
    }
    Ok(())
}

/// A place for a gear that has none: beside its mate, else behind the other gears of its shaft, from u = 0 on.
fn free_place(train: &Train, frames: &BTreeMap<i64, Frame>, i: usize) -> (f64, &'static str) {
    let own = &train.gears[i];
    let mates = train.meshes.iter().filter(|m| m.gears.contains(&i));
    let mut known = mates.filter_map(|m| {
        let mate = &train.gears[m.gears[usize::from(m.gears[0] == i)]];
        let (there, here) = (frames.get(&mate.shaft)?, frames.get(&own.shaft)?);
        let point = there.point([mate.mid_mm, 0.0, 0.0]);
        mate.mid_mm.is_finite().then(|| here.u_of(point))
    });
    if let Some(u) = known.next() {
        return (u, "its face in the middle of its mate's");
    }
    let beside = train.gears.iter().filter(|g| g.shaft == own.shaft);
    let placed = beside.filter(|g| g.mid_mm.is_finite());
    let start = placed
        .map(|g| g.mid_mm + 0.5 * g.gear.face_width_mm)
        .fold(0.0, f64::max);
    let words = "its face behind those of the other gears there, or from u = 0 on";
    (start + 0.5 * own.gear.face_width_mm, words)
}
