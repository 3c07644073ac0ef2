//! What loads anywhere do to a gear that is solved by its repetition: inwards to the cuts, round the ring, out again.

use crate::Progress;
use crate::cyclic_body::{CyclicBody, Place};
use crate::flank_loads::SparseVector;
use crate::tooth_substructure::add_turned;
use faer::{Mat, MatRef};
use gearmesh_fe::CondensedLoads;
use std::collections::BTreeMap;

/// Full fields that are made together.
const FIELDS: usize = 8;

/// What loads do to the sectors, before anything inside the teeth is asked for.
struct Response {
    /// Displacements of the sectors' nodes: the cases of sector 0, then those of sector 1, ...
    sectors: Mat<f64>,
    /// Number of cases.
    cases: usize,
    /// (tooth, case) of the columns of `inside`.
    loaded: BTreeMap<usize, Vec<(usize, usize)>>,
    /// The loads inside the teeth.
    inside: CondensedLoads,
}

impl Response {
    /// Displacements of one sector's nodes × cases.
    fn sector(&self, sector: usize) -> MatRef<'_, f64> {
        self.sectors
            .as_ref()
            .subcols(sector * self.cases, self.cases)
    }
}

impl CyclicBody {
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
            let mut found = on_tooth.kept.transpose() * self.foot(a, response.sector(sector));
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
        loads: &[&SparseVector],
        progress: &dyn Progress,
        mut each: impl FnMut(usize, &[f64]),
    ) {
        for (batch, cases) in loads.chunks(FIELDS).enumerate() {
            let fields = self.fields(cases);
            for (case, field) in fields.iter().enumerate() {
                each(batch * FIELDS + case, field);
            }
            progress.advance(batch * FIELDS + cases.len(), loads.len());
        }
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
        let mut loads = Mat::zeros(self.tooth.condensation.size(), tooth_parts.len());
        let mut loaded: BTreeMap<usize, Vec<(usize, usize)>> = BTreeMap::new();
        for (column, (&(tooth, case), entries)) in tooth_parts.iter().enumerate() {
            for &(row, value) in entries {
                loads[(row, column)] += value;
            }
            loaded.entry(tooth).or_default().push((case, column));
        }
        let inside = self.tooth.condensation.condense(loads.as_ref());
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
        let mut loads = Mat::zeros(self.sector.condensation.size(), sector_parts.len());
        for (column, entries) in sector_parts.values().enumerate() {
            for &(row, value) in entries {
                loads[(row, column)] += value;
            }
        }
        let in_sectors = self.sector.condensation.condense(loads.as_ref());
        let mut at_cuts =
            vec![Mat::zeros(2 * self.interface.cut_size(), cases.len()); self.sector.sectors];
        for (column, &(sector, case)) in sector_parts.keys().enumerate() {
            at_cuts[sector]
                .col_mut(case)
                .copy_from(in_sectors.kept.col(column));
        }
        let cuts = self.interface.displacements(&at_cuts);
        // All sectors at once: the factor is read from memory once for many columns.
        let n = cases.len();
        let mut kept = Mat::zeros(2 * self.interface.cut_size(), n * self.sector.sectors);
        for (sector, u) in cuts.iter().enumerate() {
            kept.as_mut().subcols_mut(sector * n, n).copy_from(u);
        }
        let mut interior = Mat::zeros(self.sector.condensation.interior_size(), kept.ncols());
        for (column, &(sector, case)) in sector_parts.keys().enumerate() {
            in_sectors.put_interior(column, interior.col_mut(sector * n + case));
        }
        let sectors = self
            .sector
            .condensation
            .expand(kept.as_ref(), interior.as_ref());
        Response {
            sectors,
            cases: n,
            loaded,
            inside,
        }
    }

    fn fields(&self, cases: &[&SparseVector]) -> Vec<Vec<f64>> {
        let response = self.respond(cases);
        let mut fields = vec![vec![0.0; 3 * self.places.len()]; cases.len()];
        let mut put = |node: u32, i: usize, u: MatRef<'_, f64>| {
            for (case, field) in fields.iter_mut().enumerate() {
                let part = [u[(3 * i, case)], u[(3 * i + 1, case)], u[(3 * i + 2, case)]];
                field[3 * node as usize..][..3]
                    .copy_from_slice(&self.frames.to_cartesian(node as usize, part));
            }
        };
        for sector in 0..self.sector.sectors {
            for (i, &node) in self.sector.nodes(sector).iter().enumerate() {
                put(node, i, response.sector(sector));
            }
        }
        let (n, teeth) = (cases.len(), self.sector.own * self.sector.sectors);
        let mut feet = Mat::zeros(3 * self.tooth.boundary_count(), n * teeth);
        let mut interior = Mat::zeros(self.tooth.condensation.interior_size(), n * teeth);
        for t in 0..teeth {
            let (sector, a) = self.sector.of_tooth(t);
            feet.as_mut()
                .subcols_mut(t * n, n)
                .copy_from(self.foot(a, response.sector(sector)));
            for &(case, column) in response.loaded.get(&t).into_iter().flatten() {
                response
                    .inside
                    .put_interior(column, interior.col_mut(t * n + case));
            }
        }
        let inside = self
            .tooth
            .condensation
            .expand(feet.as_ref(), Some(interior.as_ref()));
        for t in 0..teeth {
            for (i, &node) in self.tooth.nodes(t).iter().enumerate() {
                put(node, i, inside.as_ref().subcols(t * n, n));
            }
        }
        fields
    }
}
