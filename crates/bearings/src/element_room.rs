//! What can be built between bore, outside diameter and width: how wide a bearing is, which elements go in, which
//! ratings they reach.
//!
//! Rings need a twentieth of D_a − d on either side of the elements, balls no more than the width, between washers and
//! as rollers nine tenths of it. Widths lie between those of the dimension series of ISO 15 (radial), ISO 104 (thrust)
//! and ISO 355 (tapered) with a margin. Ratings reach from those of half the usual number of elements of half the usual
//! size to those of the largest elements that go in, with a margin for makers' figures.
//! docs/theory/rolling_bearings.md.

use std::f64::consts::PI;

use crate::catalogue::{CatalogueLine, CatalogueType};
use crate::ratings;
use crate::thrust_ratings::{thrust_ball_dynamic_n, thrust_ball_static_n};

/// Largest share of D_a − d that an element takes: rings of a twentieth are left on either side.
const MOST_OF_SECTION: f64 = 0.45;

/// Largest share of the width that rollers take: the ribs, or one ring's corners, need the rest.
const MOST_OF_WIDTH: f64 = 0.9;

/// Sizes below this share of the usual one are taken for a mistake.
const LEAST_OF_USUAL: f64 = 0.5;

/// Makers' ratings, and those by the standards, may lie so far beyond what the sizes say.
const RATING_MARGIN: f64 = 1.3;

/// Largest arc that the balls of a deep-groove bearing fill when it is assembled with the inner ring aside.
const ASSEMBLY_ARC_DEG: f64 = 195.0;

/// Most elements that go in, a real number: balls of a deep-groove bearing are filled in with the inner ring aside,
/// cages of the others need some of the circle.
pub(crate) fn most_elements(kind: CatalogueType, diameter_m: f64, pitch_m: f64) -> f64 {
    let ratio = diameter_m / pitch_m;
    if ratio >= 1.0 {
        return 0.0;
    }
    let each = 2.0 * ratio.asin();
    match kind {
        CatalogueType::DeepGroove => 1.0 + ASSEMBLY_ARC_DEG.to_radians() / each,
        CatalogueType::AngularContact
        | CatalogueType::AngularContactDoubleRow
        | CatalogueType::FourPoint
        | CatalogueType::ThrustBall => 2.0 * PI / (1.05 * each),
        CatalogueType::CylindricalRoller
        | CatalogueType::TaperedRoller
        | CatalogueType::SphericalRoller => 2.0 * PI / (1.08 * each),
    }
}

/// C and C₀ of a bearing with so many elements of this diameter and length \[N\].
pub(crate) fn ratings_of(line: &CatalogueLine, count: usize, size: (f64, f64)) -> [f64; 2] {
    let (pitch, angle, rows) = (
        line.pitch_m(),
        line.contact_angle_rad,
        line.kind.rows() as f64,
    );
    if line.kind.has_rollers() {
        let made = match line.kind {
            CatalogueType::SphericalRoller => ratings::BARREL_SHARE,
            _ => 1.0,
        };
        [
            made * ratings::roller_row_dynamic_n(count, size, pitch, angle) * rows.powf(7.0 / 9.0),
            ratings::roller_row_static_n(count, size, pitch, angle) * rows,
        ]
    } else if line.kind == CatalogueType::ThrustBall {
        [
            thrust_ball_dynamic_n(count, size.0, pitch),
            thrust_ball_static_n(count, size.0),
        ]
    } else {
        [
            ratings::ball_row_dynamic_n(count, size.0, pitch, angle) * rows.powf(0.7),
            ratings::ball_row_static_n(count, size.0, pitch, angle) * rows,
        ]
    }
}

/// Ranges of sizes that go in.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ElementRoom {
    /// Diameters \[m\].
    pub diameter_m: [f64; 2],
    /// Lengths of rollers \[m\]; zero for balls.
    pub length_m: [f64; 2],
}

