//! What follows once all parts of a gearbox are read: stations, one direction for parallel shafts, tips, bores.

use crate::backlash;
use crate::by_number::grouped;
use crate::gearbox::{Mesh, SeatedGear, Train};
use crate::ledger::About;
use crate::shaft::Shaft;
use crate::shaft_sections::demand_sections;
use crate::source::Source;
use crate::units::MM;
use crate::vectors::{Frame, dot};
use std::collections::{HashMap, HashSet};

/// Directions that differ by an angle whose cosine is less than this from 1 are one line.
const SAME_LINE: f64 = 1e-6;

/// Size of the cells in which lines are looked for: more than the distance √(2·[`SAME_LINE`]) of the ends of such
/// directions.
const CELL: f64 = 2e-3;

/// Directions in the order in which they came, by the cell of their end.
#[derive(Default)]
struct Lines {
    directions: Vec<[f64; 3]>,
    in_cell: HashMap<[i64; 3], Vec<usize>>,
}

impl Lines {
    /// The first direction along the same line, either way; the given one, which is kept, where there is none before
    /// it.
    fn first_along(&mut self, direction: [f64; 3]) -> [f64; 3] {
        let cell = |d: [f64; 3]| d.map(|x| (x / CELL).floor() as i64);
        let mut first: Option<usize> = None;
        for way in [1.0, -1.0] {
            let [x, y, z] = cell(direction.map(|d| way * d));
            for near in 0..27 {
                let at = [x + near % 3 - 1, y + near / 3 % 3 - 1, z + near / 9 - 1];
                let known = self.in_cell.get(&at).into_iter().flatten().copied();
                let along =
                    known.filter(|&i| dot(self.directions[i], direction).abs() > 1.0 - SAME_LINE);
                first = first.into_iter().chain(along).min();
            }
        }
        if let Some(first) = first {
            return self.directions[first];
        }
        let own = self.in_cell.entry(cell(direction)).or_default();
        own.push(self.directions.len());
        self.directions.push(direction);
        direction
    }
}

/// One direction for all shafts of parallel axes: against the first one along the same line, z runs against u.
pub fn point_shafts_one_way(train: &mut Train) {
    let mut lines = Lines::default();
    for shaft in train.shafts.iter_mut() {
        let direction = shaft.frame.map_or([1.0, 0.0, 0.0], |f| f.axes[0]);
        shaft.is_reversed = dot(lines.first_along(direction), direction) < 0.0;
    }
}

/// Stations where something stands.
pub fn finish_shafts(source: &Source<'_>, train: &mut Train) {
    let mut marks: Vec<(i64, f64)> = Vec::new();
    marks.extend(train.gears.iter().map(|g| (g.shaft, g.mid_mm)));
    marks.extend(train.loads.iter().map(|l| (l.shaft, l.u_mm)));
    marks.extend(train.masses.iter().map(|m| (m.shaft, m.u_mm)));
    marks.extend(train.torque_seats().map(|t| (t.shaft, t.u_mm)));
    marks.extend(train.sets.iter().flat_map(|s| s.carriers.iter().copied()));
    let bearings = train.bearings.iter();
    let couplings = train.couplings.iter().map(|c| (c.sides, c.u_mm));
    for (sides, places) in bearings.clone().map(|b| (b.sides, b.u_mm)).chain(couplings) {
        let both = sides.into_iter().zip(places);
        marks.extend(both.filter_map(|(id, u)| Some((id, u?))));
    }
    let marks_of: HashMap<i64, Vec<f64>> = grouped(marks);
    let bores_of = grouped(bearings.filter_map(|b| Some((b.sides[0], b.bore_mm?))));
    let gears_of = train.gears_of();
    for shaft in train.shafts.iter_mut() {
        let id = shaft.id;
        for &u in marks_of.get(&id).into_iter().flatten() {
            shaft.mark(u);
        }
        for &gear in gears_of.get(&id).into_iter().flatten() {
            let seated = &train.gears[gear];
            shaft.seat(seated.mid_mm, &seated.gear.name);
        }
        if shaft.hub_on.is_some() {
            continue;
        }
        if let Some(component) = source.part(shaft.id) {
            let mine = bores_of.get(&shaft.id).map_or(&[][..], Vec::as_slice);
            demand_sections(component, shaft, mine);
        }
    }
    // Ratios are between speeds about z.
    let sign = |id: i64| train.shaft(id).map_or(1.0, Shaft::sign);
    let bevel_links: HashSet<usize> = train.bevels.iter().map(|b| b.seat.link.0).collect();
    let signs: Vec<f64> = train
        .links
        .iter()
        .map(|l| sign(l.shafts[0]) * sign(l.shafts[1]))
        .collect();
    for (i, link) in train.links.iter_mut().enumerate() {
        // Those of cylindrical stages are so already: their shafts are parallel, z along z.
        if bevel_links.contains(&i) {
            link.ratio *= signs[i];
        }
    }
}

