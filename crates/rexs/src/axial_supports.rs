//! Which bearings hold their shafts along the axis in a load case: what the teeth and loads push along each shaft, and
//! which way the bearings support it.

use crate::bearing::{AxialSupport, Bearing};
use crate::bevel_loads::BevelLoad;
use crate::gearbox::Train;
use crate::ledger::About;
use crate::shaft::Shaft;
use crate::source::Source;
use std::collections::BTreeMap;

/// What pushes shafts along their z axes.
struct AxialForces {
    /// Force on each shaft \[N\].
    on_n: BTreeMap<i64, f64>,
    /// Whether the torques of all meshes are known.
    is_known: bool,
}

impl AxialForces {
    fn add(&mut self, shaft: i64, force_n: f64) {
        *self.on_n.entry(shaft).or_insert(0.0) += force_n;
    }

    fn on(&self, shaft: i64) -> f64 {
        self.on_n.get(&shaft).copied().unwrap_or(0.0)
    }

    fn of(train: &Train, bevel_loads: &[BevelLoad]) -> Self {
        let mut forces = Self {
            on_n: BTreeMap::new(),
            is_known: true,
        };
        for load in bevel_loads {
            forces.add(load.shaft, load.axial_n);
        }
        let meshes = train.meshes.iter().map(|mesh| (mesh.link, mesh.gears));
        // Of all planets together, as of one mesh. A carrier takes none: its planets feel sun and ring alike.
        let sets = train.sets.iter().map(|set| (set.link, [set.sun, set.ring]));
        for (link, gears) in meshes.chain(sets) {
            let Some(torques) = train.flow.torques_nm(link) else {
                forces.is_known = false;
                continue;
            };
            for (torque_nm, i) in torques.into_iter().zip(gears) {
                let seated = &train.gears[i];
                // F = T tan β / r at the reference circle, along z: a right hand pushed clockwise by its shaft goes to
                // -z.
                let radius_m = 0.5e-3 * seated.gear.reference_diameter_mm();
                let force_n = torque_nm * seated.gear.helix_deg.to_radians().tan() / radius_m;
                // A ring that is held is on no shaft.
                if seated.shaft >= 0 {
                    forces.add(seated.shaft, force_n);
                }
            }
        }
        // What pushes a loose gear goes on to the shaft that carries it.
        for (hub, on) in train.shafts.iter().filter_map(|s| Some((s.id, s.hub_on?))) {
            forces.add(on, forces.on(hub));
        }
        for load in &train.loads {
            let sign = train.shaft(load.shaft).map_or(1.0, Shaft::sign);
            forces.add(load.shaft, sign * load.force_n[0]);
        }
        forces
    }
}

/// Whether each bearing holds its shaft along the axis in this load case. One-way supports do where the load pushes
/// against them; springs know no one way.
pub fn axial_supports(source: &Source<'_>, train: &Train, bevel_loads: &[BevelLoad]) -> Vec<bool> {
    let forces = AxialForces::of(train, bevel_loads);
    let bearings_of = train.bearings_of();
    let is_both = |b: &Bearing| b.axial == AxialSupport::Both;
    let mut holds: Vec<bool> = train.bearings.iter().map(is_both).collect();
    for shaft in train.shafts.iter() {
        let carried = |id: &i64| train.shaft(*id).is_some_and(|s| s.hub_on == Some(shaft.id));
        let on = bearings_of.get(&shaft.id).into_iter().flatten().copied();
        let mine: Vec<usize> = on
            .filter(|&i| !train.bearings[i].sides.iter().any(carried))
            .collect();
        let along_u = shaft.sign() * forces.on(shaft.id);
        for &i in &mine {
            holds[i] |= is_pushed(source, train, i, (shaft, along_u));
        }
        if !mine.is_empty() && !mine.iter().any(|&i| holds[i]) {
            let one_way = |i: &&usize| train.bearings[**i].axial != AxialSupport::None;
            let chosen = *mine.iter().find(one_way).unwrap_or(&mine[0]);
            holds[chosen] = true;
            let what = format!("nothing else holds {} along its axis: it does", shaft.name);
            source.assume_of(train.bearings[chosen].id, About::Support, what);
        }
    }
    if !forces.is_known
        && let Some(unit) = source.of_kind(&["gear_unit"]).next()
    {
        unit.assume(About::Support, "the train has loops: torques of their meshes depend on stiffness, their flanks are `both`, one-way supports as without their axial tooth forces");
    }
    holds
}

/// Whether a shaft that is pushed along u by a force \[N\] leans on a bearing that supports it one way only; false of
/// other bearings.
fn is_pushed(
    source: &Source<'_>,
    train: &Train,
    bearing: usize,
    (shaft, along_u): (&Shaft, f64),
) -> bool {
    let bearing = &train.bearings[bearing];
    // The outer part feels the opposite of what the inner part does.
    let on_inner = match bearing.sides[0] == shaft.id {
        true => along_u,
        false => -along_u,
    };
    let is_pushed = match bearing.axial {
        AxialSupport::Positive => on_inner > 0.0,
        AxialSupport::Negative => on_inner < 0.0,
        AxialSupport::Both | AxialSupport::None => return false,
    };
    let verb = if is_pushed { "holds" } else { "does not hold" };
    let what = format!(
        "supports along u one way only: in this load case ({along_u:.1} N along u from the teeth and loads of {}) it {verb} the shaft",
        shaft.name
    );
    source.assume_of(bearing.id, About::Nothing, what);
    is_pushed
}
