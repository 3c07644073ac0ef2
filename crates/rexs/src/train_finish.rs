//! What follows once all parts of a gearbox are read: stations, one direction for parallel shafts, tips, bores, the flow of power.

use crate::gear::Gear;
use crate::loads::Load;
use crate::placement::{add, dot};
use crate::power_flow::{ASSUMED_RPM, Flow, TorqueOn, flow};
use crate::shaft::{self, Shaft};
use crate::source::Source;
use crate::train::Train;
use std::collections::BTreeMap;

/// Stations where something stands; one direction for all shafts of parallel axes.
pub fn finish_shafts(source: &Source<'_>, train: &mut Train) {
    let mut marks: Vec<(i64, f64)> = Vec::new();
    let mut bores: Vec<(i64, f64)> = Vec::new();
    marks.extend(train.gears.iter().map(|g| (g.shaft, g.mid_mm)));
    marks.extend(train.loads.iter().map(|l| (l.shaft, l.u_mm)));
    marks.extend(train.masses.iter().map(|m| (m.shaft, m.u_mm)));
    marks.extend(train.bevels.iter().map(|b| (b.shaft, b.u_mm)));
    for (sides, places) in train
        .bearings
        .iter()
        .map(|b| (b.sides, b.u_mm))
        .chain(train.couplings.iter().map(|c| (c.sides, c.u_mm)))
    {
        marks.extend(
            sides
                .into_iter()
                .zip(places)
                .filter_map(|(id, u)| Some((id, u?))),
        );
    }
    bores.extend(
        train
            .bearings
            .iter()
            .filter_map(|b| Some((b.sides[0], b.bore_mm?))),
    );
    let directions: Vec<[f64; 3]> = train
        .shafts
        .iter()
        .map(|s| s.frame.map_or([1.0, 0.0, 0.0], |f| f.axes[0]))
        .collect();
    for (i, shaft) in train.shafts.iter_mut().enumerate() {
        // Against the first shaft along the same line, z runs against u.
        let along = |other: &[f64; 3]| dot(*other, directions[i]);
        let leading = directions.iter().find(|d| along(d).abs() > 1.0 - 1e-6);
        shaft.is_reversed = leading.is_some_and(|d| along(d) < 0.0);
        let id = shaft.id;
        for &(_, u) in marks.iter().filter(|(on, _)| *on == id) {
            shaft.mark(u);
        }
        if let Some(component) = source.model.component(shaft.id) {
            let mine: Vec<f64> = bores
                .iter()
                .filter(|(id, _)| *id == shaft.id)
                .map(|(_, d)| *d)
                .collect();
            shaft::demand_sections(source, component, shaft, &mine);
        }
    }
    // Ratios are between speeds about z.
    let sign = |id: i64| {
        train
            .shafts
            .iter()
            .find(|s| s.id == id)
            .map_or(1.0, Shaft::sign)
    };
    let bevel_links: Vec<usize> = train.bevels.iter().map(|b| b.link.0).collect();
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

/// Backlash below this, in modules, is none: rounding decides whether the teeth fit.
const LEAST_BACKLASH: f64 = 1e-3;
/// Backlash that is then given, in modules.
const WANTED_BACKLASH: f64 = 0.02;
/// Teeth that jam by more, in modules, are no matter of rounding: the scene says so.
const MOST_JAM: f64 = 0.05;

/// Circumferential backlash on the reference circles in the transverse section \[mm\], negative for teeth that jam.
///
/// inv α_w = inv α_t + 2 tan α_n Σx₀/Σz is the profile shift Σx₀ without backlash at a working pressure angle; what the
/// gears have less than that is 2 m_n tan α_n/cos β of backlash a module, and their teeth are thinner by the allowances.
fn backlash_mm([a, b]: [&Gear; 2], distance_mm: f64) -> f64 {
    let normal = a.pressure_angle_deg.to_radians().tan();
    let cos_helix = a.helix_deg.to_radians().cos();
    let transverse = (normal / cos_helix).atan();
    let working = (0.5 * (a.base_diameter_mm() + b.base_diameter_mm()) / distance_mm)
        .min(1.0)
        .acos();
    let involute = |angle: f64| angle.tan() - angle;
    let without =
        (involute(working) - involute(transverse)) * f64::from(a.teeth + b.teeth) / (2.0 * normal);
    let shift = without - a.profile_shift - b.profile_shift;
    shift * 2.0 * a.module_mm * normal / cos_helix
        + a.thickness_allowance_mm
        + b.thickness_allowance_mm
}

/// Tips that clear the mates' roots, backlash, and bores.
pub fn finish_gears(source: &Source<'_>, train: &mut Train) {
    for mesh in &train.meshes {
        let [a, b] = mesh.gears;
        let frames = [a, b].map(|i| {
            train
                .shafts
                .iter()
                .find(|s| s.id == train.gears[i].shaft)
                .and_then(|s| s.frame)
        });
        let [Some(fa), Some(fb)] = frames else {
            continue;
        };
        let between = add(fb.origin_mm, fa.origin_mm, -1.0);
        let along = dot(between, fa.axes[0]);
        let distance = (dot(between, between) - along * along).max(0.0).sqrt();
        let [ga, gb] = [&train.gears[a].gear, &train.gears[b].gear];
        let reference = 0.5 * (ga.reference_diameter_mm() + gb.reference_diameter_mm());
        let module = ga.module_mm;
        let k = (distance - reference) / module - ga.profile_shift - gb.profile_shift;
        let jam = -backlash_mm([ga, gb], distance);
        if jam > -LEAST_BACKLASH * module && jam < MOST_JAM * module {
            let thinner = 0.5 * (jam + WANTED_BACKLASH * module);
            for i in [a, b] {
                let gear = &mut train.gears[i].gear;
                gear.thickness_allowance_mm += thinner;
                if let Some(component) = source.model.component(gear.id) {
                    source.assume(
                        component,
                        format!(
                            "no backlash at a centre distance of {distance:.4} mm: teeth {:.1} um thinner on the reference circle",
                            1e3 * thinner
                        ),
                    );
                }
            }
        }
        for i in [a, b] {
            let gear = &mut train.gears[i].gear;
            if gear.tip_diameter_mm.is_some() {
                continue;
            }
            let Some(component) = source.model.component(gear.id) else {
                continue;
            };
            let k = k.clamp(-0.5, 0.0);
            let tip = gear.reference_diameter_mm()
                + 2.0 * module * (gear.addendum + gear.profile_shift + k);
            source.assume(component, format!("tip diameter not given or not possible: {tip:.4} mm, addendum {} modules, shortened by {:.4} modules for the clearance at this centre distance", gear.addendum, -k));
            gear.tip_diameter_mm = Some(tip);
        }
    }
    for seated in &mut train.gears {
        let gear = &mut seated.gear;
        let Some(component) = source.model.component(gear.id) else {
            continue;
        };
        let shaft = train.shafts.iter().find(|s| s.id == seated.shaft);
        let [outer, _] = shaft.map_or([0.0, 0.0], |s| s.diameters_mm(seated.mid_mm));
        let most = gear.root_diameter_mm() - 3.0 * gear.module_mm;
        let wanted = gear.bore_mm.unwrap_or(outer);
        let bore = if wanted > 0.0 && wanted <= most {
            if gear.bore_mm.is_none() {
                source.assume(
                    component,
                    format!("bore {wanted} mm, the diameter of its shaft"),
                );
            }
            wanted
        } else {
            let bore = 0.5 * gear.root_diameter_mm();
            source.assume(
                component,
                format!("cut into its shaft ({outer} mm thick, root {:.3} mm): a ring from a bore of {bore:.3} mm on, held there; the shaft's own mass under the teeth counts besides", gear.root_diameter_mm()),
            );
            bore
        };
        gear.bore_mm = Some(bore);
    }
}

/// Speeds and torques by the ratios.
pub fn power(source: &Source<'_>, train: &Train) -> Flow {
    let ids: Vec<i64> = train.shafts.iter().map(|s| s.id).collect();
    let sign = |id: i64| train.shaft(id).map_or(1.0, Shaft::sign);
    let torques: Vec<TorqueOn> = train
        .loads
        .iter()
        .filter(|l| l.transmits)
        .map(|l| TorqueOn {
            shaft: l.shaft,
            torque_nm: l.torque_nm.map(|t| sign(l.shaft) * t),
            power_w: l.power_w,
        })
        .collect();
    let stated: BTreeMap<i64, f64> = train
        .shafts
        .iter()
        .filter_map(|s| Some((s.id, s.sign() * s.speed_rpm?)))
        .collect();
    let found = flow(&ids, &train.links, &torques, &stated);
    let transmitting: Vec<&Load> = train.loads.iter().filter(|l| l.transmits).collect();
    let component = |id: i64| source.model.component(id);
    for shaft in found.assumed_speed.iter().filter_map(|&id| component(id)) {
        source.assume(shaft, format!("no speed of its train is given: {} 1/min, in the sense in which the first torque drives", ASSUMED_RPM));
    }
    for (i, load) in transmitting.iter().enumerate() {
        let Some(load_component) = component(load.id) else {
            continue;
        };
        if load.torque_nm.is_none() {
            source.assume(
                load_component,
                format!(
                    "torque {:.6} N m about u, from the balance of power",
                    sign(load.shaft) * found.torque_nm[i]
                ),
            );
        }
        if found.turned.contains(&i) {
            source.assume(
                load_component,
                "its torque has the other sign: only then does the power that goes in come out",
            );
        }
    }
    for &(shaft, rest) in &found.unbalanced {
        if let Some(shaft) = component(shaft) {
            source.assume(shaft, format!("the torques of its train do not balance, {rest:.4} N m at its speed are left over: what holds the train in the scene takes them"));
        }
    }
    found
}
