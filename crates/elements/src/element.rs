//! The elements on offer, by name.

use crate::cell_kind::CellKind;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Kind and formulation of an element. A gear file may name those without wedges, which only fill gaps of imported
/// meshes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Element {
    /// Hexahedron of eight nodes: trilinear displacement, 2×2×2 Gauss points. Locks in bending.
    Hex8,
    /// [`Element::Hex8`] with three condensed bending modes (QM6). No locking in bending; the default.
    #[default]
    Hex8Incompatible,
    /// Hexahedron of twenty nodes, quadratic displacement and edges (serendipity), 3×3×3 Gauss points.
    Hex20,
    /// Tetrahedron of ten nodes, quadratic displacement and edges, eight points.
    Tet10,
    /// Wedge of six nodes beside hexahedra of eight, 3×2 points. Locks in bending.
    #[serde(skip)]
    Wedge6,
    /// Wedge of fifteen nodes beside hexahedra of twenty (serendipity), 6×3 points.
    #[serde(skip)]
    Wedge15,
}

impl Element {
    /// Every formulation.
    pub const ALL: [Self; 6] = [
        Self::Hex8,
        Self::Hex8Incompatible,
        Self::Hex20,
        Self::Tet10,
        Self::Wedge6,
        Self::Wedge15,
    ];

    /// The name in files and messages.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Hex8Incompatible => "hex8-incompatible",
            _ => self.cell().name(),
        }
    }

    /// The formulation with this name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|e| e.name() == name)
    }

    /// Its nodes.
    pub const fn cell(self) -> CellKind {
        match self {
            Self::Hex8 | Self::Hex8Incompatible => CellKind::Hex8,
            Self::Hex20 => CellKind::Hex20,
            Self::Tet10 => CellKind::Tet10,
            Self::Wedge6 => CellKind::Wedge6,
            Self::Wedge15 => CellKind::Wedge15,
        }
    }

    /// Number of nodes.
    pub const fn node_count(self) -> usize {
        self.cell().node_count()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_lead_back() {
        for element in Element::ALL {
            assert_eq!(Element::from_name(element.name()), Some(element));
        }
        for cell in CellKind::ALL {
            assert_eq!(CellKind::from_name(cell.name()), Some(cell));
        }
        assert_eq!(Element::from_name("hex9"), None);
    }
}
