//! How far gears are turned at the start so that their teeth touch, where the scene leaves that open.

use gearmesh_drivetrain::FlankContacts;
use gearmesh_drivetrain::tooth_overlap::{BEHIND, THROUGH};
use gearmesh_geometry::input::{InputDocument, TableKeys};
use gearmesh_geometry::{Flank, InputError};
use gearmesh_specification::gear_tables::UM;

use super::bodies::Bodies;
use super::gear_mesh::PreparedMesh;

/// Touching is met to this gap \[m\]: far below any deflection, well above rounding.
const TOUCHING_M: f64 = 1e-13;
/// Overlap at least with which an equilibrium of a planetary set is looked for \[m\]: far above rounding, a small part
/// of deflections.
const PRESSED_M: f64 = UM;
/// Overlap of the coast flanks while the others touch, from which teeth are said to jam: pairs without backlash have
/// some rounding.
const JAMMED_M: f64 = UM;
/// Part of a pitch that the gaps of both sides are together where a tooth stands in a tooth.
const TOOTH_ON_TOOTH: f64 = 0.9;

/// Turns gears whose angle nobody states so that their teeth touch, gear 2 where both are free; says what it did and
/// where teeth stand whose angles are stated. `seeks_rest`: the start is where an equilibrium is looked for. Teeth of
/// planetary sets that would be open there are then pressed into each other, so that all planets carry from the first
/// iteration on.
pub(super) fn settle_phases(
    bodies: &mut Bodies,
    meshes: &[PreparedMesh],
    (document, seeks_rest): (&InputDocument, bool),
    notes: &mut Vec<String>,
) -> Result<(), InputError> {
    // A gear that an earlier mesh has turned, or turned others against, stays.
    let mut meshed: Vec<usize> = Vec::new();
    let mut closed: Vec<&PreparedMesh> = Vec::new();
    let mut turned_by: Vec<Option<&PreparedMesh>> = vec![None; bodies.list.len()];
    for mesh in meshes {
        if mesh.mesh.is_none() {
            continue;
        }
        let free = |i: usize| {
            bodies.list[mesh.bodies[i]].turn_is_free && !meshed.contains(&mesh.bodies[i])
        };
        let turned = [1, 0].into_iter().find(|&i| free(i));
        let keys = TableKeys::new(document, &mesh.key);
        if let Some(i) = turned {
            turned_by[mesh.bodies[i]] = Some(mesh);
            turn_to_touch(mesh, i, bodies, &keys, notes)?;
        } else {
            closed.push(mesh);
            notes.push(as_they_stand(mesh, bodies, &keys)?);
        }
        refuse_teeth_in_teeth(mesh, bodies, &keys)?;
        meshed.extend(mesh.bodies);
    }
    if seeks_rest {
        press_sets(bodies, &turned_by, &closed, document)?;
    }
    Ok(())
}

/// Turns gear `i` of a mesh so that the driven flanks touch; notes its angle, and how far other flanks overlap then.
fn turn_to_touch(
    mesh: &PreparedMesh,
    i: usize,
    bodies: &mut Bodies,
    keys: &TableKeys<'_>,
    notes: &mut Vec<String>,
) -> Result<(), InputError> {
    let Some(teeth) = &mesh.mesh else {
        return Ok(());
    };
    let (name, side) = (&mesh.built.name, driven_side(mesh, bodies));
    let mut least = least_gap_m(mesh, bodies, side, keys)?;
    for _ in 0..100 {
        if !least.is_finite() || least.abs() < TOUCHING_M {
            break;
        }
        // Seen along z, the gap grows with either gear's turn by σ r_b, with the signs of rings.
        let slope = teeth.kinematics().hand(side) * mesh.built.base_radii_m[i];
        bodies.list[mesh.bodies[i]].turn(-least / slope);
        least = least_gap_m(mesh, bodies, side, keys)?;
    }
    let body = &bodies.list[mesh.bodies[i]].body;
    if !least.is_finite() || least.abs() >= UM {
        let problem = format!(
            "no angle of body `{}` was found at which the {} flanks touch (gap {least:.3e} m); state cardan_deg of both gears",
            body.name,
            side.name()
        );
        return Err(keys.error("", problem));
    }
    let angle = body.orientation.scaled_axis();
    notes.push(format!(
        "body `{}` is turned so that the {} flanks of mesh `{name}` touch: rotation vector [{:.6}, {:.6}, {:.6}] deg",
        body.name,
        side.name(),
        angle[0].to_degrees(),
        angle[1].to_degrees(),
        angle[2].to_degrees()
    ));
    for other in mesh.sides.iter().filter(|other| **other != side) {
        let least = least_gap_m(mesh, bodies, *other, keys)?;
        if least < -JAMMED_M {
            notes.push(format!(
                "the teeth of mesh `{name}` jam: while the {} flanks touch, the {} ones overlap by {:.1} um; give the pair backlash, or \
                 mount the gears farther apart",
                side.name(),
                other.name(),
                -least / UM
            ));
        }
    }
    Ok(())
}

