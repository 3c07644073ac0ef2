//! The natural modes of one harmonic of a gear that repeats: K φ = ω² M φ over the nodes of one sector.
//!
//! In a field of harmonic k every sector moves as its predecessor does, e^{ikα} ahead in phase, α = 2π/N:
//!
//! ```text
//! u(s) = Re( z e^{iksα} )        s: sector, z: complex displacements of sector 0 in cylindrical components
//! ```
//!
//! The unknowns z are those of sector 0 without its cut L, which is e^{ikα} times its cut R. Written as real numbers
//! (Re z, Im z) the problem is a real symmetric one of twice the size, each frequency of which occurs twice: z and i z
//! are the two members of the pair (the same shape, turned by a quarter of its period). For k = 0 and k = N/2 the
//! factor e^{ikα} is real; z then is real too, and the frequencies are single.
//!
//! With z of modal mass 1 in the sector, Σ_s |u(s)|²_M = N/2 for complex and N for real harmonics:
//! [`HarmonicProblem::scale`].
//!
//! The static condensation of a sector is exact for forces; for K⁻¹ M, what the search needs, it is just another way to
//! solve: M z inwards to the cuts, one small Hermitian system, and outwards again. Source: D. L. Thomas (1979), as in
//! docs/theory/cyclic_symmetry.md.

use crate::cyclic_body::CyclicBody;
use crate::repeated_mesh::RepeatedMesh;
use faer::{Mat, MatMut, MatRef, c64};
use gearmesh_fe::{FeError, FeModel, ModeProblem, SymmetricRows, numbers_without_pattern};

/// Mass of the parts of a sector, and where the unknowns of a harmonic sit in them. The same for all harmonics.
pub(crate) struct SectorMass<'a> {
    body: &'a CyclicBody,
    tooth: SymmetricRows,
    hub: SymmetricRows,
    /// Unknown node of each sector node; that of a node of cut L is its image on cut R.
    place: Vec<usize>,
    /// Sector node of each unknown node, teeth apart.
    node: Vec<usize>,
    /// Nodes of the tooth cell that are not shared with the sector.
    inner: Vec<usize>,
}

impl<'a> SectorMass<'a> {
    /// Assembles the mass of a tooth cell and of the body of a sector.
    ///
    /// # Errors
    /// [`FeError::DensityOutOfRange`].
    pub fn new(
        body: &'a CyclicBody,
        mesh: &impl RepeatedMesh,
        model: &FeModel,
        fixed: &[bool],
        density_kg_per_m3: f64,
    ) -> Result<Self, FeError> {
        let [right, left] = &body.sector.cuts;
        let mut on_left_cut = vec![false; body.sector.node_count()];
        for &node in left {
            on_left_cut[node] = true;
        }
        let all = 0..on_left_cut.len();
        let node: Vec<usize> = all.filter(|&node| !on_left_cut[node]).collect();
        let mut place = vec![0; on_left_cut.len()];
        for (unknown, &node) in node.iter().enumerate() {
            place[node] = unknown;
        }
        for (&r, &l) in right.iter().zip(left) {
            place[l] = place[r];
        }
        let mut shared = vec![false; body.tooth.node_count()];
        for &node in &body.tooth.boundary {
            shared[node] = true;
        }
        Ok(Self {
            body,
            tooth: SymmetricRows::new(&body.tooth.mass(model, density_kg_per_m3)?),
            hub: SymmetricRows::new(&body.sector.body_mass(
                mesh,
                model,
                fixed,
                density_kg_per_m3,
            )?),
            place,
            node,
            inner: (0..shared.len()).filter(|&n| !shared[n]).collect(),
        })
    }

    /// Number of harmonics, 0 to N/2.
    pub fn harmonics(&self) -> usize {
        self.body.sector.sectors / 2 + 1
    }

    /// The problem of a harmonic.
    pub fn harmonic(&self, k: usize) -> HarmonicProblem<'_> {
        let sectors = self.body.sector.sectors;
        HarmonicProblem {
            mass: self,
            harmonic: k,
            parts: if k == 0 || 2 * k == sectors { 1 } else { 2 },
        }
    }

    /// Displacements in one sector.
    fn unknowns(&self) -> usize {
        3 * (self.node.len() + self.body.sector.own * self.inner.len())
    }

    /// First unknown of the inner nodes of the a-th tooth.
    fn tooth_start(&self, a: usize) -> usize {
        3 * (self.node.len() + a * self.inner.len())
    }
}

