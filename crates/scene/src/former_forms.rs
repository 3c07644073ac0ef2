//! Forms that scenes had in earlier versions and that are still read: every key that has moved, and where it stands now.

use gearmesh_geometry::input::{FormerTable, Move};

/// Those of multibody scenes.
pub(crate) const SYSTEM: &[FormerTable] = &[FormerTable {
    table: "bearing",
    moves: &[
        to("kind", "model.kind"),
        to(
            "radial_stiffness_N_per_mm",
            "model.radial_stiffness_N_per_mm",
        ),
        to("axial_stiffness_N_per_mm", "model.axial_stiffness_N_per_mm"),
        to(
            "tilt_stiffness_Nm_per_rad",
            "model.tilt_stiffness_Nm_per_rad",
        ),
        to(
            "radial_damping_N_s_per_mm",
            "model.radial_damping_N_s_per_mm",
        ),
        to("axial_damping_N_s_per_mm", "model.axial_damping_N_s_per_mm"),
        to(
            "tilt_damping_Nm_s_per_rad",
            "model.tilt_damping_Nm_s_per_rad",
        ),
    ],
}];

const fn to(from: &'static str, to: &'static str) -> Move {
    Move { from, to }
}
