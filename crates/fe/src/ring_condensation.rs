//! A ring of equal parts with its core: the ring by harmonics ([`Ring`], where the formulas stand), the core by itself.

use crate::error::FeError;
use crate::factor::FactorInfo;
use crate::ring::{AXES, Harmonic, Ring};
use crate::ring_transform::by_reference;
use crate::static_condensation::{CondensedLoads, StaticCondensation};
use faer::linalg::triangular_solve::solve_upper_triangular_in_place;
use faer::{Mat, MatMut, MatRef, Par, c64};
use rayon::prelude::*;

/// A ring with the factorised core: as [`StaticCondensation`] with no node kept.
#[derive(Debug)]
pub struct RingCondensation {
    ring: Ring,
    core: StaticCondensation,
    /// Nodes of the whole of the core's nodes.
    core_nodes: Vec<usize>,
    /// Core nodes of those on the parts, part by part.
    on_parts: Vec<usize>,
}

impl RingCondensation {
    /// Joins a ring to its core: `core` was condensed with the ring's stiffness added, no node kept; `core_nodes` are
    /// its nodes among those of the whole, ascending.
    ///
    /// # Errors
    /// [`FeError::SizeMismatch`] where they do not fit.
    pub fn new(
        ring: Ring,
        core: StaticCondensation,
        core_nodes: Vec<usize>,
    ) -> Result<Self, FeError> {
        let on_parts: Vec<usize> = (ring.core_nodes())
            .filter_map(|node| core_nodes.binary_search(&node).ok())
            .collect();
        let (found, expected) = (on_parts.len(), ring.core_nodes().count());
        if found != expected || core.size() != AXES * core_nodes.len() {
            return Err(FeError::SizeMismatch {
                what: "the core's nodes on the ring",
                found,
                expected,
            });
        }
        Ok(Self {
            ring,
            core,
            core_nodes,
            on_parts,
        })
    }

    /// The ring.
    pub fn ring(&self) -> &Ring {
        &self.ring
    }

