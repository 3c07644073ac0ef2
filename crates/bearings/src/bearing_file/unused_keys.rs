//! Keys that a kind of bearing, or a type of a catalogue, does not use.

use gearmesh_geometry::input::TableKeys;
use gearmesh_geometry::{InputError, given};

use super::BearingFile;
use crate::catalogue::CatalogueType;

/// Keys that the chosen kind does not use are errors.
pub(super) fn by_kind(file: &BearingFile, keys: &TableKeys<'_>) -> Result<(), InputError> {
    const BALLS: &str = "deep-groove angular-contact four-point thrust-ball catalogue";
    const ROLLERS: &str = "cylindrical-roller tapered-roller spherical-roller catalogue";
    const WITH_ANGLE: &str = "angular-contact four-point tapered-roller spherical-roller catalogue";
    const WITH_PLAY: &str = "deep-groove four-point cylindrical-roller spherical-roller catalogue";
    const PRELOADED: &str = "angular-contact thrust-ball tapered-roller catalogue";
    // Four-point and thrust bearings have one row, spherical roller bearings two that face one sphere.
    const PAIRED: &str = "deep-groove angular-contact cylindrical-roller tapered-roller catalogue";
    const BARRELS: &str = "spherical-roller";
    let groups: &[(&[(&str, bool)], &str)] = &[
        (&given!(file; balls, ball_diameter_mm), BALLS),
        (&given!(file; inner_conformity, outer_conformity), BALLS),
        (&given!(file; rollers, roller_diameter_mm), ROLLERS),
        (&given!(file; roller_length_mm), ROLLERS),
        (&given!(file; contact_angle_deg), WITH_ANGLE),
        (&given!(file; radial_clearance_um), WITH_PLAY),
        (
            &given!(file; raceway_diameters_mm),
            "deep-groove angular-contact",
        ),
        (
            &given!(file; shoulder_heights_mm),
            "deep-groove angular-contact four-point catalogue",
        ),
        (&given!(file; profile), "cylindrical-roller tapered-roller"),
        (
            &given!(file; laminae),
            "cylindrical-roller tapered-roller spherical-roller",
        ),
        (
            &given!(file; end_radius_ratio, rib_height_mm),
            "tapered-roller",
        ),
        (&given!(file; roller_profile_radius_mm), BARRELS),
        (&given!(file; inner_groove_radius_mm), BARRELS),
        (&given!(file; designation, r#type), "catalogue"),
        (&given!(file; preload_N, preload_um), PRELOADED),
        (&given!(file; arrangement, row_distance_mm), PAIRED),
    ];
    keys.refuse_unused(("kind", file.kind.word()), groups)
}

/// Keys that the type of a catalogue's line does not use.
pub(super) fn by_type(
    file: &BearingFile,
    keys: &TableKeys<'_>,
    kind: CatalogueType,
) -> Result<(), InputError> {
    const BALLS: &str =
        "deep-groove angular-contact angular-contact-double-row four-point thrust-ball";
    const WITH_SHOULDERS: &str =
        "deep-groove angular-contact angular-contact-double-row four-point";
    const ROLLERS: &str = "cylindrical-roller tapered-roller spherical-roller";
    // The play of the others is said by their contact angle or preload_um.
    const WITH_PLAY: &str = "deep-groove four-point cylindrical-roller spherical-roller";
    const PAIRED: &str =
        "deep-groove angular-contact angular-contact-double-row cylindrical-roller tapered-roller";
    let groups: &[(&[(&str, bool)], &str)] = &[
        (&given!(file; balls, ball_diameter_mm), BALLS),
        (&given!(file; inner_conformity, outer_conformity), BALLS),
        (&given!(file; shoulder_heights_mm), WITH_SHOULDERS),
        (&given!(file; rollers, roller_diameter_mm), ROLLERS),
        (&given!(file; roller_length_mm), ROLLERS),
        (&given!(file; radial_clearance_um), WITH_PLAY),
        (&given!(file; arrangement, row_distance_mm), PAIRED),
    ];
    keys.refuse_unused(("type", kind.word()), groups)
}
