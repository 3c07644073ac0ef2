//! Speeds and torques of a gearbox by its ratios, and what the file has to be told of them.

use crate::gearbox::Train;
use crate::ledger::About;
use crate::loads::Load;
use crate::power_flow::{ASSUMED_RPM, Flow, TorqueOn, flow};
use crate::shaft::{MOST_RPM, Shaft};
use crate::source::{Part, Source};
use std::collections::{BTreeMap, HashMap, HashSet};

/// Speeds and torques by the ratios.
pub fn power(source: &Source<'_>, train: &Train) -> Flow {
    let found = followed(train);
    let told = Told {
        source,
        train,
        found: &found,
        transmitting: train.loads.iter().filter(|l| l.transmits).collect(),
    };
    told.speeds();
    told.torques();
    told.other_speeds();
    told.locked();
    told.unbalanced();
    found
}

/// +1 where z of a shaft runs along u, else -1.
fn sign(train: &Train, shaft: i64) -> f64 {
    train.shaft(shaft).map_or(1.0, Shaft::sign)
}

/// The flow of power from what loads and shafts state.
fn followed(train: &Train) -> Flow {
    let ids: Vec<i64> = train.shafts.iter().map(|s| s.id).collect();
    // A brake carries what is left over where nothing else does.
    let open = |l: &&Load| l.transmits && l.torque_nm.is_none() && l.power_w.is_none();
    let has_open = train.loads.iter().filter(open).any(|l| !l.is_brake);
    let transmitting = train.loads.iter().filter(|l| l.transmits);
    let torques = transmitting.map(|l| TorqueOn {
        shaft: l.shaft,
        torque_nm: match l.torque_nm {
            None if l.is_brake && has_open => Some(0.0),
            torque => torque.map(|t| sign(train, l.shaft) * t),
        },
        power_w: l.power_w,
    });
    let torques: Vec<TorqueOn> = torques.collect();
    let stated = train.shafts.iter();
    let stated = stated.filter_map(|s| Some((s.id, s.sign() * s.speed_rpm?)));
    let stated: BTreeMap<i64, f64> = stated.collect();
    flow(&ids, &train.links, &torques, &stated)
}

/// What was assumed so that speeds and torques fit each other.
struct Told<'a> {
    source: &'a Source<'a>,
    train: &'a Train,
    found: &'a Flow,
    /// The loads whose torques the flow has, in its order.
    transmitting: Vec<&'a Load>,
}

