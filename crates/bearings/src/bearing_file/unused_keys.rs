//! Keys that a kind of bearing, or a type of a catalogue, does not use.

use gearmesh_geometry::InputError;
use gearmesh_geometry::input::TableKeys;

use super::BearingFile;
use super::given::given;
use crate::catalogue::CatalogueType;

/// Keys of a file, each with whether it is given, and the kinds that use them.
type Group<'a> = (&'a [(&'a str, bool)], &'a [&'a str]);

fn refuse(
    keys: &TableKeys<'_>,
    chosen: (&str, &str),
    groups: &[Group<'_>],
) -> Result<(), InputError> {
    for (given, users) in groups {
        for (key, is_given) in *given {
            keys.refuse_unused(chosen, &[(key, *is_given, users)])?;
        }
    }
    Ok(())
}

/// Keys that the chosen kind does not use are errors.
pub(super) fn by_kind(file: &BearingFile, keys: &TableKeys<'_>) -> Result<(), InputError> {
    const SIZES: &[&str] = &[
        "deep-groove",
        "angular-contact",
        "four-point",
        "thrust-ball",
        "cylindrical-roller",
        "tapered-roller",
        "spherical-roller",
        "catalogue",
    ];
    let balls = &[SIZES[0], SIZES[1], SIZES[2], SIZES[3], "catalogue"];
    let rollers = &SIZES[4..];
    let preloaded = &[
        "angular-contact",
        "thrust-ball",
        "tapered-roller",
        "catalogue",
    ];
    refuse(
        keys,
        ("kind", file.kind.word()),
        &[
            (&given!(file; pitch_diameter_mm), SIZES),
            (
                &given!(file; balls, ball_diameter_mm, inner_conformity, outer_conformity),
                balls,
            ),
            (
                &given!(file; rollers, roller_diameter_mm, roller_length_mm),
                rollers,
            ),
            (
                &given!(file; contact_angle_deg),
                &[
                    "angular-contact",
                    "four-point",
                    "tapered-roller",
                    "spherical-roller",
                    "catalogue",
                ],
            ),
            (
                &given!(file; radial_clearance_um),
                &[
                    "deep-groove",
                    "four-point",
                    "cylindrical-roller",
                    "spherical-roller",
                    "catalogue",
                ],
            ),
            (
                &given!(file; raceway_diameters_mm),
                &["deep-groove", "angular-contact"],
            ),
            (
                &given!(file; shoulder_heights_mm),
                &["deep-groove", "angular-contact", "four-point", "catalogue"],
            ),
            (
                &given!(file; profile),
                &["cylindrical-roller", "tapered-roller"],
            ),
            (
                &given!(file; laminae),
                &["cylindrical-roller", "tapered-roller", "spherical-roller"],
            ),
            (
                &given!(file; end_radius_ratio, rib_height_mm),
                &["tapered-roller"],
            ),
            (
                &given!(file; roller_profile_radius_mm, inner_groove_radius_mm),
                &["spherical-roller"],
            ),
            (&given!(file; designation, r#type), &["catalogue"]),
            (&given!(file; preload_N, preload_um), preloaded),
            // Of the others four-point and thrust bearings have one row, spherical roller bearings two that face one sphere.
            (
                &given!(file; arrangement, row_distance_mm),
                &[
                    "deep-groove",
                    "angular-contact",
                    "cylindrical-roller",
                    "tapered-roller",
                    "catalogue",
                ],
            ),
        ],
    )
}

/// Keys that the type of a catalogue's line does not use.
pub(super) fn by_type(
    file: &BearingFile,
    keys: &TableKeys<'_>,
    kind: CatalogueType,
) -> Result<(), InputError> {
    const BALLS: &[&str] = &[
        "deep-groove",
        "angular-contact",
        "angular-contact-double-row",
        "four-point",
        "thrust-ball",
    ];
    refuse(
        keys,
        ("type", kind.word()),
        &[
            (
                &given!(file; balls, ball_diameter_mm, inner_conformity, outer_conformity),
                BALLS,
            ),
            (&given!(file; shoulder_heights_mm), &BALLS[..4]),
            (
                &given!(file; rollers, roller_diameter_mm, roller_length_mm),
                &["cylindrical-roller", "tapered-roller", "spherical-roller"],
            ),
            // The play of the others is said by their contact angle or preload_um.
            (
                &given!(file; radial_clearance_um),
                &[
                    "deep-groove",
                    "four-point",
                    "cylindrical-roller",
                    "spherical-roller",
                ],
            ),
            (
                &given!(file; arrangement, row_distance_mm),
                &[
                    "deep-groove",
                    "angular-contact",
                    "angular-contact-double-row",
                    "cylindrical-roller",
                    "tapered-roller",
                ],
            ),
        ],
    )
}
