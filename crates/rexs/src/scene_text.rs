//! The text of the scene of a gearbox at rest under its loads.

use crate::axial_supports::axial_supports;
use crate::bevel_loads::bevel_loads;
use crate::by_number::{grouped, topmost};
use crate::drive_text::{Held, drive};
use crate::error::{Result, RexsError};
use crate::gear_bodies::gear_bodies;
use crate::gearbox::{SeatedGear, Train};
use crate::in_time::run_tables;
use crate::mesh_model::{Meshes, mesh_model};
use crate::planetary_set;
use crate::running::{DAMPING_S, Running};
use crate::shaft::Shaft;
use crate::source::Source;
use crate::text::{comment, number, numbers, quoted};
use crate::vectors::Frame;
use std::collections::{BTreeMap, HashMap, HashSet};

/// Text of the scene, and what holds its trains.
///
/// # Errors
/// [`RexsError::Missing`] for a scene in time of a gearbox whose gears do not turn.
pub fn scene(
    source: &Source<'_>,
    train: &Train,
    (title, head): (&str, &[String]),
    gravity: Option<[f64; 3]>,
    (with, running): (Meshes, Running),
) -> Result<(String, Vec<Held>)> {
    let mut text = String::new();
    for line in head {
        text.push_str(&format!("# {}\n", comment(line)));
    }
    text.push_str(&format!("title = {}\n", quoted(title)));
    if let Some(g) = gravity {
        text.push_str(&format!("gravity_m_per_s2 = {}\n", numbers(&g)));
    }
    match running {
        Running::AtRest => text.push_str("\n[run]\nkind = \"static\"\n"),
        Running::InTime => text.push_str(&run_tables(train).ok_or_else(|| RexsError::Missing {
            component: "the gearbox".to_owned(),
            what: "no gear of it turns in a mesh, so that it has no motion in time: give a shaft its speed (speed of shaft or external_load), or import it at rest"
                .to_owned(),
        })?),
    }
    text.push_str(&gear_bodies(source, train, |g| with.gear(&g.gear.file)));
    let groups = joined(train, |_| true);
    // Springs of couplings tell no speed.
    let springs: HashSet<[i64; 2]> = train.couplings.iter().map(|c| c.sides).collect();
    let turning = joined(train, |i| !springs.contains(&train.links[i].shafts));
    let masses = train.masses.iter().enumerate();
    let mut on_shafts = OnShafts {
        gears: train.gears_of(),
        masses: grouped(masses.map(|(i, mass)| (mass.shaft, i))),
        ..OnShafts::default()
    };
    for shaft in train.shafts.iter().filter(|s| s.hub_on.is_none()) {
        if let Some(&group) = turning.get(&shaft.id) {
            on_shafts.first_of.entry(group).or_insert(shaft.id);
        }
    }
    for shaft in train.shafts.iter().filter(|s| s.hub_on.is_none()) {
        shaft_table(&mut text, (train, running), shaft, &turning, &on_shafts);
    }
    let bevel_loads = bevel_loads(source, train);
    let supports = axial_supports(source, train, &bevel_loads);
    bearings(&mut text, train, &supports, running);
    couplings(&mut text, train);
    let held = drive(&mut text, source, (train, running), &groups);
    bevel_loads
        .iter()
        .for_each(|load| text.push_str(&load.text()));
    meshes(&mut text, train, with, running);
    text.push_str(&planetary_set::tables(train, with, running));
    Ok((text, held))
}

/// Trains that are joined by meshes of the scene and couplings, as far as these links are wanted: the number of each
/// shaft's train.
fn joined(train: &Train, wanted: impl Fn(usize) -> bool) -> BTreeMap<i64, usize> {
    // A tree of shafts for each train, the first one of the file at its root.
    let mut above: Vec<usize> = (0..train.shafts.len()).collect();
    let apart: HashSet<usize> = train.torque_seats().map(|t| t.link.0).collect();
    for (_, link) in train
        .links
        .iter()
        .enumerate()
        .filter(|(i, _)| !apart.contains(i) && wanted(*i))
    {
        let [Some(a), Some(b)] = link.shafts.map(|s| train.shafts.place(s)) else {
            continue;
        };
        let [a, b] = [a, b].map(|i| topmost(&mut above, i));
        above[a.max(b)] = a.min(b);
    }
    let ids = train.shafts.iter().map(|s| s.id).enumerate();
    ids.map(|(i, id)| (id, topmost(&mut above, i))).collect()
}

/// What stands on which shaft.
#[derive(Default)]
struct OnShafts {
    /// Places of gears.
    gears: HashMap<i64, Vec<usize>>,
    /// Places of masses.
    masses: HashMap<i64, Vec<usize>>,
    /// First shaft of each train.
    first_of: HashMap<usize, i64>,
}

