//! Speeds and torques through a gear train by the ratios, as by hand: which flanks touch, where the load goes, which
//! bearing is pushed along its axis.

use crate::by_number::{grouped, topmost};
use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};

/// Two shafts that turn together: ω_b = ratio · ω_a, about their z axes.
#[derive(Debug, Clone, Copy)]
pub struct Link {
    /// The shafts: components.
    pub shafts: [i64; 2],
    /// Ratio.
    pub ratio: f64,
}

/// A torque on a shaft, about z \[N m\]; none where it follows from the others.
#[derive(Debug, Clone, Copy)]
pub struct TorqueOn {
    /// The shaft.
    pub shaft: i64,
    /// The torque.
    pub torque_nm: Option<f64>,
    /// Power that is put in \[W\], instead.
    pub power_w: Option<f64>,
}

/// Speeds and torques.
#[derive(Debug, Clone, Default)]
pub struct Flow {
    /// Speeds about z \[1/min\].
    pub speed_rpm: BTreeMap<i64, f64>,
    /// Torque of each [`TorqueOn`].
    pub torque_nm: Vec<f64>,
    /// Torque that each shaft brings to each link, about z: of the first and of the second shaft. None for the links
    /// of a loop, where it depends on stiffness.
    pub link_nm: Vec<Option<[f64; 2]>>,
    /// Shafts whose speed was assumed.
    pub assumed_speed: Vec<i64>,
    /// Trains whose stated torques do not balance: the torque where most power goes in, and by how much it was changed
    /// so that they do \[N m\].
    pub unbalanced: Vec<(usize, f64)>,
    /// Torques that were given the other sign, because only then the power balances.
    pub turned: Vec<usize>,
    /// Links that close a loop with another ratio than the rest of it has: the link, and the speed of its second shaft
    /// over that of the first one by the rest.
    pub locked: Vec<(usize, f64)>,
    /// Shafts whose stated speed \[1/min\] is not what follows from that of another one.
    pub other_speed: Vec<(i64, f64)>,
}

impl Flow {
    /// What its two shafts bring to a link \[N m\], where it is known.
    pub fn torques_nm(&self, link: usize) -> Option<[f64; 2]> {
        self.link_nm.get(link).copied().flatten()
    }
}

/// Speeds that differ by less are the same: files round them.
const SAME_SPEED: f64 = 1e-3;

/// Speed that is taken where none is stated \[1/min\].
pub const ASSUMED_RPM: f64 = 1000.0;

/// Follows the power through all trains.
pub fn flow(
    shafts: &[i64],
    links: &[Link],
    torques: &[TorqueOn],
    stated_rpm: &BTreeMap<i64, f64>,
) -> Flow {
    let mut found = Flow {
        torque_nm: torques.iter().map(|t| t.torque_nm.unwrap_or(0.0)).collect(),
        link_nm: vec![None; links.len()],
        ..Flow::default()
    };
    let both = |(i, link): (usize, &Link)| {
        let [a, b] = link.shafts;
        [(a, i)].into_iter().chain((a != b).then_some((b, i)))
    };
    let mut of = Of {
        seen: HashSet::new(),
        in_tree: vec![false; links.len()],
        links: grouped(links.iter().enumerate().flat_map(both)),
        torques: grouped(
            torques
                .iter()
                .enumerate()
                .map(|(i, torque)| (torque.shaft, i)),
        ),
    };
    // Shafts with a stated speed are roots before others.
    let rooted = shafts.iter().filter(|s| stated_rpm.contains_key(s));
    let roots: Vec<i64> = rooted.chain(shafts).copied().collect();
    for root in roots {
        if !of.seen.contains(&root) {
            train(root, links, torques, stated_rpm, &mut of, &mut found);
        }
    }
    found
}

