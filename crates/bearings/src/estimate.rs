//! What is inside a bearing of which only the catalogue's line is known: an estimate, with its spread.
//!
//! Number Z and size of the elements are those that fit best, in logarithms and each in terms of its own scatter: C by
//! ISO 281, C₀ by ISO 76, and the usual share of the section that the elements fill; without ratings the usual share of
//! the circle, too. Numbers that cannot be assembled and sizes that do not go into the section are left out; what is
//! known of the inside is kept. The spread is the range of all numbers whose misfit is at most 4 above the least (two
//! standard deviations), without ratings widened by the scatter of the usual shares. docs/theory/rolling_bearings.md.

use nalgebra::{DMatrix, DVector};

use crate::catalogue::CatalogueLine;
use crate::element_room::{ElementRoom, most_elements, ratings_of};

/// Scatter of makers' C about ISO 281 and of C₀ about ISO 76, in logarithms.
const SCATTER_DYNAMIC: f64 = 0.06;
const SCATTER_STATIC: f64 = 0.04;

/// Scatter of the number of elements about the usual share of those that go in; used where no ratings are known.
const SCATTER_NUMBER: f64 = 0.08;

/// Misfits beyond so many standard deviations are reported.
const POOR: f64 = 2.0;

/// An estimate of what is inside.
#[derive(Debug, Clone, PartialEq)]
pub struct Estimate {
    /// Z of a row.
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
    /// d_m \[m\]: as stated, else (d + D_a)/2.
    pub pitch_m: f64,
    /// C by ISO 281 of the estimate \[N\].
    pub dynamic_n: f64,
    /// C₀ by ISO 76 of the estimate \[N\].
    pub static_n: f64,
    /// C by ISO 281 of the estimate over the catalogue's; 1 where that is not known.
    pub dynamic_ratio: f64,
    /// C₀ by ISO 76 of the estimate over the catalogue's; 1 where that is not known.
    pub static_ratio: f64,
    /// Where the line fits no usual design well: by how much each of its figures is missed, and which sizes they ask
    /// for.
    pub poor_fit: Option<String>,
}

/// Best sizes for one number of elements.
#[derive(Debug, Clone)]
struct Fit {
    count: usize,
    diameter_m: f64,
    length_m: f64,
    ratings_n: [f64; 2],
    /// Misfits over their scatters: C, C₀, diameter, then length and number where they count.
    misfits: Vec<f64>,
}

impl Fit {
    fn new(line: &CatalogueLine, count: usize, (diameter_m, length_m): (f64, f64)) -> Self {
        let usual = line.kind.usual();
        let ratings_n = ratings_of(line, count, (diameter_m, length_m));
        let of = |found: f64, stated: Option<f64>, scatter: f64| {
            stated.map_or(0.0, |stated| (found / stated).ln() / scatter)
        };
        let share = diameter_m / (usual.diameter.0 * line.section_m());
        let mut misfits = vec![
            of(ratings_n[0], line.dynamic_n, SCATTER_DYNAMIC),
            of(ratings_n[1], line.static_n, SCATTER_STATIC),
            share.ln() / usual.diameter.1,
        ];
        if line.kind.has_rollers() {
            misfits.push((length_m / (usual.length.0 * line.width_m)).ln() / usual.length.1);
        }
        if line.dynamic_n.is_none() && line.static_n.is_none() {
            let room = usual.number * most_elements(line.kind, diameter_m, line.pitch_m());
            misfits.push((count as f64 / room.max(1e-3)).ln() / SCATTER_NUMBER);
        }
        Self {
            count,
            diameter_m,
            length_m,
            ratings_n,
            misfits,
        }
    }

    /// Σ of the squares of the misfits.
    fn sum(&self) -> f64 {
        self.misfits.iter().map(|m| m * m).sum()
    }

    /// By Gauss and Newton; sizes that are known stay.
    fn best(line: &CatalogueLine, count: usize) -> Self {
        const STEP: f64 = 1e-6;
        let usual = line.kind.usual();
        let known = &line.known;
        let rollers = line.kind.has_rollers();
        let diameter = known
            .diameter_m
            .unwrap_or(usual.diameter.0 * line.section_m());
        let length = known.length_m.unwrap_or(usual.length.0 * line.width_m);
        let mut logs = [diameter.ln(), if rollers { length.ln() } else { 0.0 }];
        let free: Vec<usize> = [
            known.diameter_m.is_none(),
            rollers && known.length_m.is_none(),
        ]
        .iter()
        .enumerate()
        .filter_map(|(place, is_free)| is_free.then_some(place))
        .collect();
        let at = |logs: [f64; 2]| {
            let diameter_m = known.diameter_m.unwrap_or_else(|| logs[0].exp());
            let length_m = match known.length_m {
                _ if !rollers => 0.0,
                Some(length_m) => length_m,
                None => logs[1].exp(),
            };
            Self::new(line, count, (diameter_m, length_m))
        };
        for _ in 0..20 {
            if free.is_empty() {
                break;
            }
            let here = DVector::from_vec(at(logs).misfits);
            let columns: Vec<DVector<f64>> = free
                .iter()
                .map(|place| {
                    let mut moved = logs;
                    moved[*place] += STEP;
                    (DVector::from_vec(at(moved).misfits) - &here) / STEP
                })
                .collect();
            let jacobian = DMatrix::from_columns(&columns);
            let gradient = jacobian.tr_mul(&here);
            let Some(step) = jacobian.tr_mul(&jacobian).lu().solve(&gradient) else {
                break;
            };
            for (place, step) in free.iter().zip(step.iter()) {
                logs[*place] -= step.clamp(-0.2, 0.2);
            }
            if step.amax() < 1e-12 {
                break;
            }
        }
        at(logs)
    }