/// One harmonic. A vector is (Re z, Im z), or z alone where it is real; z over the sector's nodes without cut L, then
/// over the inner nodes of its teeth, three displacements each.
pub(crate) struct HarmonicProblem<'a> {
    mass: &'a SectorMass<'a>,
    harmonic: usize,
    /// 1 for real harmonics, 2 for complex ones.
    parts: usize,
}

impl HarmonicProblem<'_> {
    /// Members of each frequency: 1, or 2 for a pair.
    pub fn multiplicity(&self) -> usize {
        self.parts
    }

    /// Factor of a shape of modal mass 1 in the sector that makes it one in the whole gear.
    pub fn scale(&self) -> f64 {
        (self.parts as f64 / self.mass.body.sector.sectors as f64).sqrt()
    }

    /// e^{iksα}: what sector s has more in phase than sector 0.
    fn turn(&self, s: usize) -> c64 {
        self.mass.body.interface.turn(self.harmonic * s)
    }

    /// Part of an entry of column `parts` · vector + part, turned by a phase.
    fn turned(&self, all: &Mat<f64>, (row, first): (usize, usize), turn: c64) -> c64 {
        let imaginary = match self.parts {
            2 => all[(row, first + 1)],
            _ => 0.0,
        };
        turn * c64::new(all[(row, first)], imaginary)
    }

    /// Turns what the sector has on its cut L.
    fn turn_left_cut(&self, on_sector: &mut Mat<f64>, turn: c64) {
        let [_, left] = &self.mass.body.sector.cuts;
        for first in (0..on_sector.ncols()).step_by(self.parts) {
            for row in left.iter().flat_map(|node| 3 * node..3 * node + 3) {
                let value = self.turned(on_sector, (row, first), turn);
                on_sector[(row, first)] = value.re;
                if self.parts == 2 {
                    on_sector[(row, first + 1)] = value.im;
                }
            }
        }
    }

    /// The unknowns of column `parts` · vector + part.
    fn unknowns<'x>(&self, x: &'x Mat<f64>, column: usize) -> &'x [f64] {
        let n = self.mass.unknowns();
        &x.col_as_slice(column / self.parts)[column % self.parts * n..][..n]
    }

    /// The same to be written.
    fn unknowns_mut<'x>(&self, x: &'x mut Mat<f64>, column: usize) -> &'x mut [f64] {
        let n = self.mass.unknowns();
        &mut x.col_as_slice_mut(column / self.parts)[column % self.parts * n..][..n]
    }

    /// The sector's displacements (rows) from vectors: columns `parts` · vector + part.
    fn on_sector(&self, x: &Mat<f64>) -> Mat<f64> {
        let place = &self.mass.place;
        let mut on_sector = Mat::zeros(3 * place.len(), self.parts * x.ncols());
        for column in 0..on_sector.ncols() {
            let nodes = place.iter().copied().enumerate();
            let own = self.unknowns(x, column);
            put(on_sector.col_as_slice_mut(column), own, nodes);
        }
        self.turn_left_cut(&mut on_sector, self.turn(1));
        on_sector
    }

    /// The displacements of all teeth of the sector, columns tooth by tooth as those of [`Self::on_sector`].
    fn on_teeth(&self, x: &Mat<f64>, on_sector: &Mat<f64>) -> Mat<f64> {
        let (mass, body) = (self.mass, self.mass.body);
        let columns = on_sector.ncols();
        let mut teeth = Mat::zeros(3 * body.tooth.node_count(), body.sector.own * columns);
        for a in 0..body.sector.own {
            for column in 0..columns {
                let tooth = teeth.col_as_slice_mut(a * columns + column);
                put(tooth, on_sector.col_as_slice(column), feet(body, a));
                let inner = &self.unknowns(x, column)[mass.tooth_start(a)..];
                put(tooth, inner, counted(&mass.inner));
            }
        }
        teeth
    }

    /// A X for a matrix A of the sector given by its products on the body and on a tooth.
    fn product(
        &self,
        x: MatRef<'_, f64>,
        of_body: impl Fn(MatRef<'_, f64>) -> Mat<f64>,
        of_tooth: impl Fn(MatRef<'_, f64>) -> Mat<f64>,
    ) -> Mat<f64> {
        let (mass, body) = (self.mass, self.mass.body);
        let x = x.to_owned();
        let on_sector = self.on_sector(&x);
        let columns = on_sector.ncols();
        let nodes = &body.sector.body_nodes;
        let mut at_body = Mat::zeros(3 * nodes.len(), columns);
        for column in 0..columns {
            let to = at_body.col_as_slice_mut(column);
            put(
                to,
                on_sector.col_as_slice(column),
                turned_round(counted(nodes)),
            );
        }
        let from_body = of_body(at_body.as_ref());
        let from_teeth = of_tooth(self.on_teeth(&x, &on_sector).as_ref());
        let mut forces = Mat::zeros(on_sector.nrows(), columns);
        for column in 0..columns {
            let total = forces.col_as_slice_mut(column);
            add(total, from_body.col_as_slice(column), counted(nodes));
            for a in 0..body.sector.own {
                let tooth = from_teeth.col_as_slice(a * columns + column);
                add(total, tooth, turned_round(feet(body, a)));
            }
        }
        // Forces on cut L act on cut R, as many phases behind.
        self.turn_left_cut(&mut forces, self.turn(1).conj());
        let mut result = Mat::zeros(self.size(), x.ncols());
        for column in 0..columns {
            let own = self.unknowns_mut(&mut result, column);
            let places = mass.place.iter().copied().enumerate();
            add(own, forces.col_as_slice(column), turned_round(places));
            for a in 0..body.sector.own {
                let tooth = from_teeth.col_as_slice(a * columns + column);
                let inner = turned_round(counted(&mass.inner));
                put(&mut own[mass.tooth_start(a)..], tooth, inner);
            }
        }
        result
    }

    /// The shape z (one vector) in a sector, real, over the sector's nodes and then over the nodes of each of its
    /// teeth.
    pub fn in_sector(&self, shape: &[f64], sector: usize) -> (Vec<f64>, Vec<Vec<f64>>) {
        let body = self.mass.body;
        let x = MatRef::from_column_major_slice(shape, shape.len(), 1).to_owned();
        let on_sector = self.on_sector(&x);
        let teeth = self.on_teeth(&x, &on_sector);
        let turn = self.turn(sector);
        let rows = |all: &Mat<f64>, first: usize| -> Vec<f64> {
            let rows = 0..all.nrows();
            rows.map(|row| self.turned(all, (row, first), turn).re)
                .collect()
        };
        let of_teeth = (0..body.sector.own).map(|a| rows(&teeth, a * self.parts));
        (rows(&on_sector, 0), of_teeth.collect())
    }

    /// Displacements of both cuts from the loads that were carried to them, columns `parts` · vector + part.
    fn at_cuts(&self, loads: &Mat<f64>, vectors: usize) -> Mat<f64> {
        let interface = &self.mass.body.interface;
        let (cut, turn) = (interface.cut_size(), self.turn(1));
        let complex = |row: usize, vector: usize, turn: c64| {
            self.turned(loads, (row, self.parts * vector), turn)
        };
        let mut at_cut = Mat::from_fn(cut, vectors, |i, vector| {
            complex(i, vector, c64::new(1.0, 0.0)) + complex(cut + i, vector, turn.conj())
        });
        interface.solve_harmonic(self.harmonic, at_cut.as_mut());
        Mat::from_fn(2 * cut, self.parts * vectors, |i, column| {
            let value = at_cut[(i % cut, column / self.parts)];
            let value = if i < cut { value } else { turn * value };
            match column % self.parts {
                0 => value.re,
                _ => value.im,
            }
        })
    }
}

/// Pairs of nodes between which components go: where to and where from.
trait NodePairs: Iterator<Item = (usize, usize)> {}

impl<I: Iterator<Item = (usize, usize)>> NodePairs for I {}

/// To the listed nodes from those of a list of their own.
fn counted(nodes: &[usize]) -> impl NodePairs {
    nodes.iter().copied().zip(0..)
}

/// To the feet of a tooth cell from the sector's nodes.
fn feet(body: &CyclicBody, tooth: usize) -> impl NodePairs {
    let of_sector = body.sector.tooth_nodes(tooth).iter().copied();
    body.tooth.boundary.iter().copied().zip(of_sector)
}

/// The other way.
fn turned_round(nodes: impl NodePairs) -> impl NodePairs {
    nodes.map(|(to, from)| (from, to))
}

/// Copies the components of nodes.
fn put(to: &mut [f64], from: &[f64], nodes: impl NodePairs) {
    for (at, of) in nodes {
        to[3 * at..3 * at + 3].copy_from_slice(&from[3 * of..3 * of + 3]);
    }
}

/// Adds them.
fn add(to: &mut [f64], from: &[f64], nodes: impl NodePairs) {
    for (at, of) in nodes {
        for axis in 0..3 {
            to[3 * at + axis] += from[3 * of + axis];
        }
    }
}

impl ModeProblem for HarmonicProblem<'_> {
    fn size(&self) -> usize {
        self.parts * self.mass.unknowns()
    }

    fn mass_product(&self, x: MatRef<'_, f64>) -> Mat<f64> {
        self.product(
            x,
            |at_body| self.mass.hub.product(at_body),
            |at_teeth| self.mass.tooth.product(at_teeth),
        )
    }

    fn stiffness_product(&self, x: MatRef<'_, f64>) -> Mat<f64> {
        let body = self.mass.body;
        self.product(
            x,
            |at_body| body.sector.body_stiffness.as_ref() * at_body,
            |at_teeth| body.tooth.stiffness.as_ref() * at_teeth,
        )
    }

    /// Inwards from the teeth to the sector and its cuts, round the ring, out again.
    fn solve_in_place(&self, mut b: MatMut<'_, f64>) {
        let (mass, body) = (self.mass, self.mass.body);
        let (own, vectors) = (body.sector.own, b.ncols());
        let columns = self.parts * vectors;
        let mut x = b.to_owned();
        let (tooth, sector) = (&body.tooth.condensation, &body.sector.condensation);

        let mut loads = Mat::zeros(tooth.size(), own * columns);
        for (a, column) in (0..own).flat_map(|a| (0..columns).map(move |c| (a, c))) {
            let inner = &self.unknowns(&x, column)[mass.tooth_start(a)..];
            let to = loads.col_as_slice_mut(a * columns + column);
            put(to, inner, counted(&mass.inner));
        }
        let in_teeth = tooth.condense(loads.as_ref());
        drop(loads);

        let mut loads = Mat::zeros(sector.size(), columns);
        for column in 0..columns {
            let to = loads.col_as_slice_mut(column);
            put(to, self.unknowns(&x, column), counted(&mass.node));
            for a in 0..own {
                let of_tooth = in_teeth.kept.col_as_slice(a * columns + column);
                add(to, of_tooth, counted(body.sector.tooth_nodes(a)));
            }
        }
        let in_sector = sector.condense(loads.as_ref());
        drop(loads);

        let cuts = self.at_cuts(&in_sector.kept, vectors);
        let mut interior = Mat::zeros(sector.interior_size(), columns);
        for column in 0..columns {
            in_sector.put_interior(column, interior.col_mut(column));
        }
        let on_sector = sector.expand(cuts.as_ref(), interior.as_ref());
        drop(interior);

        let mut feet = Mat::zeros(3 * body.tooth.boundary_count(), own * columns);
        let mut interior = Mat::zeros(tooth.interior_size(), own * columns);
        for (a, column) in (0..own).flat_map(|a| (0..columns).map(move |c| (a, c))) {
            let both = a * columns + column;
            let nodes = turned_round(counted(body.sector.tooth_nodes(a)));
            put(
                feet.col_as_slice_mut(both),
                on_sector.col_as_slice(column),
                nodes,
            );
            in_teeth.put_interior(both, interior.col_mut(both));
        }
        let on_teeth = tooth.expand(feet.as_ref(), Some(interior.as_ref()));

        for column in 0..columns {
            let to = self.unknowns_mut(&mut x, column);
            let nodes = turned_round(counted(&mass.node));
            put(to, on_sector.col_as_slice(column), nodes);
            for a in 0..own {
                let of_tooth = on_teeth.col_as_slice(a * columns + column);
                let inner = turned_round(counted(&mass.inner));
                put(&mut to[mass.tooth_start(a)..], of_tooth, inner);
            }
        }
        b.copy_from(&x);
    }

    /// Closed under multiplication by i, so that both members of each pair are found at the same step.
    fn start(&self, columns: usize) -> Mat<f64> {
        let n = self.mass.unknowns();
        let number = numbers_without_pattern(self.size(), columns);
        Mat::from_fn(self.size(), columns, |i, j| {
            if self.parts == 1 || j % 2 == 0 {
                number[(i, j)]
            } else if i < n {
                -number[(n + i, j - 1)]
            } else {
                number[(i - n, j - 1)]
            }
        })
    }
}
