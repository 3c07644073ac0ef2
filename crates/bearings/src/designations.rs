//! Boundary dimensions of common designations: bore d, outside diameter D, width B (tapered bearings T) in mm.
//!
//! The dimension series of ISO 15 (radial bearings) and ISO 355 (tapered roller bearings, with their contact angles), where public tables agree. Load
//! ratings are not in them: they follow from the estimated inside by ISO 281 and ISO 76. Contact angles of ball bearings are those that
//! the letters behind the number usually mean (C 15, AC 25, A 30, B 40 degrees), which no standard says.

use crate::catalogue::{CatalogueLine, CatalogueType, KnownInside};

/// Bore in mm, outside diameter and width.
type Size = (u16, f64, f64);

/// Bore, outside diameter, assembled width, contact angle in degrees, minutes, seconds.
type TaperedSize = (u16, f64, f64, (u8, u8, u8));

/// Dimension series 18.
const SERIES_18: &[Size] = &[
    (10, 19.0, 5.0),
    (12, 21.0, 5.0),
    (15, 24.0, 5.0),
    (17, 26.0, 5.0),
    (20, 32.0, 7.0),
    (25, 37.0, 7.0),
    (30, 42.0, 7.0),
    (35, 47.0, 7.0),
    (40, 52.0, 7.0),
    (45, 58.0, 7.0),
    (50, 65.0, 7.0),
    (55, 72.0, 9.0),
    (60, 78.0, 10.0),
    (65, 85.0, 10.0),
    (70, 90.0, 10.0),
    (75, 95.0, 10.0),
    (80, 100.0, 10.0),
    (85, 110.0, 13.0),
    (90, 115.0, 13.0),
    (95, 120.0, 13.0),
    (100, 125.0, 13.0),
];

/// Dimension series 10.
const SERIES_10: &[Size] = &[
    (10, 26.0, 8.0),
    (12, 28.0, 8.0),
    (15, 32.0, 9.0),
    (17, 35.0, 10.0),
    (20, 42.0, 12.0),
    (25, 47.0, 12.0),
    (30, 55.0, 13.0),
    (35, 62.0, 14.0),
    (40, 68.0, 15.0),
    (45, 75.0, 16.0),
    (50, 80.0, 16.0),
    (55, 90.0, 18.0),
    (60, 95.0, 18.0),
    (65, 100.0, 18.0),
    (70, 110.0, 20.0),
    (75, 115.0, 20.0),
    (80, 125.0, 22.0),
    (85, 130.0, 22.0),
    (90, 140.0, 24.0),
    (95, 145.0, 24.0),
    (100, 150.0, 24.0),
];

/// Dimension series 02.
const SERIES_02: &[Size] = &[
    (10, 30.0, 9.0),
    (12, 32.0, 10.0),
    (15, 35.0, 11.0),
    (17, 40.0, 12.0),
    (20, 47.0, 14.0),
    (25, 52.0, 15.0),
    (30, 62.0, 16.0),
    (35, 72.0, 17.0),
    (40, 80.0, 18.0),
    (45, 85.0, 19.0),
    (50, 90.0, 20.0),
    (55, 100.0, 21.0),
    (60, 110.0, 22.0),
    (65, 120.0, 23.0),
    (70, 125.0, 24.0),
    (75, 130.0, 25.0),
    (80, 140.0, 26.0),
    (85, 150.0, 28.0),
    (90, 160.0, 30.0),
    (95, 170.0, 32.0),
    (100, 180.0, 34.0),
];

/// Dimension series 22.
const SERIES_22: &[Size] = &[
    (17, 40.0, 16.0),
    (20, 47.0, 18.0),
    (25, 52.0, 18.0),
    (30, 62.0, 20.0),
    (35, 72.0, 23.0),
    (40, 80.0, 23.0),
    (45, 85.0, 23.0),
    (50, 90.0, 23.0),
    (55, 100.0, 25.0),
    (60, 110.0, 28.0),
    (65, 120.0, 31.0),
    (70, 125.0, 31.0),
    (75, 130.0, 31.0),
    (80, 140.0, 33.0),
    (85, 150.0, 36.0),
    (90, 160.0, 40.0),
    (95, 170.0, 43.0),
    (100, 180.0, 46.0),
];

