//! Positions beside the even grid of a run, under each torque of its own: where a pair of teeth takes load or gives it
//! up, where contact goes from a flank to a tip edge or back, and at the peaks.
//!
//! Even positions see what happens between them by chance only: the transmission error has corners, and on the line of
//! action jumps, at those events, and a slice of a helical pair is pressed most where it leaves the path. The pairs
//! and slices that carry at neighbouring positions say that something has happened between them; halving finds it. Then
//! the steps in which a curve may come highest are halved, until less than [`PEAK_SHARE`] may be open.
//!
//! Only the first period of the run is looked at: the others are alike. Means, spectra and everything else that goes
//! over a period are those of the even grid.

use super::contact_places::ContactPlaces;
use super::position::{Position, PositionSolver};
use super::run::RunError;
use gearmesh_contact::FlanksAtRest;
use std::ops::Range;

/// Halvings of an even step for an event: it is known to 1/32 of a step, on both sides.
const EVENT_HALVINGS: usize = 5;

/// Steps in which slices take load or give it up are halved while they are longer than this share of a pitch: a wave of
/// the curves may lie between two slices.
const SLICE_STEP: f64 = 1.0 / 128.0;

/// A peak is followed until less than this share may still be open: of the peak-to-peak value of the transmission
/// error, of the largest pressure, of K_Hβ.
pub const PEAK_SHARE: f64 = 3e-4;

/// Halvings for the peak of a figure at most. Each leaves half of what is open at a corner, a quarter at a smooth peak.
const MOST_HALVINGS: usize = 100;

/// Positions of a result beside its even grid, torque after torque, by rising angle. E positions, L lines, S slices.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct BetweenPositions {
    /// Positions of each torque, T.
    pub count: Vec<u32>,
    /// Driver angles \[rad\], E.
    pub angle_rad: Vec<f64>,
    /// Transmission error \[m\], E.
    pub te_m: Vec<f64>,
    /// Transmission error at first touch \[m\], E.
    pub unloaded_m: Vec<f64>,
    /// Tangent mesh stiffness \[N/m\], E.
    pub tangent_n_per_m: Vec<f64>,
    /// Contact lines L.
    pub slots: usize,
    /// Slice forces \[N\], `[E][L][S]`.
    pub force_n: Vec<f64>,
    /// Hertz pressure \[Pa\], `[E][L][S]`.
    pub pressure_pa: Vec<f64>,
    /// Pair of teeth of each line, `[E][L]`; of families that store places with each position, as the next.
    pub pair: Vec<f64>,
    /// Where the slices touch, `[E][L][S]`.
    pub places: Option<ContactPlaces>,
    /// What steps of this length still leave open: of the transmission error's peak-to-peak value, as a share of it, T.
    pub te_error: Vec<f64>,
    /// Of the largest pressure, T.
    pub pressure_error: Vec<f64>,
    /// Of K_Hβ, T.
    pub k_h_beta_error: Vec<f64>,
}

impl BetweenPositions {
    /// The positions of a torque; none of a result of an older program.
    #[must_use]
    pub fn of(&self, torque: usize) -> Range<usize> {
        let before = self.count.iter().take(torque).sum::<u32>() as usize;
        before..before + self.count.get(torque).map_or(0, |count| *count as usize)
    }

    /// Slice forces \[N\] at a position, `[L][S]`.
    #[must_use]
    pub fn position_forces(&self, position: usize) -> &[f64] {
        let size = self.force_n.len() / self.angle_rad.len().max(1);
        &self.force_n[position * size..][..size]
    }

