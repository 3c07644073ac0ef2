//! Rating life: L10 by ISO 281, L10r of the true load distribution by ISO/TS 16281, L10mr with lubrication and
//! contamination.

use crate::definition::{BallBearingKind, BearingDefinition, BearingGeometry};
use crate::double_row_load::equivalent_of_two_rows_n;
use crate::element_load::ElementLoad;
use crate::operation::Operation;
use crate::quasi_static::RowLoads;
use crate::ratings::{Ratings, ball_static_factor, nominal_angle_rad, outer_angle_rad};
use crate::stress_riser::stress_riser;

/// Lives in millions of turns of the rings against each other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Life {
    /// L10 = (C/P)^p with the equivalent load P of ISO 281; none where the standard gives no factors for this bearing.
    pub basic_mrev: Option<f64>,
    /// P \[N\].
    pub equivalent_n: Option<f64>,
    /// L10r; infinite without load.
    pub reference_mrev: f64,
    /// P_ref = C/L10r^(1/p) \[N\].
    pub reference_equivalent_n: f64,
    /// L10mr = a_ISO L10r where a lubricant is stated; none for thrust bearings.
    pub modified_mrev: Option<f64>,
}

/// Loads of an element that are no more than rounding \[N\].
const NO_LOAD_N: f64 = 1e-9;

/// Lubricant at the bearing's temperature.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lubrication {
    /// ν \[mm²/s\].
    pub viscosity_mm2_per_s: f64,
    /// e_C of ISO 281, 0 (heavily contaminated) to 1 (clean).
    pub contamination: f64,
}

impl Life {
    /// From the loads of all elements and the load on the ring.
    #[must_use]
    pub fn of(
        definition: &BearingDefinition,
        loads: &RowLoads,
        force_n: [f64; 3],
        operation: &Operation,
        lubrication: Option<&Lubrication>,
    ) -> Self {
        let ratings = Ratings::of(definition);
        let power = exponent(&definition.geometry);
        let reference = reference_mrev(definition, &ratings, loads, rings_that_turn(operation));
        let reference_equivalent = ratings.dynamic_n / reference.powf(1.0 / power);
        let equivalent = equivalent_n(definition, &ratings, force_n);
        Self {
            basic_mrev: equivalent.map(|p| (ratings.dynamic_n / p).powf(power)),
            equivalent_n: equivalent,
            reference_mrev: reference,
            reference_equivalent_n: reference_equivalent,
            modified_mrev: lubrication.filter(|_| !is_thrust(definition)).map(|l| {
                reference * life_factor(definition, &ratings, reference_equivalent, operation, l)
            }),
        }
    }
}

/// Whether it is a thrust bearing: ISO 281's life factors of those are others, which are not built in.
fn is_thrust(definition: &BearingDefinition) -> bool {
    matches!(&definition.geometry, BearingGeometry::Ball(g) if g.kind == BallBearingKind::Thrust)
}

/// A ring that turns by less than this share of the other one's speed stands still: housings on springs rock.
const STANDS_STILL: f64 = 0.01;

/// Whether inner and outer ring turn against the load, which stands still: a ring that turns carries it all round, one
/// that does not wears where the load is. Without any speed the inner ring is taken to turn.
fn rings_that_turn(operation: &Operation) -> [bool; 2] {
    let speeds = [operation.inner_rad_per_s, operation.outer_rad_per_s].map(f64::abs);
    let fastest = speeds[0].max(speeds[1]);
    if fastest == 0.0 {
        return [true, false];
    }
    speeds.map(|speed| speed > STANDS_STILL * fastest)
}

/// p: 3 for balls, 10/3 for rollers.
pub(crate) fn exponent(geometry: &BearingGeometry) -> f64 {
    match geometry {
        BearingGeometry::Ball(_) => 3.0,
        BearingGeometry::Roller(_) => 10.0 / 3.0,
    }
}

/// (Σ Q^w/Z)^(1/w).
fn mean_of(loads: impl Iterator<Item = f64>, power: f64) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0);
    for load in loads {
        sum += load.powf(power);
        count += 1.0;
    }
    (sum / count).powf(1.0 / power)
}

