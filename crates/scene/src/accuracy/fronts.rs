//! Which rungs were the cheapest for a goal in the scenes that `cargo xtask accuracy-cost` runs. They are where a
//! search begins, no promise: what it finds is judged by runs of the scene itself.

use std::cmp::Reverse;
use std::collections::BTreeMap;

use serde::Deserialize;

use super::knobs::Knob;
use super::ladder::top_of;

/// What `cargo xtask accuracy-cost` has written.
const STORED: &str = include_str!("fronts.toml");

#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
struct Stored {
    front: Vec<Front>,
}

/// The cheapest setting of a scene for a goal.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
struct Front {
    /// Title of the scene.
    scene: String,
    /// As [`super::Bench::kind`].
    kind: String,
    /// Largest relative error.
    goal: f64,
    /// Rung of each knob, from the cheapest.
    rungs: BTreeMap<String, usize>,
}

/// Rungs to begin with, and where they are from: those of the scene of the kind that has most knobs in common and
/// fewest others. A knob that it has not begins at the top.
pub(super) fn start(kind: &str, goal: f64, knobs: &[Knob]) -> (Vec<usize>, String) {
    let stored = toml::from_str::<Stored>(STORED).map_or_else(|_| Vec::new(), |all| all.front);
    start_of(&stored, kind, goal, knobs)
}

fn start_of(stored: &[Front], kind: &str, goal: f64, knobs: &[Knob]) -> (Vec<usize>, String) {
    let tops = top_of(knobs);
    let likeness = |front: &&Front| {
        let has = |knob: &&Knob| front.rungs.contains_key(&knob.name);
        let shared = knobs.iter().filter(has).count();
        (shared, Reverse(front.rungs.len() - shared))
    };
    let alike = stored
        .iter()
        .filter(|front| front.kind == kind && likeness(front).0 > 0);
    // The first of equals.
    let Some(nearest) = alike.rev().max_by_key(likeness) else {
        let below = tops.iter().map(|top| top.saturating_sub(1)).collect();
        let begun = "one rung below the top: no scene of this kind is stored";
        return (below, begun.to_owned());
    };
    // The coarsest goal that serves; where all are coarser, the finest.
    let of_scene = || stored.iter().filter(|front| front.scene == nearest.scene);
    let by_goal = |a: &&Front, b: &&Front| a.goal.total_cmp(&b.goal);
    let serves = |front: &&Front| front.goal <= goal * (1.0 + 1e-9);
    let serving = of_scene().filter(serves).max_by(by_goal);
    let front = serving
        .or_else(|| of_scene().min_by(by_goal))
        .unwrap_or(nearest);
    let rung = |(knob, top): (&Knob, &usize)| {
        let stored = front.rungs.get(&knob.name);
        stored.map_or(*top, |rung| (*rung).min(*top))
    };
    let rungs = knobs.iter().zip(&tops).map(rung).collect();
    let percent = 100.0 * front.goal;
    (
        rungs,
        format!("what \"{}\" needs for {percent} %", front.scene),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn knob(name: &str) -> Knob {
        Knob::of(name, [1, 2, 3].map(toml::Value::Integer))
    }

    fn front(scene: &str, goal: f64, rungs: &[(&str, usize)]) -> Front {
        let rungs = rungs
            .iter()
            .map(|(name, rung)| ((*name).to_owned(), *rung))
            .collect();
        Front {
            scene: scene.to_owned(),
            kind: "pair at rest".to_owned(),
            goal,
            rungs,
        }
    }

    #[test]
    fn a_search_begins_at_the_scene_that_is_most_alike() {
        let stored = [
            front("C", 0.01, &[("a", 1), ("x", 1)]),
            front("A", 0.01, &[("a", 0)]),
            front("B", 0.01, &[("a", 1), ("b", 7)]),
            front("B", 0.001, &[("a", 2), ("b", 1)]),
        ];
        let start = |kind: &str, goal: f64, names: &[&str]| {
            let knobs: Vec<Knob> = names.iter().map(|name| knob(name)).collect();
            start_of(&stored, kind, goal, &knobs)
        };
        let at_rest = "pair at rest";
        assert_eq!(start(at_rest, 0.01, &["a"]).0, [0]);
        // Rungs beyond the ladder are its top, as are knobs that nobody has tried.
        assert_eq!(start(at_rest, 0.05, &["a", "b", "c"]).0, [1, 2, 2]);
        assert_eq!(start(at_rest, 0.005, &["b", "a"]).0, [1, 2]);
        // Finer than all that is stored.
        assert_eq!(start(at_rest, 1e-5, &["b"]).0, [1]);
        assert!(start(at_rest, 1e-5, &["b"]).1.contains("0.1 %"));
        for (kind, names) in [("sweep", ["a"]), (at_rest, ["c"])] {
            assert_eq!(start(kind, 0.01, &names).0, [1]);
        }
    }

    /// What is written by the command is read.
    #[test]
    fn fronts_are_there() {
        let stored: Result<Stored, _> = toml::from_str(STORED);
        assert!(stored.is_ok_and(|all| all.front.len() > 8));
    }
}