    /// Those that were found under each torque.
    pub(super) fn new(found: Vec<Found>, slices: usize) -> Self {
        let lines = |p: &Position| p.force_n.len() / slices.max(1);
        let all = || found.iter().flat_map(|found| &found.positions);
        let mut it = Self {
            slots: all().map(lines).max().unwrap_or(1).max(1),
            te_error: found.iter().map(|found| found.errors[0]).collect(),
            pressure_error: found.iter().map(|found| found.errors[1]).collect(),
            k_h_beta_error: found.iter().map(|found| found.errors[2]).collect(),
            count: (found.iter().map(|found| found.positions.len() as u32)).collect(),
            ..Self::default()
        };
        for p in found.into_iter().flat_map(|found| found.positions) {
            it.angle_rad.push(p.angle_rad);
            it.te_m.push(p.te_m);
            it.unloaded_m.push(p.unloaded_m);
            it.tangent_n_per_m.push(p.tangent_n_per_m);
            let unused = it.slots * slices - p.force_n.len();
            if !p.places.is_empty() {
                let no_pair = std::iter::repeat(0.0);
                it.pair.extend(
                    (p.pairs.iter().map(|pair| *pair as f64))
                        .chain(no_pair)
                        .take(it.slots),
                );
                let places = it.places.get_or_insert_default();
                places.push(p.places.iter().copied(), it.slots * slices);
            }
            for (all, own) in [
                (&mut it.force_n, p.force_n),
                (&mut it.pressure_pa, p.pressure_pa),
            ] {
                all.extend(own);
                all.extend(std::iter::repeat_n(0.0, unused));
            }
        }
        it
    }
}

/// Positions of one torque, by rising angle, and what is left open of transmission error, pressure and K_Hβ.
#[derive(Default)]
pub(super) struct Found {
    pub positions: Vec<Position>,
    pub errors: [f64; 3],
}

/// A position of the even grid, of which only the figures are looked at, or one that was added.
enum Node<'a> {
    Even(&'a Position),
    Added(Box<Position>),
}

impl Node<'_> {
    fn get(&self) -> &Position {
        match self {
            Self::Even(position) => position,
            Self::Added(position) => position,
        }
    }
}

/// What lies between even positions; `even`: those that are looked at. Where the run repeats after them, `repeats`, the
/// steps before the first one and after the last one are looked at, too.
///
/// # Errors
/// [`RunError::Contact`] where a position has no solution.
pub(super) fn find<F: FlanksAtRest>(
    solver: &mut PositionSolver<'_, F>,
    even: &[Position],
    repeats: bool,
) -> Result<Found, RunError> {
    let [first, second, ..] = even else {
        return Ok(Found::default());
    };
    let step = second.angle_rad - first.angle_rad;
    // Both ends belong to the period before and the one after: for their neighbours' sake only.
    let ends = if repeats {
        let after = first.angle_rad + step * even.len() as f64;
        Some([solver.at(first.angle_rad - step)?, solver.at(after)?])
    } else {
        None
    };
    let mut nodes: Vec<Node<'_>> = Vec::with_capacity(2 * even.len());
    let [before, after] = ends.as_ref().map_or([None; 2], |[a, b]| [Some(a), Some(b)]);
    nodes.extend(before.map(Node::Even));
    for (number, here) in even.iter().enumerate() {
        nodes.push(Node::Even(here));
        if let Some(next) = even.get(number + 1).or(after) {
            let mut found = Vec::new();
            halve(solver, [here, next], 0, &mut found)?;
            found.sort_by(|a, b| a.angle_rad.total_cmp(&b.angle_rad));
            nodes.extend(
                found
                    .into_iter()
                    .map(|position| Node::Added(Box::new(position))),
            );
        }
    }
    nodes.extend(after.map(Node::Even));
    let te: [fn(&Position) -> f64; 2] = [|p| p.te_m, |p| -p.te_m];
    let mut te_error = 0.0;
    let range = spread(&nodes, te[0]);
    for value in te {
        te_error += follow(solver, &mut nodes, value, range)?;
    }
    let pressure: fn(&Position) -> f64 = Position::pressure_largest_pa;
    let largest = highest(&nodes, pressure);
    let pressure_error = follow(solver, &mut nodes, pressure, largest)?;
    let factor: fn(&Position) -> f64 = |p| p.k_h_beta;
    let largest = highest(&nodes, factor);
    let factor_error = follow(solver, &mut nodes, factor, largest)?;
    let errors = [
        over(te_error, spread(&nodes, te[0])),
        over(pressure_error, highest(&nodes, pressure)),
        over(factor_error, highest(&nodes, factor)),
    ];
    let added = |node: Node<'_>| match node {
        Node::Added(position) => Some(*position),
        Node::Even(_) => None,
    };
    let positions = nodes.into_iter().filter_map(added).collect();
    Ok(Found { positions, errors })
}

