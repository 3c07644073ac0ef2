//! N equal parts in a ring round a core that does not repeat: condensed by harmonics to the core's nodes, the core by
//! itself.
//!
//! Every part has the same stiffness S over its nodes, in components that turn with the parts
//! ([`crate::CylindricalFrames`]). Some of its nodes are the next part's too, some are the core's. With c(p) the
//! displacements that part p has before the next one and the core has not, and b(p) those of the core's nodes on it
//! likewise, both of harmonic k,
//!
//! ```text
//! [ K_cc(k)  K_cb(k) ]                                      K(k) = E(k)ᴴ S E(k),   E(k) (c, b) = the part's displacements, e^{ikα} ahead where
//! [ K_bc(k)  K_bb(k) ]                                      they are the next part's, α = 2π/N
//! ```
//!
//! one Hermitian matrix for each 0 ≤ k ≤ N/2. With K_cc = Λ Λᴴ and X = Λ⁻¹ K_cb
//!
//! ```text
//! S_b(k) = K_bb − Xᴴ X       y(k) = Λ⁻¹ p_c(k)       p_b'(k) = p_b(k) − Xᴴ y(k)       c(k) = Λ⁻ᴴ (y(k) − X b(k))
//! ```
//!
//! as in [`crate::StaticCondensation`]. Back from harmonics, S_b is a block-circulant matrix over the core's nodes on
//! all parts: added to the core's own stiffness it makes a matrix that is factorised as any other. Work of two loads
//! is that of their halves,
//!
//! ```text
//! pᵀ K⁻¹ q = (1/N) Σ_k Re( y_p(k)ᴴ y_q(k) ) + y_pᵀ y_q of the core
//! ```
//!
//! over all N harmonics, of which those beyond N/2 are the conjugates of others. It is the factorisation of the whole
//! in another order.
//!
//! Source: D. L. Thomas, *Dynamics of rotationally periodic structures*, Int. J. Numer. Meth. Eng. 14 (1979) 81-102,
//! for the transform.

use crate::error::FeError;
use crate::factor::FactorInfo;
use crate::ring_transform::{RingTransform, by_reference};
use crate::static_condensation::{CondensedLoads, StaticCondensation};
use faer::linalg::solvers::Llt;
use faer::linalg::triangular_solve::{
    solve_lower_triangular_in_place, solve_upper_triangular_in_place,
};
use faer::{Mat, MatMut, MatRef, Par, Side, c64};
use rayon::prelude::*;
use std::collections::HashMap;

/// Displacements of a node.
const AXES: usize = 3;

/// Where a node of a part belongs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Place {
    /// 1 where it is the next part's.
    ahead: usize,
    in_core: bool,
    /// Among the part's own nodes of the ring or of the core.
    number: usize,
}

/// One harmonic with the ring's own displacements eliminated.
#[derive(Debug)]
struct Harmonic {
    /// Λ.
    factor: Mat<c64>,
    /// X.
    coupling: Mat<c64>,
    /// S_b.
    at_core: Mat<c64>,
}

/// The ring, condensed to the core's nodes on it.
#[derive(Debug)]
pub struct Ring {
    transform: RingTransform,
    places: Vec<Place>,
    /// Nodes of the whole that are a part's own: in the ring alone, and of the core.
    ring_nodes: Vec<Vec<usize>>,
    core_nodes: Vec<Vec<usize>>,
    harmonics: Vec<Harmonic>,
}

/// Loads on one part, carried to the core.
#[derive(Debug, Clone)]
pub struct PartLoads {
    /// y(k) of the loads on part 0.
    spectrum: Vec<Mat<c64>>,
    /// p_b': the core's nodes on part 0, then on part 1, ... × loads (N).
    at_core: Mat<f64>,
}

impl PartLoads {
    /// The loads at the core's nodes on all parts, part by part.
    pub fn at_core(&self) -> MatRef<'_, f64> {
        self.at_core.as_ref()
    }
}

