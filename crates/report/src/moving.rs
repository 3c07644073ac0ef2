//! Gears that move, as a series of files for ParaView and PyVista: `gearmesh export RESULT -o x.pvd`. For users:
//! docs/formats.md.
//!
//! | what | file |
//! | --- | --- |
//! | a moment: where the gears stand and what presses on their flanks | this one |
//! | surface of a gear | `moving/gear_surface.rs` |
//! | a gear as pages draw it in space | `moving/gear_shape.rs` |
//! | moments of a pair at rest | `moving/pair_moments.rs` |
//! | a moment as a file, the series as one | `moving/vtu_text.rs` |

mod gear_shape;
mod gear_surface;
mod pair_moments;
mod vtu_text;

pub use gear_shape::GearShape;
pub use gear_surface::{FlankFace, GearSurface, tooth_outline};
pub use pair_moments::{pair_moment, pair_surfaces, pair_turns, touching_points_m};
pub use vtu_text::{Series, series_text};

use gearmesh_geometry::Flank;

/// Where a gear stands: world from gear axes by rows, and its origin \[m\].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Placement {
    /// World from gear axes.
    pub rotation: [[f64; 3]; 3],
    /// Middle of the face on the axis, of a bevel gear the pitch apex \[m\].
    pub origin_m: [f64; 3],
}

impl Placement {
    /// A gear whose axis is z of the world, turned about it.
    #[must_use]
    pub fn turned(angle_rad: f64, origin_m: [f64; 3]) -> Self {
        let (s, c) = angle_rad.sin_cos();
        Self {
            rotation: [[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]],
            origin_m,
        }
    }

    pub(crate) fn direction(&self, v: [f64; 3]) -> [f64; 3] {
        self.rotation
            .map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
    }

    fn point(&self, p: [f64; 3]) -> [f64; 3] {
        let turned = self.direction(p);
        std::array::from_fn(|k| turned[k] + self.origin_m[k])
    }
}

/// What presses on a slice of a flank.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlankLoad {
    /// Number of the mesh.
    pub mesh: usize,
    /// Number of the gear's surface.
    pub gear: usize,
    /// Tooth.
    pub tooth: usize,
    /// Flank.
    pub side: Flank,
    /// Roll angle \[rad\]; on a bevel gear the share of the way up the flank.
    pub roll_rad: f64,
    /// Height above mid-face \[m\], on a bevel gear along the pitch cone.
    pub height_m: f64,
    /// Width of the slice \[m\].
    pub width_m: f64,
    /// Along the inward normal and along the profile towards the tip \[N\].
    pub components_n: [f64; 2],
    /// Force on this gear, world axes \[N\].
    pub force_n: [f64; 3],
    /// Line load \[N/m\].
    pub line_load_n_per_m: f64,
    /// Hertz pressure \[Pa\].
    pub pressure_pa: f64,
}

/// A moment.
#[derive(Debug, Clone, PartialEq)]
pub struct Moment {
    /// What the series runs over: time \[s\] or driver angle \[deg\].
    pub at: f64,
    /// Where each gear stands.
    pub placements: Vec<Placement>,
    /// What presses on the flanks.
    pub loads: Vec<FlankLoad>,
    /// Of each gear the radial motions of its bore, where rollers press on it \[m\]; may be shorter.
    pub bore_m: Vec<Vec<f64>>,
    /// Von Mises stress of each gear's cells \[Pa\]; empty where none is asked for.
    pub von_mises_pa: Vec<Vec<f64>>,
}
