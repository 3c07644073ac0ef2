//! A gear solved by its repetition: teeth condensed to their feet, a sector to its cuts, the ring by harmonics.
//!
//! | level | eliminated | kept | how often |
//! | --- | --- | --- | --- |
//! | [`ToothSubstructure`] | inside of a tooth cell | nodes shared with the rest | once, all teeth are equal |
//! | [`SectorSubstructure`] | body and tooth feet of a sector | its two cuts | once, all sectors are equal |
//! | [`CyclicInterface`] | the ring of cuts | nothing | one small Hermitian system per harmonic |
//!
//! Exact: the same linear algebra as one factorisation of the whole gear, in another order. Components are cylindrical
//! throughout. docs/theory/cyclic_symmetry.md has the derivation.

use crate::Progress;
use crate::flank_loads::SparseVector;
use crate::sector_substructure::SectorSubstructure;
use crate::tooth_substructure::{ToothSubstructure, add_turned};
use faer::{Mat, MatRef};
use gearmesh_fe::{CondensedLoads, CyclicInterface, CylindricalFrames, FeError, FeModel};
use gearmesh_mesh::GearMesh;
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::time::Instant;

/// Loads of a sector that are solved together.
const BLOCK: usize = 128;
/// Full fields that are made together.
const FIELDS: usize = 8;

/// A gear held at its bore, factorised tooth by tooth, sector by sector, harmonic by harmonic.
pub struct CyclicBody {
    frames: CylindricalFrames,
    tooth: ToothSubstructure,
    sector: SectorSubstructure,
    interface: CyclicInterface,
    /// Tooth and cell node, or sector and sector node, of each mesh node.
    places: Vec<Place>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Place {
    Tooth(u32, u32),
    Sector(u32, u32),
    Fixed,
}

/// What loads do to the sectors, before anything inside the teeth is asked for.
struct Response {
    /// Displacements of each sector's nodes, sector displacements × cases.
    sectors: Vec<Mat<f64>>,
    /// (tooth, case) of the columns of `inside`.
    loaded: BTreeMap<usize, Vec<(usize, usize)>>,
    /// The loads inside the teeth.
    inside: CondensedLoads,
}

impl CyclicBody {
    /// Factorises the three levels. `fixed` tells the nodes that are held; the wall time of each stage is added to
    /// `stage_seconds`.
    ///
    /// # Errors
    /// [`FeError`] when the body is not held or memory is short.
    pub fn new(
        mesh: &GearMesh,
        model: &FeModel,
        fixed: &[bool],
        progress: &dyn Progress,
        stage_seconds: &mut Vec<(String, f64)>,
    ) -> Result<Self, FeError> {
        let mut clock = Instant::now();
        let mut lap = |name: &str| {
            stage_seconds.push((name.to_string(), clock.elapsed().as_secs_f64()));
            clock = Instant::now();
        };
        progress.stage("condensing a tooth");
        let tooth = ToothSubstructure::new(mesh, model)?;
        lap("tooth factor");
        progress.stage("condensing a sector");
        let sector = SectorSubstructure::new(mesh, model, fixed, &tooth)?;
        lap("sector factor");
        progress.stage("factoring harmonics");
        let interface = CyclicInterface::new(sector.condensation().stiffness(), sector.sectors)?;
        lap("harmonics");
        let mut places = vec![Place::Fixed; mesh.nodes.len()];
        for s in 0..sector.sectors {
            for i in 0..sector.node_count() {
                if let Some(node) = sector.node(mesh, &tooth, s, i) {
                    places[node as usize] = Place::Sector(s as u32, i as u32);
                }
            }
        }
        for t in 0..mesh.section.cell_nodes.len() {
            for i in 0..tooth.node_count() {
                if let Some(node) = tooth.node(mesh, t, i) {
                    places[node as usize] = Place::Tooth(t as u32, i as u32);
                }
            }
        }
        Ok(Self {
            frames: CylindricalFrames::new(mesh.nodes.iter().copied()),
            tooth,
            sector,
            interface,
            places,
        })
    }

    /// Number and sizes of the factorisations: tooth, sector and harmonics.
    pub fn effort(&self) -> Vec<(&'static str, usize)> {
        vec![
            ("factorisations", 2 + self.interface.harmonics()),
            ("DOF of a tooth", self.tooth.condensation().size()),
            ("DOF at its foot", 3 * self.tooth.boundary_count()),
            ("DOF of a sector", self.sector.condensation().size()),
            ("DOF of a cut", self.interface.cut_size()),
            ("harmonics", self.interface.harmonics()),
        ]
    }