impl Ring {
    /// Condenses equal parts with the stiffness S (three rows a node, N/m). `nodes` are those of the whole for each
    /// node of each part, the i-th of each part the image of the i-th of the first; `in_core` tells which are the
    /// core's.
    ///
    /// # Errors
    /// [`FeError::SizeMismatch`] where S or the lists of nodes do not fit, or there are fewer than three parts;
    /// [`FeError::NotPositiveDefinite`] where the ring can move with the core's nodes held.
    pub fn new(
        stiffness: MatRef<'_, f64>,
        nodes: &[Vec<usize>],
        in_core: impl Fn(usize) -> bool,
    ) -> Result<Self, FeError> {
        let parts = nodes.len();
        let mismatch = |what, found, expected| FeError::SizeMismatch {
            what,
            found,
            expected,
        };
        if parts < 3 {
            return Err(mismatch("the parts of a ring", parts, 3));
        }
        let of_part = stiffness.nrows() / AXES;
        for list in nodes {
            if list.len() != of_part {
                return Err(mismatch("the nodes of a part", list.len(), of_part));
            }
        }
        let next: HashMap<usize, usize> = nodes[1].iter().copied().zip(0..).collect();
        let mut places = vec![None; of_part];
        let (mut ring_nodes, mut core_nodes) = (vec![Vec::new(); parts], vec![Vec::new(); parts]);
        for (i, node) in nodes[0].iter().enumerate() {
            if next.contains_key(node) {
                continue;
            }
            let in_core = in_core(*node);
            let own = if in_core {
                &mut core_nodes
            } else {
                &mut ring_nodes
            };
            places[i] = Some(Place {
                ahead: 0,
                in_core,
                number: own[0].len(),
            });
            for (list, part) in own.iter_mut().zip(nodes) {
                list.push(part[i]);
            }
        }
        for (i, node) in nodes[0].iter().enumerate() {
            if let Some(image) = next.get(node).and_then(|&image| places[image]) {
                places[i] = Some(Place { ahead: 1, ..image });
            }
        }
        let places: Vec<Place> = places.into_iter().flatten().collect();
        if places.len() != of_part {
            return Err(mismatch(
                "the placed nodes of a part",
                places.len(),
                of_part,
            ));
        }
        let [own_ring, own_core] = [&ring_nodes, &core_nodes].map(|own| AXES * own[0].len());
        let transform = RingTransform { parts };
        let harmonics = (0..transform.harmonics())
            .into_par_iter()
            .map(|k| {
                let turned = turned(stiffness, &places, transform.phase(k), [own_ring, own_core]);
                let (rows, core) = turned.split_at_row(own_ring);
                let llt = Llt::new(rows.subcols(0, own_ring), Side::Lower)
                    .map_err(|_| FeError::NotPositiveDefinite { free_dof: 0 })?;
                let factor = llt.L().to_owned();
                let mut coupling = rows.subcols(own_ring, own_core).to_owned();
                solve_lower_triangular_in_place(factor.as_ref(), coupling.as_mut(), Par::Seq);
                let at_core = core.subcols(own_ring, own_core) - coupling.adjoint() * &coupling;
                Ok(Harmonic {
                    factor,
                    coupling,
                    at_core,
                })
            })
            .collect::<Result<_, FeError>>()?;
        Ok(Self {
            transform,
            places,
            ring_nodes,
            core_nodes,
            harmonics,
        })
    }