/// Dimension series 03.
const SERIES_03: &[Size] = &[
    (10, 35.0, 11.0),
    (12, 37.0, 12.0),
    (15, 42.0, 13.0),
    (17, 47.0, 14.0),
    (20, 52.0, 15.0),
    (25, 62.0, 17.0),
    (30, 72.0, 19.0),
    (35, 80.0, 21.0),
    (40, 90.0, 23.0),
    (45, 100.0, 25.0),
    (50, 110.0, 27.0),
    (55, 120.0, 29.0),
    (60, 130.0, 31.0),
    (65, 140.0, 33.0),
    (70, 150.0, 35.0),
    (75, 160.0, 37.0),
    (80, 170.0, 39.0),
    (85, 180.0, 41.0),
    (90, 190.0, 43.0),
    (95, 200.0, 45.0),
    (100, 215.0, 47.0),
];

/// Dimension series 23.
const SERIES_23: &[Size] = &[
    (20, 52.0, 21.0),
    (25, 62.0, 24.0),
    (30, 72.0, 27.0),
    (35, 80.0, 31.0),
    (40, 90.0, 33.0),
    (45, 100.0, 36.0),
    (50, 110.0, 40.0),
    (55, 120.0, 43.0),
    (60, 130.0, 46.0),
    (65, 140.0, 48.0),
    (70, 150.0, 51.0),
    (75, 160.0, 55.0),
    (80, 170.0, 58.0),
    (85, 180.0, 60.0),
    (90, 190.0, 64.0),
    (95, 200.0, 67.0),
    (100, 215.0, 73.0),
];

/// Dimension series 04.
const SERIES_04: &[Size] = &[
    (17, 62.0, 17.0),
    (20, 72.0, 19.0),
    (25, 80.0, 21.0),
    (30, 90.0, 23.0),
    (35, 100.0, 25.0),
    (40, 110.0, 27.0),
    (45, 120.0, 29.0),
    (50, 130.0, 31.0),
    (55, 140.0, 33.0),
    (60, 150.0, 35.0),
    (65, 160.0, 37.0),
    (70, 180.0, 42.0),
    (75, 190.0, 45.0),
    (80, 200.0, 48.0),
    (85, 210.0, 52.0),
    (90, 225.0, 54.0),
];

/// Series 302 of tapered roller bearings.
const TAPERED_302: &[TaperedSize] = &[
    (17, 40.0, 13.25, (12, 57, 10)),
    (20, 47.0, 15.25, (12, 57, 10)),
    (25, 52.0, 16.25, (14, 2, 10)),
    (30, 62.0, 17.25, (14, 2, 10)),
    (35, 72.0, 18.25, (14, 2, 10)),
    (40, 80.0, 19.75, (14, 2, 10)),
    (45, 85.0, 20.75, (15, 6, 34)),
    (50, 90.0, 21.75, (15, 38, 32)),
    (55, 100.0, 22.75, (15, 6, 34)),
    (60, 110.0, 23.75, (15, 6, 34)),
    (65, 120.0, 24.75, (15, 6, 34)),
    (70, 125.0, 26.25, (15, 38, 32)),
    (75, 130.0, 27.25, (16, 10, 20)),
    (80, 140.0, 28.25, (15, 38, 32)),
];

/// Series 322 of tapered roller bearings.
const TAPERED_322: &[TaperedSize] = &[
    (30, 62.0, 21.25, (14, 2, 10)),
    (35, 72.0, 24.25, (14, 2, 10)),
    (40, 80.0, 24.75, (14, 2, 10)),
    (45, 85.0, 24.75, (15, 6, 34)),
    (50, 90.0, 24.75, (15, 38, 32)),
    (55, 100.0, 26.75, (15, 6, 34)),
    (60, 110.0, 29.75, (15, 6, 34)),
    (65, 120.0, 32.75, (15, 6, 34)),
    (70, 125.0, 33.25, (15, 38, 32)),
    (75, 130.0, 33.25, (16, 10, 20)),
    (80, 140.0, 35.25, (15, 38, 32)),
];

