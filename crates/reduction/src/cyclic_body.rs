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
use crate::repeated_mesh::RepeatedMesh;
use crate::sector_substructure::SectorSubstructure;
use crate::stages::Stages;
use crate::tooth_substructure::ToothSubstructure;
use faer::{Mat, MatRef};
use gearmesh_fe::{CondensedLoads, CyclicInterface, CylindricalFrames, FeError, FeModel};
use rayon::prelude::*;

/// A gear held at its bore, factorised tooth by tooth, sector by sector, harmonic by harmonic.
pub struct CyclicBody {
    pub(crate) frames: CylindricalFrames,
    pub(crate) tooth: ToothSubstructure,
    pub(crate) sector: SectorSubstructure,
    pub(crate) interface: CyclicInterface,
    /// Where each mesh node belongs.
    pub(crate) places: Vec<Place>,
}

/// Where a mesh node belongs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Place {
    /// Tooth and node of its cell.
    Tooth(u32, u32),
    /// Sector and node of it.
    Sector(u32, u32),
    /// Held.
    Fixed,
}

impl CyclicBody {
    /// Factorises the three levels. `fixed` tells the nodes that are held; the wall time of each stage is added to
    /// `stages`.
    ///
    /// # Errors
    /// [`FeError`] when the body is not held or memory is short.
    pub(crate) fn new(
        mesh: &impl RepeatedMesh,
        model: &FeModel,
        fixed: &[bool],
        progress: &dyn Progress,
        stages: &mut Stages,
    ) -> Result<Self, FeError> {
        progress.stage("condensing a tooth");
        let tooth = ToothSubstructure::new(mesh, model)?;
        stages.lap("tooth factor");
        progress.stage(match mesh.sectors() {
            1 => "condensing the body, which does not repeat",
            _ => "condensing a sector",
        });
        let sector = SectorSubstructure::new(mesh, model, fixed, &tooth, progress)?;
        stages.lap("sector factor");
        progress.stage("factoring harmonics");
        let at_cuts = sector.condensation.stiffness();
        let interface = CyclicInterface::counted(at_cuts, sector.sectors, |done, all| {
            progress.advance(done, all);
        })?;
        stages.lap("harmonics");
        let mut places = vec![Place::Fixed; mesh.nodes().len()];
        for s in 0..sector.sectors {
            for (i, &node) in sector.nodes(s).iter().enumerate() {
                places[node as usize] = Place::Sector(s as u32, i as u32);
            }
        }
        for t in 0..mesh.teeth() {
            for (i, &node) in tooth.nodes(t).iter().enumerate() {
                places[node as usize] = Place::Tooth(t as u32, i as u32);
            }
        }
        Ok(Self {
            frames: CylindricalFrames::new(mesh.nodes().iter().copied()),
            tooth,
            sector,
            interface,
            places,
        })
    }

    /// Number and sizes of the factorisations: tooth, sector and harmonics.
    pub fn effort(&self) -> Vec<(&'static str, usize)> {
        vec![
            (
                "factorisations",
                1 + self.sector.condensation.factorisations() + self.interface.harmonics(),
            ),
            ("DOF of a tooth", self.tooth.condensation.size()),
            ("DOF at its foot", 3 * self.tooth.boundary_count()),
            ("DOF of a sector", self.sector.condensation.size()),
            (
                "numbers in the factor of a sector",
                self.sector.condensation.info().nnz_l,
            ),
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
        // The loads of a tooth are solved together: they reach the same, small part of the sector's factor.
        let mut at_cuts = Mat::<f64>::zeros(2 * self.interface.cut_size(), own * n);
        let loaded: Vec<CondensedLoads> = (0..own)
            .map(|a| {
                let loads = self.at_foot(on_tooth.kept.as_ref(), a);
                let condensed = self.sector.condensation.condense(loads.as_ref());
                at_cuts
                    .as_mut()
                    .subcols_mut(a * n, n)
                    .copy_from(&condensed.kept);
                progress.advance(a + 1, own);
                condensed
            })
            .collect();
        let pairs: Vec<(usize, usize)> = (0..own)
            .flat_map(|a| (0..=a).map(move |b| (a, b)))
            .collect();
        let works: Vec<Mat<f64>> = pairs
            .par_iter()
            .map(|&(a, b)| loaded[a].gram(&loaded[b]))
            .collect();
        let mut inside_sector = Mat::<f64>::zeros(own * n, own * n);
        for (&(a, b), work) in pairs.iter().zip(&works) {
            let mut block = inside_sector.as_mut().submatrix_mut(a * n, b * n, n, n);
            block.copy_from(work);
            if a == b {
                block += &inside_tooth;
            } else {
                inside_sector
                    .as_mut()
                    .submatrix_mut(b * n, a * n, n, n)
                    .copy_from(work.transpose());
            }
        }
        let mut products = self.interface.products(at_cuts.as_ref());
        products[0] += &inside_sector;
        drop(inside_sector);

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

    /// Loads of a tooth, carried to its foot, on the a-th tooth of sector 0.
    pub(crate) fn at_foot(&self, carried: MatRef<'_, f64>, a: usize) -> Mat<f64> {
        let mut loads = Mat::zeros(self.sector.condensation.size(), carried.ncols());
        for column in 0..carried.ncols() {
            for (b, &node) in self.sector.tooth_nodes(a).iter().enumerate() {
                for axis in 0..3 {
                    loads[(3 * node + axis, column)] = carried[(3 * b + axis, column)];
                }
            }
        }
        loads
    }

    /// XᵀKX for full Cartesian fields that are zero where the body is held: the sum over all parts.
    pub fn energy_products(&self, fields: &[Vec<f64>]) -> Mat<f64> {
        self.tooth.energy_products(&self.frames, fields)
            + self.sector.energy_products(&self.frames, fields)
    }
}
