//! N equal parts in a ring round a core that does not repeat, condensed by harmonics to the core's nodes.
//!
//! Every part has the same stiffness S over its nodes, in components that turn with the parts
//! ([`crate::CylindricalFrames`]). Some of its nodes are the next part's too, some are the core's. With c(p) the
//! displacements that part p has before the next one and the core has not, and b(p) those of the core's nodes on it
//! likewise, both of harmonic k,
//!
//! ```text
//! [ K_cc(k)  K_cb(k) ]
//! [ K_bc(k)  K_bb(k) ] = K(k) = E(k)ᴴ S E(k),   E(k) (c, b) = the part's displacements,
//!                        e^{ikα} ahead where they are the next part's, α = 2π/N
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
use crate::ring_transform::{RingTransform, by_reference};
use faer::linalg::solvers::Llt;
use faer::linalg::triangular_solve::solve_lower_triangular_in_place;
use faer::{Mat, MatRef, Par, Side, c64};
use rayon::prelude::*;
use std::collections::HashMap;

/// Displacements of a node.
pub(crate) const AXES: usize = 3;

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
pub(crate) struct Harmonic {
    /// Λ.
    pub factor: Mat<c64>,
    /// X.
    pub coupling: Mat<c64>,
    /// S_b.
    at_core: Mat<c64>,
}

/// The ring, condensed to the core's nodes on it.
#[derive(Debug)]
pub struct Ring {
    pub(crate) transform: RingTransform,
    places: Vec<Place>,
    /// Nodes of the whole that are a part's own: in the ring alone, and of the core.
    pub(crate) ring_nodes: Vec<Vec<usize>>,
    core_nodes: Vec<Vec<usize>>,
    pub(crate) harmonics: Vec<Harmonic>,
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
        FeError::check_size("the parts of a ring", parts.min(3), 3)?;
        let of_part = stiffness.nrows() / AXES;
        for list in nodes {
            FeError::check_size("the nodes of a part", list.len(), of_part)?;
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
        FeError::check_size("the placed nodes of a part", places.len(), of_part)?;
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
    pub(crate) fn own(&self) -> [usize; 2] {
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
    pub(crate) fn forward(&self, k: usize, mut loads: Mat<c64>) -> (Mat<c64>, Mat<c64>) {
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
