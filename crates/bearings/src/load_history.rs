//! Life over a history of loads and speeds: loads that are alike are gathered, each has a life, damages add up (A.
//! Palmgren 1924, M. A. Miner 1945).
//!
//! ```text
//! L = Σ N_k / Σ (N_k/L_k),   P = (Σ N_k P_k^p / Σ N_k)^(1/p),   N_k: turns of the rings against each other under load k
//! ```
//!
//! Loads are alike where their magnitudes lie in one octave and no component differs by more than a 64th of the
//! octave's lower end; each group is taken at its mean load and speed. A life that goes with the p-th power is then
//! off by p(p − 1)/2 times the variance within a group, below 3e-4. Elements pass: a group's damage is the mean of
//! that with an element under the radial force and with a gap there. The direction of the radial force does not
//! matter: loads are seen from it.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use crate::definition::BearingDefinition;
use crate::error::BearingError;
use crate::life::{Life, Lubrication, exponent};
use crate::operation::Operation;
use crate::quasi_static::QuasiStaticBearing;
use crate::ratings::Ratings;
use crate::ring_equilibrium::{AppliedBearingLoad, TiltCondition};
use crate::warnings::{BearingWarning, Concern, Judged};

/// Groups in an octave of the load's magnitude.
const FINENESS: f64 = 64.0;

/// Load \[N\] below which nothing wears.
const NOTHING_N: f64 = 1e-6;

/// One moment of a history.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HistorySample {
    /// For so long \[s\], or any other weight.
    pub weight: f64,
    /// Force on the inner ring from outside, axes of the outer ring \[N\].
    pub force_n: [f64; 3],
    /// Moments about x and y on it \[N·m\].
    pub moment_nm: [f64; 2],
    /// Speed of the inner ring \[rad/s\].
    pub inner_rad_per_s: f64,
    /// Speed of the outer ring \[rad/s\].
    pub outer_rad_per_s: f64,
}

/// A history, gathered.
#[derive(Debug, Clone)]
pub struct LoadHistory {
    arm_m: f64,
    groups: BTreeMap<[i64; 8], Group>,
    weight: f64,
}

/// Loads that are alike: sums over the weight.
#[derive(Debug, Clone, Copy, Default)]
struct Group {
    weight: f64,
    turns_rad: f64,
    /// Radial force, axial force, moments about the radial force and about the axis across it, speeds.
    sums: [f64; 6],
}

/// Lives over a history.
#[derive(Debug, Clone, PartialEq)]
pub struct HistoryLife {
    /// L10 by ISO 281 in millions of turns; none where the standard gives no factors for this bearing.
    pub basic_mrev: Option<f64>,
    /// P \[N\], over the whole history.
    pub equivalent_n: Option<f64>,
    /// L10r.
    pub reference_mrev: f64,
    /// L10mr where a lubricant is stated.
    pub modified_mrev: Option<f64>,
    /// Mean speed of the rings against each other \[rad/s\], regardless of its sign.
    pub mean_speed_rad_per_s: f64,
    /// Groups of loads that were judged.
    pub groups: usize,
    /// What is beyond its limit under one of the loads: of each concern the worst one.
    pub warnings: Vec<BearingWarning>,
}

impl HistoryLife {
    /// A life in hours at the history's own speeds; infinite without turns.
    #[must_use]
    pub fn hours(&self, mrev: f64) -> f64 {
        mrev * 1e6 * TAU / self.mean_speed_rad_per_s / 3600.0
    }
}

impl LoadHistory {
    /// An empty history of a bearing.
    #[must_use]
    pub fn new(bearing: &QuasiStaticBearing) -> Self {
        Self {
            arm_m: bearing.rows[0].pitch_radius_m(),
            groups: BTreeMap::new(),
            weight: 0.0,
        }
    }

