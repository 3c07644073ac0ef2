//! Where the matrices of a system may have entries: blocks of bodies, of pairs that joints connect, and of force
//! elements.

use std::sync::Arc;

use crate::body::BodyId;
use crate::joint::Joint;
use crate::pattern::Pattern;
use crate::state::Layout;

/// Patterns of the matrices of a system, the same for every motion.
#[derive(Debug, Clone)]
pub(crate) struct Structure {
    /// Mass, damping and stiffness: square and symmetric.
    pub square: Arc<Pattern>,
    /// Bᵀ: one column for each joint equation; rows in sixes, the rigid motion of a body each.
    pub gradient: Arc<Pattern>,
}

impl Structure {
    /// `elements`: degrees of freedom of the system that an element couples with each other.
    pub(crate) fn new(
        layout: &Layout,
        joints: &[Joint],
        elements: impl Iterator<Item = Vec<usize>>,
    ) -> Self {
        let rigid = |body: BodyId| {
            let start = layout.start(body);
            start.map_or(0..0, |start| start..start + 6)
        };
        let mut groups: Vec<Vec<usize>> = elements.collect();
        for (body, start) in layout.starts().enumerate() {
            let own: Vec<usize> = (start..start + 6).collect();
            let modes = start + 6..start + layout.size(BodyId(body));
            groups.extend(modes.map(|mode| [&own[..], &[mode]].concat()));
            groups.push(own);
        }
        let mut columns = Vec::new();
        for joint in joints {
            let pairs = joint.pairs().iter();
            let of_pairs: Vec<Vec<usize>> = pairs
                .map(|pair| rigid(pair.a.body).chain(rigid(pair.b.body)).collect())
                .collect();
            let all = of_pairs.concat();
            columns.extend((0..joint.equations()).map(|_| all.clone()));
            groups.extend(of_pairs);
        }
        let size = layout.degrees_of_freedom();
        Self {
            square: Arc::new(Pattern::of_groups(size, groups.iter().map(Vec::as_slice))),
            gradient: Arc::new(Pattern::from_columns(size, columns)),
        }
    }
}