/// The note on a mesh both of whose gears have their angles.
fn as_they_stand(
    mesh: &PreparedMesh,
    bodies: &Bodies,
    keys: &TableKeys<'_>,
) -> Result<String, InputError> {
    let mut stand = Vec::new();
    for side in &mesh.sides {
        let least = least_gap_m(mesh, bodies, *side, keys)?;
        let word = match least < 0.0 {
            true => "overlap by",
            false => "are open by",
        };
        let (side, um) = (side.name(), least.abs() / UM);
        stand.push(format!("the {side} flanks {word} {um:.3} um"));
    }
    let (name, stand) = (&mesh.built.name, stand.join(", "));
    Ok(format!("mesh `{name}` starts as the bodies stand: {stand}"))
}

fn refuse_teeth_in_teeth(
    mesh: &PreparedMesh,
    bodies: &Bodies,
    keys: &TableKeys<'_>,
) -> Result<(), InputError> {
    let Some(teeth) = &mesh.mesh else {
        return Ok(());
    };
    let pitch_m = teeth.kinematics().pitch_m();
    let [gear_1, gear_2] = mesh.bodies.map(|body| bodies.name(Some(body)));
    let mut open = [0.0; 2];
    for (side, gap_m) in Flank::ALL.into_iter().zip(&mut open) {
        *gap_m = least_gap_m(mesh, bodies, side, keys)?;
        let share = match mesh.sides.contains(&side) {
            true => THROUGH,
            false => BEHIND,
        };
        let (depth_m, allowed_m) = (-*gap_m, share * pitch_m);
        if depth_m > allowed_m {
            let problem = format!(
                "the {} flanks stand {:.3} mm in each other at the start, allowed are {:.3} mm; state other angles (cardan_deg) or places \
                 of `{gear_1}` and `{gear_2}`",
                side.name(),
                1e3 * depth_m,
                1e3 * allowed_m,
            );
            return Err(keys.error("", problem));
        }
    }
    let sum = open[0] + open[1];
    // The gaps of a tooth in its space add up to the backlash, less than a pitch by what two tips are thick. A whole
    // pitch: each side found another space, a tooth stands in the middle of a tooth.
    if sum.is_finite() && sum > TOOTH_ON_TOOTH * pitch_m {
        let problem = format!(
            "teeth stand in teeth at the start: the right flanks are open by {:.3} mm and the left ones by {:.3} mm, together a pitch ({:.3} mm); state other \
             angles (cardan_deg) of `{gear_1}` and `{gear_2}`, or leave the last angle of one of them out",
            1e3 * open[0],
            1e3 * open[1],
            1e3 * pitch_m,
        );
        return Err(keys.error("", problem));
    }
    Ok(())
}

/// The least gap of the flanks of one side \[m\]; infinite where none face each other.
fn least_gap_m(
    mesh: &PreparedMesh,
    bodies: &Bodies,
    side: Flank,
    keys: &TableKeys<'_>,
) -> Result<f64, InputError> {
    let Some(teeth) = &mesh.mesh else {
        return Ok(f64::INFINITY);
    };
    let mut found = FlankContacts::default();
    let contacts = teeth
        .kinematics()
        .contacts_at(&mesh.pose(bodies), side, &mut found);
    contacts.map_err(|e| keys.error("", e))?;
    let gaps = found.contacts.iter().map(|contact| contact.gap_m);
    Ok(gaps.fold(f64::INFINITY, f64::min))
}

