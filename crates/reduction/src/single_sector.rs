//! A body of a single sector under loads on its teeth: half solves, whose products are what goes from tooth to tooth.
//!
//! Where its teeth are condensed as a ring, loads reach the circle on which it stands in fewer shapes than there are
//! loads, to rounding. They are half solved once for every tooth, and the compliance between loads of two teeth is a
//! product of small matrices.

use crate::Progress;
use crate::cyclic_body::CyclicBody;
use crate::flank_loads::SparseVector;
use faer::{Mat, MatRef};
use gearmesh_fe::{CondensedLoads, RingCondensation};
use rayon::prelude::*;
use std::sync::atomic::{AtomicUsize, Ordering};

/// A body that does not repeat, and the loads of a tooth carried to its foot.
pub(crate) struct SingleSector<'a> {
    body: &'a CyclicBody,
    on_tooth: CondensedLoads,
    ring: Option<OnRing>,
    solved: AtomicUsize,
}

/// Loads of a tooth on the ring of all teeth: F of them at the circle on which it stands is U A, with few columns in U.
struct OnRing {
    /// A: shapes of load at the circle × loads.
    amounts: Mat<f64>,
    /// Work of the shapes on a tooth with those on each up to itself, by tooth (m/N).
    at_circle: Vec<Vec<Mat<f64>>>,
    /// Work of the loads on a tooth so much further on, the circle held (m/N).
    held: Vec<Mat<f64>>,
}

/// Shapes of load at the circle are left out below this share of the largest: a hundredth of what [`HubPatterns`] leave
/// out. A third of the shapes of a wheel of 64 teeth lies between this and rounding.
const LEAST_SHAPE: f64 = 1e-10;

/// Loads of a tooth, as shares of all of a tooth (loads × columns), and where they are not on a ring half solved in
/// the body.
pub(crate) struct HalfSolves {
    tooth: usize,
    shares: Mat<f64>,
    in_body: Option<CondensedLoads>,
}

impl<'a> SingleSector<'a> {
    /// Loads given on tooth 0, equal on all teeth; none where the body repeats.
    pub fn new(
        body: &'a CyclicBody,
        vectors: &[&SparseVector],
        progress: &dyn Progress,
    ) -> Option<Self> {
        (body.sector.sectors == 1).then(|| {
            let on_tooth = body.tooth.condense(&body.frames, vectors);
            let ring = body.sector.condensation.ring();
            let ring = ring.and_then(|ring| OnRing::new(ring, &on_tooth, progress));
            let solved = ring.as_ref().map_or(0, OnRing::solved);
            Self {
                body,
                on_tooth,
                ring,
                solved: AtomicUsize::new(solved),
            }
        })
    }

    /// Number of teeth.
    pub fn teeth(&self) -> usize {
        self.body.sector.own
    }

    /// Right-hand sides that were solved so far.
    pub fn solved(&self) -> usize {
        self.solved.load(Ordering::Relaxed)
    }

    /// Work of the loads inside the tooth, its foot held: loads × loads (m/N).
    pub fn inside(&self) -> Mat<f64> {
        self.on_tooth.gram(&self.on_tooth)
    }

    /// Half solves of the loads of a tooth combined by `shares` (loads × columns).
    pub fn half_solves(&self, tooth: usize, shares: MatRef<'_, f64>) -> HalfSolves {
        let (_, own) = self.body.sector.of_tooth(tooth);
        let in_body = self.ring.is_none().then(|| {
            let carried = &self.on_tooth.kept * shares;
            let loads = self.body.at_foot(carried.as_ref(), own);
            self.solved.fetch_add(shares.ncols(), Ordering::Relaxed);
            self.body.sector.condensation.condense(loads.as_ref())
        });
        HalfSolves {
            tooth: own,
            shares: shares.to_owned(),
            in_body,
        }
    }

    /// With F the loads carried to a tooth's foot and S the compliance of the body with the feet: (F a)ᵀ S F b for the
    /// shares a (rows) and b (columns) of two half solves (m/N).
    pub fn work(&self, a: &HalfSolves, b: &HalfSolves) -> Mat<f64> {
        if let (Some(in_body), Some(other)) = (&a.in_body, &b.in_body) {
            return in_body.gram(other);
        }
        let (rows, columns) = (a.shares.shape().1, b.shares.shape().1);
        self.ring
            .as_ref()
            .map_or_else(|| Mat::zeros(rows, columns), |ring| ring.work(a, b))
    }
}

impl OnRing {
    fn new(
        ringed: &RingCondensation,
        on_tooth: &CondensedLoads,
        progress: &dyn Progress,
    ) -> Option<Self> {
        progress.stage("solving the circle below the teeth");
        let carried = ringed.ring().carry(on_tooth.kept.as_ref());
        let held = ringed.ring().work(&carried);
        let svd = carried.at_core().thin_svd().ok()?;
        let sizes = svd.S().column_vector();
        let count = (0..sizes.nrows())
            .take_while(|&k| sizes[k] > LEAST_SHAPE * sizes[0])
            .count();
        let shapes = svd.U().subcols(0, count);
        let amounts = Mat::from_fn(count, on_tooth.kept.ncols(), |k, load| {
            sizes[k] * svd.V()[(load, k)]
        });
        let (teeth, done) = (held.len(), AtomicUsize::new(0));
        let solves: Vec<CondensedLoads> = (0..teeth)
            .into_par_iter()
            .map(|tooth| {
                let solves = ringed.condense_at_core(shapes, tooth);
                progress.advance(done.fetch_add(1, Ordering::Relaxed) + 1, teeth);
                solves
            })
            .collect();
        let up_to = |a: usize| (0..=a).map(|b| solves[a].gram(&solves[b])).collect();
        Some(Self {
            amounts,
            at_circle: (0..teeth).into_par_iter().map(up_to).collect(),
            held,
        })
    }

    fn solved(&self) -> usize {
        self.at_circle.len() * self.amounts.nrows()
    }

    fn work(&self, a: &HalfSolves, b: &HalfSolves) -> Mat<f64> {
        let teeth = self.held.len();
        let held = &self.held[(a.tooth + teeth - b.tooth) % teeth];
        let of_shapes = if b.tooth <= a.tooth {
            self.at_circle[a.tooth][b.tooth].as_ref()
        } else {
            self.at_circle[b.tooth][a.tooth].transpose()
        };
        let [of_a, of_b] = [a, b].map(|half| &self.amounts * &half.shares);
        of_a.transpose() * of_shapes * of_b + a.shares.transpose() * held * &b.shares
    }
}