    /// By how much each figure is missed, where one is missed by more than two standard deviations.
    fn poor(&self, line: &CatalogueLine, spread: &Estimate) -> Option<String> {
        if self.misfits.iter().all(|misfit| misfit.abs() <= POOR) {
            return None;
        }
        let percent = |ratio: f64| format!("{:+.0} %", 100.0 * (ratio - 1.0));
        let element = if line.kind.has_rollers() {
            "rollers"
        } else {
            "balls"
        };
        let mut parts = Vec::new();
        let mut asked = Vec::new();
        // C grows about with D^1.8 and C₀ with D² at a given number.
        for (name, found, stated, power) in [
            ("C by ISO 281", self.ratings_n[0], line.dynamic_n, 1.8),
            ("C0 by ISO 76", self.ratings_n[1], line.static_n, 2.0),
        ] {
            if let Some(stated) = stated {
                parts.push(format!("its {name} is {} off", percent(found / stated)));
                let size = self.diameter_m * (stated / found).powf(1.0 / power);
                asked.push(format!("{} for {:.2} mm", &name[..2], 1e3 * size));
            }
        }
        let usual = line.kind.usual();
        let in_section = usual.diameter.0 * line.section_m();
        parts.push(format!(
            "its {element} are {} off those usual in this section",
            percent(self.diameter_m / in_section)
        ));
        asked.push(format!("the section for {:.2} mm", 1e3 * in_section));
        if line.kind.has_rollers() {
            let ratio = self.length_m / (usual.length.0 * line.width_m);
            parts.push(format!("their length {} off", percent(ratio)));
        }
        let [few, many] = spread.elements_spread;
        let [small, large] = spread.diameter_spread_m.map(|d| 1e3 * d);
        Some(format!(
            "the line fits no usual design well: of the best estimate ({} {element}, spread {few} to {many}, of {:.2} mm, spread {small:.2} to {large:.2}) {}; with this number \
             {} ask. Check the line, or give number and size where they are known",
            self.count,
            1e3 * self.diameter_m,
            parts.join(", "),
            asked.join(", ").replace("C  for", "C for"),
        ))
    }
}

impl CatalogueLine {
    /// Number and size of balls or rollers; none where none can be assembled and goes into the section.
    #[must_use]
    pub fn estimate(&self) -> Option<Estimate> {
        let pitch_m = self.pitch_m();
        let room = ElementRoom::of(self);
        let numbers = match self.known.elements {
            Some(number) => number..=number,
            None => {
                let most = most_elements(self.kind, room.diameter_m[0], pitch_m);
                4..=most as usize
            }
        };
        let fits: Vec<Fit> = numbers
            .map(|count| Fit::best(self, count))
            .filter(|fit| {
                fit.count as f64 <= most_elements(self.kind, fit.diameter_m, pitch_m)
                    && room.takes(fit.diameter_m, fit.length_m)
            })
            .collect();
        let best = fits.iter().min_by(|a, b| a.sum().total_cmp(&b.sum()))?;
        let near = || fits.iter().filter(|fit| fit.sum() <= best.sum() + 4.0);
        let range = |of: fn(&Fit) -> f64| {
            [
                near().map(of).fold(f64::INFINITY, f64::min),
                near().map(of).fold(0.0, f64::max),
            ]
        };
        // Without ratings nothing but the usual shares says the sizes: their scatter is that of the sizes.
        let free = self.dynamic_n.is_none() && self.static_n.is_none();
        let usual = self.kind.usual();
        let widened = |[low, high]: [f64; 2], known: Option<f64>, scatter: f64| match known {
            None if free => [low * (-scatter).exp(), high * scatter.exp()],
            _ => [low, high],
        };
        let [few, many] = range(|fit| fit.count as f64);
        let ratio = |found: f64, stated: Option<f64>| stated.map_or(1.0, |stated| found / stated);
        let mut estimate = Estimate {
            elements: best.count,
            elements_spread: [few as usize, many as usize],
            diameter_m: best.diameter_m,
            diameter_spread_m: widened(
                range(|fit| fit.diameter_m),
                self.known.diameter_m,
                usual.diameter.1,
            ),
            length_m: best.length_m,
            length_spread_m: widened(
                range(|fit| fit.length_m),
                self.known.length_m,
                usual.length.1,
            ),
            pitch_m,
            dynamic_n: best.ratings_n[0],
            static_n: best.ratings_n[1],
            dynamic_ratio: ratio(best.ratings_n[0], self.dynamic_n),
            static_ratio: ratio(best.ratings_n[1], self.static_n),
            poor_fit: None,
        };
        estimate.poor_fit = best.poor(self, &estimate);
        Some(estimate)
    }
}
