//! Joints of which some equations follow from those of others.

/// A joint of which some equations follow from those of other joints.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Redundancy {
    /// Name of the joint.
    pub joint: String,
    /// Number of its equations that are redundant.
    pub equations: usize,
    /// The joints that imply them.
    pub implied_by: Vec<String>,
}
