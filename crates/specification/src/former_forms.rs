//! Forms that scenes had in earlier versions and that are still read: every key that has moved, and where it stands now
//! (docs/decisions/0014-tables-by-kind.md).

use gearmesh_geometry::input::{FormerTable, Move};

/// Those of multibody scenes.
pub const SYSTEM: &[FormerTable] = &[
    FormerTable {
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
    },
    FormerTable {
        table: "shaft",
        moves: &[
            to("kind", "model.kind"),
            to("young_GPa", "model.young_GPa"),
            to("poisson", "model.poisson"),
            to("damping_s", "model.damping_s"),
        ],
    },
    FormerTable {
        table: "gear_mesh",
        moves: &[
            to("model", "model.kind"),
            to("stiffness_N_per_mm_e", "model.stiffness_N_per_mm_e"),
            to("exponent", "model.exponent"),
            to("damping_N_s_per_mm", "model.damping_N_s_per_mm"),
            to("full_damping_depth_um", "model.full_damping_depth_um"),
            to("stiffness", "model.stiffness"),
            to("stiffness_N_per_mm_um", "model.stiffness_N_per_mm_um"),
            to("line_load_N_per_mm", "model.line_load_N_per_mm"),
            to("stiffness_amplitude", "model.stiffness_amplitude"),
            to("local", "model.local"),
            to("nominal_force_N", "model.nominal_force_N"),
            to("slices", "model.slices"),
            to("damping", "model.damping"),
            to("cracks_1", "model.cracks_1"),
            to("cracks_2", "model.cracks_2"),
            to("flanks", "teeth.flanks"),
            to("path", "teeth.path"),
            to("friction", "teeth.friction"),
            to("errors_1", "teeth.errors_1"),
            to("errors_2", "teeth.errors_2"),
            to("eccentricity_1", "teeth.eccentricity_1"),
            to("eccentricity_2", "teeth.eccentricity_2"),
        ],
    },
];

/// Those of scenes of a pair.
pub const PAIR: &[FormerTable] = &[FormerTable {
    table: "mesh",
    moves: &[
        to("model", "model.kind"),
        to("local", "model.local"),
        to("slices", "model.slices"),
        to("path", "teeth.path"),
        to("edge_radius_um", "teeth.edge_radius_um"),
        to("friction.coefficient", "friction.dynamic_coefficient"),
        to("friction", "teeth.friction"),
        to("errors_1", "teeth.errors_1"),
        to("errors_2", "teeth.errors_2"),
        to("eccentricity_1", "teeth.eccentricity_1"),
        to("eccentricity_2", "teeth.eccentricity_2"),
    ],
}];

const fn to(from: &'static str, to: &'static str) -> Move {
    Move { from, to }
}