impl ElementRoom {
    /// Of a line.
    #[must_use]
    pub fn of(line: &CatalogueLine) -> Self {
        let usual = line.kind.usual();
        // A ring of its share is left inside and outside of the circle of the elements.
        let wall = (0.5 - MOST_OF_SECTION) * line.section_m();
        let beside = (line.pitch_m() - line.bore_m).min(line.outside_m - line.pitch_m());
        let across = (beside - wall).min(MOST_OF_SECTION * line.section_m());
        let rows = line.kind.rows() as f64;
        let beside_washers = match line.kind {
            CatalogueType::ThrustBall => MOST_OF_WIDTH,
            _ => 1.0,
        };
        let least = LEAST_OF_USUAL * usual.diameter.0 * line.section_m();
        if line.kind.has_rollers() {
            let most = match line.kind {
                // Rollers of both rows must not meet in the middle plane.
                CatalogueType::SphericalRoller => {
                    let cosine = line.contact_angle_rad.cos();
                    let diameter = line.known.diameter_m;
                    let usual = usual.diameter.0 * line.section_m();
                    (line.pitch_m() - diameter.unwrap_or(usual) * cosine)
                        * line.contact_angle_rad.tan()
                        / cosine
                }
                _ => MOST_OF_WIDTH * line.width_m / rows,
            };
            let least_length = LEAST_OF_USUAL * usual.length.0 * line.width_m;
            Self {
                diameter_m: [least, across],
                length_m: [least_length, most],
            }
        } else {
            Self {
                diameter_m: [least, across.min(beside_washers * line.width_m / rows)],
                length_m: [0.0; 2],
            }
        }
    }

    /// Whether elements of this size go in; where the smallest is concerned, whether that is no mistake.
    #[must_use]
    pub fn takes(&self, diameter_m: f64, length_m: f64) -> bool {
        let within = |value: f64, [low, high]: [f64; 2]| {
            value >= low * (1.0 - 1e-9) && value <= high * (1.0 + 1e-9)
        };
        within(diameter_m, self.diameter_m) && within(length_m, self.length_m)
    }
}

/// What cannot be built: a key of the file (in `[ratings]` where that is said), what is allowed in the key's unit, and
/// why.
#[derive(Debug, Clone, PartialEq)]
pub struct NoRoom {
    /// Key.
    pub key: &'static str,
    /// Whether it stands in `[ratings]`.
    pub in_ratings: bool,
    /// What was found, in the unit of the key.
    pub found: f64,
    /// What is allowed, in words.
    pub allowed: String,
}

impl NoRoom {
    fn of(key: &'static str, found: f64, allowed: String) -> Self {
        Self {
            key,
            in_ratings: false,
            found,
            allowed,
        }
    }
}

/// A number with four digits, or more before the point.
fn short(value: f64) -> String {
    let decimals = (3 - value.abs().log10().floor() as i32).clamp(0, 6) as usize;
    let text = format!("{value:.decimals$}");
    if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        text
    }
}

impl CatalogueLine {
    /// Narrowest and widest bearings of the series over (D_a − d)/2, with a margin of about a fifth: ISO 15 (ISO 355
    /// for tapered ones).
    fn widths_over_height(&self) -> ([f64; 2], &'static str) {
        match self.kind {
            CatalogueType::DeepGroove
            | CatalogueType::AngularContact
            | CatalogueType::FourPoint => ([0.5, 2.4], "the width series of ISO 15"),
            CatalogueType::ThrustBall => ([0.8, 2.4], "the series of ISO 104"),
            CatalogueType::AngularContactDoubleRow => ([1.0, 3.0], "ISO 15 for two rows"),
            CatalogueType::CylindricalRoller => ([0.5, 4.0], "the width series of ISO 15"),
            CatalogueType::TaperedRoller => ([0.7, 2.4], "the series of ISO 355"),
            CatalogueType::SphericalRoller => ([0.8, 2.6], "ISO 15 for two rows of rollers"),
        }
    }

    /// Complains about what cannot be built.
    ///
    /// # Errors
    /// [`NoRoom`]: which key, and what is allowed.
    pub fn check(&self) -> Result<(), NoRoom> {
        let mm = |m: f64| short(1e3 * m);
        let height = 0.5 * self.section_m();
        let ratio = self.outside_m / self.bore_m;
        if !(1.03..=5.0).contains(&ratio) {
            let allowed = format!(
                "{} to {}, 1.03 to 5 times the bore: beyond every diameter series of ISO 15",
                mm(1.03 * self.bore_m),
                mm(5.0 * self.bore_m)
            );
            return Err(NoRoom::of(
                "outside_diameter_mm",
                1e3 * self.outside_m,
                allowed,
            ));
        }
        let ([narrow, wide], series) = self.widths_over_height();
        if !(narrow * height..=wide * height).contains(&self.width_m) {
            let allowed = format!(
                "{} to {}, {narrow} to {wide} times the height of the section, {} mm: {series} with a margin",
                mm(narrow * height),
                mm(wide * height),
                mm(height)
            );
            return Err(NoRoom::of("width_mm", 1e3 * self.width_m, allowed));
        }
        self.check_known()?;
        self.check_ratings()
    }