    /// Nodes of the core on the parts, part by part.
    pub fn core_nodes(&self) -> impl Iterator<Item = usize> + '_ {
        self.core_nodes.iter().flatten().copied()
    }

    /// Number of harmonics that were factorised.
    pub fn harmonics(&self) -> usize {
        self.harmonics.len()
    }

    /// Displacements that a part has for itself, in the ring and in the core.
    fn own(&self) -> [usize; 2] {
        [&self.ring_nodes, &self.core_nodes].map(|own| AXES * own[0].len())
    }

    /// S_b between the core's displacements on a part and on the one that is `result`'s number before it (N/m).
    pub fn stiffness_at_core(&self) -> Vec<Mat<f64>> {
        let spectrum: Vec<MatRef<'_, c64>> = (self.harmonics.iter())
            .map(|h| h.at_core.as_ref())
            .collect();
        let own = self.own()[1];
        self.transform.back(&spectrum, (own, own))
    }

    /// y(k), and −Xᴴ y(k), of loads at the ring's own displacements.
    fn forward(&self, k: usize, mut loads: Mat<c64>) -> (Mat<c64>, Mat<c64>) {
        let Harmonic {
            factor, coupling, ..
        } = &self.harmonics[k];
        solve_lower_triangular_in_place(factor.as_ref(), loads.as_mut(), Par::Seq);
        let carried = -(coupling.adjoint() * &loads);
        (loads, carried)
    }

    /// Carries loads at the nodes of part 0 (three rows a node × loads, N) to the core.
    ///
    /// # Panics
    /// If `loads` does not have the rows of a part.
    pub fn carry(&self, loads: MatRef<'_, f64>) -> PartLoads {
        assert_eq!(loads.nrows(), AXES * self.places.len(), "rows of the loads");
        let [own_ring, own_core] = self.own();
        let both: Vec<(Mat<c64>, Mat<c64>)> = (0..self.harmonics())
            .into_par_iter()
            .map(|k| {
                let back = self.transform.phase(k).conj();
                let mut own = [own_ring, own_core].map(|rows| Mat::zeros(rows, loads.ncols()));
                for (i, place) in self.places.iter().enumerate() {
                    let turn = if place.ahead == 1 {
                        back
                    } else {
                        c64::new(1.0, 0.0)
                    };
                    let into = &mut own[usize::from(place.in_core)];
                    for column in 0..loads.ncols() {
                        for axis in 0..AXES {
                            into[(AXES * place.number + axis, column)] +=
                                turn * loads[(AXES * i + axis, column)];
                        }
                    }
                }
                let [ring, mut core] = own;
                let (y, carried) = self.forward(k, ring);
                core += carried;
                (y, core)
            })
            .collect();
        let (spectrum, at_core): (Vec<_>, Vec<_>) = both.into_iter().unzip();
        let shape = (own_core, loads.ncols());
        let on_parts = self.transform.back(&by_reference(&at_core), shape);
        let mut all = Mat::zeros(on_parts.len() * own_core, loads.ncols());
        for (part, block) in on_parts.iter().enumerate() {
            let mut rows = all.as_mut().subrows_mut(part * own_core, own_core);
            rows.copy_from(block);
        }
        PartLoads {
            spectrum,
            at_core: all,
        }
    }

    /// Work of each load on the part that is `result`'s number further on (rows) in the displacements by each load on
    /// part 0, the core's nodes held (m/N).
    pub fn work(&self, loads: &PartLoads) -> Vec<Mat<f64>> {
        let products: Vec<Mat<c64>> = (loads.spectrum.par_iter())
            .map(|y| y.adjoint() * y)
            .collect();
        let count = loads.at_core.ncols();
        self.transform
            .back(&by_reference(&products), (count, count))
    }
}

/// K(k) over the ring's, then the core's displacements of a part; `ahead` is e^{ikα}.
fn turned(
    stiffness: MatRef<'_, f64>,
    places: &[Place],
    ahead: c64,
    [own_ring, own_core]: [usize; 2],
) -> Mat<c64> {
    let mut sum = Mat::<c64>::zeros(own_ring + own_core, own_ring + own_core);
    let row = |place: &Place| AXES * place.number + usize::from(place.in_core) * own_ring;
    for (b, of_column) in places.iter().enumerate() {
        for (a, of_row) in places.iter().enumerate() {
            let turn = match (of_row.ahead, of_column.ahead) {
                (0, 1) => ahead,
                (1, 0) => ahead.conj(),
                _ => c64::new(1.0, 0.0),
            };
            let (first, column) = (row(of_row), row(of_column));
            for k in 0..AXES {
                for i in 0..AXES {
                    sum[(first + i, column + k)] += turn * stiffness[(AXES * a + i, AXES * b + k)];
                }
            }
        }
    }
    sum
}

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