fn reference_mrev(
    definition: &BearingDefinition,
    ratings: &Ratings,
    loads: &RowLoads,
    turns: [bool; 2],
) -> f64 {
    let carried = |load: &ElementLoad| load.inner_load_n.max(load.outer_load_n) > NO_LOAD_N;
    if !loads.elements.iter().flatten().any(carried) {
        return f64::INFINITY;
    }
    match &definition.geometry {
        BearingGeometry::Ball(g) => {
            let angle = nominal_angle_rad(g);
            let gamma = g.ball_diameter_m * angle.cos() / g.pitch_diameter_m;
            let groove = |f: f64| (2.0 * f - 1.0) / f;
            let grooves = (groove(g.outer_conformity) / groove(g.inner_conformity)).powf(0.41);
            let is_thrust = g.kind == BallBearingKind::Thrust;
            // Both washers are alike, and all balls carry the same.
            let zone = if is_thrust { 1.0 } else { 1.044 };
            let ratio = zone * ((1.0 - gamma) / (1.0 + gamma)).powf(1.72) * grooves;
            let share = |sign: f64| (1.0 + ratio.powf(sign * 10.0 / 3.0)).powf(0.3);
            let row = ratings.dynamic_n / (ratings.rows as f64).powf(0.7) / g.balls as f64;
            let zones = if is_thrust {
                [1.0; 2]
            } else {
                [0.407, 0.389].map(|zone| zone * angle.cos().powf(0.7))
            };
            let (inner, outer) = (row / zones[0] * share(1.0), row / zones[1] * share(-1.0));
            let powers = turns.map(|turns| if turns { 3.0 } else { 10.0 / 3.0 });
            let damage: f64 = loads
                .elements
                .iter()
                // The two tracks of a four-point bearing's race are stressed by themselves, as those of two rows.
                .flat_map(|row| [true, false].map(|positive| (row, positive)))
                .map(|(row, positive)| {
                    let q_i = mean_of(row.iter().map(|e| e.on_track(positive).0), powers[0]);
                    let q_o = mean_of(row.iter().map(|e| e.on_track(positive).1), powers[1]);
                    (q_i / inner).powf(10.0 / 3.0) + (q_o / outer).powf(10.0 / 3.0)
                })
                .sum();
            damage.powf(-0.9)
        }
        BearingGeometry::Roller(g) => {
            let angle = outer_angle_rad(g);
            let gamma = g.diameter_m * angle.cos() / g.pitch_diameter_m;
            let ratio = 1.038 * ((1.0 - gamma) / (1.0 + gamma)).powf(143.0 / 108.0);
            let share = |sign: f64| (1.0 + ratio.powf(sign * 4.5)).powf(2.0 / 9.0);
            let row = ratings.dynamic_n
                / (ratings.rows as f64).powf(7.0 / 9.0)
                / (0.83 * g.rollers as f64 * angle.cos());
            let count = g.laminae as f64;
            let lamina = count.powf(-7.0 / 9.0);
            let inner = row / 0.378 * share(1.0) * lamina;
            let outer = row / 0.364 * share(-1.0) * lamina;
            let powers = turns.map(|turns| if turns { 4.0 } else { 4.5 });
            let mut damage = 0.0;
            for row in &loads.laminae {
                for k in 0..g.laminae {
                    let of_lamina = || row.iter().skip(k).step_by(g.laminae);
                    let riser = stress_riser(k, g.laminae);
                    let q_i = riser * mean_of(of_lamina().map(|q| q.0), powers[0]);
                    let q_o = riser * mean_of(of_lamina().map(|q| q.1), powers[1]);
                    damage += (q_i / inner).powf(4.5) + (q_o / outer).powf(4.5);
                }
            }
            damage.powf(-8.0 / 9.0)
        }
    }
}

/// Rows of ISO 281, table 3: f₀ F_a/C₀, e, Y; for deep-groove bearings (X = 0.56) …
const DEEP_GROOVE: [[f64; 3]; 9] = [
    [0.172, 0.19, 2.30],
    [0.345, 0.22, 1.99],
    [0.689, 0.26, 1.71],
    [1.03, 0.28, 1.55],
    [1.38, 0.30, 1.45],
    [2.07, 0.34, 1.31],
    [3.45, 0.38, 1.15],
    [5.17, 0.42, 1.04],
    [6.89, 0.44, 1.00],
];

/// … and for angular-contact bearings of 15° (X = 0.44).
const FIFTEEN_DEGREES: [[f64; 3]; 9] = [
    [0.178, 0.38, 1.47],
    [0.357, 0.40, 1.40],
    [0.714, 0.43, 1.30],
    [1.07, 0.46, 1.23],
    [1.43, 0.47, 1.19],
    [2.14, 0.50, 1.12],
    [3.57, 0.55, 1.02],
    [5.35, 0.56, 1.00],
    [7.14, 0.56, 1.00],
];

/// ISO 281, table 3, from 20° on: α in degrees, X, Y, e.
const STEEP_ANGLES: [[f64; 4]; 6] = [
    [20.0, 0.43, 1.00, 0.57],
    [25.0, 0.41, 0.87, 0.68],
    [30.0, 0.39, 0.76, 0.80],
    [35.0, 0.37, 0.66, 0.95],
    [40.0, 0.35, 0.57, 1.14],
    [45.0, 0.33, 0.50, 1.34],
];

