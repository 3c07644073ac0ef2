//! The two end faces of a gear that is cut into a shaft which goes on at both: what joins them, and what they do to the
//! flanks.
//!
//! With both faces held the flanks deflect by C f. Let the front face move by e against the back one (three
//! translations of its centre, three rotations about it, along the gear's axes), Ψ the displacements of the body under
//! unit motions, K those of its forces:
//!
//! ```text
//! flanks  NᵀΨ e + C f,      force on the front face  K e − (NᵀΨ)ᵀ f
//! ```
//!
//! The rest follows from balance: the 12 × 12 stiffness between the faces has the six rigid motions as its null space.
//! Theory: docs/theory/reduction.md, "Two faces".

use crate::quantity_check::check_array;
use crate::reduced_gear_error::ReducedGearError;

/// The front face against the back one. Motions: x, y, z, rotations about x, y, z of the front face's centre.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ShaftFaces {
    /// Centre of the front face (m).
    pub front_m: [f64; 3],
    /// K, `[motion][motion]`: force and moment on the front face per motion of it, back face held (N/m, N, N m).
    pub stiffness: Vec<f64>,
    /// NᵀΨ, `[tooth][flank][load][component][motion]`; components as in [`crate::GaugeRows::adjoint`] (m/m, m/rad).
    pub flank: Vec<f64>,
    /// gᵀΨ, `[gauge][motion]` (strain per m, per rad).
    pub gauges: Vec<f64>,
    /// The mass that goes with them; none where no density was given.
    pub mass: Option<FaceMass>,
}

/// Consistent mass of the motions of the front face; that of the body as a whole is in [`crate::RigidBody`].
#[derive(Debug, Clone, PartialEq, Default)]
pub struct FaceMass {
    /// ΨᵀMΨ, `[motion][motion]` (kg, kg m, kg m²).
    pub mass: Vec<f64>,
    /// ΨᵀMR, `[motion][rigid motion]`, rigid motions about the origin of the gear's frame (kg, kg m, kg m²).
    pub coupling: Vec<f64>,
    /// ΦᵀMΨ of each natural mode with both faces held, `[mode][motion]` (kg^½, kg^½ m); empty without modes.
    pub modes: Vec<f64>,
}

impl ShaftFaces {
    /// Lengths of all arrays. `sizes`: loads on the flanks of all teeth, gauges, natural modes.
    pub(crate) fn check(&self, [loads, gauges, modes]: [usize; 3]) -> Result<(), ReducedGearError> {
        let mut arrays = vec![
            ("front_m", &self.front_m[..], 3, "3"),
            ("stiffness", &self.stiffness, 36, "6 * 6"),
            (
                "flank",
                &self.flank,
                3 * 6 * loads,
                "teeth * flanks * loads * 3 * 6",
            ),
            ("gauges", &self.gauges, 6 * gauges, "gauges * 6"),
        ];
        if let Some(mass) = &self.mass {
            arrays.extend([
                ("mass.mass", &mass.mass[..], 36, "6 * 6"),
                ("mass.coupling", &mass.coupling, 36, "6 * 6"),
                ("mass.modes", &mass.modes, 6 * modes, "modes * 6"),
            ]);
        }
        for (name, values, expected, formula) in arrays {
            check_array(&format!("shaft_faces.{name}"), values, expected, formula)?;
        }
        Ok(())
    }
}