/// Series 303 of tapered roller bearings.
const TAPERED_303: &[TaperedSize] = &[
    (17, 47.0, 15.25, (10, 45, 29)),
    (20, 52.0, 16.25, (11, 18, 36)),
    (25, 62.0, 18.25, (11, 18, 36)),
    (30, 72.0, 20.75, (11, 51, 35)),
    (35, 80.0, 22.75, (11, 51, 35)),
    (40, 90.0, 25.25, (12, 57, 10)),
    (45, 100.0, 27.25, (12, 57, 10)),
    (50, 110.0, 29.25, (12, 57, 10)),
    (55, 120.0, 31.5, (12, 57, 10)),
    (60, 130.0, 33.5, (12, 57, 10)),
    (65, 140.0, 36.0, (12, 57, 10)),
    (70, 150.0, 38.0, (12, 57, 10)),
    (75, 160.0, 40.0, (12, 57, 10)),
    (80, 170.0, 42.5, (12, 57, 10)),
];

/// Series 323 of tapered roller bearings.
const TAPERED_323: &[TaperedSize] = &[
    (17, 47.0, 20.25, (10, 45, 29)),
    (20, 52.0, 22.25, (11, 18, 36)),
    (25, 62.0, 25.25, (11, 18, 36)),
    (30, 72.0, 28.75, (11, 51, 35)),
    (35, 80.0, 32.75, (11, 51, 35)),
    (40, 90.0, 35.25, (12, 57, 10)),
    (45, 100.0, 38.25, (12, 57, 10)),
    (50, 110.0, 42.25, (12, 57, 10)),
    (55, 120.0, 45.5, (12, 57, 10)),
    (60, 130.0, 48.5, (12, 57, 10)),
    (65, 140.0, 51.0, (12, 57, 10)),
    (70, 150.0, 54.0, (12, 57, 10)),
    (75, 160.0, 58.0, (12, 57, 10)),
    (80, 170.0, 61.5, (12, 57, 10)),
];

/// Designations with letters or digits in front, their type and table.
const RADIAL: &[(&str, CatalogueType, &[Size])] = &[
    ("618", CatalogueType::DeepGroove, SERIES_18),
    ("60", CatalogueType::DeepGroove, SERIES_10),
    ("62", CatalogueType::DeepGroove, SERIES_02),
    ("63", CatalogueType::DeepGroove, SERIES_03),
    ("64", CatalogueType::DeepGroove, SERIES_04),
    ("70", CatalogueType::AngularContact, SERIES_10),
    ("72", CatalogueType::AngularContact, SERIES_02),
    ("73", CatalogueType::AngularContact, SERIES_03),
    ("NU10", CatalogueType::CylindricalRoller, SERIES_10),
    ("NU2", CatalogueType::CylindricalRoller, SERIES_02),
    ("NU22", CatalogueType::CylindricalRoller, SERIES_22),
    ("NU3", CatalogueType::CylindricalRoller, SERIES_03),
    ("NU23", CatalogueType::CylindricalRoller, SERIES_23),
];

/// Series of tapered roller bearings.
const TAPERED: &[(&str, &[TaperedSize])] = &[
    ("302", TAPERED_302),
    ("303", TAPERED_303),
    ("322", TAPERED_322),
    ("323", TAPERED_323),
];

/// Letters behind the number of angular-contact bearings and the contact angles that they usually mean.
const ANGLES: &[(&str, f64)] = &[("C", 15.0), ("AC", 25.0), ("A", 30.0), ("B", 40.0)];

/// A designation's line.
#[derive(Debug, Clone, PartialEq)]
pub struct Listed {
    /// Designation, upper case, without blanks.
    pub designation: String,
    /// Its line; ratings are unknown.
    pub line: CatalogueLine,
    /// Whether it says the contact angle, where the type has one.
    pub says_angle: bool,
}

impl Listed {
    /// Where the figures are from.
    #[must_use]
    pub fn source(&self) -> String {
        let standard = match self.line.kind {
            CatalogueType::TaperedRoller => "boundary dimensions and contact angle by ISO 355",
            _ => "boundary dimensions by ISO 15",
        };
        format!(
            "{standard} ({} x {} x {} mm); C and C0 by ISO 281 and ISO 76 from the estimated inside where the file does not state them, no maker's figures",
            round(self.line.bore_m),
            round(self.line.outside_m),
            round(self.line.width_m)
        )
    }
}