/// What is known of all trains: shafts that were reached, links in trees of them, links and torques by shaft.
struct Of {
    seen: HashSet<i64>,
    in_tree: Vec<bool>,
    links: HashMap<i64, Vec<usize>>,
    torques: HashMap<i64, Vec<usize>>,
}

/// A shaft, its speed over the root's, and the link and shaft it is reached by.
struct Reached {
    shaft: i64,
    relative: f64,
    by: Option<(usize, i64)>,
}

fn train(
    root: i64,
    links: &[Link],
    torques: &[TorqueOn],
    stated_rpm: &BTreeMap<i64, f64>,
    of: &mut Of,
    found: &mut Flow,
) {
    let (reached, closing) = reach(root, links, of);
    let relative: BTreeMap<i64, f64> = reached.iter().map(|r| (r.shaft, r.relative)).collect();
    let on = reached.iter().filter_map(|r| of.torques.get(&r.shaft));
    let mut mine: Vec<usize> = on.flatten().copied().collect();
    mine.sort_unstable();
    for &i in &closing {
        let [a, b] = links[i].shafts.map(|s| relative[&s]);
        if (b / a / links[i].ratio - 1.0).abs() > SAME_SPEED {
            found.locked.push((i, b / a));
        }
    }
    // What nothing drives stands: pins and axles.
    let stands = mine.is_empty() && reached.len() == 1;
    let root_rpm = stated_rpm.get(&root).copied().unwrap_or_else(|| {
        if stands {
            return 0.0;
        }
        found.assumed_speed.push(root);
        // Power goes in at the first torque that is stated.
        let first = mine.iter().find(|&&i| found.torque_nm[i] != 0.0);
        let sense = first.map_or(1.0, |&i| {
            found.torque_nm[i].signum() * relative[&torques[i].shaft].signum()
        });
        sense * ASSUMED_RPM
    });
    for (&shaft, ratio) in &relative {
        found.speed_rpm.insert(shaft, root_rpm * ratio);
        let stated = stated_rpm.get(&shaft).copied();
        let other = |n: &f64| (n / (root_rpm * ratio) - 1.0).abs() > SAME_SPEED;
        found
            .other_speed
            .extend(stated.filter(other).map(|n| (shaft, n)));
    }
    balance(root_rpm, torques, &mine, &relative, found);
    torques_of_links(
        (&reached, &relative),
        (links, &closing),
        (torques, &mine),
        found,
    );
}

/// Shafts that a root reaches over links, and the links that close loops.
fn reach(root: i64, links: &[Link], of: &mut Of) -> (Vec<Reached>, Vec<usize>) {
    let mut reached = vec![Reached {
        shaft: root,
        relative: 1.0,
        by: None,
    }];
    of.seen.insert(root);
    let mut closing: BTreeSet<usize> = BTreeSet::new();
    let mut next = 0;
    while next < reached.len() {
        let (shaft, relative) = (reached[next].shaft, reached[next].relative);
        next += 1;
        for &i in of.links.get(&shaft).into_iter().flatten() {
            let link = &links[i];
            let [a, b] = link.shafts;
            let (other, ratio) = match shaft {
                s if s == a => (b, link.ratio),
                s if s == b => (a, 1.0 / link.ratio),
                _ => continue,
            };
            if of.in_tree[i] {
                continue;
            }
            if !of.seen.insert(other) {
                closing.insert(i);
                continue;
            }
            of.in_tree[i] = true;
            reached.push(Reached {
                shaft: other,
                relative: relative * ratio,
                by: Some((i, shaft)),
            });
        }
    }
    (reached, closing.into_iter().collect())
}