    /// The empty stiffness at no kept node.
    pub fn stiffness(&self) -> MatRef<'_, f64> {
        self.core.stiffness()
    }

    /// Displacements of the whole.
    pub fn size(&self) -> usize {
        self.core.size() + self.ring.transform.parts * self.ring.own()[0]
    }

    /// Numbers of a half solve: the core's, and two for each displacement of a part and harmonic.
    pub fn interior_size(&self) -> usize {
        self.core.interior_size() + 2 * self.ring.harmonics() * self.ring.own()[0]
    }

    /// Size and cost of the core's factorisation.
    pub fn info(&self) -> FactorInfo {
        self.core.info()
    }

    /// Half solves of loads (all displacements × loads, N).
    ///
    /// # Panics
    /// If `loads` does not have [`RingCondensation::size`] rows.
    pub fn condense(&self, loads: MatRef<'_, f64>) -> CondensedLoads {
        assert_eq!(loads.nrows(), self.size(), "rows of the loads");
        let columns = loads.ncols();
        let own = self.ring.own()[0];
        let halves: Vec<(Mat<c64>, Mat<c64>)> = (0..self.ring.harmonics())
            .into_par_iter()
            .map(|k| {
                let on_ring = self.spectrum(k, (own, columns), |part, row, column| {
                    loads[(
                        AXES * self.ring.ring_nodes[part][row / AXES] + row % AXES,
                        column,
                    )]
                });
                self.ring.forward(k, on_ring)
            })
            .collect();
        let (halves, carried): (Vec<_>, Vec<_>) = halves.into_iter().unzip();
        let mut at_core = Mat::from_fn(self.core.size(), columns, |i, j| {
            loads[(AXES * self.core_nodes[i / AXES] + i % AXES, j)]
        });
        let shape = (self.ring.own()[1], columns);
        let blocks = (self.ring.transform).back(&by_reference(&carried), shape);
        self.add_at_core(at_core.as_mut(), &blocks);
        let core = self.core.condense(at_core.as_ref());
        let first = self.core.interior_size();
        let in_core = core.rows.len();
        let mut rows = core.rows;
        rows.extend(first..self.interior_size());
        let mut interior = Mat::zeros(rows.len(), columns);
        interior
            .as_mut()
            .subrows_mut(0, in_core)
            .copy_from(&core.interior);
        for (k, y) in halves.iter().enumerate() {
            let root = self.ring.transform.weight(k).sqrt();
            let start = in_core + 2 * k * own;
            for column in 0..columns {
                for i in 0..own {
                    interior[(start + i, column)] = root * y[(i, column)].re;
                    interior[(start + own + i, column)] = root * y[(i, column)].im;
                }
            }
        }
        CondensedLoads {
            kept: Mat::zeros(0, columns),
            interior,
            rows,
        }
    }

    /// Half solves in the core alone of loads that were carried to it, turned by `parts`: [`CondensedLoads::gram`] of
    /// two is their work but for [`Ring::work`].
    pub fn condense_at_core(&self, at_core: MatRef<'_, f64>, parts: usize) -> CondensedLoads {
        let turned = parts * self.ring.own()[1];
        let on_parts = |row: usize| (row + turned) % at_core.nrows();
        let dof = |row: usize| AXES * self.on_parts[on_parts(row) / AXES] + row % AXES;
        self.core.condense_at(dof, at_core)
    }

    /// Adds loads at the core's nodes on the parts.
    fn add_at_core(&self, mut loads: MatMut<'_, f64>, blocks: &[Mat<f64>]) {
        let nodes = self.ring.own()[1] / AXES;
        for (of_part, block) in self.on_parts.chunks(nodes.max(1)).zip(blocks) {
            for (i, &node) in of_part.iter().enumerate() {
                for column in 0..block.ncols() {
                    for axis in 0..AXES {
                        loads[(AXES * node + axis, column)] += block[(AXES * i + axis, column)];
                    }
                }
            }
        }
    }

    /// Σ_p e^{-ikpα} v(p).
    fn spectrum(
        &self,
        k: usize,
        (rows, columns): (usize, usize),
        value: impl Fn(usize, usize, usize) -> f64,
    ) -> Mat<c64> {
        let mut sum = Mat::<c64>::zeros(rows, columns);
        for part in 0..self.ring.transform.parts {
            let turn = self.ring.transform.phase(k * part).conj();
            for column in 0..columns {
                for row in 0..rows {
                    sum[(row, column)] += turn * value(part, row, column);
                }
            }
        }
        sum
    }

    /// All displacements of the whole (m) from half solves, a column of [`RingCondensation::interior_size`] rows each.
    ///
    /// # Panics
    /// If the rows are not those of half solves.
    pub fn expand(&self, interior: MatRef<'_, f64>) -> Mat<f64> {
        assert_eq!(interior.nrows(), self.interior_size(), "rows of the halves");
        let columns = interior.ncols();
        let own = self.ring.own();
        let (in_core, in_ring) = interior.split_at_row(self.core.interior_size());
        let none = Mat::zeros(0, columns);
        let core = self.core.expand(none.as_ref(), Some(in_core));
        let nodes = own[1] / AXES;
        let spectrum: Vec<Mat<c64>> = (0..self.ring.harmonics())
            .into_par_iter()
            .map(|k| {
                let at_core = self.spectrum(k, (own[1], columns), |part, row, column| {
                    let node = self.on_parts[part * nodes + row / AXES];
                    core[(AXES * node + row % AXES, column)]
                });
                let root = self.ring.transform.weight(k).sqrt();
                let Harmonic {
                    factor, coupling, ..
                } = &self.ring.harmonics[k];
                let start = 2 * k * own[0];
                let mut y = Mat::from_fn(own[0], columns, |i, j| {
                    let (re, im) = (in_ring[(start + i, j)], in_ring[(start + own[0] + i, j)]);
                    c64::new(re / root, im / root)
                });
                y -= coupling * at_core;
                solve_upper_triangular_in_place(factor.adjoint(), y.as_mut(), Par::Seq);
                y
            })
            .collect();
        let mut all = Mat::zeros(self.size(), columns);
        for column in 0..columns {
            for (i, &node) in self.core_nodes.iter().enumerate() {
                for axis in 0..AXES {
                    all[(AXES * node + axis, column)] = core[(AXES * i + axis, column)];
                }
            }
        }
        let on_parts = (self.ring.transform).back(&by_reference(&spectrum), (own[0], columns));
        for (part, block) in on_parts.iter().enumerate() {
            for (i, &node) in self.ring.ring_nodes[part].iter().enumerate() {
                for column in 0..columns {
                    for axis in 0..AXES {
                        all[(AXES * node + axis, column)] = block[(AXES * i + axis, column)];
                    }
                }
            }
        }
        all
    }
}
