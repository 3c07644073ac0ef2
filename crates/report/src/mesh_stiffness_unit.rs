//! The unit of mesh stiffness on pages, the console's: per width of the overlapping faces.

use gearmesh_scene::SceneResult;

/// The usual unit.
const PER_WIDTH: &str = "N/(mm·µm)";

/// A unit of mesh stiffness, and what makes numbers in N/m numbers in it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct MeshStiffness {
    /// Name.
    pub name: &'static str,
    /// Factor.
    pub factor: f64,
}

impl MeshStiffness {
    /// Of the whole face: for results whose gear files this program does not understand, whose width is not known.
    const WHOLE: Self = Self {
        name: "N/µm",
        factor: 1e-6,
    };

    /// Of a result.
    pub fn of(result: &SceneResult) -> Self {
        result
            .overlap_width_m()
            .map_or(Self::WHOLE, |width_m| Self {
                name: PER_WIDTH,
                factor: 1e-9 / width_m,
            })
    }

    /// Of results side by side, all in one unit.
    pub fn of_all<'r>(results: impl Iterator<Item = &'r SceneResult>) -> Vec<Self> {
        let own: Vec<Self> = results.map(Self::of).collect();
        if own.iter().all(|unit| unit.name == PER_WIDTH) {
            return own;
        }
        vec![Self::WHOLE; own.len()]
    }
}