/// Tips that clear the mates' roots, backlash, and bores.
pub fn finish_gears(source: &Source<'_>, train: &mut Train) {
    for set in &train.sets {
        for pair in [[set.sun, set.planet], [set.planet, set.ring]] {
            backlash::give(source, &mut train.gears, pair, set.distance_mm);
        }
    }
    for mesh in &train.meshes {
        let [a, b] = mesh.gears;
        let on = |i: usize| train.shaft(train.gears[i].shaft);
        let frames = [a, b].map(|i| on(i).and_then(|s| s.frame));
        let [Some(fa), Some(fb)] = frames else {
            continue;
        };
        let distance = fa.from_axis_mm(fb.origin_mm);
        told_distance(source, mesh, distance);
        told_apart(source, mesh, [&train.gears[a], &train.gears[b]], [fa, fb]);
        let [ga, gb] = [&train.gears[a].gear, &train.gears[b].gear];
        let reference = 0.5 * (ga.reference_diameter_mm() + gb.reference_diameter_mm());
        let module = ga.module_mm;
        let k = (distance - reference) / module - ga.profile_shift - gb.profile_shift;
        backlash::give(source, &mut train.gears, [a, b], distance);
        for i in [a, b] {
            let gear = &mut train.gears[i].gear;
            if gear.tip_diameter_mm.is_some() {
                continue;
            }
            let Some(component) = source.part(gear.id) else {
                continue;
            };
            // Adding 0 makes 0 of -0, and rounding is no shortening.
            let k = if k.abs() < 1e-6 {
                0.0
            } else {
                k.clamp(-0.5, 0.0)
            };
            let tip = gear.reference_diameter_mm()
                + 2.0 * module * (gear.addendum + gear.profile_shift + k);
            component.assume(About::Teeth, format!("tip diameter not given or not possible: {tip:.4} mm, addendum {} modules, shortened by {:.4} modules for the clearance at this centre distance", gear.addendum, k.abs()));
            gear.tip_diameter_mm = Some(tip);
        }
    }
    bores(source, train);
}

/// Says so where the stage states another centre distance than its shafts have.
fn told_distance(source: &Source<'_>, mesh: &Mesh, distance_mm: f64) {
    let Some(stage) = source.part(mesh.stage) else {
        return;
    };
    let Ok(Some(stated)) = stage.number("center_distance", MM) else {
        return;
    };
    let off = (stated.abs() - distance_mm).abs() / distance_mm;
    if off > 1e-4 {
        // d tan alpha_w = da/(a sin alpha_w cos alpha_w): at 20 deg a thousandth of the distance is 0.9 % of the radial
        // force.
        let about = About::by(off > 1e-3, About::Place);
        stage.assume(about, format!("center_distance is {stated} mm, but the shafts stand {distance_mm:.4} mm apart: as the shafts stand"));
    }
}