    /// aᵀ K⁻¹ b for vectors that are given on tooth 0 and placed, turned, on every tooth:
    /// `[loaded tooth 0..own][load][tooth][response]`.
    pub fn compliance(&self, vectors: &[&SparseVector], progress: &dyn Progress) -> Vec<f64> {
        let n = vectors.len();
        let own = self.sector.own;
        let teeth = own * self.sector.sectors;
        let on_tooth = self.tooth.condense(&self.frames, vectors);
        let inside_tooth = on_tooth.gram(&on_tooth);
        let mut inside_sector = Mat::<f64>::zeros(own * n, own * n);
        let mut at_cuts = Mat::<f64>::zeros(2 * self.interface.cut_size(), own * n);
        let columns: Vec<usize> = (0..own * n).collect();
        for block in columns.chunks(BLOCK) {
            let mut loads = Mat::zeros(self.sector.condensation().size(), block.len());
            for (place, &column) in block.iter().enumerate() {
                let a = column / n;
                for (b, &node) in self.sector.tooth_nodes(a).iter().enumerate() {
                    for axis in 0..3 {
                        loads[(3 * node + axis, place)] = on_tooth.kept[(3 * b + axis, column % n)];
                    }
                }
            }
            let condensed = self.sector.condensation().condense(loads.as_ref());
            let held = Mat::<f64>::zeros(condensed.kept.nrows(), block.len());
            let u = self
                .sector
                .condensation()
                .expand(held.as_ref(), Some(condensed.interior.as_ref()));
            at_cuts
                .as_mut()
                .subcols_mut(block[0], block.len())
                .copy_from(&condensed.kept);
            for a in 0..own {
                let response = on_tooth.kept.transpose() * self.foot(a, u.as_ref());
                inside_sector
                    .as_mut()
                    .submatrix_mut(a * n, block[0], n, block.len())
                    .copy_from(&response);
            }
            progress.advance(block[0] + block.len(), columns.len());
        }
        for a in 0..own {
            let mut diagonal = inside_sector.as_mut().submatrix_mut(a * n, a * n, n, n);
            diagonal += &inside_tooth;
        }
        let mut products = self.interface.products(at_cuts.as_ref());
        products[0] += &inside_sector;

        let mut rows = vec![0.0; own * n * teeth * n];
        rows.par_chunks_mut(teeth * n)
            .enumerate()
            .for_each(|(row, values)| {
                let (from, a) = self.sector.of_tooth(row / n);
                for (t, block) in values.chunks_mut(n).enumerate() {
                    let (to, b) = self.sector.of_tooth(t);
                    let offset = (to + self.sector.sectors - from) % self.sector.sectors;
                    for (m, value) in block.iter_mut().enumerate() {
                        *value = products[offset][(b * n + m, a * n + row % n)];
                    }
                }
            });
        rows
    }

    /// aᵀ K⁻¹ g for rows g anywhere and vectors a given on tooth 0 and placed, turned, on every tooth:
    /// `[row][tooth][vector]`.
    pub fn readings(&self, rows: &[&SparseVector], vectors: &[&SparseVector]) -> Vec<Vec<f64>> {
        let response = self.respond(rows);
        let on_tooth = self.tooth.condense(&self.frames, vectors);
        let inside = on_tooth.gram(&response.inside);
        let teeth = self.sector.own * self.sector.sectors;
        let mut readings = vec![Vec::with_capacity(teeth * vectors.len()); rows.len()];
        for t in 0..teeth {
            let (sector, a) = self.sector.of_tooth(t);
            let mut found =
                on_tooth.kept.transpose() * self.foot(a, response.sectors[sector].as_ref());
            for &(case, column) in response.loaded.get(&t).into_iter().flatten() {
                for i in 0..vectors.len() {
                    found[(i, case)] += inside[(i, column)];
                }
            }
            for (case, reading) in readings.iter_mut().enumerate() {
                reading.extend((0..vectors.len()).map(|i| found[(i, case)]));
            }
        }
        readings
    }

    /// K⁻¹ p for loads anywhere, as full Cartesian fields, handed to `each` one by one.
    pub fn solve_each(
        &self,
        mesh: &GearMesh,
        loads: &[&SparseVector],
        progress: &dyn Progress,
        mut each: impl FnMut(usize, &[f64]),
    ) {
        for (batch, cases) in loads.chunks(FIELDS).enumerate() {
            let fields = self.fields(mesh, cases);
            for (case, field) in fields.iter().enumerate() {
                each(batch * FIELDS + case, field);
            }
            progress.advance(batch * FIELDS + cases.len(), loads.len());
        }
    }

    /// XᵀKX for full Cartesian fields that are zero where the body is held: the sum over all parts.
    pub fn energy_products(&self, mesh: &GearMesh, fields: &[Vec<f64>]) -> Mat<f64> {
        self.tooth.energy_products(mesh, &self.frames, fields)
            + self
                .sector
                .energy_products(mesh, &self.tooth, &self.frames, fields)
    }

    /// Displacements of what the a-th tooth shares with its surroundings.
    fn foot(&self, a: usize, sector: MatRef<'_, f64>) -> Mat<f64> {
        let nodes = self.sector.tooth_nodes(a);
        Mat::from_fn(3 * nodes.len(), sector.ncols(), |i, j| {
            sector[(3 * nodes[i / 3] + i % 3, j)]
        })
    }

