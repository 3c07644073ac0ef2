//! Boundary dimensions of common designations: bore d, outside diameter D, width B (tapered bearings T) in mm.
//!
//! The dimension series of ISO 15 (radial bearings), ISO 104 (thrust ball bearings) and ISO 355 (tapered roller
//! bearings, with their contact angles), where two public tables agree. Load ratings are not in them: they follow from
//! the estimated inside by ISO 281 and ISO 76. Contact angles of ball bearings are those that the letters behind the
//! number usually mean (C 15, AC 25, A 30, B 40 degrees), which no standard says.

mod tables;

use crate::catalogue::{CatalogueLine, CatalogueType, KnownInside};
use tables::{
    SERIES_02, SERIES_03, SERIES_04, SERIES_10, SERIES_18, SERIES_22, SERIES_23, SERIES_32,
    SERIES_33, Size, TAPERED_302, TAPERED_303, TAPERED_322, TAPERED_323, THRUST_511, THRUST_512,
    TaperedSize,
};

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
    ("32", CatalogueType::AngularContactDoubleRow, SERIES_32),
    ("33", CatalogueType::AngularContactDoubleRow, SERIES_33),
    ("QJ2", CatalogueType::FourPoint, SERIES_02),
    ("QJ3", CatalogueType::FourPoint, SERIES_03),
    ("511", CatalogueType::ThrustBall, THRUST_511),
    ("512", CatalogueType::ThrustBall, THRUST_512),
    ("222", CatalogueType::SphericalRoller, SERIES_22),
    ("223", CatalogueType::SphericalRoller, SERIES_23),
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
            CatalogueType::ThrustBall => "boundary dimensions by ISO 104",
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
        let letters = match kind {
            CatalogueType::AngularContact => " (with C, AC, A, B or contact_angle_deg)",
            CatalogueType::SphericalRoller => "",
            _ if kind.angles_deg().is_some() => " (with contact_angle_deg)",
            _ => "",
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