/// What each link that is part of no loop passes, by the balance of power.
fn torques_of_links(
    (reached, relative): (&[Reached], &BTreeMap<i64, f64>),
    (links, closing): (&[Link], &[usize]),
    (torques, mine): (&[TorqueOn], &[usize]),
    found: &mut Flow,
) {
    let in_loop = loops(reached, links, closing);
    // From the leaves to the root: what comes together behind a link goes through it.
    let mut behind: BTreeMap<i64, f64> = relative.keys().map(|&s| (s, 0.0)).collect();
    for &i in mine {
        *behind.entry(torques[i].shaft).or_insert(0.0) +=
            found.torque_nm[i] * relative[&torques[i].shaft];
    }
    for r in reached.iter().rev() {
        let Some((link, parent)) = r.by else { continue };
        let power = behind[&r.shaft];
        *behind.entry(parent).or_insert(0.0) += power;
        let [child_nm, parent_nm] = [power / r.relative, -power / relative[&parent]];
        if in_loop[link] {
            continue;
        }
        let is_first = links[link].shafts[0] == r.shaft;
        found.link_nm[link] = Some(if is_first {
            [child_nm, parent_nm]
        } else {
            [parent_nm, child_nm]
        });
    }
}

/// Which links are part of a loop: those that close one, and the way from both of their shafts up to where they come
/// together. Each link is walked once: what is part of a loop is passed over by the next one.
fn loops(reached: &[Reached], links: &[Link], closing: &[usize]) -> Vec<bool> {
    let mut found = vec![false; links.len()];
    let place: HashMap<i64, usize> = (reached.iter().enumerate())
        .map(|(i, r)| (r.shaft, i))
        .collect();
    // Shafts stand behind those by which they are reached. Of each shaft the next one on the way up whose link is not
    // marked.
    let mut above: Vec<usize> = (0..reached.len()).collect();
    for &i in closing {
        found[i] = true;
        let [mut a, mut b] = (links[i].shafts).map(|s| topmost(&mut above, place[&s]));
        while a != b {
            let lower = if a > b { &mut a } else { &mut b };
            let Some((link, parent)) = reached[*lower].by else {
                break;
            };
            found[link] = true;
            above[*lower] = place[&parent];
            *lower = topmost(&mut above, *lower);
        }
    }
    found
}

/// Torques by power, and those that follow from the others.
fn balance(
    root_rpm: f64,
    torques: &[TorqueOn],
    mine: &[usize],
    relative: &BTreeMap<i64, f64>,
    found: &mut Flow,
) {
    let of = |i: usize| relative[&torques[i].shaft];
    let mut open: Vec<usize> = Vec::new();
    for &i in mine {
        if torques[i].torque_nm.is_some() {
            continue;
        }
        match torques[i].power_w {
            Some(power) => {
                found.torque_nm[i] = power / (root_rpm * of(i) * std::f64::consts::PI / 30.0)
            }
            None => open.push(i),
        }
    }
    let known = |found: &Flow| -> f64 { mine.iter().map(|&i| found.torque_nm[i] * of(i)).sum() };
    let left = known(found);
    if !open.is_empty() {
        for &i in &open {
            found.torque_nm[i] = -left / (open.len() as f64 * of(i));
        }
        return;
    }
    let largest = mine
        .iter()
        .map(|&i| (found.torque_nm[i] * of(i)).abs())
        .fold(0.0, f64::max);
    if left.abs() <= 1e-3 * largest {
        return;
    }
    // Programs that give all torques one sign: input and output then add up instead of cancelling.
    if let [a, b] = mine {
        let [pa, pb] = [*a, *b].map(|i| found.torque_nm[i] * of(i));
        if (pa - pb).abs() <= 1e-2 * largest {
            found.torque_nm[*b] = -found.torque_nm[*b];
            found.turned.push(*b);
            return;
        }
    }
    // What holds the train in the scene carries what is left over; flanks and axial forces follow from that.
    let power = |i: usize| found.torque_nm[i] * of(i) * root_rpm;
    let input = mine.iter().copied();
    if let Some(i) = input.max_by(|&a, &b| power(a).total_cmp(&power(b))) {
        let change = -left / of(i);
        found.torque_nm[i] += change;
        found.unbalanced.push((i, change));
    }
}
