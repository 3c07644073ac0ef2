//! The body below the teeth in tetrahedra: the mesh of one sector, copied round the axis and joined to the teeth.

use crate::body_circles::first_tooth;
use crate::elements::ElementList;
use crate::python::PythonEnvironment;
use crate::quality::tetrahedron_jacobian;
use crate::ring_radius::ring_radius_m;
use crate::solid_mesher::{SolidMesh, SolidMeshError, SolidProblem, mesh_solid};
use crate::solid_problem::solid_problem;
use crate::twist::Twist;
use crate::{GearMesh, MeshError};
use gearmesh_elements::TET_EDGES;
use gearmesh_geometry::GearDefinition;
use std::collections::{BTreeMap, HashSet};
use std::f64::consts::TAU;
use std::ops::Range;

/// Distance \[m\] within which nodes of the body and the teeth are one, and nodes lie on the bore.
const SAME_M: f64 = 1e-8;
/// Distortion of an element below which its edges are straightened.
const STRAIGHTENED_BELOW: f64 = 0.3;
/// Rounds of straightening: each may spoil a neighbour.
const ROUNDS: usize = 8;
/// Node that is not known yet.
const NONE: u32 = u32::MAX;

/// The body of a mesh of tetrahedra.
#[derive(Debug, Clone, Default)]
pub struct SolidBody {
    /// Mesh node of each node of a sector's body, by sector, the i-th of each the image of the i-th of the first.
    pub nodes: Vec<Vec<u32>>,
    /// Elements of each sector's body.
    pub elements: Vec<Range<u32>>,
    /// Nodes of the bore.
    pub bore: Vec<u32>,
    /// Nodes of a sector's body on its side at the smaller angle, without those of the teeth; none in a single sector.
    pub right_side: Vec<usize>,
    /// Edges whose middles were taken off a curved surface because an element was folded there.
    pub straightened: usize,
}

/// What the teeth look like from below.
pub struct Foot {
    /// Mesh node by tooth, place along the ring's inner circle and plane; the last place of a tooth is the first of the
    /// next.
    pub ring: Vec<Vec<Vec<u32>>>,
    /// Heights of the planes \[m\].
    pub planes_m: Vec<f64>,
    /// Node in the middle of each edge between two such nodes.
    pub middles: BTreeMap<[u32; 2], u32>,
}

impl Foot {
    /// Pieces of the ring's inner circle below one tooth.
    fn pieces(&self) -> usize {
        self.ring[0].len() - 1
    }
}

/// Two node numbers in order.
pub fn edge(a: u32, b: u32) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

impl SolidBody {
    /// Meshes one sector below the teeth and joins its copies to them; nodes and elements are added to those of the
    /// teeth.
    ///
    /// # Errors
    /// [`MeshError`] when gmsh is missing or fails, when no sector can be cut, or when the mesh does not meet the
    /// teeth.
    pub fn new(
        gear: &GearDefinition,
        python: &PythonEnvironment,
        foot: &Foot,
        twist: &Twist,
        nodes: &mut Vec<[f64; 3]>,
        elements: &mut ElementList,
    ) -> Result<Self, MeshError> {
        let layers = foot.planes_m.len() - 1;
        let problem = solid_problem(gear, foot.pieces(), layers)?;
        let mut mesh = mesh_solid(python, &problem)?;
        let sector = Sector::new(gear, foot, &problem, &mesh)?;
        let straightened = sector.straighten(&mut mesh);
        let mut body = sector.join(gear, foot, twist, &mesh, nodes, elements)?;
        body.straightened = straightened;
        Ok(body)
    }
}

/// Which nodes of a sector's mesh lie where.
struct Sector {
    /// Corner nodes on the ring: place along it from the sector's first tooth, and plane.
    ring: BTreeMap<usize, (usize, usize)>,
    /// The corners at the ends of the edge in whose middle a node is.
    ends: BTreeMap<usize, [usize; 2]>,
    /// Node at the smaller angle of each node at the larger one.
    right_of: BTreeMap<usize, usize>,
    bore: Vec<usize>,
    first_tooth: usize,
}

