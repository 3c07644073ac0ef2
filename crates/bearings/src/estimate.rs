//! What is inside a bearing of which only the catalogue's line is known: an estimate, with its spread.
//!
//! Number Z and size of the elements are those that fit best, in logarithms and each in terms of its own scatter: C by ISO 281, C₀ by
//! ISO 76, and the usual share of the section that the elements fill. Numbers that cannot be assembled are left out. The spread is the range of
//! all numbers whose misfit is at most 4 above the least (two standard deviations). docs/theory/rolling_bearings.md.

use std::f64::consts::PI;

use nalgebra::{DMatrix, DVector};

use crate::catalogue::{CatalogueLine, CatalogueType};
use crate::ratings;

/// Scatter of makers' C about ISO 281, of C₀ about ISO 76 and of the share of the section, in logarithms.
const SCATTER_DYNAMIC: f64 = 0.06;
const SCATTER_STATIC: f64 = 0.04;
const SCATTER_SECTION: f64 = 0.08;
const SCATTER_LENGTH: f64 = 0.12;

/// Diameter of balls and rollers over D − d, length of rollers over B: usual values of the designs of today (an assumption, with the scatter above).
const BALL_SHARE: f64 = 0.3;
const ROLLER_SHARE: f64 = 0.275;
const LENGTH_SHARE: f64 = 0.64;

/// Largest arc that the balls of a deep-groove bearing fill when it is assembled with the inner ring aside.
const ASSEMBLY_ARC_DEG: f64 = 195.0;

/// An estimate of what is inside.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// Z.
    pub elements: usize,
    /// Fewest and most that fit about as well.
    pub elements_spread: [usize; 2],
    /// D of balls or rollers \[m\].
    pub diameter_m: f64,
    /// Its range.
    pub diameter_spread_m: [f64; 2],
    /// Length of rollers \[m\]; 0 for balls.
    pub length_m: f64,
    /// Its range.
    pub length_spread_m: [f64; 2],
    /// d_m = (d + D)/2 \[m\], an assumption.
    pub pitch_m: f64,
    /// C by ISO 281 of the estimate over the catalogue's.
    pub dynamic_ratio: f64,
    /// C₀ by ISO 76 of the estimate over the catalogue's.
    pub static_ratio: f64,
}

/// Misfits of one guess, each over its scatter.
fn misfits(line: &CatalogueLine, count: usize, logs: &[f64]) -> (Vec<f64>, [f64; 2]) {
    let pitch = 0.5 * (line.bore_m + line.outside_m);
    let section = line.outside_m - line.bore_m;
    let diameter = logs[0].exp();
    let angle = line.contact_angle_rad;
    let (c, c0, share) = match line.kind {
        CatalogueType::DeepGroove | CatalogueType::AngularContact => (
            ratings::ball_row_dynamic_n(count, diameter, pitch, angle),
            ratings::ball_row_static_n(count, diameter, pitch, angle),
            BALL_SHARE,
        ),
        CatalogueType::CylindricalRoller => {
            let size = (diameter, logs[1].exp());
            (
                ratings::roller_row_dynamic_n(count, size, pitch, 0.0),
                ratings::roller_row_static_n(count, size, pitch, 0.0),
                ROLLER_SHARE,
            )
        }
    };
    let ratios = [c / line.dynamic_n, c0 / line.static_n];
    let mut list = vec![
        ratios[0].ln() / SCATTER_DYNAMIC,
        ratios[1].ln() / SCATTER_STATIC,
        (diameter / (share * section)).ln() / SCATTER_SECTION,
    ];
    if let Some(length) = logs.get(1) {
        list.push((length.exp() / (LENGTH_SHARE * line.width_m)).ln() / SCATTER_LENGTH);
    }
    (list, ratios)
}

/// Best sizes for a number of elements, by Gauss and Newton.
fn fit(line: &CatalogueLine, count: usize) -> (Vec<f64>, f64, [f64; 2]) {
    let section = line.outside_m - line.bore_m;
    let mut logs = match line.kind {
        CatalogueType::CylindricalRoller => vec![
            (ROLLER_SHARE * section).ln(),
            (LENGTH_SHARE * line.width_m).ln(),
        ],
        _ => vec![(BALL_SHARE * section).ln()],
    };
    const STEP: f64 = 1e-6;
    for _ in 0..20 {
        let (list, _) = misfits(line, count, &logs);
        let columns: Vec<DVector<f64>> = (0..logs.len())
            .map(|place| {
                let mut moved = logs.clone();
                moved[place] += STEP;
                let (other, _) = misfits(line, count, &moved);
                (DVector::from_vec(other) - DVector::from_column_slice(&list)) / STEP
            })
            .collect();
        let jacobian = DMatrix::from_columns(&columns);
        let gradient = jacobian.tr_mul(&DVector::from_vec(list));
        let Some(step) = jacobian.tr_mul(&jacobian).lu().solve(&gradient) else {
            break;
        };
        for (log, step) in logs.iter_mut().zip(step.iter()) {
            *log -= step.clamp(-0.2, 0.2);
        }
    }
    let (list, ratios) = misfits(line, count, &logs);
    (logs, list.iter().map(|m| m * m).sum(), ratios)
}

/// Whether so many elements of this diameter go in.
fn can_be_assembled(kind: CatalogueType, count: usize, diameter_m: f64, pitch_m: f64) -> bool {
    let ratio = diameter_m / pitch_m;
    if ratio >= 1.0 {
        return false;
    }
    let each = 2.0 * ratio.asin();
    match kind {
        CatalogueType::DeepGroove => (count - 1) as f64 * each <= ASSEMBLY_ARC_DEG.to_radians(),
        // The cage's bars need some of the circle.
        CatalogueType::AngularContact => count as f64 * each * 1.05 <= 2.0 * PI,
        CatalogueType::CylindricalRoller => count as f64 * each * 1.08 <= 2.0 * PI,
    }
}

impl CatalogueLine {
    /// Number and size of balls or rollers; none where no number from 4 to 100 can be assembled.
    #[must_use]
    pub fn estimate(&self) -> Option<Estimate> {
        let pitch_m = 0.5 * (self.bore_m + self.outside_m);
        let fits: Vec<_> = (4..=100)
            .map(|count| (count, fit(self, count)))
            .filter(|(count, (logs, ..))| {
                can_be_assembled(self.kind, *count, logs[0].exp(), pitch_m)
            })
            .collect();
        let (count, (logs, least, ratios)) =
            fits.iter().min_by(|a, b| a.1.1.total_cmp(&b.1.1))?.clone();
        let near: Vec<_> = fits.iter().filter(|f| f.1.1 <= least + 4.0).collect();
        let range = |place: usize| {
            let sizes = || {
                near.iter()
                    .filter_map(|f| f.1.0.get(place))
                    .map(|l| l.exp())
            };
            [
                sizes().fold(f64::INFINITY, f64::min),
                sizes().fold(0.0, f64::max),
            ]
        };
        let counts = || near.iter().map(|f| f.0);
        let has_length = logs.len() > 1;
        Some(Estimate {
            elements: count,
            elements_spread: [
                counts().min().unwrap_or(count),
                counts().max().unwrap_or(count),
            ],
            diameter_m: logs[0].exp(),
            diameter_spread_m: range(0),
            length_m: logs.get(1).map_or(0.0, |l| l.exp()),
            length_spread_m: if has_length { range(1) } else { [0.0; 2] },
            pitch_m,
            dynamic_ratio: ratios[0],
            static_ratio: ratios[1],
        })
    }
}