fn over(part: f64, whole: f64) -> f64 {
    if whole > 0.0 { part / whole } else { 0.0 }
}

fn highest(nodes: &[Node<'_>], value: fn(&Position) -> f64) -> f64 {
    let values = nodes.iter().map(|node| value(node.get()));
    values.fold(f64::NEG_INFINITY, f64::max)
}

fn spread(nodes: &[Node<'_>], value: fn(&Position) -> f64) -> f64 {
    let values = nodes.iter().map(|node| value(node.get()));
    highest(nodes, value) - values.fold(f64::INFINITY, f64::min)
}

/// Halves the step between two positions at which other pairs or other slices carry, and each half in which that is so,
/// and keeps the positions in between. `halvings`: how often it was halved.
fn halve<F: FlanksAtRest>(
    solver: &mut PositionSolver<'_, F>,
    [a, b]: [&Position; 2],
    halvings: usize,
    found: &mut Vec<Position>,
) -> Result<(), RunError> {
    let an_event = a.carriers != b.carriers && halvings < EVENT_HALVINGS;
    let is_long = b.angle_rad - a.angle_rad > SLICE_STEP * solver.measures.pitch_rad;
    if !(an_event || is_long && a.carrying != b.carrying) {
        return Ok(());
    }
    let middle = solver.at(0.5 * (a.angle_rad + b.angle_rad))?;
    halve(solver, [a, &middle], halvings + 1, found)?;
    halve(solver, [&middle, b], halvings + 1, found)?;
    found.push(middle);
    Ok(())
}

/// Halves the step in which a figure may come highest, until it can come above what was found by [`PEAK_SHARE`] of
/// `scale` at most; returns by how much it still may.
fn follow<F: FlanksAtRest>(
    solver: &mut PositionSolver<'_, F>,
    nodes: &mut Vec<Node<'_>>,
    value: fn(&Position) -> f64,
    scale: f64,
) -> Result<f64, RunError> {
    for halvings in 0.. {
        let steps = 0..nodes.len().saturating_sub(1);
        let reached = steps.map(|step| (reach(nodes, step, value), step));
        let Some((reach, step)) = reached.max_by(|a, b| a.0.total_cmp(&b.0)) else {
            break;
        };
        let open = (reach - highest(nodes, value)).max(0.0);
        if open <= PEAK_SHARE * scale || halvings == MOST_HALVINGS {
            return Ok(open);
        }
        let [a, b] = [step, step + 1].map(|k| nodes[k].get().angle_rad);
        nodes.insert(step + 1, Node::Added(Box::new(solver.at(0.5 * (a + b))?)));
    }
    Ok(0.0)
}

/// How high a figure may come between a position and the next.
///
/// It goes on as steeply as it comes to either end, over the whole step at most: it has corners where slices take load,
/// and jumps where pairs of teeth do, across which nothing is said about how steep it is.
fn reach(nodes: &[Node<'_>], step: usize, value: fn(&Position) -> f64) -> f64 {
    let at = |k: usize| nodes.get(k).map(Node::get);
    let [a, b] = [nodes[step].get(), nodes[step + 1].get()];
    // By how much it rises over the step as it does from a position to the one beside it.
    let rise = |from: Option<&Position>, to: &Position| {
        let from = from.filter(|from| from.carriers == to.carriers);
        from.map_or(0.0, |from| {
            let slope = (value(to) - value(from)) / (to.angle_rad - from.angle_rad).abs();
            slope.max(0.0) * (b.angle_rad - a.angle_rad)
        })
    };
    let before = step.checked_sub(1).and_then(at);
    (value(a) + rise(before, a)).max(value(b) + rise(at(step + 2), b))
}