    /// Carries loads inwards to the cuts, solves the ring and goes back out to the sectors' nodes.
    fn respond(&self, cases: &[&SparseVector]) -> Response {
        // Split the loads by tooth and by sector.
        let mut tooth_parts: BTreeMap<(usize, usize), Vec<(usize, f64)>> = BTreeMap::new();
        let mut sector_parts: BTreeMap<(usize, usize), Vec<(usize, f64)>> = BTreeMap::new();
        for (case, load) in cases.iter().enumerate() {
            for &(dof, value) in *load {
                let (list, i) = match self.places[dof / 3] {
                    Place::Tooth(t, i) => (tooth_parts.entry((t as usize, case)), i as usize),
                    Place::Sector(s, i) => (sector_parts.entry((s as usize, case)), i as usize),
                    Place::Fixed => continue,
                };
                let list = list.or_default();
                add_turned(&self.frames, dof, value, |axis, part| {
                    list.push((3 * i + axis, part));
                });
            }
        }
        let mut loads = Mat::zeros(self.tooth.condensation().size(), tooth_parts.len());
        let mut loaded: BTreeMap<usize, Vec<(usize, usize)>> = BTreeMap::new();
        for (column, (&(tooth, case), entries)) in tooth_parts.iter().enumerate() {
            for &(row, value) in entries {
                loads[(row, column)] += value;
            }
            loaded.entry(tooth).or_default().push((case, column));
        }
        let inside = self.tooth.condensation().condense(loads.as_ref());
        for (&tooth, columns) in &loaded {
            let (sector, a) = self.sector.of_tooth(tooth);
            for &(case, column) in columns {
                let list = sector_parts.entry((sector, case)).or_default();
                for (b, &node) in self.sector.tooth_nodes(a).iter().enumerate() {
                    list.extend(
                        (0..3).map(|axis| (3 * node + axis, inside.kept[(3 * b + axis, column)])),
                    );
                }
            }
        }
        let mut loads = Mat::zeros(self.sector.condensation().size(), sector_parts.len());
        for (column, entries) in sector_parts.values().enumerate() {
            for &(row, value) in entries {
                loads[(row, column)] += value;
            }
        }
        let in_sectors = self.sector.condensation().condense(loads.as_ref());
        let mut at_cuts =
            vec![Mat::zeros(2 * self.interface.cut_size(), cases.len()); self.sector.sectors];
        for (column, &(sector, case)) in sector_parts.keys().enumerate() {
            at_cuts[sector]
                .col_mut(case)
                .copy_from(in_sectors.kept.col(column));
        }
        let cuts = self.interface.displacements(&at_cuts);
        let columns: Vec<(usize, usize)> = sector_parts.keys().copied().collect();
        let sectors = cuts
            .into_par_iter()
            .enumerate()
            .map(|(sector, kept)| {
                let rows = in_sectors.interior.nrows();
                let mut interior = Mat::zeros(rows, cases.len());
                for (column, &(s, case)) in columns.iter().enumerate() {
                    if s == sector {
                        interior
                            .col_mut(case)
                            .copy_from(in_sectors.interior.col(column));
                    }
                }
                self.sector
                    .condensation()
                    .expand(kept.as_ref(), Some(interior.as_ref()))
            })
            .collect();
        Response {
            sectors,
            loaded,
            inside,
        }
    }

    fn fields(&self, mesh: &GearMesh, cases: &[&SparseVector]) -> Vec<Vec<f64>> {
        let response = self.respond(cases);
        let mut fields = vec![vec![0.0; 3 * mesh.nodes.len()]; cases.len()];
        let mut put = |node: u32, i: usize, u: &Mat<f64>| {
            for (case, field) in fields.iter_mut().enumerate() {
                let part = [u[(3 * i, case)], u[(3 * i + 1, case)], u[(3 * i + 2, case)]];
                field[3 * node as usize..][..3]
                    .copy_from_slice(&self.frames.to_cartesian(node as usize, part));
            }
        };
        for (sector, u) in response.sectors.iter().enumerate() {
            for i in 0..self.sector.node_count() {
                if let Some(node) = self.sector.node(mesh, &self.tooth, sector, i) {
                    put(node, i, u);
                }
            }
        }
        let teeth = self.sector.own * self.sector.sectors;
        let inside: Vec<Mat<f64>> = (0..teeth)
            .into_par_iter()
            .map(|t| {
                let (sector, a) = self.sector.of_tooth(t);
                let foot = self.foot(a, response.sectors[sector].as_ref());
                let rows = response.inside.interior.nrows();
                let mut interior = Mat::zeros(rows, cases.len());
                for &(case, column) in response.loaded.get(&t).into_iter().flatten() {
                    interior
                        .col_mut(case)
                        .copy_from(response.inside.interior.col(column));
                }
                self.tooth
                    .condensation()
                    .expand(foot.as_ref(), Some(interior.as_ref()))
            })
            .collect();
        for (t, u) in inside.iter().enumerate() {
            for i in 0..self.tooth.node_count() {
                if let Some(node) = self.tooth.node(mesh, t, i) {
                    put(node, i, u);
                }
            }
        }
        fields
    }
}