impl Sector {
    fn new(
        gear: &GearDefinition,
        foot: &Foot,
        problem: &SolidProblem,
        mesh: &SolidMesh,
    ) -> Result<Self, MeshError> {
        let ring_m = ring_radius_m(gear);
        let step = TAU / (gear.tooth.teeth * foot.pieces()) as f64;
        let (start, bore_m) = (problem.start, gear.blank.bore_radius_m());
        let mut ends = BTreeMap::new();
        let mut corners: HashSet<usize> = HashSet::new();
        for element in &mesh.elements {
            corners.extend(&element[..4]);
            for (&[a, b], &middle) in TET_EDGES.iter().zip(&element[4..]) {
                ends.insert(middle, [element[a], element[b]]);
            }
        }
        let mut ring = BTreeMap::new();
        let mut bore = Vec::new();
        for (n, &[x, y, z]) in mesh.nodes.iter().enumerate() {
            let radius = x.hypot(y);
            if (radius - bore_m).abs() < SAME_M {
                bore.push(n);
            }
            if (radius - ring_m).abs() > SAME_M || !corners.contains(&n) {
                continue;
            }
            // Half a piece before the start is the start still.
            let along = ((y.atan2(x) - start) / step + 0.5).rem_euclid(TAU / step) - 0.5;
            let place = along.round();
            let plane = foot.planes_m.partition_point(|p| *p < z - SAME_M);
            let off = foot
                .planes_m
                .get(plane)
                .map_or(f64::INFINITY, |p| (p - z).abs());
            if off > SAME_M || (along - place).abs() * step * ring_m > SAME_M {
                return Err(mismatch(format!(
                    "a node on the ring at x {:.4} y {:.4} z {:.4} mm is none of the teeth's",
                    1e3 * x,
                    1e3 * y,
                    1e3 * z
                )));
            }
            ring.insert(n, (place as usize, plane));
        }
        let arcs = problem.ring_arcs * problem.pieces;
        let places = if problem.closed { arcs } else { arcs + 1 };
        let expected = places * foot.planes_m.len();
        if ring.len() != expected {
            return Err(mismatch(format!(
                "{} nodes on the ring instead of {expected}",
                ring.len()
            )));
        }
        if bore.is_empty() {
            return Err(mismatch("no nodes on the bore".into()));
        }
        Ok(Self {
            ring,
            ends,
            right_of: mesh.left_right.iter().map(|&[l, r]| (l, r)).collect(),
            bore,
            first_tooth: first_tooth(gear)?,
        })
    }

    /// Puts the middles of the edges of folded elements on their chords; returns how many.
    fn straighten(&self, mesh: &mut SolidMesh) -> usize {
        let left_of: BTreeMap<usize, usize> = self.right_of.iter().map(|(&l, &r)| (r, l)).collect();
        let on_ring = |ends: [usize; 2]| ends.iter().all(|end| self.ring.contains_key(end));
        let mut moved = HashSet::new();
        for _ in 0..ROUNDS {
            let folded = mesh.elements.iter().filter(|element| {
                tetrahedron_jacobian(&element.map(|n| mesh.nodes[n])) < STRAIGHTENED_BELOW
            });
            let mut spoilt: Vec<usize> = folded
                .flat_map(|element| element[4..].iter().copied())
                .filter(|n| !on_ring(self.ends[n]) && !moved.contains(n))
                .collect();
            if spoilt.is_empty() {
                break;
            }
            // The same on the other side of the sector.
            let images: Vec<usize> = spoilt
                .iter()
                .filter_map(|n| self.right_of.get(n).or(left_of.get(n)).copied())
                .collect();
            spoilt.extend(images);
            for n in spoilt {
                let [a, b] = self.ends[&n].map(|end| mesh.nodes[end]);
                mesh.nodes[n] = [0, 1, 2].map(|k| 0.5 * (a[k] + b[k]));
                moved.insert(n);
            }
        }
        moved.len()
    }

