//! What is made of the columns that a rating of a run reads.

use gearmesh_rating::NominalRating;

use super::{BearingLifeJob, FatigueJob};

/// What is made of the columns of a rating.
#[derive(Debug, Clone, PartialEq)]
pub enum RatingRule {
    /// Cycles and damage of the sum of the columns, strain in µε.
    Fatigue(FatigueJob),
    /// Nominal stresses under the largest value of the columns, forces in N.
    Nominal(Box<NominalRating>),
    /// Life of a bearing under the loads of the columns.
    BearingLife(Box<BearingLifeJob>),
}
