//! A crack in the cross-section of a tooth: a chain of sides of quads from the root's outline to the wanted tip.
//!
//! The mouth is the node of the outline next to the place asked for, moved there along the outline; from there the
//! shortest chain of sides that keeps close to the straight line is followed to a node next to the wanted tip. That
//! node is moved to the very place, and the nodes around move as long as that makes the quads better: depth and
//! angle are those asked for, the sides in between are as ragged as the mesh. All teeth have the same section, the
//! sound ones too.

use crate::MeshError;
use crate::plane::apart;
use crate::tooth_cell::ToothCell;
use gearmesh_geometry::{CrackDefinition, Flank, GearDefinition, ProfileCurve};
use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};

/// Nodes next to the wanted tip that are tried.
const TIPS: usize = 4;
/// How far from the tip nodes move, in sides of quads.
const REACH: usize = 4;
/// Sweeps over them; the last of them move nothing any more.
const SWEEPS: usize = 30;

/// A crack along the sides of a tooth cell's quads.
#[derive(Debug, Clone, PartialEq)]
pub struct CrackLine {
    /// Corners of quads from the mouth to the tip.
    pub path: Vec<usize>,
    /// Nodes to double: all of the path but the tip, with those in the middle of its sides.
    pub doubled: Vec<usize>,
    /// Quads that touch doubled nodes, on the side of the tooth's tip.
    pub beyond: Vec<usize>,
    /// Radius of the mouth \[m\].
    pub mouth_radius_m: f64,
}

/// The line asked for, in the tooth's section.
struct Line {
    mouth: [f64; 2],
    direction: [f64; 2],
    depth: f64,
}

impl Line {
    fn at(&self, s: f64) -> [f64; 2] {
        [0, 1].map(|k| self.mouth[k] + s * self.direction[k])
    }

    fn distance(&self, p: [f64; 2]) -> f64 {
        let from = [p[0] - self.mouth[0], p[1] - self.mouth[1]];
        let along = from[0] * self.direction[0] + from[1] * self.direction[1];
        apart(p, self.at(along.clamp(0.0, self.depth)))
    }
}

impl CrackLine {
    /// Finds the crack of a definition and brings its tip to its place.
    ///
    /// # Errors
    /// [`MeshError::CrackTip`] where the crack leaves the tooth and the ring below it.
    pub fn new(
        cell: &mut ToothCell,
        gear: &GearDefinition,
        crack: &CrackDefinition,
    ) -> Result<Self, MeshError> {
        let curve = ProfileCurve::new(&gear.profile);
        let total = cell.outline_arc_m[cell.outline_arc_m.len() - 1];
        // The definition was checked for this place.
        let arc = curve.arc_length_at(crack.start).unwrap_or_default();
        let wanted = match crack.side {
            Flank::Right => arc,
            Flank::Left => total - arc,
        };
        let off = |i: &usize| (cell.outline_arc_m[*i] - wanted).abs();
        let place = (1..cell.outline.len() - 1).min_by(|a, b| off(a).total_cmp(&off(b)));
        let place = place.unwrap_or_default();
        let mouth = cell.outline[place];
        // The ends of the tooth-only submodel's cut stay.
        if !cell.cut.contains(&mouth) {
            cell.outline_arc_m[place] = wanted;
            cell.nodes[mouth] = on_outline(&curve, total, wanted);
        }
        let (sin, cos) = crack.angle_rad.sin_cos();
        let line = Line {
            mouth: cell.nodes[mouth],
            direction: [-cos, crack.side.mirror() * sin],
            depth: crack.depth_m,
        };
        let path = best_path(cell, mouth, &line, gear.mesh.min_scaled_jacobian)?;
        for side in [place - 1, place] {
            if let Some(&middle) = cell.outline_mid_sides.get(side) {
                let arc = 0.5 * (cell.outline_arc_m[side] + cell.outline_arc_m[side + 1]);
                cell.nodes[middle] = on_outline(&curve, total, arc);
            }
        }
        let (left, right) = sides(cell, &path);
        let mut doubled = path[..path.len() - 1].to_vec();
        doubled.extend(path.windows(2).filter_map(|edge| middle(cell, edge)));
        doubled.sort_unstable();
        Ok(Self {
            mouth_radius_m: line.mouth[0].hypot(line.mouth[1]),
            beyond: match crack.side {
                Flank::Right => right,
                Flank::Left => left,
            },
            doubled,
            path,
        })
    }
}

/// Point of the whole outline at an arc length from the right tooth space, of `total` to the left one.
fn on_outline(curve: &ProfileCurve, total: f64, arc_m: f64) -> [f64; 2] {
    let [x, y] = curve.point_at(arc_m.min(total - arc_m));
    [x, if 2.0 * arc_m > total { -y } else { y }]
}

/// Node in the middle of a side, where elements are quadratic.
fn middle(cell: &ToothCell, edge: &[usize]) -> Option<usize> {
    let quads = cell.quads.iter().zip(&cell.mid_sides);
    for (quad, middles) in quads {
        for k in 0..4 {
            let ends = [quad[k], quad[(k + 1) % 4]];
            if edge.contains(&ends[0]) && edge.contains(&ends[1]) {
                return Some(middles[k]);
            }
        }
    }
    None
}

