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
    /// Whether a sector node lies on cut L.
    on_left_cut: Vec<bool>,
    /// Unknown nodes of the sector, teeth apart.
    sector_nodes: usize,
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
        let [right, left] = body.sector.cuts();
        let mut on_left_cut = vec![false; body.sector.node_count()];
        for &node in left {
            on_left_cut[node] = true;
        }
        let mut place = vec![0; body.sector.node_count()];
        let mut sector_nodes = 0;
        for node in 0..place.len() {
            if !on_left_cut[node] {
                place[node] = sector_nodes;
                sector_nodes += 1;
            }
        }
        for (&r, &l) in right.iter().zip(left) {
            place[l] = place[r];
        }
        let mut shared = vec![false; body.tooth.node_count()];
        for &node in body.tooth.boundary() {
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
            on_left_cut,
            sector_nodes,
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
        3 * (self.sector_nodes + self.body.sector.own * self.inner.len())
    }

    /// First unknown of the inner nodes of the a-th tooth.
    fn tooth_start(&self, a: usize) -> usize {
        3 * (self.sector_nodes + a * self.inner.len())
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

    /// e^{ikα} (a, b) for real and imaginary part a and b; b is zero for real harmonics.
    fn ahead(&self, steps: usize, [a, b]: [f64; 2]) -> [f64; 2] {
        let turned = c64::new(a, b) * self.mass.body.interface.turn(self.harmonic * steps);
        [turned.re, turned.im]
    }

    /// Real and imaginary part of entry `i` of a vector.
    fn entry(&self, x: MatRef<'_, f64>, i: usize, column: usize) -> [f64; 2] {
        let n = self.mass.unknowns();
        let imaginary = if self.parts == 2 {
            x[(n + i, column)]
        } else {
            0.0
        };
        [x[(i, column)], imaginary]
    }

    /// The sector's displacements (rows) from vectors: columns `parts` · vector + part.
    fn on_sector(&self, x: MatRef<'_, f64>) -> Mat<f64> {
        let mass = self.mass;
        let mut on_sector = Mat::zeros(3 * mass.place.len(), self.parts * x.ncols());
        for vector in 0..x.ncols() {
            for (node, &place) in mass.place.iter().enumerate() {
                let steps = usize::from(mass.on_left_cut[node]);
                for axis in 0..3 {
                    let value = self.ahead(steps, self.entry(x, 3 * place + axis, vector));
                    for part in 0..self.parts {
                        on_sector[(3 * node + axis, self.parts * vector + part)] = value[part];
                    }
                }
            }
        }
        on_sector
    }

    /// The displacements of all teeth of the sector, columns tooth by tooth as those of [`Self::on_sector`].
    fn on_teeth(&self, x: MatRef<'_, f64>, on_sector: MatRef<'_, f64>) -> Mat<f64> {
        let (mass, body) = (self.mass, self.mass.body);
        let columns = on_sector.ncols();
        let mut teeth = Mat::zeros(3 * body.tooth.node_count(), body.sector.own * columns);
        for a in 0..body.sector.own {
            let (feet, start) = (body.sector.tooth_nodes(a), mass.tooth_start(a));
            for column in 0..columns {
                let (vector, part) = (column / self.parts, column % self.parts);
                let mut tooth = teeth.col_mut(a * columns + column);
                for (&inside, &node) in body.tooth.boundary().iter().zip(feet) {
                    for axis in 0..3 {
                        tooth[3 * inside + axis] = on_sector[(3 * node + axis, column)];
                    }
                }
                for (i, &inside) in mass.inner.iter().enumerate() {
                    for axis in 0..3 {
                        let value = self.entry(x, start + 3 * i + axis, vector);
                        tooth[3 * inside + axis] = value[part];
                    }
                }
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
        let on_sector = self.on_sector(x);
        let columns = on_sector.ncols();
        let nodes = body.sector.body_nodes();
        let at_body = Mat::from_fn(3 * nodes.len(), columns, |i, column| {
            on_sector[(3 * nodes[i / 3] + i % 3, column)]
        });
        let from_body = of_body(at_body.as_ref());
        let from_teeth = of_tooth(self.on_teeth(x, on_sector.as_ref()).as_ref());
        let mut forces = Mat::zeros(on_sector.nrows(), columns);
        for column in 0..columns {
            for (i, &node) in nodes.iter().enumerate() {
                for axis in 0..3 {
                    forces[(3 * node + axis, column)] += from_body[(3 * i + axis, column)];
                }
            }
            for a in 0..body.sector.own {
                let feet = body.sector.tooth_nodes(a);
                for (&inside, &node) in body.tooth.boundary().iter().zip(feet) {
                    for axis in 0..3 {
                        forces[(3 * node + axis, column)] +=
                            from_teeth[(3 * inside + axis, a * columns + column)];
                    }
                }
            }
        }
        // Forces on cut L act on cut R, as many phases behind.
        let mut result = Mat::zeros(self.size(), x.ncols());
        let (n, own) = (mass.unknowns(), body.sector.own);
        for vector in 0..x.ncols() {
            let first = self.parts * vector;
            for (node, &place) in mass.place.iter().enumerate() {
                let back = usize::from(mass.on_left_cut[node]) * (body.sector.sectors - 1);
                for axis in 0..3 {
                    let force = std::array::from_fn(|part| match part < self.parts {
                        true => forces[(3 * node + axis, first + part)],
                        false => 0.0,
                    });
                    let force = self.ahead(back, force);
                    for part in 0..self.parts {
                        result[(part * n + 3 * place + axis, vector)] += force[part];
                    }
                }
            }
            for (a, part) in (0..own).flat_map(|a| (0..self.parts).map(move |part| (a, part))) {
                let column = a * columns + first + part;
                for (i, &inside) in mass.inner.iter().enumerate() {
                    for axis in 0..3 {
                        let row = part * n + mass.tooth_start(a) + 3 * i + axis;
                        result[(row, vector)] = from_teeth[(3 * inside + axis, column)];
                    }
                }
            }
        }
        result
    }

    /// The shape z (one vector) in a sector, real, over the sector's nodes and then over the nodes of each of its
    /// teeth.
    pub fn in_sector(&self, shape: &[f64], sector: usize) -> (Vec<f64>, Vec<Vec<f64>>) {
        let body = self.mass.body;
        let x = MatRef::from_column_major_slice(shape, shape.len(), 1);
        let on_sector = self.on_sector(x);
        let teeth = self.on_teeth(x, on_sector.as_ref());
        let real = |all: &Mat<f64>, first: usize, row: usize| {
            let imaginary = if self.parts == 2 {
                all[(row, first + 1)]
            } else {
                0.0
            };
            self.ahead(sector, [all[(row, first)], imaginary])[0]
        };
        let rows = |all: &Mat<f64>, first: usize| -> Vec<f64> {
            (0..all.nrows()).map(|row| real(all, first, row)).collect()
        };
        let of_teeth = (0..body.sector.own).map(|a| rows(&teeth, a * self.parts));
        (rows(&on_sector, 0), of_teeth.collect())
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
            |at_body| body.sector.body_stiffness() * at_body,
            |at_teeth| body.tooth.stiffness() * at_teeth,
        )
    }

    /// Inwards from the teeth to the sector and its cuts, round the ring, out again.
    fn solve_in_place(&self, mut b: MatMut<'_, f64>) {
        let (mass, body) = (self.mass, self.mass.body);
        let (n, own, vectors) = (mass.unknowns(), body.sector.own, b.ncols());
        let columns = self.parts * vectors;
        // Of column `parts` · vector + part: the row of an unknown.
        let row = |column: usize, i: usize| (column % self.parts * n + i, column / self.parts);

        let mut loads = Mat::zeros(body.tooth.condensation().size(), own * columns);
        for (a, column) in (0..own).flat_map(|a| (0..columns).map(move |c| (a, c))) {
            for (i, &inside) in mass.inner.iter().enumerate() {
                for axis in 0..3 {
                    let from = row(column, mass.tooth_start(a) + 3 * i + axis);
                    loads[(3 * inside + axis, a * columns + column)] = b[from];
                }
            }
        }
        let in_teeth = body.tooth.condensation().condense(loads.as_ref());
        drop(loads);

        let mut loads = Mat::zeros(body.sector.condensation().size(), columns);
        for column in 0..columns {
            for (node, &place) in mass.place.iter().enumerate() {
                if !mass.on_left_cut[node] {
                    for axis in 0..3 {
                        loads[(3 * node + axis, column)] = b[row(column, 3 * place + axis)];
                    }
                }
            }
            for a in 0..own {
                for (foot, &node) in body.sector.tooth_nodes(a).iter().enumerate() {
                    for axis in 0..3 {
                        loads[(3 * node + axis, column)] +=
                            in_teeth.kept[(3 * foot + axis, a * columns + column)];
                    }
                }
            }
        }
        let in_sector = body.sector.condensation().condense(loads.as_ref());
        drop(loads);

        let cut = body.interface.cut_size();
        let kept = &in_sector.kept;
        let complex = |row: usize, vector: usize| {
            let first = self.parts * vector;
            let imaginary = if self.parts == 2 {
                kept[(row, first + 1)]
            } else {
                0.0
            };
            c64::new(kept[(row, first)], imaginary)
        };
        let turn = body.interface.turn(self.harmonic);
        let mut at_cut = Mat::from_fn(cut, vectors, |i, vector| {
            complex(i, vector) + turn.conj() * complex(cut + i, vector)
        });
        body.interface
            .solve_harmonic(self.harmonic, at_cut.as_mut());
        let cuts = Mat::from_fn(2 * cut, columns, |i, column| {
            let value = at_cut[(i % cut, column / self.parts)];
            let value = if i < cut { value } else { turn * value };
            if column % self.parts == 0 {
                value.re
            } else {
                value.im
            }
        });

        let mut interior = Mat::zeros(body.sector.condensation().interior_size(), columns);
        for column in 0..columns {
            in_sector.put_interior(column, interior.col_mut(column));
        }
        let sector = body.sector.condensation();
        let on_sector = sector.expand(cuts.as_ref(), interior.as_ref());
        drop(interior);

        let feet = Mat::from_fn(
            3 * body.tooth.boundary_count(),
            own * columns,
            |i, column| {
                let node = body.sector.tooth_nodes(column / columns)[i / 3];
                on_sector[(3 * node + i % 3, column % columns)]
            },
        );
        let mut interior = Mat::zeros(body.tooth.condensation().interior_size(), own * columns);
        for column in 0..own * columns {
            in_teeth.put_interior(column, interior.col_mut(column));
        }
        let tooth = body.tooth.condensation();
        let on_teeth = tooth.expand(feet.as_ref(), Some(interior.as_ref()));

        for column in 0..columns {
            for (node, &place) in mass.place.iter().enumerate() {
                if !mass.on_left_cut[node] {
                    for axis in 0..3 {
                        b[row(column, 3 * place + axis)] = on_sector[(3 * node + axis, column)];
                    }
                }
            }
            for a in 0..own {
                for (i, &inside) in mass.inner.iter().enumerate() {
                    for axis in 0..3 {
                        let to = row(column, mass.tooth_start(a) + 3 * i + axis);
                        b[to] = on_teeth[(3 * inside + axis, a * columns + column)];
                    }
                }
            }
        }
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
