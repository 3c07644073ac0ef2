//! Boundary dimensions of common designations: bore d, outside diameter D, width B (tapered bearings T) in mm.
//!
//! The dimension series of ISO 15 (radial bearings), ISO 104 (thrust ball bearings) and ISO 355 (tapered roller
//! bearings, with their contact angles), where two public tables agree. Load ratings are not in them: they follow from
//! the estimated inside by ISO 281 and ISO 76. Contact angles of ball bearings are those that the letters behind the
//! number usually mean (C 15, AC 25, A 30, B 40 degrees), which no standard says.

mod tables;

use crate::catalogue::{CatalogueLine, CatalogueType, KnownInside};
use tables::{
    Angle, DIAMETERS_2, DIAMETERS_3, SERIES_04, SERIES_10, SERIES_18, Size, THRUST_511, THRUST_512,
};

/// What stands before the bore in a designation, the type, and a column of a table.
const SERIES: &[(&str, CatalogueType, &[Size], usize)] = &[
    ("618", CatalogueType::DeepGroove, SERIES_18, 0),
    ("60", CatalogueType::DeepGroove, SERIES_10, 0),
    ("62", CatalogueType::DeepGroove, DIAMETERS_2, 0),
    ("63", CatalogueType::DeepGroove, DIAMETERS_3, 0),
    ("64", CatalogueType::DeepGroove, SERIES_04, 0),
    ("70", CatalogueType::AngularContact, SERIES_10, 0),
    ("72", CatalogueType::AngularContact, DIAMETERS_2, 0),
    ("73", CatalogueType::AngularContact, DIAMETERS_3, 0),
    ("32", CatalogueType::AngularContactDoubleRow, DIAMETERS_2, 2),
    ("33", CatalogueType::AngularContactDoubleRow, DIAMETERS_3, 2),
    ("QJ2", CatalogueType::FourPoint, DIAMETERS_2, 0),
    ("QJ3", CatalogueType::FourPoint, DIAMETERS_3, 0),
    ("511", CatalogueType::ThrustBall, THRUST_511, 0),
    ("512", CatalogueType::ThrustBall, THRUST_512, 0),
    ("222", CatalogueType::SphericalRoller, DIAMETERS_2, 1),
    ("223", CatalogueType::SphericalRoller, DIAMETERS_3, 1),
    ("NU10", CatalogueType::CylindricalRoller, SERIES_10, 0),
    ("NU2", CatalogueType::CylindricalRoller, DIAMETERS_2, 0),
    ("NU22", CatalogueType::CylindricalRoller, DIAMETERS_2, 1),
    ("NU3", CatalogueType::CylindricalRoller, DIAMETERS_3, 0),
    ("NU23", CatalogueType::CylindricalRoller, DIAMETERS_3, 1),
    ("302", CatalogueType::TaperedRoller, DIAMETERS_2, 3),
    ("303", CatalogueType::TaperedRoller, DIAMETERS_3, 3),
    ("322", CatalogueType::TaperedRoller, DIAMETERS_2, 4),
    ("323", CatalogueType::TaperedRoller, DIAMETERS_3, 4),
];

/// Bore, outside diameter and width in mm and the contact angle of the sizes in a column of a table.
fn sizes(table: &[Size], column: usize) -> impl Iterator<Item = (u16, f64, f64, Angle)> {
    let listed = move |&(bore, outside, widths, angle): &Size| {
        let width = widths[column];
        (width > 0.0).then_some((bore, outside, width, angle))
    };
    table.iter().filter_map(listed)
}

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
    for &(series, kind, table, column) in SERIES {
        let Some(rest) = wanted.strip_prefix(series).filter(|rest| rest.is_ascii()) else {
            continue;
        };
        let (code, letters) = rest.split_at(rest.len().min(2));
        let wanted_bore = bore_mm(code);
        let found = sizes(table, column).find(|size| Some(size.0) == wanted_bore);
        let Some((bore, outside, width, (degrees, minutes, seconds))) = found else {
            continue;
        };
        let usual = ANGLES.iter().find(|(name, _)| *name == letters);
        let angle_deg = match (letters, kind, usual) {
            ("", CatalogueType::TaperedRoller, _) => {
                let [degrees, minutes, seconds] = [degrees, minutes, seconds].map(f64::from);
                Some(degrees + minutes / 60.0 + seconds / 3600.0)
            }
            ("", _, _) => None,
            (_, CatalogueType::AngularContact, Some((_, degrees))) => Some(*degrees),
            _ => continue,
        };
        return Some(Listed {
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
            designation: wanted,
        });
    }
    None
}

/// What is known, in words.
#[must_use]
pub fn known() -> String {
    let of_series = |&(series, kind, table, column): &(&str, CatalogueType, &[Size], usize)| {
        let letters = match kind {
            CatalogueType::AngularContact => " (with C, AC, A, B or contact_angle_deg)",
            CatalogueType::SphericalRoller | CatalogueType::TaperedRoller => "",
            _ if kind.angles_deg().is_some() => " (with contact_angle_deg)",
            _ => "",
        };
        let bores = || sizes(table, column).map(|size| size.0);
        let (small, large) = (bores().min(), bores().max());
        let (small, large) = (small.unwrap_or_default(), large.unwrap_or_default());
        format!("{series}..{letters} bores {small} to {large} mm")
    };
    let all: Vec<String> = SERIES.iter().map(of_series).collect();
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
    SERIES.iter().flat_map(move |&(series, _, table, column)| {
        sizes(table, column).map(move |size| format!("{series}{:02}", code(size.0)))
    })
}