/// Corners on the edge of the cell, which stay where they are.
fn edge_nodes(cell: &ToothCell) -> HashSet<usize> {
    let lists = [
        &cell.outline,
        &cell.bottom,
        &cell.right_side,
        &cell.left_side,
    ];
    lists.into_iter().flatten().copied().collect()
}

/// Corners next to each corner.
fn neighbours(cell: &ToothCell) -> BTreeMap<usize, BTreeSet<usize>> {
    let mut found: BTreeMap<usize, BTreeSet<usize>> = BTreeMap::new();
    for quad in &cell.quads {
        for k in 0..4 {
            let (a, b) = (quad[k], quad[(k + 1) % 4]);
            found.entry(a).or_default().insert(b);
            found.entry(b).or_default().insert(a);
        }
    }
    found
}

/// Whether a point lies in a quad of the cell.
fn is_inside(cell: &ToothCell, p: [f64; 2]) -> bool {
    cell.quads.iter().any(|quad| {
        (0..4).all(|k| {
            let (a, b) = (cell.nodes[quad[k]], cell.nodes[quad[(k + 1) % 4]]);
            (b[0] - a[0]) * (p[1] - a[1]) >= (b[1] - a[1]) * (p[0] - a[0])
        })
    })
}

/// The path to the nearest node that, brought to the crack's tip, leaves quads as good as `wanted`; where none of the
/// nearest does, to the one that leaves the best.
///
/// # Errors
/// [`MeshError::CrackTip`] where the crack leaves the cell.
fn best_path(
    cell: &mut ToothCell,
    mouth: usize,
    line: &Line,
    wanted: f64,
) -> Result<Vec<usize>, MeshError> {
    let end = line.at(line.depth);
    let edge = edge_nodes(cell);
    let mut tips: Vec<usize> = neighbours(cell).into_keys().collect();
    tips.retain(|n| !edge.contains(n));
    tips.sort_by(|&a, &b| apart(cell.nodes[a], end).total_cmp(&apart(cell.nodes[b], end)));
    tips.truncate(TIPS);
    let before = cell.nodes.clone();
    let mut best: Option<(f64, Vec<[f64; 2]>, Vec<usize>)> = None;
    for (number, tip) in tips.into_iter().enumerate() {
        let path = match follow(cell, mouth, tip, line) {
            Err(_) if number > 0 => continue,
            path => path?,
        };
        place_tip(cell, &path, end);
        let qualities = cell.quads.iter().map(|quad| quality(&cell.nodes, quad));
        let poorest = qualities.fold(f64::INFINITY, f64::min);
        let nodes = std::mem::replace(&mut cell.nodes, before.clone());
        if best.as_ref().is_none_or(|(known, ..)| poorest > *known) {
            best = Some((poorest, nodes, path));
        }
        if poorest >= wanted {
            break;
        }
    }
    let Some((_, nodes, path)) = best else {
        return follow(cell, mouth, mouth, line);
    };
    cell.nodes = nodes;
    Ok(path)
}

/// The chain of sides from the mouth to a tip next to the line's end: shortest where a side that ends d off the line
/// counts 1 + (d/length)² times.
fn follow(
    cell: &ToothCell,
    mouth: usize,
    tip: usize,
    line: &Line,
) -> Result<Vec<usize>, MeshError> {
    let edge = edge_nodes(cell);
    let next = neighbours(cell);
    let end = line.at(line.depth);
    let off = |n: usize| apart(cell.nodes[n], end);
    let size = (next.get(&tip).into_iter().flatten())
        .map(|&n| apart(cell.nodes[n], cell.nodes[tip]))
        .fold(0.0, f64::max);
    if off(tip) > size || !is_inside(cell, end) {
        return Err(MeshError::CrackTip {
            x_mm: end[0] * 1e3,
            y_mm: end[1] * 1e3,
            off_mm: off(tip) * 1e3,
        });
    }
    // Dijkstra's algorithm; the mesh is small enough to look for the nearest open node in a list.
    let mut cost: HashMap<usize, (f64, usize)> = HashMap::from([(mouth, (0.0, mouth))]);
    let mut open = BTreeSet::from([mouth]);
    while let Some(&node) = open
        .iter()
        .min_by(|a, b| cost[*a].0.total_cmp(&cost[*b].0))
        .filter(|node| **node != tip)
    {
        open.remove(&node);
        for &other in next.get(&node).into_iter().flatten() {
            if edge.contains(&other) {
                continue;
            }
            let length = apart(cell.nodes[node], cell.nodes[other]);
            let stray = line.distance(cell.nodes[other]) / length;
            let through = cost[&node].0 + length * (1.0 + stray * stray);
            if cost.get(&other).is_none_or(|known| through < known.0) {
                cost.insert(other, (through, node));
                open.insert(other);
            }
        }
    }
    let mut path = vec![tip];
    while let Some(&node) = path.last()
        && node != mouth
    {
        path.push(cost.get(&node).map_or(mouth, |(_, before)| *before));
    }
    path.reverse();
    Ok(path)
}