    /// Adds a moment.
    pub fn add(&mut self, sample: &HistorySample) {
        let [x, y, axial] = sample.force_n;
        let radial = x.hypot(y);
        let (cosine, sine) = if radial > 0.0 {
            (x / radial, y / radial)
        } else {
            (1.0, 0.0)
        };
        let [mx, my] = sample.moment_nm;
        let (along, across) = (mx * cosine + my * sine, my * cosine - mx * sine);
        let load = [radial, axial, along / self.arm_m, across / self.arm_m];
        let size = load.iter().map(|v| v * v).sum::<f64>().sqrt();
        let speeds = [sample.inner_rad_per_s, sample.outer_rad_per_s];
        let fastest = speeds[0].abs().max(speeds[1].abs());
        let octave = |value: f64, least: f64| value.max(least).log2().floor();
        let (of_load, of_speed) = (octave(size, NOTHING_N), octave(fastest, 1e-6));
        let mut key = [0; 8];
        key[0] = of_load as i64;
        for (place, value) in key[1..5].iter_mut().zip(load) {
            *place = (value / of_load.exp2() * FINENESS).round() as i64;
        }
        key[5] = of_speed as i64;
        for (place, value) in key[6..].iter_mut().zip(speeds) {
            *place = (value / of_speed.exp2() * FINENESS).round() as i64;
        }
        let weight = sample.weight;
        let turns = weight * (speeds[0] - speeds[1]).abs();
        let group = self.groups.entry(key).or_default();
        group.weight += weight;
        group.turns_rad += turns;
        let values = [radial, axial, along, across, speeds[0], speeds[1]];
        for (sum, value) in group.sums.iter_mut().zip(values) {
            *sum += weight * value;
        }
        self.weight += weight;
    }

    /// Lives under it. Where nothing turns, loads count by their weight.
    ///
    /// # Errors
    /// [`BearingError`] where a load of the history has no equilibrium.
    pub fn life(
        &self,
        definition: &BearingDefinition,
        bearing: &QuasiStaticBearing,
        lubrication: Option<&Lubrication>,
    ) -> Result<HistoryLife, BearingError> {
        let turned: f64 = self.groups.values().map(|group| group.turns_rad).sum();
        let power = exponent(&definition.geometry);
        let (mut all, mut reference, mut modified, mut loads) = (0.0, 0.0, 0.0, Some(0.0));
        let mut worst: BTreeMap<Concern, BearingWarning> = BTreeMap::new();
        for group in self.groups.values() {
            let turns = if turned > 0.0 {
                group.turns_rad
            } else {
                group.weight
            };
            all += turns;
            let [radial, axial, along, across, inner, outer] =
                group.sums.map(|sum| sum / group.weight);
            if turns == 0.0 || radial.hypot(axial) + along.hypot(across) / self.arm_m < NOTHING_N {
                continue;
            }
            let load = AppliedBearingLoad {
                // Cylindrical rollers carry no axial load; what damping leaves of it is none.
                force_n: [radial, 0.0, if bearing.locates { axial } else { 0.0 }],
                // What a self-aligning bearing passes on as a moment is its force beside the ring's middle.
                tilt: if bearing.aligns() {
                    TiltCondition::Held([0.0; 2])
                } else {
                    TiltCondition::Moments([along, across])
                },
            };
            let mut equivalent_n = None;
            // An element under the load, and a gap there.
            for share in [0.0, 0.5] {
                let operation = Operation {
                    inner_rad_per_s: inner,
                    outer_rad_per_s: outer,
                    cage_angle_rad: share * TAU / bearing.rows[0].elements() as f64,
                    ..Operation::default()
                };
                let (pose, mut places) = bearing.equilibrium_with_places(&load, &operation)?;
                let (ring, elements) = bearing.loads_from(&pose, &operation, &mut places)?;
                let life = Life::of(definition, &elements, load.force_n, &operation, lubrication);
                let judged = Judged {
                    definition,
                    bearing,
                    pose: &pose,
                    ring: &ring,
                    loads: &elements,
                    force_n: load.force_n,
                    operation: &operation,
                    life: &life,
                };
                for warning in judged.warnings() {
                    let known = worst.get(&warning.concern);
                    if known.is_none_or(|known| warning.excess() > known.excess()) {
                        worst.insert(warning.concern, warning);
                    }
                }
                reference += 0.5 * turns / life.reference_mrev;
                modified += life.modified_mrev.map_or(0.0, |mrev| 0.5 * turns / mrev);
                equivalent_n = life.equivalent_n;
            }
            loads = loads
                .zip(equivalent_n)
                .map(|(sum, p)| sum + turns * p.powf(power));
        }
        let equivalent_n = loads.map(|sum| (sum / all).powf(1.0 / power));
        let dynamic_n = Ratings::of(definition).dynamic_n;
        Ok(HistoryLife {
            basic_mrev: equivalent_n.map(|p| (dynamic_n / p).powf(power)),
            equivalent_n,
            reference_mrev: all / reference,
            modified_mrev: lubrication.map(|_| all / modified),
            mean_speed_rad_per_s: turned / self.weight,
            groups: self.groups.len(),
            warnings: worst.into_values().collect(),
        })
    }
}
