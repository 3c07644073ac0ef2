//! A sector condensed to its cuts: its body and the feet of its teeth in one factorisation, or the ring of its teeth
//! by harmonics first.
//!
//! A body that does not repeat is one sector with all teeth. Their cells are equal all the same, so that what they
//! share with one another is eliminated by harmonics ([`Ring`]), and the body alone is factorised with the ring's
//! stiffness at its outer circle. Loads on teeth then reach that circle and nothing further in.

use crate::Progress;
use crate::sector_stiffness::sector_stiffness;
use faer::{Mat, MatRef};
use gearmesh_fe::{
    CondensedLoads, FactorInfo, FeError, Ring, RingCondensation, StaticCondensation,
};

/// Displacements of a node.
const AXES: usize = 3;

/// Displacements of the circle that are factorised as one dense block: it takes 1.6 GB, as much as the circle of a
/// wheel of 90 teeth with 12 layers. Beyond that nested dissection needs less.
pub(crate) const MOST_ON_CIRCLE: usize = 14_000;

/// A sector without the inside of its teeth, condensed.
pub enum SectorCondensation {
    /// Body and feet at once.
    AtOnce(Box<StaticCondensation>),
    /// The feet by harmonics, then the body.
    Ringed(Box<RingCondensation>),
}

impl SectorCondensation {
    /// Condenses a body whose teeth go all the way round by its ring; none where that would not pay, or teeth touch
    /// held nodes. `body` is its own stiffness over `body_nodes`, ascending; `foot` that of a tooth over its
    /// `tooth_nodes`.
    ///
    /// # Errors
    /// [`FeError`] when a factorisation fails.
    pub fn ringed(
        (body, body_nodes): (faer::sparse::SparseColMatRef<'_, usize, f64>, &[usize]),
        (foot, tooth_nodes): (MatRef<'_, f64>, &[Vec<usize>]),
        progress: &dyn Progress,
    ) -> Result<Option<Self>, FeError> {
        let in_body = |node: usize| body_nodes.binary_search(&node).is_ok();
        let is_whole = |list: &Vec<usize>| AXES * list.len() == foot.nrows();
        let on_circle = |list: &Vec<usize>| list.iter().filter(|&&n| in_body(n)).count();
        let most = AXES * tooth_nodes.iter().map(on_circle).sum::<usize>();
        if tooth_nodes.len() < 3 || !tooth_nodes.iter().all(is_whole) || most > MOST_ON_CIRCLE {
            return Ok(None);
        }
        let ring = Ring::new(foot, tooth_nodes, in_body)?;
        let circle: Vec<usize> = (ring.core_nodes())
            .filter_map(|node| body_nodes.binary_search(&node).ok())
            .collect();
        let blocks = ring.stiffness_at_core();
        let (teeth, own) = (blocks.len(), blocks[0].nrows());
        let of_ring =
            |i: usize, j: usize| blocks[(i / own + teeth - j / own) % teeth][(i % own, j % own)];
        let all: Vec<usize> = (0..body_nodes.len()).collect();
        let stiffness = sector_stiffness(
            all.len(),
            (body, &all),
            (of_ring, std::slice::from_ref(&circle)),
        )?;
        let core = StaticCondensation::announced(stiffness, &circle, &[], |symbolic| {
            progress.expect(symbolic.expected_seconds())
        })?;
        let condensation = RingCondensation::new(ring, core, body_nodes.to_vec())?;
        Ok(Some(Self::Ringed(Box::new(condensation))))
    }

    /// The ring of its teeth, where it was condensed by one.
    pub fn ring(&self) -> Option<&RingCondensation> {
        match self {
            Self::AtOnce(_) => None,
            Self::Ringed(ringed) => Some(ringed),
        }
    }

    /// S, the stiffness at the cuts (N/m).
    pub fn stiffness(&self) -> MatRef<'_, f64> {
        match self {
            Self::AtOnce(whole) => whole.stiffness(),
            Self::Ringed(ringed) => ringed.stiffness(),
        }
    }

    /// Displacements of the sector.
    pub fn size(&self) -> usize {
        match self {
            Self::AtOnce(whole) => whole.size(),
            Self::Ringed(ringed) => ringed.size(),
        }
    }

    /// Rows of half solves.
    pub fn interior_size(&self) -> usize {
        match self {
            Self::AtOnce(whole) => whole.interior_size(),
            Self::Ringed(ringed) => ringed.interior_size(),
        }
    }

    /// Size and cost of the sparse factorisation.
    pub fn info(&self) -> FactorInfo {
        match self {
            Self::AtOnce(whole) => whole.info(),
            Self::Ringed(ringed) => ringed.info(),
        }
    }

    /// Factorisations: one, and those of the ring's harmonics.
    pub fn factorisations(&self) -> usize {
        1 + self.ring().map_or(0, |ringed| ringed.ring().harmonics())
    }

    /// Carries loads to the cuts.
    ///
    /// # Panics
    /// If `loads` does not have [`SectorCondensation::size`] rows.
    pub fn condense(&self, loads: MatRef<'_, f64>) -> CondensedLoads {
        match self {
            Self::AtOnce(whole) => whole.condense(loads),
            Self::Ringed(ringed) => ringed.condense(loads),
        }
    }

    /// All displacements (m) from those of the cuts and the half solves of loads.
    ///
    /// # Panics
    /// As [`StaticCondensation::expand`].
    pub fn expand(&self, cuts: MatRef<'_, f64>, interior: MatRef<'_, f64>) -> Mat<f64> {
        match self {
            Self::AtOnce(whole) => whole.expand(cuts, Some(interior)),
            Self::Ringed(ringed) => ringed.expand(interior),
        }
    }
}
