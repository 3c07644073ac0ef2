//! Keys that a kind of bearing does not use.

use gearmesh_geometry::InputError;
use gearmesh_geometry::input::TableKeys;

use super::BearingFile;

/// Keys that the chosen kind does not use are errors.
pub(super) fn refuse(file: &BearingFile, keys: &TableKeys<'_>) -> Result<(), InputError> {
    const BALLS: &[&str] = &["deep-groove", "angular-contact"];
    const ALL_BALLS: &[&str] = &[
        "deep-groove",
        "angular-contact",
        "four-point",
        "thrust-ball",
        "catalogue",
    ];
    const ROLLERS: &[&str] = &["cylindrical-roller", "tapered-roller"];
    const ROLLERS_OR_LISTED: &[&str] = &[
        "cylindrical-roller",
        "tapered-roller",
        "spherical-roller",
        "catalogue",
    ];
    const LISTED: &[&str] = &["catalogue"];
    const PRELOADED: &[&str] = &[
        "angular-contact",
        "thrust-ball",
        "tapered-roller",
        "catalogue",
    ];
    keys.refuse_unused(
        ("kind", file.kind.word()),
        &[
            ("balls", file.balls.is_some(), ALL_BALLS),
            (
                "ball_diameter_mm",
                file.ball_diameter_mm.is_some(),
                ALL_BALLS,
            ),
            (
                "pitch_diameter_mm",
                file.pitch_diameter_mm.is_some(),
                &[
                    "deep-groove",
                    "angular-contact",
                    "four-point",
                    "thrust-ball",
                    "cylindrical-roller",
                    "tapered-roller",
                    "spherical-roller",
                    "catalogue",
                ],
            ),
            (
                "inner_conformity",
                file.inner_conformity.is_some(),
                ALL_BALLS,
            ),
            (
                "outer_conformity",
                file.outer_conformity.is_some(),
                ALL_BALLS,
            ),
            (
                "contact_angle_deg",
                file.contact_angle_deg.is_some(),
                &[
                    "angular-contact",
                    "four-point",
                    "tapered-roller",
                    "spherical-roller",
                    "catalogue",
                ],
            ),
            (
                "radial_clearance_um",
                file.radial_clearance_um.is_some(),
                &[
                    "deep-groove",
                    "four-point",
                    "cylindrical-roller",
                    "spherical-roller",
                    "catalogue",
                ],
            ),
            (
                "raceway_diameters_mm",
                file.raceway_diameters_mm.is_some(),
                BALLS,
            ),
            (
                "shoulder_heights_mm",
                file.shoulder_heights_mm.is_some(),
                &["deep-groove", "angular-contact", "four-point", "catalogue"],
            ),
            ("rollers", file.rollers.is_some(), ROLLERS_OR_LISTED),
            (
                "roller_diameter_mm",
                file.roller_diameter_mm.is_some(),
                ROLLERS_OR_LISTED,
            ),
            (
                "roller_length_mm",
                file.roller_length_mm.is_some(),
                ROLLERS_OR_LISTED,
            ),
            ("profile", file.profile.is_some(), ROLLERS),
            (
                "laminae",
                file.laminae.is_some(),
                &["cylindrical-roller", "tapered-roller", "spherical-roller"],
            ),
            (
                "end_radius_ratio",
                file.end_radius_ratio.is_some(),
                &["tapered-roller"],
            ),
            (
                "rib_height_mm",
                file.rib_height_mm.is_some(),
                &["tapered-roller"],
            ),
            (
                "roller_profile_radius_mm",
                file.roller_profile_radius_mm.is_some(),
                &["spherical-roller"],
            ),
            (
                "inner_groove_radius_mm",
                file.inner_groove_radius_mm.is_some(),
                &["spherical-roller"],
            ),
            ("designation", file.designation.is_some(), LISTED),
            ("type", file.r#type.is_some(), LISTED),
            ("preload_N", file.preload_N.is_some(), PRELOADED),
            ("preload_um", file.preload_um.is_some(), PRELOADED),
        ],
    )
}