    /// Copies the sector round the axis.
    fn join(
        &self,
        gear: &GearDefinition,
        foot: &Foot,
        twist: &Twist,
        mesh: &SolidMesh,
        nodes: &mut Vec<[f64; 3]>,
        elements: &mut ElementList,
    ) -> Result<SolidBody, MeshError> {
        let (teeth, sectors) = (gear.tooth.teeth, gear.sectors());
        let own = teeth / sectors;
        let mut maps = vec![vec![NONE; mesh.nodes.len()]; sectors];
        for (sector, map) in maps.iter_mut().enumerate() {
            for (&n, &(place, plane)) in &self.ring {
                let (tooth, place) = (place / foot.pieces(), place % foot.pieces());
                let tooth = (self.first_tooth + sector * own + tooth) % teeth;
                map[n] = foot.ring[tooth][place][plane];
            }
            for (&middle, &[a, b]) in &self.ends {
                if map[a] != NONE
                    && map[b] != NONE
                    && let Some(&node) = foot.middles.get(&edge(map[a], map[b]))
                {
                    map[middle] = node;
                }
            }
            let (sin, cos) = (TAU * sector as f64 / sectors as f64).sin_cos();
            for (n, &[x, y, z]) in mesh.nodes.iter().enumerate() {
                if map[n] == NONE && !self.right_of.contains_key(&n) {
                    map[n] = nodes.len() as u32;
                    nodes.push(twist.point_m([cos * x - sin * y, sin * x + cos * y], z));
                }
            }
        }
        self.check_ring(foot, &maps[0])?;
        for sector in 0..sectors {
            for (&left, &right) in &self.right_of {
                if maps[sector][left] == NONE {
                    maps[sector][left] = maps[(sector + 1) % sectors][right];
                }
            }
            if maps[sector].contains(&NONE) {
                let problem = "a node on one side of the sector has none on the other";
                return Err(mismatch(problem.into()));
            }
        }
        let ranges = maps
            .iter()
            .map(|map| {
                let first = elements.len() as u32;
                for element in &mesh.elements {
                    elements.push(element.map(|n| map[n]));
                }
                first..elements.len() as u32
            })
            .collect();
        let mut bore: Vec<u32> = maps
            .iter()
            .flat_map(|map| self.bore.iter().map(|&n| map[n]))
            .collect();
        bore.sort_unstable();
        bore.dedup();
        let held: HashSet<u32> = foot.ring.iter().flatten().flatten().copied().collect();
        let middles: HashSet<u32> = foot.middles.values().copied().collect();
        let mut right_side: Vec<usize> = self
            .right_of
            .values()
            .copied()
            .filter(|&n| !held.contains(&maps[0][n]) && !middles.contains(&maps[0][n]))
            .collect();
        right_side.sort_unstable();
        Ok(SolidBody {
            nodes: maps,
            elements: ranges,
            bore,
            right_side,
            straightened: 0,
        })
    }

    /// Every edge of the teeth's foot in the sector is an edge of the body: both are cut alike.
    fn check_ring(&self, foot: &Foot, map: &[u32]) -> Result<(), MeshError> {
        let corners: HashSet<u32> = self.ring.keys().map(|&n| map[n]).collect();
        let met: HashSet<u32> = self
            .ends
            .keys()
            .map(|&n| map[n])
            .filter(|&n| n != NONE)
            .collect();
        let missing = foot
            .middles
            .iter()
            .filter(|(ends, middle)| {
                ends.iter().all(|n| corners.contains(n)) && !met.contains(middle)
            })
            .count();
        if missing > 0 {
            let problem = format!("{missing} edges of the teeth's foot are none of the body's");
            return Err(mismatch(problem));
        }
        Ok(())
    }
}

fn mismatch(text: String) -> MeshError {
    SolidMeshError::Mismatch(text).into()
}

impl GearMesh {
    /// Edges of the body whose middles were taken off a curved surface because an element would have been folded there;
    /// zero in hexahedra.
    pub fn straightened_edges(&self) -> usize {
        self.solid.as_ref().map_or(0, |solid| solid.straightened)
    }
}