/// Row of a table at `x` between its rows, held at its ends.
pub(crate) fn between<const N: usize>(table: &[[f64; N]], x: f64) -> [f64; N] {
    let last = table.len() - 1;
    let upper = table.iter().position(|row| row[0] >= x).unwrap_or(last);
    let lower = upper.saturating_sub(1);
    let (a, b) = (&table[lower], &table[upper]);
    let share = if upper > lower {
        ((x - a[0]) / (b[0] - a[0])).clamp(0.0, 1.0)
    } else {
        0.0
    };
    std::array::from_fn(|i| a[i] + share * (b[i] - a[i]))
}

/// P = X F_r + Y F_a; none for tandem rows, four-point bearings, thrust bearings with a radial load and angles that ISO
/// 281 does not list.
fn equivalent_n(
    definition: &BearingDefinition,
    ratings: &Ratings,
    force_n: [f64; 3],
) -> Option<f64> {
    let radial = force_n[0].hypot(force_n[1]);
    let axial = force_n[2].abs();
    if ratings.rows > 1 {
        return equivalent_of_two_rows_n(definition, (radial, axial));
    }
    if let BearingGeometry::Ball(g) = &definition.geometry {
        match g.kind {
            BallBearingKind::FourPoint { .. } => return None,
            // P = F_a, no radial load.
            BallBearingKind::Thrust => {
                return (axial > 0.0 && radial <= 1e-6 * axial).then_some(axial);
            }
            BallBearingKind::DeepGroove | BallBearingKind::AngularContact => {}
        }
    }
    let (x, y, limit) = match &definition.geometry {
        BearingGeometry::Ball(g) => {
            let degrees = nominal_angle_rad(g).to_degrees();
            let gamma = g.ball_diameter_m * nominal_angle_rad(g).cos() / g.pitch_diameter_m;
            let relative = ball_static_factor(gamma) * axial / ratings.static_n;
            if degrees == 0.0 {
                let [_, e, y] = between(&DEEP_GROOVE, relative);
                (0.56, y, e)
            } else if (degrees - 15.0).abs() < 0.5 {
                let [_, e, y] = between(&FIFTEEN_DEGREES, relative);
                (0.44, y, e)
            } else if (20.0..=45.0).contains(&degrees) {
                let [_, x, y, e] = between(&STEEP_ANGLES, degrees);
                (x, y, e)
            } else {
                return None;
            }
        }
        BearingGeometry::Roller(g) => match g.taper {
            None => (1.0, 0.0, f64::INFINITY),
            Some(taper) => {
                let tangent = taper.contact_angle_rad.tan();
                (0.4, 0.4 / tangent, 1.5 * tangent)
            }
        },
    };
    let equivalent = if axial <= limit * radial {
        radial
    } else {
        x * radial + y * axial
    };
    (equivalent > 0.0).then_some(equivalent)
}

/// a_ISO of ISO 281 (9.3.3) with κ = ν/ν₁ by its equations for ν₁; between 0.1 and 50.
fn life_factor(
    definition: &BearingDefinition,
    ratings: &Ratings,
    load_n: f64,
    operation: &Operation,
    lubrication: &Lubrication,
) -> f64 {
    let speed_rpm =
        (operation.inner_rad_per_s - operation.outer_rad_per_s).abs() * 30.0 / std::f64::consts::PI;
    let (pitch_m, is_ball) = match &definition.geometry {
        BearingGeometry::Ball(g) => (g.pitch_diameter_m, true),
        BearingGeometry::Roller(g) => (g.pitch_diameter_m, false),
    };
    let reference = if speed_rpm < 1000.0 {
        45_000.0 * speed_rpm.powf(-0.83)
    } else {
        4500.0 * speed_rpm.powf(-0.5)
    } / (pitch_m * 1e3).sqrt();
    let kappa = (lubrication.viscosity_mm2_per_s / reference).min(4.0);
    if kappa < 0.1 {
        return 0.1;
    }
    let clean = lubrication.contamination * ratings.fatigue_n / load_n;
    let by_range = |values: [(f64, f64, f64); 3]| {
        let (a, b, power) = if kappa < 0.4 {
            values[0]
        } else if kappa < 1.0 {
            values[1]
        } else {
            values[2]
        };
        a - b / kappa.powf(power)
    };
    let inside = if is_ball {
        let film = by_range([
            (2.5671, 2.2649, 0.054381),
            (2.5671, 1.9987, 0.19087),
            (2.5671, 1.9987, 0.071739),
        ]);
        1.0 - film.max(0.0).powf(0.83) * clean.cbrt()
    } else {
        let film = by_range([
            (1.5859, 1.3993, 0.054381),
            (1.5859, 1.2348, 0.19087),
            (1.5859, 1.2348, 0.071739),
        ]);
        1.0 - film * clean.powf(0.4)
    };
    if inside <= 0.0 {
        return 50.0;
    }
    let power = if is_ball { -9.3 } else { -9.185 };
    (0.1 * inside.powf(power)).clamp(0.1, 50.0)
}