/// Millimetres of metres without what rounding leaves.
fn round(m: f64) -> f64 {
    (1e5 * m).round() / 100.0
}

/// Bore of the last two digits.
fn bore_mm(code: &str) -> Option<u16> {
    if code.len() != 2 {
        return None;
    }
    Some(match code.parse::<u16>().ok()? {
        0 => 10,
        1 => 12,
        2 => 15,
        3 => 17,
        number => 5 * number,
    })
}

/// Finds a designation; blanks and case do not matter.
#[must_use]
pub fn find(designation: &str) -> Option<Listed> {
    let wanted: String = designation
        .chars()
        .filter(|c| !c.is_whitespace())
        .flat_map(char::to_uppercase)
        .collect();
    let listed =
        |kind: CatalogueType, (bore, outside, width): Size, angle_deg: Option<f64>| Listed {
            designation: wanted.clone(),
            line: CatalogueLine {
                kind,
                bore_m: 1e-3 * f64::from(bore),
                outside_m: 1e-3 * outside,
                width_m: 1e-3 * width,
                dynamic_n: None,
                static_n: None,
                contact_angle_rad: angle_deg.unwrap_or(0.0).to_radians(),
                known: KnownInside::default(),
            },
            says_angle: angle_deg.is_some() || kind.angles_deg().is_none(),
        };
    for (series, sizes) in TAPERED {
        let bore = wanted.strip_prefix(series).and_then(bore_mm);
        if let Some(size) = sizes.iter().find(|size| Some(size.0) == bore) {
            let (degrees, minutes, seconds) = size.3;
            let angle =
                f64::from(degrees) + f64::from(minutes) / 60.0 + f64::from(seconds) / 3600.0;
            let size = (size.0, size.1, size.2);
            return Some(listed(CatalogueType::TaperedRoller, size, Some(angle)));
        }
    }
    for (series, kind, sizes) in RADIAL {
        let Some(rest) = wanted.strip_prefix(series).filter(|rest| rest.is_ascii()) else {
            continue;
        };
        let (code, letters) = rest.split_at(rest.len().min(2));
        let bore = bore_mm(code);
        let Some(size) = sizes.iter().find(|size| Some(size.0) == bore) else {
            continue;
        };
        let angle = ANGLES.iter().find(|(name, _)| *name == letters);
        match (letters, kind, angle) {
            ("", _, _) => return Some(listed(*kind, *size, None)),
            (_, CatalogueType::AngularContact, Some((_, degrees))) => {
                return Some(listed(*kind, *size, Some(*degrees)));
            }
            _ => {}
        }
    }
    None
}

/// What is known, in words.
#[must_use]
pub fn known() -> String {
    let bores = |smallest: u16, largest: u16| format!("bores {smallest} to {largest} mm");
    let radial = RADIAL.iter().map(|(series, kind, sizes)| {
        let letters = if *kind == CatalogueType::AngularContact {
            " (with C, AC, A, B or contact_angle_deg)"
        } else {
            ""
        };
        (*series, sizes[0].0, sizes[sizes.len() - 1].0, letters)
    });
    let tapered = TAPERED
        .iter()
        .map(|(series, sizes)| (*series, sizes[0].0, sizes[sizes.len() - 1].0, ""));
    let all: Vec<String> = radial
        .chain(tapered)
        .map(|(series, small, large, letters)| {
            format!("{series}..{letters} {}", bores(small, large))
        })
        .collect();
    format!("such as 6205, 7010 C, NU 204, 30206, of {}", all.join(", "))
}

/// All designations, without letters behind the number.
pub fn all() -> impl Iterator<Item = String> {
    let code = |bore: u16| match bore {
        10 => 0,
        12 => 1,
        15 => 2,
        17 => 3,
        bore => bore / 5,
    };
    let radial = RADIAL.iter().flat_map(move |(series, _, sizes)| {
        sizes
            .iter()
            .map(move |size| format!("{series}{:02}", code(size.0)))
    });
    let tapered = TAPERED.iter().flat_map(move |(series, sizes)| {
        sizes
            .iter()
            .map(move |size| format!("{series}{:02}", code(size.0)))
    });
    radial.chain(tapered)
}
