//! A body of a single sector under loads on its teeth: half solves, whose products are what goes from tooth to tooth.

use crate::cyclic_body::CyclicBody;
use crate::flank_loads::SparseVector;
use faer::{Mat, MatRef};
use gearmesh_fe::CondensedLoads;

/// A body that does not repeat, and the loads of a tooth carried to its foot.
pub(crate) struct SingleSector<'a> {
    body: &'a CyclicBody,
    on_tooth: CondensedLoads,
}

impl<'a> SingleSector<'a> {
    /// Loads given on tooth 0, equal on all teeth; none where the body repeats.
    pub fn new(body: &'a CyclicBody, vectors: &[&SparseVector]) -> Option<Self> {
        (body.sector.sectors == 1).then(|| Self {
            body,
            on_tooth: body.tooth.condense(&body.frames, vectors),
        })
    }

    /// Number of teeth.
    pub fn teeth(&self) -> usize {
        self.body.sector.own
    }

    /// Work of the loads inside the tooth, its foot held: loads × loads (m/N).
    pub fn inside(&self) -> Mat<f64> {
        self.on_tooth.gram(&self.on_tooth)
    }

    /// Half solves of the loads of a tooth combined by `shares` (loads × columns). With F the loads carried to a tooth's foot and S the
    /// compliance of the body with the feet, products of those of two teeth ([`CondensedLoads::gram`]) are sharesᵀ Fᵀ S F shares (m/N).
    pub fn half_solves(&self, tooth: usize, shares: MatRef<'_, f64>) -> CondensedLoads {
        let (_, own) = self.body.sector.of_tooth(tooth);
        let loads = self
            .body
            .at_foot((&self.on_tooth.kept * shares).as_ref(), own);
        self.body.sector.condensation().condense(loads.as_ref())
    }
}