/// Moves the end of the path to its place and lets the nodes around it and around the mouth move.
fn place_tip(cell: &mut ToothCell, path: &[usize], place: [f64; 2]) {
    let tip = path[path.len() - 1];
    cell.nodes[tip] = place;
    let held: HashSet<usize> = (edge_nodes(cell).into_iter())
        .chain(cell.cut.iter().copied())
        .chain([tip])
        .collect();
    let next = neighbours(cell);
    let mut near = BTreeSet::from([tip, path[0]]);
    for _ in 0..REACH {
        let around = near.iter().flat_map(|n| next[n].iter().copied());
        near = near.iter().copied().chain(around).collect();
    }
    let mut quads_at: HashMap<usize, Vec<[usize; 4]>> = HashMap::new();
    for quad in &cell.quads {
        for &n in quad {
            quads_at.entry(n).or_default().push(*quad);
        }
    }
    for _ in 0..SWEEPS {
        for &node in near.iter().filter(|n| !held.contains(*n)) {
            let poorest = |nodes: &[[f64; 2]]| {
                let each = quads_at[&node].iter().map(|quad| quality(nodes, quad));
                each.fold(f64::INFINITY, f64::min)
            };
            let (before, old) = (cell.nodes[node], poorest(&cell.nodes));
            let around = &next[&node];
            let mean = |k: usize| {
                around.iter().map(|&n| cell.nodes[n][k]).sum::<f64>() / around.len() as f64
            };
            cell.nodes[node] = [mean(0), mean(1)];
            if poorest(&cell.nodes) <= old {
                cell.nodes[node] = before;
            }
        }
    }
    let moved = |n: usize| near.contains(&n) && (n == tip || n == path[0] || !held.contains(&n));
    for (quad, middles) in cell.quads.iter().zip(&cell.mid_sides) {
        for k in 0..4 {
            let (a, b) = (quad[k], quad[(k + 1) % 4]);
            if moved(a) || moved(b) {
                let (p, q) = (cell.nodes[a], cell.nodes[b]);
                cell.nodes[middles[k]] = [0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1])];
            }
        }
    }
}

/// Smallest scaled Jacobian at the corners of a quad.
fn quality(nodes: &[[f64; 2]], quad: &[usize; 4]) -> f64 {
    let at = |k: usize| nodes[quad[k % 4]];
    let corner = |k: usize| {
        let (p, q, r) = (at(k), at(k + 1), at(k + 3));
        let (a, b) = ([q[0] - p[0], q[1] - p[1]], [r[0] - p[0], r[1] - p[1]]);
        (a[0] * b[1] - a[1] * b[0]) / (a[0].hypot(a[1]) * b[0].hypot(b[1]))
    };
    (0..4).map(corner).fold(f64::INFINITY, f64::min)
}

/// Quads that touch the path short of its tip, to its left and to its right as it runs inwards: those along its sides,
/// and from there across sides that end on the path.
fn sides(cell: &ToothCell, path: &[usize]) -> (Vec<usize>, Vec<usize>) {
    let doubled: HashSet<usize> = path[..path.len() - 1].iter().copied().collect();
    let steps: HashSet<(usize, usize)> = path.windows(2).map(|s| (s[0], s[1])).collect();
    let on_path = |a: usize, b: usize| steps.contains(&(a, b)) || steps.contains(&(b, a));
    let mut across: HashMap<(usize, usize), Vec<usize>> = HashMap::new();
    let directed = |quad: &[usize; 4]| {
        let quad = *quad;
        (0..4).map(move |k| (quad[k], quad[(k + 1) % 4]))
    };
    for (number, quad) in cell.quads.iter().enumerate() {
        for (a, b) in directed(quad) {
            if !on_path(a, b) && (doubled.contains(&a) || doubled.contains(&b)) {
                let side = (a.min(b), a.max(b));
                across.entry(side).or_default().push(number);
            }
        }
    }
    // Quads are counter-clockwise: a side that runs with the path has its quad on the left.
    let reached = |seed: &dyn Fn((usize, usize)) -> bool| -> Vec<usize> {
        let along = |quad: &[usize; 4]| directed(quad).any(seed);
        let quads = cell.quads.iter().enumerate();
        let mut open: Vec<usize> = (quads.filter(|(_, quad)| along(quad)))
            .map(|(number, _)| number)
            .collect();
        let mut found: BTreeSet<usize> = open.iter().copied().collect();
        while let Some(number) = open.pop() {
            for (a, b) in directed(&cell.quads[number]) {
                let others = across.get(&(a.min(b), a.max(b)));
                for &other in others.into_iter().flatten() {
                    if found.insert(other) {
                        open.push(other);
                    }
                }
            }
        }
        found.into_iter().collect()
    };
    (
        reached(&|(a, b)| steps.contains(&(a, b))),
        reached(&|(a, b)| steps.contains(&(b, a))),
    )
}