/// Presses teeth of planetary sets into each other. Of gears in a circle of meshes that which was turned last, such as
/// the ring, is turned so that it overlaps with all planets; what is between it and the gear at which the circle begins
/// is turned so that all meshes have the same part of the overlap. From planets that are open an equilibrium is not
/// found: nothing holds them. `turned_by`: the mesh in which each body was turned; `closed`: meshes whose gears were
/// turned in others.
fn press_sets(
    bodies: &mut Bodies,
    turned_by: &[Option<&PreparedMesh>],
    closed: &[&PreparedMesh],
    document: &InputDocument,
) -> Result<(), InputError> {
    let gap = |mesh: &PreparedMesh, bodies: &Bodies| {
        let keys = TableKeys::new(document, &mesh.key);
        least_gap_m(mesh, bodies, driven_side(mesh, bodies), &keys)
    };
    // How far a gap grows with a turn of one of its gears.
    let slope = |mesh: &PreparedMesh, bodies: &Bodies, body: usize| {
        let hand = mesh.mesh.as_ref().map_or(0.0, |teeth| {
            teeth.kinematics().hand(driven_side(mesh, bodies))
        });
        hand * mesh.built.base_radii_m[usize::from(mesh.bodies[1] == body)]
    };
    let mut pressed: Vec<usize> = Vec::new();
    for (end, meshes) in ends_of_circles(turned_by, closed) {
        let senses = meshes.iter().map(|mesh| slope(mesh, bodies, end).signum());
        let senses: Vec<f64> = senses.collect();
        // What is pressed from two sides is no end.
        if !bodies.list[end].turn_is_free || senses.iter().any(|sense| *sense != senses[0]) {
            continue;
        }
        // Meshes one after the other, each with the gear behind it that a turn takes out of it and into the next.
        let path = |first: &'_ PreparedMesh| {
            let mut path = Vec::new();
            let mut body = mate(first, end);
            let mut mesh = first;
            while let Some(next) = turned_by[body].filter(|_| !pressed.contains(&body)) {
                let both = slope(mesh, bodies, body) * slope(next, bodies, body);
                if both >= 0.0 {
                    break;
                }
                path.push((body, next));
                (body, mesh) = (mate(next, body), next);
            }
            path
        };
        let paths: Vec<_> = meshes.iter().map(|mesh| (*mesh, path(mesh))).collect();
        let open_m =
            |bodies: &Bodies, (first, path): &(&PreparedMesh, Vec<(usize, &PreparedMesh)>)| {
                let mut sum_m = gap(first, bodies)?;
                for (_, mesh) in path {
                    sum_m += gap(mesh, bodies)?;
                }
                Ok::<f64, InputError>(sum_m)
            };
        let mut widest_m = 0.0_f64;
        for path in &paths {
            widest_m = widest_m.max(open_m(bodies, path)?);
        }
        if !widest_m.is_finite() {
            continue;
        }
        let turn_rad = -(widest_m + PRESSED_M) / slope(meshes[0], bodies, end);
        bodies.list[end].turn(turn_rad);
        for path in &paths {
            let share_m = -open_m(bodies, path)? / (path.1.len() + 1) as f64;
            let mut mesh = path.0;
            for (body, next) in &path.1 {
                let turn_rad = -(share_m + gap(mesh, bodies)?) / slope(mesh, bodies, *body);
                bodies.list[*body].turn(turn_rad);
                pressed.push(*body);
                mesh = next;
            }
        }
        pressed.push(end);
    }
    Ok(())
}

/// The other gear of a mesh.
fn mate(mesh: &PreparedMesh, body: usize) -> usize {
    mesh.bodies[usize::from(mesh.bodies[0] == body)]
}

/// The gears that were turned last in circles of meshes, with their meshes there; those nearest to the begin first.
fn ends_of_circles<'m>(
    turned_by: &[Option<&'m PreparedMesh>],
    closed: &[&'m PreparedMesh],
) -> Vec<(usize, Vec<&'m PreparedMesh>)> {
    let depth = |body: usize| {
        let next = |body: &usize| Some(mate(turned_by[*body]?, *body));
        std::iter::successors(Some(body), next).count()
    };
    let mut ends: Vec<(usize, Vec<&'m PreparedMesh>)> = Vec::new();
    let of_sets = |mesh: &&&PreparedMesh| mesh.touching_at_start.is_some();
    for mesh in closed.iter().filter(of_sets) {
        let [one, other] = mesh.bodies.map(depth);
        let last = mesh.bodies[usize::from(other >= one)];
        match ends.iter_mut().find(|(end, _)| *end == last) {
            Some((_, meshes)) => meshes.push(mesh),
            None => ends.push((last, turned_by[last].into_iter().chain([*mesh]).collect())),
        }
    }
    ends.sort_by_key(|(end, _)| depth(*end));
    ends
}

/// The side that touches at the start, where the scene does not say: right where gear 1 turns clockwise or stands.
fn driven_side(mesh: &PreparedMesh, bodies: &Bodies) -> Flank {
    let driven = match bodies.list[mesh.bodies[0]].spin() > 0.0 {
        true => Flank::Left,
        false => Flank::Right,
    };
    let wanted = mesh.touching_at_start.unwrap_or(driven);
    let known = mesh.sides.iter().find(|side| **side == wanted);
    known.or(mesh.sides.first()).copied().unwrap_or(wanted)
}
