//! Speeds and torques through a gear train by the ratios, as by hand: which flanks touch, where the load goes, which bearing
//! is pushed along its axis.

use std::collections::BTreeMap;

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
    /// Torque that each shaft brings to each link, about z: of the first and of the second shaft. None in loops, where
    /// it depends on stiffness.
    pub link_nm: Vec<Option<[f64; 2]>>,
    /// Shafts whose speed was assumed.
    pub assumed_speed: Vec<i64>,
    /// Trains whose stated torques do not balance: a shaft, and the power that is left over by its speed \[N m\].
    pub unbalanced: Vec<(i64, f64)>,
    /// Torques that were given the other sign, because only then the power balances.
    pub turned: Vec<usize>,
}

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
    let mut seen: Vec<i64> = Vec::new();
    // Shafts with a stated speed are roots before others.
    let rooted = shafts.iter().filter(|s| stated_rpm.contains_key(s));
    let roots: Vec<i64> = rooted.chain(shafts).copied().collect();
    for root in roots {
        if !seen.contains(&root) {
            train(root, links, torques, stated_rpm, &mut seen, &mut found);
        }
    }
    found
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
    seen: &mut Vec<i64>,
    found: &mut Flow,
) {
    let mut reached = vec![Reached {
        shaft: root,
        relative: 1.0,
        by: None,
    }];
    seen.push(root);
    let mut in_tree = vec![false; links.len()];
    let mut has_loop = false;
    let mut next = 0;
    while next < reached.len() {
        let (shaft, relative) = (reached[next].shaft, reached[next].relative);
        next += 1;
        for (i, link) in links.iter().enumerate() {
            let [a, b] = link.shafts;
            let (other, ratio) = match shaft {
                s if s == a => (b, link.ratio),
                s if s == b => (a, 1.0 / link.ratio),
                _ => continue,
            };
            if in_tree[i] {
                continue;
            }
            if seen.contains(&other) {
                has_loop = true;
                continue;
            }
            in_tree[i] = true;
            seen.push(other);
            reached.push(Reached {
                shaft: other,
                relative: relative * ratio,
                by: Some((i, shaft)),
            });
        }
    }
    let relative: BTreeMap<i64, f64> = reached.iter().map(|r| (r.shaft, r.relative)).collect();
    let mine: Vec<usize> = (0..torques.len())
        .filter(|&i| relative.contains_key(&torques[i].shaft))
        .collect();
    let root_rpm = stated_rpm.get(&root).copied().unwrap_or_else(|| {
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
    }
    balance(root, root_rpm, torques, &mine, &relative, found);
    if has_loop {
        return;
    }
    // From the leaves to the root: what comes together behind a link goes through it.
    let mut behind: BTreeMap<i64, f64> = relative.keys().map(|&s| (s, 0.0)).collect();
    for &i in &mine {
        *behind.entry(torques[i].shaft).or_insert(0.0) +=
            found.torque_nm[i] * relative[&torques[i].shaft];
    }
    for r in reached.iter().rev() {
        let Some((link, parent)) = r.by else { continue };
        let power = behind[&r.shaft];
        *behind.entry(parent).or_insert(0.0) += power;
        let [child_nm, parent_nm] = [power / r.relative, -power / relative[&parent]];
        let is_first = links[link].shafts[0] == r.shaft;
        found.link_nm[link] = Some(if is_first {
            [child_nm, parent_nm]
        } else {
            [parent_nm, child_nm]
        });
    }
}

/// Torques by power, and those that follow from the others.
fn balance(
    root: i64,
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
    found.unbalanced.push((root, left));
}