impl Told<'_> {
    /// Speeds of which there is more than machines have, and trains without one.
    fn speeds(&self) {
        let speeds = self.found.speed_rpm.iter();
        for (&id, rpm) in speeds.filter(|(_, n)| n.abs() > MOST_RPM) {
            let what = format!(
                "turns at {rpm:.3e} 1/min by the ratios: look at numbers of teeth and the stated speed"
            );
            self.source.assume_of(id, About::Lost, what);
        }
        for &id in &self.found.assumed_speed {
            let what = format!(
                "no speed but 0 of its train is given: {ASSUMED_RPM} 1/min, in the sense in which the first torque drives"
            );
            self.source.assume_of(id, About::Torque, what);
        }
    }

    /// Torques that follow from others, or have another sign than the file's.
    fn torques(&self) {
        let stated = |l: &&Load| {
            let torques = [l.torque_nm, l.power_w].into_iter().flatten();
            { torques }.any(|t| t != 0.0)
        };
        let is_loaded = self.transmitting.iter().any(stated);
        let turned: HashSet<usize> = self.found.turned.iter().copied().collect();
        for (i, load) in self.transmitting.iter().enumerate() {
            let Some(component) = self.source.part(load.id) else {
                continue;
            };
            if load.torque_nm.is_none() && !self.balanced_torque(component, (i, load), is_loaded) {
                continue;
            }
            if turned.contains(&i) {
                let what =
                    "its torque has the other sign: only then does the power that goes in come out";
                component.assume(About::Torque, what);
            }
        }
    }

    /// The torque of a load that does not state it; false where none comes to it.
    fn balanced_torque(
        &self,
        component: Part<'_>,
        (i, load): (usize, &Load),
        is_loaded: bool,
    ) -> bool {
        let is_idle = self.found.torque_nm[i] == 0.0 && !load.is_brake;
        if is_idle && is_loaded {
            let what = "it transmits torque, but none comes to it: no load that states one is joined to its shaft by stages and couplings. \
                        Look for a stage, a coupling or a relation that is missing";
            component.assume(About::Lost, what);
            return false;
        }
        let about = if is_idle { About::Torque } else { About::Small };
        let acts = sign(self.train, load.shaft) * self.found.torque_nm[i];
        let other = |stated: &f64| (stated - acts).abs() > 1e-2 * acts.abs();
        if let Some(stated) = load.stated_nm.filter(other) {
            let what = format!(
                "a torque of {stated:.4} N m is stated, but defines_torque is false: {acts:.4} N m follow from the others"
            );
            component.assume(About::Torque, what);
        }
        let what = format!(
            "torque {:.6} N m about u, from the balance of power",
            acts + 0.0
        );
        component.assume(about, what);
        true
    }

    /// Shafts whose stated speed is not what follows.
    fn other_speeds(&self) {
        for &(shaft, stated) in &self.found.other_speed {
            let sign = sign(self.train, shaft);
            let follows = self.found.speed_rpm.get(&shaft).copied().unwrap_or(0.0) * sign;
            let stated = stated * sign;
            let about = About::by((stated / follows - 1.0).abs() > 1e-2, About::Torque);
            let what = format!(
                "rotational_speed is {stated} 1/min, but {follows:.4} 1/min follow by the ratios from the shaft that comes first: the latter"
            );
            self.source.assume_of(shaft, about, what);
        }
    }

    /// Loops whose ratios contradict each other.
    fn locked(&self) {
        let train = self.train;
        let stage_of: HashMap<usize, i64> =
            train.meshes.iter().map(|m| (m.link, m.stage)).collect();
        let couplings = train.couplings.iter().rev();
        let coupling_of: HashMap<[i64; 2], i64> = couplings.map(|c| (c.sides, c.id)).collect();
        for &(link, rest) in &self.found.locked {
            let (own, shafts) = (train.links[link].ratio, train.links[link].shafts);
            let names = shafts.map(|id| train.shaft(id).map_or("", |s| s.name.as_str()));
            let by = stage_of.get(&link).or(coupling_of.get(&shafts));
            let what = format!(
                "THE GEARBOX IS LOCKED: {} turns {own:.6} times as fast as {} by it, and {rest:.6} times by the other way between them. Loads in the scene come of teeth that jam. Open a coupling (is_engaged) or mend the numbers of teeth",
                names[1], names[0]
            );
            let subject = by.copied().unwrap_or(shafts[0]);
            self.source.assume_of(subject, About::Lost, what);
        }
    }

    /// Trains whose torques do not balance.
    fn unbalanced(&self) {
        for &(i, change) in &self.found.unbalanced {
            let load = self.transmitting[i];
            let sign = sign(self.train, load.shaft);
            let acts = sign * self.found.torque_nm[i];
            let stated = acts - sign * change;
            if acts.abs() <= 1e-6 * stated.abs() {
                let what = format!(
                    "its torque of {stated:.4} N m does not act in the scene: nothing takes it off, for its shaft is joined to no other load that \
                     transmits torque. Look for a stage, a coupling or a relation that is missing"
                );
                self.source.assume_of(load.id, About::Lost, what);
                continue;
            }
            let off = change.abs() / acts.abs().max(stated.abs());
            let what = format!(
                "the torques of its train do not balance by {:.2} %: {acts:.4} N m about u in place of {stated:.4} N m here, where most power goes in",
                100.0 * off
            );
            self.source
                .assume_of(load.id, About::by(off > 1e-2, About::Lost), what);
        }
    }
}