fn shaft_table(
    text: &mut String,
    (train, running): (&Train, Running),
    shaft: &Shaft,
    groups: &BTreeMap<i64, usize>,
    on_shafts: &OnShafts,
) {
    let frame = shaft.frame.unwrap_or(Frame::WORLD);
    let stations = shaft.stations_mm();
    let pairs = stations.windows(2);
    let diameters: Vec<[f64; 2]> = pairs.map(|w| shaft.between_mm([w[0], w[1]])).collect();
    let outer: Vec<f64> = diameters.iter().map(|d| d[0]).collect();
    let inner: Vec<f64> = diameters.iter().map(|d| d[1]).collect();
    text.push_str(&format!(
        "\n[[shaft]]\nname = {}\norigin_mm = {}\naxis = {}\nstations_mm = {}\nouter_diameters_mm = {}\n",
        quoted(&shaft.name),
        numbers(&frame.origin_mm),
        numbers(&shaft.z()),
        numbers(stations),
        numbers(&outer)
    ));
    if inner.iter().any(|d| *d > 0.0) {
        text.push_str(&format!("inner_diameters_mm = {}\n", numbers(&inner)));
    }
    text.push_str(&format!(
        "density_kg_per_m3 = {}\n",
        number(shaft.material.density_kg_per_m3)
    ));
    // One speed a train: those of the others follow by the ratios.
    let group = groups.get(&shaft.id);
    let first = group.and_then(|group| on_shafts.first_of.get(group));
    if let Some(&speed) = train.flow.speed_rpm.get(&shaft.id).filter(|n| **n != 0.0)
        && first == Some(&shaft.id)
    {
        text.push_str(&format!("speed_rpm = {}\n", number(speed)));
    }
    let mine = on_shafts.gears.get(&shaft.id).into_iter().flatten();
    let mine = mine.map(|&i| &train.gears[i]);
    let first = |g: &&SeatedGear| shaft.seated(shaft.station(g.mid_mm)) == Some(&g.gear.name);
    let seats: Vec<String> = mine
        .filter(first)
        .map(|g| {
            format!(
                "{{ station = {}, body = {} }}",
                shaft.station(g.mid_mm),
                quoted(&g.gear.name)
            )
        })
        .collect();
    if !seats.is_empty() {
        text.push_str(&format!("seat = [{}]\n", seats.join(", ")));
    }
    let masses = on_shafts.masses.get(&shaft.id).into_iter().flatten();
    let parts: Vec<String> = masses
        .map(|&i| &train.masses[i])
        .map(|m| {
            let inertia = numbers(&m.inertia_kg_m2);
            format!(
                "{{ station = {}, mass_kg = {}, inertia_kg_m2 = {inertia} }}",
                shaft.station(m.u_mm),
                number(m.mass_kg)
            )
        })
        .collect();
    if !parts.is_empty() {
        text.push_str(&format!("part = [{}]\n", parts.join(", ")));
    }
    let damping = match running {
        Running::AtRest => String::new(),
        Running::InTime => format!(", damping_s = {}", number(DAMPING_S)),
    };
    text.push_str(&format!(
        "model = {{ kind = \"beam\", young_GPa = {}, poisson = {}{damping} }}\n",
        number(shaft.material.young_gpa),
        number(shaft.material.poisson)
    ));
}

fn bearings(text: &mut String, train: &Train, supports: &[bool], running: Running) {
    for (bearing, &holds) in train.bearings.iter().zip(supports) {
        let body = |side: usize| -> Option<String> {
            let shaft = train.shaft(bearing.sides[side])?;
            Some(shaft.body(bearing.u_mm[side]?))
        };
        let (first, second) = match (body(1), body(0)) {
            (outer, Some(inner)) => (outer, inner),
            (Some(outer), None) => (None, outer),
            (None, None) => continue,
        };
        text.push_str(&format!(
            "\n[[bearing]]\nname = {}\n",
            quoted(&bearing.name)
        ));
        if let Some(first) = first {
            text.push_str(&format!("body_1 = {}\n", quoted(&first)));
        }
        text.push_str(&format!("body_2 = {}\n", quoted(&second)));
        // One that was chosen for want of others may have none of its own.
        let axial = match bearing.axial_n_per_mm {
            _ if !holds => 0.0,
            own if own > 0.0 => own,
            _ => 0.4 * bearing.radial_n_per_mm.max(1.0),
        };
        let model = bearing.linear_model(axial, running);
        text.push_str(&format!("model = {{ {model} }}\n"));
        if let Some((file, _)) = &bearing.file {
            text.push_str(&format!(
                "# or: model = {{ kind = \"quasi-static\", file = {} }}\n",
                quoted(file)
            ));
        }
    }
}

fn couplings(text: &mut String, train: &Train) {
    for coupling in &train.couplings {
        let bodies = [0, 1].map(|side| {
            let shaft = train.shaft(coupling.sides[side])?;
            Some(shaft.body(coupling.u_mm[side]?))
        });
        let [Some(a), Some(b)] = bodies else { continue };
        let [axial, radial, torsion, tilt] = coupling.stiffness;
        text.push_str(&format!(
            "\n[[bushing]]\nname = {}\nbody_1 = {}\nbody_2 = {}\nstiffness_N_per_mm = {}\nstiffness_Nm_per_rad = {}\n",
            quoted(&coupling.name),
            quoted(&a),
            quoted(&b),
            numbers(&[radial, radial, axial]),
            numbers(&[tilt, tilt, torsion])
        ));
    }
}

fn meshes(text: &mut String, train: &Train, with: Meshes, running: Running) {
    for mesh in &train.meshes {
        let [a, b] = mesh.gears.map(|i| &train.gears[i].gear);
        let torque = train.flow.torques_nm(mesh.link);
        let flanks = match torque {
            Some([t, _]) if t < 0.0 => "right",
            Some([t, _]) if t > 0.0 => "left",
            _ => "both",
        };
        let has_flanks = !a.microgeometry.is_empty() || !b.microgeometry.is_empty();
        let plain = if has_flanks && with == Meshes::Iso6336 {
            "microgeometry = false       # one spring for all teeth knows no flanks\n"
        } else {
            ""
        };
        let model = mesh_model(with, running);
        text.push_str(&format!(
            "\n[[gear_mesh]]\nname = {}\ngear_1 = {}\ngear_2 = {}\n{plain}model = {{ {model} }}\nteeth = {{ flanks = \"{flanks}\" }}\n",
            quoted(&mesh.name),
            quoted(&a.name),
            quoted(&b.name)
        ));
    }
}