    /// What is stated of the inside must go in.
    fn check_known(&self) -> Result<(), NoRoom> {
        let mm = |m: f64| short(1e3 * m);
        let rollers = self.kind.has_rollers();
        let known = &self.known;
        let pitch = self.pitch_m();
        let middle = 0.5 * (self.bore_m + self.outside_m);
        let aside = 0.15 * self.section_m();
        if (pitch - middle).abs() > aside {
            let allowed = format!(
                "{} to {}, near the middle between bore and outside diameter",
                mm(middle - aside),
                mm(middle + aside)
            );
            return Err(NoRoom::of("pitch_diameter_mm", 1e3 * pitch, allowed));
        }
        let room = ElementRoom::of(self);
        let named = |ball: &'static str, roller: &'static str| if rollers { roller } else { ball };
        if let Some(diameter) = known.diameter_m {
            let [least, most] = room.diameter_m;
            if !(least..=most).contains(&diameter) {
                let allowed = format!(
                    "{} to {}: a section of {} mm and a width of {} mm hold no larger ones, and smaller ones are less than half of what is usual there",
                    mm(least),
                    mm(most),
                    mm(0.5 * self.section_m()),
                    mm(self.width_m)
                );
                let key = named("ball_diameter_mm", "roller_diameter_mm");
                return Err(NoRoom::of(key, 1e3 * diameter, allowed));
            }
        }
        if let Some(length) = known.length_m {
            let [least, most] = room.length_m;
            if !(least..=most).contains(&length) {
                let allowed = format!(
                    "{} to {} in a width of {} mm",
                    mm(least),
                    mm(most),
                    mm(self.width_m)
                );
                return Err(NoRoom::of("roller_length_mm", 1e3 * length, allowed));
            }
        }
        if let Some(number) = known.elements {
            let diameter = known.diameter_m.unwrap_or(room.diameter_m[0]);
            let most = most_elements(self.kind, diameter, pitch).floor();
            if number < 3 || number as f64 > most {
                let allowed = format!(
                    "3 to {most}, as many as of {} mm go in on {} mm",
                    mm(diameter),
                    mm(pitch)
                );
                let key = named("balls", "rollers");
                return Err(NoRoom::of(key, number as f64, allowed));
            }
        }
        Ok(())
    }

    /// Ranges of C and C₀ that can be built \[N\].
    #[must_use]
    pub fn ratings_in_reach(&self) -> [[f64; 2]; 2] {
        const STEPS: usize = 8;
        let room = ElementRoom::of(self);
        let [small, large] = self
            .known
            .diameter_m
            .map_or(room.diameter_m, |diameter| [diameter; 2]);
        let [short, long] = self
            .known
            .length_m
            .map_or(room.length_m, |length| [length; 2]);
        let mut range = [[f64::INFINITY, 0.0_f64]; 2];
        for step in 0..=STEPS {
            let share = step as f64 / STEPS as f64;
            let diameter = small + share * (large - small);
            let most = most_elements(self.kind, diameter, self.pitch_m()).floor();
            let many = self.known.elements.map_or(most, |number| number as f64);
            let few = self
                .known
                .elements
                .map_or((0.5 * most).ceil(), |n| n as f64);
            let least_n = ratings_of(self, few.max(3.0) as usize, (diameter, short));
            let most_n = ratings_of(self, many.max(3.0) as usize, (diameter, long));
            for place in 0..2 {
                range[place][0] = range[place][0].min(least_n[place] / RATING_MARGIN);
                range[place][1] = range[place][1].max(most_n[place] * RATING_MARGIN);
            }
        }
        range
    }

    fn check_ratings(&self) -> Result<(), NoRoom> {
        let reach = self.ratings_in_reach();
        for (key, stated, [least, most], standard) in [
            ("dynamic_N", self.dynamic_n, reach[0], "C by ISO 281"),
            ("static_N", self.static_n, reach[1], "C0 by ISO 76"),
        ] {
            let Some(stated) = stated else {
                continue;
            };
            if (least..=most).contains(&stated) {
                continue;
            }
            let slip = if (least..=most).contains(&(1e3 * stated)) {
                format!("; {} kN are {}", short(stated), short(1e3 * stated))
            } else {
                String::new()
            };
            let allowed = format!(
                "{:.0} to {:.0}: {standard} of what goes in between a bore of {} and an outside diameter of {} mm{slip}",
                least,
                most,
                short(1e3 * self.bore_m),
                short(1e3 * self.outside_m)
            );
            return Err(NoRoom {
                in_ratings: true,
                ..NoRoom::of(key, stated, allowed)
            });
        }
        Ok(())
    }
}