/// Says so where the axes of mates are not parallel, or their faces do not overlap: the scene refuses such meshes by
/// its own names.
fn told_apart(source: &Source<'_>, mesh: &Mesh, gears: [&SeatedGear; 2], frames: [Frame; 2]) {
    let Some(stage) = source.part(mesh.stage) else {
        return;
    };
    let [a, b] = gears;
    let names = format!("{} and {}", a.gear.name, b.gear.name);
    let cosine = dot(frames[0].axes[0], frames[1].axes[0]).abs();
    if cosine < 1.0 - 1e-5 {
        let angle = cosine.min(1.0).acos().to_degrees();
        stage.leave_out(About::Lost, format!("the axes of {names} stand {angle:.3} deg from parallel: the scene will refuse this mesh; mend u_axis_vector of their shafts"));
        return;
    }
    let there = frames[1].point([b.mid_mm, 0.0, 0.0]);
    let offset = (frames[0].u_of(there) - a.mid_mm).abs();
    let reach = 0.5 * (a.gear.face_width_mm + b.gear.face_width_mm);
    if offset >= reach {
        stage.leave_out(About::Lost, format!("the middles of the faces of {names} stand {offset:.3} mm apart along the axis, they overlap below {reach:.3} mm: the scene will refuse this mesh; mend u_coordinate_on_shaft or support_vector"));
    }
}

/// Thinnest shaft that holds a gear cut into it, over the gear's root: what gear files allow.
const LEAST_END: f64 = 0.1;

/// Bores, and gears that are cut into their shafts.
fn bores(source: &Source<'_>, train: &mut Train) {
    for i in 0..train.gears.len() {
        let seated = &mut train.gears[i];
        let gear = &mut seated.gear;
        if gear.internal {
            continue;
        }
        let Some(component) = source.part(gear.id) else {
            continue;
        };
        let on = |id: i64| train.shafts.place(id);
        let place = on(seated.shaft);
        // A gear that turns loose is as wide inside as the shaft that carries it.
        let carrier = place.and_then(|i| train.shafts[i].hub_on).map_or(place, on);
        let outer = carrier.map_or(0.0, |i| train.shafts[i].diameters_mm(seated.mid_mm)[0]);
        let is_hub = carrier != place;
        let mut shaft = place.map(|i| &mut train.shafts[i]);
        let most = gear.root_diameter_mm() - 3.0 * gear.module_mm;
        let wanted = gear.bore_mm.unwrap_or(outer);
        if wanted > 0.0 && wanted <= most {
            if gear.bore_mm.is_none() {
                let what = format!("bore {wanted} mm, the diameter of its shaft");
                component.assume(About::Blank, what);
            }
            gear.bore_mm = Some(wanted);
            continue;
        }
        let root = gear.root_diameter_mm();
        let half = 0.5 * gear.face_width_mm;
        if let Some(shaft) = shaft.as_mut().filter(|_| !is_hub) {
            // Just beyond each face, along z; a millimetre is no shaft's length.
            let ends = [-1.0, 1.0].map(|side| {
                let u = seated.mid_mm + shaft.sign() * side * (half + 1.0);
                let beyond = shaft.reaches(u).then(|| shaft.diameters_mm(u)[0].min(most));
                beyond.filter(|d| *d >= LEAST_END * root).unwrap_or(0.0)
            });
            let faces = match ends.map(|d| d > 0.0) {
                [true, true] => "at both faces",
                [true, false] => "at its back face",
                _ => "at its front face",
            };
            if ends != [0.0; 2] && shaft.cut_in(seated.mid_mm, gear.face_width_mm) {
                component.assume(About::Blank,
                    format!(
                        "cut into its shaft ({outer} mm thick, root {root:.3} mm): no bore, the shaft goes on {faces}; beams begin at its faces, so that the \
                         core's mass, bending and torsion count once"
                    ),
                );
                (gear.bore_mm, gear.shaft_mm) = (Some(0.0), Some(ends));
                continue;
            }
        }
        let bore = 0.5 * root;
        if shaft.is_none() {
            let what = format!(
                "on no shaft of the scene: a ring from a bore of {bore:.3} mm, half its root diameter, on"
            );
            component.assume(About::Stiffness, what);
            gear.bore_mm = Some(bore);
            continue;
        }
        if is_hub {
            let what = format!(
                "a bore of {wanted} mm leaves too little below the teeth (root {root:.3} mm): {bore:.3} mm"
            );
            component.assume(About::Blank, what);
            gear.bore_mm = Some(bore);
            continue;
        }
        component.assume(About::Blank, format!("cut into its shaft ({outer} mm thick, root {root:.3} mm), where other things stand within its face, or no shaft goes on: a ring from a bore of {bore:.3} mm on, held there; the shaft's own mass under the teeth counts besides"),
        );
        gear.bore_mm = Some(bore);
    }
}
